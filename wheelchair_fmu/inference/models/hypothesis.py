"""What may be the case, as a value; and a model of it, fitted and held out."""

from __future__ import annotations

from dataclasses import dataclass

from ..estimation.fit import Fit
from ..evidence.evidence import Evidence


@dataclass(frozen=True)
class Hypothesis:
    """That a chair has these effects, in the order found, and does `without` these nuisances, as an effect does the same."""

    effects: tuple[str, ...]
    without: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Model:
    """A fit with these effects, and what it leaves of held-out runs."""

    effects: tuple[str, ...]
    fit: Fit
    heldout: Evidence
