"""What the contracts are asked about: a model with effects, and the same without."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..model.stage import Effect
from ..model.wheelchair import Choice, Model, assemble

NOT_OF_NUMBERS = "write it of quantities, numbers and CasADi's functions, without if"  # the cure of a law that raises an error


@dataclass(frozen=True)
class Breach:
    """A contract that an effect, or a law, breaks: the fact, with numbers and units, and the cure."""

    effect: str
    contract: str
    fact: str
    cure: str
    kind: str = "effect"  # or which law: "tyre law", "caster law", "wheel law"

    def __str__(self) -> str:
        return f"{self.kind} {self.effect}, {self.contract}: {self.fact}; {self.cure}"


@dataclass(frozen=True)
class Subject:
    """A model with these effects, by the laws that they need, and the `bare` one that has none."""

    effects: tuple[Effect, ...]
    model: Model
    bare: Model

    @classmethod
    def of(cls, effects: Iterable[Effect]) -> Subject:
        """Raises whatever the effects' laws raise, and ModelError or UsageError where one does not fit the model."""
        effects = tuple(effects)
        choice = Choice().with_laws({kind: law for effect in effects for kind, law in effect.needs.items()})
        return cls(effects, assemble(choice, effects), _bare(choice))

    @property
    def id(self) -> str:
        return ", ".join(effect.id for effect in self.effects) or "none"

    def values(self, size: float) -> np.ndarray:
        """Parameters (np,): the effects' at `size` times their smallest interesting size, within bounds; the rest as usual."""
        return np.array(
            [
                q.default if q.smallest_interesting is None else min(max(size * q.smallest_interesting, q.lower), q.upper)
                for q in self.model.parameters
            ]
        )

    def breach(self, contract: str, fact: str, cure: str) -> Breach:
        return Breach(self.id, contract, fact, cure)


@cache
def _bare(choice: Choice) -> Model:
    return assemble(choice)
