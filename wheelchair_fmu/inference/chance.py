"""Chances of χ² and Student's t, by `scipy.special`: `scipy.stats` has the same under better names, and takes a quarter of a
second to import, each time a command starts."""

from __future__ import annotations

from scipy import special


def chance_beyond(x: float, degrees: int) -> float:
    """That χ² with so many degrees of freedom exceeds x."""
    return float(special.chdtrc(degrees, max(x, 0.0)))


def value_beyond(chance: float, degrees: int) -> float:
    """What χ² with so many degrees of freedom exceeds with this chance."""
    return float(special.chdtri(degrees, chance))


def student(level: float, degrees: float) -> float:
    """Standard errors either way within which a value lies at this level, where its error has so many degrees of freedom."""
    return float(special.stdtrit(degrees, (1 + level) / 2))


def power(noncentrality: float, degrees: int, level: float) -> float:
    """That a χ² test at this level sees a noncentrality, the square of an effect in standard deviations."""
    return 1.0 - float(special.chndtr(value_beyond(level, degrees), degrees, noncentrality))
