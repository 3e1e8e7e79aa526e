"""`wheelchair effects`: the catalogue, from the records themselves."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from shlex import quote
from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..errors import UsageError, unknown
from ..inference.subject import chair
from ..model.alike import look_alikes
from ..model.effects import NAME, bundled
from ..model.signs import Shows
from ..model.stage import Effect
from ..quantities import Parameter
from ..writing import written
from . import templates
from .files import print_json
from .group import console
from .quantities import quantities
from .terminal import announce
from .trust import variant_option

app = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="The physical effects that the chair can have.")
KINDS = ("force", "moment", "reading", "state", "body")
Own = Annotated[Path | None, typer.Option("--effects", metavar="DIR", help="A folder with effect files of your own.")]
In = Annotated[Path | None, variant_option("A variant, for the effects of somebody's own in it.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]

app.command()(quantities)


def register(parent: typer.Typer) -> None:
    parent.add_typer(app, name="effects")


@app.command(name="list")
def list_effects(as_json: AsJson = False, own: Own = None, variant: In = None) -> None:
    """Every effect with its parameters, their units and smallest interesting sizes."""
    known = chair(variant, own).catalogue
    if as_json:
        print_json([record(effect, known) for effect in known.values()])
        return
    table = Table(box=box.SIMPLE)
    for title in ("effect", "what it is", "parameters and their smallest interesting sizes"):
        table.add_column(title, no_wrap=title == "effect")
    for effect in known.values():
        table.add_row(
            effect.id,
            f"{effect.title} (your own)" if effect.program else effect.title,
            ", ".join(_size(p) for p in effect.parameters),
        )
    console().print(table)


@app.command()
def show(
    effect: Annotated[str, typer.Argument(metavar="ID", help="An effect, as `list` names it.")],
    as_json: AsJson = False,
    own: Own = None,
    variant: In = None,
) -> None:
    """One effect: what it is, what it acts on, its parameters and where their sizes come from."""
    known = chair(variant, own).catalogue
    if effect not in known:
        raise unknown("effect", effect, known)
    told = record(known[effect], known)
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
    if told["own"]:
        out.print("your own; it keeps every contract that the bundled effects keep")
    else:
        out.print(f"in the default FMU: {'yes' if told['in_default_fmu'] else 'no'}")
    for a in told["alike"]:
        out.print(f"looks like {', '.join(a['with'])} in {a['what']}; told by {a['told_by']}")
    for p in told["parameters"]:
        out.print(f"\n{p['name']} [{p['unit']}]: {p['meaning']}")
        out.print(f"    off at {p['default']:g}" if p["estimated"] else f"    a constant, {p['default']:g} unless set")
        if p["above_zero"]:
            out.print(f"    above zero: {p['above_zero']}")
        if p["smallest_interesting"] is not None:
            out.print(f"    smallest interesting size: {p['smallest_interesting']:g} {p['unit']}")
        low, high = ("−∞" if p["lower"] is None else f"{p['lower']:g}", "∞" if p["upper"] is None else f"{p['upper']:g}")
        out.print(f"    bounds: {low} to {high} {p['unit']}")
        out.print(f"    source: {p['source']}")


@app.command()
def new(
    effect: Annotated[str, typer.Argument(metavar="ID", help="A name in small letters and underscores.")],
    folder: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the file goes.")] = Path("effects"),
    kind: Annotated[
        str, typer.Option(metavar="KIND", help="What to begin with: force, moment, reading, state or body.")
    ] = "force",
) -> None:
    """Start an effect of your own: a file to edit, which `--effects DIR` puts into the catalogue."""
    if kind not in KINDS:
        raise unknown("kind of effect", kind, KINDS)
    if not NAME.fullmatch(effect):
        raise UsageError(f"{effect!r} is no name for an effect; use small letters, digits and underscores, like my_drag")
    file = folder / f"{effect}.py"
    if effect in bundled() or file.exists():
        raise UsageError(f"there is an effect {effect!r} already; choose another name")
    with written(file) as beside:
        beside.write_text(template(kind, effect), encoding="utf-8")
    announce(file)
    where = f"--effects {quote(str(folder))}"
    print(
        "It is a whole effect already; its first lines say what to change. Then check it, diagnose with it, add it:",
        f"  wheelchair effects show {effect} {where}",
        f"  wheelchair diagnose CAMPAIGN {where}",
        f"  wheelchair add {effect} CAMPAIGN {where} -o better.toml",
        sep="\n",
    )


def template(kind: str, effect: str) -> str:
    """An effect of one of the KINDS to begin with, under this id."""
    text = files(templates).joinpath(f"{kind}.py").read_text(encoding="utf-8")
    return text.replace('"my_effect"', f'"{effect}"')


def record(effect: Effect, catalogue: Mapping[str, Effect]) -> dict[str, Any]:
    """An effect as plain data, beside the others of the catalogue."""
    signs = {p.name: sign for p, sign in zip(effect.owned, effect.signs, strict=False)}
    return {
        "id": effect.id,
        "meaning": effect.title,
        "acts_on": _acted_on(effect),
        "states": [f"effect.{effect.id}.{name}" for row in effect.rows for name in row.state.names],
        "needs": dict(effect.needs),
        "own": effect.program is not None,
        "in_default_fmu": effect.stateless and effect.program is None,
        "alike": [
            {"what": a.what, "with": list(look_alikes(effect, a, catalogue)), "told_by": a.told_by} for a in effect.alike
        ],
        "parameters": [_parameter(p, signs.get(p.name)) for p in effect.owned],
    }


def _acted_on(effect: Effect) -> list[str]:
    """Quantities that it adds to or multiplies, and speeds of the chair that it shares inertia with."""
    return list(
        dict.fromkeys([*(c.to for c in effect.contributions), *(speed for row in effect.rows for speed in row.coupled)])
    )


def _parameter(p: Parameter, sign: Shows | None) -> dict[str, Any]:
    bounds = {key: None if abs(value) == float("inf") else value for key, value in (("lower", p.lower), ("upper", p.upper))}
    return {
        "name": p.name,
        "unit": p.unit.name,
        "meaning": p.meaning,
        "above_zero": sign.words if sign else None,
        "default": p.default,
        **bounds,
        "smallest_interesting": p.smallest_interesting,
        "estimated": p.estimated,
        "source": p.source,
    }


def _size(p: Parameter) -> str:
    size = "" if p.smallest_interesting is None else f" {p.smallest_interesting:g}"
    return f"{p.name}{size} {'' if p.unit.name == '1' else p.unit.name}".rstrip()
