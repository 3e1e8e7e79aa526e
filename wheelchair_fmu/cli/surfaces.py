"""`wheelchair surfaces`: how hard a chair rolls on floors of published measurements, and on soft tyres."""

from __future__ import annotations

from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..errors import UsageError
from ..model.tyre.common import PARAMETERS, RATED
from ..surroundings.surfaces import HARD, SURFACES
from .files import print_json
from .group import console

PRESSURES = (1.0, 2.0, 3.0, 4.0, 6.0)  # bar


def register(app: typer.Typer) -> None:
    app.command()(surfaces)


def surfaces(
    coefficient: Annotated[float, typer.Option(metavar="F", help="What the chair has on a hard floor.")] = HARD,
    mass: Annotated[float, typer.Option(metavar="KG", help="Of chair and user.")] = 80.0,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """How hard a chair rolls on floors of published measurements, and on soft tyres."""
    if not mass > 0:
        raise UsageError(f"a mass of {mass:g} kg is no chair's; give one above 0")
    told: list[dict[str, Any]] = [
        {
            "surface": name,
            "adds": each.adds,
            "factor": each.factor(coefficient),
            "force": each.factor(coefficient) * coefficient * mass * 9.81,
            "what": each.what,
            "source": each.source,
        }
        for name, each in SURFACES.items()
    ]
    soft = {bar: (bar / RATED) ** _exponent() for bar in PRESSURES}
    if as_json:
        print_json({"surfaces": told, "pressure": [{"bar": bar, "factor": value} for bar, value in soft.items()]})
        return
    table = Table(box=box.SIMPLE)
    for title in ("surface", "adds", "floor.rolling_factor", f"N of {mass:g} kg", "what it is", "source"):
        table.add_column(title, no_wrap=title != "what it is")
    for t in told:
        table.add_row(t["surface"], f"{t['adds']:.4f}", f"{t['factor']:.2f}", f"{t['force']:.1f}", t["what"], t["source"])
    console().print(table)
    factors = ", ".join(f"{value:.2f} at {bar:g} bar" for bar, value in soft.items())
    console().print(f"Rear wheels besides, by tyre.pressure: {factors}.")


def _exponent() -> float:
    return next(p.default for p in PARAMETERS if p.name == "tyre.pressure_D")
