"""The rider's body moves forward and back with each stroke, the same way each time: what nobody filmed and no push tells.

With the phase θ of the strokes, 2π times their number since the first, the CM lies

    s = c (cos θ − 1) + d sin θ

ahead of where it is at a stroke's beginning and while nobody strokes. As with a body that was recorded, the frame recoils at
s' = (ds/dθ) θ', and accelerometers feel s'' = (d²s/dθ²) θ'². It may be ahead of the push, as a body is that reaches back for
the rim; no law that the push drives can be. θ/2π and its rate are inputs; a campaign has them from its pushes, and a simulated
pusher gives them.
"""

from math import cos, pi, sin
from typing import Any

import casadi as cs

from ...quantities import M, Parameter
from ..alike import MOVING_BODY
from ..signs import Shows
from ..sketch import Curve, graph
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(
    off=0.0, smallest_interesting=0.005, lower=-0.3, upper=0.3, source="chosen, as for the swing of trunk_motion"
)
COS = Parameter("cos", M, "motion of the CM against the frame with the cosine of the strokes' phase", symbol="sway_c", **COMMON)
SIN = Parameter("sin", M, "motion of the CM against the frame with the sine of the strokes' phase", symbol="sway_d", **COMMON)


def swayed(sway_c, sway_d, stroke_phase):
    """s, which is zero at the beginning of a stroke."""
    theta = 2 * cs.pi * stroke_phase
    return sway_c * (cs.cos(theta) - 1) + sway_d * cs.sin(theta)


def recoil(sway_c, sway_d, stroke_phase, stroke_rate):
    """−s'"""
    theta, omega = 2 * cs.pi * stroke_phase, 2 * cs.pi * stroke_rate
    return (sway_c * cs.sin(theta) - sway_d * cs.cos(theta)) * omega


def recoil_rate(sway_c, sway_d, stroke_phase, stroke_rate):
    """−s'', at a rate that changes little within a stroke."""
    theta, omega = 2 * cs.pi * stroke_phase, 2 * cs.pi * stroke_rate
    return (sway_c * cs.cos(theta) + sway_d * cs.sin(theta)) * omega * omega


EFFECT = Effect(
    "stroke_motion",
    "a body that moves with each stroke",
    parameters=(COS, SIN),
    contributions=(adds("shift", swayed), adds("recoil", recoil), adds("recoil_rate", recoil_rate)),
    alike=(MOVING_BODY,),
    signs=(Shows("start-stop", "sensor.x", more=True), Shows("start-stop", "sensor.x", more=False, seconds=0.5)),
    sketches=(
        graph(
            "time",
            "",
            Curve(lambda t: 0.5 + 0.4 * max(0.0, sin(4 * pi * t)), "push", before=True),
            Curve(lambda t: 0.25 + 0.15 * cos(4 * pi * (t - 0.02)), "s"),
        ),
    ),
)
