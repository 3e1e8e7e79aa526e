"""`wheelchair diagnose`: which effect is missing, what cannot be told apart, and what to measure next."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..api import diagnoses
from ..api.diagnosing import searched
from ..campaign import windows
from ..inference.decision.bootstrap import Bootstrap, bootstrap
from ..inference.decision.decide import insufficient
from ..inference.decision.diagnosis import Diagnosis
from ..model.effects import bundled
from ..model.generic import terms, told_at
from ..report.saving import save
from ..report.words import helpers, listed, needed, outside, probably, tied, to_measure, verdict_words
from ..writing import written
from .files import write_json
from .group import Progress, console, working
from .settings import subject
from .staircase import physical_staircase, staircase_table
from .terminal import announce
from .trust import variant_option

LIKELIEST = 8  # effects, of which the table tells
SENTENCES = {
    "missing": "Missing: {effects}.",
    "small": "There, but too small to matter: {effects}. The model is adequate without.",
    "needed": "There, too small to matter by itself: {effects}. Without, the model leaves more than noise.",
    "adequate": "Nothing is missing: the model explains these data, and would have shown an effect of interesting size.",
    "cannot_see": "Nothing was found for sure, but effects could be of interesting size and these runs would not show it.",
}


def register(app: typer.Typer) -> None:
    app.command()(diagnose)


def diagnose(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, variant_option("Laws, effects and values to start from.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    json_file: Annotated[Path | None, typer.Option("--json", metavar="OUT", help="Write the diagnosis as JSON.")] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="DIR", help="For estimates, figures and proposals.")
    ] = None,
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
        found, content = searched(measured, chair, fixed, say)
    stable = bootstrap(found, resamples) if resamples else None
    if stable:
        content["bootstrap"] = stable.as_json()
    if json_file:
        write_json(json_file, content)
    show(found, content)
    if stable:
        _show_bootstrap(stable)
    if output:
        for file in _files(diagnoses.Diagnosis(measured, chair, fixed, found, content), found, output):
            announce(file)


def show(d: Diagnosis, content: dict[str, Any]) -> None:
    """The verdict and its evidence, for a person."""
    out = console()
    for note in d.notes:
        out.print(f"note: {note}")
    ids = {e: e for e in d.effects}
    out.print(f"{d.campaign}: {_verdict(d, content, ids)}")
    for odds in content["odds"]:
        out.print("the odds: " + ", ".join(f"{effect} {share:.2f}" for effect, share in odds.items()))
    if d.verdict == "outside" and d.effects:
        out.print(f"These help but do not suffice: {helpers(d.effects, d.ties, ids)}.")
    if d.proposal:
        term = terms()[d.proposal.effect]
        size = f"{d.proposal.estimate[0]:.3g} ± {d.proposal.se[0]:.2g} {term.unit.name}"
        lead = "The term that helps most, and does not suffice either" if insufficient(d.ladder) else "What would explain it"
        out.print(f"{lead}: {term.words}, {size}{told_at(d.proposal.effect)}.")
    out.print(staircase_table(d.ladder))
    out.print(physical_staircase(d.ladder))
    for words in d.unexplained.words if d.unexplained else ():
        out.print(words)
    out.print(_ranking(content, set(d.models.factory.catalogue) - set(bundled())))
    for row in content["ranking"]:
        for name, size in row["parameters"].items():
            if ends := size.get("interval"):
                told = f"{row['effect']}.{name} = {size['estimate']:.4g} {size['unit']}"
                out.print(f"{told}, 95 % within {ends[0]:.4g} to {ends[1]:.4g}")
    if d.next_experiment:
        n = d.next_experiment
        times = "" if n["repeats"] == 1 else f", {n['repeats']} times"
        what = to_measure(n["manoeuvre"], {p.name: p for p in d.models.factory.variant.parameters()})
        out.print(f"Measure {what} next{times}{_aim(d, n['separates'])}: {n['why']}.")
    out.print(f"{d.seconds:.1f} s")


def _aim(d: Diagnosis, separates: Sequence[str]) -> str:
    """What a run would be for."""
    if d.verdict == "tie":
        return f", to tell {' and '.join(separates)} apart"
    return f", to show {', '.join(separates)}" if separates else ""


def _verdict(d: Diagnosis, content: Mapping[str, Any], ids: Mapping[str, str]) -> str:
    if d.verdict == "tie":
        return tied(d.effects, d.ties, ids)
    named = [probably(content, e) + e for e in d.effects]
    effects = listed(named, "or") if d.verdict == "small" else ", ".join(named)  # of several small ones it is one
    said = SENTENCES.get("needed" if needed(content) else d.verdict, "").format(effects=effects)
    return outside(content) if d.verdict == "outside" else said


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
    for title in ("effect", "parameter", "estimate", "of interest", "P(larger)", "power", "Δ(−2 log L)", "verdict"):
        right = title in ("P(larger)", "power", "Δ(−2 log L)")
        table.add_column(title, no_wrap=True, justify="right" if right else "left")
    for place, row in enumerate(content["ranking"]):
        if place >= LIKELIEST and row["effect"] not in own:
            continue
        larger = "" if row["probability"] is None else f"{row['probability']:.2f}"
        figures = (larger, f"{row['power']:.2f}", f"{row['lr']:.0f}", verdict_words(row))
        for i, (name, v) in enumerate(row["parameters"].items()):
            se = f"{v['se']:.2g}" if v["se"] is not None else "?"
            size = f"{v['estimate']:.3g} ± {se} {v['unit']}".removesuffix(" 1")
            about = (name, size, f"{v['smallest_interesting']:g}")
            table.add_row("" if i else row["effect"], *about, *(("",) * 4 if i else figures))
    return table


def _files(face: diagnoses.Diagnosis, d: Diagnosis, folder: Path) -> list[Path]:
    figures = {"staircase": face.plot_staircase(), "estimates": face.plot_estimates()}
    if face.as_dict()["missing"]:
        figures["missing"] = face.plot_missing()
    files = [face.save(folder / f"estimates{ending}") for ending in (".csv", ".tex")]
    for name, figure in figures.items():
        for ending in (".png", ".svg"):
            with written(folder / f"{name}{ending}") as beside:
                save(figure, beside)
            files.append(folder / f"{name}{ending}")
    return [*files, write_proposal(d, folder / "effects")[1]] if d.proposal else files


def write_proposal(d: Diagnosis, folder: Path) -> tuple[str, Path]:
    """The proposed term as an effect file that a user may edit: its id and place."""
    assert d.proposal is not None
    name = d.proposal.effect.replace("generic_", "proposed_").lower()
    file = folder / f"{name}.py"
    with written(file) as beside:
        beside.write_text(terms()[d.proposal.effect].file(name), encoding="utf-8")
    return name, file
