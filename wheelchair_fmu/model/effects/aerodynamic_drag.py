"""Air resistance:  F_x = −k u |u|,  k = ½ ρ C_d A. The F_aero of (20)."""

from ...quantities import N_S2_M2, Parameter
from ..alike import DRAG_SLOPE
from ..signs import Shows
from ..sketch import Arrow, from_the_side
from ..smooth import magnitude
from ..stage import Effect, adds

K = Parameter(
    "k",
    N_S2_M2,
    "air resistance by the speed squared, ½ ρ C_d A",
    off=0.0,
    smallest_interesting=0.2,
    lower=0.0,
    upper=20.0,
    source="C_d A = 0.5 m²",
)

EFFECT = Effect(
    "aerodynamic_drag",
    "air resistance",
    parameters=(K,),
    contributions=(adds("F_x", lambda u, k, v_eps: -k * u * magnitude(u, v_eps), opposes="u"),),
    alike=(DRAG_SLOPE,),
    signs=(Shows("coast-down", "chair.u", more=False),),
    sketches=(from_the_side(Arrow((0, 0.6), (-0.3, 0.6), "k u²"), Arrow((0.3, 0.75), (0.52, 0.75), "u", moves=True)),),
)
