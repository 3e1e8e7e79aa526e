"""What is exported gives the fitted curve: through the FMU, through the model, and through a .tir file and back."""

from __future__ import annotations

from pathlib import Path

import casadi as cs
import fmpy
import numpy as np
import pytest
from lxml import etree

from wheelchair_fmu.errors import Failure, UsageError
from wheelchair_fmu.fmu import parameter_set
from wheelchair_fmu.model.variant import read_variant, variant_text
from wheelchair_fmu.studies import Fmu, fmu_of
from wheelchair_fmu.tyres import identify, read
from wheelchair_fmu.tyres.magic_formula import FORCE, TORQUE
from wheelchair_fmu.tyres.parameters import chair, chosen
from wheelchair_fmu.tyres.records import CAMBER, SLIP
from wheelchair_fmu.tyres.tir import tir_text

from .rig import Tyre

ROTATING_DISC = Path(__file__).parents[2] / "examples" / "rotating-disc.csv"
LAMBDA = np.radians([-4.5, -1.0, 0.2, 1.0, 3.0, 5.0])
CONDITIONS = (("A", 4, 400), ("A", 2, 400), ("B", 4, 600))


@pytest.fixture(scope="module")
def disc():
    return identify(read(ROTATING_DISC).sweeps)


def at(found, tyre, pressure, load):
    return chosen(found, tyre, pressure, load, 4 / 3.6)


def on_load(variant, load):
    """The chair's mass that puts this load on each rear wheel, (19)."""
    values = dict(zip((p.name for p in variant.parameters()), variant.vector(), strict=True))
    return load * 2 * (values["chair.a"] + values["chair.b"]) / (values["chair.a"] * values["g"])


def expected(fit, law, channel, x):
    sign = np.sign(x)
    if law == "dugoff":
        return fit.dugoff.force(x) if channel == FORCE else fit.dugoff.torque(x)
    if law == "magic_formula":
        return sign * fit.magic(SLIP, channel)(np.abs(x))
    return fit.K(SLIP, channel).value * x


@pytest.mark.parametrize("law", ["linear", "dugoff", "magic_formula"])
@pytest.mark.parametrize("condition", CONDITIONS, ids=str)
def test_the_fmu_gives_the_fitted_force(disc, law, condition, tmp_path):
    fit = at(disc, *condition)
    (tmp_path / "tyre.toml").write_text(variant_text(chair(disc, fit, law)))
    variant = read_variant(tmp_path / "tyre.toml")
    values = {
        **variant.values,
        "tyre.law": variant.choice.tyre,
        "chair.m": on_load(variant, fit.condition.load),
        "speed.mode": "prescribed",
        "speed.u": 1.0,
    }
    with Fmu(fmu_of(variant)) as fmu:
        for x in LAMBDA:
            result = fmu.run(np.array([0.0, 1e-3]), {}, {**values, "start.v": -np.tan(x)})
            slip = np.array([result["slip.rl"][0]])
            assert slip[0] == pytest.approx(x, rel=1e-3)
            assert result["load.rl"][0] == pytest.approx(fit.condition.load, rel=1e-9)
            assert result["force.F_srl"][0] == pytest.approx(expected(fit, law, FORCE, slip)[0], rel=1e-6)


@pytest.mark.parametrize("law", ["linear", "dugoff", "magic_formula"])
@pytest.mark.parametrize("condition", CONDITIONS, ids=str)
def test_the_model_gives_the_fitted_torque_and_camber_force(disc, law, condition):
    fit = at(disc, *condition)
    variant = chair(disc, fit, law).with_values(
        {"effect.camber_misalignment.sum": 0.05, "effect.camber_misalignment.difference": -0.05}
    )
    variant = variant.with_values({"chair.m": on_load(variant, fit.condition.load)})
    model = variant.model()
    q = model.quantities
    of_slip = cs.Function("tyre", [model.x, model.w, model.p], [q["lam"], q["M_t"], q["F_s"], q["F_lam"]])
    for x in LAMBDA:
        state = np.zeros(model.x.numel())
        names = [s.symbol for s in model.states for _ in s.names]
        state[names.index("u")], state[names.index("v")] = 1.0, -np.tan(x)
        start = np.array([i.start for i in model.inputs])
        lam, M_t, F_s, F_lam = (np.array(each).ravel() for each in of_slip(state, start, variant.vector()))
        left = np.array([lam[0]])
        twist, lean = fit.K(CAMBER, TORQUE).value * 0.05, fit.K(CAMBER, FORCE).value * 0.05
        assert M_t[0] == pytest.approx(expected(fit, law, TORQUE, left)[0] + twist, rel=1e-3, abs=1e-6)
        assert F_s[0] - F_lam[0] == pytest.approx(lean, rel=1e-3)


def test_a_tyre_exported_at_400_n_is_the_one_measured_at_600_n_when_the_chair_is_heavy(disc):
    variant, heavy = chair(disc, at(disc, "A", 4, 400), "linear"), at(disc, "A", 4, 600)
    model = variant.model()
    of_load = cs.Function("k", [model.x, model.w, model.p], [model.quantities["k_F"], model.quantities["k_M"]])
    weighed = variant.with_values({"chair.m": on_load(variant, 600.0)})
    k_F, k_M = of_load(np.zeros(model.x.numel()), np.array([i.start for i in model.inputs]), weighed.vector())
    assert float(k_F[0]) == pytest.approx(heavy.K(SLIP, FORCE).value, rel=0.01)
    assert float(k_M[0]) == pytest.approx(-heavy.K(SLIP, TORQUE).value, rel=0.01)


def test_the_reference_tyre_is_the_default_one(disc):
    """Table 1 is tyre A in the reference condition."""
    values = chair(disc, at(disc, "A", 4, 400), "linear").values
    for name, default in (("tyre.C_lambda", 5038), ("tyre.C_m_lambda", 45), ("tyre.C_phi", 464)):
        assert values[name] == pytest.approx(default, rel=0.03)


def test_without_other_loads_and_pressures_only_what_was_measured_is_set():
    found = identify([Tyre().sweep()])
    variant = chair(found, found.conditions[0], "linear")
    assert set(variant.values) == {"tyre.pressure", "tyre.C_lambda", "tyre.C_m_lambda"} and variant.effects == ()


def test_a_law_that_the_data_do_not_support_is_refused():
    found = identify([Tyre().sweep(angles=[0.1, 0.3, 0.5])])
    for law in ("dugoff", "magic_formula"):
        with pytest.raises(Failure, match=r"do not support .* choose --law linear"):
            chair(found, found.conditions[0], law)
    with pytest.raises(Failure, match="--law linear"):
        tir_text(found, found.conditions[0])
    assert chair(found, found.conditions[0], "linear").values["tyre.C_lambda"] > 4000


def test_a_condition_that_was_not_tested_names_those_that_were(disc):
    with pytest.raises(UsageError, match=r"no test at 500 N .* there are 400 N, 600 N"):
        chosen(disc, "A", None, 500, None)
    with pytest.raises(UsageError, match="tyres A, B; choose one by --tyre"):
        chosen(disc, None, None, None, None)


def test_the_parameter_set_is_valid_and_holds_the_variant(disc):
    variant = chair(disc, at(disc, "A", 4, 400), "magic_formula")
    schema = Path(fmpy.__file__).parent / "ssp" / "schema" / "SystemStructureParameterValues.xsd"
    root = etree.fromstring(parameter_set.text(parameter_set.from_variant(variant, "tyre", "tyre A & its <laws>")))
    etree.XMLSchema(etree.parse(schema)).assertValid(root)
    space = {
        "v": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
        "c": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    }
    reals = {p.get("name"): p[0] for p in root.iterfind(".//v:Parameter", space)}
    assert {n: float(e.get("value")) for n, e in reals.items() if n != "tyre.law"} == dict(variant.values)
    assert reals["tyre.law"].get("value") == "magic_formula"
    defined = {u.get("name") for u in root.iterfind(".//c:Unit", space)}
    assert {e.get("unit") for e in reals.values() if e.get("unit")} == defined


@pytest.mark.parametrize("condition", CONDITIONS, ids=str)
def test_a_tir_file_read_back_is_the_same_tyre(disc, condition, tmp_path):
    fit = at(disc, *condition)
    (tmp_path / "t.tir").write_text(tir_text(disc, fit))
    again = identify(read(tmp_path / "t.tir").sweeps)
    same = chosen(again, None, condition[1], condition[2], None)
    x = np.radians(np.linspace(0.1, 5, 40))
    for channel in (FORCE, TORQUE):
        truth = fit.magic(SLIP, channel)(x)
        assert np.abs(same.magic(SLIP, channel)(x) - truth).max() < 2e-3 * np.abs(truth).max()
        assert same.K(CAMBER, channel).value == pytest.approx(fit.K(CAMBER, channel).value, rel=1e-6)
    loads = [again.across["t"].laws[name].exponents["load"].value for name in ("C_lambda", "C_m_lambda")]
    truths = [disc.across[condition[0]].laws[name].exponents["load"].value for name in ("C_lambda", "C_m_lambda")]
    assert loads == pytest.approx(truths, abs=0.12)  # the files' own shape over load is no power law
