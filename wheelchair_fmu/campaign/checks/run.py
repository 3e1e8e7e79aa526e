"""Checks of one run: what is there, how large it is, and whether it moves."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ...faults import WARNING, Fault, run_fault
from ..channels import BY_NAME, PUSHES, TIME
from ..draft import Draft
from ..resampled import REPEATED

FEWEST = 10  # samples of a run


def too_short(draft: Draft) -> Iterator[Fault]:
    if draft.rows.values and len(draft.kept) < FEWEST:
        start, stop = draft.entry.data.get("from"), draft.entry.data.get("to")
        if start is None and stop is None:
            fact, cure = f"only {len(draft.kept)} samples, at least {FEWEST} are needed", "log for longer"
        else:
            cut = " ".join(f"{k} {v} s" for k, v in (("from", start), ("to", stop)) if v is not None)
            fact = f"the cut {cut} leaves {len(draft.kept)} samples, at least {FEWEST} are needed"
            cure = _extent(draft)
        yield run_fault(draft.file, fact, cure)


def _extent(draft: Draft) -> str:
    time = draft.whole_time
    if time is None or not np.isfinite(time).any():
        return "widen it"
    return f"widen it; the file runs from {np.nanmin(time):.6g} to {np.nanmax(time):.6g} s"


def no_push(draft: Draft) -> Iterator[Fault]:
    for force, torque in PUSHES.items():
        if force not in draft.values and torque not in draft.values:
            cure = f"add a column '{force} [N]', name it in [columns], or write constant = {{ {force} = 0.0 }} in the run"
            yield run_fault(draft.file, f"no push force {force}", cure, 1)


def nothing_measured(draft: Draft) -> Iterator[Fault]:
    if not draft.channels:
        cure = "add columns such as 'yaw_rate [rad/s]' or name them in [columns]"
        yield run_fault(draft.file, "nothing is measured: no channel among the columns", cure, 1)


def input_gap(draft: Draft) -> Iterator[Fault]:
    assert draft.time is not None or not draft.gaps
    for name, gaps in draft.gaps.items():
        series = draft.values[name]
        for gap in () if np.isnan(series).all() else gaps:
            where = "at the end of the run" if gap.stop == len(series) else "at the start of the run"
            if gap.inside and draft.time is not None:
                where = f"for {draft.time[gap.stop] - draft.time[gap.start - 1]:.4g} s, too long for a straight line"
            fact = f"{name} is missing {where}"
            cure = "fill it in, or cut the run by from and to"
            yield run_fault(draft.file, fact, cure, draft.line(gap.start), draft.header(name))


def silent(draft: Draft) -> Iterator[Fault]:
    """Its own sentence, in place of one for each channel and for the speed."""
    if draft.silent:
        fact = "no channel changes in this run (the chair stood still, or the logger held), so it says nothing and is left out"
        yield run_fault(draft.file, fact, "remove the run, or record it again", severity=WARNING)


def empty_column(draft: Draft) -> Iterator[Fault]:
    for name, series in draft.logged.items():
        if len(series) and np.isnan(series).all():
            if name in draft.inputs:
                cure = f"remove it and write constant = {{ {name} = 0.0 }} in the run, or give the values"
                yield run_fault(draft.file, f"the input {name} holds only gaps", cure, column=draft.header(name))
            elif not draft.silent:
                fact = f"{name} holds only gaps and is left out"
                yield run_fault(draft.file, fact, "remove the column", column=draft.header(name), severity=WARNING)


def stuck(draft: Draft) -> Iterator[Fault]:
    """Pushes may stand still: nobody may have pushed."""
    for name, series in ({} if draft.silent else draft.logged).items():
        if name not in draft.inputs and np.isfinite(series).sum() > 1 and np.nanmin(series) == np.nanmax(series):
            fact = f"{name} never changes from {np.nanmin(series):.6g} {BY_NAME[name].unit.name} and is left out"
            cure = "check the sensor, or remove the column"
            yield run_fault(draft.file, fact, cure, column=draft.header(name), severity=WARNING)


def implausible(draft: Draft) -> Iterator[Fault]:
    for name, series in draft.values.items():
        channel = BY_NAME[name]
        odd = np.flatnonzero((series < channel.low) | (series > channel.high))
        if odd.size:
            i = odd[np.argmax(np.abs(series[odd]))]
            value, unit = series[i], channel.unit.name
            bound = channel.high if value > channel.high else channel.low
            side = "above" if value > channel.high else "below"
            fact = f"{name} reaches {value:.4g} {unit}, {side} any plausible {bound:g} {unit}"
            cure = f"check its unit (is it {channel.wrong_unit}?)"
            if name in draft.constants:
                yield run_fault(draft.file, fact, cure, severity=WARNING)
            else:
                yield run_fault(draft.file, fact, cure, draft.line(int(i)), draft.header(name), WARNING)


def resampled(draft: Draft) -> Iterator[Fault]:
    for name, found in draft.resampled.items():
        low, high = np.floor(found.rows + 0.05), np.ceil(found.rows - 0.05)
        rows = f"{low:g} rows" if low == high else f"{low:g} or {high:g} rows"
        seen = "changes only every" if found.how == REPEATED else "changes its slope only every"
        rate = ""
        if draft.time is not None and (step := float(np.median(np.diff(draft.time)))) > 0:
            rate = f"at about {1 / (found.rows * step):.3g} Hz "
        fact = f"{name} {seen} {rows}: it was sampled {rate}and {found.how}; what is no reading is left out"
        cure = "leave its cells empty in rows without a new reading"
        yield run_fault(draft.file, fact, cure, column=draft.header(name), severity=WARNING)


def spike(draft: Draft) -> Iterator[Fault]:
    for name, found in draft.spikes.items():
        usual = float(np.nanmedian(draft.values[name]))
        i = max(found, key=lambda row: abs(found[row] - usual))
        assert draft.time is not None  # without it nobody looks for any
        farthest = f"{found[i]:.4g} {BY_NAME[name].unit.name} at {draft.time[i]:.6g} s"
        if len(found) == 1:
            fact = f"{name} reads {farthest}, alone between readings that agree, and is left out there"
        else:
            fact = f"{name} has {len(found)} readings that stand alone and are left out, the farthest {farthest}"
        cure = "check the sensor and its cable; no chair moves so"
        yield run_fault(draft.file, fact, cure, draft.line(i), draft.header(name), WARNING)


def constant_replaces(draft: Draft) -> Iterator[Fault]:
    for name in draft.constants:
        if name in draft.bindings.found:
            fact = f"the constant {name} = {draft.values[name][0]:g} replaces this column" if len(draft.kept) else name
            yield run_fault(draft.file, fact, "remove one of them", 1, draft.header(name), WARNING)


def absent_column(draft: Draft) -> Iterator[Fault]:
    """Only a warning: another run may have it. That no run has it is an error of the campaign."""
    for name in draft.bindings.absent:
        if name != TIME.name and name not in draft.values:
            cure = "not measured in this run; give it by constant if it is known"
            yield run_fault(draft.file, f"no column for {name}, which [columns] renames", cure, 1, severity=WARNING)


def no_start_speed(draft: Draft) -> Iterator[Fault]:
    if draft.entry.data.get("u0") is None and not draft.silent:
        if draft.first_speed is None:
            fact, cure = "no u0 and no speed measured to take it from", "write u0 = ... in m/s in the run"
        else:
            fact = f"no u0, {draft.first_speed:.3g} m/s is taken from the first measured speeds"
            cure = "write u0 in the run to say it yourself"
        yield run_fault(draft.file, fact, cure, severity=WARNING)


def start_speed_differs(draft: Draft) -> Iterator[Fault]:
    stated, measured = draft.entry.number("u0"), None if draft.silent else draft.first_speed
    if stated is not None and measured is not None and abs(stated - measured) > max(0.3, 0.5 * abs(measured)):
        fact = f"u0 = {stated:g} m/s, but the first measured speeds are {measured:.3g} m/s"
        yield run_fault(draft.file, fact, "correct u0, or the unit of the speeds", severity=WARNING)


RUN_CHECKS: tuple[Callable[[Draft], Iterator[Fault]], ...] = (
    too_short, no_push, nothing_measured, input_gap, silent, empty_column, stuck, implausible, resampled, spike,
    constant_replaces, absent_column, no_start_speed, start_speed_differs,
)  # fmt: skip
