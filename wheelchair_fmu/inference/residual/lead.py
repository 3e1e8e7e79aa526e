"""What to measure next where something is left that no effect explains: the run or the sensor that would say most about it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..estimation.calibration import Calibrated
from .unexplained import CONSTANT, Unexplained

# By what orders the missing force: what to do, and why.
LEADS = {
    CONSTANT: (
        "coast-downs with hands off, both ways along the hall",
        "what is the same both ways belongs to the chair, and what changes its sign to the floor",
    ),
    "speed": (
        "a coast-down with hands off from twice the usual speed",
        "with nobody pushing, what goes with the speed stands alone",
    ),
    "yaw rate": (
        "spins on the spot both ways, and circles of two radii",
        "at one yaw rate they have different speeds and side forces",
    ),
    "heading": ("the same runs the other way along the hall", "a slope of the floor pulls the other way then"),
    "push": (
        "a weight hung from each push rim, and hard strokes with hands off after them",
        "the weight checks the force sensors, and what goes with the push is gone with the hands",
    ),
    "stroke": (
        "one of these runs with markers or an inertial sensor on the trunk, read as rider.momentum or rider.s",
        "the force comes back with every stroke, as that of a moving body does",
    ),
    "caster angle": (
        "a start with the casters turned, with a camera on their forks",
        "nothing else says when and how they swing",
    ),
    "time": ("the same run three times, with a rest of ten minutes between", "what warms or tires begins anew after a rest"),
    "left wheel's angle": (
        "two coast-downs, with the left tyre turned by half a turn on its rim in between",
        "what comes back with every turn moves with the tyre, or stays with the wheel",
    ),
    "right wheel's angle": (
        "two coast-downs, with the right tyre turned by half a turn on its rim in between",
        "what comes back with every turn moves with the tyre, or stays with the wheel",
    ),
    "run": ("that run again", "what happened only once will not come back"),
}
NOTHING = (
    "one of these runs twice on the same line of the floor, and once beside it",
    "what comes back at the same place is the floor's, and what does not is the rider's or chance",
)


def lead(values: Sequence[Calibrated], left: Unexplained | None) -> dict[str, Any]:
    """The next experiment, by values that calibration bent as far as it may, else by what orders the missing force most. `gain`
    is the share of that force's mean square which it would be about; None where nobody can say."""
    bent = [v.record.name for v in values if v.beyond]
    if bent:
        it, them = ("it", "it") if len(bent) == 1 else ("they", "them")
        return _experiment(
            f"{' and '.join(bent)} measured again",
            f"{it} came out as nobody would have measured {them}, so that is wrong, or something is missing",
        )
    order = left.orders[0] if left and left.orders else None
    if order is None:
        return _experiment(*NOTHING)
    what, why = LEADS[order.by]
    return _experiment(what, f"{why}; {order.words}", order.share)


def _experiment(what: str, why: str, gain: float | None = None) -> dict[str, Any]:
    return {"manoeuvre": what, "separates": [], "repeats": 1, "why": why, "gain": gain}
