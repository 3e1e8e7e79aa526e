"""Patches that resist being turned:  M_z = −M L ψ' / √(v² + (L ψ')²) at each rear wheel, and so at each caster.

A wheel that rolls along a wide arc hardly turns its patch on the floor: the torque is M L / R_c there, the turn slip stiffness
over the radius R_c = v/ψ' of the wheel's own path. Around a radius below L the patch slides, and on the spot the torque is M.
A caster turns with δ' + ψ'; an ideal one, whose angle has no rate of its own, as in a steady turn with ψ'. What the floor does
to a caster's patch its bearing does not feel: it is held by a lateral force at the trail's length, (8).
"""

import casadi as cs

from ...quantities import N_M, RAD_S, M, Parameter
from ..alike import TURNED_PATCHES, YAW_RESISTANCE
from ..signs import Shows
from ..sketch import REAR_LEFT, REAR_RIGHT, Turn, Wheel, from_above
from ..stage import Effect, adds

TORQUE = Parameter(
    "M",
    N_M,
    "torque M that turning one rear wheel on the spot takes",
    off=0.0,
    smallest_interesting=0.5,
    lower=0.0,
    upper=8.0,
    symbol="M_turn",
    source="chosen; at most what μN has at half a patch; Fallot2021: less the wider the path",
)
CASTER_TORQUE = Parameter(
    "M_f",
    N_M,
    "torque M_f that turning one caster on the spot takes",
    off=0.0,
    smallest_interesting=0.1,
    lower=0.0,
    upper=2.0,
    symbol="M_turn_f",
    source="chosen; Fallot2021: less than a rear wheel's",
)
LENGTH = Parameter(
    "L",
    M,
    "radius L below which a rear wheel's patch slides round: C_mλ times half the patch's length, over M",
    default=0.6,
    lower=0.01,
    upper=5.0,
    symbol="L_turn",
    source="chosen: 45 N m/rad, half a patch of 34 mm and 2.5 N m; Pacejka, turn slip",
    known_to=0.4,
)
CASTER_LENGTH = Parameter(
    "L_f",
    M,
    "radius L_f below which a caster's patch slides round",
    default=0.1,
    lower=0.01,
    upper=5.0,
    symbol="L_turn_f",
    source="chosen: a patch of a third of the length",
)
RATE = Parameter(
    "rate",
    RAD_S,
    "yaw rate within which the torque of a standing wheel builds up",
    default=0.01,
    lower=1e-5,
    upper=1.0,
    source="chosen",
)


def resistance(torque, length, yaw_rate, v, rate):
    """M_z of a patch that turns with `yaw_rate` while its wheel moves with v."""
    swept = length * length * (yaw_rate * yaw_rate + rate * rate)
    return -torque * length * yaw_rate / cs.sqrt(v * v + swept)


def rear(M_turn, L_turn, psi_dot, v_xw, rate):
    return resistance(M_turn, L_turn, psi_dot, v_xw, rate)


def front(M_turn_f, L_turn_f, turning, rolling, rate):
    return resistance(M_turn_f, L_turn_f, turning, rolling, rate)


EFFECT = Effect(
    "turn_slip",
    "contact patches that resist being turned",
    parameters=(TORQUE, CASTER_TORQUE),
    constants=(LENGTH, CASTER_LENGTH, RATE),
    contributions=(adds("M_t", rear, opposes="psi_dot"), adds("M_p", front, opposes="turning")),
    alike=(TURNED_PATCHES, YAW_RESISTANCE),
    signs=(Shows("spin", "chair.psi_dot", more=False), Shows("steady-turn", "chair.curvature", more=False)),
    sketches=(
        from_above(
            Wheel("rl"),
            Wheel("rr"),
            Wheel("fl"),
            Wheel("fr"),
            Turn(REAR_LEFT, "", clockwise=False),
            Turn(REAR_RIGHT, "M", clockwise=False),
            Turn((-0.225, 0.2), "", clockwise=False, radius=0.07),
            Turn((0.225, 0.2), "M_f", clockwise=False, radius=0.07),
            Turn((0, 0), "ψ'", radius=0.07, moves=True),
        ),
    ),
)
