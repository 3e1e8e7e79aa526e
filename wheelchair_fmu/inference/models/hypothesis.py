"""What may be the case, as a value; and a model of it, fitted and held out."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ..estimation.problem import Fit
from ..evidence.evidence import Evidence
from .factory import members_of


@dataclass(frozen=True)
class Hypothesis:
    """That a chair has these effects, in whatever order they were found, and does `without` these nuisances, as an effect does
    the same."""

    effects: frozenset[str]
    without: frozenset[str] = frozenset()

    @classmethod
    def of(cls, effects: Iterable[str], without: frozenset[str] = frozenset()) -> Hypothesis:
        """That it has these, of groups all members."""
        return cls(frozenset(member for effect in effects for member in members_of(effect)), without)


@dataclass(frozen=True)
class Model:
    """A fit with these effects, and what it leaves of held-out runs."""

    effects: tuple[str, ...]
    fit: Fit
    heldout: Evidence
