"""The lag between two clocks at which what one device saw follows from what the other saw.

One or several equations share the lag s. Each says of device A's clock t

    target(t) = Σ gain_k · seen_k(t − s) + Σ coefficient_j · own_j(t) + rest,

where `seen` are signals of device B and `own` are known on A's clock (a constant, a speed that drags). Gains and coefficients
are linear and are solved for at each s; s itself is looked for among all lags first, and then by Gauss and Newton.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .equation import Equation
from .fine import refine
from .profile import profile
from .scatter import memory

SURE = 12.0  # log likelihood ratio by which the best lag must be ahead of any other: 1 in 1e5
CRYSTAL = 50e-6  # s/s by which two clocks usually differ: a drift that is known less well is better left at 0
HOPEFUL = 20.0  # times as unsure it may seem before it is looked for: a drift that is there makes it seem so
SERIOUS = 0.5  # share of the best log likelihood that another lag has that is worth a look
WIDE = 3  # grid steps that a maximum is wide


@dataclass(frozen=True, eq=False)
class Lag:
    """`seconds` s and its standard error; `unique` where no other lag comes near; `correlation` of target and what `seen` says
    of it (after `own`); `gains` by equation; `rival` is the next best lag (s) and `ahead` how far it is behind in log
    likelihood; `drift` is the rate at which s grows, s/s, with its standard error, 0 where the record is too short to tell it
    better than crystals are made; `middle` is where (s, A's clock) the lag is s: elsewhere it is s + drift · (t − middle)."""

    seconds: float
    se: float
    unique: bool
    correlation: float
    gains: tuple[np.ndarray, ...]
    ahead: float
    rival: float | None
    drift: float
    drift_se: float
    middle: float
    overlap: float

    def at_zero(self) -> tuple[float, float]:
        """The lag at time 0 of A's clock, and its standard error."""
        unsure = self.drift_se if self.drift else CRYSTAL
        return self.seconds - self.drift * self.middle, float(np.hypot(self.se, unsure * self.middle))


def find(equations: Sequence[Equation]) -> Lag | None:
    """The lag of these equations, or None where the records share too little, or nothing."""
    lags, support, better = profile(equations)
    if not np.isfinite(better).any() or np.nanmax(better) <= 0:
        return None
    best, step = int(np.nanargmax(better)), float(lags[1] - lags[0])
    fine = refine(equations, float(lags[best]), step)
    if fine is None:
        return None
    drifting = refine(equations, fine.seconds, step, fine) if fine.drift_se < HOPEFUL * CRYSTAL else None
    if drifting is not None and drifting.drift_se < CRYSTAL:
        fine = drifting
    thin = 1 / float(np.mean([memory(p.rest) for p in fine.parts]))
    rival, ahead = _rival(support, better, best)
    rest, whole = (
        sum(w * x for w, x in zip(fine.weights, xs, strict=True))
        for xs in ([p.rest_power for p in fine.parts], [p.power for p in fine.parts])
    )
    return Lag(
        fine.seconds,
        fine.se,
        thin * ahead > SURE,
        float(np.sqrt(max(0.0, 1 - rest / whole))),
        tuple(p.gains for p in fine.parts),
        thin * ahead,
        None if rival is None else float(lags[rival]),
        fine.drift,
        fine.drift_se,
        fine.middle,
        float(support[best]),
    )


def summits(heights: np.ndarray) -> np.ndarray:
    """Where a profile (n,) is higher than on both sides; of a flat top its middle, and no end. These are the peaks of
    `scipy.signal`, which takes longer to load than all clocks of a campaign to find."""
    first = np.flatnonzero(np.diff(heights, prepend=np.nan) != 0)  # of each stretch of equal heights
    last = np.append(first[1:], len(heights)) - 1
    up = np.diff(heights[first]) > 0
    top = np.flatnonzero(up[:-1] & ~up[1:]) + 1
    return (first[top] + last[top]) // 2


def _rival(support: np.ndarray, better: np.ndarray, best: int) -> tuple[int | None, float]:
    """The maximum of a profile that comes nearest to the best, and by how much it is behind over as long a time as it shares:
    strokes that are all alike fit as well one stroke later, in a record that is one stroke shorter."""
    peaks = summits(np.nan_to_num(better, nan=-1.0))
    others = peaks[(np.abs(peaks - best) > WIDE) & (better[peaks] > SERIOUS * better[best])]
    if not len(others):
        return None, float(better[best])
    due = np.minimum(support[others] / support[best], 1.0) * better[best]
    behind = due - np.maximum(better[others], 0.0)
    nearest = int(np.argmin(behind))
    return int(others[nearest]), float(behind[nearest])
