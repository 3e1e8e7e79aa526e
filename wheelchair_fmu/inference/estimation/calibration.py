"""What a fit made of the values it was given: each beside its prior, and which of them nobody should believe."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...quantities import Parameter
from ..evidence.likelihood import Likelihood
from .problem import REACH, Fit, Problem, sizes_an_effect
from .statistics import finite, standard_errors

DOUBTED = 2.0  # standard deviations of its prior by which a value is said to be off
SCALE, OF_THE_BODY = "rider.scale", 0.1  # and the share by which that may be off before anybody is told
CLOSE = 1e-3  # of a prior's standard deviation, or of a bound: as near as a fit comes to it


@dataclass(frozen=True)
class Calibrated:
    """A value as fitted, with its standard error, beside what was given, `prior` ± `prior_sd` (inf: nothing known).

    A fit goes no further than `lower` and `upper`; it is `at_bound` where it would have gone on, `beyond` where that is as far
    as a prior lets it go. What nobody has `given` is what chairs usually have.
    """

    record: Parameter
    value: float
    se: float
    prior: float
    prior_sd: float
    at_bound: bool
    lower: float = -np.inf
    upper: float = np.inf
    given: bool = True

    @property
    def off(self) -> float:
        """How far the value is from what was given, in standard deviations of that."""
        return (self.value - self.prior) / self.prior_sd

    @property
    def beyond(self) -> bool:
        """Would it be another chair, rather than one that was measured with an ordinary error? A constant of an effect's law is
        nobody's measurement: what the law does not do, however it is bent, is among what is left."""
        return abs(self.off) > REACH - CLOSE and not self.record.adjusted

    @property
    def words(self) -> str:
        """What there is to say of it; empty where it is as it was given."""
        unit = self.record.unit.behind
        value, prior, sd = _to_the_same_place(self.value, self.prior, self.prior_sd)
        told = f"{self.record.name} comes out at {value}{unit}"
        known = f"{prior} ± {sd}{unit} given" if self.given else f"usual {prior} ± {sd}{unit}"
        given = f"{abs(self.off):.1f} standard deviations from the {known}"
        if self.beyond:
            wrong = "the value given is wrong" if self.given else "the chair is no usual one"
            return f"{told}, {given}, where the search stops: {wrong}, or it stands in for what the model lacks"
        if self.at_bound:
            told = f"{self.record.name} comes out at {self.value:.3g}{unit}"  # as it may be far below what was known of it
            return f"{told}, at its bound: it stands in for what the model lacks, or the data say little of it"
        return f"{told}, {given}" if self.bent else ""

    @property
    def bent(self) -> bool:
        """Is it further from what was given than a value that was measured well usually is?"""
        return abs(self.off) > DOUBTED

    def as_json(self) -> dict[str, Any]:
        """The keys of one value in `calibration`."""
        return {
            "value": self.value,
            "se": self.se,
            "prior": self.prior,
            "prior_sd": self.prior_sd if np.isfinite(self.prior_sd) else None,
            "at_bound": self.at_bound,
            "beyond": self.beyond,
            "lower": finite(self.lower),
            "upper": finite(self.upper),
        }


def calibration(likelihood: Likelihood, found: Fit) -> list[Calibrated]:
    """Every calibrated value of a fit, in the fit's order, with constants of effects that it has adjusted; sizes of effects and
    offsets of sensors are not among them, nor generic terms, which no likelihood of the search knows."""
    told = [n for n in found.names if n in likelihood.records and not n.startswith("offset.")]
    names = [n for n in told if not sizes_an_effect(likelihood, n)]
    problem, errors = Problem(likelihood, names), standard_errors(found)
    out = []
    for i, name in enumerate(names):
        value, sd = found.values[name], float(problem.prior.sd[i])
        record, mean = likelihood.records[name], float(problem.prior.mean[i])
        reach = (float(problem.lower[i]), float(problem.upper[i]))
        stopped = at_bound(record, value, mean, sd, reach)
        given = name in likelihood.campaign.known or name in likelihood.variant.values or name in likelihood.campaign.priors
        out.append(Calibrated(record, value, errors[name], mean, sd, stopped, *reach, given))
    return out


def _to_the_same_place(value: float, prior: float, sd: float) -> tuple[str, str, str]:
    """A value and what was given to the second digit of its standard deviation; to four digits where nothing is known."""
    if not np.isfinite(sd):
        return f"{float(f'{value:.4g}'):.9g}", f"{float(f'{prior:.4g}'):.9g}", f"{sd:g}"
    place = 1 - int(np.floor(np.log10(sd)))
    return f"{round(value, place):.9g}", f"{round(prior, place):.9g}", f"{float(f'{sd:.2g}'):.9g}"


def at_bound(record: Parameter, value: float, prior: float, prior_sd: float, reach: tuple[float, float]) -> bool:
    """Does a fitted value lie at an end of what a fit may `reach`: at a bound of its record's, or as far off as its prior lets
    it? One that is as it was given has not been stopped there."""
    near = CLOSE * (prior_sd if np.isfinite(prior_sd) else record.smallest_interesting or record.nominal or 1.0)
    inside = reach[0] + near < value < reach[1] - near
    return not inside and abs(value - prior) > near


def of_the_body(found: Sequence[Calibrated]) -> list[str]:
    """A sentence where the rider's body counts for more, or less, than was measured of it."""
    return [
        f"the rider's body counts {c.value:.2g} ± {c.se:.1g} times as much as was measured of it"
        + ("; what was measured may be a part of what moves" if c.value > 1 else "")
        for c in found
        if c.record.name == SCALE and abs(c.value - 1) > max(DOUBTED * c.se, OF_THE_BODY)
    ]


def doubts(found: Sequence[Calibrated]) -> list[str]:
    """A sentence for each value that is at a bound or far from what was given."""
    return [c.words for c in found if c.words]
