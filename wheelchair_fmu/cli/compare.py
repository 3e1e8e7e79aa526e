"""`wheelchair compare`: how far off the model is, in which run, channel and regime."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import chain, islice
from os import cpu_count
from pathlib import Path
from typing import Annotated, Any, TypeVar

import numpy as np
import typer
from rich import box
from rich.table import Table

from ..campaign import CHANNELS, Campaign, pieces, windows
from ..errors import UsageError, unknown
from ..loop.compare import Comparison, RunErrors, errors_of, together
from ..loop.evidence import Bench
from ..loop.fit import fit, start_value
from ..loop.statistics import finite
from ..model.variant import Variant
from ..model.wheelchair import REGIMES
from ..report.figures import overlay_figure, where_figure
from ..report.saving import save
from ..studies import Fmu, fmu_of
from ..studies.measured import run_campaign_run
from ..writing import written
from .files import print_json
from .group import console, working
from .settings import subject
from .terminal import announce

TUNING = 2  # how often the start of each run is moved to where its readings want it
PIECE = 60.0  # s: a longer run is compared piece by piece
AT_ONCE = cpu_count() or 1  # pieces whose filters are made together, while those before them go through the FMU

Item = TypeVar("Item")


def register(app: typer.Typer) -> None:
    app.command()(compare)


def compare(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, typer.Option(metavar="TOML", help="Laws, effects and values.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    calibrate: Annotated[str, typer.Option(metavar="NAMES", help="Parameters to fit first, with commas.")] = "",
    as_json: Annotated[bool, typer.Option("--json", help="Print the errors as JSON.")] = False,
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="DIR", help="Where figures go.")] = None,
) -> None:
    """Simulate every run through the FMU by fmpy, and give the whitened RMS error: 1.0 is the noise floor."""
    chair, measured, _ = subject(campaign, variant, effects, settings)
    chair = chair.with_effects(measured.effects)  # for the FMU to have
    with working("simulating") as say:
        values = {**chair.values, **_calibrated(measured, chair, calibrate)}
        comparison = Comparison(tuple(r if output else r.brief() for r in _through_fmu(measured, chair, values, say)))
    for note in _notes(measured):
        console(stderr=True).print(note)
    if as_json:
        print_json(_content(measured, comparison, values, calibrate))
    else:
        _show(measured, comparison, values, calibrate)
    if output:
        offsets = {c: values[f"offset.{c}"] for c in measured.nuisance if f"offset.{c}" in values}
        for file in _figures(measured, comparison, offsets, output):
            announce(file)


def _calibrated(measured: Campaign, chair: Variant, names: str) -> dict[str, float]:
    """Fitted values of these parameters and of sensors' offsets, from windows of the campaign where it is large."""
    if not names and not measured.nuisance:
        return {}
    bench = Bench(windows(measured), chair)
    records = {p.name: p for p in bench.variant.parameters()}
    wanted = [n.strip() for n in names.split(",") if n.strip()]
    for name in wanted:
        if name not in records:
            raise unknown("parameter", name, records)
        if name not in bench.sensitivities.columns:
            raise UsageError(f"{name} cannot be calibrated; choose among {', '.join(bench.sensitivities.columns)}")
    wanted += bench.offsets  # sensors' offsets, where the campaign names them, are nobody's error
    return dict(fit(bench, wanted, {n: start_value(bench, bench.records[n]) for n in wanted}).values) if wanted else {}


def _through_fmu(
    measured: Campaign, chair: Variant, values: dict[str, float], say: Callable[[str], None]
) -> Iterator[RunErrors]:
    """Each run driven through the FMU, a long one piece by piece, from the starts that its evidence finds."""
    cut = {run.name: pieces(run, PIECE) for run in measured.runs}
    bench = Bench(replace(measured, runs=tuple(piece for run in cut.values() for piece in run)), chair)
    results = [o.name for o in chair.model().outputs]
    batches = (parts[i : i + AT_ONCE] for parts in cut.values() for i in range(0, len(parts), AT_ONCE))
    batch_by_batch = _ahead(bench.evidence(batch, values, (), tune_start=TUNING).runs for batch in batches)
    evidence = chain.from_iterable(batch_by_batch)
    with Fmu(fmu_of(chair)) as fmu:
        for name, parts in cut.items():
            say(f"simulating {name}")
            found = []
            for e in islice(evidence, len(parts)):
                given = {**measured.known, **values, **e.started}
                given = {n: v for n, v in given.items() if n in fmu.parameters}
                predicted = run_campaign_run(fmu, bench.on_time(e.run, values, e.start), given)
                found.append(errors_of(e, predicted, REGIMES, results))
            yield together(name, found)


def _ahead(items: Iterable[Item]) -> Iterator[Item]:
    """The same items, each made while the one before it is used."""
    with ThreadPoolExecutor(1) as beside:
        making = beside.submit(next, iterator := iter(items), None)
        while (item := making.result()) is not None:
            making = beside.submit(next, iterator, None)
            yield item


def _notes(measured: Campaign) -> list[str]:
    estimated = sorted(c for c in measured.noise_estimated if measured.noise.get(c))
    said = [f"noise of {', '.join(estimated)} is not stated and was estimated from the data"] if estimated else []
    if any(len(pieces(run, PIECE)) > 1 for run in measured.runs):
        said.append(f"runs of {2 * PIECE:g} s and more are compared in pieces of {PIECE:g} s, each from a start of its own")
    return [*said, "each run's start is estimated about what the file says (speed ± 0.02 m/s)"]


def _content(measured: Campaign, c: Comparison, values: dict[str, float], calibrate: str) -> dict[str, Any]:
    return {
        "campaign": measured.name,
        "rms": {"fit": finite(c.rms("fit")), "holdout": finite(c.rms("holdout"))},
        "runs": [{"run": r.name, "role": r.role, "rms": r.rms} for r in c.runs],
        "excess": {n: [{"from": a, "to": b, "share": s} for a, b, s in c.excess_by(n)] for n in c.runs[0].regime},
        "values": values,
        "calibrated": [n for n in calibrate.split(",") if n],
    }


def _show(measured: Campaign, c: Comparison, values: dict[str, float], calibrate: str) -> None:
    out = console()
    for name in (n.strip() for n in calibrate.split(",") if n.strip()):
        out.print(f"calibrated: {name} = {values[name]:.6g}")
    channels = list(dict.fromkeys(ch for r in c.runs for ch in r.channels))
    table = Table(box=box.SIMPLE, title=f"{measured.name}: whitened RMS error, 1.0 is the noise floor", title_justify="left")
    table.add_column("run", no_wrap=True)
    table.add_column("role", no_wrap=True)
    for channel in channels:
        table.add_column(channel.replace("wheel_speed", "wheel"), justify="right", no_wrap=True)
    for r in c.runs:
        table.add_row(r.name, r.role, *(f"{r.rms[ch]:.2f}" if ch in r.rms else "" for ch in channels))
    out.print(table)
    for role in ("fit", "holdout"):
        if np.isfinite(c.rms(role)):
            out.print(f"{'fitted' if role == 'fit' else 'held-out'} runs together: {c.rms(role):.3f}")
    run, channel, value = c.worst()
    out.print(f"largest: {channel} in {run}, {value:.2f}")
    for name in c.runs[0].regime:
        bins = c.excess_by(name)
        if bins:
            a, b, share = max(bins, key=lambda row: row[2])
            out.print(f"by {name}: {share:4.0%} of the excess lies between {a:.3g} and {b:.3g} (a quarter of the samples)")


def _figures(measured: Campaign, c: Comparison, offsets: dict[str, float], folder: Path) -> list[Path]:
    channels = list(dict.fromkeys(ch for r in c.runs for ch in r.channels))
    rms = np.array([[r.rms.get(ch, np.nan) for ch in channels] for r in c.runs])
    figures = {"where": where_figure([r.name for r in c.runs], channels, rms)}
    for r, run in zip(c.runs, measured.runs, strict=True):
        shown = {ch: r.predicted[:, i] for i, ch in enumerate(r.channels)}
        figures[f"run-{r.name}"] = overlay_figure(
            r.name,
            run.time,
            {ch: run.channels[ch] for ch in r.channels},
            shown,
            {ch: measured.noise[ch] for ch in r.channels},
            units={c.name: c.unit.name for c in CHANNELS},
            offsets=offsets,
        )
    files = []
    for name, figure in figures.items():
        for ending in (".png", ".svg"):
            with written(folder / f"{name}{ending}") as beside:
                save(figure, beside)
            files.append(folder / f"{name}{ending}")
    return files
