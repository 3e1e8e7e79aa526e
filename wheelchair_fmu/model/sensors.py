"""What the instruments on a chair read."""

from __future__ import annotations

from ..quantities import M_S, M_S2, RAD, RAD_S, REAR, M
from .stage import define, stage


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
def sensors(v_xw, locked, psi_dot, a_x, a_y, g_x, g_y, x, y, psi, u, v):
    """Wheels roll without longitudinal slip unless they are locked; an accelerometer does not feel gravity along its axis."""
    return (1 - locked) * v_xw, psi_dot, a_x - g_x, a_y - g_y, x, y, psi, u, v
