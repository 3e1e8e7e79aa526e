"""Traction needs slip: a driven wheel turns faster than it rolls, by  compliance · F |v_x|, a braked one slower."""

from ...quantities import PER_N, Parameter
from ..signs import Shows
from ..sketch import Arrow, Turn, Wheel, from_the_side
from ..smooth import magnitude
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


def creep(compliance, creeping, v_xw, v_eps):
    return compliance * creeping * magnitude(v_xw, v_eps)


EFFECT = Effect(
    "longitudinal_slip",
    "traction that needs slip",
    parameters=(COMPLIANCE,),
    contributions=(adds("read_wheel_speed", creep),),
    signs=(Shows("start-stop", "sensor.wheel_speed_r", more=True),),
    sketches=(
        from_the_side(
            Wheel("rear"),
            Turn((-0.2, 0.31), "turns faster", radius=0.13),
            Arrow((-0.2, -0.06), (0.05, -0.06), "traction", moves=True),
        ),
    ),
)
