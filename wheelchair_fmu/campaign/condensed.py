"""Fast recordings as means over short spans of time, for a search that looks at them hundreds of times.

Loggers of 240 and 400 Hz, each with its own clock, make a thousand rows a second of a chair that hardly changes within twenty
milliseconds. A mean over these says of the chair all that its samples say, with less of the noise, and a search takes a tenth
of the time. No reading moves to another time: a mean stands in the middle of its span.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .records import Baseline, Campaign, Run
from .series import integral

SPAN = 0.02  # s. Over it a frequency f is damped by (2π f SPAN)²/24: 1 % at 4 Hz, where hands and trunks hardly move
DENSE = 150.0  # rows a second, above which a run is condensed
SLOW = 1.5  # samples in a span, below which a series stays as it is
FEWEST = 10  # spans; a shorter run stays as it is
MOSTLY = 0.75  # of the usual number of samples in a span, from which on there is a mean of them


def condensed(campaign: Campaign) -> Campaign:
    """The campaign with every run of more than DENSE rows a second condensed, and its channels' noise as the means have it.

    It says so in `thinned`. Pushes stay straight lines between rows and keep their momentum; the noise of their records is by
    their own samples (see `Run.input_steps`), and stays what it was.
    """
    fast = sum(map(_is_fast, campaign.runs))
    if not fast or campaign.thinned:
        return campaign
    runs = tuple(_condensed(run) if _is_fast(run) else run for run in campaign.runs)
    noise = {name: sd / float(np.sqrt(_samples_in_a_mean(campaign, name))) for name, sd in campaign.noise.items()}
    said = (
        f"the search looks at means over {1000 * SPAN:g} ms of {fast} runs with more than {DENSE:g} rows a second; "
        "`wheelchair compare` looks at every sample"
    )
    return replace(campaign, runs=runs, noise=noise, thinned=said)


def _is_fast(run: Run) -> bool:
    """Has it more rows a second than a search needs, and enough spans to be a run of their means?"""
    seconds = float(run.time[-1] - run.time[0])
    return len(run.time) - 1 > DENSE * seconds and seconds > FEWEST * SPAN


def _step(run: Run, series: np.ndarray) -> float:
    """Usual time between the readings of a channel (n,) with gaps; inf where there are none."""
    own = run.time[np.isfinite(series)]
    return float(np.median(np.diff(own))) if len(own) > 1 else np.inf


def _samples_in_a_mean(campaign: Campaign, channel: str) -> float:
    """Of a channel, by the run that has fewest; 1 for what stays as it is."""
    counts = [
        SPAN / _step(run, run.channels[channel]) if _is_fast(run) else 1.0 for run in campaign.runs if channel in run.channels
    ]
    fewest = min(counts, default=1.0)
    return fewest if fewest > SLOW else 1.0


def _condensed(run: Run) -> Run:
    """The run on the middles of spans, and the times of its slow channels."""
    count = int((run.time[-1] - run.time[0]) / SPAN)
    edges = run.time[0] + SPAN * np.arange(count + 1)
    middles = edges[:-1] + SPAN / 2
    slow = [c for c, series in run.channels.items() if SPAN / _step(run, series) <= SLOW]
    own = [run.time[np.isfinite(run.channels[c])] for c in slow]
    time = np.unique(np.concatenate([middles, *(t[(t > middles[0]) & (t < middles[-1])] for t in own)]))
    at = np.searchsorted(time, middles)
    channels = {c: np.full(len(time), np.nan) for c in run.channels}
    for c, series in run.channels.items():
        if c in slow:
            rows, there = np.isin(time, run.time), np.isin(run.time, time)
            channels[c][rows] = series[there]
        else:
            channels[c][at] = _means(run.time, series, edges)

    def driven(series: np.ndarray) -> np.ndarray:
        return np.interp(time, middles, np.diff(integral(run.time, series, edges)) / SPAN)

    usual = float(np.median(np.diff(run.time)))
    return replace(
        run,
        time=time,
        inputs={name: driven(series) for name, series in run.inputs.items()},
        channels=channels,
        baselines=tuple(_baseline(b, driven) for b in run.baselines),
        input_steps={name: run.input_steps.get(name, usual) for name in run.inputs},
    )


def _baseline(baseline: Baseline, driven: Callable[[np.ndarray], np.ndarray]) -> Baseline:
    return replace(baseline, shapes=np.stack([driven(shape) for shape in baseline.shapes.T], axis=1))


def _means(time: np.ndarray, series: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Means (m,) of the readings in each span, moved along their own slope to its middle; NaN where many are missing."""
    good = np.isfinite(series) & (time < edges[-1])
    t, v = time[good], series[good]
    span = np.searchsorted(edges, t, side="right") - 1
    m = len(edges) - 1
    n = np.bincount(span, minlength=m)
    there = n >= MOSTLY * SPAN / float(np.median(np.diff(t)))
    with np.errstate(invalid="ignore"):
        mean_t, mean_v = (np.where(there, np.bincount(span, x, m) / n, np.nan) for x in (t, v))
    known = np.flatnonzero(there)
    if len(known) < 2:
        return mean_v
    slope = np.full(m, np.nan)
    slope[known] = np.gradient(mean_v[known], mean_t[known])
    return np.asarray(mean_v + slope * ((edges[:-1] + edges[1:]) / 2 - mean_t))
