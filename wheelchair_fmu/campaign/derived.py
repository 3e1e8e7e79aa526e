"""The chair's pose from markers at the ends of its rear axle, and the rider's motion against it from those on the body."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from ..faults import Fault, run_fault, suggestion
from ..tables import Table
from ..units import UnitError, factor, split
from . import body
from .angles import TURN, unwrapped
from .devices import Part

ENDS = ("axle_l", "axle_r")  # markers on the rear axle
ROOM = ("x", "y")


_COORDINATE = re.compile(r"(.+?)\s*[._ -]\s*([xyz])", re.IGNORECASE)


def coordinate(header: str) -> tuple[str, str] | None:
    """The marker and the axis, in small letters, that a header is of: LHUB.x, LHUB_X [mm] or LHUB X; None if of none."""
    found = _COORDINATE.fullmatch(split(header)[0].strip())
    return (found[1].lower(), found[2].lower()) if found else None


def marker_columns(part: Part, table: Table) -> tuple[dict[str, tuple[int, float]], list[Fault]]:
    """Places and factors to m of the columns that the device's markers need, by "axle_l.x" and so on; and what is missing."""
    found: dict[str, tuple[int, float]] = {}
    faults: list[Fault] = []
    wanted = [*ENDS, *(name for name in body.MARKERS if name in part.device.markers)]
    for end in wanted if part.device.markers else ():
        for room, (axis, sign) in _room(part).items():
            marker = part.device.markers.get(end, end)
            name = f"{marker}.{axis}"
            sought = marker.lower(), axis
            at = next((i for i, h in enumerate(table.headers) if coordinate(h) == sought), None)
            if at is None:
                fact = f"no column {name!r} (nor '{marker}_{axis}') for the marker {end}"
                faults.append(run_fault(part.file, fact, suggestion(name, table.headers), 1))
                continue
            try:
                found[f"{end}.{room}"] = at, sign * _metres(end, table, at)
            except UnitError as error:
                faults.append(run_fault(part.file, error.fact, error.cure, 1, table.headers[at]))
    whole = all(f"{end}.{room}" in found for end in ENDS for room in ROOM)
    return (found, faults) if whole else ({}, faults)


def _metres(end: str, table: Table, at: int) -> float:
    """By what a marker's column becomes metres. Raises UnitError, also where there is no unit: most cameras count in mm."""
    unit = table.units[at]
    if not unit:
        cure = f"write the header as '{split(table.headers[at])[0]} [mm]', or with the unit it has"
        raise UnitError(f"the marker {end} is read from it, but it gives no unit", cure)
    return factor(unit, "m")


def pose(markers: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """x, y and yaw (n,) of the middle of the rear axle from markers at its ends, in m by "axle_l.x" and so on.

    They are not moved to the centre of mass by the b that was given: readings that hold that value would make it look as if
    it had been measured with them.
    """
    if not markers:
        return {}
    left, right = (np.stack([markers[f"{end}.{axis}"] for axis in ROOM]) for end in ENDS)
    across, middle = right - left, (right + left) / 2  # the axle points to the right
    return {"x": middle[0], "y": middle[1], "yaw": unwrapped(np.arctan2(-across[0], across[1]), TURN)}


def position(
    part: Part, markers: Mapping[str, np.ndarray], time: np.ndarray | None, yaw: np.ndarray | None
) -> np.ndarray | None:
    """How far (n,) the rider's body has moved forward against the frame; None where no marker is on it."""
    names = [name for name in body.MARKERS if name in part.device.markers and f"{name}.x" in markers]
    if not names or time is None or yaw is None:
        return None
    ends = [body.by_each_other(time, markers[f"axle_l.{room}"], markers[f"axle_r.{room}"]) for room in ROOM]
    middle = [0.5 * (left + right) for left, right in ends]
    yaw = np.interp(time, time[np.isfinite(yaw)], yaw[np.isfinite(yaw)]) if np.isfinite(yaw).any() else yaw
    forward = np.cos(yaw), np.sin(yaw)

    def ahead(name: str) -> np.ndarray:
        return np.asarray(sum(f * (markers[f"{name}.{room}"] - m) for f, room, m in zip(forward, ROOM, middle, strict=True)))

    return body.position(time, {name: ahead(name) for name in names})


def _room(part: Part) -> dict[str, tuple[str, float]]:
    """Which of the laboratory's axes is the room's x and y, and its sign."""
    given = part.device.marker_axes
    words = {room: str(given.get(room, room)).strip() for room in ROOM}
    return {room: (word.lstrip("+-"), -1.0 if word.startswith("-") else 1.0) for room, word in words.items()}
