"""`wheelchair import`: a campaign from recordings as loggers left them."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..campaign import Judged, judged
from ..campaign.axes import AXES
from ..campaign.document import FILE
from ..campaign.formats import format_of
from ..campaign.importing import (
    BOUNDS,
    RADIUS,
    SIZES,
    Choice,
    Found,
    Plan,
    Wanted,
    aside,
    doubts,
    find,
    held_out,
    needs_radius,
    open_axes,
    still,
    text,
    unsure,
)
from ..campaign.syncing import RunClocks
from ..campaign.syncing import find as find_clocks
from ..errors import UsageError
from ..faults import ERROR, NOTE, Fault
from ..inference.subject import known_parameters
from ..units import same_dimension
from ..writing import written
from .check import MOST, draw
from .files import print_json
from .group import Progress, console, working
from .sync import show

RUNS = "runs"  # the folder of a campaign in which the recordings lie


def register(app: typer.Typer) -> None:
    app.command("import")(import_)


def import_(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...", help="Recordings, or folders of them.")],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="CAMPAIGN", help="The folder to make.")],
    mass: Annotated[float | None, typer.Option(metavar="KG", help="Of chair and rider.")] = None,
    person: Annotated[
        float | None,
        typer.Option(metavar="KG", help="Of the rider alone, where markers are on the body; of what moves as rider.s."),
    ] = None,
    radius: Annotated[float | None, typer.Option(metavar="M", help="Of the rear wheels.")] = None,
    track: Annotated[float | None, typer.Option(metavar="M", help="Of the rear wheels.")] = None,
    wheelbase: Annotated[float | None, typer.Option(metavar="M", help="From the rear axle to the casters' pivots.")] = None,
    cm_ahead: Annotated[
        float | None, typer.Option(metavar="M", help="From the rear axle forward to the centre of mass of chair and rider.")
    ] = None,
    caster_track: Annotated[float | None, typer.Option(metavar="M", help="Of the casters' pivots.")] = None,
    caster_trail: Annotated[
        float | None, typer.Option(metavar="M", help="Of the casters, from the pivot back to where the caster stands.")
    ] = None,
    wheel_inertia: Annotated[
        float | None, typer.Option(metavar="KG_M2", help="Moment of inertia of one rear wheel with its rim about the axle.")
    ] = None,
    axes: Annotated[str, typer.Option(help="SAE-J670 or ISO-8855, where no signal tells.")] = "",
    holdout: Annotated[
        list[str] | None, typer.Option(metavar="RUN", help="A run to keep for checking; else the last fifth.")
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Ask nothing.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace the campaign.toml that is there.")] = False,
    link: Annotated[bool, typer.Option("--link", help="Link to the recordings in place of copying them.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print what was found as JSON.")] = False,
    progress: Progress = False,
) -> None:
    """Find out which file is which run and device, which column is what, and how the clocks stand; write a campaign of it."""
    given = (mass, person, radius, track, wheelbase, cm_ahead, caster_track, caster_trail, wheel_inertia)
    _usable(output, axes, force, dict(zip(SIZES, given, strict=True)))
    with working("reading", lines=progress):
        found = find(files, radius)
    kept = held_out(found.runs, holdout or [])
    wanted = Wanted(output.resolve().name, *given, axes=axes, holdout=kept)
    if _at_terminal() and not yes:
        found = _told(files, radius, found)
        wanted = _asked(wanted, found)
    with working("writing", lines=progress):
        names = _placed(found, output, link)
    wanted = replace(wanted, at_rest=still(found, wanted.radius))
    with working("finding the clocks", lines=progress) as say:
        seen, clocks = _on_one_clock(output, found, names, wanted)
        say("drawing every signal")
        draw(wanted.name, seen.runs, seen.faults, output, told=not progress)
    if as_json:
        print_json(_told_as_data(found, wanted, seen.faults))
        return
    wanted = replace(wanted, clocks={one.run.name: one.sure for one in clocks})
    said = [*show(clocks), *_needing_radius(output, found, wanted)]
    _show(found)
    for line in said:
        console().print(line)
    _conclude(output, found, wanted, seen.faults, link)


def _told_as_data(found: Found, wanted: Wanted, faults: Sequence[Fault]) -> dict[str, Any]:
    """What was found, column by column, what is to be looked at, and all faults, those of files that were left out first."""
    devices = [
        {
            "name": plan.name,
            "place": plan.place,
            "columns": [
                {"channel": c.channel, "column": c.header, "unit": c.unit, "sign": c.sign, "why": c.why, "beside": c.beside}
                for c in plan.choices
            ],
        }
        for plan in found.plans
    ]
    looked_at = [asdict(one) for one in unsure(found.plans, wanted)]
    told = [asdict(fault) for fault in (*found.faults, *faults)]
    return {"runs": list(found.runs), "devices": devices, "unsure": looked_at, "faults": told}


def _usable(output: Path, axes: str, force: bool, sizes: Mapping[str, float | None]) -> None:
    """Raises UsageError for what cannot be meant."""
    if (output / FILE).exists() and not force:
        raise UsageError(f"{output / FILE} is there already and stays as it is; give another folder, or --force to replace it")
    if axes and axes not in AXES:
        raise UsageError(f"no axes {axes!r}; use {' or '.join(AXES)}")
    for name, value in sizes.items():
        least, most = BOUNDS[name]
        if value is not None and not least <= value <= most:
            option = f"--{name.replace('_', '-')}"
            raise UsageError(
                f"{option} {value:g} is no size of a wheelchair ({SIZES[name]}); give one from {least:g} to {most:g}"
            )
    wheelbase, ahead = sizes["wheelbase"], sizes["cm_ahead"]
    if wheelbase is not None and ahead is not None and ahead >= wheelbase:
        raise UsageError(
            f"--cm-ahead {ahead:g} is beyond the casters' pivots, which --wheelbase puts {wheelbase:g} m ahead of the rear "
            "axle; measure both from the axle"
        )


def _at_terminal() -> bool:
    return sys.stdin.isatty()


def _asked(wanted: Wanted, found: Found) -> Wanted:
    """What no signal can tell, from the person at the terminal; an empty answer leaves it open."""
    body = any(plan.body for plan in found.plans)
    asked = {name: words for name, words in SIZES.items() if getattr(wanted, name) is None and (body or name != "person")}
    answers: dict[str, Any] = {
        name: answer for name, words in asked.items() if (answer := _number(words, *BOUNDS[name])) is not None
    }
    axes = wanted.axes
    if not axes and open_axes(found.plans):
        axes = {"right": AXES[0], "left": AXES[1]}.get(
            typer.prompt("no signal tells: does y point to the right or left", "right"), ""
        )
    return replace(wanted, axes=axes, **answers)


def _told(files: Sequence[Path], radius: float | None, found: Found) -> Found:
    """What was found, with the wheels and the units that no file tells from the person at the terminal."""
    on = {plan.name: side for plan in found.plans if plan.sideless and (side := _side(plan.name))}
    if on:
        found = find(files, radius, on)
    for plan in found.plans:
        for choice in [c for c in plan.choices if not c.settled and not c.beside]:
            plan.put(_unit(plan.name, choice))
    return found


def _side(device: str) -> str:
    answer = typer.prompt(
        f"{device}: on which wheel is it, left or right (empty: fill in later)", default="", show_default=False
    )
    return {"left": "l", "l": "l", "right": "r", "r": "r"}.get(answer.strip().lower(), "")


def _unit(device: str, choice: Choice) -> Choice:
    """The choice in a unit of the right dimension; as it is where that is left open."""
    units = (choice.si, "rad/s") if choice.channel.startswith("wheel_speed") else (choice.si,)
    words = f"{device}: the unit of {choice.header!r}, which is {choice.channel} (empty: fill in later)"
    while answer := typer.prompt(words, default="", show_default=False).strip():
        if si := next((one for one in units if same_dimension(answer, one)), ""):
            return replace(choice.because("in the unit that you said"), unit=answer, si=si, settled=True)
        console(stderr=True).print(f"{answer!r} is no unit of it; give one such as {' or '.join(units)}")
    return choice


def _number(words: str, least: float, most: float) -> float | None:
    while True:
        answer = typer.prompt(f"{words} (empty: fill in later)", default="", show_default=False, err=True).strip()
        try:
            if not answer or least <= float(answer.replace(",", ".")) <= most:
                return float(answer.replace(",", ".")) if answer else None
        except ValueError:
            pass  # asked again
        console(stderr=True).print(f"{answer!r} is no such size; give a number from {least:g} to {most:g}")


def _placed(found: Found, output: Path, link: bool) -> dict[str, dict[str, str]]:
    """Puts the recordings into the campaign, but for those that lie in it; their names in campaign.toml by run and device."""
    names: dict[str, dict[str, str]] = {}
    for run, of in found.files.items():
        for device, (path, file) in of.items():
            inside = path.resolve().is_relative_to(output.resolve()) and not path.is_symlink()
            name = path.resolve().relative_to(output.resolve()).as_posix() if inside else f"{RUNS}/{file.replace('/', '_')}"
            names.setdefault(run, {})[device] = name
            if not inside:
                with written(output / name) as beside:
                    if link:
                        os.symlink(path.resolve(), beside)
                    else:
                        shutil.copyfile(path, beside)
    return names


def _on_one_clock(
    output: Path, found: Found, names: Mapping[str, Mapping[str, str]], wanted: Wanted
) -> tuple[Judged, list[RunClocks]]:
    """Writes campaign.toml with the clocks that are sure; the campaign as it is then, and all clocks.

    Where a radius is needed that nobody gave, one stands in for it until all is read, and is not written.
    """

    def write(how: Wanted) -> None:
        with written(output / FILE) as beside:
            beside.write_text(text(found.plans, found.runs, names, how), encoding="utf-8")

    standing_in = _lacks_radius(found, wanted)
    known = replace(wanted, radius=RADIUS) if standing_in else wanted
    write(known)
    seen = judged(output, known_parameters())
    clocks = find_clocks(seen.runs, aside(found))
    sure = {one.run.name: one.sure for one in clocks if one.sure}
    write(replace(known, clocks=sure))
    if sure:
        seen = judged(output, known_parameters())
    noise = {} if seen.campaign is None or standing_in else {c: seen.campaign.noise[c] for c in seen.campaign.noise_estimated}
    write(replace(wanted, clocks=sure, noise=noise))
    return seen, clocks


def _lacks_radius(found: Found, wanted: Wanted) -> bool:
    return wanted.radius is None and needs_radius(found.plans)


def _needing_radius(output: Path, found: Found, wanted: Wanted) -> list[str]:
    """A sentence where the wheels' radius is missing."""
    if not _lacks_radius(found, wanted):
        return []
    return [
        "the wheels' radius is missing, by which angles, angular speeds and torques of wheels become m/s and N: write "
        f"[wheel] R in {output / FILE} before you go on (the preview is drawn with {RADIUS:g} m)"
    ]


def _show(found: Found) -> None:
    """A line for each column: what it became, and why."""
    table = Table(box=box.SIMPLE)
    for title in ("device", "files", "format", "channel", "column"):
        table.add_column(title, no_wrap=title != "column")
    table.add_column("what told it")
    for plan in found.plans:
        of = list(plan.source.files.values())
        first = (plan.name, str(len(of)), format_of(of[0].path))
        for row in _rows(plan):
            table.add_row(*first, *row)
            first = ("", "", "")
    console().print(table)


def _rows(plan: Plan) -> list[tuple[str, str, str]]:
    rows = [
        (c.channel if not c.beside else f"({c.channel})", _column(c), f"{c.beside} measures it too" if c.beside else c.why)
        for c in plan.choices
    ]
    if plan.markers:
        rows.append(("x, y, yaw", " and ".join(plan.markers.values()), plan.why_axes))
    if plan.body:
        rows.append(("rider.s", ", ".join(plan.body.values()), "markers on the rider's body, by their names"))
    return rows or [("", "", "see below" if plan.doubts else "no column is known by its name")]


def _column(choice: Choice) -> str:
    turned = "−" if choice.sign < 0 else ""
    return f"{turned}{choice.header}" + (f" in {choice.unit}" if choice.unit and choice.unit != "?" else "")


def _conclude(output: Path, found: Found, wanted: Wanted, faults: Sequence[Fault], link: bool) -> None:
    out = console()
    errors = [fault for fault in faults if fault.severity == ERROR]
    warnings = sorted((fault for fault in faults if fault.severity != ERROR), key=lambda fault: fault.severity == NOTE)
    for fault in (*found.faults, *errors, *warnings[:MOST]):
        out.print(str(fault))
    if len(warnings) > MOST:
        out.print(f"and {len(warnings) - MOST} more warnings; see `wheelchair check {output}`")
    for doubt in (doubt for plan in found.plans for doubt in doubts(plan, wanted)):
        out.print(f"look at this: {doubt}")
    how = "linked to" if link else "copied into"
    out.print(
        f"runs: {len(found.runs)}; devices: {len(found.plans)}; recordings are {how} {output / RUNS}"
        + (f"; kept for checking: {', '.join(wanted.holdout)}" if wanted.holdout else "")
    )
    unknown = any(not choice.settled and not choice.beside for plan in found.plans for choice in plan.choices)
    left = "fill in what is open in" if errors or unknown or None in (wanted.mass, wanted.radius) else "read"
    out.print(f"next: {left} {output / FILE} and look at {output / 'preview.html'}, then")
    sync = f"    wheelchair sync {output}\n" if _clocks_unsure(found, wanted) else ""
    out.print(f"{sync}    wheelchair check {output}\n    wheelchair diagnose {output}")


def _clocks_unsure(found: Found, wanted: Wanted) -> bool:
    known = wanted.clocks or {}
    return any(device not in known.get(run, {}) for run in found.runs for device in list(found.files[run])[1:])
