"""`wheelchair steady`: how the chair turns: its gradients after ISO 4138, the limits of its turns, its eigenvalues."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite, radians
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich import box
from rich.table import Table

from ..api.linear import steady_chair, turn
from ..handling.linearize import Linear
from ..handling.steady import HEIGHT, Gradients, Turns, gradients, limits, root_locus, turns
from ..handling.trim import Chair, SteadyState
from ..report.saving import save
from ..report.turning import turning_figure
from ..writing import written
from .files import print_json, write_table
from .group import console
from .settings import parse
from .terminal import announce
from .trust import variant_option

SPEEDS = (0.5, 1.0, 1.5, 2.0)  # times the speed asked for
LOCUS = (0.25, 4.0, 200)  # from and to, times the speed asked for, and how many
EARTH = 9.80665

Columns = dict[str, np.ndarray]


def register(app: typer.Typer) -> None:
    app.command()(steady)


def steady(
    speed: Annotated[float, typer.Option(help="Forward speed u [m/s].")] = 1.0,
    delta_force: Annotated[float | None, typer.Option(help="ΔF [N], F_rl − F_rr = 2ΔF, > 0 to the right; else 10.")] = None,
    radius: Annotated[float | None, typer.Option(help="R_c [m] instead of ΔF: > 0 to the right.")] = None,
    slip_limit: Annotated[float, typer.Option(min=0.001, max=90.0, help="Slip angle [deg] that a turn must not exceed.")] = 1.0,
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, variant_option("Laws, effects and values.")] = None,
    effects: Annotated[str | None, typer.Option(metavar="IDS", help="default, all, none, ids, or a folder.")] = None,
    equations: Annotated[str | None, typer.Option(metavar="KIND", help="extended, or paper: to the letter.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the files go.")] = Path("out"),
) -> None:
    """Understeer or oversteer, the largest turn before slip, friction or lift, and eigenvalues against speed."""
    chair = steady_chair(parse(settings or ()), variant, effects or "default", equations)
    state = turn(chair, speed, delta_force, radius)
    found = gradients(state)
    right = state.delta_force > 0
    bounds = limits(chair, radians(slip_limit))
    ends = {b.name: turns(chair, speed, [b], right) for b in bounds}
    curves = {factor * speed: turns(chair, factor * speed, bounds, right) for factor in SPEEDS}
    locus = _locus(chair, state)
    files = _write(state, curves, locus, slip_limit, output)
    if as_json:
        print_json(_record(state, found, ends, locus))
        return
    for file in files:
        announce(file)
    _show(state, found, ends, locus)


def _locus(chair: Chair, state: SteadyState) -> list[Linear]:
    """From the fastest down, for slow chairs take no strong turn."""
    low, high, count = LOCUS
    return root_locus(chair, state.speed * np.linspace(high, low, count), state.delta_force)


def _columns(found: Turns) -> Columns:
    """Steady turns as columns (n,), all positive, with slip in degrees."""
    names = {
        "delta_force": lambda s: abs(s.delta_force),
        "radius": lambda s: abs(s.radius),
        "a_y": lambda s: abs(s.speed * s.psi_dot),
        "slip": lambda s: np.degrees(max(abs(s.results["slip.rl"]), abs(s.results["slip.rr"]))),
    }
    return {name: np.array([of(s) for s in found.states]) for name, of in names.items()}


def _write(state: SteadyState, curves: Mapping[float, Turns], locus: list[Linear], slip: float, folder: Path) -> list[Path]:
    """Turns and eigenvalues as CSV, and the figure."""
    columns = {speed: _columns(found) for speed, found in curves.items()}
    parts = [
        {
            "speed [m/s]": np.full(len(c["radius"]), speed),
            "delta_force [N]": c["delta_force"],
            "radius [m]": c["radius"],
            "a_y [m/s2]": c["a_y"],
            "slip [deg]": c["slip"],
        }
        for speed, c in columns.items()
    ]
    tables = {"steady-turns.csv": {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}}
    speeds = np.array([one.trim.speed for one in locus])
    values = np.array([one.eigenvalues for one in locus])
    parts_of = [(k, part) for k in range(values.shape[1]) for part in ("real", "imag")]
    tables["eigenvalues.csv"] = {"speed [m/s]": speeds} | {
        f"{part}_{k + 1} [1/s]": getattr(values[:, k], part) for k, part in parts_of
    }
    for name, table in tables.items():
        write_table(folder / name, table)
    title = f"steady turns; eigenvalues at ΔF = {state.delta_force:.4g} N"
    figure = turning_figure(title, columns, {"speed": speeds, "eigenvalues": values}, slip)
    files = [folder / name for name in (*tables, "steady.png", "steady.svg")]
    for file in files[2:]:
        with written(file) as beside:
            save(figure, beside)
    return files


def _record(state: SteadyState, found: Gradients, ends: Mapping[str, Turns], locus: list[Linear]) -> dict[str, Any]:
    """Everything as plain data, SI units."""
    return {
        "trim": _turn(state),
        "gradients": {
            "at_radius": found.at_radius,
            "at_speed": found.at_speed,
            "of_force": found.of_force,
            "of_radius": found.of_radius,
        },
        "character": found.character,
        "limits": {
            name: {"reached": end.limit is not None, "why": end.limit.meaning if end.limit else end.why, **_turn(end.last)}
            for name, end in ends.items()
        },
        "root_locus": [
            {"speed": one.trim.speed, "eigenvalues": [[z.real, z.imag] for z in one.eigenvalues.tolist()]} for one in locus
        ],
    }


def _turn(state: SteadyState) -> dict[str, float | None]:
    return {
        "speed": state.speed,
        "delta_force": state.delta_force,
        "a_y": state.speed * state.psi_dot,
        "radius": state.radius if isfinite(state.radius) else None,
        "slip_rl": state.results["slip.rl"],
        "slip_rr": state.results["slip.rr"],
    }


def _show(state: SteadyState, found: Gradients, ends: Mapping[str, Turns], locus: list[Linear]) -> None:
    out = console()
    out.print(f"\nu = {state.speed:g} m/s, ΔF = {state.delta_force:.4g} N, R_c = {state.radius:.4g} m: {found.character}")
    out.print(f"  on this circle 1 % more speed takes {found.of_force:+.3g} % of ΔF, {found.at_radius:.4g} N s²/m of a_y")
    out.print(f"  at this speed a tighter turn takes {found.at_speed:.4g} N s²/m of a_y")
    out.print(f"  under this ΔF 1 % more speed moves R_c by {found.of_radius:+.3g} %\n")
    table = Table(box=box.SIMPLE, title=f"the largest turns at {state.speed:g} m/s", title_justify="left")
    table.add_column("before")
    for title in ("ΔF [N]", "R_c [m]", "a_y [g]", "λ_rl [deg]", "λ_rr [deg]"):
        table.add_column(title, justify="right")
    for end in ends.values():
        last = end.last
        slips = (f"{np.degrees(last.results[f'slip.{side}']):.3f}" for side in ("rl", "rr"))
        table.add_row(
            end.limit.meaning if end.limit else f"(not reached: {end.why})",
            f"{last.delta_force:.4g}",
            f"{last.radius:.4g}",
            f"{last.speed * last.psi_dot / EARTH:.3f}",
            *slips,
        )
    out.print(table)
    if "lift" not in ends:
        out.print(f"no wheel can lift: the CM's height is 0; give it by --set {HEIGHT}=0.6")
    out.print(_stability(locus))


def _stability(locus: list[Linear]) -> str:
    fast, slow = locus[0].trim.speed, locus[-1].trim.speed
    grows = [one.trim.speed for one in locus if one.eigenvalues.real.max() > 0]
    said = (
        f"no motion grows from {slow:.3g} to {fast:.3g} m/s"
        if not grows
        else (
            f"a motion grows at {len(grows)} of {len(locus)} speeds from {slow:.3g} to {fast:.3g} m/s, "
            f"from {min(grows, key=abs):.3g} m/s on"
        )
    )
    return said if len(locus) == LOCUS[2] else f"{said}; at slower ones there is no such turn"
