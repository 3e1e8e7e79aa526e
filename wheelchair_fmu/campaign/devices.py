"""Who recorded what: the devices of a campaign, and the files of each run that are theirs.

::

    [[recording]]                 how a device's files are read, once
    device = "imu"
    format = "csv"
    at = [0.21, 0.04]
    columns.yaw_rate = "Gyroscope Z"

    [[run]]                       which of its files belongs to a run, and how its clock stands
    files = { imu = "run01_imu.csv", wheels = "run01_wheels.csv" }
    clocks = { imu = { offset = 0.412, sd = 0.002 } }

A run with `file` has one device without a name, which is read as the campaign's [columns] and the run itself say.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from .document import Document, Entry, number
from .formats import known_options

FASTEST = 0.1  # s/s that a clock drifts; the oscillators inside inertial sensors are off by some hundredths at most


@dataclass(frozen=True)
class Clock:
    """The run's time = file time · (1 + drift) + offset, in s; `sd` is the standard deviation of what may be left of it."""

    offset: float = 0.0
    sd: float = 0.0
    drift: float = 0.0


@dataclass(frozen=True)
class Device:
    """How the files of one device are read. `path` is where its [columns] stand in campaign.toml, `place` which
    [[recording]] it is, None for a run of one file; `at` is where it sits on the chair, (x forward, y right) of the centre of
    mass in m, None where that is not said."""

    name: str
    path: str = "columns"
    place: int | None = None
    columns: Mapping[str, Any] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)
    axes: str = ""
    radius: float | None = None
    at: tuple[float, float] | None = None
    markers: Mapping[str, str] = field(default_factory=dict)
    marker_axes: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Part:
    """One file of a run: which device's it is, and how its clock stands in this run."""

    entry: Entry
    device: Device
    file: str
    clock: Clock = Clock()

    @property
    def alone(self) -> bool:
        """Is this the run's only file?"""
        return not self.device.name


def devices(doc: Document) -> dict[str, Device]:
    """The devices that [[recording]] describes, by name. What is wrong in them reads as absent, and a check says so."""
    found: dict[str, Device] = {}
    for place, table in enumerate(doc.recordings):
        name = table.get("device")
        if isinstance(name, str) and name and name not in found:
            found[name] = _device(doc, name, place, table)
    return found


def parts(doc: Document, entry: Entry) -> list[Part]:
    """The files of a run, in the order in which campaign.toml names them."""
    named = entry.table("files")
    if not named:
        return [Part(entry, _nameless(doc, entry), entry.file)] if entry.file else []
    known = devices(doc)
    return [
        Part(entry, known.get(name, Device(name)), file, clock(entry, name))
        for name, file in named.items()
        if isinstance(file, str) and file
    ]


def clock(entry: Entry, device: str) -> Clock:
    """How a device's clock stands in a run: `clocks = { imu = 0.41 }`, or with offset, sd and drift. What no clock can be, of
    which checks/document.py tells, is left out, so that nothing else seems wrong for it."""
    given = entry.table("clocks").get(device)
    if isinstance(given, Mapping):
        offset, sd, drift = (number(given.get(key)) or 0.0 for key in ("offset", "sd", "drift"))
        return Clock(offset, max(sd, 0.0), drift if abs(drift) <= FASTEST else 0.0)
    return Clock(number(given) or 0.0)


def _device(doc: Document, name: str, place: int, table: Mapping[str, Any]) -> Device:
    columns, markers = table.get("columns"), table.get("markers")
    axes = table.get("axes")
    return Device(
        name,
        "recording.columns",
        place,
        columns if isinstance(columns, Mapping) else {},
        {k: v for k, v in table.items() if k not in OWN_KEYS},
        axes if isinstance(axes, str) else doc.axes,
        number(table.get("radius")) or number(doc.table("wheel").get("R")),
        point(table.get("at")),
        {k: v for k, v in markers.items() if isinstance(v, str)} if isinstance(markers, Mapping) else {},
        axes if isinstance(axes, Mapping) else {},
    )


def _nameless(doc: Document, entry: Entry) -> Device:
    options = {k: entry.data[k] for k in ("format", *known_options()) if k in entry.data}
    return Device("", columns=doc.table("columns"), options=options, axes=doc.axes, radius=number(doc.table("wheel").get("R")))


def point_of(entry: Any) -> tuple[float, float] | None:
    """What `sensor.<channel>.at` says; None where it says nothing."""
    return point(entry.get("at")) if isinstance(entry, Mapping) else None


def point(value: Any) -> tuple[float, float] | None:
    """[x, y] as two numbers; None for anything else."""
    if isinstance(value, list) and len(value) == 2:
        x, y = map(number, value)
        if x is not None and y is not None:
            return x, y
    return None


OWN_KEYS = ("device", "columns", "markers", "axes", "radius", "at", "description")  # the others are options of the format
