"""Figures as files whose bytes depend on nothing but what they show."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from PIL import Image

STEADY: Any = {"svg.hashsalt": "wheelchair-fmu", "svg.fonttype": "path", "pdf.fonttype": 42}  # letters of a PDF stay letters
COLOURS = 32  # of a film
UNDATED = {
    ".svg": {"Date": None, "Creator": None},
    ".png": {"Software": None},
    ".pdf": dict.fromkeys(("CreationDate", "Creator", "Producer")),
}


def save(figure: Figure, path: Path) -> None:
    """Write a figure as PNG, SVG or PDF with its fonts, by the path's ending."""
    from matplotlib import rc_context  # here, not above: see `canvas`

    with rc_context(STEADY):
        figure.savefig(path, dpi=150, metadata=UNDATED[path.suffix])


def save_svg(figure: Figure, target: IO[str]) -> None:
    """Write a figure as SVG text."""
    from matplotlib import rc_context

    with rc_context(STEADY):
        figure.savefig(target, format="svg", metadata=UNDATED[".svg"])


def save_film(frames: Iterable[np.ndarray], path: Path, pause: float) -> None:
    """Write frames (height, width, 3) of bytes as a GIF that plays for ever, with `pause` [s] from one to the next.

    All frames share the first one's colours, so that only what moves is stored again.
    """
    from PIL import Image  # here, not above: only a film needs it

    pictures: list[Image.Image] = []
    for frame in frames:
        picture = Image.fromarray(frame)
        pictures.append(
            picture.quantize(COLOURS, dither=Image.Dither.NONE)
            if not pictures
            else picture.quantize(palette=pictures[0], dither=Image.Dither.NONE)
        )
    pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=round(1000 * pause), loop=0, optimize=True)
