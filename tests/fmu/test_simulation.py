"""That the FMU moves as the model does, whatever the steps, and the flavours alike."""

from __future__ import annotations

import fmpy
import numpy as np
import pytest

from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.fmu.build import build, with_chosen_effects
from wheelchair_fmu.model.variant import Variant

from .chair import Unpacked, chair, pushed

SOME = {"effect.lateral_load_transfer.h": 0.6, "effect.tyre_saturation.inv_mu": 1.0, "tyre.C_lambda": 4200.0}
MORE = {**SOME, "effect.relaxation_length.sigma": 0.12, "effect.caster_friction.M": 0.1}


def test_fmpy_coasts_to_rest(native):
    result = fmpy.simulate_fmu(str(native.path), stop_time=20, output=["chair.u", "chair.x"])
    assert np.all(np.diff(result["chair.u"]) <= 1e-12) and result["chair.u"][-1] == pytest.approx(0, abs=1e-4)
    assert np.all(result["chair.u"] > -1e-6)
    assert result["chair.x"][-1] == pytest.approx(3.2765, abs=1e-3)


def _simulated(variant: Variant, values, time: np.ndarray, inputs, hold: bool) -> np.ndarray:
    simulator = Simulator(variant)
    names = [p.name for p in variant.parameters()]
    parameters = variant.vector()
    for name, value in values.items():
        parameters[names.index(name)] = value
    columns = {name: np.array([inputs(i)[name] for i in range(len(time))]) for name in inputs(0)}
    run = simulator.run(time, simulator.inputs(len(time), columns), parameters, tolerance=1e-7, grid=1e-3, hold=hold)
    told = [i for i, o in enumerate(simulator.model.outputs) if o.boolean]  # which the importer does not ask for here
    return np.delete(run.results, told, axis=1)


@pytest.mark.parametrize(("archive", "effects", "values"), [("native", "default", SOME), ("everything", "all", MORE)])
def test_equals_the_simulator_with_held_inputs(archive, effects, values, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    time = np.arange(401) * 0.01
    expected = _simulated(with_chosen_effects(Variant(), effects), values, time, pushed, hold=True)
    with chair(unpacked) as c:
        c.start({**values, **pushed(0)})  # some effects start where the push is
        for i in range(400):
            c.set(pushed(i))
            c.time = time[i]
            c.step(time[i + 1] - time[i])
            assert c.outputs() == pytest.approx(expected[i + 1], rel=1e-9, abs=1e-9)


def test_equals_the_simulator_with_linear_inputs(native):
    def smooth(i: int) -> dict[str, float]:
        beat = max(0.0, np.sin(2 * np.pi * i * 0.01))
        return {"push.F_rl": 60 * beat + 3, "push.F_rr": 60 * beat - 3}

    time = np.arange(301) * 0.01
    expected = _simulated(with_chosen_effects(Variant()), {}, time, smooth, hold=False)
    with chair(native) as c:
        c.start()
        for i in range(300):
            now, following = smooth(i), smooth(i + 1)
            c.set(now)
            for name in now:
                _derivative(c, name, (following[name] - now[name]) / (time[i + 1] - time[i]))
            c.time = time[i]
            c.step(time[i + 1] - time[i])
            assert c.outputs() == pytest.approx(expected[i + 1], rel=1e-9, abs=1e-9)


def test_a_derivative_carries_the_input_and_is_then_spent(native):
    with chair(native) as c:
        c.start({"push.F_rl": 10.0})
        _derivative(c, "push.F_rl", 100.0)
        c.step(0.1)
        assert c.get("push.F_rl")[0] == pytest.approx(20.0, rel=1e-14)
        c.step(0.1)
        assert c.get("push.F_rl")[0] == pytest.approx(20.0, rel=1e-14)


def _derivative(c, name: str, value: float) -> None:
    f = c.fmu
    f.fmi2SetRealInputDerivatives(
        f.component,
        (fmpy.fmi2.fmi2ValueReference * 1)(c.types[name].valueReference),
        1,
        (fmpy.fmi2.fmi2Integer * 1)(1),
        (fmpy.fmi2.fmi2Real * 1)(value),
    )


@pytest.mark.parametrize("archive", ["native", "everything"])
def test_the_communication_step_does_not_matter(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    values = {"push.F_rl": 30.0, "push.F_rr": 26.0, **(MORE if archive == "everything" else SOME)}
    ends = {}
    for h, count in ((1e-3, 2100), (1e-2, 210), (5e-2, 42), (7e-3, 300), (3.3e-3, 636)):
        with chair(unpacked) as c:
            c.start(values)
            c.step(h, count)
            c.step(2.1 - c.time) if abs(2.1 - c.time) > 1e-6 else None
            ends[h] = np.array(c.outputs())
    assert np.max(np.abs(ends[1e-2] - ends[1e-3])) < 1e-9
    assert np.max(np.abs(ends[5e-2] - ends[1e-3])) < 1e-9
    assert np.max(np.abs(ends[7e-3] - ends[1e-3])) < 1e-6
    assert np.max(np.abs(ends[3.3e-3] - ends[1e-3])) < 1e-6


def test_the_start_time_does_not_matter(native):
    ends = []
    for start in (0.0, 1234.0):
        with chair(native) as c:
            c.start({"push.F_rl": 30.0}, time=start)
            ends.append(c.step(0.01, 100).outputs())
            assert c.get("time")[0] == pytest.approx(start + 1.0)
    assert ends[0] == ends[1]


def test_effects_at_zero_change_nothing(native, everything):
    ends = []
    for unpacked in (native, everything):
        with chair(unpacked) as c:
            c.start()
            for i in range(300):
                c.set(pushed(i))
                c.step(0.01)
            ends.append(c.get(*native.names("output")))
    names = native.names("output")
    for name, a, b in zip(names, *ends, strict=True):
        assert a == pytest.approx(b, abs=1e-4 if not name.startswith(("force", "push", "load", "caster")) else 5e-2), name


@pytest.mark.parametrize("law", [1, 2, 3])
def test_python_gives_the_same_as_native(law, native, in_python):
    assert [
        (v.name, v.valueReference, v.unit, v.start, v.min, v.max, v.nominal, v.causality, v.variability, v.initial)
        for v in native.description.modelVariables
        if v.causality != "local"
    ] == [
        (v.name, v.valueReference, v.unit, v.start, v.min, v.max, v.nominal, v.causality, v.variability, v.initial)
        for v in in_python.description.modelVariables
    ]
    runs = []
    for unpacked in (native, in_python):
        with chair(unpacked) as c:
            c.start({**SOME, "tyre.law": law})
            rows = []
            for i in range(120):
                c.set(pushed(i))
                rows.append(c.step(0.01 if i % 3 else 0.0137).outputs())
            c.set({"tyre.C_lambda": 6000.0})
            rows.append(c.outputs())
            runs.append(np.array(rows))
    assert np.max(np.abs(runs[0] - runs[1])) < 1e-9


def test_python_gives_the_same_with_every_effect(workshop, everything):
    python = Unpacked.of(build(target=workshop / "all.fmu", effects="all", flavour="python"), workshop / "all")
    runs = []
    for unpacked in (everything, python):
        with chair(unpacked) as c:
            c.start({**MORE, "brake.rl": 0.1})
            for i in range(60):
                c.set(pushed(i))
                c.step(0.01)
            runs.append(np.array(c.outputs()))
    assert np.max(np.abs(runs[0] - runs[1])) < 1e-9


def test_python_can_be_loaded_again_from_another_folder(in_python):
    ends = [fmpy.simulate_fmu(str(in_python.path), stop_time=0.5)["chair.x"][-1] for _ in range(3)]
    assert ends[0] == ends[1] == ends[2] > 0.4


def test_prescribed_speed_follows_its_parameter(native, in_python):
    for unpacked in (native, in_python):
        with chair(unpacked) as c:
            c.start({"speed.mode": 2, "speed.u": 0.8, "push.F_rl": 10.0})
            assert c.step(0.05, 10).get("chair.u")[0] == pytest.approx(0.8, abs=1e-12)
            c.set({"speed.u": 1.3})
            assert c.get("chair.u")[0] == 1.3
            assert c.step(0.05).get("chair.u")[0] == pytest.approx(1.3, abs=1e-12)


def test_paper_equations_start_moving_and_say_why_they_cannot_at_rest(workshop):
    paper = Unpacked.of(build(target=workshop / "paper.fmu", effects="none", equations="paper"), workshop / "paper")
    with chair(paper) as c:
        c.start()
        assert c.step(0.1, 5).get("chair.u")[0] < 1
    with chair(paper) as c, pytest.raises(fmpy.fmi1.FMICallException) as refused:
        c.start({"start.u": 0.0})
        c.step(0.1)
    assert refused.value.status == 3
    assert "the equations give NaN or infinity" in c.sentences[-1]
