"""What a check says of signals, clocks, pushes and masses that do not go together."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.campaign import check

from .small import HEAD, NOISE, RUNS, SI, csv_text, motion, rows

LONG = 600
SAMPLE = Path(__file__).resolve().parents[2] / "examples" / "sample-campaign"


def told(campaign, words, **parts):
    """Sentences on a campaign that have these words in them."""
    return [line for line in map(str, check(campaign(**parts))) if words in line]


def files(change, both=True):
    made = {name: change(motion(LONG, seed)) for name, seed in (("a.csv", 0), ("b.csv", 1))}
    whole = {name: motion(LONG, seed) for name, seed in (("a.csv", 0), ("b.csv", 1))}
    return {name: csv_text(SI, rows(made[name] if both or name == "a.csv" else whole[name])) for name in made}


def times(factor, column=5):
    def change(data):
        data[:, column] *= factor
        return data

    return change


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        (np.pi / 180, "times too small (as if rad were called deg)"),
        (180 / np.pi, "times too large (as if deg were called rad)"),
    ],
)
def test_a_unit_that_does_not_fit_the_wheels_is_said(campaign, factor, words):
    (said,) = told(campaign, "goes with the wheels", files=files(times(factor)))
    assert said.startswith("warning: campaign.toml: yaw_rate goes with the wheels, but is ") and "in every run" in said
    assert words in said


def test_of_one_run_it_is_said_of_that_run(campaign):
    (said,) = told(campaign, "goes with the wheels", files=files(times(np.pi / 180), both=False))
    assert said.startswith("warning: run a.csv: yaw_rate goes with the wheels")


def test_a_chair_of_any_track_and_a_sign_are_no_unit(campaign):
    for factor in (1.0, 0.6, 1.6, -1.0):
        assert not told(campaign, "goes with the wheels", files=files(times(factor)))


def test_of_one_run_the_sign_of_either_may_be_wrong(campaign):
    (said,) = told(campaign, "unlike in other runs", files=files(times(-1.0), both=False))
    assert "exchange the columns of left and right in this run, or correct the sign of yaw_rate in it" in said


def unpushed(data):
    data[:, 1:3] = 0.0
    data[:, 3:5] += np.clip(data[:, :1] - 1, 0, 1.5)
    return data


def test_a_chair_that_gains_speed_by_no_push_is_said(campaign):
    (said, _) = told(campaign, "all pushes are 0", files=files(unpushed))
    assert "the wheels gain 1." in said and "on a ramp this may be right" in said


def test_a_chair_that_coasts_is_not(campaign):
    def coasting(data):
        data[:, 1:3] = 0.0
        data[:, 3:5] -= 0.1 * data[:, :1]
        return data

    assert not told(campaign, "all pushes are 0", files=files(coasting))


def test_a_run_that_is_over_at_once_is_said_and_nothing_stops_at_it(campaign):
    (said, _) = told(campaign, "the run lasts", files=files(times(1e-3, column=0)))
    assert "the run lasts 0.006 s, in which a chair hardly moves; check the unit of its time" in said


def test_a_cut_that_leaves_nothing_is_one_sentence(campaign):
    runs = RUNS.replace('role = "fit"', 'role = "fit"\nfrom = 100')
    said = told(campaign, "a.csv", runs=runs)
    assert len(said) == 1 and "the cut from 100 s leaves 0 samples" in said[0]


def test_pushes_that_a_clock_moves_out_of_the_run_are_said(campaign):
    runs = RUNS.replace('role = "fit"', 'role = "fit"\nclocks = { pushes = 60 }')
    (said,) = told(campaign, "clocks.pushes", runs=runs)
    assert said == "run a.csv: clocks.pushes moves the pushes by 60 s, out of a run of 1.99 s; give it in s"


def test_a_drift_between_columns_of_one_file_changes_nothing_and_is_said(campaign):
    runs = RUNS.replace('role = "fit"', 'role = "fit"\nclocks = { pushes = { offset = 0.02, drift = 4e-5 } }')
    (said,) = told(campaign, "the drift of pushes", runs=runs)
    assert said.endswith("the drift of pushes changes nothing: they stand in the same file as the readings; leave it out")


def test_more_rider_than_chair_and_rider_is_said(campaign):
    (said,) = told(campaign, "[rider]", head=HEAD + "[rider]\nm = 80.0\n")
    assert said.endswith(
        "[rider] m = 80 kg moves on a chair of 80 kg, which has the rider in it; "
        "correct one of them; [chair] m is of chair and rider together"
    )


DEVICES = """
[[recording]]
device = "rims"
[[recording]]
device = "frame"
[[recording]]
device = "wheels"
[[run]]
files = { rims = "rims.csv", frame = "frame.csv", wheels = "wheels.csv" }
manoeuvre = "slalom"
role = "fit"
u0 = 1.0
"""
COLUMNS = {"rims": (0, 1, 2), "frame": (0, 5, 6), "wheels": (0, 3, 4)}


def devices(campaign, clocks):
    data = motion(LONG)
    made = {f"{name}.csv": csv_text([SI[i] for i in of], rows(data[:, list(of)])) for name, of in COLUMNS.items()}
    said = check(campaign(HEAD + NOISE + DEVICES.replace("u0 = 1.0", f"u0 = 1.0\n{clocks}"), files=made))
    return [str(fault) for fault in said if "clocks" in str(fault)]


def test_clocks_that_nobody_gave_are_said_once(campaign):
    assert devices(campaign, "") == [
        "warning: campaign.toml: nothing says how far the clocks of frame, wheels are off that of rims in run run-1; "
        "run `wheelchair sync`, or write clocks = { frame = 0, wheels = 0 } in a run whose devices one trigger started"
    ]
    assert not devices(campaign, "clocks = { frame = 0, wheels = 0.2 }")


def test_a_device_that_recorded_at_another_time_is_said(campaign):
    (said,) = devices(campaign, "clocks = { frame = 1000, wheels = 0 }")
    assert "frame recorded from 1000 to 1006 s, the pushes from 0 to 5.99 s: they have no time in common" in said


def test_one_column_as_two_channels_is_said(campaign):
    head = HEAD + '[columns]\na_y = "yaw_rate [rad/s]"\n'
    (said, *_) = told(campaign, "are read from the same column", head=head)
    assert said.startswith("warning: run a.csv column 'yaw_rate [rad/s]': yaw_rate and a_y are read from the same column")


def test_a_column_that_no_run_has_is_said_where_another_stands_for_it(campaign):
    (said,) = told(campaign, "Gyro Z", head=HEAD + '[columns]\nyaw_rate = "Gyro Z"\n')
    assert said.startswith("warning: campaign.toml line 7: no run has the column 'Gyro Z' that [columns] gives for yaw_rate")
    assert "so that it is read from 'yaw_rate [rad/s]'; correct [columns]" in said


def test_a_recording_that_is_fitted_twice_is_said(campaign):
    (said,) = told(campaign, "both are fitted", runs=RUNS.replace("b.csv", "a.csv").replace("holdout", "fit"))
    assert said.startswith("warning: campaign.toml") and "has the samples of run 1 again" in said
    parted = RUNS.replace("b.csv", "a.csv").replace('role = "fit"', 'role = "fit"\nto = 0.9').replace("holdout", "fit")
    assert not told(campaign, "both are fitted", runs=parted.replace("u0 = 1.0\n", "u0 = 1.0\n", 1) + "from = 1.0\n")


def swapped(folder, change, of=("runs/random-steps.csv", "runs/holdout-random.csv")):
    """Warnings on pushes of the sample campaign, with the first lines of these files as `change` has them."""
    shutil.copytree(SAMPLE, folder)
    for name in of:
        head, rest = (folder / name).read_text(encoding="utf-8").split("\n", 1)
        (folder / name).write_text("\n".join(change(head, rest)), encoding="utf-8")
    return [str(fault) for fault in check(folder) if "push" in fault.fact]


def exchange(head, rest):
    return head.replace("F_rl", "F_x").replace("F_rr", "F_rl").replace("F_x", "F_rr"), rest


def test_pushes_that_were_exchanged_turn_the_chair_the_other_way(tmp_path):
    (said,) = swapped(tmp_path / "all", exchange)
    assert (
        said.startswith("warning: campaign.toml: the pushes turn the chair the other way") and "in every run that tells" in said
    )
    (said,) = swapped(tmp_path / "one", exchange, of=["runs/random-steps.csv"])
    assert said.startswith("warning: run runs/random-steps.csv: the pushes turn") and said.endswith("in this run")
    assert not swapped(tmp_path / "none", lambda *lines: lines)


def test_a_push_with_the_other_sign_slows_the_chair(tmp_path):
    def negated(head, rest):
        cells = [row.split(",") for row in rest.splitlines()]
        at = [name.partition(" ")[0] for name in head.split(",")].index("F_rl")
        for row in cells:
            row[at] = str(-float(row[at]))
        return head, "\n".join(map(",".join, cells)) + "\n"

    (said,) = (line for line in swapped(tmp_path / "all", negated) if "loses speed" in line)
    assert "the chair loses speed where F_rl pushes it, in every run that tells; correct the sign of F_rl" in said


def test_a_push_that_is_missing_may_be_a_column_that_nothing_is_taken_from(campaign):
    named = {name: csv_text([h.replace("F_rl [N]", "Schub [N]") for h in SI], rows(motion())) for name in ("a.csv", "b.csv")}
    (said, _) = told(campaign, "no push force F_rl", files=named)
    assert said == "run a.csv line 1: no push force F_rl; name it in [columns], if it is 'Schub [N]'"
