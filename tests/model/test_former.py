"""Names that parameters had before: read by every kind of file, each time with the name and the value of today."""

from __future__ import annotations

import warnings

import casadi as cs
import numpy as np
import pytest

from tests.campaign.small import HEAD, NOISE, RUNS, SI, csv_text, motion, rows
from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.errors import FormerName, UsageError
from wheelchair_fmu.faults import WARNING
from wheelchair_fmu.inference.subject import applied, known_parameters
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.former import renamed, replaced
from wheelchair_fmu.model.variant import Variant, read_variant

CAMBER, GAIN = "effect.camber_misalignment", "effect.push_force_gain"


def test_pairs_are_sums_or_means_and_differences():
    instead = {name: [p.name.rpartition(".")[2] for p in found] for name, found in replaced().items()}
    assert {n.split(".")[1] for n in instead} == {
        "camber_misalignment",
        "toe_misalignment",
        "wheel_radius_error",
        "push_force_gain",
    }
    assert instead[f"{CAMBER}.phi_r"] == ["sum", "difference"] and instead[f"{GAIN}.l"] == ["mean", "difference"]
    assert not any(f"effect.{id}.{p.name}" in instead for id, effect in bundled().items() for p in effect.parameters)


@pytest.mark.parametrize(
    ("given", "expected", "quantity", "sides"),
    [
        ({f"{CAMBER}.phi_r": 0.02, f"{CAMBER}.phi_l": -0.01}, {"sum": 0.01, "difference": 0.03}, "phi", (-0.01, 0.02)),
        ({f"{CAMBER}.phi_l": "0.01"}, {"sum": 0.01, "difference": -0.01}, "phi", (0.01, 0.0)),
        ({f"{GAIN}.r": 0.1}, {"mean": 0.05, "difference": 0.1}, "F_t", (30.0, 30 / 1.1)),
    ],
)
def test_a_side_by_its_former_name_is_what_it_was(given, expected, quantity, sides):
    with pytest.warns(FormerName, match="former names?, read as") as told:
        chair = Variant().with_values(given)
    (note,) = (str(w.message) for w in told)
    effect = next(iter(given)).rpartition(".")[0]
    assert all(name in note for name in given) and f"{effect}.difference = {expected['difference']:g}" in note
    assert chair.values == pytest.approx({f"{effect}.{name}": value for name, value in expected.items()})
    model = chair.model()
    at = np.array([30.0 if i.name.startswith("push.F") else i.start for i in model.inputs])
    found = cs.Function("q", [model.x, model.w, model.p], [model.quantities[quantity]])(0, at, chair.vector())
    np.testing.assert_allclose(found.full().ravel(), sides)


def test_a_value_for_one_side_leaves_the_other_as_it_was():
    both = {f"{CAMBER}.sum": 0.03, f"{CAMBER}.difference": -0.01}  # φ_r = 0.01, φ_l = 0.02
    found, _ = renamed({f"{CAMBER}.phi_r": 0.0}, both)
    assert found == pytest.approx({f"{CAMBER}.sum": 0.02, f"{CAMBER}.difference": -0.02})


@pytest.mark.parametrize("new", ["sum", "difference"])
def test_a_former_name_beside_what_has_replaced_it_is_one_fault(new):
    with pytest.raises(UsageError, match=rf"both are given; give {CAMBER}.sum and {CAMBER}.difference only"):
        Variant().with_values({f"{CAMBER}.phi_r": 0.01, f"{CAMBER}.{new}": 0.01})


def test_what_is_no_number_or_too_much_is_refused():
    with pytest.raises(UsageError, match=rf"{CAMBER}.phi_r = 'steep' is not a number"):
        Variant().with_values({f"{CAMBER}.phi_r": "steep"})
    with pytest.warns(FormerName), pytest.raises(UsageError, match=rf"{CAMBER}.sum = 2.0 is outside its bounds -0.6 to 0.6"):
        Variant().with_values({f"{CAMBER}.phi_r": 2.0})


def test_a_variant_file_with_former_names_is_read(tmp_path):
    file = tmp_path / "old.toml"
    file.write_text(
        f'[laws]\neffects = ["push_force_gain"]\n[values]\n"{GAIN}.r" = 0.04\n"{GAIN}.l" = 0.02\n', encoding="utf-8"
    )
    with pytest.warns(FormerName, match=rf"{GAIN}.mean = 0.03 and {GAIN}.difference = 0.02"):
        assert read_variant(file).values == pytest.approx({f"{GAIN}.mean": 0.03, f"{GAIN}.difference": 0.02})


def campaign(folder, effect: str, of_run: str = ""):
    """A small campaign with values of an effect, for all runs and for the first."""
    runs = RUNS.replace("u0 = 1.0\n", f"u0 = 1.0\nset = {{ {of_run} }}\n", 1)
    (folder / "campaign.toml").write_text(HEAD + f"[effect]\n{effect}\n" + NOISE + runs, encoding="utf-8")
    for name in ("a.csv", "b.csv"):
        (folder / name).write_text(csv_text(SI, rows(motion())), encoding="utf-8")
    return folder


def test_a_campaign_with_former_names_is_read(tmp_path):
    old = "camber_misalignment.phi_r = 0.01\ncamber_misalignment.phi_l = 0.02"
    folder = campaign(tmp_path, old, f'"{CAMBER}.phi_r" = 0.0')
    (whole, of_run) = (f for f in check(folder, known_parameters()) if "former" in f.fact)
    assert whole.severity == of_run.severity == WARNING and whole.line == 7
    assert f"{CAMBER}.sum = 0.03 rad and {CAMBER}.difference = -0.01 rad" in whole.fact
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        measured = read(folder, known_parameters())
    assert {n: v for n, v in measured.known.items() if n.startswith(CAMBER)} == pytest.approx(
        {f"{CAMBER}.sum": 0.03, f"{CAMBER}.difference": -0.01}
    )
    assert measured.runs[0].set == pytest.approx({f"{CAMBER}.sum": 0.02, f"{CAMBER}.difference": -0.02})


@pytest.mark.parametrize(
    ("effect", "says"),
    [
        ("camber_misalignment.phi_r = 0.01\ncamber_misalignment.sum = 0.02", "and both are given"),
        ('camber_misalignment.phi_r = "steep"', "is not a finite number"),
        ("camber_misalignment.phi_r = 0.7", "camber_misalignment.sum = 0.7 is outside -0.6 to 0.6"),
        ("camber_misalignment.sum = 0.01\n[prior]\neffect.camber_misalignment.phi_r = 0.01", "which has no prior of its own"),
    ],
)
def test_faults_of_former_names_in_a_campaign(tmp_path, effect, says):
    faults = [f for f in check(campaign(tmp_path, effect, "chair.m = 80"), known_parameters()) if f.severity != WARNING]
    assert says in faults[0].fact and all(f.line for f in faults)


def test_what_is_set_by_a_former_name_is_fixed_by_todays(tmp_path):
    measured = read(campaign(tmp_path, "gyro_bias.b = 0.0", "chair.m = 80"))
    with pytest.warns(FormerName):
        variant, _, fixed = applied({f"{GAIN}.r": "0.02"}, Variant(), measured)
    assert set(fixed) == {f"{GAIN}.mean", f"{GAIN}.difference"} == set(variant.values)
