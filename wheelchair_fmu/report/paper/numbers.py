"""Numbers in the text of a supplement."""

from __future__ import annotations

from math import log10

from ...quantities import UNITS, Unit
from ..words import value_text

WORDS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")


def amount(value: float, se: float | None, unit: str) -> str:
    """A value in the SI unit of this name, with a standard deviation if there is one; angles in degrees: "80 ± 2 kg"."""
    return value_text(value, se, UNITS.get(unit, Unit(unit)))


def read_out(value: float, unit: str) -> str:
    """A figure with three digits in the unit that it is in already."""
    shown = f"{value:#.3g}".rstrip(".").replace("-", "−")
    return f"{shown} {unit.replace('.', ' ').replace('2', '²')}" if unit != "1" else shown


def ends(lower: float, upper: float, se: float, unit: str) -> str:
    """An interval in the SI unit of this name, to the place that the standard error reaches: "1.582 to 1.631 N"."""
    low, high = (amount(value, se, unit).partition(" ± ") for value in (lower, upper))
    name = high[2].partition(" ")
    return f"{low[0]} to {high[0]}{name[1]}{name[2]}"


def power(value: float) -> str:
    """A power of ten as mathematics."""
    return f"$10^{{{round(log10(value))}}}$"


def number(n: int) -> str:
    """ "seven", "13"."""
    return WORDS[n] if n < len(WORDS) else str(n)


def several(n: int, thing: str) -> str:
    """ "one run", "seven runs"."""
    return f"{number(n)} {thing}{'' if n == 1 else 's'}"


def chance(p: float) -> str:
    """A probability; none is said to be certain."""
    if p > 0.999:
        return "more than 0.999"
    return "less than 0.001" if p < 0.001 else f"{p:.3f}" if p > 0.99 or p < 0.01 else f"{p:.2f}"


def seconds(duration: float) -> str:
    return f"{duration:.1f} s" if duration < 600 else f"{duration / 60:.0f} min"


def capital(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}"
