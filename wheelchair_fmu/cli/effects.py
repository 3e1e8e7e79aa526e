"""`wheelchair effects`: the catalogue, from the records themselves."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..errors import UsageError, unknown
from ..model.effects import bundled
from ..model.expression import effect_file
from ..model.stage import Effect
from ..quantities import N, Parameter
from ..writing import written
from .files import print_json
from .group import console

app = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="The physical effects that the chair can have.")
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


def register(parent: typer.Typer) -> None:
    parent.add_typer(app, name="effects")


@app.command(name="list")
def list_effects(as_json: AsJson = False) -> None:
    """Every effect with its parameters, their units and smallest interesting sizes."""
    effects = bundled().values()
    if as_json:
        print_json([record(effect) for effect in effects])
        return
    table = Table(box=box.SIMPLE)
    for title in ("effect", "what it is", "parameters and their smallest interesting sizes"):
        table.add_column(title, no_wrap=title == "effect")
    for effect in effects:
        table.add_row(effect.id, effect.title, ", ".join(_size(p) for p in effect.parameters))
    console().print(table)


@app.command()
def show(
    effect: Annotated[str, typer.Argument(metavar="ID", help="An effect, as `list` names it.")],
    as_json: AsJson = False,
) -> None:
    """One effect: what it is, what it acts on, its parameters and where their sizes come from."""
    if effect not in bundled():
        raise unknown("effect", effect, bundled())
    told = record(bundled()[effect])
    if as_json:
        print_json(told)
        return
    out = console()
    out.print(f"{told['id']}: {told['meaning']}")
    out.print(f"acts on: {', '.join(told['acts_on']) or 'the recorded pushes'}")
    if told["states"]:
        out.print(f"states of its own: {', '.join(told['states'])}")
    if told["needs"]:
        out.print("needs: " + ", ".join(f"{kind} = {law}" for kind, law in told["needs"].items()))
    out.print(f"in the default FMU: {'yes' if told['in_default_fmu'] else 'no'}")
    for p in told["parameters"]:
        out.print(f"\n{p['name']} [{p['unit']}]: {p['meaning']}")
        out.print(f"    off at {p['default']:g}" if p["estimated"] else f"    a constant, {p['default']:g} unless set")
        if p["smallest_interesting"] is not None:
            out.print(f"    smallest interesting size: {p['smallest_interesting']:g} {p['unit']}")
        low, high = ("−∞" if p["lower"] is None else f"{p['lower']:g}", "∞" if p["upper"] is None else f"{p['upper']:g}")
        out.print(f"    bounds: {low} to {high} {p['unit']}")
        out.print(f"    source: {p['source']}")


@app.command()
def new(
    effect: Annotated[str, typer.Argument(metavar="ID", help="A name in small letters and underscores.")],
    folder: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the file goes.")] = Path("effects"),
) -> None:
    """Start an effect of your own: a file to edit, which `--effects DIR` puts into the catalogue."""
    if not re.fullmatch(r"[a-z][a-z0-9_]*", effect):
        raise UsageError(f"{effect!r} is no name for an effect; use small letters, digits and underscores, like my_drag")
    file = folder / f"{effect}.py"
    if effect in bundled() or file.exists():
        raise UsageError(f"there is an effect {effect!r} already; choose another name")
    text = effect_file(effect, "say in a few words what it is", "F_x", N, "-q * u", size=0.5, lower=0.0, upper=100.0,
                       source="say where its size comes from")  # fmt: skip
    with written(file) as beside:
        beside.write_text(text, encoding="utf-8")
    print(file)


def record(effect: Effect) -> dict[str, Any]:
    """An effect as plain data."""
    return {
        "id": effect.id,
        "meaning": effect.title,
        "acts_on": list(dict.fromkeys(c.to for c in effect.contributions)),
        "states": [f"effect.{effect.id}.{name}" for row in effect.rows for name in row.state.names],
        "needs": dict(effect.needs),
        "in_default_fmu": effect.stateless,
        "parameters": [_parameter(p) for p in effect.owned],
    }


def _parameter(p: Parameter) -> dict[str, Any]:
    bounds = {key: None if abs(value) == float("inf") else value for key, value in (("lower", p.lower), ("upper", p.upper))}
    return {
        "name": p.name, "unit": p.unit.name, "meaning": p.meaning, "default": p.default, **bounds,
        "smallest_interesting": p.smallest_interesting, "estimated": p.estimated, "source": p.source,
    }  # fmt: skip


def _size(p: Parameter) -> str:
    size = "" if p.smallest_interesting is None else f" {p.smallest_interesting:g}"
    return f"{p.symbol}{size} {'' if p.unit.name == '1' else p.unit.name}".rstrip()
