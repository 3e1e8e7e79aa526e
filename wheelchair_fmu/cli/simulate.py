"""`wheelchair simulate`: a manoeuvre through an FMU, by fmpy; a table of results and a figure."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from math import isinf, isnan
from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.table import Table

from ..api.frames import save as save_frame
from ..api.runs import driven, frame_of
from ..errors import UsageError
from ..handling.key_numbers import KeyNumber, key_numbers
from ..handling.manoeuvres import MANOEUVRES, Manoeuvre, manoeuvre, refuse_unknown
from ..report.figures import manoeuvre_figure
from ..report.saving import save
from ..studies import Result
from ..writing import written
from .files import Kind, TableKind
from .group import console
from .settings import parse
from .terminal import announce
from .trust import variant_option

# What a manoeuvre of a user's own takes, only its file says, so the parser lets pass what it does not know.
ANY = {"allow_extra_args": True, "ignore_unknown_options": True}


def register(app: typer.Typer) -> None:
    app.command(context_settings=ANY)(simulate)


def simulate(
    ctx: typer.Context,
    name: Annotated[str, typer.Argument(metavar="MANOEUVRE", help=f"One of {', '.join(MANOEUVRES)}.")],
    speed: Annotated[float | None, typer.Option(help="Forward speed [m/s]: held, or at the start of a coast-down.")] = None,
    delta_force: Annotated[float | None, typer.Option(help="ΔF [N]; F_rl − F_rr = 2ΔF, positive turns right.")] = None,
    period: Annotated[float | None, typer.Option(help="Period T of the slalom [s].")] = None,
    time: Annotated[float | None, typer.Option(help="Length [s].")] = None,
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, variant_option("Laws, effects and values.")] = None,
    effects: Annotated[str | None, typer.Option(metavar="IDS", help="default, all, none, ids, or a folder.")] = None,
    equations: Annotated[str | None, typer.Option(metavar="KIND", help="extended, or paper: to the letter.")] = None,
    fmu: Annotated[Path | None, typer.Option(metavar="PATH", help="Drive this FMU instead of building one.")] = None,
    table: Kind = TableKind.csv,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the files go.")] = Path("out"),
) -> None:
    """Put the chair through a manoeuvre of the paper, or into standstill, spin and reverse; or through one of your own, whose
    options are those of its function."""
    course = manoeuvre(name, speed=speed, delta_force=delta_force, period=period, time=time, **_further(name, ctx))
    given = parse(settings or ())
    if fmu and (variant or effects or equations):
        raise UsageError("--fmu gives a finished FMU; leave out --variant, --effects and --equations, or --fmu")
    with console(stderr=True).status("simulating"):
        result, values = driven(course, variant, given, effects or "default", equations, fmu)
    held = values.get("speed.mode") == 2
    _tell(result.warnings)
    for file in _write(course, result, output, table):
        announce(file)
    console().print(_table(key_numbers(result.columns, held=held)))


def _further(name: str, ctx: typer.Context) -> dict[str, float]:
    """Options that a manoeuvre of a user's own has beside the usual ones, given as --width 0.9 or --width=0.9."""
    given, rest = {}, list(ctx.args)
    usual = [option for parameter in ctx.command.params for option in parameter.opts]
    while rest:
        option, equals, value = rest.pop(0).partition("=")
        if not option.startswith("--"):
            raise UsageError(f"{option!r} is no option; an option of {name} is written as --period 4")
        key = option.removeprefix("--").replace("-", "_")
        try:
            refuse_unknown(name, [key])
        except UsageError as error:
            close = get_close_matches(option, usual, n=1, cutoff=0.7)
            raise UsageError(f"no option {option}; did you mean {close[0]}?") if close else error from None
        value = value if equals else rest.pop(0) if rest else ""
        try:
            given[key] = float(value)
        except ValueError:
            raise UsageError(f"{option} {value}: {value!r} is no number; give one, as in {option} 1.5") from None
    return given


def _tell(warnings: Iterable[str]) -> None:
    for warning in warnings:
        console(stderr=True).print(f"warning: {warning}")


def _write(course: Manoeuvre, result: Result, folder: Path, table: str) -> list[Path]:
    """The table, PNG and SVG."""
    files = [folder / f"{course.name}{ending}" for ending in (".png", ".svg")]
    figure = manoeuvre_figure(course.title, result.time, result.columns, course.watch)
    for file in files:
        with written(file) as beside:
            save(figure, beside)
    return [save_frame(frame_of(course, result), folder / f"{course.name}.{table}"), *files]


def _table(numbers: list[KeyNumber]) -> Table:
    table = Table(box=box.SIMPLE)
    table.add_column("result")
    for title in ("at the end", "mean", "least", "greatest"):
        table.add_column(title, justify="right")
    for n in numbers:
        table.add_row(f"{n.meaning} [{n.unit}]", *map(_digits, (n.end, n.mean, n.least, n.greatest)))
    return table


def _digits(value: float) -> str:
    if isnan(value):
        return ""
    return "straight" if isinf(value) else f"{round(value, 4) + 0.0:.4f}"  # + 0.0 takes the sign off what is nothing
