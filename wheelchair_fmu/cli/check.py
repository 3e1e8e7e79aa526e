"""`wheelchair check`: every fault of a campaign at once."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.table import Table

from ..campaign import CHANNELS, Campaign, Fault, Recorded, judged, read
from ..contracts.own import catalogue
from ..faults import ERROR, WARNING
from ..inference.subject import known_parameters
from ..model.choice import Choice
from ..model.stage import Effect
from ..report import preview
from ..report.saving import save
from ..writing import written
from .files import Out, print_json
from .group import console

MOST = 6  # warnings that other commands repeat


def register(app: typer.Typer) -> None:
    app.command()(check)


def measurements(folder: Path, catalogue: Mapping[str, Effect] | None = None, choice: Choice = Choice()) -> Campaign:
    """A campaign without errors, which may name parameters of these effects and laws; warnings go to stderr.

    Raises CampaignError with all its faults.
    """
    campaign = read(folder, known_parameters(catalogue, choice))
    for fault in campaign.warnings[:MOST]:
        console(stderr=True).print(str(fault))
    if len(campaign.warnings) > MOST:
        console(stderr=True).print(f"and {len(campaign.warnings) - MOST} more warnings; see `wheelchair check {folder}`")
    return campaign


def check(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the faults as JSON.")] = False,
    plot: Annotated[bool, typer.Option("--plot", help="Draw every signal of every run: preview.html and PNG.")] = False,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="DIR", help="Where to draw.")] = Path("out"),
    out: Out = None,
) -> None:
    """Read a campaign and print all its faults: place, fact, cure. Exits with 1 where there are errors."""
    found = judged(campaign, known_parameters(catalogue(effects)))
    faults = found.faults
    if plot:
        draw(campaign.name, found.runs, faults, out or output)
    errors = sum(fault.severity == ERROR for fault in faults)
    warnings = sum(fault.severity == WARNING for fault in faults)
    counts = {"errors": errors, "warnings": warnings, "notes": len(faults) - errors - warnings}
    if as_json:
        print_json({"campaign": str(campaign), **counts, "faults": [asdict(fault) for fault in faults]})
    else:
        _show(campaign, faults, counts)
        if found.campaign:
            _tell(found.campaign)
    if errors:
        raise typer.Exit(1)


def draw(title: str, runs: Sequence[Recorded], faults: Sequence[Fault], out: Path, *, told: bool = True) -> None:
    """preview.html and preview.png in `out`, and their names on stderr if `told`: what was printed before may be JSON."""
    seen = preview.seen(runs)
    drawn = preview.figures(seen)
    for i, figure in enumerate(drawn):
        name = "preview.png" if len(drawn) == 1 else f"preview-{i + 1}.png"
        with written(out / name) as beside:
            save(figure, beside)
        figure.set_layout_engine("none")  # where things are is found: the page need not look for it again
        if told:
            print(out / name, file=sys.stderr)
    with written(out / "preview.html") as beside:
        beside.write_text(preview.page(title, drawn, [(f.severity, f.where, f.what) for f in faults]), encoding="utf-8")
    if told:
        print(out / "preview.html", file=sys.stderr)


def _show(campaign: Path, faults: list[Fault], counts: dict[str, int]) -> None:
    out = console()
    for fault in faults:
        out.print(str(fault))
    said = {word: f"{n} {word if n != 1 else word[:-1]}" for word, n in counts.items() if n}
    notes = said.pop("notes", "")
    tally = " and ".join(said.values()) or "no faults"
    out.print(f"{campaign}: {tally}{f', {notes}' if notes else ''}")


def _tell(campaign: Campaign) -> None:
    """What there is in a campaign without errors."""
    table = Table(box=box.SIMPLE)
    for title in ("run", "role", "manoeuvre"):
        table.add_column(title, no_wrap=True)
    for title in ("samples", "time [s]", "channels"):
        table.add_column(title, justify="right")
    for run in campaign.runs:
        duration = f"{run.time[-1] - run.time[0]:.2f}"
        table.add_row(run.name, run.role, run.manoeuvre, str(len(run.time)), duration, str(len(run.channels)))
    out = console()
    out.print(table)
    out.print("one standard deviation of the noise:")
    for channel in CHANNELS:
        if channel.name in campaign.noise:
            how = " (estimated)" if channel.name in campaign.noise_estimated else ""
            out.print(f"    {channel.name} {campaign.noise[channel.name]:.3g} {channel.unit.name}{how}")
