"""What two devices see alike.

::

    device A                     device B
    a wheel's speed              the same; or speed and yaw rate of the frame; or a_x and yaw rate, one derivative up
    mean of the wheels           speed of the frame; or a_x, one derivative up
    yaw rate, speed, a_x         the same; or both wheels
    any of these, differentiated pushes on the rims, where nothing else is shared: gains (masses) and drag are free

Gains are free in all of them: they say whether the unit, the sign, the side and the track are what they are called.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from .equation import Equation
from .signals import ALONG, APART, FORWARD, LEFT, MEAN, PUSH_L, PUSH_R, RIGHT, SWAY, SWAYING, TURN, TURN2, Device

MOTION, PUSHES, PART = KINDS = "motion", "pushes", "a part of the motion"
FORWARDS, TURNS = "speeding up", "turning"
BODY_LAG = 0.006  # s by which pushes and motion are unsure: dampings of the rider's body that fit as well move the lag so far
MOVING = 0.02  # m/s, speed at which rolling resistance has its whole size


@dataclass(frozen=True)
class View:
    """`target` of A, differentiated `order` times, against `seen` of B, each with how many times."""

    target: str
    order: int
    seen: tuple[tuple[str, int], ...]
    drag: bool = False

    @property
    def words(self) -> str:
        names = [f"{'change of ' * order}{name}" for name, order in ((self.target, self.order), *self.seen)]
        return f"{names[0]} against {' and '.join(names[1:])}"


def views(a: Device, b: Device, kind: str) -> tuple[View, ...]:
    """What of A follows from B, by one kind of view; empty where there is nothing."""
    return tuple(_BY_KIND[kind](a, b))


def _motion(a: Device, b: Device) -> Iterator[View]:
    """Rigid frame: a wheel's speed is u ± t/2 · yaw rate, and a_x of a sensor is u̇ less its place times ψ̈ and ψ̇²."""
    same = [f for f in (LEFT, RIGHT, ALONG, TURN) if a.has(f) and b.has(f)]
    yield from (View(f, 0, ((f, 0),)) for f in same)
    place = ((TURN, 1), (TURN2, 0)) if b.has(TURN) else ()
    if a.has(FORWARD) and b.has(FORWARD):
        yield View(FORWARD, 0, ((FORWARD, 0), *place))
    if a.has(APART) and b.has(TURN) and TURN not in same:
        yield View(APART, 0, ((TURN, 0),))
    wheels = [w for w in (LEFT, RIGHT) if a.has(w) and w not in same]
    if b.has(ALONG, TURN):
        yield from (View(w, 0, ((ALONG, 0), (TURN, 0))) for w in wheels)
    elif b.has(ALONG) and a.has(MEAN) and wheels:
        yield View(MEAN, 0, ((ALONG, 0),))
    elif b.has(FORWARD) and not a.has(FORWARD):
        if len(wheels) == 2:
            yield View(MEAN, 1, ((FORWARD, 0), *place))
        elif wheels and b.has(TURN):
            yield View(wheels[0], 1, ((FORWARD, 0), *place))


def _loosely(a: Device, b: Device) -> Iterator[View]:
    """One of two numbers that the motion has: right where the other hardly changes."""
    for f in (MEAN, ALONG, LEFT, RIGHT):
        if a.has(f):
            seen = next((g for g in (MEAN, ALONG, LEFT, RIGHT, FORWARD, TURN) if b.has(g)), None)
            if seen:
                yield View(f, int(seen == FORWARD), ((seen, 0),))
            return


def _pushes(a: Device, b: Device) -> Iterator[View]:
    """Two bodies: each acceleration is a sum of the pushes, less drag, and of a rider's body that stays behind."""
    seen = tuple((p, 0) for p in (PUSH_L, PUSH_R) if b.has(p))
    same = [p for p, _ in seen if a.has(p)]
    if same:
        yield from (View(p, 0, ((p, 0),)) for p in same)
        return
    if len(seen) < 2:
        return
    body = ((SWAY, 0), (SWAYING, 0))
    wheels = [w for w in (LEFT, RIGHT) if a.has(w)]
    for f in wheels or [f for f in (ALONG,) if a.has(f)]:
        yield View(f, 1, seen + body, drag=True)
    if not wheels and not a.has(ALONG) and a.has(FORWARD):
        yield View(FORWARD, 0, seen + body)
    if len(wheels) < 2 and a.has(TURN):
        yield View(TURN, 1, seen, drag=True)


def rigid(device: Device, way: str) -> tuple[View, ...]:
    """What the pushes of a device do to its own readings: on along its way, or in turning."""
    seen = tuple((p, 0) for p in (PUSH_L, PUSH_R) if device.has(p))
    if way == TURNS:
        found = [View(f, 1, seen, drag=True) for f in (TURN, APART) if device.has(f)][:1]
    else:
        found = [View(f, 1, seen, drag=True) for f in (MEAN, ALONG, LEFT, RIGHT) if device.has(f)][:1]
        found += [View(FORWARD, 0, seen, drag=True)] if device.has(FORWARD) else []
    return tuple(found) if seen else ()


_BY_KIND: dict[str, Callable[[Device, Device], Iterator[View]]] = {MOTION: _motion, PUSHES: _pushes, PART: _loosely}


def equation(view: View, a: Device, b: Device) -> Equation:
    """The view on A's grid."""
    target = a.smooth(view.target, view.order)
    own = [np.ones(len(target.value))]
    if view.drag:
        own += _drag(a)
    return Equation(target.time, target.value, target.slope, np.array(own), tuple(b.smooth(*f) for f in view.seen))


def motion_known(a: Device) -> tuple[bool, bool]:
    """Are its speed and its turning known, from which drag follows?"""
    return any(a.has(f) for f in (MEAN, ALONG, LEFT, RIGHT)), a.has(TURN) or a.has(APART)


def _drag(a: Device) -> list[np.ndarray]:
    """What brakes and turns a chair without pushes, up to factors: rolling resistance, air and tyres with speed and yaw rate,
    and the centre of mass ahead of the axle with their product and the yaw rate's square."""
    speed = next((a.smooth(f).value for f in (MEAN, ALONG, LEFT, RIGHT) if a.has(f)), None)
    turn = a.smooth(TURN).value if a.has(TURN) else a.smooth(APART).value if a.has(APART) else None
    found = [] if speed is None else [speed, np.tanh(speed / MOVING)]
    if turn is not None:
        found += [turn, turn**2] + ([] if speed is None else [speed * turn])
    return found
