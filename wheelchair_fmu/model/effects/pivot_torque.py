"""A patch held only where its wheel stands:  M_z = −M L ψ' / √(v² + (L ψ')²) at each rear wheel, with an L of half a patch.

The law is that of `turn_slip`, whose patches resist on arcs of up to their reach. A patch that slides easily, worn or on a
dusty floor, slides all over as soon as its wheel rolls: then a wheel that the chair turns about is held, by M, and the wheel
that goes round it is not.
"""

from ...quantities import N_M, M, Parameter
from ..alike import TURNED_PATCHES
from ..signs import Shows
from ..sketch import REAR_RIGHT, Arrow, Turn, Wheel, from_above
from ..stage import Effect, adds
from .turn_slip import RATE, resistance

TORQUE = Parameter(
    "M",
    N_M,
    "torque M that turning one rear wheel takes where it stands, or nearly so",
    off=0.0,
    smallest_interesting=0.5,
    lower=0.0,
    upper=8.0,
    symbol="M_pivot",
    source="chosen; at most what μN has at half a patch; Fallot2021: less the wider the path",
)
LENGTH = Parameter(
    "L",
    M,
    "radius L of the wheel's path below which its patch is held",
    default=0.04,
    lower=0.01,
    upper=5.0,
    symbol="L_pivot",
    source="chosen: about half a patch's length",
)


def pivot(M_pivot, L_pivot, psi_dot, v_xw, rate):
    return resistance(M_pivot, L_pivot, psi_dot, v_xw, rate)


EFFECT = Effect(
    "pivot_torque",
    "contact patches that resist being turned where their wheel stands",
    parameters=(TORQUE,),
    constants=(LENGTH, RATE),
    contributions=(adds("M_t", pivot, opposes="psi_dot"),),
    alike=(TURNED_PATCHES,),
    signs=(Shows("spin", "chair.psi_dot", more=False),),
    sketches=(
        from_above(
            Wheel("rr"),
            Turn(REAR_RIGHT, "M", clockwise=False),
            Turn((0, 0.05), "ψ'", radius=0.07, moves=True),
            Arrow((-0.4, -0.2), (-0.4, 0.1), "rolls", moves=True),
        ),
    ),
)
