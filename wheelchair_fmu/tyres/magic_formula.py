"""Fitting the Magic Formula (1) to one curve.

A rig that stops before the peak cannot tell the peak D from the shapes C and E: many sets give the same curve. So each has a
mild prior, wide enough to yield to any curve that tells it, and what the data did not tell is named.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..model.tyre.common import PARAMETERS
from . import laws
from .fitting import Estimate, Fit, Prior, Shape, bent, estimate, positive
from .half_difference import Curve

FEWEST = 6  # settings for four numbers and something to judge them by
FORCE, TORQUE = "force", "torque"
PEAK = 1.2  # how far above the largest measured value the peak is expected, within a factor of e^SPREAD
SPREAD = 0.4
DEVIATION = {"C": 0.3, "E": 2.0}  # of ln C and of E
TOLD = 0.5  # of the prior's deviation: a number that stays less certain than this, the data have not told
_SHAPE = Shape(np.array([True, True, True, False]))  # ln K, ln C, ln D, E
_BOUNDS = {p.name: p for p in PARAMETERS}


@dataclass(frozen=True, eq=False)
class MagicFormula:
    """Y = D sin(C atan(B x − E (B x − atan B x))): B [1/rad], C, D [unit of Y, with its sign], E, and K = B C D."""

    B: Estimate
    C: Estimate
    D: Estimate
    E: Estimate
    K: Estimate
    rms: float
    misfit: float | None
    untold: tuple[str, ...]  # of C, D and E, those that rest on the prior

    def __call__(self, angle: np.ndarray) -> np.ndarray:
        """Y (n,) at angles (n,) rad."""
        sign = np.sign(self.D.value)
        numbers = np.array([sign * self.K.value, self.C.value, sign * self.D.value, self.E.value])
        return sign * laws.evaluate("magic", angle, numbers)


def magic_formula(curve: Curve, slope: float, kind: str) -> MagicFormula:
    """The fit to a curve whose slope at the origin is about `slope`; `kind` is FORCE or TORQUE."""
    sign = 1.0 if slope >= 0 else -1.0
    upright = Curve(curve.angle, sign * curve.value, curve.sigma, curve.freedom, curve.offset, curve.offset_se)
    prior = _prior(upright, abs(slope), kind)
    starts = [
        np.array([prior.mean[0], np.log(C), prior.mean[2] + up, E])
        for C, up, E in ((1.3, 0.0, 0.0), (2.0, -0.1, 0.0), (1.0, 0.4, -2.0), (2.0, 0.2, 0.5))
    ]
    return _told(bent(upright, "magic", starts, prior, _SHAPE), prior, sign)


def _prior(curve: Curve, slope: float, kind: str) -> Prior:
    C, E = _BOUNDS[f"tyre.{kind}.C"], _BOUNDS[f"tyre.{kind}.E"]
    top = np.log(curve.largest)
    steep = np.log(slope)
    return Prior(
        lower=np.array([steep - 2, np.log(C.lower), top - 0.5, E.lower]),
        upper=np.array([steep + 2, np.log(C.upper), top + 3, E.upper]),
        mean=np.array([steep, np.log(C.default), top + np.log(PEAK), E.default]),
        deviation=np.array([np.inf, DEVIATION["C"], SPREAD, DEVIATION["E"]]),
    )


def _told(fit: Fit, prior: Prior, sign: float) -> MagicFormula:
    names = ("K", "C", "D", "E")
    S = fit.covariance
    v = dict(zip(names, (None,) * 4 if S is None else np.diag(S), strict=True))
    z = dict(zip(names, fit.numbers, strict=True))
    of_B = np.array([1.0, -1.0, -1.0, 0.0])  # B = K / (C D)
    untold = tuple(
        n
        for n, d in zip(names[1:], prior.deviation[1:], strict=True)
        if (variance := v[n]) is None or variance > (TOLD * d) ** 2
    )
    return MagicFormula(
        B=positive(float(of_B @ fit.numbers), None if S is None else float(of_B @ S @ of_B), fit.freedom),
        C=positive(z["C"], v["C"], fit.freedom),
        D=positive(z["D"], v["D"], fit.freedom).scaled(sign),
        E=estimate(float(z["E"]), v["E"], fit.freedom),
        K=positive(z["K"], v["K"], fit.freedom).scaled(sign),
        rms=fit.rms,
        misfit=fit.misfit,
        untold=untold,
    )
