"""Checks of one file of a run: how much of it there is, how large its values are, and whether they move."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ...faults import ERROR, WARNING, Fault, run_fault
from ..channels import BODY_NAMES, BY_NAME, INPUT_NAMES, Channel
from ..draft import Draft
from ..resampled import REPEATED

FEWEST = 10  # samples of a run
ABSURD = 1000.0  # times what is plausible: no wrong unit does more
PUSHED_HARD = 3.0  # the same of an input, which is simulated: a chair at the speed of a bullet takes minutes, and tells nothing


def too_short(draft: Draft) -> Iterator[Fault]:
    if draft.rows.values and len(draft.kept) < FEWEST:
        start, stop = draft.entry.data.get("from"), draft.entry.data.get("to")
        if start is None and stop is None:
            fact, cure = f"only {len(draft.kept)} samples, at least {FEWEST} are needed", "log for longer"
        else:
            cut = " ".join(f"{k} {v} s" for k, v in (("from", start), ("to", stop)) if v is not None)
            fact = f"the cut {cut} leaves {len(draft.kept)} samples, at least {FEWEST} are needed"
            cure = _extent(draft)
        yield run_fault(draft.file, fact, cure)


def _extent(draft: Draft) -> str:
    time = draft.whole_time
    if time is None or not np.isfinite(time).any():
        return "widen it"
    return f"widen it; the file runs from {np.nanmin(time):.6g} to {np.nanmax(time):.6g} s"


def input_gap(draft: Draft) -> Iterator[Fault]:
    assert draft.time is not None or not draft.gaps
    for name, gaps in draft.gaps.items():
        series = draft.values[name]
        for gap in () if np.isnan(series).all() else gaps:
            where = "at the end of the run" if gap.stop == len(series) else "at the start of the run"
            if gap.inside and draft.time is not None:
                where = f"for {draft.time[gap.stop] - draft.time[gap.start - 1]:.4g} s, too long for a straight line"
            fact = f"{name} is missing {where}"
            cure = "fill it in, or cut the run by from and to"
            yield run_fault(draft.file, fact, cure, draft.line(gap.start), draft.header(name))


def empty_column(draft: Draft) -> Iterator[Fault]:
    """A check of the run says where the rider's body is not seen."""
    for name, series in draft.values.items():
        if name not in BODY_NAMES and len(series) and np.isnan(series).all():
            if name in draft.inputs:
                cure = f"remove it and write constant = {{ {name} = 0.0 }} in the run, or give the values"
                yield run_fault(draft.file, f"the input {name} holds only gaps", cure, column=draft.header(name))
            elif not draft.left_out:
                fact = f"{name} holds only gaps and is left out"
                yield run_fault(draft.file, fact, "remove the column", column=draft.header(name), severity=WARNING)


def stuck(draft: Draft) -> Iterator[Fault]:
    """Pushes may stand still: nobody may have pushed."""
    for name, series in ({} if draft.left_out else draft.values).items():
        if name not in draft.inputs and np.isfinite(series).sum() > 1 and np.nanmin(series) == np.nanmax(series):
            fact = f"{name} never changes from {np.nanmin(series):.6g} {BY_NAME[name].unit.name} and is left out"
            cure = "check the sensor, or remove the column"
            yield run_fault(draft.file, fact, cure, column=draft.header(name), severity=WARNING)


def one_for_two(draft: Draft) -> Iterator[Fault]:
    """One column as several channels, as a copied line of [columns] makes it."""
    of: dict[int, list[str]] = {}
    for name, binding in draft.bindings.found.items():
        of.setdefault(binding.index, []).append(name)
    for names in (names for names in of.values() if len(names) > 1):
        cure = "correct [columns], unless one sensor stands for both"
        fact = f"{' and '.join(names)} are read from the same column"
        yield run_fault(draft.file, fact, cure, column=draft.header(names[0]), severity=WARNING)


def implausible(draft: Draft) -> Iterator[Fault]:
    for name, series in draft.values.items():
        channel = BY_NAME[name]
        odd = np.flatnonzero((series < channel.low) | (series > channel.high))
        if odd.size:
            i = odd[np.argmax(np.abs(series[odd]))]
            fact, cure, absurd = beyond_plausible(channel, float(series[i]))
            severity = ERROR if np.isfinite(series[i]) and absurd else WARNING
            yield run_fault(draft.file, fact, cure, draft.line(int(i)), draft.header(name), severity)


def beyond_plausible(channel: Channel, value: float) -> tuple[str, str, bool]:
    """The fact and the cure for a value that is not within what is plausible of a channel or an input, and whether it is so far
    from it that it is an error."""
    bound, side = (channel.high, "above") if value > channel.high else (channel.low, "below")
    times, unit = PUSHED_HARD if channel.name in INPUT_NAMES else ABSURD, channel.unit.behind
    fact = f"{channel.name} reaches {value:.4g}{unit}, {side} any plausible {bound:g}{unit}"
    return fact, f"check its unit (is it {channel.wrong_unit}?)", abs(value) > times * abs(bound or 1.0)


def resampled(draft: Draft) -> Iterator[Fault]:
    for name, found in draft.resampled.items():
        low, high = np.floor(found.rows + 0.05), np.ceil(found.rows - 0.05)
        rows = f"{low:g} rows" if low == high else f"{low:g} or {high:g} rows"
        seen = "changes only every" if found.how == REPEATED else "changes its slope only every"
        rate = ""
        if draft.time is not None and (step := float(np.median(np.diff(draft.time)))) > 0:
            rate = f"at about {1 / (found.rows * step):.3g} Hz "
        fact = f"{name} {seen} {rows}: it was sampled {rate}and {found.how}; what is no reading is left out"
        cure = "leave its cells empty in rows without a new reading"
        yield run_fault(draft.file, fact, cure, column=draft.header(name), severity=WARNING)


def spike(draft: Draft) -> Iterator[Fault]:
    for name, found in draft.spikes.items():
        usual = float(np.nanmedian(draft.values[name]))
        i = max(found, key=lambda row: abs(found[row] - usual))
        assert draft.time is not None  # without it nobody looks for any
        farthest = f"{found[i]:.4g} {BY_NAME[name].unit.name} at {draft.time[i]:.6g} s"
        if len(found) == 1:
            fact = f"{name} reads {farthest}, alone between readings that agree, and is left out there"
        else:
            fact = f"{name} has {len(found)} readings that stand alone and are left out, the farthest {farthest}"
        cure = "check the sensor and its cable; no chair moves so"
        yield run_fault(draft.file, fact, cure, draft.line(i), draft.header(name), WARNING)


FILE_CHECKS: tuple[Callable[[Draft], Iterator[Fault]], ...] = (
    too_short,
    one_for_two,
    input_gap,
    empty_column,
    stuck,
    implausible,
    resampled,
    spike,
)
