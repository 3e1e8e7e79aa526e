"""What a small drawing of an effect shows, as a record: a view of the chair, and what is marked in it.

Places are in metres and angles in degrees, in the axes of the view:

    above   (y, x): to the right, and forward
    rear    (y, z): seen from behind, to the right, and up from the floor
    side    (x, z): seen from the right, forward is to the right, and up from the floor
    graph   (0 to 1, 0 to 1): two quantities, named by `axes`
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

Place = tuple[float, float]
View = Literal["above", "rear", "side", "graph"]

REAR_LEFT, REAR_RIGHT = (-0.275, -0.2), (0.275, -0.2)  # hubs, from above
PIVOT_LEFT, PIVOT_RIGHT = (-0.225, 0.25), (0.225, 0.25)
RADIUS, HEIGHT = 0.31, 0.6  # of the rear wheels, of the CM


@dataclass(frozen=True)
class Arrow:
    """A force, a speed or a way, as it is where the parameter is positive; `moves`: of the chair, for orientation."""

    start: Place
    end: Place
    label: str = ""
    moves: bool = False


@dataclass(frozen=True)
class Turn:
    """A torque or a turn; in the view from above clockwise is positive."""

    at: Place
    label: str = ""
    clockwise: bool = True
    radius: float = 0.1
    moves: bool = False


@dataclass(frozen=True)
class Wheel:
    """A wheel in question, turned in the view by so many degrees clockwise."""

    name: Literal["rl", "rr", "fl", "fr", "rear", "front"]
    turned: float = 0.0


@dataclass(frozen=True)
class Spot:
    """A place: of a mass, a sensor (`box`) or a marker."""

    at: Place
    label: str = ""
    box: bool = False
    turned: float = 0.0  # of a box


@dataclass(frozen=True)
class Length:
    """How far it is from one place to another."""

    start: Place
    end: Place
    label: str = ""


@dataclass(frozen=True)
class Curve:
    """One quantity over another; `before` is the one without the effect."""

    law: Callable[[float], float]
    label: str = ""
    before: bool = False


Mark = Arrow | Turn | Wheel | Spot | Length | Curve


@dataclass(frozen=True)
class Sketch:
    """One drawing. `tilt`: of floor and chair, in degrees, clockwise; `of`: the parameter, where each has its own."""

    view: View
    marks: tuple[Mark, ...]
    tilt: float = 0.0
    axes: tuple[str, str] = ("", "")
    of: str = ""


def from_above(*marks: Mark, of: str = "") -> Sketch:
    return Sketch("above", marks, of=of)


def from_behind(*marks: Mark, tilt: float = 0.0, of: str = "") -> Sketch:
    return Sketch("rear", marks, tilt, of=of)


def from_the_side(*marks: Mark, tilt: float = 0.0, of: str = "") -> Sketch:
    return Sketch("side", marks, tilt, of=of)


def graph(over: str, shown: str, *marks: Mark, of: str = "") -> Sketch:
    return Sketch("graph", marks, axes=(over, shown), of=of)
