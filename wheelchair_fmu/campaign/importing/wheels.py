"""Push rims, encoders and sensors on the spokes: what of them is which wheel's, and which way is forward."""

from __future__ import annotations

from collections.abc import Iterator

from ...units import same_dimension
from ..angles import TURN, cleaned
from ..clocks.signals import rate
from .choices import CHECK_IT, Choice, Plan, angle_size, force_size, nothing, rate_size, sized, torque_size
from .gathering import Column, Series, Source
from .turning import Lean, axes, forward, on_spokes, pushing

SIDES = {"l": "left", "r": "right"}


def sided(plan: Plan, column: Column, alone: str = "") -> str:
    """The wheel that a column is of, by its header, else by its device; "" where neither tells."""
    return (column.guess.side if column.guess else "") or plan.source.side or alone


def rims(plan: Plan) -> None:
    """Torques or forces on the rims; hands push forward more than they brake."""
    source = plan.source
    for quantity, si, size in (("torque", "N.m", torque_size), ("force", "N", force_size)):
        columns = source.of(quantity)
        axial = [c for c in columns if c.guess and c.guess.axis == "z"]
        for column in axial if axial and quantity == "torque" else columns:
            side = sided(plan, column)
            if not side:
                _leave(plan, column, "F_rl or columns.F_rr")
                continue
            series = everything(source, column)
            unit, why = sized(column, (si,), size, series)
            lean = pushing(series)
            chosen = Choice(f"F_r{side}", column.header, unit=unit, sign=lean.sign, settled=unit != "?", column=column, si=si)
            if plan.find(chosen.channel):
                continue  # a torque about the axle tells more than a force beside it
            chosen = chosen.because(_side_told(plan, column, side)).because(_said(lean, "hands push", "pushes are forward"))
            plan.put(chosen.because(why) if why else chosen)


def angles(plan: Plan) -> None:
    for column in plan.source.of("wheel_angle"):
        side = sided(plan, column)
        if not side:
            _leave(plan, column, "wheel_angle_l or columns.wheel_angle_r")
            continue
        unit, why = sized(column, ("rad",), angle_size, everything(plan.source, column))
        chosen = Choice(f"wheel_angle_{side}", column.header, unit=unit, settled=unit != "?", column=column, si="rad")
        if chosen.settled:
            lean = forward(turns(plan, chosen))
            chosen = chosen.because(_said(lean, "it rolls", "it mostly rolls forward"), sign=lean.sign)
        plan.put(chosen.because(why) if why else chosen)


def speeds(plan: Plan) -> None:
    """Speeds that name a wheel; one that names none is the chair's."""
    for column in plan.source.of("speed"):
        side = sided(plan, column)
        channel, units = (f"wheel_speed_{side}", ("m/s", "rad/s")) if side else ("u", ("m/s",))
        unit, why = sized(column, units, nothing, everything(plan.source, column))
        si = next((one for one in units if same_dimension(unit or column.unit or "", one)), "m/s")
        lean = forward(everything(plan.source, column))
        chosen = Choice(channel, column.header, unit=unit, sign=lean.sign, settled=unit != "?", column=column, si=si)
        if not plan.find(channel):
            chosen = chosen.because(_said(lean, "it goes", "it mostly goes forward")) if lean.sign < 0 else chosen
            plan.put(chosen.because(why) if why else chosen)


def spokes(plan: Plan) -> bool:
    """A sensor on the spokes; whether it is one. Its gyroscope is a wheel's speed through the radius."""
    source = plan.source
    axis = on_spokes(source)
    if not axis:
        return False
    column = axes(source, "gyro")[axis]
    side = source.side or "l"
    lean = forward(everything(source, column))
    unit, why = sized(column, ("rad/s",), rate_size, everything(source, column))
    chosen = Choice(
        f"wheel_speed_{side}", column.header, unit=unit, sign=lean.sign, settled=unit != "?", column=column, si="rad/s"
    )
    told = "gravity turns through its other axes: it is on the spokes" if axes(source, "acc") else "it turns most of its axes"
    chosen = chosen.because(f"by its signal: {told}").because(_said(lean, "it rolls", "it mostly rolls forward", ""))
    plan.put(chosen.because(why) if why else chosen)
    plan.place = "on the spokes"
    if not source.side:
        plan.doubts.append(unsided(plan))
    return True


def everything(source: Source, column: Column) -> list[Series]:
    """A column in all runs, in the file's unit."""
    return [one for run in source.files if (one := source.series(run, column)) is not None]


def turns(plan: Plan, angle: Choice) -> list[Series]:
    """The speed (rad/s) of a wheel whose angle was recorded, in all runs."""
    return [one for run in plan.source.files if (one := turn(plan, run, angle)) is not None]


def turn(plan: Plan, run: str, angle: Choice) -> Series | None:
    found = plan.series(run, angle)
    return found and rate(found[0], cleaned(found[1], TURN)[0])


def rolling(plan: Plan, run: str, radius: float) -> Iterator[tuple[str, Series]]:
    """Each wheel's speed (m/s) that a device tells, by the channel."""
    for choice in plan.choices:
        if choice.channel.startswith("wheel_speed") and choice.settled and (found := plan.series(run, choice)) is not None:
            yield choice.channel, (found[0], found[1] * (radius if choice.si == "rad/s" else 1.0))
        if choice.channel.startswith("wheel_angle") and choice.settled and (speed := turn(plan, run, choice)) is not None:
            yield choice.channel.replace("angle", "speed"), (speed[0], radius * speed[1])


def unsided(plan: Plan) -> str:
    """The doubt about a sensor on the spokes whose wheel no name tells."""
    return f"{plan.name}: it is on the spokes, but neither its name nor a turn tells of which wheel: check its side"


def _leave(plan: Plan, column: Column, cure: str) -> None:
    """A column whose wheel nothing tells."""
    plan.sideless = True
    plan.doubts.append(
        f"{plan.name}: no name tells of which wheel {column.header!r} is, so it is not used; write columns.{cure}"
    )


def _side_told(plan: Plan, column: Column, side: str) -> str:
    by = "its header" if column.guess and column.guess.side else "its device's name"
    return f"{SIDES[side]} by {by}"


def _said(lean: Lean, does: str, what: str, by: str = "by its signal: ") -> str:
    """Which way is forward, and what tells that."""
    if not lean.plain:
        return f"{by}{does} as much back as forward, so its sign is not sure: {CHECK_IT}"
    return f"{by}{'turned round, as ' if lean.sign < 0 else ''}{what}"


def read(plan: Plan) -> None:
    """All that a device tells of wheels."""
    rims(plan)
    angles(plan)
    speeds(plan)
