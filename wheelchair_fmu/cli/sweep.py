"""`wheelchair sweep`: many chairs through many manoeuvres into one Parquet file."""

from __future__ import annotations

from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import pandas as pd
import typer
from rich import box
from rich.table import Table

from ..campaign import condensed, read
from ..chunks import bad, is_done
from ..errors import UsageError, unknown
from ..inference.evidence.initial_state import TUNING
from ..inference.evidence.likelihood import Likelihood
from ..inference.search.recordings import taken
from ..inference.subject import known_parameters
from ..studies.sweep import ENGINES, INDICES, Job, Plan, prepare, read_plan
from ..studies.sweep.indices import indices
from ..studies.sweep.plan import variant_files
from ..studies.sweep.yardstick import Yardstick
from ..writing import written
from .chunked import Address, Workers, done_with_a_bar, pool_of
from .group import console
from .terminal import announce
from .trust import asked


def register(app: typer.Typer) -> None:
    app.command("sweep")(run)


def run(
    plan: Annotated[Path, typer.Argument(metavar="PLAN.toml", help="Parameters, manoeuvres, variants.")],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="OUT.parquet", help="Where the table goes.")],
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    engine: Annotated[str, typer.Option(help=f"{' or '.join(ENGINES)}, with the same numbers.")] = "kernel",
    workers: Workers = None,
    address: Address = None,
) -> None:
    """Simulate every chair of a plan. Killed and run again, it goes on where it stood."""
    if engine not in ENGINES:
        raise unknown("engine", engine, ENGINES)
    pool = pool_of(address, workers)
    if output.suffix != ".parquet":
        raise UsageError(f"-o {output}: the table is Parquet; give a name that ends in .parquet")
    for file in variant_files(plan):
        asked(file)
    planned = read_plan(plan, effects)
    _needs_salib(planned)
    job = _job(planned, engine)
    if is_done(job, output):
        console(stderr=True).print(f"{output}: already done by this plan")
    else:
        with console(stderr=True).status("compiling"):
            prepare(job)
    done_with_a_bar(job, output, pool, "runs")
    announce(output)
    _tell_bad(output, planned.runs)
    table = indices(planned, output)
    if table is not None:
        _tell_indices(table, output)


def _tell_bad(output: Path, runs: int) -> None:
    count, first = bad(output)
    if count:
        console(stderr=True).print(f"{count} of {runs} runs gave nothing (see column error), the first: {first}")


def _tell_indices(table: pd.DataFrame, output: Path) -> None:
    file = output.with_name(f"{output.stem}-indices.csv")
    with written(file) as beside:
        table.to_csv(beside, index=False, float_format="%.6g", lineterminator="\n")
    announce(file)
    total = "mu_star" if "mu_star" in table else "ST"
    for (variant, manoeuvre), case in table.dropna(subset=[total]).groupby(["variant", "manoeuvre"], sort=False):
        shown = Table(box=box.SIMPLE, title=f"{variant}, {manoeuvre}: {total}, by parameter", title_justify="left")
        names = list(dict.fromkeys(case.parameter))
        for name in ("quantity", *names):
            shown.add_column(name, justify="left" if name == "quantity" else "right")
        for quantity, rows in case.groupby("quantity", sort=False):
            shown.add_row(str(quantity), *(f"{value:.3g}" for value in rows[total]))
        console().print(shown)


def _needs_salib(plan: Plan) -> None:
    if plan.design.method in INDICES and find_spec("SALib") is None:
        raise UsageError(f"method {plan.design.method} needs SALib; install it with pip install 'wheelchair-fmu[sweep]'")


def _job(plan: Plan, engine: str) -> Job:
    if plan.campaign is None:
        return Job(plan, engine)
    first = plan.chairs[0].variant()
    measured = condensed(read(plan.campaign, known_parameters(first.catalogue, first.choice)))
    plan = replace(plan, chairs=tuple(chair.with_effects(measured.effects) for chair in plan.chairs))
    yardsticks, notes = {}, list[str]()
    with console(stderr=True).status("reading the campaign"):
        for chair in plan.chairs:
            variant = chair.variant()
            recordings = taken(measured, variant)
            notes += recordings.notes
            likelihood = Likelihood(recordings.campaign, variant, recordings.noise_model)
            found = likelihood.evidence(recordings.campaign.runs, variant.values, (), tune_start=TUNING)
            yardsticks[chair.label] = tuple(
                Yardstick(
                    likelihood.on_time(e.run, variant.values, e.start),
                    e.channels,
                    e.error_scale().errors,
                    measured.known,
                    {**e.run.set, **e.started},
                )
                for e in found.runs
            )
    for note in dict.fromkeys(notes):
        console(stderr=True).print(f"note: {note}")
    return Job(plan, engine, yardsticks, measured.name, measured.fingerprint)
