"""`wheelchair check`: every fault of a campaign at once."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.table import Table

from ..campaign import CHANNELS, Campaign, Fault, read
from ..campaign import check as faults_of
from ..faults import ERROR
from ..loop.subject import known_parameters
from .files import print_json
from .group import console

MOST = 6  # warnings that other commands repeat


def register(app: typer.Typer) -> None:
    app.command()(check)


def measurements(folder: Path) -> Campaign:
    """A campaign without errors; what `check` would warn of is said on stderr.

    Raises CampaignError with all its faults.
    """
    campaign = read(folder, known_parameters())
    for fault in campaign.warnings[:MOST]:
        console(stderr=True).print(str(fault))
    if len(campaign.warnings) > MOST:
        console(stderr=True).print(f"and {len(campaign.warnings) - MOST} more warnings; see `wheelchair check {folder}`")
    return campaign


def check(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the faults as JSON.")] = False,
) -> None:
    """Read a campaign and print all its faults: place, fact, cure. Exits with 1 where there are errors."""
    known = known_parameters()
    faults = faults_of(campaign, known)
    errors = sum(fault.severity == ERROR for fault in faults)
    counts = {"errors": errors, "warnings": len(faults) - errors}
    if as_json:
        print_json({"campaign": str(campaign), **counts, "faults": [asdict(fault) for fault in faults]})
    else:
        _show(campaign, faults, counts)
        if not errors:
            _tell(read(campaign, known))
    if errors:
        raise typer.Exit(1)


def _show(campaign: Path, faults: list[Fault], counts: dict[str, int]) -> None:
    out = console()
    for fault in faults:
        out.print(str(fault))
    tally = " and ".join(f"{n} {word if n != 1 else word[:-1]}" for word, n in counts.items() if n)
    out.print(f"{campaign}: {tally or 'no faults'}")


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
