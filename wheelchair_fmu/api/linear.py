"""The chair linearised about a steady turn."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import UsageError
from ..fmu.build import with_chosen_effects
from ..handling.linearize import linearize as linearised
from ..handling.trim import Chair, SteadyState, trim
from .variants import Values, Variant, chair_of

if TYPE_CHECKING:
    from control import StateSpace

OPTION_FOR = {"speed.u": "speed", "start.u": "speed", "speed.mode": "free-speed"}
PUSHED = 10.0  # N, of ΔF where nothing else is asked for


def linearize(
    speed: float = 1.0,
    delta_force: float | None = None,
    radius: float | None = None,
    *,
    free_speed: bool = False,
    variant: Variant | str | Path | None = None,
    values: Values | None = None,
    effects: str | Sequence[str] = "default",
    equations: str | None = None,
) -> StateSpace:
    """Find a steady turn and return small motions about it, exact, as python-control's StateSpace.

    The turn is at forward `speed` [m/s] under `delta_force` [N] (10 N unless given; F_rl − F_rr = 2ΔF, positive turns right),
    or on a circle of `radius` [m] (positive to the right, infinite straight on). States are the lateral speed `v` [m/s], the
    yaw rate `psi_dot` [rad/s] and those of active effects, with `free_speed` also `u` [m/s] by equation (20) of the paper;
    inputs and outputs go by their FMI names, with _ for every dot. `variant`, `values`, `effects` and `equations` are as in
    `simulate`.

    Raises UsageError for what cannot be asked, and Failure where there is no such turn, with the nearest that exists.

    >>> chair = wc.linearize(speed=1.0, delta_force=10.0)
    >>> chair.state_labels, bool((chair.poles().real < 0).all())
    (['v', 'psi_dot'], True)
    """
    chair = steady_chair(values or {}, variant, effects, equations)
    return linearised(turn(chair, speed, delta_force, radius), free_speed=free_speed).state_space()


def steady_chair(
    values: Values, variant: Variant | str | Path | None, effects: str | Sequence[str], equations: str | None
) -> Chair:
    """The chair asked for, ready to be balanced. Raises UsageError for a value that another option decides."""
    for name, option in OPTION_FOR.items():
        if name in values:
            raise UsageError(f"{name} = {values[name]}: here --{option} decides that; give --{option}")
    chair, chosen = chair_of(variant, values, effects, equations)
    return Chair(with_chosen_effects(chair, chosen))


def turn(chair: Chair, speed: float, delta_force: float | None, radius: float | None) -> SteadyState:
    """The steady state asked for; ΔF = PUSHED unless a radius is given."""
    return trim(chair, speed, PUSHED if delta_force is None and radius is None else delta_force, radius)
