"""What an import only guessed, or left open, and where it stands in campaign.toml: what somebody has to look at."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from .choices import CHECK_IT, Plan
from .frames import AXES_CURE
from .writing import Wanted, assumed_person, of_one_device, open_axes, why_axes


@dataclass(frozen=True)
class Unsure:
    """`what` is to be looked at, as it stands at each of the `places` of campaign.toml: keys, of [[recording]] by its device.
    Of a column, its `header` and `device`."""

    what: str
    places: tuple[tuple[str, ...], ...]
    device: str = ""
    header: str = ""


def unsure(plans: Sequence[Plan], wanted: Wanted) -> list[Unsure]:
    """All of it, of the campaign first."""
    return [*_campaign(plans, wanted), *(one for plan in plans for one in _device(plan, plans, wanted))]


def _campaign(plans: Sequence[Plan], wanted: Wanted) -> Iterator[Unsure]:
    if open_axes(plans) and not wanted.axes and not any(plan.axes for plan in plans):
        yield Unsure(f"which way y points is assumed: {why_axes(plans, wanted)}", (("campaign", "axes"),))
    if assumed := assumed_person(plans, wanted):
        yield Unsure(assumed, (("rider", "m"),))


def _device(plan: Plan, plans: Sequence[Plan], wanted: Wanted) -> Iterator[Unsure]:
    alone = of_one_device(plans)
    table = ("columns",) if alone else ("recording", plan.name, "columns")
    for choice in plan.choices:
        if choice.guessed:
            guessed = "; ".join(part for part in choice.why.split("; ") if CHECK_IT in part)
            yield Unsure(guessed, ((*table, choice.channel),), plan.name, choice.header)
    for doubt in doubts(plan, wanted):
        yield Unsure(doubt, (table if alone else table[:2], ("campaign", "axes")), plan.name)


def doubts(plan: Plan, wanted: Wanted) -> list[str]:
    """What is doubtful about a device, but for axes that the user has said."""
    return [doubt for doubt in plan.doubts if not (wanted.axes and doubt.endswith(AXES_CURE))]
