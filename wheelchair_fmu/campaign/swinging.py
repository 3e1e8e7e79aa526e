"""How fast a body swings, from where it was seen: a smoothing spline that is as stiff as the readings ask for.

Two derivatives of a position are mostly the camera's noise, unless they are smoothed as far as the motion allows. People move
smoothly: of a trunk that swings once a second next to nothing is left at 3 Hz, where noise is most of the second derivative. A
spline with a penalty on its fourth derivative is what a body wants of which that is white noise, as `noise_model.SWUNG` has it:
half is left at ω_c, and steeply less beyond it, with λ dt ω_c⁸ = 1 (Woltring 1986; on differences of B-splines' coefficients,
Eilers and Marx 1996). ω_c is found by cross-validation, where every other reading is foretold from the rest. What is smoothed
less steeply has noise in it that goes with it, and does not stand for the motion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import solveh_banded
from scipy.optimize import minimize_scalar
from scipy.sparse import diags_array

SLOWEST, FASTEST = 2.0, 9.0  # Hz, between which half of a body's motion may be left: it swings at 1 to 3
LIVELY = 8.0  # s of the most motion, by which it is found,
OFTEN = 0.02  # s, from readings that are means over so long where they are more frequent
FEWEST = 8  # readings that are smoothed at all
APART = 1.0  # s of a gap, over which readings tell nothing of each other: one that is longer counts as so long
DEGREE, STIFF = 5, 4  # of the B-splines, and of the derivative that counts
KNOTS = 0.025  # s between knots, a few in each swing
SLOPES = 0.0845  # ∫ x²/(1 + x⁸)² dx/π: the variance of a slope is so many times σ² dt ω_c³
FOUND = 0.05  # log frequency to which it is found


@dataclass(frozen=True)
class Swing:
    """A path (n,), its slope and its bend, and the standard deviation of the slope by the noise of the readings."""

    value: np.ndarray
    slope: np.ndarray
    bend: np.ndarray
    noise: float


def swing(time: np.ndarray, path: np.ndarray) -> Swing | None:
    """Of readings (n,) at rising times (n,) in s, NaN where there is none, also across gaps; None of too few."""
    there = np.isfinite(path)
    t, y = time[there], path[there]
    if len(t) < FEWEST:
        return None
    pressed = t[0] + np.cumsum(np.minimum(np.diff(t, prepend=t[0]), APART))
    time, t = np.interp(time, t, pressed), pressed
    step = float(np.median(np.diff(t)))
    limit = 2 * np.pi * half_left(t, y)
    spline = _spline(t, y, step, limit)
    value, slope, bend = (np.asarray(spline(time, nu)) for nu in range(3))
    sd = float(np.sqrt(np.mean((y - value[there]) ** 2)))
    return Swing(value, slope, bend, sd * float(np.sqrt(SLOPES * step * limit**3)))


def half_left(time: np.ndarray, path: np.ndarray) -> float:
    """The frequency (Hz) of which a spline that foretells these readings best leaves half."""
    t, y = _means(time, path)
    if len(t) < 2 * FEWEST:
        return FASTEST
    t, y = _liveliest(t, y)
    step = 2 * float(np.median(np.diff(t)))

    def missed(log_frequency: float) -> float:
        limit, squares = 2 * np.pi * float(np.exp(log_frequency)), 0.0
        for kept, left in ((slice(0, None, 2), slice(1, -1, 2)), (slice(1, None, 2), slice(2, -1, 2))):
            squares += float(np.sum((y[left] - _spline(t[kept], y[kept], step, limit)(t[left])) ** 2))
        return squares

    bounds = np.log([SLOWEST, FASTEST])
    return float(np.exp(minimize_scalar(missed, bounds=bounds, method="bounded", options={"xatol": FOUND}).x))


def _spline(t: np.ndarray, y: np.ndarray, step: float, limit: float) -> BSpline:
    """Of readings (n,) that are `step` apart, half left at `limit` (rad/s)."""
    count = max(STIFF + 1, round((t[-1] - t[0]) / KNOTS))
    apart, coefficients = (t[-1] - t[0]) / count, count + DEGREE
    knots = t[0] + apart * np.arange(-DEGREE, count + DEGREE + 1)
    knots[-DEGREE - 1] = max(knots[-DEGREE - 1], t[-1])  # the last reading is inside, however times are rounded
    waves = BSpline.design_matrix(t, knots, DEGREE)
    binomial = np.poly(np.ones(STIFF))  # of differences
    bends = diags_array(binomial, offsets=range(STIFF + 1), shape=(coefficients - STIFF, coefficients))
    weight = apart ** (1 - 2 * STIFF) / (step * limit ** (2 * STIFF))
    normal = (waves.T @ waves + weight * (bends.T @ bends)).tocsr()
    band = np.zeros((DEGREE + 1, coefficients))
    for k in range(DEGREE + 1):
        band[k, : coefficients - k] = normal.diagonal(-k)
    return BSpline(knots, solveh_banded(band, waves.T @ y, lower=True), DEGREE)


def _means(t: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means of as many neighbours as make one reading of OFTEN."""
    k = max(1, round(OFTEN / float(np.median(np.diff(t)))))
    n = len(t) // k * k
    return t[:n].reshape(-1, k).mean(axis=1), y[:n].reshape(-1, k).mean(axis=1)


def _liveliest(t: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """So many seconds of readings in which there is most motion."""
    n = round(LIVELY / float(np.median(np.diff(t))))
    if n >= len(t):
        return t, y
    power = np.concatenate([[0.0], np.cumsum(np.gradient(y, t) ** 2)])
    at = int(np.argmax(power[n:] - power[:-n]))
    return t[at : at + n], y[at : at + n]
