"""Energy: without a push the chair only loses it, whatever the motion, and no drag is below zero.

Asked of the equations themselves, moment by moment, so that no integrator's tolerance is in the way: the power of all forces,
less gravity's and with what goes into the states of laws and effects, is not above zero. Inertia that an effect shares with the
chair counts by the equations as they were before each had one rate. Camber and self-aligning torque are left out, as the
paper's own terms for them take part in no balance of energy.

Effects are anywhere in their bounds, their constants with them; of a chair whose `laws` are asked, so is now and then each of
its parameters.

A tyre that slides and a brake take so much power that they hide what drives. So half of the motions are such that a chair
without effects loses nothing: no resistance, no brake, and a rear axle that rolls where it points. In the others each of what
takes power is left out half of the time: what the tyres resist sliding with, each axle's rolling resistance, the brakes.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property

import casadi as cs
import numpy as np

from ..model.chassis import ROWS
from ..model.stage import Effect
from ..model.wheelchair import Model
from ..quantities import Parameter
from .places import SOLVED, Place, Settler
from .subject import Breach, Subject

NAME = "energy"
SAME = 1e-9  # of the powers that balance
LEAST = 1e-12  # W
DRAGS = ("D_f", "D_w", "d_f", "d_r", "braking", "side")
SPENT = -1e-8  # N or N s/m: what rounding may leave of a drag that has run out
NONE = ("tyre.C_m_lambda", "tyre.c_p", "tyre.C_phi", "tyre.C_m_phi")
RANGE = {"lagged_slip": 1.0, "smoothed_rate": 5.0, "felt_push": 60.0, "lean": 0.05}  # sizes of states that are not nominal
KINDS: Mapping[str, tuple[float, float, float]] = {  # spread of u, v, ψ' in each kind of motion
    "at rest": (0.0, 0.0, 0.0),
    "all but at rest": (1e-4, 1e-4, 1e-4),
    "rolling": (1.5, 0.05, 0.8),
    "spinning on the spot": (0.0, 0.2, 3.0),
    "sliding": (0.5, 1.0, 1.0),
}
WORK = ("push.", "stroke.", "rider.", "external.")  # inputs by which a person does work
RESISTANCES = ("resistance.f_r", "resistance.f_f")
HIDING = (*RESISTANCES, "tyre.C_lambda", "caster.C_lambda")  # what takes power, where a chair has it
OF_NO_CHAIR = ("start.", "speed.", "effect.")  # parameters that say how a chair moves, or that are asked of by themselves
SELDOM = 0.15  # share of a chair's parameters that are not as usual


@dataclass(frozen=True)
class Energy:
    """What is asked of one model, in which the effects that are asked of are on and all others off; with `laws`, in chairs
    with parameters anywhere in their bounds."""

    subject: Subject
    laws: bool = False

    def breaches(self, on: Collection[Effect], rng: np.random.Generator, times: int = 60) -> list[Breach]:
        """The first moment, of so many with these effects anywhere in their bounds, in which energy rises."""
        for i in range(times):
            kind = list(KINDS)[i % len(KINDS)]
            place, left = self._settler(self._anywhere(kind, on, rng, free=i % 2 == 0))
            if left >= SOLVED:
                continue  # loads and accelerations that find no balance: far beyond where wheels have left the ground
            power, scale, drags = self._powers_at(place)
            where = f"{kind}{self._sizes(on, place)}"
            if power > SAME * scale + LEAST:
                fact = f"{where} its energy rises by {power:.3g} W, of {scale:.3g} W that balance"
                return [_breach(on, fact, "let forces oppose the velocity of the point at which they act")]
            for symbol, least in drags.items():
                if least < SPENT:
                    return [_breach(on, f"{where} {symbol} is {least:.3g}", "let no drag go below zero")]
        return []

    def of_casters(self, rng: np.random.Generator, times: int = 60) -> list[Breach]:
        """The first moment in which the casters alone drive the chair, which the rear axle's resistance may hide."""
        for i in range(times):
            kind = list(KINDS)[i % len(KINDS)]
            place, left = self._settler(self._anywhere(kind, (), rng, free=False))
            parts = self._of_casters(place.x, place.w, place.p).full().ravel()
            if left < SOLVED and parts.sum() > SAME * abs(parts).sum() + LEAST:
                fact = f"{kind} the casters give the chair {parts.sum():.3g} W"
                return [_breach((), fact, "let their forces oppose the velocity of the pivot at which they act")]
        return []

    def _anywhere(self, kind: str, on: Collection[Effect], rng: np.random.Generator, free: bool) -> Place:
        p, w = self._values(on, rng), np.array([i.start for i in self._model.inputs])
        if free:
            p[self._of(RESISTANCES)] = 0.0
        else:
            w = np.where(self._surroundings, rng.uniform(*self._reach), w)
            w[self._brakes] *= rng.choice([0.0, 1.0])
            p[self._of(HIDING)] *= rng.choice([0.0, 1.0], len(self._of(HIDING)))
        x = self._states(KINDS[kind], rng)
        if free:
            x[4] = p[self._names.index("chair.b")] * x[5]  # v = b ψ'
            x[len(ROWS) :] *= rng.choice([0.0, 1.0])
            self._trail(x, p, rng)
            self._roll(x, w, p)
        return Place(x, w, p)

    def _trail(self, x: np.ndarray, p: np.ndarray, rng: np.random.Generator) -> None:
        """Casters all but behind their pivots, where a little of their torque moves the chair and swings them by much."""
        if swivels := self._places("swivel"):
            a, t_f = (p[self._names.index(name)] for name in ("chair.a", "chair.t_f"))
            ways = np.arctan2(x[4] + a * x[5], x[3] + np.array([t_f / 2, -t_f / 2]) * x[5])  # (9), (10)
            x[swivels] = ways + rng.choice([0.003, 0.3]) * rng.normal(size=len(swivels))

    def _roll(self, x: np.ndarray, w: np.ndarray, p: np.ndarray) -> None:
        """Casters that may slip turn as fast as those that roll do."""
        if turning := self._places("turning_rate"):
            slip, trail = (v.full().ravel() for v in self._slips.call([x, w, p]))
            x[turning] += slip / trail

    def _states(self, spread: tuple[float, float, float], rng: np.random.Generator) -> np.ndarray:
        """Speeds of either sign, casters anywhere round, and what effects remember."""
        moving = dict(zip(("u", "v", "psi_dot"), spread, strict=True))
        x = []
        for state in self._model.states:
            name = state.name.rpartition(".")[2]
            round_about = name in ("psi", "swivel")
            size = moving.get(name, 0.0 if name in ("x", "y") else RANGE.get(name, state.nominal))
            x.append(rng.uniform(-np.pi, np.pi, state.size) if round_about else size * rng.normal(size=state.size))
        return np.concatenate(x)

    def _values(self, on: Collection[Effect], rng: np.random.Generator) -> np.ndarray:
        """Parameters (np,): of the effects that are on anywhere in their bounds or at one of these, of the others zero."""
        p = self._off.copy()
        for i in self._loose if self.laws else ():
            if rng.random() < SELDOM:
                p[i] = _within(self._model.parameters[i], rng)
        for effect in on:
            for q in effect.parameters:
                inside = rng.uniform(-1, 1) * (q.smallest_interesting or 0.0)
                value = rng.choice([q.lower, q.upper, rng.uniform(q.lower, q.upper), inside])
                p[self._names.index(f"effect.{effect.id}.{q.name}")] = np.clip(value, q.lower, q.upper)
            for q in effect.constants:
                if rng.random() < 0.5:
                    p[self._names.index(f"effect.{effect.id}.{q.name}")] = _within(q, rng)
        return p

    @cached_property
    def _loose(self) -> list[int]:
        """Places of the chair's own parameters that may have another value."""
        return [
            i
            for i, q in enumerate(self._model.parameters)
            if not (q.choices or q.name in NONE or q.name.startswith(OF_NO_CHAIR))
        ]

    def _powers_at(self, place: Place) -> tuple[float, float, dict[str, float]]:
        """Power [W], the sizes of its parts, and the least of each drag."""
        parts, *drags = (v.full().ravel() for v in self._powers.call([place.x, place.w, place.p]))
        return float(parts.sum()), float(abs(parts).sum()), {n: float(v.min()) for n, v in zip(DRAGS, drags, strict=True)}

    def _sizes(self, on: Collection[Effect], place: Place) -> str:
        names = {f"effect.{e.id}.{q.name}" for e in on for q in e.parameters}
        other = {self._names[i] for i in np.flatnonzero(place.p != self._off)}.difference(HIDING)
        shown = [(i, n) for i, n in enumerate(self._names) if n in names | other]
        return "".join(f", {n.rpartition('.')[2] if n in names else n} = {place.p[i]:.4g}" for i, n in shown)

    def _places(self, state: str) -> list[int]:
        """Where a pair of states is among all."""
        return [i for i, name in enumerate(n for s in self._model.states for n in s.names) if name.startswith(f"{state}.")]

    @property
    def _model(self) -> Model:
        return self.subject.model

    @cached_property
    def _names(self) -> list[str]:
        return [q.name for q in self._model.parameters]

    @cached_property
    def _off(self) -> np.ndarray:
        p = self.subject.values(0.0)
        p[self._of(NONE)] = 0.0
        return p

    def _of(self, names: Collection[str]) -> list[int]:
        """Where those of these parameters are that this model has."""
        return [i for i, name in enumerate(self._names) if name in names]

    @cached_property
    def _brakes(self) -> np.ndarray:
        return np.array([i.name.startswith("brake.") for i in self._model.inputs])

    @cached_property
    def _surroundings(self) -> np.ndarray:
        return np.array([not i.name.startswith(WORK) for i in self._model.inputs])

    @cached_property
    def _reach(self) -> tuple[np.ndarray, np.ndarray]:
        """What brakes, slopes and carpets may be."""
        inputs = self._model.inputs
        return np.array([max(i.lower, -1.0) for i in inputs]), np.array([min(i.upper, 2.0) for i in inputs])

    @cached_property
    def _settler(self) -> Settler:
        return Settler(self._model)

    @cached_property
    def _slips(self) -> cs.Function:
        m, q = self._model, self._model.quantities
        return cs.Function("slips", [m.x, m.w, m.p], [q["swivel_slip"], q["c"]])

    @cached_property
    def _of_casters(self) -> cs.Function:
        """Power [W] of the casters' forces, of their bearings' moments, and into states of theirs, part by part."""
        m, q = self._model, self._model.quantities
        parts = q["F_xf"] * q["v_xf"], q["F_yf"] * q["v_yf"], q["M_f"] * q["psi_dot"], m.absorbed
        return cs.Function("of_casters", [m.x, m.w, m.p], [cs.vertcat(*parts)])

    @cached_property
    def _powers(self) -> cs.Function:
        m, q = self._model, self._model.quantities
        u, v, psi_dot = m.x[3], m.x[4], m.x[5]
        rows = u * m.f[3], v * m.f[4], psi_dot * m.f[5]
        gravity = -q["m"] * q["g_x"] * u, -q["m"] * q["g_y"] * v
        return cs.Function("powers", [m.x, m.w, m.p], [cs.vertcat(*rows, *gravity, m.absorbed), *(q[n] for n in DRAGS)])


def _within(q: Parameter, rng: np.random.Generator) -> float:
    """A value of a parameter within its bounds, or at one: where these are far apart, of any order of magnitude."""
    lower, upper = (
        bound if np.isfinite(bound) else far * max(1.0, abs(q.default)) for bound, far in ((q.lower, -10), (q.upper, 10))
    )
    inside = np.exp(rng.uniform(*np.log([lower, upper]))) if lower > 0 else rng.uniform(lower, upper)
    usual = q.default * np.exp(rng.normal())
    return float(np.clip(rng.choice([lower, upper, inside, usual]), lower, upper))


def _breach(on: Collection[Effect], fact: str, cure: str) -> Breach:
    return Breach(", ".join(e.id for e in on) or "none", NAME, fact, cure)
