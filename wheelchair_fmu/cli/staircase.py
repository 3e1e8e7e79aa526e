"""The staircase of the error falling, in the terminal and on disk."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from rich import box
from rich.console import JustifyMethod
from rich.table import Table

from ..loop.diagnose import Step
from ..model.variant import Variant, variant_text
from ..report.figures import staircase_figure
from ..report.saving import save
from ..writing import written

BAR = 24  # characters, for the highest step
FLOOR = "whitened RMS error, 1.0 is the noise floor"


def staircase_table(ladder: Sequence[Step]) -> Table:
    """One line per step: the error on fitted and on held-out runs, and a bar of the latter."""
    table = Table(box=box.SIMPLE, title=FLOOR, title_justify="left")
    sides: dict[str, JustifyMethod] = {"step": "left", "fitted runs": "right", "held-out runs": "right", "": "left"}
    for title, side in sides.items():
        table.add_column(title, justify=side)
    shown = [s.heldout if math.isfinite(s.heldout) else s.fit for s in ladder]
    for s, height in zip(ladder, shown, strict=True):
        bar = "█" * max(1, round(BAR * height / max(shown)))
        table.add_row(s.name, f"{s.fit:.3f}", f"{s.heldout:.3f}" if math.isfinite(s.heldout) else "none", bar)
    return table


def write_improved(output: Path, variant: Variant, ladder: Sequence[Step]) -> list[Path]:
    """The variant as TOML, and its staircase beside it as PNG."""
    with written(output) as beside:
        beside.write_text(variant_text(variant), encoding="utf-8")
    picture = output.with_suffix(".png")
    with written(picture) as beside:
        save(staircase_figure([step.as_json() for step in ladder]), beside)
    return [output, picture]
