"""Columns of time as loggers write them, into seconds from the recording's own zero, with the absolute start."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import partial

import numpy as np
import pandas as pd

DAY = 86400.0  # s
DAY_FIRST, MONTH_FIRST = "day first", "month first"
_TIME = r"(?P<h>\d{1,2}):(?P<min>\d\d)(?::(?P<s>\d\d(?:[.,]\d+)?))?\s*(?P<half>[AaPp]\.?[Mm]\.?)?"
_DATE = r"(?:(?P<iso>\d{4}[-/]\d\d?[-/]\d\d?)|(?P<local>\d{1,2}(?P<mark>[./-])\d{1,2}(?P=mark)(?:\d{4}|\d\d)))"
_ZONE = r"\s*(?P<zone>Z|UTC|[+-]\d\d:?\d\d)?"
_STAMP = re.compile(rf"(?:{_DATE}(?:[T,;\s]\s*{_TIME}{_ZONE})?|{_TIME.replace('?P<', '?P<only_')})")
_EPOCHS = (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6), ("ns", 1e-9))
_EPOCH_RANGE = 3.0e8, 6.0e9  # s since 1970: 1979 to 2160
_SERIAL_RANGE = 3.0e4, 8.0e4  # days since 1899-12-30: 1982 to 2119
_SERIAL_STEP = 2e-5  # days, 1.7 s: seconds that were counted would step by less only above 50 kHz
_SERIAL_ZERO = datetime(1899, 12, 30)
NAMES = frozenset(
    (
        "time",
        "t",
        "zeit",
        "temps",
        "tiempo",
        "tempo",
        "tijd",
        "tid",
        "timestamp",
        "timestamps",
        "time stamp",
        "zeitstempel",
        "datetime",
        "date time",
        "date/time",
        "datum/zeit",
        "datum zeit",
        "uhrzeit",
        "time of day",
        "clock",
        "elapsed time",
        "messzeit",
        "ms since midnight",
        "milliseconds since midnight",
        "millisekunden seit mitternacht",
        "time since midnight",
        "epoch",
        "unix time",
    )
)
_MIDNIGHT = ("midnight", "mitternacht", "minuit", "middernacht", "time of day")


@dataclass(frozen=True)
class Seconds:
    """Times (n,) in s from the first one, NaN where a cell is no time; `started` and `note` may be missing."""

    values: np.ndarray
    started: datetime | None = None
    note: str = ""


@dataclass(frozen=True)
class Clock:
    """How a column of numbers becomes what `unit` says: seconds, or as it was where it is no `moment` but may pass midnight."""

    seconds: Callable[[Sequence[str] | np.ndarray], Seconds]
    unit: str | None = "s"
    moment: bool = True


class ClockError(ValueError):
    """A column of times that could be read in two ways: a fact and a cure."""

    def __init__(self, fact: str, cure: str):
        self.fact, self.cure = fact, cure
        super().__init__(f"{fact}; {cure}")


def named_time(name: str) -> bool:
    """Is this what loggers call their column of time?"""
    return re.sub(r"[\s_]+", " ", name.strip().casefold()) in NAMES


def is_stamp(text: str) -> bool:
    """A date, a time of day or both."""
    return (":" in text and bool(_STAMP.fullmatch(text.strip()))) or bool(_date_only(text))


def _date_only(text: str) -> re.Match | None:
    found = re.fullmatch(_DATE, text.strip())
    if found and found["local"] and found["mark"] == "." and len(found["local"].split(".")[0]) > 2:
        return None
    return found


def is_date(text: str) -> bool:
    """A date without a time of day."""
    return bool(_date_only(text))


def stamps(cells: Sequence[str], order: str = "", european: bool = False) -> Seconds:
    """Stamps as text, ISO 8601 or local. `order` settles whether 3/4/2026 is in April; `european` makes that evident.

    Raises ClockError where nothing does.
    """
    texts = pd.Series(list(cells), dtype=str).str.strip()
    if texts.size and re.match(r"\d{4}-", texts.iloc[0]):
        with suppress(ValueError):  # written in another way, or in several: part by part, then
            return datetimes(pd.to_datetime(texts, format="ISO8601"))
    parts = texts.str.extract(_STAMP)
    dates = parts["iso"].combine_first(parts["local"])  # not fillna, which in pandas 2 makes floats of texts all missing
    day = dates.map(_days(dates.dropna().unique(), parts, order, european)).to_numpy(dtype=float)
    clock = [parts[name].combine_first(parts[f"only_{name}"]) for name in ("h", "min", "s", "half")]
    hours, minutes = (pd.to_numeric(c).to_numpy(dtype=float) for c in clock[:2])
    seconds = pd.to_numeric(clock[2].str.replace(",", ".")).to_numpy(dtype=float)
    half = clock[3].str.lower().str[0]
    hours = np.where(half.notna(), hours % 12 + 12 * (half == "p"), hours)
    within = hours * 3600 + minutes * 60 + np.nan_to_num(seconds)
    dated = np.isfinite(day)
    within = np.where(dated & np.isnan(within), 0.0, within)
    zones = parts["zone"].map({zone: _offset(zone) for zone in parts["zone"].dropna().unique()}).to_numpy(dtype=float)
    within = within - np.nan_to_num(zones)
    found = np.flatnonzero(np.isfinite(within))
    if not found.size:
        return Seconds(np.full(len(parts), np.nan), note="")
    first = found[0]
    if not dated[first]:
        note = f"time of day, from {clock_text(float(within[first]))}"
        return Seconds(over_midnight(within - within[first], DAY), note=note)
    started = datetime(1970, 1, 1) + timedelta(days=float(day[first]), seconds=float(within[first]))
    started = started.replace(tzinfo=UTC) if np.isfinite(zones[first]) else started
    values = (day - day[first]) * DAY + (within - within[first])
    return Seconds(values, started, f"stamps from {_written(started)}")


def _days(dates: Sequence[str], parts: pd.DataFrame, order: str, european: bool) -> dict[str, float]:
    """Days since 1970 by date as written."""
    local = [d for d in dates if not re.match(r"\d{4}", d)]
    day_at = 0
    if local and not all("." in d for d in local):
        numbers = [[int(n) for n in re.split(r"[./-]", d)[:2]] for d in local]
        first, second = (max(n[i] for n in numbers) for i in (0, 1))
        if first > 12 or order == DAY_FIRST:
            day_at = 0
        elif second > 12 or order == MONTH_FIRST:
            day_at = 1
        elif not european:
            fact = f"the date {local[0]} may have its day or its month first"
            raise ClockError(fact, f'write dates = "{DAY_FIRST}" or dates = "{MONTH_FIRST}" in the run')
    return {d: _day(d, day_at) for d in dates}


def _day(date: str, day_at: int) -> float:
    numbers = [int(n) for n in re.split(r"[./-]", date)]
    if numbers[0] > 31:
        year, month, day = numbers
    else:
        day, month, year = numbers[day_at], numbers[1 - day_at], numbers[2]
    year += 2000 if year < 70 else 1900 if year < 100 else 0
    try:
        return float((datetime(year, month, day) - datetime(1970, 1, 1)).days)
    except ValueError:  # there is no such day: its cell is no time
        return np.nan


def _offset(zone: str) -> float:
    if zone in ("Z", "UTC"):
        return 0.0
    digits = zone[1:].replace(":", "")
    return (-1 if zone[0] == "-" else 1) * (int(digits[:2]) * 3600.0 + int(digits[2:]) * 60.0)


def over_midnight(values: np.ndarray, day: float) -> np.ndarray:
    """A clock that starts again at 0 after `day`, made to go on; only a fall by nearly a whole day counts as that."""
    finite = np.flatnonzero(np.isfinite(values))
    falls = np.diff(values[finite], prepend=values[finite[:1]]) < -0.9 * day
    result = values.copy()
    result[finite] += day * np.cumsum(falls)
    return result


def datetimes(column: pd.Series) -> Seconds:
    """Stamps that a library has read: timestamps with or without a zone."""
    moments = column.dropna()
    if moments.empty:
        return Seconds(np.full(len(column), np.nan))
    if moments.dt.tz is not None:
        column = column.dt.tz_convert("UTC")
    first = column[column.notna()].iloc[0]
    values = (column - first).dt.total_seconds().to_numpy(dtype=float)
    ns = (column - first).astype("timedelta64[ns]").to_numpy()
    values = np.where(np.isnat(ns), np.nan, ns.astype("int64") / 1e9)
    started = first.to_pydatetime()
    return Seconds(values, started, f"stamps from {_written(started)}")


def durations(column: pd.Series) -> np.ndarray:
    """Time deltas in s, as the file counts them."""
    return column.dt.total_seconds().to_numpy(dtype=float)


def counted(name: str, unit: str | None, sample: np.ndarray) -> Clock | None:
    """How a column of numbers that is called time is to be read; None where it is just as it stands.

    Told from the first numbers: seconds (or ms, µs, ns) since 1970, days as spreadsheets count them, or the time of day.
    """
    sample = sample[np.isfinite(sample)]
    if not sample.size:
        return None
    for epoch, scale in _EPOCHS:
        if _within(sample * scale, _EPOCH_RANGE) and unit in (None, epoch, "us" if epoch == "µs" else epoch):
            return Clock(partial(_since, scale=scale, zero=datetime(1970, 1, 1, tzinfo=UTC), what=f"{epoch} since 1970"))
    steps = np.diff(sample)
    if unit in (None, "d", "days") and _within(sample, _SERIAL_RANGE) and steps.size and 0 < np.median(steps) < _SERIAL_STEP:
        return Clock(lambda v: _since(v, DAY, _SERIAL_ZERO, "days of a spreadsheet"))
    factor = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "µs": 1e-6, "us": 1e-6}.get(unit or "")
    midnight = any(word in name.casefold().replace("_", " ") for word in _MIDNIGHT)
    if midnight and unit is None and re.search(r"\bm(illi)?s(ec|econds|ekunden)?\b", name.casefold().replace("_", " ")):
        factor = 1e-3
    if factor is None or not _within(sample * factor, (0.0, DAY)):
        return None
    day = DAY / factor
    if midnight:
        return Clock(lambda v: _since(over_midnight(np.asarray(v, dtype=float), day), factor, None, "time of day"))
    return Clock(lambda v: Seconds(over_midnight(np.asarray(v, dtype=float), day)), unit, False)


def _within(values: np.ndarray, span: tuple[float, float]) -> bool:
    return bool(span[0] <= values.min() and values.max() <= span[1])


def _since(numbers: Sequence[str] | np.ndarray, scale: float, zero: datetime | None, what: str) -> Seconds:
    numbers = np.asarray(numbers, dtype=float)
    found = np.flatnonzero(np.isfinite(numbers))
    if not found.size:
        return Seconds(numbers)
    first = float(numbers[found[0]])
    started = None if zero is None else zero + timedelta(seconds=round(first * scale, 6))
    note = f"{what}, from {_written(started)}" if started else f"{what}, from {clock_text(first * scale)}"
    return Seconds((numbers - first) * scale, started, note)


def clock_text(seconds: float) -> str:
    """51234.5 s after midnight is 14:13:54.500."""
    return f"{int(seconds // 3600):02d}:{int(seconds % 3600 // 60):02d}:{seconds % 60:06.3f}"


def _written(moment: datetime) -> str:
    """ISO 8601 to the millisecond."""
    return moment.isoformat(sep=" ", timespec="milliseconds")


def count_over(values: np.ndarray, modulus: float) -> np.ndarray:
    """A counter of samples that starts again at 0 after `modulus` - 1, made to go on and to start at 0."""
    finite = np.flatnonzero(np.isfinite(values))
    result = np.array(values, dtype=float)
    if finite.size:
        falls = np.diff(result[finite], prepend=result[finite[:1]]) < -0.5 * modulus
        result[finite] += modulus * np.cumsum(falls)
        result -= result[finite[0]]
    return result
