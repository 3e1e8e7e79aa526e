"""From devices to what each of their columns is: first what a device tells of itself, then what it tells beside others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from . import frames, markers, wheels
from .choices import Choice, Plan
from .gathering import Series, Source
from .guesses import OWN
from .together import Told, Together, spread, together

RADIUS = 0.3  # m, about: for setting wheels beside other devices where nobody gave it
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
    some = spread([run for run in runs])
    seen = together({run: _told(plans, run, radius or RADIUS, axles) for run in some})
    heading = next(iter(axles), "")
    _sides(plans, seen, heading)
    pairs = list(_pairs(seen))
    for plan in plans:
        if plan.place == "on the frame":
            frames.finish(plan, seen, pairs, heading)
    _once(plans)
    return plans


def _mark(plan: Plan, axles: dict[str, markers.Axle]) -> None:
    found = markers.axle(plan.source)
    if isinstance(found, str):
        plan.doubts.append(f"{plan.name}: {found}")
        return
    axles[plan.name] = found
    plan.markers = {"axle_l": found.left, "axle_r": found.right}
    plan.marker_axes = {"x": found.x, "y": found.y}
    plan.place, plan.why_axes = "markers", found.why
    if found.swapped:
        plan.doubts.append(f"{plan.name}: the marker named {found.left} is on the right by its name, but the chair would go backwards "
                           "then: it is taken for the left one")  # fmt: skip


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


def _own(plan: Plan, column) -> Choice:
    from ..channels import BY_NAME, SOURCES
    from .choices import given, nothing, sized

    channel = OWN[column.quantity.lower()]
    known = BY_NAME.get(channel) or next(s for s in SOURCES if s.name == channel)
    units = [known.unit.name] + ([known.rotary.name] if known.rotary else [])
    unit, why = sized(column, units, nothing, wheels.everything(plan.source, column))
    si = units[1] if len(units) > 1 and given(column, units[1:]) and not given(column, units[:1]) else units[0]
    chosen = Choice(channel, column.header, unit=unit, settled=unit != "?", column=column, si=si)
    return chosen.because(why) if why else chosen


def _told(plans: Sequence[Plan], run: str, radius: float, axles: Mapping[str, markers.Axle]) -> Told:
    """What the devices saw in a run, as far as it is known, for finding their clocks."""
    told: dict[tuple[str, str], Series] = {}
    for plan in plans:
        for channel, series in wheels.rolling(plan, run, radius):
            told.setdefault((plan.name, channel), series)
        for choice in plan.choices:
            if choice.channel in ("F_rl", "F_rr", "M_rl", "M_rr") and (found := plan.series(run, choice)) is not None:
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
    """Whether wheels are on the sides that their names say: in a turn the outer wheel goes farther. Only a yaw rate whose sign is
    known without them, by gravity or by markers, can tell."""
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
        fit = seen.fit(lambda run, pair=(left, right): seen.difference(run, *pair), yaw)
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
                plan.doubts = [doubt for doubt in plan.doubts if not doubt.endswith(f"{wheels.WHICH} it is on")]


OTHER = {"l": "r", "r": "l"}


def _swap(plan: Plan, by: str, named: str) -> None:
    """Put all that a device says of one wheel to the other."""
    is_named = bool(plan.source.side) or any(c.column and c.column.guess and c.column.guess.side for c in plan.choices)
    plan.choices = [replace(c.because("its side by its signal: in turns the outer wheel goes farther"), channel=f"{c.channel[:-1]}{OTHER[c.channel[-1]]}")
                    if c.channel.startswith(("F_r", "M_r", "wheel_")) else c for c in plan.choices]  # fmt: skip
    plan.doubts = [doubt for doubt in plan.doubts if not doubt.endswith(f"{wheels.WHICH} it is on")]
    if is_named:
        other = "right" if named == "left" else "left"
        plan.doubts.append(f"{plan.name}: what is named {named} seems to be the {other} wheel's: in turns the outer wheel goes farther, by {by}; "
                           f"it is taken as the {other} wheel's")  # fmt: skip


ORDER = ("yaw_rate", "a_x", "a_y")


def _once(plans: Sequence[Plan]) -> None:
    """Each channel from one device: of frame sensors the one that tells most, of wheels' speeds what was measured, not what is
    made from an angle."""
    for channel in dict.fromkeys(c.channel for p in plans for c in p.choices):
        of = [p for p in plans if p.find(channel)]
        of.sort(key=lambda p: -sum(p.find(name) is not None for name in ORDER))
        for plan in of[1:] if len(of) > 1 else []:
            choice = plan.find(channel)
            assert choice is not None
            plan.put(replace(choice, beside=of[0].name))
    for side in "lr":
        speed = next((p for p in plans if p.find(f"wheel_speed_{side}")), None)
        for plan in plans:
            if speed is not None and plan is not speed and plan.find(f"wheel_angle_{side}"):
                plan.empty[f"wheel_speed_{side}"] = f"{speed.name} measures it; the angle tells the ripple of the rim"
    for name, of in (("yaw", [p for p in plans if p.markers]),):
        for plan in plans:
            if of and plan not in of and (choice := plan.find(name)):
                plan.put(replace(choice, beside=of[0].name))
