"""The reference run as a drawing for the documentation page."""

from __future__ import annotations

import io
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

# The same bytes each time; text stays text. What matplotlib calls the type of the keys depends on its version.
STEADY: dict[Any, str] = {"svg.hashsalt": "wheelchair-fmu", "svg.fonttype": "none"}
PANELS = (("speed u [m/s]", ("chair.u",)), ("yaw rate ψ' [rad/s]", ("chair.psi_dot",)), ("slip [rad]", ("slip.rl", "slip.rr")))


def reference_run(table: bytes) -> str:
    """SVG of the columns of reference.csv that tell most."""
    rows = np.genfromtxt(io.BytesIO(table), delimiter=",", names=True, deletechars="")
    with mpl.rc_context(STEADY):
        figure = Figure(figsize=(9, 2.6), layout="constrained")
        for axes, (label, names) in zip(figure.subplots(1, len(PANELS)), PANELS, strict=True):
            for name in names:
                axes.plot(rows["time"], rows[name], linewidth=1.5, label=name)
            axes.set(xlabel="t [s]", title=label)
            if len(names) > 1:
                axes.legend(frameon=False, fontsize="small")
            axes.grid(alpha=0.3)
        text = io.StringIO()
        FigureCanvasSVG(figure).print_svg(text, metadata={"Date": None, "Creator": None})
    drawing = text.getvalue()
    return drawing[drawing.index("<svg") :]
