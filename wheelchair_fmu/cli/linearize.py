"""`wheelchair linearize`: a steady turn, its A, B, C, D, its modes, and what each parameter does to its radius."""

from __future__ import annotations

from math import inf, isfinite, pi
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich import box
from rich.table import Table
from scipy.io import savemat

from ..api.linear import steady_chair, turn
from ..handling.linearize import Linear, linearize, radius_sensitivities, radius_slopes
from ..handling.trim import SteadyState
from ..quantities import ONE
from ..writing import written
from .files import print_json
from .group import console
from .settings import parse
from .terminal import announce
from .trust import variant_option

LEAST = 0.0005  # %; less is not shown


def register(app: typer.Typer) -> None:
    app.command(name="linearize")(linearize_command)


def linearize_command(
    speed: Annotated[float, typer.Option(help="Forward speed u [m/s].")] = 1.0,
    delta_force: Annotated[float | None, typer.Option(help="ΔF [N], F_rl − F_rr = 2ΔF, > 0 to the right; else 10.")] = None,
    radius: Annotated[float | None, typer.Option(help="R_c [m] instead of ΔF: > 0 to the right, inf straight on.")] = None,
    free_speed: Annotated[bool, typer.Option("--free-speed", help="u is a state, by (20), not prescribed.")] = False,
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, variant_option("Laws, effects and values.")] = None,
    effects: Annotated[str | None, typer.Option(metavar="IDS", help="default, all, none, ids, or a folder.")] = None,
    equations: Annotated[str | None, typer.Option(metavar="KIND", help="extended, or paper: to the letter.")] = None,
    mat: Annotated[Path | None, typer.Option(metavar="FILE", help="Write A, B, C, D and the names as a .mat file.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Find a steady turn and linearise the chair about it, exactly."""
    given = parse(settings or ())
    state = turn(steady_chair(given, variant, effects or "default", equations), speed, delta_force, radius)
    linear = linearize(state, free_speed=free_speed)
    if mat:
        with written(mat) as beside:
            savemat(beside, linear.matrices(), appendmat=False, oned_as="column")
    if as_json:
        print_json(record(linear))
        return
    _show(linear)
    if mat:
        announce(mat)


def record(linear: Linear) -> dict[str, Any]:
    """A linear model as plain data, SI units."""
    state, results = linear.trim, linear.trim.results
    slopes = radius_slopes(state)
    values, shapes = linear.modes
    return {
        "trim": {
            "speed": state.speed,
            "delta_force": state.delta_force,
            "v": state.v,
            "psi_dot": state.psi_dot,
            "radius": state.radius if isfinite(state.radius) else None,
            "slip_rl": results["slip.rl"],
            "slip_rr": results["slip.rr"],
            "total_force": results["push.total_needed"],
        },
        "states": linear.states,
        "inputs": linear.inputs,
        "outputs": linear.outputs,
        "A": linear.A.tolist(),
        "B": linear.B.tolist(),
        "C": linear.C.tolist(),
        "D": linear.D.tolist(),
        "eigenvalues": [[z.real, z.imag] for z in values.tolist()],
        "modes": [{n: [z.real, z.imag] for n, z in zip(linear.states, shape, strict=True)} for shape in shapes.T.tolist()],
        "radius_sensitivity": radius_sensitivities(state, slopes),
        "radius_slope": slopes,
    }


def _show(linear: Linear) -> None:
    out, state = console(), linear.trim
    out.print(
        f"u = {state.speed:g} m/s, ΔF = {state.delta_force:.6g} N, needed: F_rl + F_rr = "
        f"{state.results['push.total_needed']:.6g} N"
    )
    way = f"R_c = {state.radius:.6g} m" if isfinite(state.radius) else "straight on"
    slips = ", ".join(f"λ_{side} = {state.results[f'slip.{side}'] * 180 / pi:.4f}°" for side in ("rl", "rr"))
    out.print(f"{way}, ψ' = {state.psi_dot:.6g} rad/s, v = {state.v:.6g} m/s, {slips}\n")
    out.print(_matrix("A: what each rate (row) takes from each state", linear.A, linear.states, linear.states))
    out.print(_matrix("B, turned: what each input (row) gives to each rate", linear.B.T, linear.inputs, linear.states))
    out.print(_modes(linear))
    out.print(_sensitivities(state))


def _matrix(title: str, matrix: np.ndarray, rows: tuple[str, ...], columns: tuple[str, ...]) -> Table:
    """The rows that are not all zero."""
    table = Table(box=box.SIMPLE, title=title, title_justify="left")
    table.add_column("")
    for name in columns:
        table.add_column(_short(name), justify="right")
    for name, row in zip(rows, matrix, strict=True):
        if row.any():
            table.add_row(_short(name), *(f"{entry:.5g}" for entry in row))
    return table


def _short(name: str) -> str:
    """An effect's state without the effect's id."""
    return ".".join(name.split(".")[2:]) if name.startswith("effect.") else name


def _modes(linear: Linear) -> Table:
    table = Table(box=box.SIMPLE, title="modes", title_justify="left")
    for title in ("eigenvalue [1/s]", "time constant [s]", "frequency [Hz]", "damping"):
        table.add_column(title, justify="right")
    table.add_column("most of it")
    values, shapes = linear.modes
    for z, shape in zip(values, shapes.T, strict=True):
        if z.imag < 0:
            continue
        swings = z.imag > 0
        constant = -1 / z.real if z.real else inf
        table.add_row(
            f"{z:.5g}" if swings else f"{z.real:.5g}",
            f"{constant:.4g}" if constant > 0 else "grows",
            f"{z.imag / (2 * pi):.4g}" if swings else "",
            f"{-z.real / abs(z):.3f}" if swings else "",
            _short(linear.states[int(np.abs(shape).argmax())]),
        )
    return table


def _sensitivities(state: SteadyState) -> Table | str:
    """What moves the radius, the strongest first: 1 % of a parameter, or an effect at its smallest interesting size."""
    if state.straight:
        return "straight on: no radius for a parameter to move"
    slopes = radius_slopes(state)
    relative = radius_sensitivities(state, slopes)
    moves = {}
    for p in state.chair.model.parameters:
        size = p.smallest_interesting
        if relative.get(p.name):
            moves[f"{p.name} + 1 %"] = relative[p.name]
        elif size and slopes.get(p.name):
            moves[f"{p.name} = {size:g} {'' if p.unit == ONE else p.unit.name}"] = 100 * slopes[p.name] * size
    table = Table(box=box.SIMPLE, title="what moves the radius, by its slope", title_justify="left")
    table.add_column("change")
    table.add_column("R_c moves [%]", justify="right")
    for change, move in sorted(moves.items(), key=lambda item: -abs(item[1])):
        if abs(move) >= LEAST:
            table.add_row(change, f"{move:+.3f}")
    return table
