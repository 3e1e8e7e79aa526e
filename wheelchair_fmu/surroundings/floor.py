"""The floor: slopes and rolling resistance by where the chair is.

Three rectangles lie on a level, smooth floor: a ramp, which falls or rises along the room's x, a corridor with a cross
slope, along y, and a carpet. Each is off until its slope or factor is given. An edge is passed over a blending length,
as a chair goes over it wheel after wheel. Axes are those of the room, x forward and y right at the start.
"""

from __future__ import annotations

from typing import Any

import casadi as cs

from ..model.wheelchair import Model
from ..quantities import ONE, RAD, Input, M, Output, Parameter
from . import kit

CHOSEN = "chosen"


def _rectangle(patch: str, meaning: str) -> tuple[Parameter, ...]:
    reach: dict[str, Any] = {"lower": -1e6, "upper": 1e6, "nominal": 1.0, "source": CHOSEN}
    return (
        Parameter(f"{patch}.x_from", M, f"x where {meaning} begins", default=2.0, **reach),
        Parameter(f"{patch}.x_to", M, f"x where {meaning} ends", default=1000.0, **reach),
        Parameter(f"{patch}.y_from", M, f"y where {meaning} begins", default=-1000.0, **reach),
        Parameter(f"{patch}.y_to", M, f"y where {meaning} ends", default=1000.0, **reach),
    )


PARAMETERS = (
    Parameter(
        "ramp.slope",
        RAD,
        "slope of the ramp along x, positive where it falls towards +x",
        lower=-0.5,
        upper=0.5,
        nominal=0.05,
        source="ISO 7176-2 tests up to 10°; 1 in 12 is 0.083",
    ),
    *_rectangle("ramp", "the ramp"),
    Parameter(
        "cross.slope",
        RAD,
        "slope of the corridor along y, positive where it falls towards +y",
        lower=-0.5,
        upper=0.5,
        nominal=0.05,
        source="Richter2007",
    ),
    *_rectangle("cross", "the corridor with a cross slope"),
    Parameter(
        "carpet.rolling_factor",
        ONE,
        "factor on rolling resistance on the carpet: 1 smooth, about 2 carpet; `wheelchair surfaces` has more",
        default=1.0,
        lower=0.0,
        upper=100.0,
        source="Hoffman2003: carpet adds 0.0118 to 0.012",
    ),
    *_rectangle("carpet", "the carpet"),
    Parameter(
        "edge.length",
        M,
        "length over which the chair passes an edge, about its wheelbase",
        default=0.45,
        lower=1e-3,
        upper=10.0,
        source="a + b of Doria, Table 1",
    ),
)
INPUTS = (
    Input("chair.x", M, "x of the chair's CM in the room", lower=-1e6, upper=1e6),
    Input("chair.y", M, "y of the chair's CM in the room, to the right of x", mirror="-", lower=-1e6, upper=1e6),
)
OUTPUTS = (
    Output(
        "floor.slope_x",
        RAD,
        "slope along the room's x under the chair, positive where the floor falls towards +x",
        lower=-1.0,
        upper=1.0,
        nominal=0.05,
    ),
    Output(
        "floor.slope_y",
        RAD,
        "slope along the room's y under the chair, positive where the floor falls towards +y",
        "-",
        lower=-1.0,
        upper=1.0,
        nominal=0.05,
    ),
    Output(
        "floor.rolling_factor", ONE, "factor on both rolling resistance coefficients under the chair", lower=0.0, upper=100.0
    ),
)


def floor() -> Model:
    """The floor as a model without states."""
    known = kit.symbols((*PARAMETERS, *INPUTS))
    results = {
        "floor.slope_x": known["ramp.slope"] * _on("ramp", known),
        "floor.slope_y": known["cross.slope"] * _on("cross", known),
        "floor.rolling_factor": 1 + (known["carpet.rolling_factor"] - 1) * _on("carpet", known),
    }
    return kit.model(PARAMETERS, INPUTS, OUTPUTS, known, results)


def _on(patch: str, known: kit.Symbols) -> cs.SX:
    """How much of the chair is on a patch, 0 to 1."""

    def past(place: cs.SX, edge: cs.SX) -> cs.SX:
        t = kit.clip((place - edge) / known["edge.length"] + 0.5, 0.0, 1.0)
        return t * t * (3 - 2 * t)  # no kink at either end

    x, y = known["chair.x"], known["chair.y"]
    begun = past(x, known[f"{patch}.x_from"]) * past(y, known[f"{patch}.y_from"])
    return begun * (1 - past(x, known[f"{patch}.x_to"])) * (1 - past(y, known[f"{patch}.y_to"]))
