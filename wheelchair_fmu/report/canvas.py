"""Where a figure is drawn."""

from __future__ import annotations

from functools import cache
from io import BytesIO
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def blank(width: float, height: float) -> Figure:
    """An empty figure of this size [in]. matplotlib comes with the first: loading it takes longer than most commands."""
    return _figure()(figsize=(width, height), layout="constrained")


@cache
def _figure() -> type[Figure]:
    from matplotlib.figure import Figure

    class Drawn(Figure):
        """Shows itself in a notebook, also where nobody loaded pyplot, which teaches notebooks to show figures."""

        def _repr_png_(self) -> bytes:
            held = BytesIO()
            self.savefig(held, format="png")
            return held.getvalue()

    return Drawn
