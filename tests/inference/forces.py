"""Campaigns as the model has them, with a force and a moment on the chair that no record has."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from wheelchair_fmu.campaign import Campaign, Run
from wheelchair_fmu.engine.tangent import EXTERNAL
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import FORGOTTEN, HANDS
from wheelchair_fmu.model.variant import Variant

T_R, B, MASS = 0.55, 0.2, 80.0
CHAIR = {"chair.t_r": T_R, "chair.b": B, "chair.m": MASS}
# of a run and its results without: F, M (n,), and what accelerometers do not feel of that, by channel, if there is any
Forces = Callable[[Run, dict[str, np.ndarray]], tuple[Any, ...]]


def rolled(run: Run, without: Mapping[str, np.ndarray]) -> np.ndarray:
    """How far (n,) a run's chair has rolled, by its results."""
    return np.cumsum(np.abs(without["chair.u"]) * np.diff(run.time, prepend=run.time[0]))


def wandering(rng: np.random.Generator, at: np.ndarray, sd: float, lasting: float = FORGOTTEN) -> np.ndarray:
    """A first-order Gauss–Markov process (n,) that is forgotten over so many seconds, at times in s, or metres of a way."""
    out, level = np.empty(len(at)), sd * rng.standard_normal()
    for i, gap in enumerate(np.diff(at, prepend=at[0])):
        keeps = np.exp(-gap / lasting)
        level = keeps * level + np.sqrt(1 - keeps**2) * sd * rng.standard_normal()
        out[i] = level
    return out


def swinging(rng: np.random.Generator, time: np.ndarray, sd: float, hard: np.ndarray | float = 1.0) -> np.ndarray:
    """A momentum (n,), (1 + s/15) (1 + s/10) (1 + 3 s/20) p = white noise, by steps of a millisecond: of this standard
    deviation, as long as its noise is the usual one and not `hard` (n,) times that."""
    noise = sd * np.sqrt(2 * 1000 * (950 / 3 * 95 / 3 - 1000) / (95 / 3))
    out, p, rate, bend, hard = np.empty(len(time)), 0.0, 0.0, 0.0, np.broadcast_to(hard, time.shape)
    for i, gap in enumerate(np.diff(time, prepend=time[0] - 5.0)):
        steps = max(10, round(gap / 1e-3))
        for shock in hard[i] * noise * np.sqrt(gap / steps) * rng.standard_normal(steps):
            bend += -(95 / 3 * bend + 950 / 3 * rate + 1000 * p) * gap / steps + shock
            rate += bend * gap / steps
            p += rate * gap / steps
        out[i] = p
    return out


def pushing(run: Run) -> np.ndarray:
    """RMS push (n,) of both hands about each moment, weighed by e^(−|t| / 0.3 s), as a swing's square dies out."""
    both = np.sum([run.inputs[name] for name in HANDS], axis=0)
    apart = np.abs(np.subtract.outer(run.time, run.time))
    return np.sqrt(np.exp(-apart / 0.3) @ (both**2 * np.gradient(run.time)) / 0.6)


def floor(rng: np.random.Generator, slope: float, length: float = 0.4) -> Callable[..., tuple[np.ndarray, np.ndarray]]:
    """Slopes along the way and to the side, at x, y and heading (n,), of a floor whose height is a Gaussian field: waves of all
    directions that together have slopes of this standard deviation and are alike over `length` (m)."""
    k, shift = rng.normal(0, 1 / length, (400, 2)), rng.uniform(0, 2 * np.pi, 400)

    def slopes(x: np.ndarray, y: np.ndarray, heading: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        wave = np.cos(np.outer(x, k[:, 0]) + np.outer(y, k[:, 1]) + shift)
        by_x, by_y = (slope * length * np.sqrt(2 / 400) * wave @ k).T
        c, s = np.cos(heading), np.sin(heading)
        return c * by_x + s * by_y, c * by_y - s * by_x

    return slopes


def uneven(g_x: np.ndarray, g_y: np.ndarray) -> tuple[Any, ...]:
    """The forces of a floor by gravity (n,) along the heading and to the left."""
    return MASS * g_x, MASS * B * g_y, {"a_x": g_x, "a_y": g_y}


def without_accelerometers(campaign: Campaign) -> Campaign:
    """The campaign of a chair that has none."""
    runs = (replace(r, channels={c: v for c, v in r.channels.items() if c not in ("a_x", "a_y")}) for r in campaign.runs)
    return replace(campaign, runs=tuple(runs))


def ridden(
    campaign: Campaign, rng: np.random.Generator, forces: Forces, chair: Variant = Variant(), values: Mapping[str, float] = {}
) -> Campaign:
    """The campaign's runs, simulated with its own pushes and these forces on a chair of such values, read with its noise."""
    likelihood, runs = Likelihood(campaign, chair), []
    names = likelihood.sensitivities.results
    for run in campaign.runs:
        start = likelihood.begins[run.name].start
        without = dict(zip(names, likelihood._simulated(run, values, start)[0].T, strict=True))
        F, M, *gravity = forces(run, without)
        unfelt = gravity[0] if gravity else {}
        felt = dict(zip(EXTERNAL, (F, M), strict=True))
        channels, _, true = likelihood.readings(replace(run, inputs={**run.inputs, **felt}), values, start)
        noise = {
            c: rng.normal(0, campaign.noise[c], len(v)) - unfelt.get(c, 0.0) for c, v in zip(channels, true.T, strict=True)
        }
        read = {c: v + noise[c] for c, v in zip(channels, true.T, strict=True)}
        record = {n: w + rng.normal(0, 0.4, len(w)) if n in HANDS else w for n, w in run.inputs.items()}
        runs.append(replace(run, inputs=record, channels=read))
    return replace(campaign, runs=tuple(runs))
