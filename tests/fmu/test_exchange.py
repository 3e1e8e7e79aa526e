"""Model Exchange: the importer integrates, and gets what Co-Simulation gives."""

from __future__ import annotations

from math import nan

import fmpy
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from wheelchair_fmu.fmu.build import build
from wheelchair_fmu.model.variant import Variant

from .chair import DISCARD, ERROR, Unpacked, chair, pushed
from .exchange import exchange
from .test_protocol import refused

VERSIONS = ["native", "native3"]
STATES = ["chair.x", "chair.y", "chair.psi", "chair.u", "chair.v", "chair.psi_dot"]
SET = {"effect.lateral_load_transfer.h": 0.5, "start.psi_dot": 0.2}
# Held, with jumps: fmpy's CVode holds inputs within its steps anyway.
JUMPS = [(0.0, 20, 16), (1.0, 20, 16), (1.0, -5, 8), (2.0, -5, 8), (2.0, 0, 0), (3.0, 0, 0)]
PUSHES = np.array(
    [tuple(map(float, row)) for row in JUMPS], dtype=[("time", float), ("push.F_rl", float), ("push.F_rr", float)]
)


@pytest.fixture(scope="session")
def lagged(workshop) -> Unpacked:
    """A build with a relaxation length and swivelling casters: ten states."""
    variant = Variant().with_values({"effect.relaxation_length.sigma": 0.12, "effect.caster_friction.M": 0.1})
    return Unpacked.of(build(variant, workshop / "lagged.fmu", effects="none", fmi="3"), workshop / "lagged")


@pytest.mark.parametrize("archive", [*VERSIONS, pytest.param("lagged", marks=pytest.mark.nightly)])
def test_cvode_gets_the_trajectory_of_co_simulation(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    outputs = [*STATES, "slip.rl", "sensor.a_y", *(n for n in unpacked.names("output", "Float64") if "lagged" in n)]
    values = {k: v for k, v in SET.items() if any(k == x.name for x in unpacked.description.modelVariables)}

    def run(kind: str, tolerance: float) -> np.ndarray:
        return fmpy.simulate_fmu(
            str(unpacked.path),
            fmi_type=kind,
            stop_time=3,
            output_interval=0.01,
            input=PUSHES,
            output=outputs,
            start_values=values,
            relative_tolerance=tolerance,
            record_events=False,
        )

    expected, found = run("CoSimulation", 1e-9), run("ModelExchange", 1e-9)
    for name in outputs:
        np.testing.assert_allclose(found[name], expected[name], atol=1e-5 if name == "sensor.a_y" else 1e-6, err_msg=name)


@pytest.mark.parametrize("archive", ["native", pytest.param("everything3", marks=pytest.mark.nightly)])
def test_another_integrator_gets_it_too_with_pushes_that_vary(archive, request):
    """SciPy's Radau between the samples of held pushes."""
    unpacked: Unpacked = request.getfixturevalue(archive)
    with exchange(unpacked) as e, chair(unpacked) as c:
        e.enter(SET)
        c.start(SET, tolerance=1e-10)
        x = e.states()
        for i in range(0, 60, 5):
            c.set(pushed(i))
            c.step(0.05)
            e.set(pushed(i))
            x = solve_ivp(e.f, (i * 0.01, i * 0.01 + 0.05), x, "Radau", rtol=1e-9, atol=1e-11).y[:, -1]
            e.put(x)
            names = [*STATES, "slip.rl", "load.fr", "sensor.a_x"]
            assert e.get(*names) == pytest.approx(c.get(*names), rel=2e-6, abs=2e-7)


def test_the_states_are_those_of_the_build(native, everything, lagged):
    """What is algebraic in a build is no state: slip without relaxation, ideal casters, algebraic accelerations."""
    assert [v.derivative.name for v in native.description.modelVariables if v.derivative] == STATES
    more = [v.derivative.name for v in everything.description.modelVariables if v.derivative][len(STATES) :]
    assert more and not [n for n in more if "relaxation_length" in n]  # σ = 0 in this build
    own = [v.derivative.name for v in lagged.description.modelVariables if v.derivative][len(STATES) :]
    assert {"effect.relaxation_length.lagged_slip.rl", "effect.relaxation_length.lagged_slip.rr"} < set(own)


@pytest.mark.parametrize(("archive", "value"), [("everything", 0.1), ("lagged", 0.0)])
def test_a_parameter_that_would_change_the_states_is_refused(archive, value, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    name = "effect.relaxation_length.sigma"
    with exchange(unpacked) as e:
        old = e.get(name)
        refused(DISCARD, e.set, {name: value})
        assert "would change the number of continuous states, which Model Exchange fixes" in e.sentences[0]
        assert e.get(name) == old
        assert np.isfinite(e.enter().rates()).all()
    with chair(unpacked) as c:  # Co-Simulation knows no such limit
        assert c.start({name: value}).step(0.01).get("chair.u")[0] < 1


@pytest.mark.parametrize("archive", VERSIONS)
def test_rates_are_those_of_the_states(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    with exchange(unpacked) as e:
        e.enter({**SET, "push.F_rl": 20.0, "start.psi": 0.4})
        assert e.states() == pytest.approx([0, 0, 0.4, 1, 0, 0.2])
        nominals = {n: float(e.types[n].nominal) for n in STATES}
        assert list(e.nominals()) == list(nominals.values())  # by function as by description
        assert nominals["chair.v"] == 0.01 and nominals["chair.psi_dot"] == 0.1
        rates = e.rates()
        assert rates[:3] == pytest.approx([np.cos(0.4), np.sin(0.4), 0.2], rel=1e-12)
        assert list(rates) == e.get(*unpacked.derivatives)
        jacobian = np.array(
            [
                e.fmu.getDirectionalDerivative(
                    [unpacked.reference(n) for n in unpacked.derivatives], [unpacked.reference(n)], [1.0]
                )
                for n in STATES
            ]
        ).T
        x, h = e.states(), 1e-6
        for i in range(6):
            ends = [e.f(0.0, x + s * h * np.eye(6)[i]) for s in (1, -1)]
            np.testing.assert_allclose(jacobian[:, i], (ends[0] - ends[1]) / (2 * h), rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("archive", VERSIONS)
def test_a_new_prescribed_speed_is_an_event(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    with exchange(unpacked) as e:
        e.enter({"speed.mode": 2, "speed.u": 0.8})
        assert e.states()[3] == 0.8
        refused(ERROR, e.set, {"speed.u": 1.3})
        assert "speed.u is a parameter, and parameters change at events" in e.sentences[0]
        e.fmu.enterEventMode()
        e.set({"speed.u": 1.3})
        assert e.event() and e.states()[3] == 1.3
        e.fmu.enterEventMode()
        assert not e.event()  # told once


@pytest.mark.parametrize("archive", VERSIONS)
def test_a_wheel_leaves_the_ground_at_an_event(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    with exchange(unpacked) as e:
        e.enter({"effect.lateral_load_transfer.h": 1.0, "start.u": 2.0})
        assert e.indicators()[0] > 0 and e.get("load.lifted.margin", "push.beyond_friction.margin") == list(e.indicators())
        x = e.states()
        x[5] = 3.0  # a sudden turn
        e.put(x)
        assert e.indicators()[0] < 0 and e.get("load.lifted") == [0]  # until the event
        assert e.fmu.completedIntegratorStep() == (0, 0)
        assert "load.lifted is true" in e.sentences[0]
        e.fmu.enterEventMode()
        assert e.get("load.lifted") == [1]
        e.event()
        assert e.get("load.lifted") == [1]


@pytest.mark.parametrize("archive", VERSIONS)
def test_euler_at_the_default_step_integrates_a_turn(archive, request):
    """As the plainest of importers does; the model is stiff, and at 10 ms Euler diverges in any turn."""
    unpacked: Unpacked = request.getfixturevalue(archive)
    step, turn = float(unpacked.description.defaultExperiment.stepSize), {"push.F_rl": 20.0, "push.F_rr": 6.0}
    assert step <= 0.005
    with exchange(unpacked) as e, chair(unpacked) as c:
        e.enter(turn)
        c.start(turn).step(0.01, 400)
        x = e.states()
        for i in range(round(4 / step)):
            x = x + step * e.f(i * step, x)
        e.put(x)
        assert e.get("chair.u", "chair.psi_dot") == pytest.approx(c.get("chair.u", "chair.psi_dot"), rel=2e-3)


def test_cvode_stops_at_the_event(native):
    """A growing turn: the wheel lifts between two outputs, and the output says so from then on only."""
    pushes = np.array([(0.0, 0.0, 0.0), (2.0, 400.0, -400.0)], dtype=PUSHES.dtype)
    result = fmpy.simulate_fmu(
        str(native.path),
        fmi_type="ModelExchange",
        stop_time=2,
        output_interval=0.02,  # CVODE may take 500 steps between two outputs, and a start at its tolerance takes 300 in this
        input=pushes,
        start_values={"effect.lateral_load_transfer.h": 1.0, "start.u": 2.0, "chair.t_r": 0.3},
        output=["load.lifted", "load.rl", "load.rr", "load.fl", "load.fr"],
    )
    lifted = result["load.lifted"].astype(bool)
    least = np.min([result[f"load.{w}"] for w in ("rl", "rr", "fl", "fr")], axis=0)
    assert lifted.any() and not lifted[0]
    first = int(np.argmax(lifted))
    assert abs(least[first]) < 1e-6 and (least[:first] > -1e-6).all()


@pytest.mark.parametrize("archive", VERSIONS)
def test_a_saved_state_goes_on_bit_for_bit(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    with exchange(unpacked) as e, chair(unpacked) as c:
        e.enter(SET)
        x = e.states()
        e.f(0.1, x * 1.01)
        state = e.save()
        first = (e.f(0.2, x * 1.02), e.outputs())
        e.restore(state)
        again = (e.f(0.2, x * 1.02), e.outputs())
        assert (first[0] == again[0]).all() and first[1] == again[1]
        size = "serializeFMUstate" if e.version == 2 else "serializeFMUState"
        give = "deSerializeFMUstate" if e.version == 2 else "deserializeFMUState"
        refused(ERROR, getattr(c.fmu, give), getattr(e.fmu, size)(state))
        assert "the state was saved in Model Exchange, and this is Co-Simulation" in c.sentences[0]
        e.drop(state)


@pytest.mark.parametrize("archive", VERSIONS)
def test_bad_states_sizes_and_calls_are_refused(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    with exchange(unpacked) as e:
        refused(ERROR, e.rates)  # not yet initialized
        e.enter()
        before = e.states()
        refused(DISCARD, e.put, [0, 0, nan, 1, 0, 0])
        refused(ERROR, e.put, [0, 0, 0, 1, 0])
        refused(DISCARD, e.fmu.setTime, nan)
        assert (e.states() == before).all()
        refused(DISCARD, e.f, 0.0, [0, 0, 0, 1e200, 1e200, 1e300])
        e.put(before)
        assert np.isfinite(e.rates()).all()
        e.fmu.enterEventMode()
        refused(ERROR, e.put, before)
        assert "chair.psi = nan is not a finite number; the old states stay" in e.sentences[1]
        assert "this FMU has 6 continuous states, not 5" in e.sentences[2]
        if e.version == 3:
            refused(ERROR, e.fmu.fmi3EnterStepMode, e.fmu.component)
            assert "Co-Simulation has no event mode here" in e.sentences[-1]
