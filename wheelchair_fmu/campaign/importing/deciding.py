"""From devices to what each of their columns is: first what a device tells of itself, then what it tells beside others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

from ..channels import BY_NAME, SOURCES
from . import frames, markers, wheels
from .choices import CHECK_IT, Choice, Plan, given, nothing, sized
from .gathering import Column, Series, Source
from .together import Together, Told, spread, together

RADIUS = 0.3  # m, about: for setting wheels beside other devices where nobody gave it
SIGNED = ("F_rl", "F_rr", "M_rl", "M_rr", "a_x")  # whose name says which way is positive, whatever the axes
Pair = tuple[tuple[str, str], tuple[str, str]]


def decide(sources: Sequence[Source], runs: Sequence[str], radius: float | None) -> list[Plan]:
    """How each device's files are to be read."""
    plans = [Plan(source) for source in sources]
    axles: dict[str, markers.Axle] = {}
    for plan in plans:
        if markers.is_markers(plan.source):
            _mark(plan, axles)
        else:
            _alone(plan)
    _nameless(plans)
    some = spread(runs)
    seen = together({run: _told(plans, run, radius or RADIUS, axles) for run in some})
    heading = next(iter(axles), "")
    _sides(plans, seen, heading)
    pairs = list(_pairs(seen))
    for plan in plans:
        if plan.place == "on the frame":
            frames.finish(plan, seen, pairs, heading)
    _once(plans)
    return plans


def _nameless(plans: Sequence[Plan]) -> None:
    """Sensors on spokes that name no side are taken for the wheels that no other one is on, until a turn tells."""
    spoked = [plan for plan in plans if plan.place == "on the spokes"]
    free = [side for side in "lr" if side not in {plan.source.side for plan in spoked}]
    for plan, side in zip((p for p in spoked if not p.source.side), free, strict=False):
        plan.choices = [replace(c, channel=f"wheel_speed_{side}") for c in plan.choices]


def _mark(plan: Plan, axles: dict[str, markers.Axle]) -> None:
    found = markers.axle(plan.source)
    if isinstance(found, str):
        plan.doubts.append(f"{plan.name}: {found}")
        return
    axles[plan.name] = found
    plan.markers = {"axle_l": found.left, "axle_r": found.right}
    plan.body = markers.on_the_body(plan.source)
    plan.marker_axes = {"x": found.x, "y": found.y}
    plan.place, plan.why_axes = "markers", found.why
    if found.swapped:
        plan.doubts.append(
            f"{plan.name}: the marker named {found.left} is on the right by its name, but the chair would go backwards then: "
            "it is taken for the left one"
        )


def _alone(plan: Plan) -> None:
    """What a device tells of itself."""
    source = plan.source
    for column in source.columns:
        if column.guess and column.guess.own:
            plan.put(_own(plan, column))
    if wheels.spokes(plan):
        return
    wheels.read(plan)
    if source.of("gyro", "acc", "yaw_rate"):
        plan.place = "on the frame"
        frames.provisional(plan)


def _own(plan: Plan, column: Column) -> Choice:
    """A column that is called as the channel that it is."""
    channel = column.quantity
    known = BY_NAME.get(channel) or next(s for s in SOURCES if s.name == channel)
    units = [known.unit.name] + ([known.rotary.name] if known.rotary else [])
    unit, why = sized(column, units, nothing, wheels.everything(plan.source, column))
    si = units[1] if len(units) > 1 and given(column, units[1:]) and not given(column, units[:1]) else units[0]
    if unit == "?" and not column.unit:
        unit, why = known.unit.name, f"the file gives no unit; {known.unit.name} is what a column of this name has: {CHECK_IT}"
    chosen = Choice(channel, column.header, unit=unit, settled=unit != "?", column=column, si=si)
    return chosen.because(why) if why else chosen


def _told(plans: Sequence[Plan], run: str, radius: float, axles: Mapping[str, markers.Axle]) -> Told:
    """What the devices saw in a run, as far as it is known, for finding their clocks."""
    told: dict[tuple[str, str], Series] = {}
    for plan in plans:
        for channel, series in wheels.rolling(plan, run, radius):
            told.setdefault((plan.name, channel), series)
        for choice in plan.choices:
            if choice.channel in SIGNED and (found := plan.series(run, choice)) is not None:
                told[plan.name, choice.channel] = found
        if plan.name in axles:
            told |= {(plan.name, q): s for q, s in markers.pose(plan.source, run, axles[plan.name]).items()}
    rolled = [series for (_, quantity), series in told.items() if quantity.startswith("wheel_speed")]
    for plan in plans:
        if plan.place == "on the frame":
            turned, along = frames.clockwise(plan, run), frames.accelerations(plan, run, rolled[:2])
            told |= {(plan.name, "yaw_rate"): turned} if turned is not None else {}
            told |= {(plan.name, "a_x"): along} if along is not None else {}
    return told


def _pairs(seen: Together) -> Iterator[Pair]:
    """Left and right wheels' speeds; those of one device first."""
    keys = dict.fromkeys(key for of in seen.told.values() for key in of)
    lefts, rights = ([key for key in keys if key[1] == f"wheel_speed_{side}"] for side in "lr")
    yield from sorted(((a, b) for a in lefts for b in rights), key=lambda pair: pair[0][0] != pair[1][0])


def _sides(plans: Sequence[Plan], seen: Together, heading: str) -> None:
    """Whether wheels are on the sides that their names say: in a turn the outer wheel goes farther. Only a yaw rate whose sign
    is known without them, by gravity or by markers, can tell."""
    turned = next((p for p in plans if p.place == "on the frame" and p.why_axes and p.find("yaw_rate")), None)
    if turned is None and not heading:
        return
    device = turned.name if turned else heading

    def yaw(run: str) -> Series | None:
        if turned is not None:
            series = frames.clockwise(turned, run)
            return series and seen.at(run, device, series)
        series = seen.told[run].get((device, "yaw"))
        return series and seen.at(run, device, series, 1)

    done: set[str] = set()
    for left, right in _pairs(seen):
        if {left[0], right[0]} & done:
            continue
        fit = seen.fit(partial(seen.difference, left=left, right=right), yaw)
        if fit is None or not fit.plain:
            continue
        done |= {left[0], right[0]}
        of = [p for p in plans if p.name in (left[0], right[0])]
        by = f"{'the yaw rate of ' if turned else 'the heading of '}{device}, {fit.words}"
        if fit.sign < 0:
            for plan in of:
                _swap(plan, by, {left[0]: "left", right[0]: "right"}.get(plan.name, "left"))
        else:
            for plan in of:
                plan.doubts = [doubt for doubt in plan.doubts if doubt != wheels.unsided(plan)]


OTHER = {"l": "r", "r": "l"}
SIDED = ("F_r", "M_r", "wheel_")  # how channels of one wheel begin


def _swap(plan: Plan, by: str, named: str) -> None:
    """Put all that a device says of one wheel to the other."""
    is_named = bool(plan.source.side) or any(c.column and c.column.guess and c.column.guess.side for c in plan.choices)
    why = "its side by its signal: in turns the outer wheel goes farther"
    plan.choices = [
        c.because(why, channel=f"{c.channel[:-1]}{OTHER[c.channel[-1]]}") if c.channel.startswith(SIDED) else c
        for c in plan.choices
    ]
    plan.doubts = [doubt for doubt in plan.doubts if doubt != wheels.unsided(plan)]
    if is_named:
        other = "right" if named == "left" else "left"
        plan.doubts.append(
            f"{plan.name}: what is named {named} seems to be the {other} wheel's: in turns the outer wheel goes farther, by "
            f"{by}; it is taken as the {other} wheel's"
        )


FRAME = ("yaw_rate", "a_x", "a_y")


def _once(plans: Sequence[Plan]) -> None:
    """In a run each channel from one device: of frame sensors from the one that tells most, of wheels what was measured, not
    what is made from an angle; a heading from markers."""
    for channel in dict.fromkeys(c.channel for p in plans for c in p.choices):
        telling = sorted((p for p in plans if p.find(channel)), key=lambda p: -sum(p.find(name) is not None for name in FRAME))
        for i, plan in enumerate(telling):
            _leave(plan, channel, [first for first in telling[:i] if first.find(channel)])
    for plan in plans:
        _leave(plan, "yaw", [p for p in plans if p.markers])
        for side in "lr":
            speed = next((p for p in plans if _share(p, plan) and p.find(f"wheel_speed_{side}")), None)
            if speed is not None and plan.find(f"wheel_angle_{side}"):
                plan.empty[f"wheel_speed_{side}"] = f"{speed.name} measures it; the angle tells the ripple of the rim"


def _leave(plan: Plan, channel: str, others: Sequence[Plan]) -> None:
    """Leave a channel to another device that recorded the same runs."""
    better = next((other for other in others if _share(other, plan)), None)
    choice = plan.find(channel)
    if better is not None and choice is not None:
        plan.put(replace(choice, beside=better.name))


def _share(one: Plan, other: Plan) -> bool:
    """Are these two devices that recorded a run together?"""
    return one is not other and bool(one.source.files.keys() & other.source.files.keys())
