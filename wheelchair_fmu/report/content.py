"""What the page knows: measurements, the model as WebAssembly, the diagnosis and the models it went through."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any

from ..campaign import CHANNELS, Campaign, Run
from ..campaign.channels import PUSHES
from ..campaign.recorded import PUSHES_CLOCK
from ..engine.tangent import differentiable, sensed
from ..engine.wasm import modules
from ..loop.factory import ModelFactory
from ..loop.landscape import landscape
from ..loop.likelihood import CASTERS, SETTLED, START, TOLERANCE, NoiseModel, driven, prior_start, start_sd, starts_of
from ..loop.statistics import finite
from ..loop.timing import Late, retimed
from ..loop.verdict import FORCES as UNRECORDED
from ..model.stage import Effect
from ..model.variant import Variant
from ..model.wheelchair import REGIMES
from ..quantities import N, Parameter, Unit

STARTS = (*START, *CASTERS)  # of which a model has those of its own states
TUNING = 2  # how often a run's start is moved to where its readings want it, as in `wheelchair compare`
PATH = ("chair.x", "chair.y", "chair.psi", "caster.fl", "caster.fr")
FORCES = ("chair.u", "chair.psi_dot", "force.F_srl", "force.F_srr")


def content(
    campaign: Campaign, variant: Variant, colour: NoiseModel, diagnosis: Mapping[str, Any], fixed: Sequence[str] = ()
) -> dict[str, Any]:
    """Everything that `page.html` shows, as JSON; series are numbers under the key "f64", null in gaps.

    `diagnosis` is what `loop.story` tells; `fixed` are parameters that the diagnosis did not estimate.
    """
    campaign = replace(campaign, runs=tuple(in_time(r, diagnosis.get("sync", {})) for r in campaign.runs))
    factory = ModelFactory(campaign, variant, fixed)
    factory.noise_model = colour
    variants = [variant.with_effects(ids) for ids in layers(factory, campaign.effects, diagnosis["effects"])]
    compiled = modules([(v.choice, v.active()) for v in variants], STARTS, driven(campaign))
    measured = {name for r in campaign.runs for name in r.channels}
    return {
        "name": campaign.name,
        "diagnosis": diagnosis,
        "landscape": _landscape(factory, diagnosis),
        "runs": [_run(r, campaign) for r in campaign.runs],
        "channels": [_quantity(c.name, c.unit, c.meaning) for c in CHANNELS if c.name in measured],
        "outputs": {c.name: c.fmu for c in CHANNELS},
        "drifting": [c.name for c in CHANNELS if c.drifts],
        "pushed": list(PUSHES),
        "noise": asdict(colour),
        "known": {**factory.variant.values, **campaign.known},
        "models": [_model(v, wasm) for v, wasm in zip(variants, compiled, strict=True)],
        "effects": [_effect(e) for e in factory.catalogue.values()],
        "calibrated": [_parameter(p) for p in variant.parameters() if p.name in diagnosis["calibrated"]],
        "regimes": _regimes(variant),
        "shown": list(dict.fromkeys((*PATH, *FORCES, *REGIMES.values()))),
        "geometry": _geometry(campaign, variant),
        "tuning": TUNING,
        "settled": SETTLED,
        "tolerance": TOLERANCE,
    }


def _landscape(factory: ModelFactory, diagnosis: Mapping[str, Any]) -> dict[str, Any]:
    """See `landscape`; none of what was found beside forces that nobody recorded, of which a plain simulation knows nothing."""
    led = any(step["step"] == UNRECORDED for step in diagnosis["ladder"])
    return {"profiles": [], "pair": None} if led else landscape(factory, diagnosis)


def in_time(run: Run, sync: Mapping[str, Any]) -> Run:
    """The run with its pushes at the time that the diagnosis read them at, where the campaign has them at another."""
    late = sync.get(run.name, {}).get(PUSHES_CLOCK)
    return run if late is None or run.clocks else retimed(run, Late(late["offset"], 0.0))


def layers(w: ModelFactory, given: Sequence[str], found: Sequence[str]) -> list[tuple[str, ...]]:
    """Effects of each model the page carries, the lightest first: what brings no state and what the campaign has `given` a
    size, that and what was `found`, what brings states, what needs other laws."""
    seldom = (*w.heavy, *w.demanding)
    more = (given, (*given, *found), (*given, *w.heavy), seldom)
    return list(dict.fromkeys((*w.light, *(e for e in seldom if e in some)) for some in more))


def _model(variant: Variant, wasm: bytes) -> dict[str, Any]:
    model = variant.model()
    vector = variant.vector()
    return {
        "effects": list(variant.effects),
        "wasm": b64encode(wasm).decode(),
        "parameters": [[p.name, float(v)] for p, v in zip(model.parameters, vector, strict=True)],
        "inputs": [[i.name, i.start] for i in model.inputs],
        "outputs": [o.name for o in model.outputs],
        "states": model.x.numel(),
        "sensors": [model.outputs[i].name for i in sensed(model)],
        "columns": [p.name for p in differentiable(model, STARTS)],
        "starts": starts_of(p.name for p in model.parameters),
        "delays": [p.name for e in model.effects if e.delays_record for p in e.owned],
    }


def _run(run: Run, campaign: Campaign) -> dict[str, Any]:
    return {
        "name": run.name,
        "role": run.role,
        "manoeuvre": run.manoeuvre,
        "set": run.set,
        "time": _series(run.time),
        "inputs": {name: _series(v) for name, v in run.inputs.items()},
        "channels": {c.name: _series(run.channels[c.name]) for c in CHANNELS if c.name in run.channels},
        "start": prior_start(run, {**campaign.known, **run.set}, STARTS),
        "start_sd": start_sd(run, STARTS),
    }


def _effect(effect: Effect) -> dict[str, Any]:
    return {"id": effect.id, "title": effect.title, "parameters": [_parameter(p) for p in effect.owned if p.estimated]}


def _parameter(p: Parameter) -> dict[str, Any]:
    return {
        **_quantity(p.name, p.unit, p.meaning),
        "lower": finite(p.lower),
        "upper": finite(p.upper),
        "default": p.default,
        "delta": p.smallest_interesting,
        "source": p.source,
    }


def _quantity(name: str, unit: Unit, meaning: str) -> dict[str, Any]:
    shown = [{"unit": d.name, "factor": d.factor} for d in unit.display if d.name.startswith("deg")]
    return {"name": name, "unit": unit.name, "meaning": meaning, "display": shown}


def _regimes(variant: Variant) -> list[dict[str, Any]]:
    """What errors are sorted by: a result, or the total push."""
    outputs = {o.name: o for o in variant.model().outputs}
    sorted_by = [{**_quantity(name, outputs[o].unit, outputs[o].meaning), "output": o} for name, o in REGIMES.items()]
    return [*sorted_by, {**_quantity("push", N, "total push"), "output": None}]


def _geometry(campaign: Campaign, variant: Variant) -> dict[str, float]:
    """Where the wheels are, for drawing the chair."""
    values = {p.name: p.default for p in variant.parameters()} | dict(variant.values) | campaign.known
    return {
        n.rpartition(".")[2]: values[n]
        for n in ("chair.a", "chair.b", "chair.t_r", "chair.t_f", "chair.m", "chair.I_z", "wheel.R")
    }


def _series(values: Iterable[float]) -> dict[str, list[float | None]]:
    return {"f64": [finite(float(v)) for v in values]}
