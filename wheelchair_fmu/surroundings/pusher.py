"""The pusher: a person whose hands push both rims in strokes.

A stroke begins 1/cadence after the one before. While the hands are on the rims the force follows half a sine, then the
hands go back. What changes with the mode is how strong a stroke is:

    open_loop   always the same
    follow      as strong as path and speed ask for, told apart left and right, up to the strongest stroke
    replay      the forces of a recording, instead of strokes

To follow, the person looks ahead along the path, and turns at the rate of the circle that leads there (pure pursuit,
Coulter1992); both hands together make up for the speed that is missing. Hands act after a reaction time, a lag of first order.

The path is a straight line along x, or a slalom round cones that stand on it: it passes the first cone on its right
(y > 0), the second on its left, and so on, as a cosine between them. At the end of the course the person stops.
Forces act at the contact patch, as the chair's inputs do.
"""

from __future__ import annotations

from math import pi

import casadi as cs

from ..model.chassis import PUSH_LIMIT
from ..model.wheelchair import Model
from ..quantities import HZ, M_S, N_S_M, ONE, RAD, RAD_S, Input, M, N, Output, Parameter, S, State, Unit
from . import kit

PER_S = Unit("1/s", s=-1)
N_S_RAD = Unit("N.s/rad", kg=1, m=1, s=-1, rad=-1)
MODES = ("open_loop", "follow", "replay")
CHOSEN = "chosen"
STOPPING = 1.0  # m before the end of the course, over which the wanted speed goes to zero

PARAMETERS = (
    Parameter(
        "pusher.mode",
        ONE,
        "open_loop: strokes that are all the same; follow: a path and a speed; replay: a recording",
        default=1,
        lower=1,
        upper=3,
        choices=MODES,
        fixed=True,
    ),
    Parameter("stroke.cadence", PER_S, "strokes per second", default=1.0, lower=0.0, upper=5.0, source=CHOSEN),
    Parameter(
        "stroke.force",
        N,
        "peak force of a stroke on each wheel, at the contact patch; in follow the strongest that the person can do",
        default=60.0,
        lower=0.0,
        upper=1000.0,
        source="peak tangential force at the rim 69 to 79 N, two instrumented-wheel recordings",
    ),
    Parameter(
        "stroke.contact",
        ONE,
        "part of the cycle in which the hands are on the rims",
        default=0.5,
        lower=0.05,
        upper=1.0,
        source=CHOSEN,
    ),
    Parameter(
        "stroke.asymmetry",
        ONE,
        "what the left hand is stronger and the right hand weaker than meant",
        mirror="-",
        lower=-1.0,
        upper=1.0,
        nominal=0.1,
        source=CHOSEN,
    ),
    Parameter(
        "stroke.delay",
        S,
        "time from the start to the first stroke, or to the beginning of the recording",
        lower=0.0,
        upper=1000.0,
        fixed=True,
        source=CHOSEN,
    ),
    Parameter(
        "follow.delay",
        S,
        "reaction time, from what is seen to what the hands do",
        default=0.15,
        lower=0.01,
        upper=10.0,
        source=CHOSEN,
    ),
    Parameter("follow.speed", M_S, "speed that the person wants", default=0.9, lower=-3.0, upper=3.0, source=CHOSEN),
    Parameter(
        "follow.preview",
        M,
        "how far ahead the person looks",
        default=0.8,
        lower=0.05,
        upper=20.0,
        source="chosen; Coulter1992 calls it the lookahead",
    ),
    Parameter(
        "follow.speed_gain",
        N_S_M,
        "mean push on each wheel per missing speed",
        default=40.0,
        lower=0.0,
        upper=1e4,
        source=CHOSEN,
    ),
    Parameter(
        "follow.turn_gain",
        N_S_RAD,
        "mean push, forward on one wheel and backward on the other, per missing yaw rate",
        default=60.0,
        lower=0.0,
        upper=1e4,
        source=CHOSEN,
    ),
    Parameter(
        "course.cones", ONE, "number of cones; none makes the path straight", lower=0.0, upper=1000.0, fixed=True, source=CHOSEN
    ),
    Parameter("course.first", M, "x of the first cone", default=3.0, lower=-1e6, upper=1e6, fixed=True, source=CHOSEN),
    Parameter(
        "course.spacing", M, "distance from one cone to the next", default=3.0, lower=0.1, upper=1e6, fixed=True, source=CHOSEN
    ),
    Parameter(
        "course.clearance",
        M,
        "how far beside a cone the path goes; negative begins on the cone's left",
        mirror="-",
        default=0.6,
        lower=-100.0,
        upper=100.0,
        fixed=True,
        source=CHOSEN,
    ),
    Parameter(
        "course.end", M, "x where the person stops", default=1e6, lower=-1e6, upper=1e6, nominal=10.0, fixed=True, source=CHOSEN
    ),
)
INPUTS = (
    Input("chair.x", M, "x of the chair's CM in the room", lower=-1e6, upper=1e6),
    Input("chair.y", M, "y of the chair's CM in the room, to the right of x", mirror="-", lower=-1e6, upper=1e6),
    Input("chair.psi", RAD, "the chair's yaw angle ψ, clockwise from above", mirror="-", lower=-1e5, upper=1e5),
    Input("chair.u", M_S, "the chair's forward speed u", lower=-1e3, upper=1e3),
    Input("chair.psi_dot", RAD_S, "the chair's yaw rate ψ', clockwise from above", mirror="-", lower=-1e4, upper=1e4),
)
STATES = (
    State("clock", S, "time since the first stroke or the beginning of the recording"),
    State("phase", ONE, "strokes since the first"),
    State("meant.rl", N, "mean push that the left hand means to give", "+meant.rr", nominal=10.0),
    State("meant.rr", N, "mean push that the right hand means to give", "+meant.rl", nominal=10.0),
)
OUTPUTS = (
    Output(
        "push.F_rl",
        N,
        "push force on the left wheel, at the contact patch, forward",
        "+push.F_rr",
        nominal=50.0,
        lower=-PUSH_LIMIT,
        upper=PUSH_LIMIT,
    ),
    Output(
        "push.F_rr",
        N,
        "push force on the right wheel, at the contact patch, forward",
        "+push.F_rl",
        nominal=50.0,
        lower=-PUSH_LIMIT,
        upper=PUSH_LIMIT,
    ),
    Output("path.y", M, "y of the path beside the chair", "-"),
    Output("path.deviation", M, "how far the chair is to the right of the path", "-", nominal=0.1),
    Output("stroke.phase", ONE, "strokes since the first, as a number that grows steadily"),
    Output("stroke.rate", HZ, "rate of change of stroke.phase"),
)
CLOCK = [s.name for s in STATES].index("clock")


def pusher(mode: str) -> Model:
    """The pusher in one of MODES. In replay the pushes are zero here; the recording comes in as C (see `fmu.replay`)."""
    known = kit.symbols((*PARAMETERS, *INPUTS, *STATES))
    meant = _wanted(known) if mode == "follow" else (known["stroke.force"] * _mean(known),) * 2
    hand = {
        "open_loop": lambda wheel: known["stroke.force"],
        "follow": lambda wheel: _strength(known, wheel),
        "replay": lambda wheel: cs.SX(0),
    }[mode]
    shape, uneven = _shape(known), known["stroke.asymmetry"]
    results = {
        "push.F_rl": shape * hand("rl") * (1 + uneven),
        "push.F_rr": shape * hand("rr") * (1 - uneven),
        "path.y": path(known, known["chair.x"]),
        "path.deviation": known["chair.y"] - path(known, known["chair.x"]),
        "stroke.phase": known["phase"],
        "stroke.rate": known["stroke.cadence"],
    }
    rates = {
        "clock": cs.SX(1),
        "phase": known["stroke.cadence"],
        "meant.rl": (meant[0] - known["meant.rl"]) / known["follow.delay"],
        "meant.rr": (meant[1] - known["meant.rr"]) / known["follow.delay"],
    }
    late = known["stroke.delay"]
    starts = {"clock": -late, "phase": -known["stroke.cadence"] * late, "meant.rl": cs.SX(0), "meant.rr": cs.SX(0)}
    return kit.model(PARAMETERS, INPUTS, OUTPUTS, known, results, STATES, rates, starts)


def path(known: kit.Symbols, x: cs.SX) -> cs.SX:
    """y of the path at x: a cosine from cone to cone, which begins and ends along x one spacing before and behind them."""
    last = known["course.cones"] - 1
    s = (x - known["course.first"]) / known["course.spacing"]  # in spacings from the first cone
    between = cs.cos(pi * kit.clip(s, 0.0, cs.fmax(last, 0.0)))
    entry = (1 + cs.cos(pi * kit.clip(s, -1.0, 0.0))) / 2
    exit_ = (1 + cs.cos(pi * kit.clip(s - last, 0.0, 1.0))) / 2
    return cs.if_else(last >= 0, known["course.clearance"] * between * entry * exit_, 0)


def _shape(known: kit.Symbols) -> cs.SX:
    """The force of a stroke over its peak, 0 to 1: half a sine while the hands are on the rims."""
    part = known["phase"] - cs.floor(known["phase"])
    on = cs.logic_and(part < known["stroke.contact"], known["phase"] >= 0)
    return cs.if_else(on, cs.sin(pi * part / known["stroke.contact"]), 0)


def _mean(known: kit.Symbols) -> cs.SX:
    """The mean force of a cycle over its peak."""
    return known["stroke.contact"] * 2 / pi


def _strength(known: kit.Symbols, wheel: str) -> cs.SX:
    """Peak of a stroke whose mean is what the hand means to give, as far as the person can."""
    return kit.clip(known[f"meant.{wheel}"] / _mean(known), -known["stroke.force"], known["stroke.force"])


def _wanted(known: kit.Symbols) -> tuple[cs.SX, cs.SX]:
    """Mean pushes, left and right, that path and speed ask for."""
    u = known["chair.u"]
    left = kit.clip((known["course.end"] - known["chair.x"]) / STOPPING, 0.0, 1.0)
    drive = known["follow.speed_gain"] * (left * known["follow.speed"] - u)
    turn = known["follow.turn_gain"] * (u * _curvature(known) - known["chair.psi_dot"])
    return drive + turn, drive - turn


def _curvature(known: kit.Symbols) -> cs.SX:
    """Of the circle that leaves along the chair's heading and meets the path one preview ahead."""
    ahead = known["follow.preview"]
    aside = path(known, known["chair.x"] + ahead) - known["chair.y"]
    angle = cs.atan2(aside, ahead) - known["chair.psi"]
    return 2 * cs.sin(angle) / cs.sqrt(ahead**2 + aside**2)
