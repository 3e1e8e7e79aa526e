"""`wheelchair compare`: how far off the model is, in which run, channel and regime."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich import box
from rich.table import Table

from ..api import comparisons
from ..api.comparing import PIECE, Compared, compared
from ..campaign import DENSE, SPAN, Campaign, condensed, pieces
from ..inference.estimation.statistics import finite
from ..inference.residual.physical import as_json as physical
from ..report.saving import save
from ..writing import written
from .files import Kind, TableKind, print_json
from .group import Progress, console, working
from .settings import subject
from .staircase import physical_table
from .terminal import announce
from .trust import variant_option


def register(app: typer.Typer) -> None:
    app.command()(compare)


def compare(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, variant_option("Laws, effects and values.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    calibrate: Annotated[str, typer.Option(metavar="NAMES", help="Parameters to fit first, with commas.")] = "",
    as_json: Annotated[bool, typer.Option("--json", help="Print the errors as JSON.")] = False,
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="DIR", help="Where series and figures go.")] = None,
    table: Kind = TableKind.csv,
    progress: Progress = False,
) -> None:
    """Simulate every run through the FMU by fmpy, and give the whitened RMS error: 1.0 is the noise floor."""
    chair, measured, _ = subject(campaign, variant, effects, settings)
    measured = condensed(measured)  # here already, so that the samples themselves are not kept in memory
    names = [n.strip() for n in calibrate.split(",") if n.strip()]
    with working("calibrating" if names else "simulating", lines=progress) as say:
        found = compared(measured, chair, names, say, brief=not output)
    for note in _notes(found.campaign):
        console(stderr=True).print(note)
    if as_json:
        print_json(_content(measured, found, names))
    else:
        _show(measured, found, names)
    for file in _files(comparisons.Comparison(found), output, table) if output else []:
        if not as_json:
            announce(file)


def _notes(measured: Campaign) -> list[str]:
    estimated = sorted(c for c in measured.noise_estimated if measured.noise.get(c))
    said = [f"noise of {', '.join(estimated)} is not stated and was estimated from the data"] if estimated else []
    if any(run.noise_shares for run in measured.runs):
        said.append(f"what was recorded more than {DENSE:g} times a second is compared as means over {1000 * SPAN:g} ms")
    if any(len(pieces(run, PIECE)) > 1 for run in measured.runs):
        said.append(f"runs of {2 * PIECE:g} s and more are compared in pieces of {PIECE:g} s, each from a start of its own")
    return [*said, "each run's start is estimated about what the file says (speed ± 0.02 m/s)"]


def _content(measured: Campaign, found: Compared, names: Sequence[str]) -> dict[str, Any]:
    c = found.errors
    return {
        "campaign": measured.name,
        "rms": {"fit": finite(c.rms("fit")), "holdout": finite(c.rms("holdout"))},
        "runs": [{"run": r.name, "role": r.role, "rms": r.rms} for r in c.runs],
        "physical": physical(c.physical("fit"), c.physical("holdout")),
        "excess": {n: [{"from": a, "to": b, "share": s} for a, b, s in c.excess_by(n)] for n in c.runs[0].regime},
        "values": dict(found.values),
        "calibrated": list(names),
        "calibration": {v.record.name: v.as_json() for v in found.calibration},
        "notes": found.notes,
    }


def _show(measured: Campaign, found: Compared, names: Sequence[str]) -> None:
    out, c = console(), found.errors
    for name in names:
        out.print(f"calibrated: {name} = {found.values[name]:.6g}")
    for note in found.notes:
        out.print(f"note: {note}")
    channels = list(dict.fromkeys(ch for r in c.runs for ch in r.channels))
    table = Table(box=box.SIMPLE, title=f"{measured.name}: whitened RMS error, 1.0 is the noise floor", title_justify="left")
    table.add_column("run", no_wrap=True)
    table.add_column("role", no_wrap=True)
    for channel in channels:
        table.add_column(channel.replace("wheel_speed", "wheel"), justify="right", no_wrap=True)
    for r in c.runs:
        table.add_row(r.name, r.role, *(f"{r.rms[ch]:.2f}" if ch in r.rms else "" for ch in channels))
    out.print(table)
    for role in ("fit", "holdout"):
        if np.isfinite(c.rms(role)):
            out.print(f"{'fitted' if role == 'fit' else 'held-out'} runs together: {c.rms(role):.3f}")
    out.print(physical_table([("error", physical(c.physical("fit"), c.physical("holdout")))]))
    run, channel, value = c.worst()
    out.print(f"largest: {channel} in {run}, {value:.2f}")
    for name in c.runs[0].regime:
        bins = c.excess_by(name)
        if bins:
            a, b, share = max(bins, key=lambda row: row[2])
            out.print(f"by {name}: {share:4.0%} of the excess lies between {a:.3g} and {b:.3g} (a quarter of the samples)")


def _files(c: comparisons.Comparison, folder: Path, table: str) -> list[Path]:
    """What was measured and simulated in each run as a table, and figures."""
    files = list(c.save(folder, kind=table))
    figures = {"where": c.plot_where(), **{f"run-{name}": c.plot_run(name) for name in c.rms.index}}
    for name, figure in figures.items():
        for ending in (".png", ".svg"):
            with written(folder / f"{name}{ending}") as beside:
                save(figure, beside)
            files.append(folder / f"{name}{ending}")
    return files
