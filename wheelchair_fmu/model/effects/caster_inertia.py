"""Swivel inertia of the casters: turning one takes a lateral force at its patch,  c F = −I (δ'' + ψ''), (8).

No bearing turns the caster, so the chair feels the force at the pivot and no moment. The acceleration is that of the swivel
rate through a short filter, Ω' = (δ' + ψ' − Ω)/τ, because the rate itself may jump with the pushes.
"""

import casadi as cs

from ...quantities import FRONT, KG_M2, RAD_S, Parameter, S, State
from ..signs import Shows
from ..sketch import PIVOT_LEFT, PIVOT_RIGHT, Turn, Wheel, from_above
from ..stage import Effect, Row, adds

INERTIA = Parameter(
    "I",
    KG_M2,
    "moment of inertia I of each caster about its pivot",
    off=0.0,
    smallest_interesting=0.005,
    lower=0.0,
    upper=0.5,
    source="Doria, (8)",
)
FILTER = Parameter(
    "filter",
    S,
    "time constant that smooths the swivel rate",
    default=0.02,
    lower=1e-4,
    upper=1.0,
    symbol="T_filter",
    source="chosen",
)
RATE = State(
    "smoothed_rate",
    RAD_S,
    "turning rate of each caster in the room, smoothed",
    mirror="-swap",
    components=FRONT,
    nominal=10.0,
    usual=0.1,
)


def acceleration(swivel_rate, psi_dot, smoothed_rate, T_filter):
    return (swivel_rate + psi_dot - smoothed_rate) / T_filter


def reaction(I, swivel_rate, psi_dot, smoothed_rate, T_filter):  # noqa: E741
    return -I * acceleration(swivel_rate, psi_dot, smoothed_rate, T_filter)


def spun(I, swivel_rate, psi_dot, smoothed_rate, T_filter, c, lever):  # noqa: E741
    """Of ½ I Ω², as far as the trail passes it on."""
    return cs.sum1(c / lever * I * smoothed_rate * acceleration(swivel_rate, psi_dot, smoothed_rate, T_filter))


EFFECT = Effect(
    "caster_inertia",
    "swivel inertia of the casters",
    parameters=(INERTIA,),
    constants=(FILTER,),
    contributions=(adds("M_p", reaction),),
    rows=(Row(RATE, lambda: 1.0, acceleration),),
    needs={"caster": "swivelling"},
    through=("caster_trail",),
    absorbs=spun,
    signs=(Shows("spin", "chair.psi_dot", more=False),),
    sketches=(
        from_above(
            Wheel("fl", 25),
            Wheel("fr", 25),
            Turn(PIVOT_LEFT, "", clockwise=False),
            Turn(PIVOT_RIGHT, "I δ''", clockwise=False),
            Turn((0, -0.05), "δ''", radius=0.07, moves=True),
        ),
    ),
)
