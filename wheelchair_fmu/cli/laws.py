"""`wheelchair laws`: laws of tyres, casters and rear wheels, and whether a user's own keep what every law has to keep."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..contracts.of_laws import law_breaches
from ..errors import EffectError, UsageError, unknown
from ..inference.subject import chair
from ..model.choice import KINDS, Choice, configured, law, names
from .files import print_json
from .group import console
from .terminal import announce
from .trust import variant_option

app = typer.Typer(
    no_args_is_help=True, rich_markup_mode=None, help="The laws of tyres, casters and rear wheels to choose from."
)
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
In = Annotated[Path | None, variant_option("A variant, for the laws of somebody's own in it.")]


def register(parent: typer.Typer) -> None:
    parent.add_typer(app, name="laws")


@app.command(name="list")
def list_laws(as_json: AsJson = False, variant: In = None) -> None:
    """Every law, what it is for, and where it comes from."""
    told = list(_records(chair(variant, None).choice))
    if as_json:
        print_json(told)
        return
    table = Table(box=box.SIMPLE)
    for title in ("law", "of", "from", "parameters of its own"):
        table.add_column(title)
    for record in told:
        table.add_row(record["name"], record["kind"], record["from"], ", ".join(record["parameters"]))
    console().print(table)


@app.command()
def check(
    law_names: Annotated[list[str] | None, typer.Argument(metavar="LAW...", help="Laws; all of your own unless given.")] = None,
    variant: In = None,
) -> None:
    """Hold laws to what every law has to keep: units, mirror, finite and exact slopes, and no force that drives."""
    choice = chair(variant, None).choice
    asked = _asked(choice, law_names or [])
    if not asked:
        raise UsageError("there are no laws of your own here; name one, or see `wheelchair laws list`")
    broken = []
    for kind, name in asked:
        if found := law_breaches(kind, choice.with_laws({kind: name})):
            broken += found
        else:
            announce(f"{kind} law {name}: keeps every contract that the bundled laws keep")
    if broken:
        raise EffectError(broken)


def _asked(choice: Choice, given: list[str]) -> list[tuple[str, str]]:
    """Kinds and names of laws: those given, or a user's own."""
    known = [(kind, name) for kind in KINDS for name in names(choice)[kind]]
    for name in given:
        if name not in [other for _, other in known]:
            raise unknown("law", name, [other for _, other in known])
    own = {(kind, name) for kind in KINDS for name in configured(kind)} | {(one.kind, one.name) for one in choice.own}
    return [pair for pair in known if (pair[1] in given if given else pair in own)]


def _records(choice: Choice) -> Iterator[dict[str, Any]]:
    carried = {(one.kind, one.name): one.file for one in choice.own}
    for kind in KINDS:
        here = configured(kind)
        for name in names(choice)[kind]:
            place = carried.get((kind, name)) or (here[name].file if name in here else "the package")
            parameters = [p.name for p in law(kind, choice, name).parameters]
            yield {"name": name, "kind": kind, "from": place, "parameters": parameters}
