"""Traction needs slip: a driven wheel turns faster than it rolls, by  compliance · F |v_x|."""

from ...quantities import PER_N, Parameter
from ..smooth import magnitude
from ..stage import Effect, adds

COMPLIANCE = Parameter("compliance", PER_N, "longitudinal slip per newton of traction", off=0.0, smallest_interesting=1e-4,
                       lower=0.0, upper=0.02, source="Pacejka: inverse longitudinal stiffness")  # fmt: skip


def creep(compliance, F_t, v_xr, v_eps):
    return compliance * F_t * magnitude(v_xr, v_eps)


EFFECT = Effect(
    "longitudinal_slip",
    "traction that needs slip",
    parameters=(COMPLIANCE,),
    contributions=(adds("read_wheel_speed", creep),),
)
