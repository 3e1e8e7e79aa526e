"""From sweeps to laws: every condition by itself, then one law across load and pressure for each tyre."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import Failure
from . import magic_formula as magic_law
from .across import Across, across
from .dugoff import Dugoff, dugoff
from .fitting import Estimate
from .half_difference import Curve, corrected, pairs, pooled
from .magic_formula import FORCE, TORQUE, MagicFormula, magic_formula
from .records import SLIP, Condition, Sweep
from .slope import Slope, slope_of

TOLERANCE = 0.05  # of the measured curve: beyond it the linear law is not enough
REACH = np.radians(2.0)  # slips that stay below this say nothing about the bend
ODD = 1e-3  # a misfit that noise alone would show less often is worth a word
SMALL = 0.005  # of the peak: nobody minds a smaller misfit, however unlikely
UNITS = {FORCE: "N", TORQUE: "N m"}
OF_PEAK = 0.1  # of the largest torque or force: where Dugoff's law is off by more


@dataclass(frozen=True, eq=False)
class CurveFit:
    """One curve with its slope, its Magic Formula (None where it does not bend or is too short), and ranges in rad.

    `linear_to` is the angle beyond which the tangent at the origin is off by more than the tolerance; `ends` says that it
    was found, and is no mere end of the data.
    """

    curve: Curve
    slope: Slope
    magic: MagicFormula | None
    linear_to: float
    ends: bool

    @property
    def K(self) -> Estimate:
        """The slope at the origin: the tangent of a Magic Formula that fits, which no bend biases, or else a polynomial's."""
        return self.magic.K if self.magic and not _odd(self.magic) else self.slope.K


@dataclass(frozen=True, eq=False)
class ConditionFit:
    """All laws of one condition, by (SLIP or CAMBER, FORCE or TORQUE), and what the data could not support."""

    condition: Condition
    fits: Mapping[tuple[str, str], CurveFit]
    dugoff: Dugoff | None = None
    warnings: tuple[str, ...] = ()

    def K(self, kind: str, channel: str) -> Estimate | None:
        fit = self.fits.get((kind, channel))
        return None if fit is None else fit.K

    def magic(self, kind: str, channel: str) -> MagicFormula | None:
        fit = self.fits.get((kind, channel))
        return None if fit is None else fit.magic


@dataclass(frozen=True, eq=False)
class Identified:
    """Every condition, the law across load and pressure by tyre."""

    conditions: tuple[ConditionFit, ...]
    across: Mapping[str, Across]
    tolerance: float

    @property
    def tyres(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(c.condition.tyre for c in self.conditions))


def identify(sweeps: Sequence[Sweep], tolerance: float = TOLERANCE) -> Identified:
    """The laws of every condition. Raises Failure where no condition has a slip curve that can be fitted."""
    curves, complaints = _curves(sweeps)
    conditions = tuple(dict.fromkeys(s.condition for s in sweeps))
    fits = tuple(
        _condition(c, {k[1:]: v for k, v in curves.items() if k[0] == c}, tolerance, complaints.get(c, [])) for c in conditions
    )
    if not any(f.fits for f in fits):
        said = "\n".join(f"{f.condition}: {w}" for f in fits for w in f.warnings)
        raise Failure(f"nothing could be fitted:\n{said}")
    return Identified(fits, across(fits), tolerance)


Curves = dict[tuple[Condition, str, str], Curve]


def _curves(sweeps: Sequence[Sweep]) -> tuple[Curves, dict[Condition, list[str]]]:
    """The corrected curves of all sweeps, with the noise of all, and what is missing in them."""
    found: Curves = {}
    complaints: dict[Condition, list[str]] = {}
    for sweep in sweeps:
        paired = pairs(sweep.angle)
        said = complaints.setdefault(sweep.condition, [])
        if not len(paired.angle):
            said.append(
                f"{sweep.kind}: {_one_sided(sweep)}; measure every angle with both signs, so that the curvature force cancels"
            )
            continue
        if paired.alone:
            angles = ", ".join(f"{np.degrees(a):.3g}" for a in paired.alone)
            said.append(f"{sweep.kind}: {angles}° measured with one sign only and left out; measure the other sign too")
        for channel, measured in ((FORCE, sweep.force), (TORQUE, sweep.torque)):
            if np.isfinite(measured).all():
                curve = corrected(paired, measured)
                if curve.largest > 0:
                    found[sweep.condition, sweep.kind, channel] = curve
                else:
                    said.append(f"{sweep.kind}: the {channel} is the same at both signs of every angle; check the file")
            else:
                said.append(f"{sweep.kind}: no {channel} was measured; its laws are left out")
    for channel in (FORCE, TORQUE):
        keys = [key for key in found if key[2] == channel]
        found |= zip(keys, pooled([found[key] for key in keys]), strict=True)
    return found, complaints


def _one_sided(sweep: Sweep) -> str:
    signs = {float(s) for s in np.sign(sweep.angle)} - {0.0}
    if len(signs) == 1:
        return f"all angles are {'positive' if 1.0 in signs else 'negative'}"
    return "no angle was measured with both signs" if signs else "no angle differs from zero"


def _condition(
    condition: Condition, curves: Mapping[tuple[str, str], Curve], tolerance: float, said: list[str]
) -> ConditionFit:
    fits: dict[tuple[str, str], CurveFit] = {}
    for (kind, channel), curve in curves.items():
        slope = slope_of(curve, kind)
        doubt = _doubt(kind, channel, curve, slope)
        said += [doubt] if doubt else []
        magic = magic_formula(curve, slope.K.value, channel) if slope.bends and not doubt else None
        if magic is not None and _odd(magic):
            said.append(
                f"{kind} {channel}: the Magic Formula leaves {magic.rms:.3g} {UNITS[channel]} (rms), more than noise "
                f"of {curve.sigma:.2g}; look at the curve by `wheelchair tyre plot`"
            )
        fits[kind, channel] = CurveFit(curve, slope, magic, *_linear_range(curve, magic, tolerance))
    said += list(_signs(fits))
    return ConditionFit(condition, fits, _dugoff(condition, fits), tuple(said))


def _doubt(kind: str, channel: str, curve: Curve, slope: Slope) -> str | None:
    """Why the curve supports a slope and no more, or not even that. A camber curve may well be straight."""
    n, largest = len(curve.angle), float(np.degrees(curve.angle[-1]))
    what = f"{kind} {channel}: the slope only"
    if n < magic_law.FEWEST:
        return (
            f"{what}; {n} angle{'s' * (n > 1)} measured with both signs cannot tell how it bends, nor a Magic Formula's "
            f"four coefficients; measure {magic_law.FEWEST} or more"
        )
    ends = slope.K.interval
    if ends is not None and ends[0] * ends[1] <= 0:
        return f"{kind} {channel}: the slope is not told from zero; measure larger angles, or more of them"
    if kind == SLIP and curve.angle[-1] < REACH:
        return f"{what}; no angle beyond {largest:.3g}°, and tyres are still linear there; measure up to 5°"
    if kind == SLIP and not slope.bends:
        return f"{what}; up to {largest:.3g}° the curve bends less than the noise; measure more angles, or larger ones"
    return None


def _odd(magic: MagicFormula) -> bool:
    unlikely = magic.misfit is not None and magic.misfit < ODD
    return unlikely and magic.rms > SMALL * abs(magic.D.value)


def _signs(fits: Mapping[tuple[str, str], CurveFit]) -> list[str]:
    """Forces that point the wrong way: most likely other axes."""
    fit = fits.get((SLIP, FORCE))
    if fit is not None and fit.slope.K.value < 0:
        return [
            "the lateral force falls as the slip angle rises; the file's axes are not the paper's (y to the right): "
            "try --axes iso"
        ]
    return []


def _linear_range(curve: Curve, magic: MagicFormula | None, tolerance: float) -> tuple[float, bool]:
    """The angle at which the tangent first is off by `tolerance` of the fitted curve, or the end of the data."""
    end = float(curve.angle[-1])
    if magic is None:
        return end, False
    x = np.linspace(0, end, 2001)[1:]
    y = magic(x)
    off = np.flatnonzero(np.abs(magic.K.value * x - y) > tolerance * np.abs(y))
    return (float(x[off[0]]), True) if len(off) else (end, False)


def _dugoff(condition: Condition, fits: Mapping[tuple[str, str], CurveFit]) -> Dugoff | None:
    force, torque = fits.get((SLIP, FORCE)), fits.get((SLIP, TORQUE))
    if force is None or force.magic is None or force.K.value <= 0:
        return None
    return dugoff(force.curve, torque.curve if torque else None, force.K.value, condition.load)


def dugoff_off(fit: ConditionFit, channel: str) -> tuple[tuple[float, float], ...] | None:
    """Slip ranges (rad) where Dugoff's law is off the Magic Formula by more than OF_PEAK of its largest value."""
    magic = fit.magic(SLIP, channel)
    if fit.dugoff is None or magic is None or (channel == TORQUE and fit.dugoff.c_p is None):
        return None
    x = np.linspace(0, float(fit.fits[SLIP, channel].curve.angle[-1]), 2001)
    y = magic(x)
    law = fit.dugoff.force(x) if channel == FORCE else fit.dugoff.torque(x)
    off = np.abs(law - y) > OF_PEAK * np.abs(y).max()
    edges = np.flatnonzero(np.diff(np.r_[False, off, False].astype(int)))
    return tuple((float(x[a]), float(x[b - 1])) for a, b in edges.reshape(-1, 2))
