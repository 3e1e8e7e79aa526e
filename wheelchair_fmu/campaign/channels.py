"""What a campaign may hold: measured channels, and the inputs that drive the chair."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from ..model.readings import READINGS
from ..model.sensors import Reading
from ..quantities import HZ, M_S, M_S2, N_M, N_S, ONE, RAD, RAD_S, M, N, S, Unit


@dataclass(frozen=True)
class Channel:
    """A column under its own name, in SI units and SAE J670 axes.

    `fmu` is the FMU output that predicts it, or the FMU input that it feeds. `iso_sign` is its factor from
    ISO 8855 to SAE J670. `low` and `high` bound what is plausible. A wheel turns `rotary` units into this
    channel's unit: value = rotary value · radius ** rotary_power. In one that `drifts`, whatever pushed the chair a little
    stays for good. `starts` is the start parameter that its first readings tell; `side` is "l" or "r" where the other side
    has one like it. From this record follow starts, wiring checks, at which level two signals are compared for their clocks,
    tables of what a column may be, and the page's.
    """

    name: str
    unit: Unit
    fmu: str
    meaning: str
    low: float
    high: float
    iso_sign: int = 1
    rotary: Unit | None = None
    rotary_power: int = 0
    wrong_unit: str = ""  # the unit that is most often meant when the size is implausible
    drifts: bool = False
    starts: str = ""
    side: str = ""

    @property
    def integrals(self) -> int:
        """How often it has to be differentiated to be an acceleration."""
        return _INTEGRALS.get(self.unit.name, 0)

    @property
    def confused(self) -> tuple[float, str]:
        """How many times as large the readings are in the unit they are most often left in, and that unit in words."""
        return _CONFUSED.get(self.unit.name, (1000.0, f"thousandths of {self.unit.name}"))


# by SI unit
_INTEGRALS = {"m": 2, "rad": 2, "m/s": 1, "rad/s": 1}
_CONFUSED = {
    "rad": (180 / pi, "degrees"),
    "rad/s": (180 / pi, "deg/s"),
    "m/s": (3.6, "km/h"),
    "m": (1000.0, "mm"),
    "m/s2": (9.81, "g"),
}


def _wheel_speed(side: str, word: str) -> Channel:
    return Channel(
        f"wheel_speed_{side}",
        M_S,
        f"sensor.wheel_speed_{side}",
        f"speed of the {word} rear wheel at its rim of contact, positive forward",
        -15.0,
        15.0,
        rotary=RAD_S,
        rotary_power=1,
        wrong_unit="km/h",
        side=side,
    )


def _pushes(side: str, word: str) -> tuple[Channel, ...]:
    return (
        Channel(
            f"F_{side}",
            N,
            f"push.F_{side}",
            f"push force on the {word} rear wheel, positive forward",
            -2000.0,
            2000.0,
            rotary=N_M,
            rotary_power=-1,
            wrong_unit="lbf or N.m",
        ),
        Channel(
            f"M_{side}",
            N_M,
            f"push.M_{side}",
            f"torque on the {word} rear axle, positive forward",
            -600.0,
            600.0,
            wrong_unit="lbf.ft",
        ),
        Channel(
            f"brake_{side}", ONE, f"brake.{side}", f"brake on the {word} rear wheel, 0 free, 1 full", 0.0, 1.0, wrong_unit="%"
        ),
    )


def _reading(r: Reading) -> Channel:
    """What turns its sign in a mirror along the chair does so from ISO 8855 to SAE J670, too."""
    iso_sign = -1 if r.mirror.startswith("-") else 1
    return Channel(r.name, r.unit, f"sensor.{r.name}", r.meaning, r.low, r.high, iso_sign, wrong_unit=r.wrong_unit)


TIME = Channel("time", S, "time", "time of the sample", -1e12, 1e12)

CHANNELS: tuple[Channel, ...] = (
    _wheel_speed("l", "left"),
    _wheel_speed("r", "right"),
    Channel(
        "yaw_rate",
        RAD_S,
        "sensor.yaw_rate",
        "yaw rate, positive clockwise from above",
        -20.0,
        20.0,
        -1,
        wrong_unit="deg/s",
        starts="start.psi_dot",
    ),
    Channel("a_x", M_S2, "sensor.a_x", "specific force forward", -100.0, 100.0, wrong_unit="g"),
    Channel("a_y", M_S2, "sensor.a_y", "specific force to the right", -100.0, 100.0, -1, wrong_unit="g"),
    Channel("x", M, "sensor.x", "position along the room's x", -1e4, 1e4, wrong_unit="mm", drifts=True, starts="start.x"),
    Channel(
        "y",
        M,
        "sensor.y",
        "position along the room's y, to the right of x",
        -1e4,
        1e4,
        -1,
        wrong_unit="mm",
        drifts=True,
        starts="start.y",
    ),
    Channel(
        "yaw",
        RAD,
        "sensor.yaw",
        "heading, positive clockwise from above",
        -200.0,
        200.0,
        -1,
        wrong_unit="deg",
        drifts=True,
        starts="start.psi",
    ),
    Channel(
        "u",
        M_S,
        "sensor.u",
        "speed of the centre of mass, or of the point it is `at`, forward",
        -15.0,
        15.0,
        wrong_unit="km/h",
        starts="start.u",
    ),
    Channel(
        "v",
        M_S,
        "sensor.v",
        "speed of the centre of mass, or of the point it is `at`, to the right",
        -15.0,
        15.0,
        -1,
        wrong_unit="km/h",
    ),
    *map(_reading, READINGS),
)

RIDER: tuple[Channel, ...] = (
    Channel(
        "rider.s",
        M,
        "rider.s",
        "how far the mass [rider] m of the rider's body has moved forward against the frame",
        -2.0,
        2.0,
        wrong_unit="mm",
    ),
    Channel(
        "rider.momentum", N_S, "rider.momentum", "momentum of the rider's body relative to the frame, forward", -300.0, 300.0
    ),
    Channel("rider.force", N, "rider.force", "rate of change of rider.momentum", -3000.0, 3000.0),
)

STROKE: tuple[Channel, ...] = (
    Channel(
        "stroke.phase",
        ONE,
        "stroke.phase",
        "strokes since the first, as a number that grows steadily from one to the next; without it, the pushes tell",
        -1e5,
        1e5,
    ),
    Channel("stroke.rate", HZ, "stroke.rate", "rate of change of stroke.phase", -20.0, 20.0),
)

FLOOR: tuple[Channel, ...] = (
    Channel(
        "floor.rolling_factor",
        ONE,
        "floor.rolling_factor",
        "factor of the floor on both rolling resistances, 1 on a hard one; as a constant also a name of `wheelchair surfaces`",
        0.1,
        20.0,
        wrong_unit="%",
    ),
    Channel(
        "floor.slope_x",
        RAD,
        "floor.slope_x",
        "slope of the floor along the room's x, positive where it falls towards +x",
        -0.5,
        0.5,
        wrong_unit="deg",
    ),
    Channel(
        "floor.slope_y",
        RAD,
        "floor.slope_y",
        "slope of the floor along the room's y, positive where it falls towards +y",
        -0.5,
        0.5,
        -1,
        wrong_unit="deg",
    ),
)

INPUTS: tuple[Channel, ...] = (
    *(channel for pair in zip(_pushes("rl", "left"), _pushes("rr", "right"), strict=True) for channel in pair),
    *RIDER,
    *STROKE,
    *FLOOR,
)

# What a file may hold that channels are made from: the turn of a wheel, by which its ripple goes too.
SOURCES: tuple[Channel, ...] = tuple(
    Channel(
        f"wheel_angle_{side}",
        RAD,
        "",
        f"angle of the {word} rear wheel, rising forward; its speed is made from it",
        -1e6,
        1e6,
        wrong_unit="deg",
    )
    for side, word in (("l", "left"), ("r", "right"))
)

BY_NAME: dict[str, Channel] = {channel.name: channel for channel in CHANNELS + INPUTS}
BY_FMU_NAME: dict[str, Channel] = {channel.fmu: channel for channel in CHANNELS + INPUTS}
TELLS: dict[str, Channel] = {channel.starts: channel for channel in CHANNELS if channel.starts}
INTEGRALS: dict[str, int] = {channel.name: channel.integrals for channel in CHANNELS}
SIDES: tuple[str, ...] = tuple(channel.name for channel in CHANNELS if channel.side)  # the left one first
CHANNEL_NAMES = tuple(channel.name for channel in CHANNELS)
INPUT_NAMES = tuple(channel.name for channel in INPUTS)
PUSHED = tuple(channel.name for channel in INPUTS if channel not in (*RIDER, *STROKE, *FLOOR))  # what hands give
PUSH_NAMES = ("F_rl", "F_rr", "M_rl", "M_rr")
MOUNTED = {
    "accelerometer_offset": ("a_x", "a_y"),
    "marker_offset": ("x", "y", "u", "v"),
}  # what one instrument reads, if nothing else is said
BODY_NAMES = POSITION, MOMENTUM, FORCE = tuple(channel.name for channel in RIDER)  # of the rider's body
PHASE, PHASE_RATE = (channel.name for channel in STROKE)
ROLLING_FACTOR = FLOOR[0].name
PUSHES = {"F_rl": "M_rl", "F_rr": "M_rr"}  # a push must be known, as a force or as an axle torque
