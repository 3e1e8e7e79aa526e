"""What a series of readings shows by itself: how large its noise is, and which readings stand alone."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from scipy.optimize import brentq

_MAD = 1.4826  # sd of a normal variable in units of its median absolute deviation
_ENOUGH = 8  # differences
_FOUR = 4  # neighbours of which a third difference is taken
EVEN = 1.5  # times the usual distance of neighbours, above which there is a gap between them
FAR = 12.0  # standard deviations of the noise from either neighbour,
ALONE = 3.0  # and times what the four neighbours differ from one to the next
RARE = 0.01  # of all samples, and
FEW = 3  # of a run; what is more frequent is how this sensor reads
FIRST, LINE = 0.2, 3  # s from which a series' first value is taken, by a line if that is so many samples at least
GLANCED = 10_000  # readings, which a converter that is finer than the noise shows itself in
MULTIPLES, WHOLE = 50, 0.1  # of a converter's step, that are looked at; and how near to whole numbers they are read
STRAIGHT = 1e-9  # of the steepest slope, by which a line may bend for rounding


def estimate(series: Iterable[np.ndarray]) -> float | None:
    """Standard deviation of the noise in one channel, from all its runs, each (n,) with NaN in gaps.

    Third differences remove any motion that is smooth over four readings; their median absolute deviation is
    not moved by the few readings where it is not (a hand that strikes the rim). White noise is assumed: coloured
    noise comes out too small. None where there is nothing to estimate from: too few readings, or all the same.
    """
    series = list(series)
    sd = scatter(np.concatenate([third_differences(s) for s in series]) if series else np.empty(0))
    if sd is None:
        return None
    values = np.concatenate(series)
    few = values[:: max(1, len(values) // GLANCED)]  # steps between some of the values are no smaller than between all
    return sd if 0 < _quantum(few) / np.sqrt(12.0) <= sd else max(sd, _quantum(values) / np.sqrt(12.0)) or None


def share_in_mean(n: float, phi: float) -> float:
    """What a mean of `n` neighbouring readings has of their noise's standard deviation, with the AR(1) coefficient `phi`:
    1 / √n where it is white."""
    lags = np.arange(1, int(np.ceil(n)))
    return float(np.sqrt(n + 2 * np.sum((n - lags) * phi**lags)) / n)


def colour(found: float, sd: float) -> float:
    """AR(1) coefficient of noise with the standard deviation `sd`, of which `estimate` has `found` so much: the variance of its
    third differences is σ² (20 − 30 φ + 12 φ² − 2 φ³). 0 where that is no less than white noise shows."""
    if not 0 < found < sd:
        return 0.0
    return float(brentq(lambda phi: 20 - 30 * phi + 12 * phi**2 - 2 * phi**3 - 20 * (found / sd) ** 2, 0.0, 1.0))


def bends(time: np.ndarray, series: np.ndarray) -> np.ndarray:
    """Of a series (n,) that is straight lines between samples of its own, these samples."""
    slope = np.diff(series) / np.diff(time)
    far = np.abs(np.diff(slope)) > STRAIGHT * np.max(np.abs(slope), initial=0.0)
    return series[np.concatenate(([True], far, [True]))]


def third_differences(series: np.ndarray) -> np.ndarray:
    """Of four neighbouring readings each, with the noise's own standard deviation if it is white.

    A slow sensor has its readings in every second or third row, not always as far apart: each four are weighted so that no
    parabola through them shows. There are none across gaps.
    """
    places = np.flatnonzero(np.isfinite(series))
    if len(places) < _FOUR:
        return np.empty(0)
    step = np.diff(places).astype(float)
    first = np.diff(series[places]) / step
    a, b, c = step[:-2], step[1:-1], step[2:]
    second = np.diff(first) / (step[:-1] + step[1:])
    third = np.diff(second) / (a + b + c)
    weights = 1 / (a * (a + b) * (a + b + c)), 1 / (a * b * (b + c)), 1 / ((a + b) * b * c), 1 / ((a + b + c) * (b + c) * c)
    close = np.maximum.reduce([a, b, c]) <= EVEN * np.median(step)
    return (third / np.sqrt(sum(w**2 for w in weights)))[close]


def scatter(third: np.ndarray) -> float | None:
    """Standard deviation of the noise from third differences; None where there are too few."""
    if third.size < _ENOUGH:
        return None
    sd = _MAD * float(np.median(np.abs(third)))
    return sd or float(np.sqrt(np.mean(third**2)))  # a coarse converter: most neighbours are equal


def _quantum(values: np.ndarray) -> float:
    """The smallest step between two different values: what the converter resolves, if all others are multiples of it. Of a
    marker that moves on all the time it is a step of its way."""
    values = np.unique(values)
    steps = np.diff(values[np.isfinite(values)])
    if not steps.size:
        return 0.0
    times = steps / steps.min()
    times = times[times < MULTIPLES]
    return float(steps.min()) if np.all(np.abs(times - np.round(times)) < WHOLE) else 0.0


def tells(series: np.ndarray) -> bool:
    """Does a sensor's record say anything: is there more in it than gaps, or one value over and over?"""
    finite = series[np.isfinite(series)]
    return finite.size == 1 or (finite.size > 1 and bool(finite.min() < finite.max()))


def spikes(series: np.ndarray) -> np.ndarray:
    """Places of readings in a channel (n,), which may have gaps, that are far off between neighbours that agree, as loose
    contacts and lost bits make them.

    No chair moves so. A push may: a hand that strikes the rim is over within a sample of a slow logger.
    """
    places = np.flatnonzero(np.isfinite(series))
    values = series[places]
    noise = scatter(third_differences(values))
    if not noise:
        return places[:0]
    step = np.diff(np.pad(values, 2, mode="reflect"))  # beyond an end as before it
    rise, fall = step[1:-2], step[2:-1]
    at = np.flatnonzero(((rise < 0) != (fall < 0)) & (np.abs(rise) > FAR * noise) & (np.abs(fall) > FAR * noise))
    off = np.minimum(np.abs(rise[at]), np.abs(fall[at]))
    around = np.maximum.reduce([np.abs(step[at]), np.abs(rise[at] + fall[at]), np.abs(step[at + 3])])
    found = places[at[off > ALONE * around]]
    return found if len(found) <= max(FEW, RARE * len(values)) else found[:0]


def only(series: np.ndarray, places: np.ndarray) -> np.ndarray:
    """The series with gaps everywhere but in these places."""
    return without(series, np.setdiff1d(np.arange(len(series)), places, assume_unique=True))


def without(series: np.ndarray, places: Sequence[int] | np.ndarray) -> np.ndarray:
    """The series with gaps in these places."""
    rest = series.copy()
    rest[places] = np.nan
    return rest


def began(time: np.ndarray, series: np.ndarray) -> float | None:
    """What a series (n,) at times (n,), with NaN in gaps, began with: the robust line of Theil and Sen through its first
    samples, as a chair that is being pushed gains speed; the first one itself, where the next ones are too late to tell. None
    where it has no sample."""
    there = np.isfinite(series)
    time, series = time[there] - time[0], series[there]
    first = time <= FIRST
    if first.sum() < LINE:
        return float(series[0]) if series.size else None
    time, series = time[first], series[first]
    pairs = np.stack(np.triu_indices(len(time), 1))
    earlier, later = pairs[:, np.diff(time[pairs], axis=0)[0] > 0]  # a clock that stands is a fault, and said elsewhere
    slopes = (series[later] - series[earlier]) / (time[later] - time[earlier])
    return float(np.median(series - (np.median(slopes) if slopes.size else 0.0) * time))


def integral(time: np.ndarray, series: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Of a series (n,) that is a straight line between its samples, from the first one to each of the times `at` (m,)
    among them."""
    area = np.concatenate(([0.0], np.cumsum(np.diff(time) * (series[1:] + series[:-1]) / 2)))
    i = np.clip(np.searchsorted(time, at, side="right") - 1, 0, len(time) - 2)
    along = at - time[i]
    slope = (series[i + 1] - series[i]) / (time[i + 1] - time[i])
    return np.asarray(area[i] + along * (series[i] + slope * along / 2))
