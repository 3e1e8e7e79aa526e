"""Units, and one record for everything that has a name.

A name is written once, here or beside the equation that uses it. The FMI variable, the column of a
table, the slider on a page and the units and mirror tests are derived from the record.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf, pi

REAR = ("rl", "rr")  # rear left, rear right: the order of every pair of rear-wheel quantities
FRONT = ("fl", "fr")  # front left, front right: the same for casters


@dataclass(frozen=True)
class DisplayUnit:
    """Another unit of the same dimension: `value in this unit = factor · SI value`."""

    name: str
    factor: float


@dataclass(frozen=True)
class Unit:
    """A coherent SI unit: a name, and its exponents of kg, m, s (and rad, which has no dimension)."""

    name: str
    kg: int = 0
    m: int = 0
    s: int = 0
    rad: int = 0
    display: tuple[DisplayUnit, ...] = ()
    quantity: str = ""  # what is measured in it

    @property
    def behind(self) -> str:
        """How it stands behind a number: of a plain number, nothing does."""
        return "" if self.name == "1" else f" {self.name}"

    def scale(self, kg: float, m: float, s: float) -> float:
        """Factor by which a number grows when the units of mass, length, time shrink by kg, m, s."""
        return float(kg) ** self.kg * float(m) ** self.m * float(s) ** self.s


ONE = Unit("1", display=(DisplayUnit("%", 100.0),), quantity="Ratio")
KG = Unit("kg", kg=1, quantity="Mass")
KG_M2 = Unit("kg.m2", kg=1, m=2, quantity="MomentOfInertia")
M = Unit("m", m=1, display=(DisplayUnit("mm", 1000.0),), quantity="Length")
HZ = Unit("Hz", s=-1, quantity="Frequency")
PER_M = Unit("1/m", m=-1, quantity="Curvature")
S = Unit("s", s=1, display=(DisplayUnit("ms", 1000.0),), quantity="Time")
M_S = Unit("m/s", m=1, s=-1, display=(DisplayUnit("km/h", 3.6),), quantity="Velocity")
M_S2 = Unit("m/s2", m=1, s=-2, quantity="Acceleration")
RAD = Unit("rad", rad=1, display=(DisplayUnit("deg", 180 / pi),), quantity="Angle")
RAD_S = Unit("rad/s", s=-1, rad=1, display=(DisplayUnit("deg/s", 180 / pi),), quantity="AngularVelocity")
RAD_S2 = Unit("rad/s2", s=-2, rad=1, quantity="AngularAcceleration")
PER_RAD = Unit("1/rad", rad=-1, quantity="RatioPerAngle")
N = Unit("N", kg=1, m=1, s=-2, quantity="Force")
N_RAD = Unit("N/rad", kg=1, m=1, s=-2, rad=-1, quantity="ForcePerAngle")
N_S = Unit("N.s", kg=1, m=1, s=-1, quantity="Momentum")
N_M = Unit("N.m", kg=1, m=2, s=-2, quantity="Torque")
N_M_RAD = Unit("N.m/rad", kg=1, m=2, s=-2, rad=-1, quantity="TorquePerAngle")
N_S_M = Unit("N.s/m", kg=1, s=-1, quantity="LinearDamping")
N_S2_M2 = Unit("N.s2/m2", kg=1, m=-1, quantity="QuadraticDamping")
N_M_S = Unit("N.m.s/rad", kg=1, m=2, s=-1, rad=-1, quantity="RotationalDamping")
PER_N = Unit("1/N", kg=-1, m=-1, s=2, quantity="RatioPerForce")
W = Unit("W", kg=1, m=2, s=-3, quantity="Power")
BAR = Unit("bar", quantity="Pressure")  # pressure enters only as a ratio, so its own dimension never meets kg, m, s
UNITS = {unit.name: unit for unit in tuple(globals().values()) if isinstance(unit, Unit) and unit is not BAR}


def per_second(unit: Unit) -> Unit:
    """The unit of a rate of change."""
    known = {M: M_S, M_S: M_S2, RAD: RAD_S, RAD_S: RAD_S2}
    return known.get(unit) or Unit(f"{unit.name}/s", unit.kg, unit.m, unit.s - 1, unit.rad, quantity=f"{unit.quantity}Rate")


@dataclass(frozen=True)
class Quantity:
    """Something with a name, a unit and a meaning.

    `mirror` says what the quantity becomes in a mirror held along the chair: "+" the same, "-" its
    negative, "+name" or "-name" (the negative of) its partner on the other side, and "+swap" or
    "-swap" for a pair whose two components change places.
    """

    name: str
    unit: Unit
    meaning: str = ""
    mirror: str = "+"
    components: tuple[str, ...] = ()
    symbol: str = ""  # what the equations call it; the last part of the name unless given

    def __post_init__(self) -> None:
        if not self.symbol:
            object.__setattr__(self, "symbol", self.name.rpartition(".")[2])

    @property
    def size(self) -> int:
        return len(self.components) or 1

    @property
    def names(self) -> tuple[str, ...]:
        """The dotted name of each component."""
        return tuple(f"{self.name}.{c}" for c in self.components) or (self.name,)


@dataclass(frozen=True)
class Parameter(Quantity):
    """A constant of the model. In an effect, `off` is its default and `smallest_interesting` its δ; a `mirror` that is given
    is a claim that the effect is held to."""

    mirror: str = ""  # as "+" where nothing is given
    default: float = 0.0
    off: float | None = None
    lower: float = -inf
    upper: float = inf
    nominal: float | None = None
    smallest_interesting: float | None = None
    source: str = ""
    choices: tuple[str, ...] = ()  # an enumeration: the value is the 1-based place of the choice
    fixed: bool = False  # may not change once the simulation has started
    uncertainty: float = 0.3  # relative standard deviation of a value that was measured or looked up beforehand
    known_to: float | None = None  # standard deviation of what is known of it beforehand, in place of the relative one
    among_chairs: float | None = None  # standard deviation from chair to chair, of a value that nobody gave
    estimated: bool = True  # False for an effect's constants, of which a fit only touches those that are `adjusted`
    dry: bool = False  # of dry friction that may hold what it acts on, so that for a time no reading has a slope by it
    formerly: tuple[tuple[str, float], ...] = ()  # names, without the effect's, whose sum with these weights it has replaced
    mirror_given: bool = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "mirror_given", bool(self.mirror))
        object.__setattr__(self, "mirror", self.mirror or "+")
        if self.off is not None:
            object.__setattr__(self, "default", self.off)
        if self.nominal is None:
            object.__setattr__(self, "nominal", abs(self.default) or self.smallest_interesting or 1.0)

    @property
    def delta(self) -> float:
        """δ, of a parameter that has one: every parameter of an effect that is estimated."""
        assert self.smallest_interesting is not None, self.name
        return self.smallest_interesting

    @property
    def adjusted(self) -> bool:
        """Is it a constant of an effect in which chairs differ? With the effect a fit estimates it too, by its prior."""
        return not self.estimated and self.known_to is not None

    def prior_sd(self, value: float) -> float:
        """Standard deviation of what is known of it where it was measured or looked up as `value`."""
        return self.known_to if self.known_to is not None else self.uncertainty * (abs(value) or 1.0)

    def owned_by(self, effect: str) -> Parameter:
        """The same parameter under its full name `effect.<id>.<name>`; partners keep their short names."""
        return replace(self, name=f"effect.{effect}.{self.name}")


@dataclass(frozen=True)
class Input(Quantity):
    """What the surroundings do to the chair, as a function of time."""

    start: float = 0.0
    lower: float = -inf
    upper: float = inf
    nominal: float = 1.0
    seldom: bool = False  # most runs leave it at its start, and have a shorter step for that


@dataclass(frozen=True)
class State(Quantity):
    """An unknown with a row in M x' = f.

    `nominal` is the size our own steps measure its error against. What an importer is told is the nominal of the output of the
    same name, the size that the state usually has; `usual` is that where the output is made from the state.
    """

    nominal: float = 1.0
    usual: float | None = None  # as `nominal` where not given


# Results stay within these, by unit: what lies beyond is no wheelchair. FMI asks for bounds.
REACH = {"m": 1e6, "rad": 1e5, "m/s": 1e3, "rad/s": 1e4, "m/s2": 1e6, "N": 1e7, "1/m": 1e6, "1": 1e3}


@dataclass(frozen=True)
class Output(Quantity):
    """A result under its FMI name; `symbol` names the quantity it shows, `component` which of a pair."""

    component: int = 0
    nominal: float = 1.0
    lower: float = -inf
    upper: float = inf
    boolean: bool = False  # written as an inequality; `margin` is the unit of its two sides
    margin: Unit = ONE
    limit: str = ""  # what has happened where it is true, if the model holds no longer there
    instead: str = ""  # which model would hold there, if there is one: "or choose ..."

    def __post_init__(self) -> None:
        super().__post_init__()
        reach = REACH.get(self.unit.name, 1e9)
        object.__setattr__(self, "lower", max(self.lower, -reach))
        object.__setattr__(self, "upper", min(self.upper, reach))


@dataclass(frozen=True)
class Table:
    """Records by name, in order; refuses two of the same name."""

    records: tuple[Quantity, ...]
    index: Mapping[str, int] = field(init=False, compare=False)

    def __post_init__(self) -> None:
        names = [name for record in self.records for name in record.names]
        if len(set(names)) != len(names):
            twice = sorted({name for name in names if names.count(name) > 1})
            raise ValueError(f"names used twice: {', '.join(twice)}")
        object.__setattr__(self, "index", {name: i for i, name in enumerate(names)})
