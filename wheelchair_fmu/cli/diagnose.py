"""`wheelchair diagnose`: which effect is missing, what cannot be told apart, and what to measure next."""

from __future__ import annotations

from collections.abc import Container, Mapping
from pathlib import Path
from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..campaign import windows
from ..handling.experiments import experiments
from ..loop.bootstrap import Bootstrap, bootstrap
from ..loop.story import story
from ..loop.verdict import Diagnosis, insufficient
from ..loop.verdict import diagnose as run_diagnosis
from ..model.effects import bundled
from ..model.generic import library, terms
from ..report.figures import missing_figure, staircase_figure
from ..report.saving import save
from ..report.words import helpers, outside, probability, tied, verdict_words
from ..writing import written
from .files import write_json
from .group import Progress, console, working
from .missing import missing
from .settings import subject
from .staircase import staircase_table
from .terminal import announce

LIKELIEST = 8  # effects, of which the table tells
SENTENCES = {
    "missing": "Missing: {effects}.",
    "small": "There, but too small to matter: {effects}. The model is adequate without.",
    "adequate": "Nothing is missing: the model explains these data, and would have shown an effect of interesting size.",
    "cannot_see": "Nothing was found, but these runs could not have shown most effects of interesting size.",
}


def register(app: typer.Typer) -> None:
    app.command()(diagnose)


def diagnose(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, typer.Option(metavar="TOML", help="Laws, effects and values to start from.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    json_file: Annotated[Path | None, typer.Option("--json", metavar="OUT", help="Write the diagnosis as JSON.")] = None,
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="DIR", help="For figures and proposals.")] = None,
    resamples: Annotated[
        int,
        typer.Option(
            "--bootstrap",
            metavar="N",
            min=0,
            help="Resample the measurements N times, and say how often the diagnosis would be the same.",
        ),
    ] = 0,
    progress: Progress = False,
) -> None:
    """Say which physical effect is missing from the model, with the evidence."""
    chair, measured, fixed = subject(campaign, variant, effects, settings)
    measured = windows(measured)  # here already, so that the rest is not kept in memory
    with working("reading", lines=progress) as say:
        found = run_diagnosis(measured, chair, library(), progress=say, experiments=experiments(), fixed=fixed)
    content = {**story(found), "missing": missing(found)}
    stable = bootstrap(found, resamples) if resamples else None
    if stable:
        content["bootstrap"] = stable.as_json()
    if json_file:
        write_json(json_file, content)
    show(found, content)
    if stable:
        _show_bootstrap(stable)
    if output:
        for file in _files(found, content, output):
            announce(file)


def show(d: Diagnosis, content: dict[str, Any]) -> None:
    """The verdict and its evidence, for a person."""
    out = console()
    for note in d.notes:
        out.print(f"note: {note}")
    ids = {e: e for e in d.effects}
    out.print(f"{d.campaign}: {_verdict(d, content, ids)}")
    if d.verdict == "outside" and d.effects:
        out.print(f"These help but do not suffice: {helpers(d.effects, d.ties, ids)}.")
    if d.proposal:
        term = terms()[d.proposal.effect]
        size = f"{d.proposal.estimate[0]:.3g} ± {d.proposal.se[0]:.2g} {term.unit.name}"
        lead = "The term that helps most, and does not suffice either" if insufficient(d.ladder) else "What would explain it"
        out.print(f"{lead}: {term.words}, {size}.")
    out.print(staircase_table(d.ladder))
    for words in d.unexplained.words if d.unexplained else ():
        out.print(words)
    out.print(_ranking(content, set(d.search.workshop.catalogue) - set(bundled())))
    for name, (low, high) in d.intervals.items():
        unit = d.search.records[name].unit.name
        out.print(f"{name.removeprefix('effect.')} = {d.final.values[name]:.4g} {unit}, 95 % within {low:.4g} to {high:.4g}")
    if d.next_experiment:
        n = d.next_experiment
        times = "once" if n["repeats"] == 1 else f"{n['repeats']} times"
        out.print(f"Measure next, {times}: {n['manoeuvre']}, for {' and '.join(n['separates'])}: {n['why']}.")
    out.print(f"{d.seconds:.1f} s")


def _verdict(d: Diagnosis, content: Mapping[str, Any], ids: Mapping[str, str]) -> str:
    if d.verdict == "tie":
        return tied(d.effects, d.ties, ids)
    return outside(content) if d.verdict == "outside" else SENTENCES[d.verdict].format(effects=", ".join(d.effects))


def _show_bootstrap(b: Bootstrap) -> None:
    """How often resampled measurements say the same, for a person."""
    out = console()
    for s in b.rounds:
        rivals = [f"{effect} in {share:.1%}" for effect, share in s.first.items() if effect != s.effect and share > 0]
        else_ = f"; {', '.join(rivals)}" if rivals else ""
        gain = "" if s.predicts is None else f"; held-out runs gain in {s.predicts:.1%}"
        out.print(f"of {b.resamples} resamples {s.effect} explains most in {s.first[s.effect]:.1%}{else_}{gain}")
    for name, (se, low, high) in b.estimates.items():
        out.print(f"  {name} ± {se:.2g}, 95 % within {low:.4g} to {high:.4g} (SI)")


def _ranking(content: dict[str, Any], own: Container[str]) -> Table:
    """One line per parameter of the likeliest effects, and of all of the user's own."""
    table = Table(box=box.SIMPLE)
    for title in ("effect", "parameter", "estimate", "of interest", "p", "power", "Δ(−2 log L)", "verdict"):
        right = title in ("p", "power", "Δ(−2 log L)")
        table.add_column(title, no_wrap=True, justify="right" if right else "left")
    for place, row in enumerate(content["ranking"]):
        if place >= LIKELIEST and row["effect"] not in own:
            continue
        figures = (probability(row["p"]), f"{row['power']:.2f}", f"{row['lr']:.0f}", verdict_words(row))
        for i, (name, v) in enumerate(row["parameters"].items()):
            se = f"{v['se']:.2g}" if v["se"] is not None else "?"
            size = f"{v['estimate']:.3g} ± {se} {v['unit']}".removesuffix(" 1")
            about = (name, size, f"{v['smallest_interesting']:g}")
            table.add_row("" if i else row["effect"], *about, *(("",) * 4 if i else figures))
    return table


def _files(d: Diagnosis, content: dict[str, Any], folder: Path) -> list[Path]:
    files = [folder / "staircase.png", folder / "staircase.svg"]
    figure = staircase_figure(content["ladder"])
    for file in files:
        with written(file) as beside:
            save(figure, beside)
    if d.proposal:
        files.append(write_proposal(d, folder / "effects")[1])
        files.append(_missing_picture(content["missing"], folder / "missing.png"))
    return files


def _missing_picture(lacking: Mapping[str, Any], file: Path) -> Path:
    """The proposed term's quantity as the data would have it, against each variable."""
    with written(file) as beside:
        save(missing_figure(lacking["words"], lacking["unit"], lacking["panels"]), beside)
    return file


def write_proposal(d: Diagnosis, folder: Path) -> tuple[str, Path]:
    """The proposed term as an effect file that a user may edit: its id and place."""
    assert d.proposal is not None
    name = d.proposal.effect.replace("generic_", "proposed_").lower()
    file = folder / f"{name}.py"
    with written(file) as beside:
        beside.write_text(terms()[d.proposal.effect].file(name), encoding="utf-8")
    return name, file
