"""Checks of all runs together: noise against the data, columns that no run has."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...faults import ERROR, NOTE, WARNING, Fault, some
from ..angles import TURN
from ..binding import absent_fault
from ..channels import BY_NAME
from ..document import FILE, Document, number
from ..draft import Draft
from ..noise import Noise
from ..recorded import Recorded
from ..rims import Rim

RATIO = 20.0  # between stated and visible noise


@dataclass(frozen=True)
class Assembly:
    """The campaign.toml, the runs that could be read, their noise, and what their rims show where nobody touches them."""

    doc: Document
    runs: tuple[Recorded, ...]
    noise: Noise
    rims: Mapping[int, Mapping[str, Rim]]


def column_in_no_run(all_: Assembly) -> Iterator[Fault]:
    known = {name for run in all_.runs for name in run.constants}
    for own, name in _absent(all_):
        if name not in known and all(name not in d.bindings.found for d in own):
            headers = dict.fromkeys(header for draft in own for header in draft.table.headers)
            yield absent_fault(all_.doc, own[0].part.device, name, list(headers))


def read_by_its_own_name(all_: Assembly) -> Iterator[Fault]:
    """A column that [columns] names and no recording has, where another one has the channel's own name."""
    for own, name in _absent(all_):
        if there := [d for d in own if name in d.bindings.found]:
            missing = absent_fault(all_.doc, own[0].part.device, name, there[0].table.headers)
            instead = f"{missing.fact}, so that it is read from {there[0].header(name)!r}"
            yield replace(missing, fact=instead, cure="correct [columns], or leave it out there", severity=WARNING)


def _absent(all_: Assembly) -> Iterator[tuple[list[Draft], str]]:
    """Each device's recordings with a channel for which [columns] names a column that none of them has."""
    drafts = [draft for run in all_.runs for draft in run.drafts]
    for device in dict.fromkeys(draft.part.device.name for draft in drafts):
        own = [draft for draft in drafts if draft.part.device.name == device]
        yield from ((own, name) for name in sorted(set.intersection(*(set(d.bindings.absent) for d in own))))


def nobody_speaks(all_: Assembly) -> Iterator[Fault]:
    """Runs that say nothing are left out, and that may leave none of a role."""
    for role, severity, lack in (
        ("fit", ERROR, "there is nothing to learn from"),
        ("holdout", WARNING, "no effect can be proven on data it has not seen"),
    ):
        entries = [entry for entry in all_.doc.entries if entry.text("role") == role]
        silent = [run for run in all_.runs if run.silent and run.entry.text("role") == role]
        if entries and len(silent) == len(entries):
            fact = f"no channel changes in any run with the role {role!r}, so {lack}"
            cure = f"give role = {role!r} to a run in which the chair moves"
            yield all_.doc.fault("run", fact, cure, severity=severity)


def clocks_unknown(all_: Assembly) -> Iterator[Fault]:
    """Devices that nothing started together read the same moment at different times, which looks like whatever is missing."""
    without = [(run, [d for d in run.drafts if not run.knows_clock_of(d)]) for run in all_.runs]
    devices = dict.fromkeys(d.part.device.name for _, drafts in without for d in drafts)
    if devices:
        runs = [run.name for run, drafts in without if drafts]
        where = f"run {runs[0]}" if len(runs) == 1 else f"{len(runs)} runs, the first {runs[0]}"
        first = next(run.drafts[0].part.device.name for run, drafts in without if drafts)
        fact = f"nothing says how far the clocks of {some(devices)} are off that of {first} in {where}"
        zero = ", ".join(f"{name} = 0" for name in devices)
        cure = f"run `wheelchair sync`, or write clocks = {{ {zero} }} in a run whose devices one trigger started"
        yield Fault(FILE, None, None, fact, cure, WARNING)


def rider_too_heavy(all_: Assembly) -> Iterator[Fault]:
    """What moves on a chair is part of its mass."""
    moving, whole = number(all_.doc.table("rider").get("m")), number(all_.doc.table("chair").get("m"))
    if moving and whole and moving >= whole:
        fact = f"[rider] m = {moving:g} kg moves on a chair of {whole:g} kg, which has the rider in it"
        yield all_.doc.fault("rider.m", fact, "correct one of them; [chair] m is of chair and rider together")


def bad_noise(all_: Assembly) -> Iterator[Fault]:
    for path, error in all_.noise.faults:
        yield all_.doc.fault(path, error.fact, error.cure)


def noise_unknown(all_: Assembly) -> Iterator[Fault]:
    for name in all_.noise.unknown:
        fact = f"the noise of {name} is not given and cannot be estimated from its samples"
        yield all_.doc.fault("noise", fact, f"write [noise] {name} = ... , or remove the channel")


def noise_estimated(all_: Assembly) -> Iterator[Fault]:
    names = [f"{name} {all_.noise.sd[name]:.2g} {BY_NAME[name].unit.name}" for name in sorted(all_.noise.estimated)]
    if names:
        fact = f"noise not given, estimated from the samples: {', '.join(names)}"
        yield all_.doc.fault("noise", fact, "write what the sensors' data sheets say in [noise]", severity=WARNING)


def noise_against_data(all_: Assembly) -> Iterator[Fault]:
    for name, seen in all_.noise.seen.items():
        stated = all_.noise.sd.get(name)
        if name in all_.noise.estimated or not stated or not seen:
            continue
        unit = BY_NAME[name].unit.name
        if stated > RATIO * seen:
            fact = f"noise of {name} is {stated:.2g} {unit}, but from sample to sample only {seen:.2g} {unit} is seen"
            cure = "check its unit; if the file was filtered before, leave it"
        elif seen > RATIO * stated:
            fact = f"noise of {name} is {stated:.2g} {unit}, but from sample to sample {seen:.2g} {unit} is seen"
            cure = "check its unit"
        else:
            continue
        yield all_.doc.fault(f"noise.{name}", fact, cure, severity=WARNING)


def glitches(all_: Assembly) -> Iterator[Fault]:
    """Once for each wheel: encoders spoil a reading where a turn ends, and there are as many as turns; of more something is
    wrong."""
    found: dict[str, list[tuple[str, int, float]]] = {}
    for draft in (d for run in all_.runs for d in run.drafts):
        for name, places in draft.glitches.items():
            found.setdefault(name, []).append((draft.file, len(places), _turns(draft.angles[name])))
    for name, of in found.items():
        if total := sum(n for _, n, _ in of):
            file = next(file for file, n, _ in of if n)
            fact = f"{name} has {total} readings far from both neighbours, the first in {file}, which are left out"
            more = sum(n > turns + 1 for _, n, turns in of)
            if more:
                fact = f"{fact}; in {more} of {len(of)} recordings they are more than the wheel turned"
                yield Fault(FILE, None, None, fact, "look at its encoder, or its wiring", WARNING)
            else:
                yield Fault(FILE, None, None, f"{fact}: about one each turn", "nothing is to be done", NOTE)


def _turns(angle: np.ndarray) -> float:
    """Of a wheel, by its angle (n,) in rad without jumps."""
    there = angle[np.isfinite(angle)]
    return float(np.ptp(there)) / TURN if there.size else 0.0


CAMPAIGN_CHECKS: tuple[Callable[[Assembly], Iterator[Fault]], ...] = (
    column_in_no_run,
    read_by_its_own_name,
    nobody_speaks,
    glitches,
    clocks_unknown,
    rider_too_heavy,
    bad_noise,
    noise_unknown,
    noise_estimated,
    noise_against_data,
)
