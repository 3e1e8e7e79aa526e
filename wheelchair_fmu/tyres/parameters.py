"""One condition of one tyre as parameters of the chair, so that the FMU gives the fitted curve.

The model knows a tyre at 4 bar and scales it by (p/4 bar)^n, so C_λ and C_mλ are carried to 4 bar by the exponents that are
written beside them. The effect `load_sensitivity` is switched on where the rig varied the load; at the rig's own load it is 1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..errors import Failure, UsageError, unknown
from ..model.tyre.common import PARAMETERS, RATED
from ..model.variant import LAWS, Variant
from .across import REFERENCES
from .identify import ConditionFit, Identified
from .magic_formula import FORCE, TORQUE
from .records import CAMBER, KM_H, SLIP

CLOSE = 0.02  # relative: a condition that was asked for and one that was tested
BOUNDS = {p.name: p for p in PARAMETERS}


def chosen(
    found: Identified, tyre: str | None, pressure: float | None, load: float | None, speed: float | None
) -> ConditionFit:
    """The condition asked for [bar, N, m/s]; what is left open is taken nearest to 4 bar, 400 N and 4 km/h.

    Raises UsageError, with the conditions there are, where there is no such one, or several tyres to choose from.
    """
    if tyre is None and len(found.tyres) > 1:
        raise UsageError(f"the file has tyres {', '.join(found.tyres)}; choose one by --tyre")
    tyre = tyre if tyre is not None else found.tyres[0]
    if tyre not in found.tyres:
        raise unknown("tyre", tyre, found.tyres)
    fits = [f for f in found.conditions if f.condition.tyre == tyre]
    for name, wanted in (("pressure", pressure), ("load", load), ("speed", speed)):
        values = np.array([getattr(f.condition, name) for f in fits])
        target = REFERENCES[name] if wanted is None else wanted
        least = float(np.abs(values - target).min())
        if wanted is not None and least > CLOSE * abs(target):
            raise UsageError(
                f"no test at {_shown(name, wanted)} among those that fit the rest; there are "
                f"{', '.join(sorted({_shown(name, v) for v in values}))}"
            )
        fits = [f for f, v in zip(fits, values, strict=True) if abs(v - target) <= least + 1e-9]
    return fits[0]


def _shown(name: str, value: float) -> str:
    factor, unit = {"pressure": (1.0, "bar"), "load": (1.0, "N"), "speed": (1 / KM_H, "km/h")}[name]
    return f"{value * factor:.4g} {unit}"


def chair(found: Identified, fit: ConditionFit, law: str) -> Variant:
    """The variant with this tyre under this law of the model, and notes on where its values come from.

    Raises UsageError for an unknown law and Failure where the data do not support it.
    """
    if law not in LAWS["tyre"]:
        raise unknown("tyre law", law, LAWS["tyre"])
    values = {"tyre.pressure": fit.condition.pressure, **_law_values(fit, law), **_camber(fit)}
    exponents = {name: own.exponents for name, own in found.across[fit.condition.tyre].laws.items()}
    for stiffness, name in (("C_lambda", "tyre.pressure_F"), ("C_m_lambda", "tyre.pressure_M")):
        exponent = BOUNDS[name].default
        if "pressure" in exponents.get(stiffness, {}):
            exponent = values[name] = exponents[stiffness]["pressure"].value
        if f"tyre.{stiffness}" in values:
            values[f"tyre.{stiffness}"] *= (RATED / fit.condition.pressure) ** exponent
        if "tyre.c_p" in values:  # the trail is the torque's stiffness over the force's
            values["tyre.c_p"] *= (RATED / fit.condition.pressure) ** (exponent if stiffness == "C_m_lambda" else -exponent)
    if "load" in exponents.get("C_lambda", {}):
        values["effect.load_sensitivity.exponent"] = exponents["C_lambda"]["load"].value
        values["effect.load_sensitivity.N_ref"] = fit.condition.load
        if "load" in exponents.get("C_m_lambda", {}):
            values["effect.load_sensitivity.exponent_M"] = exponents["C_m_lambda"]["load"].value
    return replace(Variant().with_values({**values, "tyre.law": law}), notes=_notes(fit, law))


def _law_values(fit: ConditionFit, law: str) -> dict[str, float]:
    return {"linear": _linear, "dugoff": _dugoff, "magic_formula": _magic}[law](fit)


def _linear(fit: ConditionFit) -> dict[str, float]:
    force, torque = fit.K(SLIP, FORCE), fit.K(SLIP, TORQUE)
    if force is None:
        raise _unsupported(fit, "linear")
    values = {"tyre.C_lambda": force.value}
    return values if torque is None else {**values, "tyre.C_m_lambda": -torque.value}  # (15)


def _dugoff(fit: ConditionFit) -> dict[str, float]:
    law = fit.dugoff
    if law is None:
        raise _unsupported(fit, "Dugoff")
    values = {"tyre.C_lambda": law.C_lambda.value, "tyre.mu": law.mu.value}
    return values if law.c_p is None else {**values, "tyre.c_p": law.c_p.value}


def _magic(fit: ConditionFit) -> dict[str, float]:
    force, torque = fit.magic(SLIP, FORCE), fit.magic(SLIP, TORQUE)
    if force is None:
        raise _unsupported(fit, "Magic Formula")
    values = {
        "tyre.C_lambda": force.K.value,
        "tyre.mu": force.D.value / fit.condition.load,
        "tyre.force.C": force.C.value,
        "tyre.force.E": force.E.value,
    }
    if torque is not None:
        values |= {
            "tyre.C_m_lambda": -torque.K.value,
            "tyre.torque.C": torque.C.value,
            "tyre.torque.D": -torque.D.value,
            "tyre.torque.E": torque.E.value,
        }
    return values


def _camber(fit: ConditionFit) -> dict[str, float]:
    stiffness = {"tyre.C_phi": fit.K(CAMBER, FORCE), "tyre.C_m_phi": fit.K(CAMBER, TORQUE)}
    return {name: K.value for name, K in stiffness.items() if K is not None}


def _unsupported(fit: ConditionFit, law: str) -> Failure:
    why = f" ({fit.warnings[0]})" if fit.warnings else ""
    cure = "measure side slip, too" if fit.K(SLIP, FORCE) is None else "choose --law linear"
    return Failure(f"{fit.condition}: the data do not support the {law} law{why}; {cure}")


def _notes(fit: ConditionFit, law: str) -> Mapping[str, Any]:
    c = fit.condition
    return {
        "origin": {
            "tyre": c.tyre,
            "law": law,
            "pressure_bar": c.pressure,
            "load_N": c.load,
            "speed_m_s": c.speed,
            "warnings": list(fit.warnings),
        }
    }
