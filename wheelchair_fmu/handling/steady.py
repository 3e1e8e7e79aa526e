"""How a chair turns steadily: its gradients after ISO 4138, what a turn's limits are, its eigenvalues against speed.

ISO 4138 calls a car understeering where it needs more steering to hold its circle as it goes faster. A chair is steered by
the difference of two pushes, so here the steering is ΔF, and the chair

    understeers   where ΔF must grow with the lateral acceleration on a circle of constant radius,
    oversteers    where it must fall,
    is neutral    where it stays.

To first order  (∂ΔF/∂a_y)_R = m (b + C_mλ/C_λ) / t_r: a chair understeers because its CM lies before the axle, and tyres add
their pneumatic trail.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import Failure, UsageError
from .linearize import Linear, linearize
from .trim import MOTION, Chair, SteadyState, U, branch, crossing, outside, trim

HEIGHT = "effect.lateral_load_transfer.h"
SPENT = 0.9  # of the largest ΔF so far: where it falls so far the tyres are spent; as the inner wheel stops it dips by less
NEUTRAL = 0.05  # of (∂ ln ΔF/∂ ln u)_R; chosen: less than 4 % more push as the speed doubles


@dataclass(frozen=True)
class Gradients:
    """Gradients at a steady turn, SI units."""

    at_radius: float  # (∂ΔF/∂a_y)_R [N s²/m], ISO 4138's constant radius
    at_speed: float  # (∂ΔF/∂a_y)_u [N s²/m], its constant speed
    of_force: float  # (∂ ln ΔF/∂ ln u)_R [1], the first of these without units
    of_radius: float  # (∂ ln R/∂ ln u)_ΔF [1], its constant steering

    @property
    def character(self) -> str:
        if abs(self.of_force) < NEUTRAL:
            return "neutral"
        return "understeer" if self.of_force > 0 else "oversteer"


@dataclass(frozen=True)
class Limit:
    """Something that a turn must not exceed: `excess` of a steady state is negative where it does not."""

    name: str
    meaning: str
    excess: Callable[[SteadyState], float]


@dataclass(frozen=True, eq=False)
class Turns:
    """Steady turns at one speed from no difference of pushes into ever tighter ones; at `limit` is the last, or `why` says
    what else ends them."""

    states: tuple[SteadyState, ...]
    limit: Limit | None
    why: str = ""

    @property
    def last(self) -> SteadyState:
        return self.states[-1]


def gradients(state: SteadyState) -> Gradients:
    """By the implicit function theorem. Raises UsageError straight on or on the spot: no turn to judge."""
    if state.straight or not state.speed:
        raise UsageError("straight on or on the spot there is no turn to judge; give a --speed, and --delta-force or --radius")
    f_x, f_w = state.derivatives[3:5]
    by_z = np.hstack([f_x[U:, MOTION:], f_w[U:] @ state.chair.pushes[:, :1]])
    by_u, by_force = f_x[U:, U], f_w[U:] @ state.chair.pushes[:, 1]
    (v_u, v_F), (r_u, r_F) = np.linalg.solve(by_z, -np.column_stack([by_u, by_force]))[:2]
    u, v, r = state.speed, state.v, state.psi_dot
    path = np.hypot(u, v)

    def curvature(dv: float, dr: float, du: float) -> float:
        return dr / path - r * (u * du + v * dv) / path**3

    k_u, k_F = curvature(v_u, r_u, 1.0), curvature(v_F, r_F, 0.0)
    force_u = -k_u / k_F  # dΔF/du on the circle
    a_u = r + u * (r_u + r_F * force_u)  # a_y = u ψ' on the circle
    with np.errstate(divide="ignore"):  # wheels that lean turn the chair without ΔF
        of_force = force_u * u / np.float64(state.delta_force)
    return Gradients(float(force_u / a_u), float(1 / (u * r_F)), float(of_force), float(-k_u * path / r * u))


def limits(chair: Chair, slip: float) -> tuple[Limit, ...]:
    """The limits of a turn: a `slip` angle [rad] of the rear tyres, friction, and where load shifts a wheel that lifts."""
    mu = chair.value("tyre.mu")
    shifts = HEIGHT in chair.parameters and chair.value(HEIGHT) > 0

    def slipping(state: SteadyState) -> float:
        return max(abs(state.results[f"slip.{side}"]) for side in ("rl", "rr")) - slip

    def sliding(state: SteadyState) -> float:
        forces = [(abs(state.results[f"force.F_s{side}"]), state.results[f"load.{side}"]) for side in ("rl", "rr")]
        return max(force - mu * load for force, load in forces)

    def lifting(state: SteadyState) -> float:
        return -min(state.results[f"load.{wheel}"] for wheel in ("rl", "rr", "fl", "fr"))

    found = (
        Limit("slip", f"a rear tyre slips by {np.degrees(slip):g}°", slipping),
        Limit("friction", f"a rear tyre's lateral force is μ N, μ = {mu:g}", sliding),
    )
    return (*found, Limit("lift", "a wheel lifts", lifting)) if shifts else found


def turns(chair: Chair, speed: float, bounds: Sequence[Limit], right: bool = True) -> Turns:
    """The steady turns at `speed` up to the first of the limits, as long as ΔF grows and the model holds."""
    states: list[SteadyState] = []
    for state in branch(chair, speed, right):
        if why := outside(state):
            return Turns(tuple(states), None, why)
        most = max(range(len(states)), key=lambda i: abs(states[i].delta_force), default=0)
        if states and abs(state.delta_force) < SPENT * abs(states[most].delta_force):
            return Turns(tuple(states[: most + 1]), None, "what resists the turn gives no more")
        met = [b for b in bounds if b.excess(state) >= 0]
        if met and not states:
            return Turns((state,), met[0])
        if met:
            ends = [(crossing(states[-1], state, b.excess), b) for b in met]
            last, limit = min(ends, key=lambda end: _way(states[-1], end[0]))
            return Turns((*states, last), limit)
        states.append(state)
    return Turns(tuple(states), None, "the equations end there")


def _way(before: SteadyState, after: SteadyState) -> float:
    return float(np.linalg.norm((after.z - before.z) / after.chair.scale))


def root_locus(chair: Chair, speeds: Iterable[float], delta_force: float, *, free_speed: bool = False) -> list[Linear]:
    """The chair linearised at each speed in turn under the same ΔF, up to the first that has no such steady turn."""
    found: list[Linear] = []
    for speed in speeds:
        try:
            state = trim(chair, speed, delta_force, near=found[-1].trim if found else None)
        except Failure:
            break
        found.append(linearize(state, free_speed=free_speed))
    return found
