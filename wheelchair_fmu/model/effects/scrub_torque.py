"""Dry friction of the turning contact patches:  M_z = −M sign(ψ')."""

from ...quantities import N_M, RAD_S, Parameter
from ..alike import TURNED_PATCHES
from ..signs import Shows
from ..sketch import Turn, from_above
from ..smooth import grip
from ..stage import Effect, adds

TORQUE = Parameter(
    "M",
    N_M,
    "dry torque M that resists turning",
    off=0.0,
    smallest_interesting=0.2,
    lower=0.0,
    upper=20.0,
    symbol="M_scrub",
    source="Doria, section 3",
)
RATE = Parameter(
    "rate", RAD_S, "yaw rate within which the dry torque builds up", default=0.01, lower=1e-5, upper=1.0, source="chosen"
)


def scrub(M_scrub, psi_dot, rate):
    return -M_scrub * grip(psi_dot, psi_dot * psi_dot, rate)


EFFECT = Effect(
    "scrub_torque",
    "dry friction of the turning contact patches",
    parameters=(TORQUE,),
    constants=(RATE,),
    contributions=(adds("M_z", scrub, opposes="psi_dot"),),
    alike=(TURNED_PATCHES,),
    signs=(Shows("spin", "chair.psi_dot", more=False),),
    sketches=(from_above(Turn((0, 0), "M", clockwise=False, radius=0.17), Turn((0, 0), "ψ'", radius=0.08, moves=True)),),
)
