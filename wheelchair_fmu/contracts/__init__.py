"""What every effect has to keep, bundled or a user's own: one function per contract, each of which returns its breaches."""

from __future__ import annotations

import re
import traceback
from collections.abc import Callable

import numpy as np

from ..errors import WheelchairError
from ..model.stage import Effect
from .inertia import inertia
from .motion import mirror, neutral, passive, present
from .record import record
from .smooth import derivative, finite
from .subject import NOT_OF_NUMBERS, Breach, Subject
from .units import units

__all__ = ["CLAIMS", "CONTRACTS", "Breach", "Subject", "breaches"]

CONTRACTS: tuple[Callable[[Subject], list[Breach]], ...] = (units, neutral, present, inertia, finite, derivative, passive)
LISTED = "`wheelchair effects quantities` lists what a law may read and act on"
WHOLE = "give one number, or one for each component of what it acts on"
PLACE = re.compile(r"^\S+\.[ch]pp:\d+: ")  # in CasADi's source
CLAIMS = (mirror,)  # asked where a parameter says what it becomes in a mirror


def breaches(effect: Effect) -> list[Breach]:
    """Every contract that an effect breaks; of one whose record is faulty, or that gives no equations, these faults."""
    if found := record(effect):
        return found
    try:
        with np.errstate(all="ignore"):  # what is not finite is a breach, and no warning beside
            subject = Subject.of([effect])
            asked = (*CONTRACTS, *(CLAIMS if any(p.mirror_given for p in effect.parameters) else ()))
            return [breach for contract in asked for breach in contract(subject)]
    except WheelchairError as error:
        fact, _, known = str(error).partition("; ")
        cure = LISTED if known.startswith("known") else known or WHOLE
        return [Breach(effect.id, "equations", fact.removeprefix(f"effect {effect.id} "), cure)]
    except Exception as error:  # what somebody else's law may raise
        return [
            Breach(
                effect.id,
                "equations",
                f"its law fails{_line(effect, error)}: {type(error).__name__}: {_last(error)}",
                NOT_OF_NUMBERS,
            )
        ]


def _line(effect: Effect, error: Exception) -> str:
    """Where in the effect's file it happened."""
    laws = [*(c.law for c in effect.contributions), *(law for r in effect.rows for law in r.laws)]
    files = {law.__code__.co_filename for law in laws if hasattr(law, "__code__")}
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename in files]
    return f" in line {lines[-1]}" if lines else ""


def _last(error: Exception) -> str:
    """The sentence of a message, of which CasADi's is the last line."""
    last = (str(error).strip().splitlines() or ["no reason given"])[-1]
    return PLACE.sub("", last.strip()).rstrip(".")
