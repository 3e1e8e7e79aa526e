"""What several effects do alike, so that data show it and not which of them does it."""

from __future__ import annotations

from collections.abc import Mapping

from .stage import Alike, Effect

READING_OFFSET = Alike(
    "an offset of the accelerometer",
    told_by="nothing that the chair does, but by readings at rest with the sensor turned round",
)
WHOLE_SCALE = Alike(
    "the scale of all that drives and resists: with every mass, stiffness and push so much larger the chair moves the same",
    told_by="no motion, but by weighing the chair or the force sensors",
    with_parameters=("chair.m", "chair.I_z", "tyre.C_lambda", "tyre.C_m_lambda"),
)
YAW_RESISTANCE = Alike(
    "yaw resistance, or how far a turn goes wide", told_by="turns of one radius at several speeds, and a spin on the spot"
)
TURNED_PATCHES = Alike(
    "a torque against the turn: turn_slip is the dry one on the spot and, at one speed, the viscous one on wide arcs, "
    "pivot_torque is there only about a wheel that stands; where a chair only rolls, casters that drag more and rear wheels "
    "that drag less do nearly the same",
    told_by="a spin on the spot and a turn about one wheel, beside turns of several radii at several speeds",
    with_parameters=("resistance.f_r", "resistance.f_f"),
    one_cause=True,
)
MOVING_BODY = Alike(
    "the motion of the rider's body: trunk_motion has it follow the push, stroke_motion go the same way in each stroke",
    told_by="strokes of several strengths and rhythms, or markers on the trunk, read as rider.s",
    one_cause=True,
)
EFFECTIVE_MASS = Alike(
    "the mass that pushes have to set going",
    told_by="a chair that was weighed, and turns, in which spinning wheels and a high centre of mass do other things than mass",
    with_parameters=("chair.m",),
)
SIDE_PULL = Alike("a pull to one side", told_by="going the same way backward, and by an accelerometer's a_y")
DRAG_SLOPE = Alike(
    "how drag grows with speed, about the mean speed of a run", told_by="a coast-down from at least twice the usual speed"
)


def look_alikes(effect: Effect, alike: Alike, catalogue: Mapping[str, Effect]) -> tuple[str, ...]:
    """What does the same as an effect: ids of others in the catalogue, and parameters of the chair."""
    others = (id for id, other in catalogue.items() if id != effect.id and alike in other.alike)
    return (*others, *alike.with_parameters)
