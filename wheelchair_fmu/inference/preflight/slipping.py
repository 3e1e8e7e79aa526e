"""Rear wheels that slip: their rims gain or lose speed while the chair, as it was felt or seen, does not.

By the law of wheels that roll, a push beyond what the floor holds moves its chair all the same, so that a search finds effects
that seem to make up for it, one after another. Whether a wheel slips is told by two instruments and by no model: over a fifth
of a second the rim changes its speed by more than its hub does. What the floor is said to hold does not matter for that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid

from ...campaign import Campaign, Run
from ...campaign.channels import SIDES
from ...model.variant import Variant
from ...model.wheel.spinning import PARAMETERS
from ..evidence.noise_model import HANDS

OVER = 0.2  # s, over which speeds are compared
WITHIN = 10  # times that so long has
AMISS = 1.0  # m/s² by which a rim's acceleration is another than its hub's; no tilt or offset of a sensor changes so fast
BEYOND_NOISE = 8.0  # standard deviations of what the noise of the readings makes of that
PUSHED = 0.05  # of its load, at least, by which a wheel that slips is pushed
SLIPPERY = 0.01  # share of a run's time, at least, in which one slips
INERTIA = next(p.default for p in PARAMETERS if p.symbol == "I_wheel")


@dataclass(frozen=True)
class Slipping:
    """How long a rear wheel slipped in a run, as a share of its time, and the share of its load that the floor then held."""

    run: str
    share: float
    held: float


def slipped(campaign: Campaign, variant: Variant) -> tuple[str, ...]:
    """A sentence on the runs in which wheels slipped, if there are any, where wheels roll by the variant's law."""
    if variant.choice.wheel != "rolling" or variant.choice.equations == "paper":
        return ()
    found = [s for run in campaign.runs if (s := slipping(run, campaign, variant))]
    return (_words(found),) if found else ()


def slipping(run: Run, campaign: Campaign, variant: Variant) -> Slipping | None:
    """Whether a rear wheel slips in a run; None too where its readings do not tell."""
    if not {*SIDES, "a_x"} <= set(run.channels) or not set(HANDS) <= set(run.inputs):
        return None
    chair = {**{p.name: p.default for p in variant.parameters()}, **variant.values, **campaign.known, **run.set}
    load = chair["chair.m"] * chair["g"] * chair["chair.a"] / (2 * (chair["chair.a"] + chair["chair.b"]))
    grid = np.arange(run.time[0], run.time[-1], OVER / WITHIN)
    felt = _change(_read(run, "a_x", grid, summed=True))
    turned = _change(_read(run, "yaw_rate", grid)) if "yaw_rate" in run.channels else 0.0
    noise = campaign.noise.get(SIDES[0], 0.0) * run.noise_share(SIDES[0]) * np.sqrt(2) / OVER
    slips, held = np.zeros(len(felt), bool), []
    for side, push, arm in zip(SIDES, HANDS, (0.5, -0.5), strict=True):
        gained = _change(_read(run, side, grid))
        amiss = gained - felt - arm * chair["chair.t_r"] * turned
        force = np.interp(grid + OVER / 2, run.time, run.inputs[push])[: len(felt)]
        known = np.isfinite(amiss)
        usual = np.median(amiss[known]) if known.any() else 0.0  # what a tilt and an offset make of it
        here = known & (np.abs(amiss - usual) > max(AMISS, BEYOND_NOISE * noise)) & (np.abs(force) > PUSHED * load)
        slips |= here
        spinning = INERTIA / chair["wheel.R"] ** 2 * gained[here]
        held.append(np.sign(force[here]) * (force[here] - spinning) / load)
    share = float(np.mean(slips))
    return Slipping(run.name, share, float(np.median(np.concatenate(held)))) if share > SLIPPERY else None


def _read(run: Run, channel: str, grid: np.ndarray, summed: bool = False) -> np.ndarray:
    """A channel, or its sum over time, at these times (n,); NaN where it has no sample near."""
    known = np.isfinite(run.channels[channel])
    time, values = run.time[known], run.channels[channel][known]
    if len(time) < 2:
        return np.full(len(grid), np.nan)
    values = cumulative_trapezoid(values, time, initial=0.0) if summed else values
    after = np.clip(np.searchsorted(time, grid), 1, len(time) - 1)
    near = time[after] - time[after - 1] < OVER
    return np.where(near, np.interp(grid, time, values), np.nan)


def _change(series: np.ndarray) -> np.ndarray:
    """How fast a series changes [1/s], from each time of the grid on."""
    return (series[WITHIN:] - series[:-WITHIN]) / OVER


def _words(found: Sequence[Slipping]) -> str:
    runs = ", ".join(f"{s.run} ({s.share:.0%} of the time)" for s in found)
    held = float(np.median([s.held for s in found]))
    return (
        f"{runs}: a rear wheel changed its speed there as the chair did not, so it slipped, as on a floor whose friction holds "
        f"about {held:.2f} of the wheel's load; wheels of this model roll, so no effect is looked for, as it could only make "
        f"up for that; leave these runs out, or take the law of wheels that slip: wheel = "
        f'"spinning" in the [laws] of a variant, with tyre.mu = {held:.2f}'
    )
