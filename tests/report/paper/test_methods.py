"""The methods say what is in the diagnosis, and nothing that is not."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from wheelchair_fmu.inference.decision.among_forces import FORCES
from wheelchair_fmu.report.paper.folder import bibliography
from wheelchair_fmu.report.paper.left_out import STOOD, left_out
from wheelchair_fmu.report.paper.markup import cited
from wheelchair_fmu.report.paper.methods import methods, tex

from .case import DRAG, SIZE, case_of, sample, told
from .test_markup import well_formed

CAMBER = "camber_misalignment"


def without_held_out() -> dict:
    ladder = [{**s, "heldout": None} for s in told()["ladder"]]
    for step in ladder:
        step["channels"] = {c: {**e, "heldout": None, "heldout_rms": None} for c, e in step["channels"].items()}
    return told(ladder=ladder)


def at_a_bound() -> dict:
    found = told()
    of_mass = next(p for p in found["final"]["parameters"] if p["name"] == "chair.m")
    of_mass |= {"estimate": 88.0, "at_bound": True, "interval": None, "interval_by": None}
    return found


def calibrated(verdict: str) -> dict:
    """Nothing was found."""
    found = told(verdict=verdict, effects=[])
    found["ladder"], found["models"] = found["ladder"][:2], found["models"][:2]
    found["final"]["step"] = "calibrated"
    found["final"]["parameters"] = [p for p in found["final"]["parameters"] if p["name"] != SIZE]
    return found


def with_offset() -> dict:
    found = told()
    offset = {"name": "offset.yaw_rate", "unit": "rad/s", "meaning": "offset of yaw_rate", "estimate": 1e-3, "se": 1e-4}
    blank = {"interval": None, "prior": None, "prior_sd": None, "smallest_interesting": None, "at_bound": False}
    found["final"]["parameters"].append({**offset, **blank})
    return found


def with_forces() -> dict:
    """The search was made again with forces among the noise, as `verdict` does, and nothing more was found."""
    found = calibrated("adequate")
    found["ladder"].append({**found["ladder"][1], "step": FORCES})
    found["models"].append({**found["models"][1], "step": FORCES})
    return found


CASES = {
    "missing": told(),
    "tie": told(verdict="tie", effects=[DRAG, CAMBER], ties=[[DRAG, CAMBER]], odds=[{DRAG: 0.75, CAMBER: 0.25}]),
    "outside": told(
        verdict="outside", disturbance={**told()["disturbance"], "orders": [{"words": "it goes with the speed", "of": "force"}]}
    ),
    "small": {**calibrated("small"), "effects": [DRAG]},
    "adequate": calibrated("adequate"),
    "cannot_see": calibrated("cannot_see"),
    "no disturbance": told(disturbance=None),
    "no runs held out": without_held_out(),
    "at a bound": at_a_bound(),
    "an offset": with_offset(),
    "other noise": told(noise={"sd": {**told()["noise"]["sd"], "yaw_rate": 0.02}, "ar": {"a_x": 0.625}}),
    "with forces": with_forces(),
    "next": told(next_experiment={"manoeuvre": "a slalom_with [20 kg]", "separates": [], "repeats": 3, "why": ""}),
}


@pytest.mark.parametrize("name", CASES)
def test_every_case_is_told_in_whole_sentences(name):
    text = methods(case_of(CASES[name]), 0)
    for word in ("None", "nan", "inf ", "{", "  ", " .", "..", "''"):
        assert word not in re.sub(r"\$[^$]*\$", "C", text), word
    for paragraph in text.strip().split("\n\n"):
        assert re.fullmatch(r"\*\*[A-Z][a-z ]+\.\*\* .*[.”]", paragraph), paragraph
    well_formed(tex(text))
    known = re.findall(r"^@\w+\{(\w+),", bibliography(cited(text)), re.MULTILINE)
    assert set(cited(text)) == set(known)


def test_the_numbers_are_those_of_the_diagnosis():
    text, diagnosis = methods(case_of(), 0), told()
    (size,) = (p for p in diagnosis["final"]["parameters"] if p["name"] == SIZE)
    lower, upper = size["interval"]
    assert f"{size['estimate']:.3f} ± {size['se']:.3f} N (estimate" in text
    assert f"profile-likelihood interval {lower:.3f} to {upper:.3f} N)" in text
    nominal, fitted, last = (s["heldout"] for s in diagnosis["ladder"])
    assert f"was {nominal:.2f} with the values as given, {fitted:.2f} as calibrated and {last:.2f} with the last model." in text
    rates = [s["channels"]["yaw_rate"]["heldout_rms"] for s in diagnosis["ladder"]]
    assert "{:#.3g}, {:#.3g} and {:#.3g} deg/s in `yaw_rate`".format(*rates) in text
    calibrated_moment = diagnosis["disturbance"]["calibrated"]["moment"]
    assert f"{calibrated_moment:.2g} N m and " in text and "N s for the calibrated model and zero for the last one." in text
    assert "total mass m of chair and user, 80.0 ± 2.0 kg" in text
    durations = [run.time[-1] - run.time[0] for run in sample().fit]
    assert f"Seven runs of {sum(durations):.1f} s together were fitted" in text
    assert sample().fingerprint[:12] in text and diagnosis["made_by"]["code"][:12] in text


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tie", "the probabilities are 0.75 for `rolling_resistance_asymmetry` and 0.25 for `camber_misalignment`"),
        ("tie", "It stands there in the place of `camber_misalignment` as well"),
        ("outside", "It goes with the speed."),
        ("adequate", "The eight estimated values are in `estimates.csv`."),
        ("no runs held out", "The whitened RMS error on the fitted runs was"),
        ("at a bound", "Total mass m of chair and user came out at 88 kg, 4.0 standard deviations from its prior."),
        ("at a bound", "`chair.m` came out where the search stops; its standard error means little."),
        ("an offset", "Constant offsets of `yaw_rate` (without a prior) were estimated with the other values."),
        ("other noise", "The residuals of `yaw_rate` contradict 0.344 deg/s; the 1.15 deg/s that they show was used instead."),
        ("other noise", "with a coefficient of 0.625 from one reading to the next"),
        (
            "with forces",
            "the noise of the recorded pushes and a slow random force and moment and a swing of the rider's body that nobody "
            "recorded as process noise",
        ),
        ("next", r"To be measured next: a slalom\_with \[20 kg\], 3 times."),
    ],
)
def test_what_is_particular_is_said(name, words):
    assert words in methods(case_of(CASES[name]), 0)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("outside", "Probabilities compare"),
        ("adequate", "profile"),
        ("no runs held out", "held-out runs better"),
        ("no disturbance", "Unrecorded forces"),
        ("missing", "Constant offsets"),
        ("missing", "clocks"),
        ("missing", "left_out.csv"),
    ],
)
def test_what_is_not_so_is_not_said(name, words):
    assert words not in methods(case_of(CASES[name]), 0)


def test_priors_that_were_stated_and_values_that_were_not_given():
    measured = replace(sample(), priors={"chair.m": 2.0}, known={n: v for n, v in sample().known.items() if n != "chair.a"})
    text = methods(case_of(campaign=measured), 0)
    assert "That of `chair.m` was stated for this chair; the others are the software's" in text
    assert "Nobody gave `chair.a`; the software's default is in its place." in text


def test_a_remark_is_pointed_at():
    assert "What was left out or found odd in the data is in `left_out.csv`." in methods(case_of(), 1)


def test_what_was_used_of_the_runs_is_said_and_what_was_not_has_its_own_reason():
    """Where forces lead the runs, these count from where the chair rolls; a run that stood in between is in two pieces."""
    found = with_forces()
    runs = found["final"]["runs"]
    whole = runs.pop("coast-down")
    middle = (whole["from"] + whole["to"]) / 2
    half = {c: {**told, "readings": told["readings"] // 2, "used": None} for c, told in whole["channels"].items()}
    runs["coast-down"] = {**whole, "from": whole["from"] + 0.5, "to": middle, "channels": half}
    runs["coast-down@9s"] = {**whole, "from": middle + 1.0, "channels": half}
    case = case_of(found)
    lost = [row for row in left_out(case).itertuples() if row.place == "coast-down"]
    assert [row.why for row in lost] == [STOOD, STOOD] and [row.what[-9:] for row in lost] == ["(0.500 s)", "(1.000 s)"]
    text = methods(case, 2)
    assert re.search(r"Of these, [\d.]+ s of the [\d.]+ s fitted and [\d.]+ s of the [\d.]+ s held out count", text)
    assert "Of these" not in methods(case_of(), 0)


def test_values_to_be_measured_again_are_no_manoeuvre():
    following = {"manoeuvre": "chair.I_z measured again", "repeats": 1, "gain": None, "shows": None}
    found = calibrated("outside") | {"next_experiment": following}
    assert "To be measured again: chair.I" in methods(case_of(found), 0)
