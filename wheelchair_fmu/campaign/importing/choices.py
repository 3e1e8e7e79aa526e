"""What was decided: which column is which channel, with which unit and sign, and why; and units by the size of the numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...units import same_dimension
from .gathering import Column, Series, Source

NAMED = "by its name"
CHECK_IT = "check it"  # ends what was only guessed


@dataclass(frozen=True)
class Choice:
    """A channel of a device: `header` is its column's, `unit` what campaign.toml has to say of it (nothing where the file says
    it), `why` what told. One that is not `settled` is left to the user; one that is `beside` another device's is not used."""

    channel: str
    header: str
    why: str = NAMED
    unit: str = ""
    sign: float = 1.0
    settled: bool = True
    beside: str = ""
    column: Column | None = None
    si: str = ""

    @property
    def guessed(self) -> bool:
        """Is a part of it to be looked at by the user?"""
        return self.settled and not self.beside and CHECK_IT in self.why

    def because(self, why: str, **more: Any) -> Choice:
        """With one more reason."""
        text = why if self.why == NAMED else f"{self.why}; {why}"
        return replace(self, why=text, **more)


@dataclass
class Plan:
    """How a device's files are to be read. `empty` are channels that would be made from others and are not wanted; `doubts` are
    sentences for the user."""

    source: Source
    choices: list[Choice] = field(default_factory=list)
    axes: str = ""
    markers: Mapping[str, str] = field(default_factory=dict)
    body: Mapping[str, str] = field(default_factory=dict)  # markers on the rider
    marker_axes: Mapping[str, str] = field(default_factory=dict)
    place: str = ""
    why_axes: str = ""
    empty: dict[str, str] = field(default_factory=dict)
    doubts: list[str] = field(default_factory=list)
    sideless: bool = False  # has it columns of a wheel, and nothing tells of which

    @property
    def name(self) -> str:
        return self.source.name

    def find(self, channel: str) -> Choice | None:
        return next((c for c in self.choices if c.channel == channel and c.settled and not c.beside), None)

    def put(self, choice: Choice) -> None:
        """In the place of the same channel's choice."""
        at = next((i for i, c in enumerate(self.choices) if c.channel == choice.channel and c.header == choice.header), None)
        if at is None:
            self.choices.append(choice)
        else:
            self.choices[at] = choice

    def series(self, run: str, choice: Choice) -> Series | None:
        """A chosen column in SI and with its sign, by the device's clock."""
        if choice.column is None:
            return None
        found = self.source.series(run, choice.column, choice.si, choice.unit or None)
        return found and (found[0], choice.sign * found[1])


def given(column: Column, units: Iterable[str]) -> str:
    """The unit that the file gives, where it is one of these dimensions; "" where it gives none, or none that can be."""
    return column.unit if column.unit and any(same_dimension(column.unit, unit) for unit in units) else ""


def sized(
    column: Column, units: Sequence[str], by_size: Callable[[np.ndarray], str], series: Sequence[Series]
) -> tuple[str, str]:
    """What campaign.toml has to say of a column's unit, and why: nothing where the file says it, "?" where nobody can tell."""
    if given(column, units):
        return "", ""
    says = f"the file says [{column.unit}], which is no unit of it" if column.unit else "the file gives no unit"
    values = np.concatenate([one[1] for one in series]) if series else np.empty(0)
    values = values[np.isfinite(values)]
    unit = by_size(values) if values.size else ""
    if not unit:
        return "?", f"{says}: write the right one"
    return unit, f"{says}; {unit} by the size of its numbers, up to {np.percentile(np.abs(values), 99.5):.3g}: {CHECK_IT}"


def torque_size(values: np.ndarray) -> str:
    """Hands push with some to some tens of N m."""
    return "N.m" if 3.0 < _peak(values) < 90.0 else ""


def force_size(values: np.ndarray) -> str:
    return "N" if 15.0 < _peak(values) < 350.0 else ""


def angle_size(values: np.ndarray) -> str:
    """An encoder wraps at a turn; one that counts on is told by nothing."""
    jumps = np.abs(np.diff(values))
    wrap = float(np.max(jumps, initial=0.0))
    for unit, turn in (("deg", 360.0), ("rad", 2 * np.pi), ("turn", 1.0)):
        if 0.9 * turn < wrap < 1.02 * turn and np.ptp(values) < 1.05 * turn:
            return unit
    return ""


def rate_size(values: np.ndarray) -> str:
    """No chair yaws by 6 rad/s for long, and no wheel turns by 20."""
    return "deg/s" if _peak(values, 99.0) > 20.0 else "rad/s" if _peak(values, 99.0) < 6.0 and _peak(values, 99.9) > 0.5 else ""


def nothing(values: np.ndarray) -> str:
    return ""


def acceleration_size(g: float) -> Callable[[np.ndarray], str]:
    """By gravity, where three axes show it."""

    def unit(values: np.ndarray) -> str:
        return next((u for u, size in (("g", 1.0), ("m/s2", 9.81), ("mg", 1000.0)) if 0.9 * size < g < 1.1 * size), "")

    return unit


def _peak(values: np.ndarray, percent: float = 99.5) -> float:
    return float(np.percentile(np.abs(values - np.median(values)), percent))
