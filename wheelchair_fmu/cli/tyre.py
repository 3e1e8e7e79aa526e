"""`wheelchair tyre`: rig data → fitted laws → the parameters of a chair."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..errors import UsageError
from ..fmu import parameter_set
from ..model.variant import LAWS, variant_text
from ..report.saving import save
from ..report.tyre_figures import paper_figures
from ..tyres import Identified, Measured, identify, read
from ..tyres.fitting import Estimate
from ..tyres.identify import OF_PEAK, TOLERANCE, ConditionFit, dugoff_off
from ..tyres.magic_formula import FORCE, TORQUE
from ..tyres.parameters import chair, chosen
from ..tyres.records import KM_H, SLIP
from ..tyres.summary import condition as summarised
from ..tyres.summary import summary
from ..tyres.tir import tir_text
from ..writing import written
from .files import print_json
from .group import console
from .terminal import announce

app = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="Tyres identified from rig data.")
File = Annotated[Path, typer.Argument(metavar="FILE", help="Rig data: .csv, TYDEX 1.3 (.tdx), or a tyre property file (.tir).")]
Axes = Annotated[str, typer.Option(metavar="SAE|ISO", help="sae: y to the right, as in the paper; iso: y to the left.")]
Tolerance = Annotated[float, typer.Option(help="Error [1] that the linear law may have of the measured curve.")]


def register(parent: typer.Typer) -> None:
    parent.add_typer(app, name="tyre")


@app.command()
def fit(
    file: File,
    axes: Axes = "sae",
    tolerance: Tolerance = TOLERANCE,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, SI units.")] = False,
) -> None:
    """Linear, Dugoff and Magic Formula laws of every condition, and one law across load and pressure."""
    measured, found = _identified(file, axes, tolerance)
    if as_json:
        print_json({"file": str(file), "warnings": [str(f) for f in measured.warnings], **summary(found)})
        return
    out = console()
    out.print(_slopes(found))
    out.print(_dugoff(found))
    out.print(_magic(found, FORCE, "N"))
    out.print(_magic(found, TORQUE, "N m"))
    out.print(_across(found))


@app.command()
def plot(
    file: File,
    axes: Axes = "sae",
    tolerance: Tolerance = TOLERANCE,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the figures go.")] = Path("out"),
) -> None:
    """The curves and their laws as Figs. 4 to 9 of the paper, PNG and SVG."""
    _, found = _identified(file, axes, tolerance)
    for name, figure in paper_figures(found):
        for ending in (".png", ".svg"):
            target = output / f"tyre-{name}{ending}"
            with written(target) as beside:
                save(figure, beside)
            announce(target)


@app.command()
def export(
    file: File,
    output: Annotated[list[Path], typer.Option("-o", "--output", metavar="FILE", help="A .toml, .ssv or .tir; repeatable.")],
    tyre: Annotated[str | None, typer.Option(help="Which tyre, where the file has several.")] = None,
    pressure: Annotated[float | None, typer.Option(help="At this pressure [bar]; else the one nearest to 4.")] = None,
    load: Annotated[float | None, typer.Option(help="At this load [N]; else the one nearest to 400.")] = None,
    speed: Annotated[float | None, typer.Option(help="At this speed [km/h]; else the one nearest to 4.")] = None,
    law: Annotated[str, typer.Option(metavar="LAW", help=f"One of {', '.join(LAWS['tyre'])}.")] = "magic_formula",
    axes: Axes = "sae",
) -> None:
    """One condition as the FMU's parameters: a variant (TOML), an SSP parameter set (.ssv), or a tyre property file (.tir)."""
    for target in output:
        if target.suffix.lower() not in (".toml", ".ssv", ".tir"):
            raise UsageError(f"-o {target}: write a .toml, .ssv or .tir")
    _, found = _identified(file, axes)
    fit = chosen(found, tyre, pressure, load, None if speed is None else speed * KM_H)
    texts = [_exported(found, fit, law, target.suffix.lower()) for target in output]
    for target, text in zip(output, texts, strict=True):
        with written(target) as beside:
            beside.write_bytes(text)
        announce(target)


def _exported(found: Identified, fit: ConditionFit, law: str, ending: str) -> bytes:
    if ending == ".tir":
        return tir_text(found, fit).encode()
    variant = chair(found, fit, law)
    if ending == ".toml":
        return variant_text(variant).encode()
    return parameter_set.text(parameter_set.from_variant(variant, "tyre", str(fit.condition)))


def _identified(file: Path, axes: str, tolerance: float = TOLERANCE) -> tuple[Measured, Identified]:
    if not 0 < tolerance < 1:
        raise UsageError(f"--tolerance {tolerance:g} is no fraction; give one between 0 and 1, such as 0.05")
    measured = read(file, axes.lower())
    found = identify(measured.sweeps, tolerance)
    told = console(stderr=True)
    for fault in measured.warnings:
        told.print(str(fault))
    for each in found.conditions:
        for warning in each.warnings:
            told.print(f"warning: {each.condition}: {warning}")
    return measured, found


def _slopes(found: Identified) -> Table:
    table = _table(
        "linear, at the origin",
        "C_λ [N/rad]",
        "C_mλ [N m/rad]",
        "C_φ [N/rad]",
        "C_mφ [N m/rad]",
        f"force, torque straight to {100 * found.tolerance:g} %",
    )
    for fit in found.conditions:
        told = summarised(fit, found.tolerance)["linear"]
        cells = [_with_error(told[name], told["se"][name]) for name in ("C_lambda", "C_m_lambda", "C_phi", "C_m_phi")]
        ranges = ", ".join(_reach(told["range"][name]) for name in ("C_lambda", "C_m_lambda"))
        table.add_row(str(fit.condition), *cells, ranges)
    return table


def _dugoff(found: Identified) -> Table:
    table = _table(
        "Dugoff, over all slips",
        "C_λ [N/rad]",
        "μ",
        "c_p [mm]",
        "rms [N]",
        "rms [N m]",
        f"torque off by {100 * OF_PEAK:g} % of its peak",
    )
    for fit in found.conditions:
        law = fit.dugoff
        if law is None:
            table.add_row(str(fit.condition), *"–" * 6)
            continue
        off = ", ".join(f"{math.degrees(a):.1f}–{math.degrees(b):.1f}°" for a, b in dugoff_off(fit, TORQUE) or ()) or "–"
        trail = "–" if law.c_p is None else f"{1000 * law.c_p.value:.2f}"
        table.add_row(
            str(fit.condition),
            f"{law.C_lambda.value:.0f}",
            f"{law.mu.value:.3f}",
            trail,
            f"{law.rms_force:.2f}",
            _number(law.rms_torque),
            off,
        )
    return table


def _magic(found: Identified, channel: str, unit: str) -> Table:
    table = _table(f"Magic Formula, {channel}", "B [1/rad]", "C", f"D [{unit}]", "E", f"rms [{unit}]", "rests on the prior")
    for fit in found.conditions:
        law = fit.magic(SLIP, channel)
        cells = (
            ["–"] * 6
            if law is None
            else [
                *(_with_error(e.value, e.se, 2) for e in (law.B, law.C, law.D, law.E)),
                f"{law.rms:.3f}",
                ", ".join(law.untold) or "–",
            ]
        )
        table.add_row(str(fit.condition), *cells)
    return table


def _across(found: Identified) -> Table:
    table = _table("one law: K = K₀ (p/4 bar)^n (N/400 N)^m", "K₀ [SI]", "n, pressure", "m, load", "speed (left out)")
    for tyre, own in found.across.items():
        for name, law in own.laws.items():
            cells = [_plus_minus(law.exponents.get(over)) for over in ("pressure", "load")]
            table.add_row(f"tyre {tyre}, {name}", _with_error(law.K.value, law.K.se), *cells, _plus_minus(own.speed.get(name)))
    return table


def _table(first: str, *others: str) -> Table:
    table = Table(box=box.SIMPLE)
    table.add_column(first, no_wrap=True)
    for title in others:
        table.add_column(title, justify="right")
    return table


def _with_error(value: float | None, se: float | None, digits: int = 1) -> str:
    if value is None:
        return "–"
    digits = 0 if abs(value) >= 100 else digits
    return f"{value:.{digits}f}" if se is None else f"{value:.{digits}f} ± {se:.{digits}f}"


def _plus_minus(e: Estimate | None) -> str:
    return "–" if e is None else f"{e.value:.2f} ± {e.se:.2f}"


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"


def _reach(told: dict[str, Any] | None) -> str:
    """'2.1°', or '> 5°' where the data end before the line fails."""
    if told is None:
        return "–"
    return f"{'' if told['exceeded'] else '> '}{math.degrees(told['angle']):.1f}°"
