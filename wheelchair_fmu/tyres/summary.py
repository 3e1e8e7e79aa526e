"""What was identified, as plain data in SI units: pressure in Pa, angles in rad."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .across import STIFFNESSES, PowerLaw
from .fitting import CONFIDENCE, Estimate
from .identify import OF_PEAK, ConditionFit, CurveFit, Identified, dugoff_off
from .magic_formula import FORCE, TORQUE, MagicFormula
from .records import CAMBER, SLIP

PA = 1e5  # in a bar
UNITS = {
    "pressure": "Pa",
    "load": "N",
    "speed": "m/s",
    "angle": "rad",
    "C_lambda": "N/rad",
    "C_m_lambda": "N.m/rad",
    "C_phi": "N/rad",
    "C_m_phi": "N.m/rad",
    "c_p": "m",
    "mu": "1",
    "B": "1/rad",
    "force.D": "N",
    "torque.D": "N.m",
    "rms_force": "N",
    "rms_torque": "N.m",
    "force.rms": "N",
    "torque.rms": "N.m",
}
LINEAR = {"force": "F = C_lambda λ + C_phi φ", "torque": "M = −C_m_lambda λ + C_m_phi φ"}


def summary(found: Identified) -> dict[str, Any]:
    """Everything `wheelchair tyre fit --json` prints, but for the file's own warnings."""
    return {
        "conditions": [condition(fit, found.tolerance) for fit in found.conditions],
        "across": {
            tyre: {
                "laws": {
                    name: {"K": _told(law.K), "exponents": _all_told(law.exponents), "at": _at(law)}
                    for name, law in own.laws.items()
                },
                "speed_exponents": _all_told(own.speed),
            }
            for tyre, own in found.across.items()
        },
        "confidence": CONFIDENCE,
        "units": UNITS,
        "laws": LINEAR,
    }


def condition(fit: ConditionFit, tolerance: float) -> dict[str, Any]:
    """One condition; what the data do not support is null, and `warnings` say why."""
    c = fit.condition
    return {
        "tyre": c.tyre,
        "pressure": c.pressure * PA,
        "load": c.load,
        "speed": c.speed,
        "linear": _linear(fit, tolerance),
        "dugoff": _dugoff(fit),
        "magic_formula": {channel: _magic(fit.magic(SLIP, channel)) for channel in (FORCE, TORQUE)},
        "camber": {channel: _magic(fit.magic(CAMBER, channel)) for channel in (FORCE, TORQUE)},
        "curvature_force": {kind: _offset(fit.fits.get((kind, FORCE))) for kind in (SLIP, CAMBER)},
        "angles": {kind: len(f.curve.angle) for (kind, channel), f in fit.fits.items() if channel == FORCE},
        "warnings": list(fit.warnings),
    }


def _linear(fit: ConditionFit, tolerance: float) -> dict[str, Any]:
    values: dict[str, Any] = {}
    told: dict[str, dict[str, Any]] = {"se": {}, "interval": {}, "range": {}}
    for name, (kind, channel, sign) in STIFFNESSES.items():
        curve = fit.fits.get((kind, channel))
        K = None if curve is None else curve.K.scaled(sign)
        values[name] = None if K is None else K.value
        told["se"][name] = None if K is None else K.se
        told["interval"][name] = None if K is None else K.interval
        told["range"][name] = None if curve is None else {"angle": curve.linear_to, "exceeded": curve.ends}
    return {**values, **told, "tolerance": tolerance}


def _dugoff(fit: ConditionFit) -> dict[str, Any] | None:
    law = fit.dugoff
    if law is None:
        return None
    estimates = {"C_lambda": law.C_lambda, "mu": law.mu, "c_p": law.c_p}
    return {
        **{name: e and e.value for name, e in estimates.items()},
        "rms_force": law.rms_force,
        "rms_torque": law.rms_torque,
        "interval": {name: e and e.interval for name, e in estimates.items()},
        "off": {"of_peak": OF_PEAK, **{channel: dugoff_off(fit, channel) for channel in (FORCE, TORQUE)}},
    }


def _magic(law: MagicFormula | None) -> dict[str, Any] | None:
    if law is None:
        return None
    estimates = {"B": law.B, "C": law.C, "D": law.D, "E": law.E}
    return {
        **{name: e.value for name, e in estimates.items()},
        "rms": law.rms,
        "BCD": law.K.value,
        "interval": {**{name: e.interval for name, e in estimates.items()}, "BCD": law.K.interval},
        "misfit_p": law.misfit,
        "rests_on_prior": list(law.untold),
    }


def _offset(fit: CurveFit | None) -> dict[str, Any] | None:
    return None if fit is None else {"value": fit.curve.offset, "se": fit.curve.offset_se}


def _at(law: PowerLaw) -> dict[str, float]:
    return {name: value * (PA if name == "pressure" else 1.0) for name, value in law.at.items()}


def _told(e: Estimate) -> dict[str, Any]:
    return {"value": e.value, "se": e.se, "interval": e.interval}


def _all_told(estimates: Mapping[str, Estimate]) -> dict[str, Any]:
    return {name: _told(e) for name, e in estimates.items()}
