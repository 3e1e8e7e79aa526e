"""Steady states: a chair held at a speed by a total push, and turned by F_rl − F_rr = 2ΔF.

The unknowns are the lateral speed, the yaw rate and what effects bring along, with the total push F = F_rl + F_rr and
the difference: z = (v, ψ', …, F, ΔF). The equations are the rows of M x' = f without the pose, at x' = 0. That is one
equation short: steady states lie on a curve, which is followed from straight on until it meets what is asked.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from math import floor, hypot, inf, isnan, log10, trunc

import casadi as cs
import numpy as np

from ..errors import Failure, UsageError
from ..model.chassis import PUSH_LIMIT
from ..model.variant import Variant
from .continuation import Equations, NoSolutionError, follow, newton
from .dense import DenseFunction
from .manoeuvres import TOP_SPEED

PSI, U = 2, 3  # places of ψ and u among the states, of which x, y, ψ are the pose
PRESCRIBED = 2.0  # of speed.mode
MOTION = U + 1  # and of the first that is unknown in a steady state
SIZES = {"v": 0.2, "psi_dot": 1.0}  # of a strong turn, so that steps along the curve are even
PUSH_SIZE = 20.0  # N
FASTEST = 50.0  # rad/s, the model's bound for start.psi_dot
MOST_POINTS = 3000
LEVEL = 1e-6  # N or N m per rad: what changes less with the heading does not change
STRAIGHT = 1e-9  # rad/s; less is no turn

Goal = Callable[[float, np.ndarray], tuple[float, np.ndarray]]  # speed, z (nz,) → what shall vanish, its gradient (nz,)


class Chair:
    """A variant's equations and values, ready to be balanced and linearised."""

    def __init__(self, variant: Variant):
        self.variant = variant.with_values({"speed.mode": "free"})  # so that (20) has to balance too
        self.model = m = self.variant.model()
        self.p = self.variant.vector()
        self.parameters = tuple(q.name for q in m.parameters)
        jacobians = [cs.jacobian(e, v) for e in (m.f, m.y) for v in (m.x, m.w, m.p)]
        tilts = cs.jacobian(cs.jacobian(m.f[U:], m.x[PSI]), m.p)
        self._all = DenseFunction("all", [m.x, m.w, m.p], [m.f, m.y, m.mass, *jacobians, tilts])
        self._some = DenseFunction("some", [m.x, m.w, m.p], [m.f, *jacobians[:2]])
        self._start = DenseFunction("start", [m.p, m.w], [m.start])
        names = [i.name for i in m.inputs]
        self.still = np.array([i.start for i in m.inputs])  # inputs (nw,) without pushes
        self.pushes = np.zeros((len(names), 2))  # what (F, ΔF) adds to them
        self.pushes[[names.index("push.F_rl"), names.index("push.F_rr")]] = (0.5, 1.0), (0.5, -1.0)
        sizes = [SIZES.get(s.name, s.nominal) for s in m.states for _ in s.names][MOTION:]
        self.scale = np.array([*sizes, PUSH_SIZE, PUSH_SIZE])

    def value(self, parameter: str) -> float:
        return float(self.p[self.parameters.index(parameter)])

    def state(self, speed: float, z: np.ndarray) -> SteadyState:
        """The motion that the unknowns z (nz,) stand for."""
        x = np.concatenate([[0.0, 0.0, self.value("start.psi"), speed], z[:-2]])
        return SteadyState(self, x, self.still + self.pushes @ z[-2:], z)

    def equations(self, speed: float) -> Equations:
        """What vanishes in a steady state: z (nz,) → values (nz − 1,) and their Jacobian."""

        def equations(z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            state = self.state(speed, z)
            f, f_x, f_w = self._some(state.x, state.w, self.p)
            return f[U:, 0], np.hstack([f_x[U:, MOTION:], f_w[U:] @ self.pushes])

        return equations

    def at_rest(self, speed: float) -> np.ndarray:
        """z (nz,) before it is balanced: no sideways motion, no turn, no push."""
        names = ("start.u", "start.v", "start.psi_dot")
        p = self.p.copy()
        p[[self.parameters.index(n) for n in names]] = speed, 0.0, 0.0
        return np.concatenate([self._start(p, self.still)[0][MOTION:, 0], [0.0, 0.0]])


@dataclass(frozen=True, eq=False)
class SteadyState:
    """States x (nx,), inputs w (nw,) and unknowns z (nz,) of a chair whose velocities do not change."""

    chair: Chair
    x: np.ndarray
    w: np.ndarray
    z: np.ndarray

    @property
    def speed(self) -> float:
        return float(self.x[U])

    @property
    def v(self) -> float:
        return float(self.z[0])

    @property
    def psi_dot(self) -> float:
        return float(self.z[1])

    @property
    def delta_force(self) -> float:
        return float(self.z[-1])

    @property
    def curvature(self) -> float:
        """1/R_c [1/m] by (23), positive to the right."""
        path = hypot(self.speed, self.v)
        return self.psi_dot / path if path else inf

    @property
    def straight(self) -> bool:
        return abs(self.psi_dot) <= STRAIGHT

    @property
    def radius(self) -> float:
        """R_c [m], infinite straight on."""
        return inf if self.straight or not self.curvature else 1 / self.curvature

    @cached_property
    def derivatives(self) -> list[np.ndarray]:
        """f, y and the diagonal of M, (n, 1) each, the Jacobians of f and of y by x, w and p, and ∂(∂f/∂ψ)/∂p."""
        return self.derivatives_with(self.chair.p)

    @cached_property
    def derivatives_held(self) -> list[np.ndarray]:
        """The same for a chair whose speed is prescribed."""
        p = self.chair.p.copy()
        p[self.chair.parameters.index("speed.mode")] = PRESCRIBED
        return self.derivatives_with(p)

    def derivatives_with(self, p: np.ndarray) -> list[np.ndarray]:
        return self.chair._all(self.x, self.w, p)

    @cached_property
    def results(self) -> dict[str, float]:
        """Every output by its FMI name, SI units."""
        return dict(zip((o.name for o in self.chair.model.outputs), self.derivatives[1][:, 0].tolist(), strict=True))


def trim(
    chair: Chair, speed: float, delta_force: float | None = None, radius: float | None = None, near: SteadyState | None = None
) -> SteadyState:
    """The steady state at `speed` [m/s] under `delta_force` [N], or on a circle of `radius` [m]: > 0 right, inf straight.

    Of several it is the first on the way from straight on, or the one that Newton's method finds from `near`.

    Raises UsageError for what cannot be asked, and Failure where there is none, with the nearest that exists.
    """
    _refuse(chair, speed, delta_force, radius)
    goal = _pushed(delta_force) if radius is None and delta_force is not None else _circled(radius or inf)
    if near is not None:
        try:
            return _level(_solved(chair, speed, near.z, goal))
        except NoSolutionError:
            pass  # the way from straight on may still lead there
    return _level(_reached(chair, speed, goal, f"ΔF = {delta_force:g} N" if radius is None else f"a radius of {radius:g} m"))


def branch(chair: Chair, speed: float, right: bool = True) -> Iterator[SteadyState]:
    """Steady states at `speed` from no difference of pushes into ever tighter turns; where to stop, `outside` says.

    Raises Failure where there is not even the first.
    """
    try:
        start = _solved(chair, speed, chair.at_rest(speed), _pushed(0.0))
    except NoSolutionError:
        raise Failure(
            f"no steady state at {speed:g} m/s, not even without a difference of pushes; try another speed or smaller effects"
        ) from None
    towards = np.zeros(len(start.z))
    towards[-1] = 1.0 if right else -1.0
    points = follow(chair.equations(speed), start.z, chair.scale, towards)
    return (chair.state(speed, z) for _, z in zip(range(MOST_POINTS), points, strict=False))


def outside(state: SteadyState) -> str:
    """Why the model no longer holds here, if it does not."""
    if abs(state.psi_dot) > FASTEST or abs(state.v) > TOP_SPEED:
        return f"there the chair spins at {state.psi_dot:.3g} rad/s"
    if np.abs(state.w).max() > PUSH_LIMIT:
        return f"that takes more than the model's {PUSH_LIMIT:g} N at a wheel"
    widest = max(state.chair.value("chair.t_r"), state.chair.value("chair.t_f"))
    if state.chair.variant.choice.equations == "paper" and state.speed <= abs(state.psi_dot) * widest / 2:
        return "the paper's equations hold only while every wheel rolls forward, and the inner one stands still there"
    return ""


def crossing(before: SteadyState, after: SteadyState, excess: Callable[[SteadyState], float]) -> SteadyState:
    """Between two neighbours on a branch, where `excess` changes its sign; by bisection, to 1e-9 of the unknowns' sizes."""
    chair, speed = before.chair, before.speed
    negative = excess(before) < 0
    while np.abs((after.z - before.z) / chair.scale).max() > 1e-9:
        middle = _solved(chair, speed, 0.5 * (before.z + after.z), _between(before, after))
        before, after = (middle, after) if (excess(middle) < 0) == negative else (before, middle)
    return after


def _reached(chair: Chair, speed: float, goal: Goal, asked: str) -> SteadyState:
    """The first state on the way from straight on that meets the goal."""

    def excess(state: SteadyState) -> float:
        return goal(speed, state.z)[0]

    states = branch(chair, speed)
    nearest = before = next(states)
    if excess(before) > 0:
        states = branch(chair, speed, right=False)
    why = "the steady turns cannot be followed further"
    for after in states:
        if reason := outside(after):
            why = reason
            break
        if excess(before) * excess(after) <= 0:
            return _solved(chair, speed, crossing(before, after, excess).z, goal)
        nearest = min(nearest, after, key=lambda s: abs(excess(s)))
        before = after
    if nearest is not before:
        why = "what resists the turn gives no more than that, and the chair would turn ever faster"
    raise Failure(
        f"no steady turn at {speed:g} m/s with {asked}: {why}; the nearest has "
        f"ΔF = {_towards_zero(nearest.delta_force):g} N and a radius of {nearest.radius:.4g} m"
    )


def _towards_zero(value: float) -> float:
    """To four digits, so that what is named exists."""
    if not value:
        return 0.0
    unit = 10.0 ** (floor(log10(abs(value))) - 3)
    return round(trunc(value / unit) * unit, 12)


def _refuse(chair: Chair, speed: float, delta_force: float | None, radius: float | None) -> None:
    if (delta_force is None) == (radius is None):
        raise UsageError("a steady turn has a difference of pushes or a radius; give one of --delta-force and --radius")
    if not abs(speed) <= TOP_SPEED:  # written so that NaN is refused too
        raise UsageError(f"--speed {speed:g} m/s is outside ±{TOP_SPEED:g} m/s; give a speed between them")
    if delta_force is not None and not abs(delta_force) <= PUSH_LIMIT:
        raise UsageError(f"--delta-force {delta_force:g} N is outside ±{PUSH_LIMIT:g} N; give a force between them")
    if radius is not None and (isnan(radius) or radius == 0):
        raise UsageError(f"--radius {radius:g} m is no turn; give a number, > 0 to the right, or inf for straight on")
    if chair.variant.choice.equations == "paper" and speed <= 0:
        raise UsageError(
            f"--speed {speed:g} m/s: the paper divides by the forward speed; give one above 0, or --equations extended"
        )
    if radius is not None and speed == 0:
        raise UsageError("--speed 0 with --radius: a spin on the spot has no radius to choose; give --delta-force")


def _level(state: SteadyState) -> SteadyState:
    """The state, where it stays steady as the heading changes."""
    by_heading = np.abs(state.derivatives[3][U:, PSI]).max()
    if by_heading > LEVEL and not state.straight:
        raise Failure(
            "no steady turn on a floor that slopes: gravity pulls from another side at every heading; the nearest "
            "steady motion is straight on, --radius inf, or set the slope to 0"
        )
    return state


def _solved(chair: Chair, speed: float, guess: np.ndarray, goal: Goal) -> SteadyState:
    """By Newton's method, with the goal as the last equation. Raises NoSolutionError."""
    balance = chair.equations(speed)

    def equations(z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        values, jacobian = balance(z)
        value, gradient = goal(speed, z)
        return np.append(values, value), np.vstack([jacobian, gradient])

    return chair.state(speed, newton(equations, guess, chair.scale))


def _pushed(delta_force: float) -> Goal:
    """A difference of pushes."""

    def goal(speed: float, z: np.ndarray) -> tuple[float, np.ndarray]:
        return float(z[-1]) - delta_force, np.eye(len(z))[-1]

    return goal


def _circled(radius: float) -> Goal:
    """A radius of curvature, by (23)."""

    def goal(speed: float, z: np.ndarray) -> tuple[float, np.ndarray]:
        v, psi_dot, path = z[0], z[1], hypot(speed, z[0])
        gradient = np.zeros(len(z))
        gradient[:2] = -psi_dot * v / path**3, 1 / path
        return psi_dot / path - 1 / radius, gradient

    return goal


def _between(before: SteadyState, after: SteadyState) -> Goal:
    """As near to the one as to the other."""

    def goal(speed: float, z: np.ndarray) -> tuple[float, np.ndarray]:
        across = (after.z - before.z) / before.chair.scale**2
        across /= np.linalg.norm(across * before.chair.scale)
        return float(across @ (z - 0.5 * (before.z + after.z))), across

    return goal
