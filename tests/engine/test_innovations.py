"""The filter against dense linear algebra: r' V⁻¹ r with V built in full."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from wheelchair_fmu.engine.innovations import ByForces, Disturbance, Noise, Whitener
from wheelchair_fmu.engine.smoothing import smoothed


def drawn(rng, n, nx, ns, keeps):
    """A run of n samples with nx states, four pushes and ns sensors, whose derivatives are drawn at random."""
    return SimpleNamespace(
        time=0.01 * np.arange(n),
        transition=keeps * rng.normal(size=(n - 1, nx, nx)),
        push_before=rng.normal(size=(n - 1, nx, 4)),
        push_after=rng.normal(size=(n - 1, nx, 4)),
        by_state=rng.normal(size=(n, ns, nx)),
        by_push=rng.normal(size=(n, ns, 4)),
    )


@pytest.mark.parametrize("colour", [0.0, 0.8])
def test_innovations_are_generalised_least_squares(colour):
    rng = np.random.default_rng(0)
    n, nx, nq, nz = 12, 3, 2, 2
    run = drawn(rng, n, nx, 3, 0.3)
    noise = Noise(
        np.array([0.3, 0.5]), np.full(nq, colour), np.array([0.2, 0.4]), np.full(nz, colour), np.diag([0.1, 0.0, 0.2]) ** 2
    )
    which = [0, 2]
    signals = rng.normal(size=(n, nz, 4))
    signals[4, 1, 0] = np.nan
    mean = rng.normal(size=nx)
    whitener = Whitener(run, which, noise, ~np.isnan(signals[:, :, 0]))
    white, logdet = whitener(signals, mean), whitener.logdet

    V, offset = dense(run, which, noise, n, nx, nq, nz, mean)
    keep = ~np.isnan(signals[:, :, 0].ravel())
    V = V[np.ix_(keep, keep)]
    flat = signals.reshape(n * nz, -1)[keep]
    flat[:, 0] -= offset[keep]
    filtered = white.reshape(n * nz, -1)[keep]
    np.testing.assert_allclose(filtered.T @ filtered, flat.T @ np.linalg.solve(V, flat), rtol=1e-8)
    assert logdet == pytest.approx(np.linalg.slogdet(V)[1], rel=1e-9)


@pytest.mark.parametrize("colour", [0.0, 0.8])
@pytest.mark.parametrize("nx", [3, 9, 20])
def test_signals_side_by_side_are_whitened_as_each_alone(colour, nx):
    """However many they are, and however long the filter's rows are."""
    rng = np.random.default_rng(2)
    n, nq, nz, m = 12, 2, 3, 31
    run = drawn(rng, n, nx, nz, 0.1)
    noise = Noise(np.array([0.3, 0.5]), np.full(nq, colour), np.array([0.2, 0.4, 0.1]), np.full(nz, colour), 0.01 * np.eye(nx))
    signals, none = rng.normal(size=(n, nz, m)), np.zeros(nx)
    present = np.ones((n, nz), bool)
    present[4, 1] = False
    whitener = Whitener(run, [0, 1, 2], noise, present)
    together = whitener(signals, none)
    for j in range(m):
        alone = whitener(signals[:, :, [j]], none)[:, :, 0]
        np.testing.assert_allclose(together[present][:, j], alone[present], rtol=1e-9, atol=1e-9)


def test_forces_that_nobody_recorded_are_part_of_the_covariance():
    """A disturbance is a coloured push on a mixture of wheels, beside the noise of the record."""
    rng = np.random.default_rng(4)
    n, nx, nq, nz, lasting = 12, 3, 2, 2, 0.05
    run = drawn(rng, n, nx, nz, 0.3)
    noise = Noise(np.array([0.3, 0.5]), np.zeros(nq), np.array([0.2, 0.4]), np.zeros(nz), np.diag([0.1, 0.0, 0.2]) ** 2)
    signal, mean, present = rng.normal(size=(n, nz, 1)), np.zeros(nx), np.ones((n, nz), bool)
    unknown = Disturbance(np.array([2.0, 0.7]), np.full(2, lasting), np.array([[0.5, 2.0], [0.5, -2.0]]))
    V, _ = dense(run, [0, 1], noise, n, nx, nq, nz, mean)
    lag = np.abs(np.subtract.outer(run.time, run.time))
    each = np.array(
        [[respond(run, ("push", i, q), run.by_state, run.by_push[:, :, :nq], n, nx, nq) for i in range(n)] for q in (0, 1)]
    )
    for d, sd in enumerate(unknown.sd):
        response = np.tensordot(unknown.as_push[:, d], each, axes=1)
        V += sd**2 * response.T @ np.exp(-lag / lasting) @ response
    plain = Whitener(run, [0, 1], noise, present)
    for filter_ in (plain.disturbed(unknown), Whitener(run, [0, 1], noise, present, disturbance=unknown)):
        white = filter_(signal, mean).ravel()
        assert white @ white == pytest.approx(signal.ravel() @ np.linalg.solve(V, signal.ravel()), rel=1e-8)
        assert filter_.logdet == pytest.approx(np.linalg.slogdet(V)[1], rel=1e-9)
        assert filter_.response(np.ones((n, nq))).shape == (n, nz)
        deviance = ByForces(plain, replace(unknown, sd=np.ones(2)), signal[:, :, 0], mean)
        assert deviance(unknown.sd, unknown.lasting) == pytest.approx(white @ white + filter_.logdet, rel=1e-12)
    assert plain.disturbed(replace(unknown, sd=np.zeros(2))).logdet == pytest.approx(plain.logdet, rel=1e-12)


@pytest.mark.parametrize("ar", [0.0, 0.6])
def test_inputs_that_never_have_noise_change_nothing(ar):
    """A push that is known exactly, and a force that was found to be none, before, between and after those that act."""
    rng = np.random.default_rng(8)
    n, nx, nz, mean = 14, 3, 2, np.array([0.1, 0.0, -0.2])
    run = drawn(rng, n, nx, nz, 0.3)
    start, sd, colour = np.diag([0.1, 0.0, 0.2]) ** 2, np.array([0.2, 0.4]), np.array([ar, 0.0])
    few = Noise(np.array([0.3, 0.5]), np.array([0.2, 0.0]), sd, colour, start)
    more = Noise(np.array([0.0, 0.3, 0.0, 0.5]), np.array([0.1, 0.2, 0.1, 0.0]), sd, colour, start)
    acts, present = rng.normal(size=(4, 3)), rng.random((n, nz)) < 0.9
    common = np.array([[1.0, 0.2, 0.3], [0.2, 1.0, 0.1], [0.3, 0.1, 1.0]])
    lasting = rng.uniform(0.02, 0.1, size=(n, 3))
    every = Disturbance(np.array([2.0, 0.0, 0.7]), lasting, acts, common)
    acting = Disturbance(every.sd[[0, 2]], lasting[:, [0, 2]], acts[[1, 3]][:, [0, 2]], common[np.ix_([0, 2], [0, 2])])
    acts[[0, 2]] = 0.0
    one = Whitener(run, [0, 1], more, present, disturbance=every)
    other = Whitener(run, [0, 1], few, present, pushes=[1, 3], disturbance=acting)
    assert one.logdet == pytest.approx(other.logdet, rel=1e-12)
    np.testing.assert_allclose(one.spread, other.spread, rtol=1e-12)
    signals = rng.normal(size=(n, nz, 30))
    for some in (signals[:, :, :1], signals):
        np.testing.assert_allclose(one(some, mean), other(some, mean), rtol=1e-9, atol=1e-12)
    told = one(signals[:, :, :1], mean)[:, :, 0]
    np.testing.assert_allclose(one.smoothed(told)[:, [0, 2]], other.smoothed(told), rtol=1e-9, atol=1e-12)
    assert not one.smoothed(told)[:, 1].any()


def test_a_disturbance_is_smoothed_as_all_readings_have_it():
    """Against conditioning of the joint Gaussian in full."""
    rng = np.random.default_rng(6)
    n, nx, nq, nz, lasting = 10, 2, 2, 2, 0.05
    run = drawn(rng, n, nx, nz, 0.4)
    noise = Noise(np.array([0.3, 0.5]), np.full(nq, 0.5), np.array([0.2, 0.4]), np.array([0.0, 0.6]), np.diag([0.1, 0.2]) ** 2)
    signal, present = rng.normal(size=(n, nz)), np.ones((n, nz), bool)
    present[3, 1] = present[5, 0] = False
    unknown = Disturbance(np.array([2.0, 0.7]), np.full(2, lasting), np.array([[0.5, 2.0], [0.5, -2.0]]))
    V, offset = dense(run, [0, 1], noise, n, nx, nq, nz, np.array([0.3, -0.2]))
    lag = np.exp(-np.abs(np.subtract.outer(run.time, run.time)) / lasting)
    H, D = run.by_state, run.by_push[:, :, :nq]
    pushed = np.array([[respond(run, ("push", i, q), H, D, n, nx, nq) for i in range(n)] for q in (0, 1)])
    by = [np.tensordot(unknown.as_push[:, d], pushed, axes=1) for d in (0, 1)]
    V += sum(sd**2 * response.T @ lag @ response for sd, response in zip(unknown.sd, by, strict=True))
    keep = present.ravel()
    solve = np.linalg.inv(V[np.ix_(keep, keep)])
    filter_, start = Whitener(run, [0, 1], noise, present, disturbance=unknown), np.array([0.3, -0.2])
    mean, sd = smoothed(filter_, signal, start)
    told = filter_(signal[:, :, None], start)[:, :, 0]
    np.testing.assert_allclose(filter_.smoothed(told), mean, rtol=1e-7, atol=1e-9)
    apart = 0.5 ** np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    for q, error in enumerate(noise.pushes):
        of_all = error**2 * apart @ pushed[q][:, keep] @ solve @ (signal.ravel() - offset)[keep]
        np.testing.assert_allclose(filter_._noise(told)[:, q], of_all, rtol=1e-7, atol=1e-9)
    for d in (0, 1):
        cross = unknown.sd[d] ** 2 * lag @ by[d][:, keep]
        np.testing.assert_allclose(mean[:, d], cross @ solve @ (signal.ravel() - offset)[keep], rtol=1e-7, atol=1e-9)
        np.testing.assert_allclose(sd[:, d] ** 2, unknown.sd[d] ** 2 - np.diag(cross @ solve @ cross.T), rtol=1e-6)


def test_two_disturbances_that_one_white_noise_drives_go_through_the_filter_as_a_process_of_second_order():
    """Against the covariance in full: of x₁ and x₂ a time t apart it is ρ e^(−t/T) of the one that comes later."""
    rng = np.random.default_rng(8)
    n, nx, nq, nz, times = 10, 2, 2, 2, np.array([0.04, 0.1])
    run = drawn(rng, n, nx, nz, 0.4)
    noise = Noise(np.array([0.3, 0.5]), np.full(nq, 0.5), np.array([0.2, 0.4]), np.array([0.0, 0.6]), np.diag([0.1, 0.2]) ** 2)
    signal, present, rho = rng.normal(size=(n, nz)), np.ones((n, nz), bool), 2 * np.sqrt(times.prod()) / times.sum()
    common = np.array([[1.0, rho], [rho, 1.0]])
    unknown = Disturbance(np.array([2.0, 1.5]), times, np.array([[0.5, -0.4], [0.5, -0.4]]), common)
    V, _ = dense(run, [0, 1], noise, n, nx, nq, nz, np.zeros(2))
    apart = np.subtract.outer(run.time, run.time)
    H, D = run.by_state, run.by_push[:, :, :nq]
    pushed = np.array([[respond(run, ("push", i, q), H, D, n, nx, nq) for i in range(n)] for q in (0, 1)])
    by = [np.tensordot(unknown.as_push[:, d], pushed, axes=1) for d in (0, 1)]

    def together(a, b):
        later = np.where(apart >= 0, times[a], times[b])
        return common[a, b] * unknown.sd[a] * unknown.sd[b] * np.exp(-np.abs(apart) / later)

    V += sum(by[a].T @ together(a, b) @ by[b] for a in (0, 1) for b in (0, 1))
    filter_ = Whitener(run, [0, 1], noise, present, disturbance=unknown)
    white = filter_(signal[:, :, None], np.zeros(2))[:, :, 0]
    assert white.ravel() @ white.ravel() == pytest.approx(signal.ravel() @ np.linalg.solve(V, signal.ravel()), rel=1e-8)
    assert filter_.logdet == pytest.approx(np.linalg.slogdet(V)[1], rel=1e-9)
    mean, _ = smoothed(filter_, signal, np.zeros(2))
    solved = np.linalg.solve(V, signal.ravel())
    for d in (0, 1):
        cross = sum(together(d, other) @ by[other] for other in (0, 1))
        np.testing.assert_allclose(mean[:, d], cross @ solved, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(filter_.smoothed(white), mean, rtol=1e-7, atol=1e-9)


def dense(run, which, noise, n, nx, nq, nz, mean):
    """Covariance of all readings, and their mean from the start's, by superposition."""
    H, D = run.by_state[:, which], run.by_push[:, which, :nq]
    V = np.zeros((n * nz, n * nz))
    for k in range(nx):
        response = respond(run, ("start", k), H, D, n, nx, nq)
        V += noise.start[k, k] * np.outer(response, response)
    lag = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    for q in range(nq):
        responses = np.array([respond(run, ("push", i, q), H, D, n, nx, nq) for i in range(n)])
        V += noise.pushes[q] ** 2 * responses.T @ noise.push_colour[q] ** lag @ responses
    for z in range(nz):
        V[z::nz, z::nz] += noise.readings[z] ** 2 * noise.colour[z] ** lag
    offset = sum(mean[k] * respond(run, ("start", k), H, D, n, nx, nq) for k in range(nx))
    return V, offset


def respond(run, source, H, D, n, nx, nq):
    e, out = np.zeros(nx), []
    if source[0] == "start":
        e[source[1]] = 1
    for i in range(n):
        q = np.zeros(nq)
        if source[0] == "push" and source[1] == i:
            q[source[2]] = 1
            if i:
                e = e + run.push_after[i - 1][:, :nq] @ q
        out.append(H[i] @ e + D[i] @ q)
        if i + 1 < n:
            e = run.transition[i] @ e + run.push_before[i][:, :nq] @ q
    return np.concatenate(out)


def test_response_to_other_pushes_is_the_sum_of_those_to_each():
    rng = np.random.default_rng(2)
    n, nx, nq, nz = 9, 3, 2, 2
    run = drawn(rng, n, nx, nz, 0.4)
    noise = Noise(np.full(nq, 0.1), np.zeros(nq), np.full(nz, 0.1), np.zeros(nz), np.zeros((nx, nx)))
    change = rng.normal(size=(n, nq))
    H, D = run.by_state, run.by_push[:, :, :nq]
    expected = sum(change[i, q] * respond(run, ("push", i, q), H, D, n, nx, nq) for i in range(n) for q in range(nq))
    found = Whitener(run, [0, 1], noise, np.ones((n, nz), bool)).response(change)
    np.testing.assert_allclose(found.ravel(), expected, rtol=1e-10, atol=1e-12)


def test_spread_is_each_readings_own_standard_deviation():
    rng = np.random.default_rng(1)
    n, nx, nq, nz = 8, 2, 1, 2
    run = drawn(rng, n, nx, nz, 0.5)
    noise = Noise(np.array([0.3]), np.zeros(1), np.array([0.2, 0.4]), np.zeros(nz), np.diag([0.1, 0.2]) ** 2)
    V, _ = dense(run, [0, 1], replace(noise, start=0 * noise.start), n, nx, nq, nz, np.zeros(nx))
    spread = Whitener(run, [0, 1], noise, np.ones((n, nz), bool)).spread
    np.testing.assert_allclose(spread.ravel(), 1 / np.sqrt(np.diag(V)), rtol=1e-10)


def test_colour_is_by_time_where_rows_belong_to_several_loggers():
    """Readings of two loggers, 0.01 s and 0.025 s apart, have noise that forgets with time, not with rows."""
    rng = np.random.default_rng(3)
    mine, other = 0.01 * np.arange(15), 0.003 + 0.025 * np.arange(6)
    time = np.sort(np.concatenate((mine, other)))
    n, nx = len(time), 2
    run = drawn(rng, n, nx, 2, 0.3)
    run.time = time
    present = np.stack([np.isin(time, mine), np.isin(time, other)], axis=1)
    noise = Noise(np.zeros(1), np.zeros(1), np.array([0.2, 0.4]), np.array([0.7, 0.5]), np.diag([0.1, 0.2]) ** 2)
    signal = np.where(present, rng.normal(size=(n, 2)), np.nan)[:, :, None]
    white = Whitener(run, [0, 1], noise, present)(signal, np.zeros(nx))[present][:, 0]

    V = np.zeros((2 * n, 2 * n))
    for k in range(nx):
        response = respond(run, ("start", k), run.by_state, run.by_push[:, :, :1], n, nx, 1)
        V += noise.start[k, k] * np.outer(response, response)
    apart = np.abs(np.subtract.outer(time, time))
    for z, (sd, phi, step) in enumerate(((0.2, 0.7, 0.01), (0.4, 0.5, 0.025))):
        V[z::2, z::2] += sd**2 * phi ** (apart / step)
    keep = present.ravel()
    flat = signal.ravel()[keep]
    assert white @ white == pytest.approx(flat @ np.linalg.solve(V[np.ix_(keep, keep)], flat), rel=1e-8)


def coasting(time: np.ndarray, mass: float) -> SimpleNamespace:
    """A chair of this mass (kg) that nothing slows down, whose speed is read at these times (n,)."""
    n = len(time)
    half = np.zeros((n - 1, 1, 4))
    half[:, 0, 0] = np.diff(time) / 2 / mass  # a straight line between two samples
    return SimpleNamespace(
        time=time,
        transition=np.ones((n - 1, 1, 1)),
        push_before=half,
        push_after=half,
        by_state=np.ones((n, 1, 1)),
        by_push=np.zeros((n, 1, 4)),
    )


@pytest.mark.parametrize("phi", [0.0, 0.8])
def test_noise_of_a_push_moves_the_chair_alike_however_many_rows_lie_between_its_samples(phi):
    """A chair of 1 kg, a push at 100 Hz with noise of 1 N, readings in between: variance of its speed after 4 s."""

    def speed_variance(time: np.ndarray) -> float:
        run, n = coasting(time, 1.0), len(time)
        noise = Noise(np.ones(1), np.full(1, phi), np.full(1, 1e-9), np.zeros(1), np.zeros((1, 1)), np.full(1, 0.01))
        return float(Whitener(run, [0], noise, np.ones((n, 1), bool)).spread[-1, 0] ** -2)

    own = 0.01 * np.arange(401)
    rng = np.random.default_rng(4)
    many = np.sort(np.concatenate((own, rng.uniform(0, 4, 800))))
    assert speed_variance(many) == pytest.approx(speed_variance(own), rel=0.05)
    assert speed_variance(own) == pytest.approx(4 * 0.01 * (1 + phi) / (1 - phi), rel=0.05)


def test_a_body_that_swings_is_as_far_off_at_the_start_as_later():
    """A chair of 2 kg and a body whose momentum p has a standard deviation of 3 N s: simulated without it from the speed of
    both, the chair is off by p / m at any time."""
    time, p, m, (alpha, beta) = 0.01 * np.arange(300), 3.0, 2.0, (10.0, 5.0)
    run, n = coasting(time, m), len(time)
    driven = np.sqrt(2 * alpha * beta * (alpha + beta)) / (alpha - beta) * p
    common = np.eye(2) + 2 * np.sqrt(alpha * beta) / (alpha + beta) * np.eye(2)[::-1]
    body = Disturbance(
        driven * np.sqrt([alpha / 2, beta / 2]), np.array([1 / alpha, 1 / beta]), np.array([[-1.0, 1.0]]), common
    )
    noise = Noise(np.zeros(1), np.zeros(1), np.full(1, 0.01), np.zeros(1), np.zeros((1, 1)))
    filter_ = Whitener(run, [0], noise, np.ones((n, 1), bool), disturbance=body)
    np.testing.assert_allclose(1 / filter_.spread, np.hypot(p / m, 0.01), rtol=0.02)
