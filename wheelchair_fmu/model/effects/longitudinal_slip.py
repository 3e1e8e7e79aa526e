"""Traction needs slip: a driven wheel turns faster than it rolls, by  compliance · F |v_x|, a braked one slower."""

import casadi as cs

from ...quantities import PER_N, Parameter
from ..smooth import grip, magnitude
from ..stage import Effect, adds

COMPLIANCE = Parameter(
    "compliance",
    PER_N,
    "longitudinal slip per newton of traction",
    off=0.0,
    smallest_interesting=1e-4,
    lower=0.0,
    upper=0.02,
    source="Pacejka: inverse longitudinal stiffness",
)


def creep(compliance, F_t, brake_rl, brake_rr, F_max, v_xw, drag_eps, v_eps):
    traction = F_t - F_max * cs.vertcat(brake_rl, brake_rr) * grip(v_xw, v_xw * v_xw, drag_eps)
    return compliance * traction * magnitude(v_xw, v_eps)


EFFECT = Effect(
    "longitudinal_slip", "traction that needs slip", parameters=(COMPLIANCE,), contributions=(adds("read_wheel_speed", creep),)
)
