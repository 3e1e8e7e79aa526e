"""What the instruments on a chair read."""

from __future__ import annotations

from dataclasses import dataclass

from ..quantities import M_S, M_S2, RAD, RAD_S, REAR, M, Output, Unit
from .frames import to_room
from .stage import Law, Stage, define, stage


@dataclass(frozen=True)
class Reading:
    """An instrument that reads one number in every model: a channel of campaigns, and the FMU's output `sensor.<name>`.

    `law` is a plain function of symbols, `low` and `high` bound what is plausible, in `unit`. `mirror` is "-" for what turns
    its sign in a mirror along the chair, as all to the right and clockwise does. `nominal` is a usual size.
    """

    name: str
    unit: Unit
    meaning: str
    law: Law
    low: float
    high: float
    mirror: str = "+"
    nominal: float = 1.0
    wrong_unit: str = ""  # the unit that is most often meant when the size is implausible

    @property
    def stage(self) -> Stage:
        return Stage(self.law, (define(f"read_{self.name}", self.unit, self.meaning, self.mirror),))

    @property
    def output(self) -> Output:
        name, symbol = f"sensor.{self.name}", f"read_{self.name}"
        return Output(name, self.unit, self.meaning, self.mirror, symbol=symbol, nominal=self.nominal)


@stage(
    define("read_wheel_speed", M_S, "wheel speeds, angular speed times rolling radius", "+swap", REAR),
    define("read_yaw_rate", RAD_S, "yaw rate", "-"),
    define("read_a_x", M_S2, "specific force along x_m", "+"),
    define("read_a_y", M_S2, "specific force along y_m", "-"),
    define("read_x", M, "x of the CM in the room"),
    define("read_y", M, "y of the CM in the room", "-"),
    define("read_yaw", RAD, "yaw angle", "-"),
    define("read_u", M_S, "speed of the CM along x_m"),
    define("read_v", M_S, "speed of the CM along y_m", "-"),
)
def sensors(rim, psi_dot, a_x, a_y, g_x, g_y, x, y, psi, u, v, shift, recoil, recoil_rate, M_z, inertia):
    """An accelerometer does not feel gravity along its axis.

    Instruments are on the frame, where the CM is while the rider's body rests: r − shift e_x is the way of that point.
    """
    back_x, back_y = to_room(shift, 0.0, psi)
    felt_x = a_x - g_x + recoil_rate + shift * psi_dot * psi_dot
    felt_y = a_y - g_y + 2 * recoil * psi_dot - shift * M_z / inertia
    return rim, psi_dot, felt_x, felt_y, x - back_x, y - back_y, psi, u + recoil, v - shift * psi_dot
