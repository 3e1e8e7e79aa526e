"""Fast recordings as means over short spans of time, for a search that looks at them hundreds of times.

Loggers of 100 to 400 Hz, each with its own clock, make hundreds of rows a second of a chair that hardly changes within twenty
milliseconds. A mean over these says of the chair all that its samples say, with less of the noise, and a search takes half of
the time, or a tenth. No reading moves to another time: a mean stands in the middle of its span.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from .records import Baseline, Campaign, Run
from .series import bends, colour, estimate, integral, share_in_mean

SPAN = 0.02  # s. Over it a frequency f is damped by (2π f SPAN)²/24: 1 % at 4 Hz, where hands and trunks hardly move
SLOW = 1.5  # samples in a span, up to which a series stays as it is
DENSE = SLOW / SPAN  # samples a second, above which a series is condensed
FEWEST = 10  # spans; a shorter run stays as it is
MOSTLY = 0.75  # of the usual number of samples in a span, from which on there is a mean of them


def condensed(campaign: Campaign) -> Campaign:
    """The campaign with every run condensed of which something was recorded more than DENSE times a second.

    Pushes stay straight lines between rows and keep their momentum; the noise of their records is by their own samples (see
    `Run.steps`). What a campaign says of a channel's noise is of its readings; `Run.noise_shares` say how much of it is
    in a mean.
    """
    fast = [_is_fast(run) for run in campaign.runs]
    if not any(fast):
        return campaign
    colours = _colours(campaign)
    runs = (_condensed(run, colours) if is_fast else run for run, is_fast in zip(campaign.runs, fast, strict=True))
    return replace(campaign, runs=tuple(runs))


def _is_fast(run: Run) -> bool:
    """Has anything more samples a second than a search needs, and the run enough spans to be one of their means?"""
    if run.noise_shares or run.time[-1] - run.time[0] <= FEWEST * SPAN:
        return False
    usual = float(np.median(np.diff(run.time)))
    each = [run.steps.get(name, usual) for name in run.inputs] + [_step(run, series) for series in run.channels.values()]
    return SPAN / min(each) > SLOW


def _step(run: Run, series: np.ndarray) -> float:
    """Usual time between the readings of a channel (n,) with gaps; inf where there are none."""
    own = run.time[np.isfinite(series)]
    return float(np.median(np.diff(own))) if len(own) > 1 else np.inf


def _colours(campaign: Campaign) -> dict[str, float]:
    """AR(1) coefficient of the noise in each channel and each recorded push, from one of its own samples to the next, by how
    much of it third differences show."""
    found = {}
    for name, sd in campaign.noise.items():
        shown = estimate([own for run in campaign.runs if (own := _samples(run, name)) is not None])
        found[name] = colour(shown, sd) if shown else 0.0
    return found


def _samples(run: Run, name: str) -> np.ndarray | None:
    """What a device recorded of a channel or a push, one after the other; None where it is not in this run."""
    pushed = run.inputs.get(f"push.{name}")
    return run.channels.get(name) if pushed is None else bends(run.time, pushed)


def _condensed(run: Run, colours: Mapping[str, float]) -> Run:
    """The run on the middles of spans, and the times of its slow channels. No sample stands on the edge of a span."""
    usual = float(np.median(np.diff(run.time)))
    edges = run.time[0] - usual / 2 + SPAN * np.arange(int((run.time[-1] - run.time[0] + usual) / SPAN) + 1)
    middles = edges[:-1] + SPAN / 2
    count = {c: SPAN / _step(run, series) for c, series in run.channels.items()}
    slow = [c for c, n in count.items() if n <= SLOW]
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

    return replace(
        run,
        time=time,
        inputs={name: driven(series) for name, series in run.inputs.items()},
        channels=channels,
        baselines=tuple(_baseline(b, driven) for b in run.baselines),
        steps={name: run.steps.get(name, usual) for name in run.inputs} | {c: SPAN / n for c, n in count.items() if n > 0},
        colours={name: colours.get(name.removeprefix("push."), 0.0) for name in run.inputs},
        noise_shares={c: 1.0 if c in slow else share_in_mean(n, colours.get(c, 0.0)) for c, n in count.items()},
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
