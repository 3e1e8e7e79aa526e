"""`wheelchair compare`: how far off the model is, in which run, channel and regime."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich import box
from rich.table import Table

from ..campaign import CHANNELS, Campaign
from ..errors import UsageError, unknown
from ..loop.compare import Comparison, RunErrors, errors_of
from ..loop.evidence import START, Bench, Evidence
from ..loop.fit import fit, start_value
from ..loop.statistics import finite
from ..model.variant import Variant
from ..model.wheelchair import REGIMES
from ..report.figures import overlay_figure, where_figure
from ..report.saving import save
from ..studies import Fmu, fmu_of, run_campaign_run
from .files import print_json, written
from .group import console
from .settings import subject

TUNING = 2  # how often the start of each run is moved to where its readings want it


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
    bench = Bench(measured, chair)
    values = dict(chair.values)
    with console(stderr=True).status("simulating"):
        values |= _calibrated(bench, calibrate)
        evidence = bench.evidence(measured.runs, values, (), tune_start=TUNING)
        comparison = Comparison(tuple(_through_fmu(measured, chair, values, evidence)))
    for note in _notes(measured):
        console(stderr=True).print(note)
    if as_json:
        print_json(_content(measured, comparison, values, calibrate))
    else:
        _show(measured, comparison, values, calibrate)
    if output:
        offsets = {channel: values[name] for name, channel in bench.offsets.items()}
        for file in _figures(measured, comparison, evidence, offsets, output):
            print(file)


def _calibrated(bench: Bench, names: str) -> dict[str, float]:
    records = {p.name: p for p in bench.variant.parameters()}
    wanted = [n.strip() for n in names.split(",") if n.strip()]
    for name in wanted:
        if name not in records:
            raise unknown("parameter", name, records)
        if name not in bench.sensitivities.columns:
            raise UsageError(f"{name} cannot be calibrated; choose among {', '.join(bench.sensitivities.columns)}")
    wanted += bench.offsets  # sensors' offsets, where the campaign names them, are nobody's error
    return dict(fit(bench, wanted, {n: start_value(bench, bench.records[n]) for n in wanted}).values) if wanted else {}


def _through_fmu(measured: Campaign, chair: Variant, values: dict[str, float], evidence: Evidence) -> list[RunErrors]:
    """Each run driven through the FMU, from the start that the evidence found."""
    results = [o.name for o in chair.model().outputs]
    found = []
    with Fmu(fmu_of(chair)) as fmu:
        for e in evidence.runs:
            given = {**measured.known, **values, **{n: e.start[n] for n in START}}
            predicted = run_campaign_run(fmu, e.run, {n: v for n, v in given.items() if n in fmu.parameters})
            found.append(errors_of(e, predicted, REGIMES, results))
    return found


def _notes(measured: Campaign) -> list[str]:
    estimated = sorted(c for c in measured.noise_estimated if measured.noise.get(c))
    said = [f"noise of {', '.join(estimated)} is not stated and was estimated from the data"] if estimated else []
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


def _figures(measured: Campaign, c: Comparison, evidence: Evidence, offsets: dict[str, float], folder: Path) -> list[Path]:
    channels = list(dict.fromkeys(ch for r in c.runs for ch in r.channels))
    rms = np.array([[r.rms.get(ch, np.nan) for ch in channels] for r in c.runs])
    figures = {"where": where_figure([r.name for r in c.runs], channels, rms)}
    for r, e in zip(c.runs, evidence.runs, strict=True):
        shown = {ch: r.predicted[:, i] for i, ch in enumerate(r.channels)}
        figures[f"run-{r.name}"] = overlay_figure(r.name, e.run.time, {ch: e.run.channels[ch] for ch in r.channels}, shown,
                                                  {ch: measured.noise[ch] for ch in r.channels},
                                                  units={c.name: c.unit.name for c in CHANNELS}, offsets=offsets)  # fmt: skip
    files = []
    for name, figure in figures.items():
        for ending in (".png", ".svg"):
            with written(folder / f"{name}{ending}") as beside:
                save(figure, beside)
            files.append(folder / f"{name}{ending}")
    return files
