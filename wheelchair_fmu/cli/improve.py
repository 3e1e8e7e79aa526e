"""`wheelchair improve`: the whole loop unattended, until nothing is missing or it must stop."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Group as Stacked
from rich.live import Live
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from ..contracts.own import load
from ..handling.experiments import experiments
from ..inference.decision.improve import after, with_proposal
from ..inference.decision.verdict import diagnose
from ..inference.explain.ranking import as_json
from ..inference.residual.staircase import Step
from ..model.generic import library
from .diagnose import show, write_proposal
from .files import write_json
from .group import console
from .settings import subject
from .staircase import staircase_table, write_improved
from .terminal import announce
from .trust import variant_option

MOST_PROPOSALS = 2
ENDS = {
    "missing": "Stopped: nothing more is missing.",
    "adequate": "Stopped: nothing is missing.",
    "small": "Stopped: what is left is too small to matter.",
    "tie": "Stopped: the likeliest of the tied effects is in; only another measurement can tell them apart.",
    "cannot_see": "Stopped: these runs could not show more.",
    "outside": "Stopped: something is left that neither the catalogue nor a generic term explains.",
}


def register(app: typer.Typer) -> None:
    app.command()(improve)


def improve(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="TOML", help="The improved variant.")],
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, variant_option("The variant to improve.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    json_file: Annotated[Path | None, typer.Option("--json", metavar="OUT", help="Write the last diagnosis as JSON.")] = None,
) -> None:
    """Diagnose, add what is missing, and so on, until nothing is missing or only a person can go on.

    Where the catalogue does not suffice, the best generic term is written as an effect file into a folder beside the
    variant, and added.
    """
    chair, measured, fixed = subject(campaign, variant, effects, settings)
    files = []
    for attempt in range(MOST_PROPOSALS + 1):
        with _watched() as watch:
            found = diagnose(
                measured, chair, library(), progress=watch.says, experiments=experiments(), fixed=fixed, stepped=watch.stepped
            )
        if found.proposal is None or attempt == MOST_PROPOSALS:
            break
        folder = output.with_name(f"{output.stem}-effects")
        name, file = write_proposal(found, folder)
        files.append(file)
        chair = with_proposal(found, replace(chair, catalogue={**chair.catalogue, **load(folder)}), measured, name)
    better = after(found, chair, measured)
    if json_file:
        write_json(json_file, as_json(found))
    show(found, as_json(found))
    console().print(ENDS["missing" if found.verdict == "adequate" and found.included else found.verdict])
    for file in (*write_improved(output, better, found.ladder), *files):
        announce(file)


@dataclass
class _Watch:
    """What is going on, below the staircase so far."""

    live: Live
    bar: Progress

    def says(self, words: str) -> None:
        self.bar.update(self.bar.task_ids[0], description=words, advance=1)

    def stepped(self, ladder: Sequence[Step]) -> None:
        self.live.update(Stacked(staircase_table(ladder), self.bar))


@contextmanager
def _watched() -> Iterator[_Watch]:
    """A bar and a live staircase on stderr while the loop works; gone afterwards."""
    columns = (TextColumn("{task.description}", markup=False), BarColumn(pulse_style="cyan"), TimeElapsedColumn())
    bar = Progress(*columns, auto_refresh=False)
    bar.add_task("reading", total=None)
    with Live(bar, console=console(stderr=True), transient=True, refresh_per_second=4) as live:
        yield _Watch(live, bar)
