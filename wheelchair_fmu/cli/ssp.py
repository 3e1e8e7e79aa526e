"""`wheelchair ssp`: systems of FMUs, a chair with the person who pushes it and the floor under it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich import box
from rich.table import Table

from ..errors import SystemStructureError
from ..fmu import parameter_set
from ..inference.subject import chair as subject_chair
from ..report.course import PLAYED, Course, course_figure, course_frames
from ..report.saving import save, save_film
from ..studies.ssp import sources
from ..studies.ssp.building import build
from ..studies.ssp.checking import check
from ..studies.ssp.recordings import read_recording
from ..studies.ssp.records import MAIN
from ..studies.ssp.running import Trace, run
from ..writing import written
from .files import print_json, write_table
from .group import console
from .settings import catalogue
from .terminal import announce
from .trust import asked, variant_option

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Systems of FMUs by the SSP standard: the chair with a pusher and a floor.",
)
FILE = typer.Argument(metavar="FILE.ssp", help="An archive, as `build` makes it.")
VERSION = typer.Option("--ssp", metavar="1|2", help=f"Version of the standard: {' or '.join(sources.VERSIONS.values())}.")
SHOWN = (
    "Chair.chair.x",
    "Chair.chair.y",
    "Chair.chair.u",
    "Chair.slip.rl",
    "Chair.slip.rr",
    "Pusher.push.F_rl",
    "Pusher.push.F_rr",
    "Pusher.path.deviation",
)
FEW = 8  # results in the table of a system that has none of these


def register(parent: typer.Typer) -> None:
    parent.add_typer(app, name="ssp")


@app.command(name="build")
def build_ssp(
    system: Annotated[str, typer.Argument(metavar="SYSTEM", help=f"{', '.join(sources.systems())}, or a .toml.")] = "slalom",
    version: Annotated[str, VERSION] = "1",
    variant: Annotated[Path | None, variant_option("The chair: laws, effects and values.")] = None,
    parameters: Annotated[
        list[str] | None,
        typer.Option(
            "--parameters",
            metavar="SET",
            help=f"Bind a set: {', '.join(sources.parameter_sets())}, or a .toml; again for more.",
        ),
    ] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    replay: Annotated[Path | None, typer.Option(metavar="CSV", help="The pusher replays this recording.")] = None,
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="FILE.ssp", help="Where to write it.")] = None,
) -> None:
    """Build the archive of a system: three FMUs, connections, parameter sets."""
    recording = read_recording(replay) if replay else None
    for name in parameters or ():
        _asked(name)
    chair = subject_chair(variant, effects) if variant else None
    with console(stderr=True).status("building the FMUs"):
        path = build(system, output, version=version, variant=chair, parameters=parameters or (), recording=recording)
    announce(path)


@app.command(name="run")
def run_ssp(
    file: Annotated[Path, FILE],
    step: Annotated[float | None, typer.Option(help="Communication step [s]; the system's own unless given.")] = None,
    time: Annotated[float | None, typer.Option(help="Stop time [s]; the system's own unless given.")] = None,
    description: Annotated[str, typer.Option(metavar="SSD", help="Which description in the archive.")] = MAIN,
    parameters: Annotated[
        list[str] | None,
        typer.Option(
            "--parameters", metavar="SET", help="A parameter set in the archive, on top of what is bound; again for more."
        ),
    ] = None,
    animation: Annotated[bool, typer.Option("--animation", help="Make a GIF too.")] = False,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the files go.")] = Path("out"),
) -> None:
    """Run a system by fmpy, with its parameter sets applied; a CSV, a figure and a table of results."""
    trace = run(file, step=step, stop=time, description=description, parameters=parameters or ())
    for warning in trace.warnings:
        console(stderr=True).print(f"warning: {warning}")
    for path in _write(trace, output / file.stem.lower(), animation):
        announce(path)
    console().print(_table(trace))


@app.command(name="check")
def check_ssp(
    file: Annotated[Path, FILE], as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False
) -> None:
    """Every fault of an archive at once, with file, line, element and cure."""
    faults = check(file)
    if as_json:
        print_json([vars(fault) for fault in faults])
        if faults:
            raise typer.Exit(1)
    elif faults:
        raise SystemStructureError(faults)
    else:
        announce(f"{file}: no faults")


@app.command()
def parameters(
    source: Annotated[
        str,
        typer.Argument(
            metavar="TOML|SET", help=f"A variant, as `wheelchair add` writes it, or {', '.join(sources.parameter_sets())}."
        ),
    ],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE.ssv", help="Where to write it.")],
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    version: Annotated[str, VERSION] = "1",
) -> None:
    """Write a variant's values as an SSP parameter set, which other tools bind to the FMU."""
    _asked(source)
    found = sources.parameter_set(source, catalogue(effects))[1]
    with written(output) as beside:
        beside.write_bytes(parameter_set.text(found, sources.version(version)))
    announce(output)


def _asked(parameter_set: str) -> None:
    if parameter_set.endswith(".toml"):
        asked(Path(parameter_set))


def _write(trace: Trace, stem: Path, animated: bool) -> list[Path]:
    columns = {"time [s]": trace.time} | {f"{name} [{trace.units[name]}]": c for name, c in trace.columns.items()}
    files = [stem.with_suffix(".csv")]
    write_table(files[0], columns)
    course = _course(trace)
    if course is None:
        return files
    files.append(stem.with_suffix(".png"))
    with written(files[-1]) as beside:
        save(course_figure(course), beside)
    if animated:
        files.append(stem.with_suffix(".gif"))
        with written(files[-1]) as beside:
            save_film(course_frames(course), beside, PLAYED)
    return files


def _course(trace: Trace) -> Course | None:
    """What the figure shows, where the system has a chair and a pusher as those of `build`."""
    names = {
        "x": "Chair.chair.x",
        "y": "Chair.chair.y",
        "psi": "Chair.chair.psi",
        "u": "Chair.chair.u",
        "F_rl": "Pusher.push.F_rl",
        "F_rr": "Pusher.push.F_rr",
    }
    if not set(names.values()) <= set(trace.columns):
        return None
    columns = {key: trace[name] for key, name in names.items()}
    p = trace.parameters
    if p.get("Pusher.pusher.mode") == 2 and "Pusher.path.y" in trace.columns:
        columns["path_y"] = trace["Pusher.path.y"]
    first, apart, count = (p.get(f"Pusher.course.{name}", 0.0) for name in ("first", "spacing", "cones"))
    cones = [(first + i * apart, 0.0) for i in range(int(count))]
    size = {key: p[f"Chair.chair.{key}"] for key in ("a", "b", "t_r", "t_f")}
    return Course(trace.system.description or trace.system.name, trace.time, columns, cones, _patches(p), size)


def _patches(p: Mapping[str, float]) -> list[tuple[float, float, float, float, str]]:
    """The parts of the floor that are not level or not smooth, each with words for it."""
    ramp, cross, carpet = (
        p.get(f"Floor.{name}", off) for name, off in (("ramp.slope", 0.0), ("cross.slope", 0.0), ("carpet.rolling_factor", 1.0))
    )
    words = {
        "ramp": f"ramp, {'falls' if ramp > 0 else 'rises'} {np.degrees(abs(ramp)):.2g}°" if ramp else "",
        "cross": f"falls {np.degrees(abs(cross)):.2g}° to the {'right' if cross > 0 else 'left'}" if cross else "",
        "carpet": f"rolling resistance × {carpet:.3g}" if carpet != 1 else "",
    }
    found = []
    for patch, text in words.items():
        if text:
            x_from, x_to, y_from, y_to = (p[f"Floor.{patch}.{edge}"] for edge in ("x_from", "x_to", "y_from", "y_to"))
            found.append((x_from, x_to, y_from, y_to, text))
    return found


def _table(trace: Trace) -> Table:
    table = Table(box=box.SIMPLE)
    table.add_column("result")
    for title in ("at the end", "least", "greatest"):
        table.add_column(title, justify="right")
    for name in [n for n in SHOWN if n in trace.columns] or list(trace.columns)[:FEW]:
        c = trace[name]
        table.add_row(f"{name} [{trace.units[name]}]", *(f"{v:.4f}" for v in (c[-1], c.min(), c.max())))
    return table
