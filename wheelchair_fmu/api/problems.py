"""A campaign as a problem of parameter estimation for other programs, in tables after PEtab 2 (Schmiester et al. 2021).

PEtab has no FMUs and no recorded inputs: the model is an FMU 2.0, and `inputs/` has each run's pushes. What its noise model
cannot say is left out: noise of the recorded pushes, noise that is coloured, and what is uncertain of clocks and push rims.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from .. import campaign as measured
from ..campaign import BY_NAME
from ..fmu.build import build, with_chosen_effects
from ..inference.estimation.problem import Problem
from ..inference.evidence.initial_state import START, prior_start, start_sd
from ..inference.evidence.likelihood import Likelihood
from ..inference.models.factory import CALIBRATED
from ..model.variant import Variant
from ..writing import written
from .frames import framed, save

MODEL = "chair.fmu"
TABLES = ("parameters", "conditions", "experiments", "measurements", "observables", "mapping")


def export(campaign: measured.Campaign, chair: Variant, effects: Sequence[str], folder: Path) -> tuple[Path, ...]:
    """Write the problem of fitting `effects`, with what is calibrated, to the fitted runs; runs held out are in holdout.tsv.

    Offsets of sensors that the campaign leaves open are parameters of what is observed. Raises UsageError for an effect that no
    FMU has.
    """
    chair = with_chosen_effects(chair.with_effects(campaign.effects), effects)
    likelihood = Likelihood(campaign, chair, derives=False)
    tables = {
        "parameters": _parameters(likelihood, effects),
        "conditions": _conditions(campaign),
        "experiments": pd.DataFrame(
            [(_id(r.name), r.time[0], _id(r.name)) for r in campaign.runs], columns=["experimentId", "time", "conditionId"]
        ),
        "measurements": _measurements(campaign.fit),
        "holdout": _measurements([r for r in campaign.runs if r.role == "holdout"]),
        "observables": _observables(likelihood),
        "mapping": _mapping(likelihood),
    }
    files = [build(chair.with_values(_plain(likelihood)), folder / MODEL, effects="none")]
    for name, table in tables.items():
        files.append(folder / f"{name}.tsv")
        with written(files[-1]) as beside:
            table.to_csv(beside, sep="\t", index=False, float_format="%.10g", lineterminator="\n")
    for run in campaign.runs:
        units = {c.fmu: c.unit.name for c in measured.INPUTS}
        files.append(save(framed(run.time, run.inputs, units), folder / "inputs" / f"{_id(run.name)}.csv"))
    with written(folder / "problem.yaml") as beside:
        beside.write_text(_yaml(campaign.runs), encoding="utf-8", newline="\n")
    return (folder / "problem.yaml", *files)


def _id(name: str) -> str:
    """A name as PEtab has identifiers."""
    plain = re.sub(r"\W", "_", name, flags=re.ASCII)
    return f"_{plain}" if plain[:1].isdigit() else plain


def _plain(likelihood: Likelihood) -> dict[str, float]:
    """What the campaign knows of the chair, as start values of the FMU."""
    return {n: v for n, v in likelihood.campaign.known.items() if n in likelihood.records}


def _parameters(likelihood: Likelihood, effects: Iterable[str]) -> pd.DataFrame:
    catalogue = likelihood.variant.catalogue
    names = [*CALIBRATED, *likelihood.offsets, *(p.name for e in effects for p in catalogue[e].owned if p.estimated)]
    problem = Problem(likelihood, names)
    rows = [
        (_id(n), *_bounded(likelihood, n, low, high), mean, mean, sd)
        for n, low, high, mean, sd in zip(
            names, problem.lower, problem.upper, problem.prior.mean, problem.prior.sd, strict=True
        )
    ]
    for run in likelihood.campaign.runs:
        mean, sd = prior_start(run, likelihood.known(run)), start_sd(run)
        records = likelihood.records
        rows += [(_own(n, run), records[n].lower, records[n].upper, mean[n], mean[n], sd[n]) for n in START if sd[n]]
    return pd.DataFrame([_parameter(*row) for row in rows])


def _bounded(likelihood: Likelihood, name: str, low: float, high: float) -> tuple[float, float]:
    """A parameter's bounds; of an offset that has none, what the sensor could at most read."""
    if name not in likelihood.offsets:
        return low, high
    channel = BY_NAME[likelihood.offsets[name]]
    most = max(abs(channel.low), abs(channel.high))
    return max(low, -most), min(high, most)


def _parameter(name: str, low: float, high: float, nominal: float, mean: float, sd: float) -> dict[str, Any]:
    told = {"parameterId": name, "lowerBound": low, "upperBound": high, "nominalValue": nominal, "estimate": "true"}
    if np.isfinite(sd):
        return {**told, "priorDistribution": "normal", "priorParameters": f"{mean:.10g};{sd:.10g}"}
    return {**told, "priorDistribution": "uniform", "priorParameters": f"{low:.10g};{high:.10g}"}


def _own(name: str, run: measured.Run) -> str:
    """A start that is this run's own."""
    return f"{_id(name)}__{_id(run.name)}"


def _conditions(campaign: measured.Campaign) -> pd.DataFrame:
    """What differs from run to run: what it sets, and where it starts."""
    rows: list[tuple[str, str, Any]] = []
    for run in campaign.runs:
        mean, sd = prior_start(run, {**campaign.known, **run.set}), start_sd(run)
        own = {**run.set, **{n: _own(n, run) if sd[n] else mean[n] for n in START}}
        rows += [(_id(run.name), _id(name), value) for name, value in own.items()]
    return pd.DataFrame(rows, columns=["conditionId", "targetId", "targetValue"])


def _measurements(runs: Sequence[measured.Run]) -> pd.DataFrame:
    def rows() -> Iterator[pd.DataFrame]:
        for run in runs:
            for channel, series in run.channels.items():
                there = np.isfinite(series)
                told = {"observableId": channel, "experimentId": _id(run.name), "time": run.time[there]}
                yield pd.DataFrame({**told, "measurement": series[there]})

    return pd.concat(list(rows()) or [pd.DataFrame(columns=["observableId", "experimentId", "time", "measurement"])])


def _observables(likelihood: Likelihood) -> pd.DataFrame:
    campaign, offset = likelihood.campaign, {channel: name for name, channel in likelihood.offsets.items()}
    names = list(dict.fromkeys(c for run in campaign.runs for c in run.channels))
    formulas = [" + ".join([_id(BY_NAME[c].fmu), *([_id(offset[c])] if c in offset else [])]) for c in names]
    rows = [(c, formula, campaign.noise[c], "normal") for c, formula in zip(names, formulas, strict=True)]
    return pd.DataFrame(rows, columns=["observableId", "observableFormula", "noiseFormula", "noiseDistribution"])


def _mapping(likelihood: Likelihood) -> pd.DataFrame:
    """Identifiers of PEtab and the names of the FMU."""
    names = [
        *(n for n in likelihood.records if n not in likelihood.offsets),
        *(o.name for o in likelihood.variant.model().outputs),
    ]
    return pd.DataFrame([(_id(n), n) for n in names], columns=["petabEntityId", "modelEntityId"])


def _yaml(runs: Sequence[measured.Run]) -> str:
    inputs: Mapping[str, str] = {_id(r.name): f"inputs/{_id(r.name)}.csv" for r in runs}
    lines = ["format_version: 2.0.0", "model_files:", "  chair:", f"    location: {MODEL}", "    language: fmu"]
    for name in TABLES:
        key = f"{name.removesuffix('s')}_files"
        lines += [f"{key}:", f"  - {name}.tsv"]
    lines += ["extensions:", "  recorded_inputs:  # by experiment: columns are inputs of the FMU, linear between samples"]
    lines += ["    version: 1.0.0", "    required: true", "    files:", *(f"      {n}: {f}" for n, f in inputs.items())]
    return "\n".join(lines) + "\n"
