"""What may be hidden in a campaign: every effect of the catalogue, and some that no catalogue has.

Each parameter says where it enters the true chair, its instruments or its runs, its unit, its smallest interesting size and its
sign. Zero always leaves the chair exactly as it was.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from .chair import Chair

Columns = dict[str, np.ndarray]


@dataclass(frozen=True)
class Instruments:
    """How the sensors distort, all zero when exact. `dead_zone` is no sensor: pushes below it never reach the wheel."""

    force_r: float = 0.0
    force_l: float = 0.0
    force_early: float = 0.0
    gyro_bias: float = 0.0
    gyro_scale: float = 0.0
    bias_x: float = 0.0
    bias_y: float = 0.0
    offset_x: float = 0.0
    offset_y: float = 0.0
    marker_x: float = 0.0
    marker_y: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    speed_r: float = 0.0
    speed_l: float = 0.0
    dead_zone: float = 0.0

    def felt(self, push: np.ndarray) -> np.ndarray:
        """The push that reaches the wheel."""
        return np.where(np.abs(push) < self.dead_zone, 0.0, push) if self.dead_zone else push

    def forces(self, time: np.ndarray, F_rl: np.ndarray, F_rr: np.ndarray) -> Columns:
        """The recorded pushes; an early record shows at t what the wheel gets at t + force_early."""
        at = time + self.force_early
        return {"F_rl": (1 + self.force_l) * np.interp(at, time, F_rl), "F_rr": (1 + self.force_r) * np.interp(at, time, F_rr)}

    def motion(self, true: Mapping[str, np.ndarray], g: float) -> Columns:
        """The recorded motion channels, without noise."""
        a_x, a_y = self._accelerometer(true, g)
        return {
            "wheel_speed_l": (1 + self.speed_l) * true["wheel_speed_l"],
            "wheel_speed_r": (1 + self.speed_r) * true["wheel_speed_r"],
            "yaw_rate": (1 + self.gyro_scale) * true["yaw_rate"] + self.gyro_bias,
            "a_x": a_x,
            "a_y": a_y,
            "yaw": true["yaw"],
            **self._marker(true),
        }

    def _marker(self, true: Mapping[str, np.ndarray]) -> Columns:
        """Where the marker is and how fast, as complex numbers: x + i y, in which turning clockwise is a factor e^(i yaw)."""
        point = self.marker_x + 1j * self.marker_y
        place = true["x"] + 1j * true["y"] + point * np.exp(1j * true["yaw"])
        speed = true["u"] + 1j * true["v"] + 1j * true["yaw_rate"] * point
        return {"x": place.real, "y": place.imag, "u": speed.real, "v": speed.imag}

    def _accelerometer(self, true: Mapping[str, np.ndarray], g: float) -> tuple[np.ndarray, np.ndarray]:
        """Specific force at the mounting point, turned into the tilted sensor's axes (first pitch, then roll)."""
        r, r_dot = true["yaw_rate"], true["yaw_acceleration"]
        f_x = true["a_x"] - r**2 * self.offset_x - r_dot * self.offset_y
        f_y = true["a_y"] - r**2 * self.offset_y + r_dot * self.offset_x
        ahead = f_x * np.cos(self.pitch) + g * np.sin(self.pitch)
        down = f_x * np.sin(self.pitch) - g * np.cos(self.pitch)
        return ahead + self.bias_x, f_y * np.cos(self.roll) + down * np.sin(self.roll) + self.bias_y


@dataclass(frozen=True)
class Truth:
    """The chair as it is, its instruments, how far the pressure is off what the gauge said, and what the rider's body does."""

    chair: Chair = Chair()
    instruments: Instruments = Instruments()
    pressure_change: float = 0.0
    reach: float = 0.0  # m by which the rider means to be ahead by themselves before each stroke


def _add(old: float, new: float) -> float:
    return old + new


def _at_least(old: float, new: float) -> float:
    return max(old, new)


@dataclass(frozen=True)
class Parameter:
    """One parameter: `where` is "chair.x", "instruments.x", "pressure_change" or "reach"; usually hidden at `pattern` times δ.

    `sides` are what the right and the left one get of it, where `where` has {} for one of a pair.
    """

    where: str
    unit: str
    delta: float
    sign: str
    pattern: float = 1.0
    combine: Callable[[float, float], float] = _add
    sides: tuple[float, float] | None = None

    def put(self, truth: Truth, value: float) -> Truth:
        owner, _, name = self.where.rpartition(".")
        if not owner:
            return replace(truth, **{name: self.combine(getattr(truth, name), value)})
        part = getattr(truth, owner)
        shares = {name: 1.0} if self.sides is None else dict(zip((name.format("r"), name.format("l")), self.sides, strict=True))
        changed = replace(part, **{n: self.combine(getattr(part, n), share * value) for n, share in shares.items()})
        return replace(truth, chair=changed) if owner == "chair" else replace(truth, instruments=changed)

    def whole(self, value: float) -> float:
        """What the chair has of it in all where `value` is hidden: its own, which is never off, with that."""
        owner, _, name = self.where.rpartition(".")
        return self.combine(getattr(Chair(), name), value) if owner == "chair" and self.sides is None else value


@dataclass(frozen=True)
class Effect:
    """An effect, the set of manoeuvres that sees it best, and whether a catalogue has it."""

    parameters: dict[str, Parameter]
    sees: str = "everyday"
    catalogued: bool = True
    of_nobody: bool = False  # what no effect should be blamed for
    channels: tuple[str, ...] = ()  # that show it, besides the usual ones


def _one(name: str, where: str, unit: str, delta: float, sign: str, **more: object) -> dict[str, Parameter]:
    return {name: Parameter(where, unit, delta, sign, **more)}  # type: ignore[arg-type]


def _two(names: tuple[str, str], where: str, unit: str, delta: float, sign: str, second: float) -> dict[str, Parameter]:
    """Two parameters of one kind; `where` has {} for the name, the second is hidden at `second` times the first."""
    return {n: Parameter(where.format(n), unit, delta, sign, pattern=k) for n, k in zip(names, (1.0, second), strict=True)}


def _sides(whole: str, where: str, unit: str, delta: float, sign: str, left: float) -> dict[str, Parameter]:
    """Sum or mean, and right less left, of a pair: usually the right one is hidden at δ, the left one at `left` times that."""
    one = 0.5 if whole == "sum" else 1.0
    return {
        whole: Parameter(where, unit, delta, f"both: {sign}", pattern=(1 + left) / (2 * one), sides=(one, one)),
        "difference": Parameter(where, unit, delta, f"right less left: {sign}", pattern=1 - left, sides=(0.5, -0.5)),
    }


EFFECTS: dict[str, Effect] = {
    "tyre_saturation": Effect(
        _one("inv_mu", "chair.inv_mu", "1", 0.8, "friction limit is load / (1 + inv_mu): the chair's own tyres have 1/mu = 1"),
        sees="hard",
    ),
    "load_sensitivity": Effect(
        _one("exponent", "chair.load_exponent", "1", 0.1, "cornering stiffness times (load / 400 N)^exponent"), sees="mass"
    ),
    "inflation_pressure": Effect(
        _one("dp", "pressure_change", "bar", 0.3, "all runs are at dp more than told, which is 4 bar, or 2 bar in marked runs"),
        sees="pressure",
    ),
    "relaxation_length": Effect(
        _one("sigma", "chair.sigma", "m", 0.05, "replaces the rear tyres' own 0.01 m", combine=_at_least)
    ),
    "pneumatic_trail_decay": Effect(
        _one("inv_slip", "chair.inv_slip", "1/rad", 5.0, "trail / sqrt(1 + ((3 + inv_slip) slip)^2)"), sees="fierce"
    ),
    "camber_misalignment": Effect(
        _sides("sum", "chair.camber_{}", "rad", 0.005, "pushes the rolling wheel right; both alike turn the chair right", 0.2)
    ),
    "toe_misalignment": Effect(
        _sides("sum", "chair.toe_{}", "rad", 0.005, "positive turns the wheel clockwise seen from above", 0.0)
    ),
    "scrub_torque": Effect(_one("M", "chair.scrub", "N m", 0.2, "positive opposes the yaw rate, dry")),
    "scrub_torque_viscous": Effect(
        _one("d", "chair.scrub_viscous", "N m s", 0.2, "positive opposes the yaw rate, in proportion")
    ),
    "turn_slip": Effect(
        {
            "M": Parameter("chair.turn", "N m", 0.5, "each rear wheel on the spot, opposes the yaw rate, less on wider arcs"),
            "M_f": Parameter(
                "chair.turn_f", "N m", 0.1, "each caster on the spot, opposes its turning on the floor", pattern=0.5
            ),
        },
        sees="both-ways",  # a circle and a run backward: everyday turns leave M unsure by more than δ
    ),
    "pivot_torque": Effect(
        _one("M", "chair.pivot", "N m", 0.5, "each rear wheel where it stands, opposes the yaw rate, nothing once it rolls"),
        sees="one-handed",
    ),
    "longitudinal_slip": Effect(
        _one("compliance", "chair.slip_compliance", "1/N", 1e-4, "a driven wheel turns faster than its hub moves")
    ),
    "lateral_load_transfer": Effect(_one("h", "chair.h_y", "m", 0.3, "CM height: turning right loads the left wheels")),
    "longitudinal_load_transfer": Effect(_one("h", "chair.h_x", "m", 0.3, "CM height: gaining speed loads the rear wheels")),
    "cm_lateral_offset": Effect(_one("y", "chair.y_cm", "m", 0.004, "positive: the CM lies right of the middle plane")),
    "trunk_motion": Effect(
        {
            "amplitude": Parameter(
                "chair.trunk", "m", 0.01, "positive: CM goes forward on the frame by this per 80 N, lag 0.15 s"
            ),
            "swing": Parameter(
                "chair.lean",
                "m",
                0.005,
                "positive: CM swings forward, by this per 80 N were it slow, and on after",
                pattern=0.0,
            ),
        }
    ),
    "stroke_motion": Effect(
        _one("reach", "reach", "m", 0.01, "the body means to go forward by this and back, once around each stroke's beginning")
    ),
    "caster_inertia": Effect(
        _one("I", "chair.I_swivel", "kg m2", 0.005, "each caster's; replaces their own 0.003", combine=_at_least), sees="slow"
    ),
    "caster_friction": Effect(
        _one("M", "chair.swivel_dry", "N m", 0.05, "each bearing, against its swivel rate; replaces 0.002", combine=_at_least)
    ),
    "caster_trail": Effect(_one("c", "chair.trail", "m", 0.03, "added to the casters' own 0.05 m"), sees="slow"),
    "rolling_resistance_speed": Effect(
        _one("k", "chair.drag_speed", "N s/m", 0.3, "whole chair, by load on the wheels, positive drags")
    ),
    "rolling_resistance_asymmetry": Effect(
        _one("D", "chair.drag_difference", "N", 0.4, "left minus right rear wheel, half on each")
    ),
    "aerodynamic_drag": Effect(_one("k", "chair.aero", "N s2/m2", 0.2, "force k u |u| against the speed, at the CM")),
    "floor_slope": Effect(
        _two(("x", "y"), "chair.slope_{}", "rad", 0.001, "positive where the floor falls towards the room's axis", 0.7)
    ),
    "floor_cross_slope": Effect(
        _one("theta", "chair.cross_slope", "rad", 0.001, "positive: the floor falls to the chair's right, whatever its heading")
    ),
    "wheel_inertia": Effect(_one("m", "chair.m_spin", "kg", 1.0, "both rear wheels together, as mass along their heading")),
    "push_force_gain": Effect(
        _sides("mean", "instruments.force_{}", "1", 0.02, "the record is (1 + gain) times the push", -0.5)
    ),
    "push_force_delay": Effect(_one("tau", "instruments.force_early", "s", 0.01, "positive: the record is early")),
    "gyro_bias": Effect(_one("b", "instruments.gyro_bias", "rad/s", 0.003, "added to the reading")),
    "gyro_scale": Effect(_one("k", "instruments.gyro_scale", "1", 0.01, "the reading is (1 + k) times the rate")),
    "accelerometer_bias": Effect(_two(("x", "y"), "instruments.bias_{}", "m/s2", 0.03, "added to the reading", 0.5)),
    "accelerometer_offset": Effect(
        _two(("x", "y"), "instruments.offset_{}", "m", 0.03, "where it sits from the CM, forward and right", 1.0)
    ),
    "marker_offset": Effect(
        _two(("x", "y"), "instruments.marker_{}", "m", 0.02, "where it sits from the CM, forward and right", -0.5),
        channels=("x", "y", "yaw"),
    ),
    "accelerometer_tilt": Effect(
        _two(("roll", "pitch"), "instruments.{}", "rad", 0.005, "right side down: a_y - g roll; front up: a_x + g pitch", 0.6)
    ),
    "wheel_radius_error": Effect(
        _sides("mean", "instruments.speed_{}", "1", 0.01, "the reading is (1 + error) times the speed", -0.5)
    ),
    # Nothing below is in any catalogue.
    "caster_spring": Effect(
        _one("k", "chair.swivel_spring", "N m/rad", 0.5, "each caster is pulled straight by k sin(angle)"), catalogued=False
    ),
    "steering_wobble": Effect(
        _one("A", "chair.wobble", "N m", 0.3, "yaw torque A sin(heading), positive turns right"), catalogued=False
    ),
    "dead_zone": Effect(
        _one("F", "instruments.dead_zone", "N", 1.5, "smaller pushes are lost, larger ones act in full"), catalogued=False
    ),
    "speed_dependent_yaw_torque": Effect(
        _one("k", "chair.speed_torque", "N m s2/m2", 0.05, "yaw torque k u^2, positive turns right"), catalogued=False
    ),
    "sticky_axle": Effect(
        _one("D", "chair.sticky", "N", 0.4, "drag of the right rear wheel only while turning right"), catalogued=False
    ),
    "slipping_wheels": Effect(
        _one(
            "inv_mu",
            "chair.slippery",
            "1",
            1.0,
            "friction limit is load / (1 + inv_mu), and wheels that are pushed harder spin",
        ),
        sees="strong",
        catalogued=False,
        of_nobody=True,
    ),
    "uneven_floor": Effect(
        _one("slope", "chair.floor", "rad", 0.001, "rms slope, along and across, in waves of 0.7 to 4 m"),
        catalogued=False,
        of_nobody=True,
    ),
}
CATALOGUE = tuple(name for name, e in EFFECTS.items() if e.catalogued)
OUTSIDE = tuple(name for name, e in EFFECTS.items() if not e.catalogued and not e.of_nobody)


def usual(effect: str, times: float = 1.0) -> dict[str, float]:
    """The parameters of an effect at `times` its smallest interesting size."""
    return {name: times * p.pattern * p.delta for name, p in EFFECTS[effect].parameters.items()}


def of_every_chair() -> tuple[str, ...]:
    """Effects that are of interest in every chair as it is: casters have a trail."""
    return tuple(name for name, e in EFFECTS.items() if any(p.whole(0.0) >= p.delta for p in e.parameters.values()))


def own(manoeuvres: str) -> tuple[str, ...]:
    """Those of them that these manoeuvres show."""
    return tuple(name for name in of_every_chair() if EFFECTS[name].sees == manoeuvres)


def hide(truth: Truth, hidden: Mapping[str, Mapping[str, float]]) -> Truth:
    """The truth with these effects in it: {effect: {parameter: value}}; parameters left out are zero."""
    for effect, values in hidden.items():
        if effect not in EFFECTS:
            raise KeyError(f"no effect {effect!r}; there are {', '.join(EFFECTS)}")
        parameters = EFFECTS[effect].parameters
        for name, value in values.items():
            if name not in parameters:
                raise KeyError(f"{effect} has no parameter {name!r}; it has {', '.join(parameters)}")
            truth = parameters[name].put(truth, value)
    return truth
