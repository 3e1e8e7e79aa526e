"""`wheelchair add`: put an effect in, refit, and see the error fall on runs that were held out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..campaign import Campaign, read
from ..errors import unknown
from ..loop.diagnose import Search, Step, begin
from ..loop.fit import Fit
from ..loop.workshop import Workshop
from ..model.effects import bundled, load
from ..model.variant import Variant, read_variant, variant_text
from ..report.figures import staircase_figure
from ..report.saving import save
from .check import known_parameters
from .files import print_json, written
from .group import console


def register(app: typer.Typer) -> None:
    app.command()(add)


def add(
    effect: Annotated[str, typer.Argument(metavar="ID", help="An effect, as `wheelchair effects list` names it.")],
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="TOML", help="The improved variant.")],
    variant: Annotated[Path | None, typer.Option(metavar="TOML", help="The variant to improve.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the staircase as JSON.")] = False,
) -> None:
    """Refit with one more effect, print and draw the staircase, and write the improved variant."""
    catalogue = {**bundled(), **(load(effects) if effects else {})}
    if effect not in catalogue:
        raise unknown("effect", effect, catalogue)
    chair = read_variant(variant, catalogue) if variant else Variant(catalogue=catalogue)
    measured = read(campaign, known_parameters())
    with console(stderr=True).status("calibrating") as status:
        found, ladder = _staircase(measured, chair, effect, status.update)
    better = _improved(chair, effect, found, measured)
    with written(output) as beside:
        beside.write_text(variant_text(better), encoding="utf-8")
    picture = output.with_suffix(".png")
    steps = [{"step": s.name, "fit": s.fit, "heldout": s.heldout} for s in ladder]
    with written(picture) as beside:
        save(staircase_figure(steps), beside)
    if as_json:
        print_json({"ladder": steps, "values": dict(better.values), "variant": str(output)})
        return
    _show(ladder, found, effect)
    for file in (output, picture):
        print(file)


def _staircase(measured: Campaign, chair: Variant, effect: str, say: Any) -> tuple[Fit, list[Step]]:
    """Nominal, calibrated, each effect that was there already, and the new one."""
    search = Search(Workshop(measured, chair), progress=say)
    base, held, ladder, _ = begin(search, say)
    on: tuple[str, ...] = ()
    for one in (*(e for e in chair.effects if e != effect), effect):
        say(f"refitting with {one}")
        score = next(s for s in search.screen(base, on, [one]))
        candidate = search.candidate(base, held, on, score, 1)
        assert candidate is not None
        on = (*on, one)
        base, bench = search.refit(on, candidate.fit.values)
        held = search.heldout(bench, base.values)
        ladder.append(Step(f"+{one}", base.evidence.rms, held.rms))
    return base, ladder


def _improved(chair: Variant, effect: str, found: Fit, measured: Campaign) -> Variant:
    """The variant with the estimates, their standard errors and where they come from."""
    better = chair.with_effects([effect])
    errors = {name: found.se(name) for name in found.names}
    notes = {"standard_errors": errors, "origin": {"campaign": measured.name, "fingerprint": measured.fingerprint}}
    return replace(better, values={**chair.values, **measured.known, **found.values}, notes=notes)


def _show(ladder: list[Step], found: Fit, effect: str) -> None:
    table = Table(box=box.SIMPLE, title="whitened RMS error, 1.0 is the noise floor", title_justify="left")
    for title, side in (("step", "left"), ("fitted runs", "right"), ("held-out runs", "right")):
        table.add_column(title, justify=side)
    for s in ladder:
        table.add_row(s.name, f"{s.fit:.3f}", f"{s.heldout:.3f}")
    console().print(table)
    for name in found.names:
        console().print(f"{name} = {found.values[name]:.5g} ± {found.se(name):.2g}")
