"""Pushes under each other's name, or with the other sign. A push of either hand quickens its chair, and that of the left hand
turns it to the right."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...faults import WARNING, Fault, run_fault
from ..channels import PUSHES, SIDES
from ..document import FILE
from ..recorded import Recorded
from .sides import FEWEST, STEP, looked_at, smoothed

SURE = 4.0  # standard errors of Fisher's z from which the sign of a partial correlation is told, and
PLAIN = 0.5  # how large it has to be
WIDTH = 0.1  # s, of the smoothing: how quickly a speed changes is noisier than a speed
APART = 2 * np.pi**0.5 * WIDTH  # s between values of what is smoothed so that tell as much as independent ones
HELD = 3  # series beside a push: the other one, a speed and a constant


@dataclass(frozen=True)
class Turned:
    """What a run shows of its pushes: by name, the partial correlations with how the chair gains speed and turns more, and from
    which size they are sure."""

    run: Recorded
    gain: Mapping[str, float]
    turn: Mapping[str, float]
    plain: float

    @property
    def way(self) -> int:
        """1 where each turns the chair as it should, -1 where the other way, 0 where that does not show."""
        left, right = self.turn.values()
        return int(np.sign(left)) if min(abs(left), abs(right)) > self.plain and left * right < 0 else 0

    def sign(self, name: str) -> int:
        """1 where a push quickens the chair, -1 where it slows it, 0 where that does not show."""
        found = self.gain.get(name, 0.0)
        return int(np.sign(found)) if abs(found) > self.plain else 0


def pushes_turned(runs: Sequence[Recorded]) -> list[Fault]:
    """A warning for each run in which pushes seem to be exchanged or to have the other sign; one for all, where all are so."""
    told = [found for run in runs if (found := _told(run)) is not None]
    exchanged = "the pushes turn the chair the other way: left and right seem to be exchanged"
    cure = "exchange the columns or files of left and right, or correct axes or the sign of the yaw rate"
    faults = list(_said([(one.run, one.way) for one in told], exchanged, cure))
    for name in dict.fromkeys(name for one in told for name in one.gain):
        slowed = f"the chair loses speed where {name} pushes it"
        faults += _said([(one.run, one.sign(name)) for one in told], slowed, f"correct the sign of {name}")
    return faults


def _said(ways: Sequence[tuple[Recorded, int]], fact: str, cure: str) -> Iterator[Fault]:
    telling = [(run, way) for run, way in ways if way]
    wrong = [run for run, way in telling if way < 0]
    if len(wrong) > 1 and len(wrong) == len(telling):
        yield Fault(FILE, None, None, f"{fact}, in every run that tells", cure, WARNING)
        return
    for run in wrong:
        yield run_fault(run.file, fact, f"{cure}, in this run", severity=WARNING)


def _told(run: Recorded) -> Turned | None:
    """None where pushes or speeds are not there, or not by one clock."""
    pushes = [next((n for n in pair if n in run.values), "") for pair in PUSHES.items()]
    needed = (*pushes, *SIDES)
    if not set(needed) <= run.values.keys() or (grid := looked_at(run, needed)) is None:
        return None
    hands = np.stack([smoothed(run, n, WIDTH).at(grid)[0] for n in pushes], axis=1)
    left, right = (smoothed(run, n, WIDTH).at(grid) for n in SIDES)
    speed, gain = 0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1])
    turn, more = left[0] - right[0], left[1] - right[1]  # to the right
    there = np.isfinite(hands).all(axis=1) & np.isfinite(gain)
    if there.sum() < FEWEST or not np.ptp(hands[there], axis=0).all():
        return None
    gains, turns = (
        dict(zip(pushes, _partial(hands[there], beside[there], of[there]), strict=True))
        for beside, of in ((speed, gain), (turn, more))
    )
    told = there.sum() * STEP / APART - HELD - 3  # Fisher's z scatters by one over the root of this
    return Turned(run, gains, turns, max(PLAIN, float(np.tanh(SURE / np.sqrt(told))))) if told > 0 else None


def _partial(pushes: np.ndarray, beside: np.ndarray, of: np.ndarray) -> list[float]:
    """Partial correlation of each push (n, 2) with a series, the other push, what goes `beside` and a constant held."""
    found = []
    for i in range(pushes.shape[1]):
        held = np.column_stack([np.delete(pushes, i, axis=1), beside, np.ones(len(of))])
        x, y = (v - held @ np.linalg.lstsq(held, v, rcond=None)[0] for v in (pushes[:, i], of))
        size = np.sqrt(float(x @ x) * float(y @ y))
        found.append(float(x @ y) / size if size > 0 else 0.0)
    return found
