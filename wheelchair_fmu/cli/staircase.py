"""The staircase of the error falling, in the terminal and on disk."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich import box
from rich.console import JustifyMethod
from rich.table import Table

from ..contracts.own import text_of
from ..inference.decision.among_forces import FORCES
from ..inference.residual.staircase import Step
from ..model.variant import Variant
from ..report.figures import staircase_figure
from ..report.saving import save
from ..writing import written

BAR = 24  # characters, for the highest step
FROM_HERE = (
    f"From the step “{FORCES}” on, such forces count as noise. By that alone whitened errors fall; those in each channel's "
    "unit do not."
)
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
    if any(s.name == FORCES for s in ladder):
        table.caption, table.caption_justify = FROM_HERE, "left"
    return table


def physical_staircase(ladder: Sequence[Step]) -> Table:
    """The calibrated model beside the last."""
    ends = {"calibrated": ladder[1], "final model": ladder[-1]} if len(ladder) > 2 else {"calibrated": ladder[-1]}
    return physical_table([(words, step.physical) for words, step in ends.items()])


def physical_table(models: Sequence[tuple[str, Mapping[str, Mapping[str, Any]]]]) -> Table:
    """One line per channel: what models, each with its title, leave of it on held-out runs, or on fitted ones where none were
    held out; then what a constant would leave, and the last model's share of the readings' spread."""
    last = models[-1][1]
    held = any(e["heldout_rms"] is not None for e in last.values())
    title = f"error on {'held-out' if held else 'fitted'} runs, in the unit of each channel"
    table = Table(box=box.SIMPLE, title=title, title_justify="left")
    table.add_column("channel")
    for words in (*(words for words, _ in models), "a constant", "share of sd"):
        table.add_column(words, justify="right")
    for channel, told in last.items():
        left = (_left(physical[channel]) for _, physical in models)
        share = "" if told["share_of_sd"] is None else f"{told['share_of_sd']:.0%}"
        table.add_row(f"{channel} [{told['unit']}]", *left, _figure(told["constant_rms"]), share)
    return table


def _left(told: Mapping[str, Any]) -> str:
    return _figure(told["fit_rms"] if told["heldout_rms"] is None else told["heldout_rms"])


def _figure(value: float | None) -> str:
    return "" if value is None else f"{value:#.3g}".rstrip(".")


def write_improved(output: Path, variant: Variant, ladder: Sequence[Step]) -> list[Path]:
    """The variant as TOML, and its staircase beside it as PNG."""
    with written(output) as beside:
        beside.write_text(text_of(variant), encoding="utf-8")
    picture = output.with_suffix(".png")
    with written(picture) as beside:
        save(staircase_figure([step.as_json() for step in ladder]), beside)
    return [output, picture]
