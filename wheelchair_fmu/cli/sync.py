"""`wheelchair sync`: the clocks of a campaign's devices, from what they see alike."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..campaign.reading import judged
from ..campaign.syncing import RunClocks, find, write
from ..errors import CampaignError
from ..faults import ERROR
from ..inference.subject import known_parameters
from ..report.saving import save
from ..report.sync_figure import sync_figure
from ..writing import written
from .files import Out, print_json
from .group import console


def register(app: typer.Typer) -> None:
    app.command()(sync)


def sync(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Find the clocks, but do not write them.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print what was found as JSON.")] = False,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="DIR", help="Where the picture goes.")] = Path("out"),
    out: Out = None,
) -> None:
    """Find the offset of each device's clock in each run, and write what is sure into campaign.toml."""
    seen = judged(campaign, known_parameters())
    if not seen.runs:
        raise CampaignError([fault for fault in seen.faults if fault.severity == ERROR])
    found = find(seen.runs)
    picture = (out or output) / "clocks.png"
    if found:
        with written(picture) as beside:
            save(sync_figure(found), beside)
    if as_json:
        print_json({"campaign": str(campaign), "sync": {one.run.name: _told(one) for one in found}})
    else:
        for doubt in show(found):
            console().print(doubt)
    if not dry_run and any(one.sure for one in found):
        doc = seen.runs[0].doc
        write(doc, found)
        console(stderr=True).print(f"the clocks that are sure are in {doc.path}; their picture is {picture}")


def _told(one: RunClocks) -> dict[str, Any]:
    """What was found of a run, by device."""
    return {
        device: {"offset": one.seconds(device), "se": clock.se, "sure": device in one.sure, "why": one.why(device)}
        for device, clock in one.clocks.items()
    }


def show(found: Sequence[RunClocks]) -> list[str]:
    """A table of the clocks; a sentence for each that is not sure."""
    out = console()
    if not found:
        out.print("every run has one clock: nothing to find")
        return []
    table = Table(box=box.SIMPLE)
    for title in ("run", "device", "beside"):
        table.add_column(title, no_wrap=True)
    for title in ("add to its times [s]", "±"):
        table.add_column(title, justify="right")
    table.add_column("from")
    doubts = []
    for one in found:
        for device, clock in one.clocks.items():
            sure = device in one.sure
            offset = f"{one.seconds(device):.4f}" if sure else "not sure"
            table.add_row(
                one.run.name, device, one.reference, offset, f"{clock.se:.4f}" if sure else "", one.why(device) if sure else ""
            )
            if not sure:
                doubts.append(f"{one.run.name}: {one.why(device)}")
    out.print(table)
    return doubts
