"""The compiled step map against SciPy's Radau, and against itself over other steps."""

from __future__ import annotations

import casadi as cs
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.kit import anywhere, variant_with
from wheelchair_fmu.engine.kernel import SIMULATED, at_rest, kernel, seldom
from wheelchair_fmu.engine.simulate import Simulator, Trajectory
from wheelchair_fmu.errors import SimulationError
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant

MANOEUVRES = {  # start speed, and pushes as functions of time
    "at 1 m/s": (1.0, lambda t: 10 + 8 * np.sin(2 * t), lambda t: 8 - 8 * np.sin(2 * t)),
    "from standstill": (0.0, lambda t: 10 + 8 * np.sin(2 * t), lambda t: 8 - 8 * np.sin(2 * t)),
    "spin": (0.0, lambda t: 20 * np.sin(t), lambda t: -20 * np.sin(t)),
    "in reverse": (-1.0, lambda t: -10 + np.sin(2 * t), lambda t: -8 - np.sin(2 * t)),
}


def radau(variant: Variant, t, w, x0):
    """States (n, nx) by SciPy's Radau at 1e-10; only for models without algebraic rows."""
    model, p = variant.model(), variant.vector()
    rates = cs.Function("rates", [model.x, model.w, model.p], [model.f / model.mass])
    slopes = cs.Function("slopes", [model.x, model.w, model.p], [cs.jacobian(model.f / model.mass, model.x)])
    rows = [x0]
    for i in range(len(t) - 1):

        def at(s, i=i):
            return w[i] + (w[i + 1] - w[i]) * (s - t[i]) / (t[i + 1] - t[i])

        run = solve_ivp(
            lambda s, x, at=at: rates(x, at(s), p).full().ravel(),
            (t[i], t[i + 1]),
            rows[-1],
            method="Radau",
            rtol=1e-10,
            atol=1e-12,
            jac=lambda s, x, at=at: slopes(x, at(s), p).full(),
        )
        rows.append(run.y[:, -1])
    return np.array(rows)


@pytest.mark.parametrize("name", MANOEUVRES)
@pytest.mark.parametrize("effects", [(), ("relaxation_length", "wheel_inertia", "floor_slope")], ids=["base", "effects"])
def test_it_agrees_with_radau_at_the_tolerance_asked(name, effects):
    u, left, right = MANOEUVRES[name]
    variant = variant_with(*effects)
    simulator = Simulator(variant)
    t = np.linspace(0, 3, 61)
    w = simulator.inputs(len(t), {"push.F_rl": left(t), "push.F_rr": right(t)})
    x0 = np.zeros(simulator.model.x.numel())
    x0[3] = u
    truth = radau(variant, t, w, x0)
    for tolerance in (1e-5, 1e-6, 1e-7):
        error = np.abs(simulator.run(t, w, start=x0, tolerance=tolerance).states - truth).max()
        # each step keeps the tolerance, and the errors of some hundred steps add up
        assert error < 10 * tolerance, tolerance


def test_rows_between_steps_are_as_good_as_steps():
    """Coasting needs few steps; the rows in between come from the method's interpolation."""
    simulator = Simulator()
    t = np.linspace(0, 5, 5001)
    w = simulator.inputs(len(t), {"push.F_rl": 8.0, "push.F_rr": 6.0})
    few, many = simulator.run(t, w, tolerance=1e-7), simulator.run(t, w, grid=1e-3, tolerance=1e-10)
    assert few.steps < 500 < many.steps
    np.testing.assert_allclose(few.states, many.states, atol=3e-6)


@pytest.mark.parametrize("period", [1e-3, 10e-3, 50e-3])
def test_on_the_grid_the_communication_step_does_not_matter(period):
    simulator = Simulator(variant_with("relaxation_length", "lateral_load_transfer", "floor_slope"))
    ends = []
    for step in (1e-3, period):
        t = np.arange(0, 2 + step / 2, step)
        w = simulator.inputs(len(t), {"push.F_rl": 12.0, "push.F_rr": 5.0})
        ends.append(simulator.run(t, w, grid=1e-3, hold=True).states[-1])
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-9)


@pytest.mark.parametrize("period", [0.7e-3, 3.3e-3, 1 / 30])
def test_off_the_grid_it_hardly_matters(period):
    simulator = Simulator()
    ends = []
    for step in (1e-3, period):
        t = np.append(np.arange(0, 2 - step / 2, step), 2.0)
        w = simulator.inputs(len(t), {"push.F_rl": 12.0, "push.F_rr": 5.0})
        ends.append(simulator.run(t, w, grid=1e-3, hold=True).states[-1])
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-6)


def turned_back(variant: Variant, period: float, tolerance: float = 1e-7) -> Trajectory:
    """Two seconds on the spot, pushed one way and the other: each wheel stops and turns back several times."""
    simulator = Simulator(variant)
    t = np.append(np.arange(0, 2 - period / 2, period), 2.0)
    push = np.where(np.floor(t / 0.3 + 1e-9) % 2 == 0, 15.0, -15.0)
    start = np.zeros(simulator.model.x.numel())
    return simulator.run(
        t,
        simulator.inputs(len(t), {"push.F_rl": push, "push.F_rr": -0.9 * push}),
        variant.vector(),
        start=start,
        tolerance=tolerance,
        grid=1e-3,
        hold=True,
    )


def test_a_wheel_that_turns_back_takes_few_steps():
    """Its dry resistance turns round within 0.1 ms, and with it, at once, the accelerations that the loads read."""
    variant = variant_with("lateral_load_transfer", "longitudinal_load_transfer")
    variant = variant.with_values({f"effect.{way}_load_transfer.h": 0.6 for way in ("lateral", "longitudinal")})
    fine, few, truth = turned_back(variant, 1e-3), turned_back(variant, 0.1), turned_back(variant, 1e-3, tolerance=1e-12)
    assert 2000 < fine.steps == few.steps < 2400
    np.testing.assert_allclose(fine.states[::100], few.states, atol=1e-9)
    np.testing.assert_allclose(fine.states[:, :6], truth.states[:, :6], atol=1e-6)
    places = {state.name: -1 - i for i, state in enumerate(reversed(variant.model().states))}
    algebraic = fine.states[:, places["algebraic.a_y"]]
    np.testing.assert_allclose(algebraic[1:], fine["sensor.a_y"][1:], atol=1e-7)


def test_algebraic_states_stay_in_place():
    """With σ = 0 the lagged slip is the slip; with load transfer the algebraic a_y is a_y."""
    variant = Variant().with_effects(bundled())
    simulator = Simulator(variant)
    t = np.linspace(0, 5, 501)
    w = simulator.inputs(len(t), {"push.F_rl": 10 + 5 * np.sin(3 * t), "push.F_rr": 8.0})
    run = simulator.run(t, w, variant.with_values({"effect.lateral_load_transfer.h": 0.5}).vector())
    np.testing.assert_allclose(run["effect.relaxation_length.lagged_slip.rl"], run["slip.rl"], atol=1e-6)
    places = {state.name: -1 - i for i, state in enumerate(reversed(simulator.model.states))}
    algebraic = run.states[:, places["algebraic.a_y"]]
    np.testing.assert_allclose(algebraic[1:], run["sensor.a_y"][1:], atol=1e-4)


def test_all_effects_off_is_the_plain_chair():
    t = np.linspace(0, 5, 501)
    runs = []
    for variant in (Variant(), Variant().with_effects(bundled())):
        simulator = Simulator(variant)
        w = simulator.inputs(len(t), {"push.F_rl": 10 + 5 * np.sin(3 * t), "push.F_rr": 8.0})
        runs.append(simulator.run(t, w, tolerance=1e-8)["chair.y"])
    np.testing.assert_allclose(runs[0], runs[1], atol=1e-4)  # casters lag by their 1 mm


def test_not_a_number_is_said_with_its_time():
    simulator = Simulator()
    t = np.linspace(0, 1, 101)
    w = simulator.inputs(len(t), {"push.F_rl": np.where(t > 0.5, np.nan, 1.0)})
    with pytest.raises(SimulationError, match=r"stops at t = 0.5 s: the equations gave NaN or infinity"):
        simulator.run(t, w)


def test_what_would_take_hours_is_refused():
    """A tolerance that asks for steps of some 1e-11 s: a thousand times as many as another that is small."""
    simulator = Simulator()
    t = np.linspace(0, 0.2, 3)
    w = simulator.inputs(len(t), {"push.F_rl": 10.0, "push.F_rr": -9.0})
    assert simulator.run(t, w, tolerance=1e-18).steps > 1e4
    with pytest.raises(SimulationError, match=r"stops at t = 0 s: .*too many would have been needed"):
        simulator.run(t, w, tolerance=1e-30)


@pytest.mark.parametrize(
    ("name", "effects", "size"),
    [("plain", "none", 0), pytest.param("plain", "all", 1, marks=pytest.mark.nightly), ("bare", "all", 0)],
)
def test_shorter_steps_are_the_step_on_a_level_floor_with_open_brakes(name, effects, size):
    """And the bare one, with all effects off besides."""
    rng = np.random.default_rng(4)
    variant = variant_with(*(() if effects == "none" else bundled()), size=size)
    functions = kernel(variant.model()).functions
    for _ in range(20):
        place = anywhere(variant, rng)
        w1 = place.w + 5 * rng.standard_normal(place.w.shape) * (place.w != 0)
        for i in seldom(variant.model()):
            place.w[i] = w1[i] = variant.model().inputs[i].start
        at = (place.x, place.w, w1, 0.01, place.p)
        for whole, short in zip(functions["step"](*at), functions[name](*at), strict=True):
            np.testing.assert_allclose(np.array(short), np.array(whole), rtol=1e-9, atol=1e-12)


def test_bare_results_are_the_results_on_a_level_floor_with_open_brakes_and_all_effects_off():
    rng = np.random.default_rng(5)
    variant = variant_with(*bundled(), size=0)
    functions = kernel(variant.model()).functions
    assert functions["bare_output"].n_instructions() < 0.6 * functions["output"].n_instructions()
    for _ in range(20):
        place = anywhere(variant, rng)
        for i in seldom(variant.model()):
            place.w[i] = variant.model().inputs[i].start
        whole, short = (np.array(functions[name](place.x, place.w, place.p)) for name in ("output", "bare_output"))
        np.testing.assert_allclose(short, whole, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("name", ["brake.rl", "brake.rr", "floor.slope_x", "floor.slope_y", "floor.rolling_factor"])
def test_no_input_is_overlooked_because_most_runs_leave_it_at_rest(name):
    """From rest to somewhere, and from somewhere to rest, within one step."""
    simulator = Simulator()
    rest = next(i for i in simulator.model.inputs if i.name == name).start
    t, size = np.linspace(0, 0.02, 3), {"brake.rl": 0.3, "brake.rr": 0.3}.get(name, 0.05)
    w = simulator.inputs(3, {"push.F_rl": 12.0, "push.F_rr": 9.0, name: rest + size * np.array([0.0, 1.0, 0.0])})
    plain = simulator.inputs(3, {"push.F_rl": 12.0, "push.F_rr": 9.0})
    x0 = simulator.run(t, plain).states[0]
    moved, unmoved = (simulator.run(t, inputs, start=x0, grid=0.01).states for inputs in (w, plain))
    first, second = np.abs(np.diff(moved - unmoved, axis=0)).max(axis=1)
    assert first > 1e-6 and second > 1e-6


@pytest.mark.parametrize("force", [0.0, 15.0])
@pytest.mark.parametrize("size", [0, 1])
def test_where_only_a_force_moves_besides_pushes_one_step_serves_both(force, size):
    """A plain one would be nearly the same; with no effect on, the bare one is taken where that force rests, and only there."""
    variant, moving = variant_with(*bundled(), size=size), ("external.force", "external.moment")
    assert not {"plain", "forward", "rate"} & kernel(at_rest(variant.model(), moving), SIMULATED).functions.keys()
    assert "plain" in kernel(variant.model(), SIMULATED).functions
    t = np.linspace(0, 1, 101)
    runs = []
    for simulator in (Simulator(variant), Simulator(variant, moving=moving)):
        w = simulator.inputs(len(t), {"push.F_rl": 12.0, "push.F_rr": 9.0, "external.force": force * np.sin(3 * t)})
        runs.append(simulator.run(t, w, tolerance=1e-9))
    np.testing.assert_allclose(runs[1].states, runs[0].states, rtol=1e-7, atol=1e-9)


def test_a_run_with_an_effect_that_is_hardly_on_is_a_run_without():
    """No step is taken without the effects where one of them is on, however little."""
    simulator = Simulator(variant_with("floor_slope", "turn_slip", size=0))
    t = np.linspace(0, 2, 41)
    w = simulator.inputs(len(t), {"push.F_rl": 12.0, "push.F_rr": 9.0})
    at = {p.name: i for i, p in enumerate(simulator.model.parameters)}
    runs = []
    for size in (0.0, 1e-9, 1e-3):
        p = simulator.variant.vector()
        p[at["effect.turn_slip.M"]] = p[at["effect.floor_slope.x"]] = size
        runs.append(simulator.run(t, w, p, grid=0.01).states)
    off, hardly, on = runs
    assert 0 < np.abs(hardly - off).max() < 1e-7
    assert np.abs(on - off).max() > 1e-4
