"""What Figs. 12 to 19 show: which runs, under which names."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..driving import Result
from .runs import Runs, Values, camber, scaled
from .statements import ALIGNING, CORNERING, SCALES

Lines = dict[str, Result]


@dataclass(frozen=True)
class FamilyFigure:
    """One figure of the paper: its number, a title, and its lines; `of_radius` where it shows R_c and not path and slips."""

    number: int
    title: str
    lines: Callable[[Runs], Lines]
    of_radius: bool = False


def _turns(values: dict[str, Values]) -> Callable[[Runs], Lines]:
    return lambda runs: {label: runs.turn(v) for label, v in values.items()}


def _slaloms(values: dict[str, Values]) -> Callable[[Runs], Lines]:
    return lambda runs: {label: runs.slalom(v) for label, v in values.items()}


def _stiffness(name: str, symbol: str) -> dict[str, Values]:
    words = ("half", "reference", "double")
    return {f"{word} {symbol}": scaled(name, scale) for word, scale in zip(words, SCALES, strict=True)}


def _cambers(*angles: float) -> dict[str, Values]:
    return {f"φ = {angle:g}°".replace("-", "−"): camber(angle) for angle in angles}


_C_LAMBDA, _C_M = _stiffness(CORNERING, "$C_λ$"), _stiffness(ALIGNING, "$C_{mλ}$")
FIGURES = (
    FamilyFigure(12, "cornering stiffness, steady turn", _turns(_C_LAMBDA)),
    FamilyFigure(13, "cornering stiffness, slalom", _slaloms(_C_LAMBDA)),
    FamilyFigure(14, "cornering stiffness, radius in the slalom", _slaloms(_C_LAMBDA), of_radius=True),
    FamilyFigure(15, "self-aligning stiffness, steady turn", _turns(_C_M)),
    FamilyFigure(16, "self-aligning stiffness, slalom", _slaloms(_C_M)),
    FamilyFigure(17, "self-aligning stiffness, radius in the slalom", _slaloms(_C_M), of_radius=True),
    FamilyFigure(18, "camber, steady turn", _turns(_cambers(-1.0, 0.0, 1.0))),
    FamilyFigure(19, "camber, slalom", _slaloms(_cambers(0.0, 0.5, 1.0))),
)
