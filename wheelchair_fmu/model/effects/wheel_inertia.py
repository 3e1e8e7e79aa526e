"""Spin inertia of the rear wheels, as the mass m = 2 I / R² that they add to the chair's, also in a turn."""

from ...quantities import KG, Parameter
from ..alike import EFFECTIVE_MASS
from ..signs import Shows
from ..sketch import Turn, Wheel, from_the_side
from ..stage import Effect, adds

MASS = Parameter(
    "m",
    KG,
    "equivalent mass 2 I / R² of both wheels' spin inertia",
    off=0.0,
    smallest_interesting=1.0,
    lower=0.0,
    upper=50.0,
    symbol="m_w",
    known_to=0.2,
    source="published wheelchair models: 0.14 kg m²",
)

EFFECT = Effect(
    "wheel_inertia",
    "spin inertia of the rear wheels",
    parameters=(MASS,),
    contributions=(adds("mass_u", lambda m_w: m_w), adds("inertia", lambda m_w, t_r: m_w * t_r * t_r / 4)),
    alike=(EFFECTIVE_MASS,),
    signs=(Shows("start-stop", "chair.u", more=False),),
    sketches=(from_the_side(Wheel("rear"), Turn((-0.2, 0.31), "I = m R²/2", radius=0.13)),),
)
