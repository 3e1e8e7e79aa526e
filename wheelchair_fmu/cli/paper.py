"""`wheelchair paper`: the paper's own study through the FMU; its figures, and each of its statements with our figure."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.table import Table

from ..model.variant import Variant
from ..report.families import family_figure, radius_family_figure
from ..report.saving import save
from ..studies import Fmu, fmu_of
from ..studies.paper import FIGURES, STATEMENTS, FamilyFigure, Finding, OpenValue, Range, Runs, Setting, ranges
from ..writing import written
from .files import print_json
from .group import console
from .settings import parse
from .terminal import announce

Ranges = dict[str, list[Range]]  # by statement id
Findings = Mapping[str, Finding]


def register(app: typer.Typer) -> None:
    app.command()(paper)


def paper(
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    delta_force: Annotated[float, typer.Option(min=0.1, help="ΔF [N] of turns and slaloms; not in the paper's text.")] = 10.0,
    period: Annotated[float, typer.Option(help="Period T of the slalom [s]; not in the paper's text.")] = 4.0,
    equations: Annotated[str, typer.Option(metavar="KIND", help="paper: to the letter, or extended.")] = "paper",
    with_ranges: Annotated[bool, typer.Option("--ranges/--no-ranges", help="Vary what the text leaves open.")] = True,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the files go.")] = Path("out/paper"),
) -> None:
    """Run sections 6.1 to 6.3 of the paper, its figures 12 to 19, and which of its statements hold."""
    chair = replace(Variant(), choice=replace(Variant().choice, equations=equations))
    with Fmu(fmu_of(chair)) as fmu:
        setting = Setting(delta_force, period, values=fmu.checked(parse(settings or ())))
        runs = Runs(fmu, setting)
        findings = {s.id: s.measure(runs) for s in STATEMENTS}
        files = [file for figure in FIGURES for file in _draw(figure, runs, output)]
        found = _ranges(fmu, setting) if with_ranges else {}
    files.append(_write_table(findings, found, output / "statements.md"))
    if as_json:
        print_json(_record(findings, found))
        return
    for file in files:
        announce(file)
    _show(findings, found)


def _draw(figure: FamilyFigure, runs: Runs, folder: Path) -> list[Path]:
    """Fig. n as PNG and SVG."""
    lines = figure.lines(runs)
    time = next(iter(lines.values())).time
    draw = radius_family_figure if figure.of_radius else family_figure
    drawn = draw(f"Fig. {figure.number}: {figure.title}", time, {label: run.columns for label, run in lines.items()})
    files = [folder / f"fig-{figure.number}{ending}" for ending in (".png", ".svg")]
    for file in files:
        with written(file) as beside:
            save(drawn, beside)
    return files


def _ranges(fmu: Fmu, setting: Setting) -> Ranges:
    found: Ranges = {s.id: [] for s in STATEMENTS}
    with console(stderr=True).status("varying what the text leaves open"):
        for _, by_statement in ranges(fmu, setting):
            for id, one in by_statement.items():
                found[id].append(one)
    return found


def _limits(found: Ranges) -> list[tuple[str, str]]:
    """Of the statements that do not hold over everything tried: where they do."""
    rows = []
    for s in STATEMENTS:
        limits = [r for r in found.get(s.id, []) if not all(r.held)]
        if limits:
            rows.append((s.says, "; ".join(f"{r.open.symbol} {r} {r.open.unit}".rstrip() for r in limits)))
    return rows


def _tried(found: Ranges) -> str:
    values: Iterable[OpenValue] = (r.open for r in next(iter(found.values()), []))
    return ", ".join(f"{v.symbol} {min(v.tried):g} to {max(v.tried):g} {v.unit}".rstrip() for v in values)


def _write_table(findings: Findings, found: Ranges, file: Path) -> Path:
    """Both tables as Markdown."""
    lines = ["| where | the paper says | our figure | holds |", "|---|---|---|---|"]
    lines += [f"| {s.where} | {s.says} | {findings[s.id].figure} | {_yes(findings[s.id])} |" for s in STATEMENTS]
    if found:
        lines += ["", f"Tried one at a time: {_tried(found)}.", "", "| the paper says | holds for |", "|---|---|"]
        lines += [f"| {says} | {limits} |" for says, limits in _limits(found)]
        lines.append("| everything else | all values tried |")
    with written(file) as beside:
        beside.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def _record(findings: Findings, found: Ranges) -> dict[str, object]:
    """Both tables as plain data; a range is what holds around the chosen value, null where that one does not."""
    statements = [
        {
            "id": s.id,
            "where": s.where,
            "says": s.says,
            "figure": findings[s.id].figure,
            "holds": findings[s.id].holds,
            "ranges": {r.open.name: r.around for r in found.get(s.id, [])},
        }
        for s in STATEMENTS
    ]
    tried = {r.open.name: r.open.tried for r in next(iter(found.values()), [])}
    return {"statements": statements, "tried": tried}


def _show(findings: Findings, found: Ranges) -> None:
    table = Table(box=box.SIMPLE)
    for title in ("where", "the paper says", "our figure", "holds"):
        table.add_column(title)
    for s in STATEMENTS:
        table.add_row(s.where, s.says, findings[s.id].figure, _yes(findings[s.id]))
    out = console()
    out.print(table)
    out.print(f"{sum(f.holds for f in findings.values())} of {len(findings)} hold")
    if found:
        out.print(f"\nTried one at a time: {_tried(found)}")
        for says, limits in _limits(found):
            out.print(f"    {says}: {limits}")
        out.print("    everything else: all values tried")


def _yes(finding: Finding) -> str:
    return "yes" if finding.holds else "no"
