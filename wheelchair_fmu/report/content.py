"""What the page knows: measurements, the model as WebAssembly, the diagnosis and the models it went through."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from ..campaign import CHANNELS, Campaign, Run, moving, pace
from ..campaign.recorded import PUSHES_CLOCK
from ..engine.innovations import steps
from ..engine.tangent import EXTERNAL, differentiable, sensed
from ..engine.wasm import evaluation, modules
from ..inference.decision.among_forces import FORCES as UNRECORDED
from ..inference.estimation.statistics import finite
from ..inference.evidence.initial_state import CASTERS, START, TUNING, prior_start, start_sd, starts_of
from ..inference.evidence.likelihood import BODY, TOLERANCE, driven
from ..inference.evidence.local import BaselineError, ClockError, Local, locals_of
from ..inference.evidence.noise_model import (
    BODYS,
    GRAVITY,
    PLACES,
    RECORDS,
    RIDER,
    NoiseModel,
    disturbance,
    noise_of,
    pushes_of,
)
from ..inference.explain.landscape import landscape
from ..inference.models.factory import ModelFactory
from ..inference.models.models import Models
from ..inference.models.setting import Setting
from ..inference.preflight.timing import Late, retimed
from ..model.stage import Effect
from ..model.variant import Variant
from ..model.wheelchair import REGIMES
from ..quantities import N, Parameter, Unit
from .words import in_full, laws_of

STARTS = (*START, *CASTERS)  # of which a model has those of its own states
PATH = ("chair.x", "chair.y", "chair.psi", "caster.fl", "caster.fr")
FORCES = ("chair.u", "chair.psi_dot", "force.F_srl", "force.F_srr")
LOADS = tuple(f"load.{wheel}" for wheel in ("rl", "rr", "fl", "fr"))
LIMITS = ("load.lifted", "push.beyond_friction")  # flags: where the model no longer holds


def content(
    campaign: Campaign, variant: Variant, colour: NoiseModel, diagnosis: Mapping[str, Any], fixed: Sequence[str] = ()
) -> dict[str, Any]:
    """Everything that `page.html` shows, as JSON; series are numbers under the key "f64", null in gaps.

    `diagnosis` is what `inference.explain.story` tells; `fixed` are parameters that the diagnosis did not estimate.
    """
    leads = any(step["step"] == UNRECORDED for step in diagnosis["ladder"])
    campaign = replace(campaign, runs=tuple(in_time(r, diagnosis.get("sync", {})) for r in campaign.runs))
    campaign = used(moving(campaign), diagnosis) if leads else campaign
    factory = ModelFactory(campaign, variant, fixed)
    models = Models(factory, Setting(colour))
    variants = [variant.with_effects(ids) for ids in layers(factory, campaign.effects, diagnosis["effects"])]
    inputs = driven(campaign).union(EXTERNAL if _acts(colour) else ())
    compiled = modules([(v.choice, v.active()) for v in variants], STARTS, inputs)
    measured = {name for r in campaign.runs for name in r.channels}
    return {
        "name": campaign.name,
        "diagnosis": _lasting(_along_forces(diagnosis) if leads else diagnosis),
        "landscape": {"profiles": [], "pair": None} if leads else landscape(models, diagnosis),
        "runs": [_run(r, campaign, colour, leads) for r in campaign.runs],
        "channels": [_quantity(c.name, c.unit, c.meaning) for c in CHANNELS if c.name in measured],
        "next_channel": _next_channel(diagnosis),
        "outputs": {c.name: c.fmu for c in CHANNELS},
        "drifting": [c.name for c in CHANNELS if c.drifts],
        "body": sorted(BODY),
        "noise": asdict(colour),
        "forces": _forces(colour),
        "leads": leads,
        "known": {**factory.variant.values, **campaign.known},
        "models": [_model(v, wasm, leads) for v, wasm in zip(variants, compiled, strict=True)],
        "evaluation": b64encode(evaluation(inputs)).decode(),
        "effects": [_effect(e) for e in factory.catalogue.values()],
        "calibrated": [_parameter(p) for p in variant.parameters() if p.name in diagnosis["calibrated"]],
        "constants": [_parameter(p) for e in factory.catalogue.values() for p in e.owned if p.name in _fitted(diagnosis)],
        "regimes": _regimes(variant),
        "shown": list(dict.fromkeys((*PATH, *FORCES, *LOADS, *LIMITS, *REGIMES.values()))),
        "geometry": _geometry(campaign, variant),
        "tuning": TUNING,
        "tolerance": TOLERANCE,
    }


def _lasting(diagnosis: Mapping[str, Any]) -> dict[str, Any]:
    """A diagnosis but for how long it took, so that the same measurements give the same page."""
    return {key: value for key, value in diagnosis.items() if key != "seconds"}


def _along_forces(diagnosis: Mapping[str, Any]) -> dict[str, Any]:
    """A diagnosis as the page runs it, with forces that nobody recorded among the noise all along: the search begins at the
    step that counts them. The calibrated model of before, whose error in the staircase is without them, is none of its
    models."""
    if diagnosis["begins"] != "calibrated":  # a chair that came with effects begins with these in
        return dict(diagnosis)
    told = {m["step"]: m["values"] for m in diagnosis["models"]}
    calibrated = told.pop("calibrated")  # of an older diagnosis the only ones that are known
    told = {"nominal": told.pop("nominal"), UNRECORDED: calibrated, **told}
    return {**diagnosis, "begins": UNRECORDED, "models": [{"step": step, "values": values} for step, values in told.items()]}


def _fitted(diagnosis: Mapping[str, Any]) -> Mapping[str, Any]:
    """What came out of calibration, constants of effects' laws among it."""
    return diagnosis.get("calibration") or {}


def _forces(colour: NoiseModel) -> dict[str, Any] | None:
    """Forces that nobody recorded, as these act from outside: a `Disturbance` of a chair of the mass they were found for that
    rolls at 1 m/s; which of them are the rider's body's, whose size in a run is `swinging` times as large, which the floor's,
    which are forgotten sooner by as much as a run has `pace`, and which are in runs whose record of that body may be wrong."""
    if not _acts(colour):
        return None
    felt = tuple(GRAVITY)
    found = disturbance(colour, (*EXTERNAL, RIDER), readings=felt)
    assert found.common is not None and found.as_reading is not None
    as_push = dict(zip(EXTERNAL, found.as_push[: len(EXTERNAL)].tolist(), strict=True))
    which = {"body": BODYS, "places": PLACES, "recorded": RECORDS}
    sizes = {"sd": found.sd.tolist(), **{name: mask.tolist() for name, mask in which.items()}}
    as_reading = dict(zip(felt, found.as_reading.tolist(), strict=True))
    lasting = {"lasting": found.lasting.tolist(), "together": found.common.tolist()}
    return {**sizes, **lasting, "as_push": as_push, "as_reading": as_reading}


def _acts(colour: NoiseModel) -> bool:
    """Is there anything among the noise that acts, besides errors of recorded pushes?"""
    return colour.disturbed or colour.wrong > 0


def in_time(run: Run, sync: Mapping[str, Any]) -> Run:
    """The run with its pushes at the time that the diagnosis read them at, where the campaign has them at another."""
    late = sync.get(run.name, {}).get(PUSHES_CLOCK)
    return run if late is None or run.clocks else retimed(run, Late(late["offset"], 0.0))


def noise_told(told: Mapping[str, Any], stated: Mapping[str, float] | None = None) -> NoiseModel:
    """The noise of a diagnosis, with that which is `stated` of channels that have come since. An older one has its forces
    elsewhere."""
    led = any(step["step"] == UNRECORDED for step in told["ladder"])
    forces = (told["disturbance"] or {}).get("calibrated", {}) if led else {}
    return NoiseModel(**{**forces, **told["noise"], "sd": {**(stated or {}), **told["noise"]["sd"]}})


def used(campaign: Campaign, told: Mapping[str, Any]) -> Campaign:
    """The runs and channels that a diagnosis used, of those there are."""
    runs = told["final"]["runs"]
    kept = (r for r in campaign.runs if r.name in runs)
    some = (replace(r, channels={c: v for c, v in r.channels.items() if c in runs[r.name]["channels"]}) for r in kept)
    return replace(campaign, runs=tuple(some))


def layers(w: ModelFactory, given: Sequence[str], found: Sequence[str]) -> list[tuple[str, ...]]:
    """Effects of each model the page carries, the lightest first: what brings no state and what the campaign has `given` a
    size, that and what was `found`, what brings states, what needs other laws."""
    seldom = (*w.heavy, *w.demanding)
    more = (given, (*given, *found), (*given, *w.heavy), seldom)
    return list(dict.fromkeys((*w.light, *(e for e in seldom if e in some)) for some in more))


def _model(variant: Variant, wasm: bytes, leads: bool) -> dict[str, Any]:
    model = variant.model()
    starts = starts_of(p.name for p in model.parameters)
    vector = variant.vector()
    return {
        "effects": list(variant.effects),
        "laws": laws_of(variant.choice),
        "wasm": b64encode(wasm).decode(),
        "parameters": [[p.name, float(v)] for p, v in zip(model.parameters, vector, strict=True)],
        "inputs": [[i.name, i.start] for i in model.inputs],
        "outputs": [o.name for o in model.outputs],
        "states": model.x.numel(),
        "sensors": [model.outputs[i].name for i in sensed(model)],
        "columns": [p.name for p in differentiable(model, STARTS)],
        "starts": starts,
        "flips": not leads and set(CASTERS) <= set(starts),  # see `Likelihood`
        "delays": [p.name for e in model.effects if e.delays_record for p in e.owned],
    }


def _run(run: Run, campaign: Campaign, colour: NoiseModel, leads: bool) -> dict[str, Any]:
    channels, pushes = [c.name for c in CHANNELS if c.name in run.channels], pushes_of(run, leads)
    noise = noise_of(colour, run, channels, pushes)
    present = np.stack([np.isfinite(run.channels[c]) for c in channels], axis=1)
    assert noise.push_step is not None
    return {
        "name": run.name,
        "role": run.role,
        "manoeuvre": run.manoeuvre,
        "set": run.set,
        "time": _series(run.time),
        "inputs": {name: _series(v) for name, v in run.inputs.items()},
        "channels": {c: _series(run.channels[c]) for c in channels},
        "start": prior_start(run, {**campaign.known, **run.set}, STARTS, leads),
        "start_sd": start_sd(run, STARTS),
        "usual": float(np.median(np.diff(run.time))),
        "pushes": {
            "names": list(pushes),
            "sd": noise.pushes.tolist(),
            "ar": noise.push_colour.tolist(),
            "step": noise.push_step.tolist(),
        },
        "noise": {"sd": noise.readings.tolist(), "ar": noise.colour.tolist(), "step": steps(run.time, present).tolist()},
        "swinging": _series(colour.swinging(run) if _acts(colour) else ()),
        "pace": _series(pace(run) if _acts(colour) else ()),
        "constants": [_constant(c) for c in locals_of(run)],
    }


def _constant(local: Local) -> dict[str, Any]:
    """What is uncertain of one run only, besides its start."""
    if isinstance(local, BaselineError):
        shape = _series(local.baseline.independent[:, local.column])
        return {"kind": "baseline", "sd": local.sd, "inputs": [local.baseline.input], "channels": [], "shape": shape}
    assert isinstance(local, ClockError)
    return {"kind": "clock", "sd": local.sd, "inputs": sorted(local.clock.inputs), "channels": sorted(local.clock.channels)}


def _effect(effect: Effect) -> dict[str, Any]:
    return {"id": effect.id, "title": in_full(effect.title), "parameters": [_parameter(p) for p in effect.owned if p.estimated]}


def _parameter(p: Parameter) -> dict[str, Any]:
    return {
        **_quantity(p.name, p.unit, p.meaning),
        "lower": finite(p.lower),
        "upper": finite(p.upper),
        "default": p.default,
        "delta": p.smallest_interesting,
        "source": p.source,
    }


def _next_channel(diagnosis: Mapping[str, Any]) -> dict[str, Any] | None:
    """The channel in which to look at the next experiment, which this campaign may not have measured; None without one."""
    shows = (diagnosis.get("next_experiment") or {}).get("shows")
    channel = next((c for c in CHANNELS if shows and c.name == shows["channel"]), None)
    return None if channel is None else _quantity(channel.name, channel.unit, channel.meaning)


def _quantity(name: str, unit: Unit, meaning: str) -> dict[str, Any]:
    shown = [{"unit": d.name, "factor": d.factor} for d in unit.display if d.name.startswith("deg")]
    return {"name": name, "unit": unit.name, "meaning": in_full(meaning), "display": shown}


def _regimes(variant: Variant) -> list[dict[str, Any]]:
    """What errors are sorted by: a result, or the total push."""
    outputs = {o.name: o for o in variant.model().outputs}
    sorted_by = [{**_quantity(name, outputs[o].unit, outputs[o].meaning), "output": o} for name, o in REGIMES.items()]
    return [*sorted_by, {**_quantity("push", N, "total push"), "output": None}]


def _geometry(campaign: Campaign, variant: Variant) -> dict[str, float]:
    """Where the wheels are, for drawing the chair, and what else its picture needs of it."""
    values = {p.name: p.default for p in variant.parameters()} | dict(variant.values) | campaign.known
    return {
        n.rpartition(".")[2]: values[n]
        for n in ("chair.a", "chair.b", "chair.t_r", "chair.t_f", "chair.m", "chair.I_z", "wheel.R", "tyre.mu")
    }


def _series(values: Iterable[float]) -> dict[str, list[float | None]]:
    return {"f64": [finite(float(v)) for v in values]}
