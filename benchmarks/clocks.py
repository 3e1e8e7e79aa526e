"""Clocks, push shifts and torque baselines beside their truths: `python -m benchmarks.clocks [measurements folder]`."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from wheelchair_fmu.campaign import Run, read
from wheelchair_fmu.campaign.baselines import baselines
from wheelchair_fmu.campaign.clocks import Signal, odd_ones_out, offsets, push_shifts

from . import lab_files

ROOT = Path(__file__).resolve().parents[1]
MEASUREMENTS = ROOT.parent / "shared" / "measurements"
SHIFTS = (0.02, 0.05, 0.1, 0.3, 1.3)  # s
Row = tuple[str, float, float]  # what, error, standard error


def clock_errors(lab: Path, truth: dict, run: str) -> Iterator[Row]:
    """Of each device beside the first: error and standard error in s; an infinite error where it is not sure."""
    clocks = offsets(lab_files.signals(lab, run))
    files = truth["runs"][run]["files"]
    first = next(iter(clocks))
    for name, clock in clocks.items():
        if name != first:
            error = clock.offset - (files[name]["offset_s"] - files[first]["offset_s"])
            yield name, error if clock.sure else np.inf, clock.se


def baseline_errors(lab: Path, truth: dict, side: str) -> Iterator[Row]:
    """Of each run's baseline and of the ripple's two parts: error and standard error in N m."""
    found = baselines({run: lab_files.angle(lab, run, side) for run in truth["runs"]})
    for run, b in found.items():
        yield f"{run} {side} baseline", b.offset - truth["runs"][run]["baseline_Nm"][side], b.offset_se
    b, hidden = next(iter(found.values())), truth["hidden"]
    size, phase = hidden["ripple_Nm"][side], hidden["ripple_phase_rad"][side]
    yield f"{side} ripple, sine", b.ripple_sin - size * np.cos(phase), float(b.covariance[1, 1] ** 0.5)
    yield f"{side} ripple, cosine", b.ripple_cos - size * np.sin(phase), float(b.covariance[2, 2] ** 0.5)


def run_signals(run: Run, early: float = 0.0) -> list[Signal]:
    """A run's readings, and its pushes standing `early` s before the motion that they make."""
    read_ = [Signal("file", name, run.time, values) for name, values in run.channels.items()]
    pushed = [
        Signal("file", name.split(".")[1], run.time, np.interp(run.time + early, run.time, values))
        for name, values in run.inputs.items()
        if name.startswith("push.")
    ]
    return read_ + pushed


def shift_lines(folder: Path) -> Iterator[str]:
    """Each run of a campaign shifted in turn: what is estimated, and who is named."""
    campaign = read(folder)
    plain = {run.name: run_signals(run) for run in campaign.runs}
    yield f"{folder.name}: named without any shift: {sorted(odd_ones_out(plain)) or 'none'}"
    for run in campaign.runs:
        told = []
        for shift in SHIFTS:
            runs = plain | {run.name: run_signals(run, shift)}
            odd = odd_ones_out(runs)
            s = odd.get(run.name) or push_shifts(runs).get(run.name)
            estimate = f"{1000 * s.seconds:.0f} ± {1000 * s.se:.0f}" if s else "-"
            how = "named" if run.name in odd else "unique" if s and s.unique else "not unique"
            wrong = [name for name in odd if name != run.name]
            told.append(f"{1000 * shift:.0f}: {estimate} {how}" + (f", WRONG {wrong}" if wrong else ""))
        yield f"  {run.name:18} " + "; ".join(told)


def main(measurements: Path) -> None:
    answers = json.loads((measurements / "lab-answers.json").read_text())
    z = []
    for name in ("lab-00", "lab-01", "lab-02"):
        lab, truth = measurements / name, answers[name]
        found = (row for run in truth["runs"] for row in clock_errors(lab, truth, run))
        rows = [(what, 1000 * error, 1000 * se, "ms") for what, error, se in found]
        if name != "lab-02":  # its amplifier was zeroed, and recorded no angle
            rows += [(*row, "N m") for side in ("left", "right") for row in baseline_errors(lab, truth, side)]
        for what, error, se, unit in rows:
            print(f"{name} {what:32} error {error:8.3f} ± {se:.3f} {unit}, {error / se:5.2f} standard errors")
        z += [error / se for _, error, se, _ in rows]
    share, size = np.mean(np.abs(z) < 2), np.sqrt(np.mean(np.square(z)))
    print(f"{len(z)} figures, {share:.1%} within two standard errors, RMS {size:.2f}")
    for line in shift_lines(ROOT / "examples" / "sample-campaign"):
        print(line, flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else MEASUREMENTS)
