"""The pneumatic trail shrinks with slip, so the self-aligning torque saturates before the force:  M / (1 + inv_slip |λ|)."""

from ...quantities import PER_RAD, RAD, Parameter
from ..signs import Shows
from ..sketch import Curve, graph
from ..smooth import magnitude
from ..stage import Effect, scales

INV_SLIP = Parameter(
    "inv_slip",
    PER_RAD,
    "inverse of the slip angle at which the trail has halved",
    off=0.0,
    smallest_interesting=5.0,
    lower=0.0,
    upper=500.0,
    source="Doria, Fig. 4.2",
)
ROUNDING = Parameter(
    "rounding", RAD, "slip angle within which |λ| is rounded off", default=1e-4, lower=1e-8, upper=0.1, source="chosen"
)


def decay(inv_slip, lam_F, rounding):
    return 1 / (1 + inv_slip * (magnitude(lam_F, rounding) - rounding))


EFFECT = Effect(
    "pneumatic_trail_decay",
    "self-aligning torque that saturates before the force",
    parameters=(INV_SLIP,),
    constants=(ROUNDING,),
    contributions=(scales("M_lam", decay),),
    signs=(Shows("steady-turn", "chair.curvature", more=True),),
    sketches=(
        graph(
            "slip angle λ",
            "self-aligning torque",
            Curve(lambda x: 0.95 * x, "", before=True),
            Curve(lambda x: 0.95 * x / (1 + 1.6 * x), "inv_slip above 0"),
        ),
    ),
)
