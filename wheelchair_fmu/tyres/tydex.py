"""TYDEX 1.3 measurements (.tdx): `**KEYWORD` blocks of fixed columns, one file for each test.

A name stands in columns 1–10, its meaning in 11–42, its unit in 43–52, and from 53 on a value (`**CONSTANTS`) or a factor and
two offsets (`**MEASURCHANNELS`): value = factor · (written + first offset) + second offset. `**MEASURDATA` has a number for
each channel in each row. What is constant may stand in either block. Forces and torques are in TYDEX's ISO axes (y left, z up),
of the W- or C-axis system.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..faults import SHOWN, Fault, not_utf8
from ..quantities import BAR, M_S, N_M, RAD, N, Unit
from ..units import UnitError, factor
from .rows import Rows

UNIT, VALUES = slice(42, 52), slice(52, None)


@dataclass(frozen=True)
class Channel:
    """Where TYDEX may have a quantity, by its names there, and its sign in the paper's axes."""

    names: tuple[str, ...]
    unit: Unit
    sign: int = 1


CHANNELS = {
    "pressure": Channel(("INFLPRES",), BAR),
    "load": Channel(("FZW", "FZH", "FZC"), N),
    "disc_speed": Channel(("TRAJVELW", "TRAJVELH", "LONGVEL"), M_S),
    "slip_angle": Channel(("SLIPANGL",), RAD),
    "camber_angle": Channel(("INCLANGL",), RAD),
    "lateral_force": Channel(("FYW", "FYH", "FYC"), N, -1),
    "yaw_torque": Channel(("MZW", "MZH", "MZC"), N_M, -1),
}
MAY_LACK = ("camber_angle", "yaw_torque")
_WORDS = {"degree": "deg", "deg C": "degC", "km/u": "km/h"}


@dataclass(frozen=True)
class Entry:
    """A line of a block."""

    name: str
    unit: str
    rest: str
    line: int


def read_tydex(path: Path, raw: bytes) -> tuple[Rows | None, list[Fault]]:
    """The rows of a TYDEX file in the paper's axes, and all its faults."""
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return None, [not_utf8(path.name, raw, error)]
    blocks = _blocks(text)
    faults = [
        Fault(path.name, None, None, f"no block **{name}", "is it a TYDEX 1.3 file with measurements?")
        for name in ("MEASURCHANNELS", "MEASURDATA")
        if not blocks.get(name)
    ]
    if faults:
        return None, faults
    constants, channels = ([_entry(i, line) for i, line in blocks.get(name, ())] for name in ("CONSTANTS", "MEASURCHANNELS"))
    data, lines, met = _data(path.name, blocks["MEASURDATA"], len(channels))
    faults += met
    columns, headers = {}, {}
    for name, channel in CHANNELS.items():
        try:
            values, header = _column(path.name, name, channel, constants, channels, data)
        except _Trouble as trouble:
            faults.append(trouble.fault)
            continue
        if values is not None:
            columns[name], headers[name] = values, header
    if faults:
        return None, faults
    tyre = next((e.rest.strip() for e in constants if e.name == "IDENTITY" and e.rest.strip()), path.stem)
    rows = Rows(path.name, [tyre] * len(lines), columns, np.array(lines), headers)
    return rows, list(rows.faults())


class _Trouble(Exception):
    def __init__(self, fault: Fault):
        self.fault = fault


def _blocks(text: str) -> dict[str, list[tuple[int, str]]]:
    """Lines that say something, with their numbers, by the keyword above them."""
    blocks: dict[str, list[tuple[int, str]]] = {}
    keyword = ""
    for i, line in enumerate(text.splitlines(), start=1):
        if line.startswith("**"):
            keyword = line[2:].strip().upper()
            blocks.setdefault(keyword, [])
        elif line.strip() and not line.lstrip().startswith("!"):
            blocks.setdefault(keyword, []).append((i, line))
    return blocks


def _entry(i: int, line: str) -> Entry:
    return Entry(line[:10].strip().upper(), line[UNIT].strip(), line[VALUES], i)


def _data(file: str, rows: Sequence[tuple[int, str]], width: int) -> tuple[np.ndarray, list[int], list[Fault]]:
    """Numbers (n, width), the line of each row, and every row that is not as the channels say."""
    table, lines, faults = [], [], []
    for i, line in rows:
        words = line.split()
        if len(words) != width:
            faults.append(
                Fault(
                    file,
                    i,
                    None,
                    f"{len(words)} numbers, but {width} channels are defined",
                    "write one number for each channel",
                )
            )
            continue
        try:
            table.append([float(word) for word in words])
            lines.append(i)
        except ValueError:
            bad = next(w for w in words if not _is_number(w))
            faults.append(Fault(file, i, None, f"{bad!r} is not a number", "write a number"))
    if len(faults) > SHOWN:
        more = Fault(file, faults[SHOWN].line, None, f"{len(faults) - SHOWN} more rows like these", "correct them, too")
        faults = [*faults[:SHOWN], more]
    return np.array(table).reshape(-1, width), lines, faults


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _column(
    file: str, name: str, channel: Channel, constants: Sequence[Entry], channels: Sequence[Entry], data: np.ndarray
) -> tuple[np.ndarray | None, str]:
    """A quantity (n,) in SI and the paper's axes, measured or constant; None where it is not there and need not be."""
    for wanted in channel.names:
        for k, entry in enumerate(channels):
            if entry.name == wanted:
                gain, before, after = _conversion(file, entry)
                written = gain * (data[:, k] + before) + after
                return channel.sign * written * _factor(file, entry, channel.unit), wanted
    for wanted in channel.names:
        for entry in constants:
            if entry.name == wanted:
                value = _numbers(file, entry)[:1]
                if not value:
                    raise _Trouble(Fault(file, entry.line, wanted, "no value", "write one from column 53 on"))
                return np.full(len(data), channel.sign * value[0] * _factor(file, entry, channel.unit)), wanted
    if name not in MAY_LACK:
        fact = f"no {' or '.join(channel.names)} among channels and constants"
        raise _Trouble(Fault(file, None, channel.names[0], fact, "add it to **CONSTANTS or **MEASURCHANNELS"))
    return None, ""


def _conversion(file: str, entry: Entry) -> tuple[float, float, float]:
    numbers = _numbers(file, entry)
    gain, before, after = (*numbers, *(1.0, 0.0, 0.0)[len(numbers) :])[:3]
    return gain, before, after


def _numbers(file: str, entry: Entry) -> list[float]:
    try:
        return [float(word) for word in entry.rest.split()]
    except ValueError:
        raise _Trouble(
            Fault(file, entry.line, entry.name, f"{entry.rest.strip()!r} is no number", "write numbers from column 53 on")
        ) from None


def _factor(file: str, entry: Entry, unit: Unit) -> float:
    try:
        return factor(_WORDS.get(entry.unit, entry.unit), unit.name)
    except UnitError as error:
        raise _Trouble(Fault(file, entry.line, entry.name, error.fact, error.cure)) from None
