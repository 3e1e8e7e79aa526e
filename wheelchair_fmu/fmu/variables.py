"""The table of FMI variables, one record each, that both flavours, both texts and the C tables are made from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from pathlib import Path

import casadi as cs
import numpy as np

from ..engine.kernel import kernel
from ..engine.source import c_source
from ..errors import BuildError
from ..model.choice import names
from ..model.variant import Variant
from ..model.wheelchair import Model
from ..quantities import Input, Output, Parameter, S, Unit, per_second
from ..resources import FMU_SOURCES

TOLERANCE = 1e-7  # of each internal step, unless the importer gives another
GRID = 1e-3  # s; no internal step is longer, or crosses a multiple of it
STOP, STEP = 10.0, 0.002  # s, of the default experiment: steps with which explicit Euler still integrates a turn
IDLE = {"rider.s": "rider.m"}  # inputs that move nothing while a parameter is 0
HELD = {"speed.u": ("speed.mode", "prescribed", "u")}  # a parameter that a state follows at once: in which mode, which


@dataclass(frozen=True)
class Variable:
    """One FMI variable. `reference` is its value reference, `index` its place among the model's p, w, y, x or crossings."""

    reference: int
    name: str
    description: str
    unit: Unit
    kind: str  # time | parameter | input | output | derivative | indicator
    type: str = "Real"  # Real | Enumeration | Boolean
    index: int = 0
    start: float | None = None
    lower: float = -inf
    upper: float = inf
    nominal: float = 1.0
    fixed: bool = False
    choices: tuple[str, ...] = ()
    source: str = ""
    state: int | None = None  # of a derivative: the value reference of its state

    @property
    def causality(self) -> str:
        return {"time": "independent", "derivative": "local", "indicator": "local"}.get(self.kind, self.kind)

    @property
    def initial(self) -> str | None:
        return {"parameter": "exact", "input": "exact", "time": None}.get(self.kind, "calculated")

    @property
    def variability(self) -> str:
        if self.kind == "parameter":
            return "fixed" if self.fixed else "tunable"
        return "continuous" if self.type == "Real" else "discrete"


@dataclass(frozen=True)
class Jump:
    """While the parameter `mode` is `when`, the state at `state` takes every new value of `parameter`."""

    parameter: Variable
    mode: Variable
    when: int
    state: int


@dataclass(frozen=True)
class Watch:
    """Beyond ±limits (by tyre law) of an output, the model no longer holds."""

    variables: tuple[Variable, ...]  # neighbours in the table
    limits: tuple[float, ...]
    guard: Variable | None  # not looked at while this one lies within ±guard_limit
    guard_limit: float
    meaning: str


@dataclass(frozen=True)
class Idle:
    """An input that moves nothing while a parameter is 0."""

    input: Variable
    parameter: Variable


@dataclass(frozen=True)
class Interface:
    """A variant seen through FMI: its variables, and a model of the same shape for each tyre law it can have."""

    variant: Variant
    models: Mapping[str, Model]
    variables: tuple[Variable, ...]
    name: str = "Wheelchair"
    title: str = "a manual wheelchair on real tyres, after Doria et al."
    pages: Path = FMU_SOURCES / "documentation"  # with index.html, to be filled in, and the icon
    chooser: str = "tyre.law"  # the parameter that chooses among the models; "" where there is but one

    @property
    def model(self) -> Model:
        return self.models[self.variant.choice.tyre]

    @cached_property
    def by_name(self) -> dict[str, Variable]:
        return {v.name: v for v in self.variables}

    def of(self, kind: str) -> tuple[Variable, ...]:
        return tuple(v for v in self.variables if v.kind == kind)

    @cached_property
    def states(self) -> dict[int, Variable]:
        """The outputs that are continuous states, by their place among the model's states.

        What is an algebraic row with this variant's values is none.
        """
        return {v.index: self.variables[v.state] for v in self.of("derivative") if v.state is not None}

    def without(self, *kinds: str) -> Interface:
        """The same without its last variables, those of these kinds."""
        kept = tuple(v for v in self.variables if v.kind not in kinds)
        assert [v.reference for v in kept] == list(range(len(kept)))
        return replace(self, variables=kept)

    @property
    def choices(self) -> tuple[str, ...]:
        """What the chooser can be, in the order of its numbers; not all have a model in every archive."""
        return self.by_name[self.chooser].choices if self.chooser else tuple(self.models)

    def c_source(self, law: str) -> str:
        """C text that defines `<law>_kernel`."""
        return c_source(kernel(self.models[law]), law)

    @property
    def jumps(self) -> tuple[Jump, ...]:
        states = [s.symbol for s in self.model.states for _ in s.names]
        modes = {name: self.by_name[mode] for name, (mode, _, _) in HELD.items()}
        return tuple(
            Jump(self.by_name[name], modes[name], 1 + modes[name].choices.index(when), states.index(state))
            for name, (_, when, state) in HELD.items()
        )

    @property
    def idles(self) -> tuple[Idle, ...]:
        return tuple(Idle(self.by_name[name], self.by_name[of]) for name, of in IDLE.items())

    @property
    def watches(self) -> tuple[Watch, ...]:
        name = self.by_name
        # The paper calls its curves linear below 3°; the other laws were fitted to 9°.
        slip = tuple({"linear": 0.0524}.get(law, 0.16) for law in names(self.variant.choice)["tyre"])
        return (
            *(
                Watch(
                    (name[o.name],),
                    (0.5,) * len(slip),
                    None,
                    0.0,
                    f"{o.limit}, and the model no longer holds; push or turn less{o.instead and f', or {o.instead}'}",
                )
                for o in self.model.outputs
                if o.limit
            ),
            Watch(
                (name["slip.rl"], name["slip.rr"]),
                slip,
                name["chair.u"],
                0.3,
                "the tyre law is not meant for so much slip; push or turn less, or choose another tyre.law",
            ),
        )


def interface(variant: Variant) -> Interface:
    """The FMI variables of a variant. Raises BuildError where the tyre laws make models of different shapes."""
    variant = _without_delays(variant)
    needed = {e.needs["tyre"] for e in variant.active() if "tyre" in e.needs}
    laws = [law for law in names(variant.choice)["tyre"] if law in needed or not needed]
    models = {law: replace(variant, choice=replace(variant.choice, tyre=law)).model() for law in laws}
    shapes = {(m.parameters, m.inputs, m.states, m.outputs) for m in models.values()}
    if len(shapes) != 1:
        raise BuildError("the tyre laws differ in parameters, states or outputs; one FMU cannot hold them all")
    model = models[variant.choice.tyre]
    starts = variant.vector()
    only_start = _only_at_the_start(models)
    table = [Variable(0, "time", "simulation time", S, "time")]
    for i, (p, start) in enumerate(zip(model.parameters, starts, strict=True)):
        variable = parameter_variable(len(table), i, p, float(start), p.fixed or (i in only_start and p.name not in HELD))
        if p.name == "tyre.law":
            variable = replace(variable, lower=1 + p.choices.index(laws[0]), upper=1 + p.choices.index(laws[-1]))
        table.append(variable)
    for i, w in enumerate(model.inputs):
        table.append(input_variable(len(table), i, w))
    for record, i in zip(model.outputs, range(model.y.numel()), strict=True):
        table.append(output_variable(len(table), i, record))
    outputs = [v for v in table if v.kind == "output"]
    for place, unit in _differential(model, starts):
        state = next(v for v in outputs if cs.is_equal(model.y[v.index], model.x[place]))
        table.append(
            Variable(
                len(table),
                f"der({state.name})",
                f"rate of change of {state.name}",
                unit,
                "derivative",
                index=place,
                state=state.reference,
            )
        )
    for i, record in enumerate(o for o in model.outputs if o.boolean):
        table.append(
            Variable(
                len(table),
                f"{record.name}.margin",
                f"positive while {record.name} is false",
                record.margin,
                "indicator",
                index=i,
                nominal=10.0,
            )
        )
    return Interface(variant, models, tuple(table))


def _differential(model: Model, parameters: np.ndarray) -> list[tuple[int, Unit]]:
    """Places of the states whose mass is not zero with these parameters, and the units of their rates."""
    mass = cs.Function("mass", [model.p], [cs.densify(model.mass)])(parameters).full().ravel()
    units = [s.unit for s in model.states for _ in s.names]
    return [(i, per_second(unit)) for i, unit in enumerate(units) if mass[i]]


def _without_delays(variant: Variant) -> Variant:
    """What shifts a record in time is about the measurement; an FMU's pushes act when they are set."""
    late = [e.id for e in variant.active() if e.delays_record]
    values = {name: v for name, v in variant.values.items() if not any(name.startswith(f"effect.{e}.") for e in late)}
    return replace(variant, effects=tuple(e for e in variant.effects if e not in late), values=values)


def parameter_variable(reference: int, index: int, p: Parameter, start: float, fixed: bool) -> Variable:
    kind = "Enumeration" if p.choices else "Real"
    lower, upper = (1, len(p.choices)) if p.choices else (p.lower, p.upper)
    assert p.nominal is not None
    return Variable(
        reference,
        p.name,
        p.meaning,
        p.unit,
        "parameter",
        kind,
        index,
        start,
        lower,
        upper,
        p.nominal,
        fixed,
        p.choices,
        p.source,
    )


def input_variable(reference: int, index: int, w: Input) -> Variable:
    return Variable(reference, w.name, w.meaning, w.unit, "input", "Real", index, w.start, w.lower, w.upper, w.nominal)


def output_variable(reference: int, index: int, o: Output) -> Variable:
    kind = "Boolean" if o.boolean else "Real"
    return Variable(reference, o.name, o.meaning, o.unit, "output", kind, index, None, o.lower, o.upper, o.nominal)


def _only_at_the_start(models: Mapping[str, Model]) -> set[int]:
    """Places of the parameters that the start depends on, and nothing afterwards: changing them later is no use."""

    def used(m: Model, *expressions: cs.SX) -> set[int]:
        pattern = cs.Function("f", [m.x, m.w, m.p], [cs.vertcat(*expressions)]).jac_sparsity(0, 2)
        return set(pattern.get_triplet()[1])

    late = set().union(*(used(m, m.f, m.y, m.mass) for m in models.values()))
    return set().union(*(used(m, m.start) for m in models.values())) - late
