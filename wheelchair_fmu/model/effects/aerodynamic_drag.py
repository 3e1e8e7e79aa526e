"""Air resistance:  F_x = −k u |u|,  k = ½ ρ C_d A. The F_aero of (20)."""

from ...quantities import N_S2_M2, Parameter
from ..alike import DRAG_SLOPE
from ..smooth import magnitude
from ..stage import Effect, adds

K = Parameter("k", N_S2_M2, "½ ρ C_d A", off=0.0, smallest_interesting=0.2, lower=0.0, upper=20.0, source="C_d A = 0.5 m²")

EFFECT = Effect(
    "aerodynamic_drag",
    "air resistance",
    parameters=(K,),
    contributions=(adds("F_x", lambda u, k, v_eps: -k * u * magnitude(u, v_eps), opposes="u"),),
    alike=(DRAG_SLOPE,),
)
