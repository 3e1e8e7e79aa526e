"""Where a run starts: what its first samples, its file and the chair say, and how sure that is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from ...campaign import Run
from ...campaign.channels import TELLS
from ...model.chassis import DEFAULTS
from ...model.frames import to_room, velocity_at
from .local import locals_of

START = ("start.x", "start.y", "start.psi", "start.u", "start.v", "start.psi_dot")
CASTERS = ("start.caster_l", "start.caster_r")  # of a model whose casters swing: nobody films them as a rule
POSE = START[:3]
MARKER = "effect.marker_offset."
START_SD = {"start.u": 0.02, "start.v": 0.05, "start.psi_dot": 0.1}  # about what a campaign file or first samples say
POSE_SD = 0.05
CASTER_SD = 0.3  # rad, of a chair at rest: as a rule it has rolled forward to where it stands
ROLLED = 0.1  # m/s; one that rolls faster had its casters behind it some trails ago, where nobody knows how far it has rolled
TRAIL = 0.05  # m over which a caster that stood aside comes back by e, c δ' = −v δ: a usual trail
TUNING = 2  # how often the start of each run is moved to where its readings want it


def starts_of(names: Iterable[str]) -> tuple[str, ...]:
    """Those of the names, a model's parameters or more, that say where a run starts."""
    there = set(names)
    return tuple(n for n in (*START, *CASTERS) if n in there)


def uncertain(run: Run, names: Sequence[str] = START) -> dict[str, float]:
    """Standard deviations of what is estimated of a run for itself: its start, then its clocks and baselines."""
    return {**start_sd(run, names), **{c.name: c.sd for c in locals_of(run)}}


def prior_start(run: Run, known: Mapping[str, float], names: Sequence[str] = START, rolls: bool = False) -> dict[str, float]:
    """Where a run is expected to start: as it is set, or else as its first samples and what is known say, and whether the chair
    `rolls` by then."""
    found = {name: run.first.get(channel.name, known.get(name, 0.0)) for name, channel in TELLS.items()}
    found = _of_the_cm(run, found, known)
    if run.u0 is not None:
        found["start.u"] = run.u0
    if rolls:
        found["start.v"] = known.get("start.v", known.get("chair.b", 0.0) * found["start.psi_dot"])  # the axle hardly slips
    return {name: run.set.get(name, found.get(name, known.get(name, 0.0))) for name in names}


def _of_the_cm(run: Run, found: dict[str, float], known: Mapping[str, float]) -> dict[str, float]:
    """The start of the CM, where position and speed were read at another point of the frame."""
    psi, turn = found["start.psi"], found["start.psi_dot"]
    lever = {
        "start.x": to_room(*_point("x", known), psi)[0],
        "start.y": to_room(*_point("y", known), psi)[1],
        "start.u": velocity_at(*_point("u", known), 0.0, 0.0, turn)[0],
    }
    return {name: value - lever.get(name, 0.0) * (TELLS[name].name in run.channels) for name, value in found.items()}


def _point(channel: str, known: Mapping[str, float]) -> tuple[float, float]:
    """Where a channel of motion capture is read: how far before the CM and to its right."""
    marker = {n.removeprefix(MARKER): v for n, v in known.items() if n.startswith(MARKER)}
    x, y = (marker.get(axis, 0.0) + marker.get(f"{channel}_{way}", 0.0) for axis, way in (("x", "ahead"), ("y", "right")))
    return x - marker.get("from_axle", 0.0) * known.get("chair.b", DEFAULTS["chair.b"]), y


def start_sd(run: Run, names: Sequence[str] = START) -> dict[str, float]:
    """Standard deviations of the above; what the run sets, and a pose that nobody measured, is as it is said to be. Casters may
    stand as they like where the chair does, and there it does not slide. A piece of a run starts in mid-stroke."""
    start = prior_start(run, {})
    rolled, moved = start["start.u"] / ROLLED, np.hypot(start["start.u"], DEFAULTS["chair.b"] * start["start.psi_dot"]) / ROLLED
    aside = 1 / (1 + rolled * rolled) if run.way is None else float(np.exp(-run.way / TRAIL))
    speed = {"start.u": run.u0_sd or START_SD["start.u"], "start.v": START_SD["start.v"] * float(1 - 1 / (1 + moved * moved))}
    pose = {name: POSE_SD if TELLS[name].name in run.channels else 0.0 for name in POSE}
    casters = dict.fromkeys(CASTERS, CASTER_SD * aside)
    return {name: 0.0 if name in run.set else {**pose, **START_SD, **speed, **casters}[name] for name in names}
