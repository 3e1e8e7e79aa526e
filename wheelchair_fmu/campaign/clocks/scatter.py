"""How much a sum of readings that hang together scatters."""

from __future__ import annotations

import numpy as np

_NORMAL = 1.96


def long_run(scores: np.ndarray, whitened: bool = True) -> tuple[float, float]:
    """Variance of the sum of scores (n,), which may hang together over time, and the factor by which a standard error from it
    is to be widened.

    Newey and West (1987) with the Bartlett kernel, if wanted after whitening by a first-order autoregression (Andrews and
    Monahan 1992), and with the bandwidth of Andrews (1991) for what is left. The factor makes up
    for the lags that a short record does not
    show: critical values of Kiefer and Vogelsang (2005), table 1, beside those of the normal distribution.
    """
    s = np.asarray(scores, float)
    n = len(s)
    if n < 4 or not np.any(s):
        return float(s @ s), 1.0
    a = float(np.clip((s[1:] @ s[:-1]) / (s @ s), -0.97, 0.97)) if whitened else 0.0
    e = s[1:] - a * s[:-1]
    lags = _bandwidth(e)
    total = float(e @ e)
    for k in range(1, lags + 1):
        total += 2 * (1 - k / (lags + 1)) * float(e[k:] @ e[:-k])
    variance = total / (1 - a) ** 2 * n / (n - 1)
    b = (lags + 2 * max(a, 0.0) / (1 - a)) / n  # the whitening looks as far back, too
    return variance, (_NORMAL + 2.9694 * b + 0.4160 * b**2 - 0.5324 * b**3) / _NORMAL


def _bandwidth(e: np.ndarray) -> int:
    r = float(np.clip((e[1:] @ e[:-1]) / (e @ e), -0.97, 0.97))
    alpha = 4 * r**2 / ((1 - r) ** 2 * (1 + r) ** 2)
    return int(min(np.ceil(1.1447 * (alpha * len(e)) ** (1 / 3)), len(e) // 3))


def memory(series: np.ndarray) -> float:
    """How many samples of a series (n,) count as one, at least 1: variance of its mean beside that of white noise."""
    s = series[np.isfinite(series)]
    s = s - s.mean() if len(s) else s
    power = float(s @ s)
    if len(s) < 4 or power == 0:
        return 1.0
    n = len(s)
    spectrum = np.abs(np.fft.rfft(s, 2 * n)) ** 2
    rho = np.fft.irfft(spectrum)[:n] / power
    total, lag = 1.0, 1
    while lag + 1 < n and (pair := rho[lag] + rho[lag + 1]) > 0:  # Geyer's (1992) initial positive sequence
        total += 2 * pair
        lag += 2
    return float(max(1.0, min(total, n / 4)))
