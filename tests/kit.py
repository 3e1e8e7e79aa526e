"""What several tests need: evaluating a model, random places to evaluate it at, its mirror image; a campaign's own settings."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import casadi as cs
import numpy as np
import pandas as pd

from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Model
from wheelchair_fmu.quantities import Quantity


@dataclass(frozen=True)
class Place:
    """Somewhere to evaluate a model: states (nx,), inputs (nw,), parameters (np,)."""

    x: np.ndarray
    w: np.ndarray
    p: np.ndarray


def evaluate(model: Model, place: Place, *what: cs.SX) -> list[np.ndarray]:
    function = cs.Function("evaluate", [model.x, model.w, model.p], list(what))
    values = function.call([place.x, place.w, place.p])
    return [np.array(v.full()).squeeze(-1) if v.shape[1] == 1 else v.full() for v in values]


def variant_with(*ids: str, size: float = 1.0) -> Variant:
    """A variant with these effects on, each parameter at `size` times its smallest interesting size."""
    variant = Variant().with_effects(ids)
    values = {p.name: size * p.smallest_interesting for p in variant.parameters() if p.smallest_interesting}
    return variant.with_values(values)


def anywhere(variant: Variant, rng: np.random.Generator, speed: float = 1.0, spread: float = 0.1) -> Place:
    """A random motion about `speed`, random pushes, and parameters off their defaults by up to `spread`."""
    model = variant.model()
    x = rng.normal(0, 0.3, model.x.numel())
    x[3] += speed
    w = np.array([i.start for i in model.inputs]) + rng.uniform(0, 0.5, len(model.inputs)) * np.array(
        [min(i.nominal, i.upper) for i in model.inputs]
    )
    p = variant.vector()
    loose = np.array([not q.choices for q in model.parameters])
    p = np.where(loose, p * (1 + spread * rng.uniform(-1, 1, len(p))), p)
    return Place(x, w, np.clip(p, [q.lower for q in model.parameters], [q.upper for q in model.parameters]))


def mirrored(records: tuple[Quantity, ...], values: np.ndarray) -> np.ndarray:
    """The values as a mirror along the chair shows them."""
    names = [n for r in records for n in r.names]
    out = np.empty_like(values)
    for record in records:
        sign, partner = (-1 if record.mirror[0] == "-" else 1), record.mirror[1:]
        places = [names.index(n) for n in record.names]
        if partner == "swap":
            others = places[::-1]
        elif partner:
            others = [names.index(n) for n in _partner(records, record, partner).names]
        else:
            others = places
        out[others] = sign * values[places]
    return out


def _partner(records: tuple[Quantity, ...], record: Quantity, partner: str) -> Quantity:
    """By full name, or by symbol within the same effect or group."""
    group = record.name.rpartition(".")[0]
    same = [r for r in records if r.name == partner or (r.symbol == partner and r.name.startswith(group))]
    assert len(same) == 1, f"{record.name} has no partner {partner}"
    return same[0]


def mirrored_place(model: Model, place: Place) -> Place:
    return Place(
        mirrored(model.states, place.x), mirrored(model.inputs, place.w), mirrored(model.parameters, place.p)
    )


# what runs of the sample campaign may set, each another kind
SETTINGS = {
    "coast-down": '{ "start.psi" = 1.2, "chair.m" = 95 }',
    "straight-strokes": '{ "start.u" = 0.55 }',
    "steady-right": '{ "start.psi_dot" = 0.3 }',
    "steady-left": '{ "start.v" = 0.05, "start.x" = 2.0 }',
    "slalom-slow": '{ "tyre.C_lambda" = 3000 }',
    "slalom-quick": '{ "effect.floor_slope.x" = 0.01 }',
    "holdout-slalom": '{ "effect.relaxation_length.sigma" = 0.3 }',
    "holdout-strokes": '{ "effect.push_force_delay.tau" = 0.03 }',
}


def with_settings(source: Path, folder: Path, settings: Mapping[str, str] = SETTINGS) -> Path:
    """A copy of a campaign, in `folder`, some of whose runs `set` something."""
    shutil.copytree(source, folder)
    file = folder / "campaign.toml"
    text = file.read_text(encoding="utf-8")
    for name, own in settings.items():
        line = f'file = "runs/{name}.csv"\n'
        assert line in text, f"no run {name} in {source}"
        text = text.replace(line, f"{line}set = {own}\n")
    file.write_text(text, encoding="utf-8")
    return folder


def tracked(folder: Path) -> Path:
    """The campaign in `folder` with columns of position and heading, to a hundredth of what wheels and gyro add up to."""
    for file in (folder / "runs").glob("*.csv"):
        rows = pd.read_csv(file)
        dt = np.gradient(rows["time [s]"])
        yaw = np.cumsum(rows["yaw_rate [rad/s]"] * dt)
        step = (rows["wheel_speed_l [m/s]"] + rows["wheel_speed_r [m/s]"]) / 2 * dt
        where = {"x [m]": np.cumsum(step * np.cos(yaw)), "y [m]": np.cumsum(step * np.sin(yaw)), "yaw [rad]": yaw}
        rows.assign(**{name: series.round(2) for name, series in where.items()}).to_csv(file, index=False)
    file = folder / "campaign.toml"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("[noise]", "[noise]\nx = 0.004\ny = 0.004\nyaw = 0.004\n#", 1), encoding="utf-8")
    return folder
