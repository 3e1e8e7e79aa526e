"""Size and colour of each channel's noise, from how quickly its residual changes from sample to sample; colour of the pushes'.

Noise shows at lags of a few samples, where a missing effect hardly moves. The mean square of
d(i + k) − d(i) is 2σ²(1 − φ^k) for AR(1) noise, plus about c k² of whatever is smooth.
"""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from ...campaign import BY_NAME
from ...campaign.series import colour, estimate
from .evidence import Evidence
from .noise_model import FORCES, NoiseModel

LAGS = 15
WHITE = 0.2  # an AR(1) coefficient below this is not worth a state
QUIETER = 0.75  # mean square error below which noise was taken for too large, once what was missing is in the model
STEADY = 0.6  # an AR(1) coefficient of pushes below this may as well be noise that was stated too large
TRUSTED = 1.5  # a stated standard deviation within this factor of the data's own is kept,
EVEN = 0.25  # share of the usual time over so many readings by which one may differ; more is a gap
SLOW = 0.98  # or one that could be right where noise is so slow that LAGS samples tell its changes but not its size
ENDLESS = 0.99  # AR(1) coefficient of what walks at random, as a chair on a rough floor does
MOST = 0.995  # the largest that is looked at
SEVERAL = 3  # runs that show whether two figures go together
ENOUGH = 100  # samples of a channel in a run that tell its noise there
TOLD = (
    0.01  # share of noise in the change between readings, below which it is not told: motion follows c k² no better than that
)


def noise_model_of(
    evidence: Evidence, stated: Mapping[str, float], taken: NoiseModel, lowest: float = 0.0, estimated: Container[str] = ()
) -> tuple[NoiseModel, list[str]]:
    """Noise by channel, and a sentence for each channel where the data contradict the campaign file.

    The innovations of `evidence` are by the noise `taken` so far; where they change as white noise does, and errors
    have a mean square of `lowest` or more, it is right. Where errors change as smoothly as motion does, they tell no noise, and
    what the file says stands; of channels `estimated` that is what their readings show by themselves.
    """
    sd, ar, notes = dict(stated), {}, []
    for channel in dict.fromkeys(c for e in evidence.runs for c in e.channels):
        if _white(evidence, channel, lowest):
            sigma, phi = taken.sd[channel], taken.ar.get(channel, 0.0)
        elif (told := _fit_structure(*_structure(_residuals(evidence, channel)))) is None:
            continue
        else:
            sigma, phi = told
        ratio = sigma / stated[channel] if stated[channel] > 0 else np.inf
        # what is slow may as well be what the model lacks, and what never settles is
        slow = phi > SLOW and ratio > 1 and ((1 - phi) * ratio**2 < 1 or phi >= ENDLESS)
        trusted = slow or 1 / TRUSTED < ratio < TRUSTED
        if phi > WHITE:
            # data tell σ² (1 − φ), the change from one sample to the next, far better than they tell either of the two
            ar[channel] = max(0.0, 1 - (1 - phi) * ratio**2) if trusted else phi
        if not trusted:
            sd[channel] = sigma
            known = (
                ("stated", "the data's own") if channel not in estimated else ("its readings show alone", "what a model leaves")
            )
            unit = BY_NAME[channel].unit.name.replace(".", " ")
            differs = f"its noise is about {sigma:.2g} {unit}, not the {stated[channel]:.2g} {known[0]}"
            notes.append(f"{channel}: {differs}; {known[1]} is used")
    pushes = {side: _push_colour(evidence, side, stated.get(side, 0.0)) for side in FORCES}
    ar |= {side: phi for side, phi in pushes.items() if phi > STEADY}
    return replace(taken, sd=sd, ar=ar), notes


def by_run(evidence: Evidence, taken: NoiseModel) -> dict[str, dict[str, float]]:
    """How many times a channel's usual standard deviation its noise is in each run, by how innovations change from one sample
    to the next: a chair on a rough floor shakes its sensors the more the faster it goes."""
    found: dict[str, dict[str, float]] = {e.run.name: {} for e in evidence.runs}
    for e in evidence.runs:
        for i, channel in enumerate(e.channels):
            r = _there(e.r[:, i])
            if len(r) > ENOUGH:
                usual = taken.sd[channel] * e.run.noise_share(channel)
                times = float(np.sqrt(np.mean(np.diff(r) ** 2) / 2)) * taken.of(channel, e.run) / usual
                found[e.run.name][channel] = times
    return found


def shown(evidence: Evidence, found: Mapping[str, Mapping[str, float]], taken: NoiseModel) -> dict[str, float]:
    """By channel, how many times what readings show by themselves its noise is, as `found` by run: where that is more alike
    from run to run than the noise is, it tells of a run that nobody has fitted."""
    told = {}
    for channel in dict.fromkeys(c for times in found.values() for c in times):
        known = [(times[channel], e) for e in evidence.runs if channel in (times := found[e.run.name])]
        usual = taken.sd[channel]
        pairs = [
            (size * usual * e.run.noise_share(channel), by) for size, e in known if (by := estimate([e.run.channels[channel]]))
        ]
        size, by = np.log(np.reshape(pairs, (-1, 2))).T
        if len(pairs) >= SEVERAL and np.std(size - by) < np.std(size):
            told[channel] = float(np.exp(np.mean(size - by)))
    return told


def _push_colour(evidence: Evidence, side: str, sd: float) -> float:
    """AR(1) coefficient of the noise in a record of pushes from sample to sample, by its stated size and its third differences,
    which no hand's push moves."""
    name = f"push.{side}"
    runs = [e.run for e in evidence.runs if name in e.run.inputs]
    told = [run.colours[name] for run in runs if name in run.colours]
    if told:
        return told[0]
    found = estimate([run.inputs[name] for run in runs])
    return 0.0 if found is None else colour(found, sd)


def _white(evidence: Evidence, channel: str, lowest: float) -> bool:
    """Do innovations change from one sample to the next as white noise of unit size does, whatever is slow in them, and are
    errors no smaller than `lowest`?"""
    where = [(e, e.channels.index(channel)) for e in evidence.runs if channel in e.channels]
    change = float(np.mean(np.concatenate([np.diff(_there(e.r[:, i])) for e, i in where]) ** 2)) / 2
    level = float(np.nanmean(np.concatenate([e.e[:, i] for e, i in where]) ** 2))
    return 1 / TRUSTED**2 < change < TRUSTED**2 and level >= lowest


def _there(values: np.ndarray) -> np.ndarray:
    return values[np.isfinite(values)]


def _residuals(evidence: Evidence, channel: str) -> list[tuple[np.ndarray, np.ndarray]]:
    """Times and residuals (m,) of the channel's own readings in each run, as large as those of one reading: a slow sensor has
    none in most rows."""
    found = []
    for e in (e for e in evidence.runs if channel in e.channels):
        d = e.run.channels[channel] - e.followed[:, e.channels.index(channel)]
        there = np.isfinite(d)
        found.append((e.run.time[there], d[there] / e.run.noise_share(channel)))
    return found


def _structure(residuals: Sequence[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """Lags over 1 … LAGS readings, in units of the usual time between two, and the residuals' mean square change over each."""
    step = float(np.median(np.concatenate([np.diff(t) for t, _ in residuals])))
    lags, means = [], []
    for k in range(1, LAGS + 1):
        pairs = [((t[k:] - t[:-k]) / step, d[k:] - d[:-k]) for t, d in residuals]
        over, change = np.concatenate([lag for lag, _ in pairs]), np.concatenate([d for _, d in pairs])
        even = np.abs(over - np.median(over)) < EVEN * np.median(over) if over.size else np.zeros(0, bool)
        if even.any():
            lags.append(float(over[even].mean()))
            means.append(float(np.mean(change[even] ** 2)))
    return np.array(lags), np.array(means)


def _fit_structure(k: np.ndarray, D: np.ndarray) -> tuple[float, float] | None:
    """(σ, φ) from the mean square changes D (m,) over k (m,) readings; None where they are those of something smooth."""
    scale = max(float(D[0]), 1e-300)

    def off(q: np.ndarray) -> np.ndarray:
        model = 2 * np.exp(q[0]) * (1 - q[1] ** k) + np.exp(q[2]) * k**2
        return np.log(model * scale / np.maximum(D, 1e-300))

    best = min(
        (
            least_squares(off, (np.log(0.5 / (1 - phi ** k[0])), phi, -8.0), bounds=([-20, 0, -30], [20, MOST, 5]))
            for phi in (0.05, 0.5, 0.9)
        ),
        key=lambda s: s.cost,
    )
    share, phi = 2 * float(np.exp(best.x[0])) * (1 - float(best.x[1]) ** k[0]), float(best.x[1])
    return (float(np.sqrt(np.exp(best.x[0]) * scale)), phi) if share > TOLD else None
