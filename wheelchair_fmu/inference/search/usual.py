"""How large an effect is whose law was adjusted: as large as by its usual law it would have to be, to do as much.

Where data tell only what an effect does, its size and a constant of its law trade one for the other: half the torque on a patch
of twice the length does the same to a chair that rolls. What an effect does is what they tell well, and what δ is a size of. So
a size θ counts as λ θ, where λ is how much longer the signature is by the law as it was adjusted than by the usual one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...errors import SimulationError
from ..estimation.problem import Fit, prior_of
from ..models.hypothesis import Model
from ..models.models import Models


@dataclass(frozen=True)
class Usual:
    """Sizes (k,) by usual laws, which of a fit's values they are `own` to (k,), and how values move where these sizes stand
    for the adjusted ones: `slopes` (n, n)."""

    size: np.ndarray
    own: list[int]
    slopes: np.ndarray

    def moved(self, covariance: np.ndarray) -> np.ndarray:
        """The covariance (n, n) of a fit's values with these sizes among them."""
        return self.slopes @ covariance @ self.slopes.T


def usual(models: Models, found: Model, names: Sequence[str]) -> Usual:
    """Sizes of effects of a model, by `names` of their parameters (k,), less what a model without them has. As they are where
    no constant was adjusted, or where the model cannot run by the usual law."""
    w, fit = models.factory, found.fit
    own = [fit.names.index(n) for n in names]
    size = np.array([fit.values[n] for n in names]) - w.unfitted(names)
    slopes = np.eye(len(fit.names))
    for effect in dict.fromkeys(e for e in found.effects for n in names if n in w.parameters(e)):
        of_it = [i for i, n in enumerate(names) if n in w.parameters(effect)]
        constants = sorted(w.constants(effect).intersection(fit.names))
        if not constants or not size[of_it].any():
            continue
        try:
            longer, by_constant = _longer(models, found, [names[i] for i in of_it], size[of_it], constants)
        except SimulationError:
            continue
        at = [own[i] for i in of_it]
        slopes[np.ix_(at, [fit.names.index(c) for c in constants])] = longer * np.outer(size[of_it], by_constant)
        slopes[at, at] = longer
        size[of_it] *= longer
    return Usual(size, own, slopes)


def _longer(
    models: Models, found: Model, names: Sequence[str], size: np.ndarray, constants: Sequence[str]
) -> tuple[float, np.ndarray]:
    """How much longer an effect's signature is by its law as it was adjusted than by the usual one, and the slopes (m,) of its
    logarithm by the constants."""
    fit, likelihood = found.fit, models.likelihood(found.effects)
    prior = prior_of(likelihood, constants)
    plain = {**fit.values, **dict(zip(constants, prior.mean.tolist(), strict=True))}
    signature = _columns(fit, names) @ size
    length = float(signature @ signature)
    by_constant = _columns(fit, constants).T @ signature / length if length else np.zeros(len(constants))

    def norm(values: Mapping[str, float]) -> float:
        """Of the signature anew: a fit's runs may start elsewhere, from where casters go another way."""
        return float(np.linalg.norm(likelihood.evidence(models.campaign.fit, values, names).S @ size))

    adjusted, usually = (norm(fit.values), norm(plain)) if plain != fit.values else (1.0, 1.0)
    return (adjusted / usually, by_constant) if adjusted and usually else (1.0, np.zeros(len(constants)))


def _columns(fit: Fit, names: Sequence[str]) -> np.ndarray:
    return fit.evidence.S[:, [fit.evidence.by.index(n) for n in names]]
