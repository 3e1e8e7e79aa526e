"""The wheelchair: choose laws, let effects sign up, and walk the line of stages once.

The result is M(p) x' = f(x, w, p) with results y(x, w, p), as CasADi expressions, and the records of
everything in them. x are the states, w the inputs, p the parameters.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import casadi as cs

from ..errors import ModelError, ShapeError, unknown
from ..quantities import M_S, M_S2, ONE, PER_M, RAD, RAD_S, Input, M, N, Output, Parameter, Quantity, State, Table
from . import chassis, resistance, sensors
from .choice import Choice, law, laws, serves
from .coupling import SPEEDS, uncoupled
from .deriving import deriving
from .readings import READINGS
from .stage import Alternative, Effect, Law, Row, Stage, reads
from .tyre import common

OUTPUTS = (
    Output("chair.x", M, "x of the CM in the room"),
    Output("chair.y", M, "y of the CM in the room", "-"),
    Output("chair.psi", RAD, "yaw angle ψ, clockwise from above", "-", nominal=0.5),
    Output("chair.u", M_S, "forward speed u of the CM"),
    Output("chair.v", M_S, "lateral speed v of the CM, to the right", "-", nominal=0.01),
    Output("chair.psi_dot", RAD_S, "yaw rate ψ', clockwise from above", "-", nominal=0.1),
    Output("chair.curvature", PER_M, "curvature 1/R_c of the CM's path, positive to the right", "-", nominal=0.1),
    Output("slip.rl", RAD, "slip angle λ_rl of the left rear wheel", "-slip.rr", symbol="lam", component=0, nominal=0.01),
    Output("slip.rr", RAD, "slip angle λ_rr of the right rear wheel", "-slip.rl", symbol="lam", component=1, nominal=0.01),
    Output(
        "force.F_srl", N, "lateral force F_srl of the left rear tyre, to the right", "-force.F_srr", symbol="F_s", nominal=20.0
    ),
    Output(
        "force.F_srr",
        N,
        "lateral force F_srr of the right rear tyre, to the right",
        "-force.F_srl",
        symbol="F_s",
        component=1,
        nominal=20.0,
    ),
    Output("load.rl", N, "vertical load of the left rear wheel", "+load.rr", symbol="N_r", nominal=200.0),
    Output("load.rr", N, "vertical load of the right rear wheel", "+load.rl", symbol="N_r", component=1, nominal=200.0),
    Output("load.fl", N, "vertical load of the left caster", "+load.fr", symbol="N_f", nominal=150.0),
    Output("load.fr", N, "vertical load of the right caster", "+load.fl", symbol="N_f", component=1, nominal=150.0),
    Output(
        "load.lifted",
        ONE,
        "true where a wheel has left the ground; the model then no longer holds",
        symbol="lifted",
        boolean=True,
        margin=N,
        limit="a wheel has left the ground",
    ),
    Output(
        "push.beyond_friction",
        ONE,
        "true where a rear wheel is pushed by more than tyre.mu times its load: it would spin, and in this model it rolls on",
        symbol="overdriven",
        boolean=True,
        margin=N,
        limit="a rear wheel is pushed beyond friction, tyre.mu times its load, and would spin",
        instead='choose the law of wheels that spin, wheel = "spinning" in the [laws] of a variant',
    ),
    Output("caster.fl", RAD, "angle δ_fl of the left caster from straight trailing", "-caster.fr", symbol="delta", nominal=0.1),
    Output(
        "caster.fr",
        RAD,
        "angle δ_fr of the right caster from straight trailing",
        "-caster.fl",
        symbol="delta",
        component=1,
        nominal=0.1,
    ),
    Output("push.total_needed", N, "total push F_rl + F_rr that keeps u constant, by (20)", symbol="needed", nominal=10.0),
    Output("push.rim_needed", N, "the same as the hands at both rims feel it", symbol="rim_needed", nominal=10.0),
    Output(
        "sensor.wheel_speed_l",
        M_S,
        "left wheel speed: angular speed times R",
        "+sensor.wheel_speed_r",
        symbol="read_wheel_speed",
    ),
    Output(
        "sensor.wheel_speed_r",
        M_S,
        "right wheel speed: angular speed times R",
        "+sensor.wheel_speed_l",
        symbol="read_wheel_speed",
        component=1,
    ),
    Output(
        "sensor.yaw_rate",
        RAD_S,
        "yaw rate as a gyroscope reads it, clockwise from above",
        "-",
        symbol="read_yaw_rate",
        nominal=0.1,
    ),
    Output("sensor.a_x", M_S2, "specific force along x_m as an accelerometer reads it", symbol="read_a_x", nominal=0.5),
    Output("sensor.a_y", M_S2, "specific force along y_m as an accelerometer reads it", "-", symbol="read_a_y", nominal=0.5),
    Output("sensor.x", M, "x as a tracking system reads it", symbol="read_x"),
    Output("sensor.y", M, "y as a tracking system reads it", "-", symbol="read_y"),
    Output("sensor.yaw", RAD, "yaw angle as a tracking system reads it", "-", symbol="read_yaw", nominal=0.5),
    Output("sensor.u", M_S, "forward speed as a tracking system reads it", symbol="read_u"),
    Output("sensor.v", M_S, "lateral speed as a tracking system reads it, to the right", "-", symbol="read_v", nominal=0.01),
    *(reading.output for reading in READINGS),
)

REGIMES = {  # what to sort errors by: name -> result
    "speed": "chair.u",
    "yaw rate": "chair.psi_dot",
    "lateral force": "force.F_srl",
    "heading": "chair.psi",
}
FORESEEN = ("a_x", "a_y")  # may be read before they are known; each then is an unknown of its own


@dataclass(frozen=True)
class Model:
    """M(p) x' = f(x, w, p), y(x, w, p), x(0) = start(p), and the records of x, w, p and y."""

    choice: Choice
    effects: tuple[Effect, ...]
    parameters: tuple[Parameter, ...]
    inputs: tuple[Input, ...]
    states: tuple[State, ...]
    outputs: tuple[Output, ...]
    x: cs.SX
    w: cs.SX
    p: cs.SX
    mass: cs.SX  # (nx,) diagonal of M, once each row has one rate
    f: cs.SX
    y: cs.SX
    start: cs.SX
    quantities: Mapping[str, cs.SX]  # every quantity of the equations by its symbol
    records: Mapping[str, Quantity]  # and what it means
    absorbed: cs.SX = field(default_factory=lambda: cs.SX(0))  # power [W] that goes into states beside u, v and ψ'


def assemble(choice: Choice = Choice(), effects: Iterable[Effect] = ()) -> Model:
    """Build the model from a choice of laws and a set of effects, whose order does not matter.

    Raises UsageError for an unknown law and ModelError for an effect that does not fit.
    """
    with deriving:
        return _Assembly(choice, tuple(sorted(effects, key=lambda e: e.id))).model()


def adds_state(choice: Choice, effect: Effect) -> bool:
    """Does this effect bring an unknown of its own, or need one: what it reads before it is known?"""
    if not any(symbol in FORESEEN for c in effect.contributions for symbol in reads(c.law)):
        return bool(effect.rows)
    return assemble(choice, [effect]).x.numel() > _states(choice)


@cache
def _states(choice: Choice) -> int:
    """How many states a model has without effects."""
    return assemble(choice).x.numel()


def base_parameters(choice: Choice = Choice()) -> tuple[Parameter, ...]:
    """The parameters of a model without effects."""
    law("tyre", choice)
    tyres = laws("tyre", choice)  # one FMU holds all of them
    extra = tuple(p for each in (*tyres.values(), law("caster", choice), wheel_law(choice)) for p in each.parameters)
    return (*chassis.PARAMETERS, *common.parameters(tuple(tyres)), *resistance.PARAMETERS, *extra)


def wheel_law(choice: Choice) -> Alternative:
    """The chosen one, or the paper's where all else is to the letter as well."""
    return law("wheel", choice, "paper" if choice.equations == "paper" else choice.wheel)


def line(choice: Choice) -> tuple[Stage, ...]:
    """The stages, in order."""
    paper = choice.equations == "paper"
    tyre_law = law("tyre", choice)
    caster_law = law("caster", choice, "paper" if paper else choice.caster)
    *before_tyres, along_wheels = wheel_law(choice).stages
    return (
        chassis.traction,
        chassis.rider,
        chassis.geometry,
        chassis.inertias,
        chassis.kinematics,
        chassis.wheel_planes,
        chassis.floor,
        chassis.gravity,
        *(caster_law.loads or (chassis.loads,)),
        common.inflation,
        common.tyres,
        common.slip_paper if paper else common.slip,
        common.followed_slip,
        *before_tyres,
        *tyre_law.stages,
        common.tyre_forces,
        resistance.rolling_resistance,
        resistance.dry_drag,
        resistance.viscous_resistance,
        along_wheels,
        resistance.rear_forces,
        *caster_law.stages,
        chassis.forces,
        chassis.momentum,
        chassis.balance,
        chassis.motion,
        sensors.sensors,
        *(reading.stage for reading in READINGS),
        chassis.results,
    )


def _symbols(records: Iterable[Quantity]) -> dict[str, cs.SX]:
    return {r.symbol: cs.SX.sym(r.symbol, r.size) for r in records}


class _Assembly:
    """One walk along the line: what is known so far, and what effects add as it becomes known."""

    def __init__(self, choice: Choice, effects: tuple[Effect, ...]):
        if choice.equations not in ("extended", "paper"):
            raise unknown("kind of equations", choice.equations, ("extended", "paper"))
        self.choice, self.effects = choice, effects
        for effect in effects:
            self._refuse_misfit(effect)
        self.parameters = base_parameters(choice)
        laws_with_states = (law("caster", choice), wheel_law(choice))
        self.rows: list[tuple[Row, Mapping[str, cs.SX]]] = []
        self.algebraic: list[tuple[State, cs.SX]] = []
        self.known = _symbols(self.parameters) | _symbols(chassis.INPUTS)
        self.own = {e.id: _symbols((*e.parameters, *e.constants)) for e in effects}
        for row in (*chassis.ROWS, *(row for each in laws_with_states for row in each.rows)):
            self._add_row(row, self.known)
        for effect in effects:
            for row in effect.rows:
                self._add_row(row, self.own[effect.id], owner=effect.id)
        self.records: dict[str, Quantity] = {}
        self.uncoupled: dict[str, tuple[cs.SX, cs.SX]] = {}  # by state, masses and rates that share inertia with the chair
        self.shared = cs.SX(0)  # power [W] that goes into what these and the chair have in common

    def _refuse_misfit(self, effect: Effect) -> None:
        for kind, name in effect.needs.items():
            if not serves(self.choice, kind, name):
                raise ModelError(
                    f"effect {effect.id} needs the {kind} law {name!r}; this model has "
                    f'{getattr(self.choice, kind)!r}: set {kind} = "{name}"'
                )

    def _add_row(self, row: Row, scope: dict[str, cs.SX], owner: str = "") -> None:
        scope[row.state.symbol] = cs.SX.sym(row.state.symbol, row.state.size)
        named = replace(row, state=replace(row.state, name=f"effect.{owner}.{row.state.name}")) if owner else row
        self.rows.append((named, scope))

    def _algebraic_variable(self, symbol: str) -> cs.SX:
        """An unknown for a quantity that is read before it is defined, with a row 0 = value − unknown."""
        defined = {q.symbol: q for s in line(self.choice) for q in s.defines}
        unit, mirror = defined[symbol].unit, defined[symbol].mirror
        guess = cs.SX.sym(f"algebraic_{symbol}")
        state = State(f"algebraic.{symbol}", unit, f"{symbol} as the loads use it", mirror, nominal=10.0)
        self.algebraic.append((state, guess))
        self.known[f"algebraic {symbol}"] = guess
        return guess

    def _value(self, symbol: str, own: Mapping[str, cs.SX], reader: str) -> cs.SX:
        for place in (own, self.known):
            if symbol in place:
                return place[symbol]
        if symbol in FORESEEN:
            algebraic = self.known.get(f"algebraic {symbol}")
            return self._algebraic_variable(symbol) if algebraic is None else algebraic
        later = any(symbol == q.symbol for s in line(self.choice) for q in s.defines)
        why = "is only known further down the line of stages" if later else "is no quantity of this model"
        raise ModelError(f"{reader} reads {symbol!r}, which {why}; known here: {', '.join(sorted(self.known))}")

    def call(self, law: Law, own: Mapping[str, cs.SX], reader: str) -> Any:
        return law(*(self._value(symbol, own, reader) for symbol in reads(law)))

    def _walk(self) -> None:
        for stage in line(self.choice):
            values = self.call(stage.law, {}, f"stage {stage.name}")
            for record, value in zip(stage.defines, values if isinstance(values, tuple) else (values,), strict=True):
                value = cs.SX(value)
                if value.shape != (record.size, 1):
                    raise ModelError(f"stage {stage.name} gives {record.symbol} with shape {value.shape}")
                self.records[record.symbol] = record
                self.known[record.symbol] = self._with_effects(record, value)
            if stage is chassis.momentum and any(row.coupled for row, _ in self.rows):
                self._uncouple()

    def _uncouple(self) -> None:
        """Let each equation of motion have one rate, where effects have inertia that moves with the chair's."""
        coupled = [(row, scope) for row, scope in self.rows if row.coupled]
        own = [self._mass_and_rate(row, scope) for row, scope in coupled]
        symbols = {"psi_dot": ("inertia", "M_z"), "v": ("mass_v", "v_rate"), "u": ("mass_u", "driving")}
        chair = [(self.known[mass], self.known[force]) for mass, force in (symbols[speed] for speed in SPEEDS)]
        M = cs.diag(cs.vertcat(*(mass for mass, _ in (*own, *chair))))
        for i, (row, scope) in enumerate(coupled):
            for speed, entry in row.coupled.items():
                if speed not in SPEEDS or row.state.size > 1:
                    raise ModelError(
                        f"state {row.state.name} is coupled with {speed!r}; write one number that moves with "
                        f"{', '.join(map(repr, sorted(SPEEDS)))}"
                    )
                j = len(own) + SPEEDS.index(speed)
                M[i, j] = M[j, i] = self.call(entry, scope, f"state {row.state.name}")
        masses, rates, driving = uncoupled(M, [rate for _, rate in (*own, *chair)], 2 - self.known["speed_mode"])
        self.uncoupled = dict(zip((row.state.name for row, _ in coupled), zip(masses, rates, strict=True), strict=False))
        for (row, scope), (_, force) in zip(coupled, own, strict=True):
            self.shared += scope[row.state.symbol] * force
        for speed, mass, rate in zip(SPEEDS, masses[len(own) :], rates[len(own) :], strict=True):
            self.shared += self.known[speed] * (self.known[symbols[speed][1]] - rate)
            self.known.update(zip(symbols[speed], (mass, rate), strict=True))
        self.known["driving"] = driving  # what a chair of free speed has; the next stage holds the speed, where it is held

    def _with_effects(self, record: Quantity, base: cs.SX) -> cs.SX:
        """(base + Σ additions) · Π factors."""
        total, factor = base, cs.SX(1)
        for effect in self.effects:
            for contribution in effect.contributions:
                if contribution.to != record.symbol:
                    continue
                term = cs.SX(self.call(contribution.law, self.own[effect.id], f"effect {effect.id}"))
                if term.shape not in ((1, 1), base.shape):
                    said = f"effect {effect.id} gives {record.symbol} a term of shape {term.shape}, not {base.shape}"
                    raise ShapeError(said, term.shape, base.shape)
                if contribution.factor:
                    factor = factor * term
                else:
                    total = total + term
        return total * factor if not factor.is_one() else total

    def _refuse_lost(self) -> None:
        for effect in self.effects:
            for contribution in effect.contributions:
                if contribution.to not in self.records:
                    raise unknown(f"quantity for effect {effect.id} to act on", contribution.to, self.records)

    def model(self) -> Model:
        self._walk()
        self._refuse_lost()
        parameters = (*self.parameters, *(p for e in self.effects for p in e.owned))
        p = cs.vertcat(
            *(self.known[q.symbol] for q in self.parameters),
            *(s for e in self.effects for s in (self.own[e.id][q.symbol] for q in (*e.parameters, *e.constants))),
        )
        x = cs.vertcat(*(scope[row.state.symbol] for row, scope in self.rows), *(g for _, g in self.algebraic))
        w = cs.vertcat(*(self.known[q.symbol] for q in chassis.INPUTS))
        rows = [*map(self._row, self.rows), *map(self._algebraic_row, self.algebraic)]
        mass, f, start = (cs.vertcat(*column) for column in zip(*rows, strict=True))
        start = _at_the_start(x, start)
        if cs.depends_on(mass, cs.vertcat(x, w)):
            raise ModelError("the mass matrix depends on states or inputs; write the law's mass with parameters only")
        states = (*(row.state for row, _ in self.rows), *(state for state, _ in self.algebraic))
        into = [(law("caster", self.choice).absorbs, self.known, "caster law")]
        into += [(wheel_law(self.choice).absorbs, self.known, "wheel law")]
        into += [(e.absorbs, self.own[e.id], f"effect {e.id}") for e in self.effects]
        absorbed = sum((self.call(power, own, reader) for power, own, reader in into if power), self.shared)
        extra = self._state_outputs()
        y = cs.vertcat(
            *(self.known[o.symbol][o.component] for o in OUTPUTS),
            *(scope[row.state.symbol] for row, scope in self.rows[len(chassis.ROWS) :]),
        )
        Table((*parameters, *chassis.INPUTS, *OUTPUTS, *extra))  # one name, one meaning
        return Model(
            self.choice,
            self.effects,
            parameters,
            chassis.INPUTS,
            states,
            (*OUTPUTS, *extra),
            x,
            w,
            p,
            mass,
            f,
            y,
            start,
            self.known,
            self.records,
            absorbed,
        )

    def _row(self, entry: tuple[Row, Mapping[str, cs.SX]]) -> tuple[cs.SX, cs.SX, cs.SX]:
        row, scope = entry
        size = row.state.size
        mass, rate = self.uncoupled.get(row.state.name) or self._mass_and_rate(row, scope)
        start = cs.SX(self.call(row.start, scope, f"state {row.state.name}")) if row.start else cs.SX.zeros(size)
        return (cs.repmat(mass, size // mass.numel()), rate, start)

    def _mass_and_rate(self, row: Row, scope: Mapping[str, cs.SX]) -> tuple[cs.SX, cs.SX]:
        mass, rate = (cs.SX(self.call(law, scope, f"state {row.state.name}")) for law in (row.mass, row.rate))
        return mass, rate

    def _algebraic_row(self, entry: tuple[State, cs.SX]) -> tuple[cs.SX, cs.SX, cs.SX]:
        state, guess = entry
        return cs.SX(0), self.known[state.symbol] - guess, cs.SX(0)

    def _state_outputs(self) -> tuple[Output, ...]:
        """States beyond the chair's own six are results too."""
        return tuple(
            Output(
                name,
                row.state.unit,
                row.state.meaning,
                _component_mirror(row.state, i),
                symbol=row.state.symbol,
                component=i,
                nominal=row.state.usual or row.state.nominal,
            )
            for row, _ in self.rows[len(chassis.ROWS) :]
            for i, name in enumerate(row.state.names)
        )


def _at_the_start(x: cs.SX, start: cs.SX) -> cs.SX:
    """Starts as functions of parameters and inputs alone: what they read of the motion is that of the start itself."""
    given = start
    for _ in range(x.numel()):
        if not cs.depends_on(start, x):
            return start
        start = cs.substitute(start, x, given)
    raise ModelError("the starts of some states read one another in a circle; write one of them with parameters only")


def _component_mirror(pair: State, i: int) -> str:
    """The mirror of one component: where the pair swaps, its partner is the other component."""
    return pair.mirror[0] + pair.names[1 - i] if pair.mirror.endswith("swap") else pair.mirror
