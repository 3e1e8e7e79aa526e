"""Sensors on the frame: which axis is the yaw rate's, which is forward, and how they are signed.

Gravity tells which axis is up, and a right-handed sensor turns counter-clockwise about it when it reads a positive rate.
Without gravity, the wheels' difference tells the sign. The axis that shows how the speed changes is forward; the third one
follows, as the sensor's axes are right-handed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from ..axes import ISO, SAE
from ..clocks import Signal, alike
from .choices import CHECK_IT, NAMED, Choice, Plan, acceleration_size, given, rate_size, sized
from .gathering import Column, Series
from .together import Fit, Together
from .turning import AXES, axes, gravity, upright
from .wheels import everything

AXES_CURE = f'write axes = "{ISO}" or "{SAE}", or give --axes'
TRACK = 0.56  # m, about: for telling deg/s from rad/s
NEAR = 1.6  # times as large or small as it should be, a unit is still believed


def provisional(plan: Plan) -> None:
    """What can be told before other devices are asked: the yaw rate's column and, by gravity, its sign."""
    source = plan.source
    for column in source.of("yaw_rate"):
        unit, why = sized(column, ("rad/s",), rate_size, everything(source, column))
        chosen = Choice("yaw_rate", column.header, unit=unit, settled=unit != "?", column=column, si="rad/s")
        plan.put(chosen.because(why) if why else chosen)
    gyros, up = axes(source, "gyro"), upright(source)
    if gyros and not plan.find("yaw_rate"):
        axis = up[0] if up and up[0] in gyros else "z" if "z" in gyros else next(iter(gyros))
        column = gyros[axis]
        unit, why = sized(column, ("rad/s",), rate_size, everything(source, column))
        chosen = Choice("yaw_rate", column.header, unit=unit, column=column, si="rad/s")
        chosen = chosen.because(f"gravity stands on {axis}") if up and up[0] == axis else chosen
        plan.put(chosen.because(why) if why else chosen)
    if up:
        plan.axes = ISO if up[1] > 0 else SAE
        plan.why_axes = f"by gravity: its {up[0]} points {'up' if up[1] > 0 else 'down'}"


def clockwise(plan: Plan, run: str) -> Series | None:
    """The yaw rate (rad/s) as far as it is known, positive clockwise from above."""
    choice = next((c for c in plan.choices if c.channel == "yaw_rate"), None)
    found = None if choice is None else plan.series(run, replace(choice, unit=choice.unit.replace("?", "")))
    if found is None:
        return None
    return (found[0], -found[1]) if plan.axes == ISO else found


def accelerations(plan: Plan, run: str, wheels: Sequence[Series]) -> Series | None:
    """The horizontal acceleration that most follows a wheel, in the file's unit: for finding this device's clock."""
    columns = _level(plan)
    best: tuple[float, Series] | None = None
    for column in columns.values():
        series = plan.source.series(run, column)
        if series is None:
            continue
        for time, speed in wheels:
            match = alike(Signal("a", "a_x", *series), Signal("b", "wheel_speed_l", time, speed))
            if match is not None and (best is None or abs(match.correlation) > best[0]):
                best = abs(match.correlation), (series[0], np.sign(match.correlation) * series[1])
    return best[1] if best else None


def _level(plan: Plan) -> Mapping[str, Column]:
    """The accelerometer's axes without the one that gravity stands on, or that the yaw rate turns about."""
    columns = axes(plan.source, "acc")
    up = upright(plan.source)
    return {axis: c for axis, c in columns.items() if axis != (up[0] if up else "z")}


def finish(plan: Plan, seen: Together, pairs: Sequence[tuple[tuple[str, str], tuple[str, str]]], heading: str) -> None:
    """Sign and unit of the yaw rate by the wheels' difference, or by the markers' heading; then the accelerations."""
    choice = next((c for c in plan.choices if c.channel == "yaw_rate"), None)
    if choice is not None:
        _yaw(plan, choice, seen, pairs, heading)
    _accelerations(plan, seen)


def _yaw(plan: Plan, choice: Choice, seen: Together, pairs: Sequence, heading: str) -> None:
    raw = replace(choice, unit=choice.unit.replace("?", ""), sign=1.0)
    found = _against(plan, raw, seen, pairs, heading)
    by, fit = found if found else ("", None)
    if choice.unit and fit is not None and fit.plain:
        choice = _by_gain(replace(choice, unit="?"), plan, fit, {"rad/s": 1.0, "deg/s": 180 / np.pi}, raw, by)
    if choice.unit == "?":
        plan.put(replace(choice, settled=False))
        return
    if plan.axes and plan.why_axes:
        told = f"by its signal: follows {by}, {fit.words}" if fit is not None and fit.plain else ""
        right = fit is None or not fit.plain or (fit.sign > 0) == (plan.axes == SAE)
        plan.put(choice.because(told) if told and right else choice)
        return
    if fit is not None and fit.plain:
        plan.axes = SAE if fit.sign > 0 else ISO
        plan.why_axes = f"by its yaw rate, which is positive {'clockwise' if fit.sign > 0 else 'counter-clockwise'}"
        plan.put(choice.because(f"by its signal: follows {by}, {fit.words}"))
    else:
        plan.doubts.append(f"{plan.name}: nothing tells which way the yaw rate {choice.header!r} is positive; {AXES_CURE}")
        plan.put(choice)


def _against(plan: Plan, choice: Choice, seen: Together, pairs: Sequence, heading: str) -> tuple[str, Fit] | None:
    """The yaw rate as it is in the file beside what else turns: (rad/s, clockwise)."""

    def own(run: str) -> Series | None:
        series = plan.series(run, choice)
        return series and seen.at(run, plan.name, series)

    for left, right in pairs:
        fit = seen.fit(own, partial(seen.difference, left=left, right=right))
        if fit is not None and fit.plain:
            return "the wheels' difference", Fit(fit.gain * TRACK, fit.correlation)
    if heading:

        def turned(run: str) -> Series | None:
            series = seen.told[run].get((heading, "yaw"))
            return series and seen.at(run, heading, (series[0], _unwrapped(series[1])), 1)

        fit = seen.fit(own, turned)
        if fit is not None:
            return "the markers' heading", fit
    return None


def _unwrapped(yaw: np.ndarray) -> np.ndarray:
    good = np.isfinite(yaw)
    found = yaw.copy()
    found[good] = np.unwrap(yaw[good])
    return found


def _by_gain(choice: Choice, plan: Plan, fit: Fit, units: Mapping[str, float], raw: Choice, by: str) -> Choice:
    """The unit in which a signal is as large as what it follows. `units`: how many of each are one in SI."""
    now = units.get(raw.unit, 1.0) if raw.unit else 1.0
    gain = abs(fit.gain) * now
    unit = next((u for u, size in units.items() if size / NEAR < gain < size * NEAR), "")
    if not unit:
        return choice
    says = (
        f"the file says [{choice.column.unit}], which is no unit of it"
        if choice.column and choice.column.unit
        else "the file gives no unit"
    )
    why = f"{says}: {unit}, as it is then as large as {by}: {CHECK_IT}"
    return replace(
        choice,
        unit=unit,
        settled=True,
        why=why if choice.why == NAMED or "by the size" in choice.why else f"{choice.why}; {why}",
    )


def _accelerations(plan: Plan, seen: Together) -> None:
    columns = _level(plan)
    if not columns:
        return
    fits = {}
    for axis, column in columns.items():

        def own(run: str, column: Column = column) -> Series | None:
            series = plan.source.series(run, column, "m/s2" if given(column, ("m/s2",)) else "")
            return series and seen.at(run, plan.name, series)

        fits[axis] = seen.fit(own, lambda run: seen.speed(run, 1))
    told = {axis: fit for axis, fit in fits.items() if fit is not None and fit.plain}
    ahead = max(told, key=lambda axis: abs(told[axis].correlation)) if told else "x" if "x" in columns else ""
    if not ahead:
        plan.doubts.append(f"{plan.name}: nothing tells which axis of its accelerometer is forward; write columns.a_x")
        return
    fit = told.get(ahead)
    sign = fit.sign if fit else 1.0
    why = (
        f"by its signal: follows how the speed changes, {fit.words}"
        if fit
        else f"{NAMED}: no speed tells which way is forward, {CHECK_IT}"
    )
    _put(plan, "a_x", columns[ahead], sign, why, fit)
    side, right = _right(plan, ahead, sign)
    if side in columns:
        unit = next((c.unit for c in plan.choices if c.channel == "a_x"), "")
        _put(plan, "a_y", columns[side], right, "right-handed with the others", None, unit)


def _right(plan: Plan, ahead: str, sign: float) -> tuple[str, float]:
    """The axis of a_y in the plan's axes, and its sign: to the left and up is ISO 8855's, to the right and down SAE J670's."""
    up = upright(plan.source)
    vertical = up[0] if up else next(iter(set(AXES) - {ahead} - ({"y"} if ahead != "y" else {"x"})))
    across = np.cross(np.eye(3)[AXES.index(vertical)], sign * np.eye(3)[AXES.index(ahead)])
    place = int(np.argmax(np.abs(across)))
    return AXES[place], float(np.sign(across[place]))


def _put(plan: Plan, channel: str, column: Column, sign: float, why: str, fit: Fit | None, unit: str = "") -> None:
    g = gravity(plan.source)
    size = acceleration_size(g)
    found, said = sized(column, ("m/s2",), size, everything(plan.source, column))
    if found == "?" and unit and unit != "?":
        found, said = unit, f"the file gives no unit; {unit} as for a_x"
    choice = Choice(channel, column.header, why, found, sign, found != "?", column=column, si="m/s2")
    if found == "?" and fit is not None:
        choice = _by_gain(
            choice,
            plan,
            fit,
            {"m/s2": 1.0, "g": 1 / 9.80665, "mg": 1000 / 9.80665},
            replace(choice, unit=""),
            "the change of speed",
        )
    elif said:
        choice = choice.because(said)
    plan.put(choice)
