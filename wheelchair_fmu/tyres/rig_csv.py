"""Rig data as CSV: a row for each measurement, headers `name [unit]`, as in measurements/rotating-disc.csv.

Needed are pressure, load, slip_angle and lateral_force; disc_speed, yaw_torque, camber_angle, tyre and test may be there.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..faults import WARNING, Fault, suggestion
from ..quantities import BAR, M_S, N_M, RAD, N
from ..tables import CsvTable, read_csv
from ..units import UnitError, factor, split
from .records import KINDS, KM_H
from .rows import NEEDED, USUAL_SPEED, Rows

UNITS = {
    "pressure": BAR,
    "load": N,
    "disc_speed": M_S,
    "slip_angle": RAD,
    "camber_angle": RAD,
    "lateral_force": N,
    "yaw_torque": N_M,
}
WORDS = ("tyre", "test")


def read_rig(path: Path, raw: bytes) -> tuple[Rows | None, list[Fault]]:
    """The rows of a CSV file, and all its faults; None where there are no rows to speak of."""
    table, faults = read_csv(path.name, raw)
    faults = [_plain(f) for f in faults]
    if table is None:
        return None, faults
    places, met = _places(table)
    faults += met
    if any(f.severity != WARNING for f in met):
        return None, faults
    read = table.rows([i for i, _ in places.values()])
    faults += [_plain(f) for f in read.faults]
    columns = {name: read.values[i] * scale for name, (i, scale) in places.items()}
    n = len(next(iter(columns.values())))
    if "disc_speed" not in columns:
        columns["disc_speed"] = np.full(n, USUAL_SPEED)
        faults.append(
            Fault(
                path.name,
                table.header_line,
                None,
                f"no column 'disc_speed', {USUAL_SPEED / KM_H:g} km/h assumed",
                "add one named 'disc_speed [km/h]'",
                WARNING,
            )
        )
    line = np.zeros(n, int) if read.lines is None else read.lines
    headers = {name: table.headers[i] for name, (i, _) in places.items()}
    words = {w: table.words(table.headers.index(w)) if w in table.headers else None for w in WORDS}
    faults += _tests(path.name, words["test"], line)
    gaps = {(f.line, f.column) for f in faults}
    rows = Rows(path.name, words["tyre"] or [path.stem] * n, columns, line, headers)
    return rows, [*faults, *(f for f in rows.faults() if (f.line, f.column) not in gaps)]


def _places(table: CsvTable) -> tuple[dict[str, tuple[int, float]], list[Fault]]:
    """Where each column stands, and its factor to SI."""
    found: dict[str, tuple[int, float]] = {}
    faults = []
    names = [split(h)[0] for h in table.headers]
    for name, unit in UNITS.items():
        places = [i for i, own in enumerate(names) if own == name]
        if len(places) > 1:
            faults.append(
                Fault(table.file, table.header_line, name, "the column stands there more than once", "remove all but one")
            )
        if places:
            header = table.headers[places[0]]
            written = split(header)[1]
            if written is None:
                fact, cure = f"no unit given, {unit.name} assumed", f"write the header as '{name} [{unit.name}]'"
                faults.append(Fault(table.file, table.header_line, header, fact, cure, WARNING))
            try:
                found[name] = places[0], 1.0 if written is None else factor(written, unit.name)
            except UnitError as error:
                faults.append(Fault(table.file, table.header_line, header, error.fact, error.cure))
        elif name in NEEDED:
            faults.append(
                Fault(
                    table.file,
                    table.header_line,
                    None,
                    f"no column {name!r}",
                    f"add one named '{name} [{unit.name}]'; this file has {', '.join(table.headers)}",
                )
            )
    unused = [h for h, own in zip(table.headers, names, strict=True) if own not in (*UNITS, *WORDS)]
    for header in unused:
        faults.append(
            Fault(
                table.file,
                table.header_line,
                header,
                "the column is not used",
                suggestion(split(header)[0], (*UNITS, *WORDS)),
                WARNING,
            )
        )
    return found, faults


def _tests(file: str, tests: list[str] | None, line: np.ndarray) -> list[Fault]:
    """Words in the column `test` that name no test."""
    return [
        Fault(file, int(i) or None, "test", f"{word!r} is no test", f"write {' or '.join(map(repr, KINDS))}")
        for word, i in zip(tests or (), line, strict=tests is not None)
        if word.replace("_", " ").lower() not in KINDS
    ]


def _plain(fault: Fault) -> Fault:
    """A fault of this file, which is no run of a campaign."""
    return Fault(fault.file, fault.line, fault.column, fault.fact, fault.cure, fault.severity)
