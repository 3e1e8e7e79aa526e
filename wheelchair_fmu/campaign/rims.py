"""Baselines of a campaign's instrumented wheels: what each run's torques show where nobody touches the rim, taken out.

Only for pushes that [nuisance] names. What the estimates leave unsure stays with the run, as constants with their covariance.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..faults import WARNING, Fault, run_fault
from ..model.chassis import DEFAULTS
from . import baselines
from .channels import BY_NAME, PUSH_NAMES
from .document import FILE
from .draft import Draft
from .recorded import Recorded
from .records import Baseline
from .series import integral

Series = tuple[np.ndarray, np.ndarray]
ARM = DEFAULTS["wheel.R"]  # m: a force at the rim of contact as a torque, where the campaign gives no radius
SURE = 5.0  # standard errors from which a baseline that nobody asked to be taken out is mentioned,
LARGE = 0.3  # N m


@dataclass(frozen=True, eq=False)
class Rim:
    """What one rim shows in one run, in N m; the radius by which its recorded push becomes a torque; and the wheel's angle,
    where anything tells it, as times by its own clock (s) and rad, (n,) each."""

    found: baselines.Baseline
    arm: float
    angle: Series | None

    def as_json(self) -> dict[str, float]:
        """The baseline, the amplitude of its ripple, and the baseline's standard error, in N m."""
        return {"offset": self.found.offset, "ripple": self.found.ripple, "se": self.found.offset_se}


def rims(runs: Sequence[Recorded], pushes: Collection[str]) -> dict[int, dict[str, Rim]]:
    """For each run by its place in campaign.toml, and each of these pushes that it recorded, what its rim shows."""
    found: dict[int, dict[str, Rim]] = {run.entry.place: {} for run in runs}
    for name in pushes:
        of = {str(run.entry.place): (run, d) for run in runs if (d := run.draft_of(name)) is not None and d.time is not None}
        alone = {place: by_speed for place, (run, d) in of.items() if (by_speed := _by_speed(run, d, name)) is not None}
        angles = {place: alone[place] if place in alone else _measured(d, name) for place, (_, d) in of.items()}
        for places in ([place for place in of if place not in alone], *([place] for place in alone)):
            series = {place: _recording(of[place][1], name, angles[place]) for place in places}
            for place, baseline in (baselines.baselines(series) if series else {}).items():
                found[int(place)][name] = Rim(baseline, _arm(of[place][1], name), angles[place])
    return found


def _arm(draft: Draft, name: str) -> float:
    return (draft.part.device.radius or ARM) if name.startswith("F_") else 1.0


def _recording(draft: Draft, name: str, angle: Series | None) -> baselines.Recording:
    assert draft.time is not None
    turned = None if angle is None else np.interp(draft.time, *angle, left=np.nan, right=np.nan)
    return draft.time, _arm(draft, name) * draft.values[name], turned


def _measured(draft: Draft, name: str) -> Series | None:
    """The angle of the wheel, where the same device tells it: in every run it counts from one place on the wheel."""
    angle = draft.angles.get(f"wheel_angle_{name[-1]}")
    if angle is None:
        return None
    assert draft.time is not None
    there = np.isfinite(angle)
    return draft.time[there], angle[there]


def _by_speed(run: Recorded, draft: Draft, name: str) -> Series | None:
    """Where the device does not tell it, the wheel's angle by its speed, from where it stood when the run began: a wheel that
    stands shows its ripple as a baseline, and nobody could tell the two apart."""
    speed = run.channels.get(f"wheel_speed_{name[-1]}")
    if _measured(draft, name) is not None or speed is None or run.time is None:
        return None
    there = np.isfinite(speed)
    time, turned = run.time[there] - run.late, speed[there] / (draft.part.device.radius or ARM)
    return (time, integral(time, turned, time)) if len(time) > 1 else None


def corrected(run: Recorded, of: Mapping[str, Rim]) -> tuple[dict[str, np.ndarray], tuple[Baseline, ...]]:
    """The run's inputs (n,) by name without what its rims show, and what is unsure of that."""
    inputs, unsure = dict(run.inputs), []
    for name, rim in of.items():
        draft = run.draft_of(name)
        if not rim.found.enough or draft is None or draft.time is None or run.time is None:
            continue
        shapes, sizes, covariance = _shapes(run.time - run.late, rim)
        inputs[name] = inputs[name] - shapes @ sizes
        if covariance.any():
            unsure.append(Baseline(BY_NAME[name].fmu, shapes, covariance))
    return inputs, tuple(unsure)


def _shapes(time: np.ndarray, rim: Rim) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What a baseline and a ripple of 1 add to the push that was recorded at `time` (n, m), how much there is of each (m,), its
    covariance."""
    found, one = rim.found, np.ones((len(time), 1)) / rim.arm
    if rim.angle is None or not found.covariance[1, 1]:
        return one, np.array([found.offset]), found.covariance[:1, :1]
    turned = np.interp(time, *rim.angle)[:, None]
    shapes = np.hstack([one, np.sin(turned) / rim.arm, np.cos(turned) / rim.arm])
    return shapes, np.array([found.offset, found.ripple_sin, found.ripple_cos]), found.covariance


def unfounded(runs: Sequence[Recorded], found: Mapping[int, Mapping[str, Rim]]) -> list[Fault]:
    """A warning for each rim whose baseline was asked for and cannot be told."""
    cure = "record some seconds without hands on the rims, or take the push out of [nuisance]"
    return [
        run_fault(run.file, f"the baseline of {name} cannot be told: {rim.found.why}", cure, severity=WARNING)
        for run in runs
        for name, rim in found.get(run.entry.place, {}).items()
        if not rim.found.enough
    ]


def unasked(runs: Sequence[Recorded], asked: Collection[str]) -> list[Fault]:
    """A warning for each rim that plainly shows something where nobody touches it, and that nobody asked to be corrected.

    Only of torques: a plain force comes from other instruments than a wheel.
    """
    by_torque = [run for run in runs if any(_is_torque(run, name) for name in run.inputs)]
    pushes = [name for name in PUSH_NAMES if name not in asked and any(_is_torque(run, name) for run in by_torque)]
    found, warnings = rims(by_torque, pushes), []
    for name in pushes:
        of = {run.name: found[run.entry.place][name].found for run in by_torque if name in found[run.entry.place]}
        plain = {run: b for run, b in of.items() if b.enough and abs(b.offset) > max(SURE * b.offset_se, LARGE)}
        if plain:
            run, worst = max(plain.items(), key=lambda item: abs(item[1].offset))
            more = f", and something in {len(plain) - 1} more runs" if len(plain) > 1 else ""
            fact = f"the rim of {name} shows {worst.offset:.2g} N m in {run} where nobody touches it{more}"
            warnings.append(Fault(FILE, None, None, fact, f"write {name} = true in [nuisance] to take it out", WARNING))
    return warnings


def _is_torque(run: Recorded, name: str) -> bool:
    draft = run.draft_of(name)
    bound = draft.bindings.found.get(name) if draft else None
    return bound is not None and (name.startswith("M_") or bound.through_radius)
