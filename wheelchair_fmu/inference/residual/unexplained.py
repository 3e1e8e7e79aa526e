"""What orders the force that a model lacks: the force and the moment that nobody recorded, as all readings have them, against
what was going on.

A force that goes with speed in one run and in the others is a law that nobody has written down; one that goes with the wheels'
angle is a valve or a flat spot; one that stands in a single place of a single run is a hand on the rim. What goes with nothing
is nobody's effect. Whatever orders it must foretell it in runs that it was not learnt from.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...campaign.strokes import phase
from ...engine.smoothing import smoothed
from ..estimation.problem import Fit
from ..evidence.disturbance import MOST, USUAL, Strength, disturbed
from ..evidence.evidence import Evidence, RunEvidence
from ..evidence.likelihood import Likelihood
from ..evidence.noise_model import ACROSS, FORCED, MOMENT, NoiseModel, pushes_of
from ..parallel import parallel_map
from .panel import Panel, against, in_run

STROKE = "stroke"
BINS = 8  # of a variable, alike in how much was recorded in each
KNOWN = 0.8  # of a force's usual size: where the readings tell it no better, it is not asked what orders it
SHARE = 0.25  # of a force's mean square in other runs that an order must foretell
LONE = 0.5  # of its sum of squares, in a part of a run that is
BRIEF = 0.2  # of all that was recorded, or less: something happened there
WINDOW = 1.0  # s, either side of where most happened
AT_MOST = 0.99  # of the largest force that is looked at
FLAT = 0.005  # slope: DIN 18202 lets a finished floor that counts as flat be 4 mm out over a metre
ORDERS = (1, 2)  # times per turn of a wheel
HARMONICS = (1, 2, 3)  # times per stroke

Basis = Callable[[np.ndarray, np.ndarray], np.ndarray]  # functions (n, k) of a variable (n,), with the edges of its bins


@dataclass(frozen=True)
class Missing:
    """The unexplained force (N) and moment (N m) of a run over its times (n,), with their standard deviations."""

    run: str
    time: np.ndarray
    values: Mapping[str, np.ndarray]
    sd: Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Order:
    """What a missing force goes with, and the share of its mean square that this foretells in other runs, or that a lone event
    holds; `words` is a sentence."""

    of: str
    by: str
    share: float
    words: str
    panel: Panel | None = None

    def as_json(self) -> dict[str, Any]:
        return {"of": self.of, "by": self.by, "share": self.share, "words": self.words}


@dataclass(frozen=True)
class Unexplained:
    """The force that nobody recorded and a calibrated model needs, `before` its search and `after`; and what orders it."""

    before: Strength
    after: Strength
    orders: tuple[Order, ...]
    forces: tuple[Missing, ...] = ()
    weight: float = 0.0  # N
    arm: float = 0.0  # m, from the axle to the CM, at which a slope to the side pulls

    @property
    def like_a_floor(self) -> bool:
        """Is it no more than a floor that counts as flat does?"""
        force, moment = self.after.whole
        return force <= FLAT * self.weight and moment <= FLAT * self.weight * self.arm

    @property
    def ordered(self) -> tuple[Order, ...]:
        """What orders it, but for the stroke, to which a rider's body is locked that has its part in such forces, and for what
        stays the same, where a floor that counts as flat and falls to one side does as much."""
        nobodys = {STROKE, CONSTANT} if self.like_a_floor else {STROKE}
        return tuple(o for o in self.orders if o.by not in nobodys)

    @property
    def nobodys(self) -> bool:
        """Is it no more than a flat floor does, and ordered by nothing, so that no effect is behind it?"""
        return self.like_a_floor and not self.ordered

    @property
    def words(self) -> list[str]:
        """What a person is told."""
        if not self.before.fall and not self.after.fall:
            return ["The model needs no force and no moment that nobody recorded."]
        told = [f"As calibrated, the model needs {_size(self.before)} that nobody recorded; in the end, {_size(self.after)}."]
        if self.forces and self.nobodys:
            nothing = "nothing else" if self.orders else "nothing"
            flat = "a floor that counts as flat gives as much: no effect is behind them"
            told.append(f"These forces follow {nothing} that was recorded, and {flat}.")
        elif self.forces and not self.orders:
            told.append("These forces follow nothing that was recorded.")
        return told + [f"{o.words[0].upper()}{o.words[1:]}." for o in self.orders]

    def as_json(self) -> dict[str, Any]:
        """The key `disturbance`: standard deviations in N, N m and N s that the model needs in the end, and the way in m over
        which the moment lasts, the same as `calibrated`, what orders them, and all in words."""
        in_the_end, calibrated = (_figures(s) for s in (self.after, self.before))
        return {**in_the_end, "calibrated": calibrated, "orders": [o.as_json() for o in self.orders], "words": self.words}


def _figures(s: Strength) -> dict[str, float]:
    whole = dict(zip(("force", "moment"), s.whole, strict=True))
    return {**whole, "floor": s.floor, "body": s.body, "lasting": s.lasting, "bumps": s.bumps, "tremor": s.tremor}


def _size(s: Strength) -> str:
    nothing = "no force and no moment"
    if not s.fall:
        return nothing
    force, moment, body = (_told(*pair) for pair in zip((*s.whole, s.body), USUAL[:3] * MOST, strict=True))
    each = ((force, f"{force} N"), (moment, f"{moment} N m"), (body, f"a swing of the rider's body of {body} N s"))
    *most, last = [words for size, words in each if size != "0"] or [nothing]
    return f"{', '.join(most)} and {last}" if most else last


def _told(size: float, most: float) -> str:
    """To two digits, and without powers of ten; one that is as large as any that is looked at may be larger."""
    digits = f"{float(f'{size:.2g}'):g}"
    return f"at least {digits}" if size > AT_MOST * most else digits


def unexplained(likelihood: Likelihood, found: Fit, before: Strength, after: Strength, evidence: Evidence) -> Unexplained:
    """What a fitted model lacks, and what orders it, by `evidence` at its values."""
    chair = likelihood.chair(found.values)
    weight, arm = chair["chair.m"] * chair["g"], chair["chair.b"]
    if not after.fall:
        return Unexplained(before, after, (), (), weight, arm)
    forces = missing(evidence, after, likelihood.noise_model, chair["chair.t_r"])
    by = orders(evidence, forces, after, likelihood.sensitivities.results, chair["wheel.R"])
    return Unexplained(before, after, tuple(by), tuple(forces), weight, arm)


def missing(evidence: Evidence, strength: Strength, other: NoiseModel, t_r: float) -> list[Missing]:
    """The force and moment of each run, by evidence of one model with its filters; `other` is their other noise, `t_r` the
    distance (m) between wheels."""
    both = np.zeros((2, FORCED))
    both[0, 0], both[1, [MOMENT, ACROSS]] = 1.0, 1.0  # what turns a chair, a floor or not; its pull along the way goes by that

    def one(e: RunEvidence) -> Missing:
        filter_, start = disturbed(e, strength.put_into(other), t_r)
        mean, sd = smoothed(filter_, e.measured - e.foretold, start, both)
        means, sds = (dict(zip(("force", "moment"), values.T, strict=True)) for values in (mean, sd))
        return Missing(e.run.name, e.run.time, means, sds)

    return parallel_map(one, evidence.runs)


def orders(
    evidence: Evidence, found: Sequence[Missing], strength: Strength, results: Sequence[str], radius: float
) -> list[Order]:
    """What orders the force, and what orders the moment, the plainest first. `results` names the columns of the evidence's;
    `radius` (m) is the wheels'."""
    going = [_going_on(e, results, radius) for e in evidence.runs]
    out: list[Order] = []
    for of, size in (("force", strength.force), ("moment", strength.moment)):
        values = [np.where(m.sd[of] < KNOWN * size, m.values[of], np.nan) for m in found]
        if not any(np.isfinite(v).any() for v in values):
            continue
        lone = _lone(of, found, values)
        shares = _shares(going, values)
        ordered = (
            Order(of, name, share, _words(of, name, share), _panel(name, going, values))
            for name, share in shares.items()
            if share > SHARE
        )
        out += [lone] if lone else ordered
    return sorted(out, key=lambda o: -o.share)


def _words(of: str, name: str, share: float) -> str:
    return (
        f"the missing {of} {VARIABLES[name].does}: this foretells {share:.0%} of its mean square in runs it was not learnt from"
    )


def _panel(name: str, going: Sequence[Mapping[str, np.ndarray]], values: Sequence[np.ndarray]) -> Panel | None:
    """A force against a variable; none of one that stays the same."""
    variable = VARIABLES[name]
    by = [g[name] % variable.period if variable.period else g[name] for g in going]
    return against(variable.words or name, variable.unit, by, values) if variable.unit else None


def _shares(going: Sequence[Mapping[str, np.ndarray]], values: Sequence[np.ndarray]) -> dict[str, float]:
    """Share of the mean square of a force, (n,) of each run, that each variable foretells, of what a constant leaves; and the
    constant's own. None where one run has no others to learn from."""
    if len(going) < 2:
        return {}
    left = {name: _left([g[name] for g in going], values, basis) for name, (_, basis, *_) in VARIABLES.items()}
    whole = float(sum(np.nansum(v**2) for v in values))
    constant = min(left[CONSTANT], whole)
    return {name: 1 - it / (whole if name == CONSTANT else constant) for name, it in left.items()}


def _left(by: Sequence[np.ndarray], values: Sequence[np.ndarray], basis: Basis) -> float:
    """The sum of squares that a function of one variable, learnt from all other runs, leaves of each run's force."""
    edges = np.nanquantile(np.append(np.concatenate(by), 0.0), np.linspace(0, 1, BINS + 1)[1:-1])
    there = [np.isfinite(v) for v in values]
    columns = [basis(x, edges)[t] for x, t in zip(by, there, strict=True)]
    forces = [v[t] for v, t in zip(values, there, strict=True)]
    left = 0.0
    for i, (own, force) in enumerate(zip(columns, forces, strict=True)):
        others = [j for j in range(len(by)) if j != i]
        A, b = (np.concatenate([part[j] for j in others]) for part in (columns, forces))
        law = np.linalg.lstsq(A, b, rcond=None)[0]
        left += float(np.sum((force - own @ law) ** 2))
    return left


def _lone(of: str, found: Sequence[Missing], values: Sequence[np.ndarray]) -> Order | None:
    """A short part of one run in which most of it is, where that is a short part of all the time for which it is known."""
    squares = [np.nan_to_num(v) ** 2 * np.gradient(m.time) for m, v in zip(found, values, strict=True)]
    whole = float(sum(s.sum() for s in squares))
    seconds = float(sum(np.gradient(m.time)[np.isfinite(v)].sum() for m, v in zip(found, values, strict=True)))
    best = None
    for m, s in zip(found, squares, strict=True):
        total = np.concatenate(([0.0], np.cumsum(s)))
        start, end = (np.searchsorted(m.time, m.time + side * WINDOW) for side in (-1, 1))
        inside = total[end] - total[start]
        at = int(np.argmax(inside))
        if best is None or inside[at] > best[0]:
            best = float(inside[at]), m, float(m.time[start[at]]), float(m.time[end[at] - 1])
    if best is None or best[0] < LONE * whole or BRIEF * seconds < 2 * WINDOW:
        return None
    share, m, begins, ends = best[0] / whole, best[1], best[2], best[3]
    words = f"{share:.0%} of the missing {of} is in {m.run} from {begins:.1f} to {ends:.1f} s: something happened there"
    return Order(of, "run", share, words, in_run(m.run, m.time, m.values[of], m.sd[of], begins, ends))


def _going_on(e: RunEvidence, results: Sequence[str], radius: float) -> dict[str, np.ndarray]:
    """What may order a force in one run, (n,) by name."""
    at = {name: e.results[:, i] for i, name in enumerate(results)}
    gaps = np.diff(e.run.time, prepend=e.run.time[0])
    by_hands = [e.run.inputs[n] for n in pushes_of(e.run) if n.startswith("push.") and n in e.run.inputs]
    push = np.sum([np.zeros(len(e.run.time)), *by_hands], axis=0)
    turned = {side: np.cumsum(at[f"sensor.wheel_speed_{side}"] * gaps) / radius for side in ("l", "r")}
    return {
        CONSTANT: at["chair.u"],
        "speed": at["chair.u"],
        "yaw rate": at["chair.psi_dot"],
        "heading": np.mod(at["chair.psi"], 2 * np.pi),
        "push": push,
        STROKE: phase(e.run.time, push),
        "caster angle": 0.5 * (at["caster.fl"] + at["caster.fr"]),
        "time": e.run.time - e.run.time[0],
        "left wheel's angle": turned["l"],
        "right wheel's angle": turned["r"],
    }


def _bins(x: np.ndarray, edges: np.ndarray) -> np.ndarray:
    return np.eye(BINS)[np.digitize(x, edges)]


def _turns(x: np.ndarray, edges: np.ndarray) -> np.ndarray:
    return np.stack([np.ones(len(x)), *(part(k * x) for k in ORDERS for part in (np.sin, np.cos))], axis=1)


def _strokes(x: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Of a phase, NaN where nobody pushes."""
    pushing = np.isfinite(x)
    angle = 2 * np.pi * np.where(pushing, x, 0.0)
    waves = [np.where(pushing, part(k * angle), 0.0) for k in HARMONICS for part in (np.sin, np.cos)]
    return np.stack([np.ones(len(x)), pushing.astype(float), *waves], axis=1)


def _course(x: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """What warms or tires does so slowly; what changes sooner, and alike in all runs, is where they began on the floor."""
    return np.stack([np.ones(len(x)), x, x * x], axis=1)


def _same(x: np.ndarray, edges: np.ndarray) -> np.ndarray:
    return np.ones((len(x), 1))


CONSTANT = "constant"


class Variable(NamedTuple):
    """What may order a force: what such a force `does`, the functions of it that are learnt, its unit, its name where the key
    is none, and after how much it comes back."""

    does: str
    basis: Basis
    unit: str = ""
    words: str = ""
    period: float = 0.0


STROKES = "is locked to the stroke, as that of a body is that moves and was not recorded"
TURN = 2 * np.pi
VARIABLES = {
    CONSTANT: Variable("stays the same throughout", _same),
    "speed": Variable("goes with the speed", _bins, "m/s"),
    "yaw rate": Variable("goes with the yaw rate", _bins, "rad/s"),
    "heading": Variable("goes with the heading", _bins, "rad"),
    "push": Variable("goes with the push", _bins, "N", "push of both hands"),
    STROKE: Variable(STROKES, _strokes, "1", "share of a stroke that has passed"),
    "caster angle": Variable("goes with the casters' angle", _bins, "rad", "mean caster angle"),
    "time": Variable("grows or fades in the course of a run", _course, "s"),
    "left wheel's angle": Variable("comes back with every turn of the left wheel", _turns, "rad", period=TURN),
    "right wheel's angle": Variable("comes back with every turn of the right wheel", _turns, "rad", period=TURN),
}
