"""Whether casters may swing round in a run: whether a pivot moves against the way that its wheel points.

A caster that trails comes to heel, and whatever disturbs it dies out over a way of its trail. One that leads, as where a chair
backs up, or turns on the spot and back, stands as a pencil on its tip: what disturbs it grows by e over each such way, until
it has swung round.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import atan, exp, pi, remainder, tan, tau

import numpy as np

from ...campaign import Run
from ...campaign.channels import SIDES
from ...campaign.moving import smooth
from ...model.chassis import DEFAULTS
from .initial_state import CASTERS, TRAIL

ROLLS = 0.05  # m/s: a pivot that is slower goes no way that sensors tell
LEADS = pi / 2  # rad by which a pivot's way is off the way that its wheel points, from which on the caster leads


def may_swing_round(run: Run, known: Mapping[str, float]) -> bool:
    """By how the chair rolls and turns, what is `known` of it, and how its casters start, which is as they stand in a chair
    that has rolled forward, if nobody says otherwise. So may those of a run that does not tell how it rolls and turns."""
    a, b, t_r, t_f = (known.get(n, DEFAULTS[n]) for n in ("chair.a", "chair.b", "chair.t_r", "chair.t_f"))
    told = _rolls_and_turns(run, t_r)
    if told is None:
        return True
    (u, r), dt = told, np.gradient(run.time)
    starts = [known.get(name, 0.0) for name in CASTERS]
    pivots = zip((1, -1), starts, strict=True)
    return any(_most_off(u + side * r * t_f / 2, (a + b) * r, r, dt, start) > LEADS for side, start in pivots)


def _rolls_and_turns(run: Run, t_r: float) -> tuple[np.ndarray, np.ndarray] | None:
    """Speed (n,) in m/s and yaw rate (n,) in rad/s, by both wheels, or else as they were measured."""
    left, right, u, r = (smooth(run, name) for name in (*SIDES, "u", "yaw_rate"))
    if left is not None and right is not None:
        return (left + right) / 2, (left - right) / t_r
    return None if u is None or r is None else (u, r)


def _most_off(ahead: np.ndarray, aside: np.ndarray, r: np.ndarray, dt: np.ndarray, start: float) -> float:
    """The most (rad) by which the way of a pivot, which moves `ahead` and `aside` (n,) in a chair that turns by r (n,), is off
    the way that its wheel points, which is `start` at first. It rolls without slip, c δ' = v sin φ − c r, with φ from where it
    points to where its pivot goes."""
    speeds, turns = np.hypot(ahead, aside), r * dt
    points, most = start, 0.0
    moments = zip(
        np.arctan2(aside, ahead).tolist(), speeds.tolist(), (speeds * dt / TRAIL).tolist(), turns.tolist(), strict=True
    )
    for towards, speed, way, turn in moments:
        off = remainder(towards - points, tau)
        if speed > ROLLS:
            most = max(most, abs(off))
        points = towards - 2 * atan(tan(off / 2) * exp(-way)) - turn
    return most
