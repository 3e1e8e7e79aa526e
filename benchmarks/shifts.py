"""Pushes of one run of the sample campaign recorded early or late, and what `diagnose` then says of the chair and of the clock:
python -m benchmarks.shifts [RUN ...] [--night]

All 60 cases take about 45 minutes on two cores; `--night` does those that `make nightly` holds.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from wheelchair_fmu.campaign import Campaign, Clock, Run, covered, read
from wheelchair_fmu.inference.decision.diagnosis import Diagnosis
from wheelchair_fmu.inference.decision.verdict import diagnose

SAMPLE = Path(__file__).resolve().parents[1] / "examples" / "sample-campaign"
RUNS = ("coast-down", "straight-strokes", "steady-right", "slalom-slow", "slalom-quick", "random-steps")
SIZES = (0.02, 0.05, 0.1, 0.3, 1.3)  # s
NIGHT = (  # every size with both signs, and every run
    ("coast-down", 0.3),
    ("coast-down", -1.3),
    ("straight-strokes", 0.02),
    ("straight-strokes", -0.3),
    ("steady-right", 0.05),
    ("steady-right", -0.1),
    ("slalom-slow", 0.1),
    ("slalom-quick", -0.02),
    ("slalom-quick", 1.3),
    ("random-steps", -0.05),
)
# whose verdict is another one, as some of what told is gone: see tests/inference/test_timing.py
TOO_LITTLE = (("steady-right", 1.3), ("slalom-slow", -1.3))


@dataclass(frozen=True)
class Case:
    """The run whose pushes stand `seconds` before the motion that they make."""

    run: str
    seconds: float


def cases() -> list[Case]:
    return [Case(run, sign * size) for run in RUNS for size in SIZES for sign in (1, -1)]


def shifted(run: Run, seconds: float) -> Run:
    """The run with its pushes recorded `seconds` early."""
    return replace(run, inputs={n: np.interp(run.time + seconds, run.time, w) for n, w in run.inputs.items()})


def with_shift(campaign: Campaign, case: Case) -> Campaign:
    return _with(campaign, case.run, lambda run: shifted(run, case.seconds))


def less(campaign: Campaign, case: Case, sd: float) -> Campaign:
    """The campaign without the shift, of which as much is lost: the stretch of the run whose pushes would then not have been
    recorded, and how its clock stands, but for a standard deviation of `sd` s."""
    return _with(campaign, case.run, lambda run: covered(_in_doubt(run, sd), case.seconds, sd))


def _in_doubt(run: Run, sd: float) -> Run:
    return replace(run, clocks=(Clock("pushes", frozenset(), frozenset(run.inputs), sd),))


def _with(campaign: Campaign, name: str, change: Callable[[Run], Run]) -> Campaign:
    return replace(campaign, runs=tuple(change(run) if run.name == name else run for run in campaign.runs))


def line(case: Case, found: Diagnosis) -> str:
    told = found.clocks.get(case.run, {}).get("pushes")
    clock = f"{1000 * told.seconds:9.1f} ± {1000 * told.sd:4.1f}" if told else f"{'none':>16}"
    return f"{case.run:18}{1000 * case.seconds:8.0f}{clock}   {found.verdict:8} {', '.join(found.effects)}"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.shifts", description=__doc__)
    parser.add_argument("runs", nargs="*", metavar="RUN", help=f"of {', '.join(RUNS)}; all, if none is named")
    parser.add_argument("--night", action="store_true", help="the cases of make nightly alone")
    chosen = parser.parse_args()
    campaign = read(SAMPLE)
    night = {Case(*one) for one in (*NIGHT, *TOO_LITTLE)}
    print(f"{'run':18}{'shift':>8}{'told [ms]':>16}   verdict")
    for case in cases():
        if (not chosen.runs or case.run in chosen.runs) and (not chosen.night or case in night):
            print(line(case, diagnose(with_shift(campaign, case))), flush=True)


if __name__ == "__main__":
    main()
