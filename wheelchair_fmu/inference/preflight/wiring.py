"""Columns that hold another thing than their name says: the other sign, another unit, the other side's.

No effect of a chair does that, but a search finds several that seem to; so such columns are found before the search, by what
each channel reads beside what the model, as the campaign has it, would read.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...campaign import BY_NAME
from ...campaign.channels import SIDES
from ...errors import SimulationError
from ..evidence.initial_state import START
from ..evidence.likelihood import Likelihood

LIKE = 0.2  # share of its mean square that k times what the model reads may leave of a channel,
ABOUT = 0.25  # and by which k may be off
TWICE = 2  # runs that must say so
DIFFERENCE = " - ".join(SIDES)


@dataclass(frozen=True)
class Wiring:
    """The channels that are not what they are called, to be left out, a sentence for each fault, and whether what is left can
    be trusted."""

    wrong: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    trusted: bool = True


def wiring(likelihood: Likelihood, values: Mapping[str, float]) -> Wiring:
    """What the runs to be fitted, all together, say of their columns."""
    try:
        factors = {c: _agreed(pairs) for c, pairs in _readings(likelihood, values).items()}
    except SimulationError:
        return Wiring()  # which the fit will say
    found = _exchanged_pushes(factors) or _channels(factors)
    if found.wrong and all(set(run.channels) <= set(found.wrong) for run in likelihood.campaign.fit):
        return Wiring((), (*found.notes, "nothing else was measured, so no verdict can be trusted"), False)
    return found


def _exchanged_pushes(factors: Mapping[str, float]) -> Wiring | None:
    """Where everything turns the other way, wheels as well."""
    odd = [k for c, k in factors.items() if c == DIFFERENCE or BY_NAME[c].iso_sign < 0]
    if DIFFERENCE not in factors or len(odd) < 2 or not all(_near(k, -1.0) for k in odd):
        return None
    note = (
        "the chair turns the other way than its pushes have it, so no verdict can be trusted; see whether the "
        "columns of F_rl and F_rr are exchanged"
    )
    return Wiring((), (note,), False)


def _channels(factors: Mapping[str, float]) -> Wiring:
    """Channels with the other sign, wheels that are exchanged, and other units."""
    notes, wrong = [], [c for c, k in factors.items() if c != DIFFERENCE and _near(k, -1.0)]
    odd = {c for c in factors if c != DIFFERENCE and BY_NAME[c].iso_sign < 0}
    if len(odd) > 1 and odd == set(wrong):
        notes.append(
            f"{', '.join(wrong)} have the other sign than the model's, and are left out; check `axes` in campaign.toml"
        )
    else:
        notes += [f"{c} has the other sign than the model's, and is left out; turn its column round" for c in wrong]
    if _near(factors.get(DIFFERENCE, 1.0), -1.0):
        wrong += SIDES
        notes.append(f"{' and '.join(SIDES)} seem to be exchanged, and are left out; exchange their columns")
    for c, k in factors.items():
        if c != DIFFERENCE and _in_other_unit(c, k):
            unit = BY_NAME[c].confused[1]
            cure = f"whether it is in {unit}" if abs(k) > 1 else f"whether its header says {unit} of what is not"
            wrong.append(c)
            notes.append(f"{c} is about {abs(k):.2g} times what the model reads, and is left out; see {cure}")
    return Wiring(tuple(wrong), tuple(notes))


def _readings(likelihood: Likelihood, values: Mapping[str, float]) -> dict[str, list[np.ndarray]]:
    """By channel, and for the difference of the two wheels: measured and simulated (2, n), of each run to be fitted."""
    found: dict[str, list[np.ndarray]] = {}
    for run in likelihood.campaign.fit:
        start = {name: run.set.get(name, 0.0) for name in START} | ({} if run.u0 is None else {"start.u": run.u0})
        channels, measured, predicted = likelihood.readings(run, values, start)  # a wrong column says nothing of the start
        pairs = np.stack([measured, predicted])  # (2, n, nz)
        by_name = {c: pairs[:, :, i] for i, c in enumerate(channels)}
        if set(SIDES) <= set(channels):
            by_name[DIFFERENCE] = by_name[SIDES[0]] - by_name[SIDES[1]]
        for name, pair in by_name.items():
            found.setdefault(name, []).append(pair[:, np.isfinite(pair[0])])
    return found


def _times(pair: np.ndarray) -> float:
    """How many times what the model reads is measured (2, n); 1 where that is not all there is to it."""
    measured, predicted = pair
    along, size, whole = float(measured @ predicted), float(predicted @ predicted), float(measured @ measured)
    return along / size if size and whole and along**2 > (1 - LIKE) * size * whole else 1.0


def _agreed(pairs: Sequence[np.ndarray]) -> float:
    """The same of several runs together, if two of them say so by themselves."""
    k = _times(np.concatenate(pairs, axis=1))
    return k if sum(_near(_times(pair), k) for pair in pairs) >= min(TWICE, len(pairs)) else 1.0


def _near(k: float, factor: float) -> bool:
    return abs(k / factor - 1) < ABOUT


def _in_other_unit(channel: str, k: float) -> bool:
    factor = BY_NAME[channel].confused[0]
    return _near(abs(k), factor) or _near(abs(k), 1 / factor)
