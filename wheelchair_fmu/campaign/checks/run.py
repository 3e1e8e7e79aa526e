"""Checks of one run, of all its files together: what is there, and how it starts."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ...faults import ERROR, NOTE, SHOWN, WARNING, Fault, run_fault
from ...units import same_dimension
from ..channels import BY_NAME, MOMENTUM, PHASE, PHASE_RATE, POSITION, PUSHES, SIDES
from ..document import number
from ..draft import Draft
from ..recorded import Recorded
from .file import FEWEST, beyond_plausible

SHORTEST = 0.5  # s of a run, or of it in which the rider's body is seen, at least
GAINED = 0.5  # m/s that no floor in a laboratory gives a chair which nobody pushes
QUICKEST = 4.0  # strokes in a second: sprinters make 2 to 3
LEAVE_OUT = "leave it out: the pushes tell it"
FASTEST = 50.0  # m/s that a run may start at


def no_push(run: Recorded) -> Iterator[Fault]:
    for force, torque in PUSHES.items():
        if force not in run.values and torque not in run.values:
            cure = f"add a column '{force} [N]', name it in [columns], or write constant = {{ {force} = 0.0 }} in the run"
            if idle := _pushes_unread(run):
                cure = f"name it in [columns], if it is {' or '.join(map(repr, idle[:SHOWN]))}"
            yield run_fault(run.file, f"no push force {force}", cure, 1)


def _pushes_unread(run: Recorded) -> list[str]:
    """Headers of forces and torques that nothing is taken from."""
    found: list[str] = []
    for draft in run.drafts:
        used = {binding.index for binding in draft.bindings.found.values()}
        units = enumerate(zip(draft.table.headers, draft.table.units, strict=True))
        found += [h for i, (h, u) in units if i not in used and u and any(same_dimension(u, of) for of in ("N", "N.m"))]
    return found


def nothing_measured(run: Recorded) -> Iterator[Fault]:
    if not run.channels:
        cure = "add columns such as 'yaw_rate [rad/s]' or name them in [columns]"
        yield run_fault(run.file, "nothing is measured: no channel among the columns", cure, 1)


def body_without_mass(run: Recorded) -> Iterator[Fault]:
    if POSITION in run.values and MOMENTUM not in run.values and not number(run.doc.table("rider").get("m")):
        fact = f"{POSITION} is given, but not the mass that moves with it"
        cure = (
            "write [rider] m = ... in kg: of the whole person where it is made from markers, else of the part that was measured"
        )
        yield run_fault(run.file, fact, cure)


def body_partly_seen(run: Recorded) -> Iterator[Fault]:
    if run.seen is None or run.time is None:
        return
    first, last = run.seen
    if last - first < SHORTEST:
        fact = f"the rider's body is nowhere seen for {SHORTEST:g} s without a longer gap"
        yield run_fault(run.file, fact, f"leave {POSITION} or {MOMENTUM} out, or fill its gaps")
    elif first - run.time[0] + run.time[-1] - last > SHORTEST:
        whole = f"{run.time[0]:.4g} to {run.time[-1]:.4g} s"
        fact = f"the rider's body is seen from {first:.4g} to {last:.4g} s; the rest of {whole} is left out"
        yield run_fault(run.file, fact, "nothing is to be done", severity=NOTE)


def strokes_that_do_not_grow(run: Recorded) -> Iterator[Fault]:
    """A phase that somebody gives is used as it is, so it has to be whole, in strokes, and of a person."""
    if PHASE not in run.values:
        if PHASE_RATE in run.values:
            cure = f"add {PHASE}, from which the rate follows, or leave both out: the pushes tell them"
            yield run_fault(run.file, f"{PHASE_RATE} is given, but not {PHASE}", cure)
        return
    phase, time = run.values[PHASE], run.time
    if time is None or len(time) < 2:
        return  # a check says so
    missing = int((~np.isfinite(phase)).sum())
    if missing:
        yield run_fault(run.file, f"{PHASE} is missing in {missing} of {len(phase)} rows", f"fill its gaps, or {LEAVE_OUT}")
        return
    rate = np.diff(phase) / np.diff(time)
    wrong = np.flatnonzero((rate < 0) | (rate > QUICKEST))
    if wrong.size:
        first, way = rate[wrong[0]], "falls" if rate[wrong[0]] < 0 else "grows"
        fact = f"{PHASE} {way} by {abs(first):.3g} a second at {time[wrong[0]]:.4g} s"
        cure = f"count strokes on from 0, without going back to it, and not in radians or degrees; or {LEAVE_OUT}"
        yield run_fault(run.file, fact, cure)


def silent(run: Recorded) -> Iterator[Fault]:
    """Its own sentence, in place of one for each channel and for the speed."""
    if run.silent and (run.time is None or len(run.time) >= FEWEST):
        fact = "no channel changes in this run (the chair stood still, or the logger held), so it says nothing and is left out"
        yield run_fault(run.file, fact, "remove the run, or record it again", severity=WARNING)


def over_at_once(run: Recorded) -> Iterator[Fault]:
    if run.time is not None and len(run.time) >= FEWEST and 0 < (lasts := float(run.time[-1] - run.time[0])) < SHORTEST:
        fact = f"the run lasts {lasts:.2g} s, in which a chair hardly moves"
        yield run_fault(run.file, fact, "check the unit of its time, or leave it out", severity=WARNING)


def nobody_pushes(run: Recorded) -> Iterator[Fault]:
    """A push that is 0 for want of a sensor is no push of 0: the chair would gain speed by nothing."""
    pushes = [run.values[name] for pair in PUSHES.items() for name in pair if name in run.values]
    wheels = [run.values[name] for name in SIDES if name in run.values]
    if not pushes or any(np.any(push) for push in pushes) or not wheels:
        return
    speeds = [np.abs(wheel[np.isfinite(wheel)]) for wheel in wheels]
    gained = min((float(np.quantile(v, 0.95) - np.mean(v[:FEWEST])) for v in speeds if v.size >= FEWEST), default=0.0)
    if gained > GAINED:
        fact = f"all pushes are 0, and yet the wheels gain {gained:.2g} m/s"
        cure = "give what was pushed, or begin the run (from = ...) when the chair rolls by itself; on a ramp this may be right"
        yield run_fault(run.file, fact, cure, severity=WARNING)


def constant_replaces(run: Recorded) -> Iterator[Fault]:
    for name, value in run.constants.items():
        for draft in (d for d in run.drafts if name in d.bindings.found):
            fact = f"the constant {name} = {value:g} replaces this column" if len(draft.kept) else name
            yield run_fault(draft.file, fact, "remove one of them", 1, draft.header(name), WARNING)


def implausible_constant(run: Recorded) -> Iterator[Fault]:
    for name, value in run.constants.items():
        channel = BY_NAME[name]
        if not channel.low <= value <= channel.high:
            fact, cure, absurd = beyond_plausible(channel, value)
            yield run_fault(run.file, fact, cure, severity=ERROR if absurd else WARNING)


def measured_twice(run: Recorded) -> Iterator[Fault]:
    """Several devices may see the same; a campaign says which of them is compared."""
    of: dict[str, list[str]] = {}
    for draft in run.drafts:
        for name in draft.values:
            of.setdefault(name, []).append(draft.part.device.name)
    for name, devices in of.items():
        if len(devices) > 1:
            cure = f'keep it in one of them; in the other [[recording]] write columns.{name} = ""'
            yield run_fault(run.file, f"{name} comes from {' and '.join(devices)}", cure)


def no_common_time(run: Recorded) -> Iterator[Fault]:
    """Pushes are needed from the first row to the last; whoever has no sample there says nothing of the run."""
    drafts = [d for d in run.drafts if d.time is not None and d.time.size]
    if len(run.drafts) < 2 or len(drafts) < len(run.drafts):
        yield from _pushes_elsewhere(run)
        return
    spans = {d.part.device.name: f"{d.time[0]:.4g} to {d.time[-1]:.4g} s" for d in drafts if d.time is not None}
    cure = "correct the run's clocks, or leave one of the devices out"
    if run.time is None or len(run.time) < FEWEST:
        said = ", ".join(f"{name} {span}" for name, span in spans.items())
        yield run_fault(run.file, f"its devices have no time in common: {said}", cure)
        return
    for draft in drafts:
        if draft.time is not None and (draft.time[-1] < run.time[0] or draft.time[0] > run.time[-1]):
            name, whole = draft.part.device.name, f"{run.time[0]:.4g} to {run.time[-1]:.4g} s"
            fact = f"{name} recorded from {spans[name]}, the pushes from {whole}: they have no time in common"
            yield run_fault(draft.file, fact, cure)
        elif not any(_overlap(draft, other) for other in drafts if other is not draft):
            name = draft.part.device.name
            others = ", ".join(f"{other} {span}" for other, span in spans.items() if other != name)
            fact = f"{name} recorded from {spans[name]}, and no other device did then: {others}"
            yield run_fault(draft.file, fact, cure)


def _overlap(one: Draft, other: Draft) -> bool:
    assert one.time is not None and other.time is not None
    return bool(one.time[0] <= other.time[-1] and other.time[0] <= one.time[-1])


def _pushes_elsewhere(run: Recorded) -> Iterator[Fault]:
    """Of a run of one file, whose pushes have a clock of their own."""
    lasts = 0.0 if run.time is None or not run.time.size else float(run.time[-1] - run.time[0])
    if 0 < lasts <= abs(run.late):
        fact = f"clocks.pushes moves the pushes by {run.late:g} s, out of a run of {lasts:.4g} s"
        yield run_fault(run.file, fact, "give it in s")


def no_start_speed(run: Recorded) -> Iterator[Fault]:
    if run.entry.data.get("u0") is None and not run.silent:
        if run.first_speed is None:
            fact, cure = "no u0 and no speed measured to take it from", "write u0 = ... in m/s in the run"
        else:
            fact = f"no u0, {run.first_speed:.3g} m/s is taken from the first measured speeds"
            cure = "write u0 in the run to say it yourself"
        yield run_fault(run.file, fact, cure, severity=WARNING)


def start_speed_differs(run: Recorded) -> Iterator[Fault]:
    if abs(run.entry.number("u0") or 0.0) > FASTEST:
        fact = f"u0 = {run.entry.number('u0'):g} m/s is no speed of a wheelchair"
        yield run_fault(run.file, fact, "give it in m/s")
        return
    stated, measured = run.entry.number("u0"), None if run.silent else run.first_speed
    if stated is not None and measured is not None and abs(stated - measured) > max(0.3, 0.5 * abs(measured)):
        fact = f"u0 = {stated:g} m/s, but the first measured speeds are {measured:.3g} m/s"
        yield run_fault(run.file, fact, "correct u0, or the unit of the speeds", severity=WARNING)


RUN_CHECKS: tuple[Callable[[Recorded], Iterator[Fault]], ...] = (
    no_push,
    nothing_measured,
    body_without_mass,
    body_partly_seen,
    strokes_that_do_not_grow,
    silent,
    over_at_once,
    nobody_pushes,
    constant_replaces,
    implausible_constant,
    measured_twice,
    no_common_time,
    no_start_speed,
    start_speed_differs,
)
