"""A torque that resists turning in proportion to the yaw rate:  M_z = −d ψ'."""

from ...quantities import N_M_S, Parameter
from ..alike import TURNED_PATCHES, YAW_RESISTANCE
from ..signs import Shows
from ..sketch import Turn, from_above
from ..stage import Effect, adds

D = Parameter(
    "d",
    N_M_S,
    "torque per yaw rate d that resists turning",
    off=0.0,
    smallest_interesting=0.2,
    lower=0.0,
    upper=50.0,
    source="chosen",
)

EFFECT = Effect(
    "scrub_torque_viscous",
    "a torque that resists turning in proportion to the yaw rate",
    parameters=(D,),
    contributions=(adds("M_z", lambda d, psi_dot: -d * psi_dot, opposes="psi_dot"),),
    alike=(TURNED_PATCHES, YAW_RESISTANCE),
    signs=(Shows("spin", "chair.psi_dot", more=False),),
    sketches=(from_above(Turn((0, 0), "d ψ'", clockwise=False, radius=0.17), Turn((0, 0), "ψ'", radius=0.08, moves=True)),),
)
