"""What one recorded run costs from Python, beside CasADi's CVODES and SciPy's LSODA on the same equations.

20 s at 100 Hz from 1 m/s under strokes with noise, so that the inputs bend at every sample; tolerance 1e-6. The model is
without effects, so that it has no algebraic rows and its right-hand side is simply f/M.

CVODES gets the inputs of each interval as start value and slope, controls that are constant in between: it then meets no
kink inside an interval, and all 2 000 intervals are one call. The peer of the target is CVODES as CasADi hands it out, BDF
with Newton and the equations interpreted; the fastest of its methods (Adams with fixed-point iteration, compiled equations)
is beside. At that tolerance its error is larger than ours, so another row asks the fastest for the same accuracy. LSODA is
one call of `odeint`, with the equations through CasADi's buffers.
Errors are the greatest in any state at any sample, from Radau at 1e-10 interval by interval.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from shlex import quote

import casadi as cs
import numpy as np
from scipy.integrate import odeint, solve_ivp

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.engine.kernel import kernel
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.model.variant import Variant

from . import limits
from .rows import Row, timed

TOLERANCE, REPEATS, TARGET = 1e-6, 9, 10.0
COMPILED = {
    "jit": True,
    "compiler": "shell",
    "jit_options": {
        "flags": ["-O2"],
        "compiler": " ".join(map(quote, compiler.command())),
        "linker": " ".join(map(quote, compiler.command())),
    },
}
ADAMS = {"linear_multistep_method": "adams", "nonlinear_solver_iteration": "functional"}
AS_IT_COMES = "BDF and Newton, interpreted"
METHODS = {
    AS_IT_COMES: {},
    "Adams, interpreted": ADAMS,
    "BDF and Newton, compiled": COMPILED,
    "Adams, compiled": {**ADAMS, **COMPILED},
}


@dataclass(frozen=True)
class Case:
    """The run: times t (n,) and inputs w (n, nw)."""

    simulator: Simulator
    t: np.ndarray
    w: np.ndarray

    @cached_property
    def p(self) -> np.ndarray:
        return self.simulator.variant.vector()

    @cached_property
    def x0(self) -> np.ndarray:
        return self.own()[0]

    @cached_property
    def slopes(self) -> np.ndarray:
        return np.diff(self.w, axis=0) / np.diff(self.t)[:, None]

    @cached_property
    def rate(self) -> cs.SX:
        return self.simulator.model.f / self.simulator.model.mass

    def own(self) -> np.ndarray:
        return self.simulator.run(self.t, self.w, self.p, tolerance=TOLERANCE).states


def case() -> Case:
    simulator = Simulator(Variant())
    t = np.arange(2001) * 0.01
    noise = np.random.default_rng(1).normal(0, 0.4, (2, len(t)))  # N, as force sensors have it
    beat, turn = 25 * np.maximum(0, np.sin(2 * np.pi * t)), 3 * np.sin(t)
    return Case(
        simulator, t, simulator.inputs(len(t), {"push.F_rl": beat + turn + noise[0], "push.F_rr": beat - turn + noise[1]})
    )


def cvodes(c: Case, options: dict[str, object]) -> Callable[[], np.ndarray]:
    m = c.simulator.model
    start, slope = (cs.SX.sym(name, c.w.shape[1]) for name in ("w0", "dw"))
    since, t = cs.SX.sym("t0"), cs.SX.sym("t")
    ode = cs.substitute(c.rate, m.w, start + slope * (t - since))
    dae = {"x": m.x, "p": m.p, "u": cs.vertcat(start, slope, since), "t": t, "ode": ode}
    controls = cs.DM(np.hstack([c.w[:-1], c.slopes, c.t[:-1, None]]).T)
    solve = cs.integrator("run", "cvodes", dae, c.t[0], c.t[1:], {"abstol": TOLERANCE, "reltol": TOLERANCE, **options})
    x0, p = cs.DM(c.x0), cs.DM(c.p)
    return lambda: np.vstack([c.x0, np.array(solve(x0=x0, p=p, u=controls)["xf"]).T])


def lsoda(c: Case) -> Callable[[], np.ndarray]:
    m = c.simulator.model
    function = cs.Function("rate", [m.x, m.w, m.p], [c.rate])
    buffer, evaluate = function.buffer()
    x, w, p, rate = np.zeros(len(c.x0)), np.zeros(c.w.shape[1]), np.ascontiguousarray(c.p), np.zeros(len(c.x0))
    for i, array in enumerate((x, w, p)):
        buffer.set_arg(i, memoryview(array))
    buffer.set_res(0, memoryview(rate))
    step, last = c.t[1] - c.t[0], len(c.t) - 2

    def f(t: float, now: np.ndarray, kept: object = (function, buffer, p)) -> np.ndarray:
        # the buffer holds bare addresses: what it points to must live as long as f
        i = min(int(t / step), last)
        x[:], w[:] = now, c.w[i] + c.slopes[i] * (t - c.t[i])
        evaluate()
        return rate

    return lambda: odeint(f, c.x0, c.t, tfirst=True, rtol=TOLERANCE, atol=TOLERANCE, mxstep=100_000)


def radau(c: Case) -> np.ndarray:
    """The truth, (n, nx): restarted at every sample, with the exact Jacobian."""
    m = c.simulator.model
    rate = cs.Function("rate", [m.x, m.w, m.p], [c.rate])
    slope = cs.Function("slope", [m.x, m.w, m.p], [cs.jacobian(c.rate, m.x)])
    rows = [c.x0]
    for i in range(len(c.t) - 1):

        def at(t: float, i: int = i) -> np.ndarray:
            return c.w[i] + c.slopes[i] * (t - c.t[i])

        run = solve_ivp(
            lambda t, x, at=at: rate(x, at(t), c.p).full().ravel(),
            (c.t[i], c.t[i + 1]),
            rows[-1],
            method="Radau",
            rtol=1e-10,
            atol=1e-12,
            jac=lambda t, x, at=at: slope(x, at(t), c.p).full(),
        )
        rows.append(run.y[:, -1])
    return np.array(rows)


def work_of(c: Case) -> tuple[limits.Work, int]:
    """What the run's own steps and results take, and how many steps they are."""
    functions = kernel(c.simulator.model).functions
    steps = c.simulator.run(c.t, c.w, c.p, tolerance=TOLERANCE).steps
    return limits.of(functions["plain"]) * steps + limits.of(functions["output"]) * len(c.t), steps


def rows() -> Iterator[Row]:
    c = case()
    truth = radau(c)

    def off(states: np.ndarray) -> float:
        return float(np.abs(states - truth).max())

    def error(states: np.ndarray) -> str:
        return f"error {off(states):.0e}"

    calls = {name: cvodes(c, options) for name, options in METHODS.items()}
    own = timed(c.own, 3 * REPEATS)
    work, steps = work_of(c)
    peers = {name: timed(call, REPEATS) for name, call in calls.items()}
    fastest = min(peers, key=lambda name: min(peers[name]))
    yield Row(
        "20 s run, own step map",
        "ms",
        own,
        TARGET,
        float(np.median(peers[AS_IT_COMES])),
        f"beside CVODES; {error(c.own())}",
        1e3 * work.seconds(limits.core(1)),
        f"{steps} steps and {len(c.t)} sets of results, {work.operations / 1e6:.1f} million operations one by one; the rest is "
        "waiting for operands, and the C library's functions",
    )
    yield Row("20 s run, own step map", "ms", own, peer=float(np.median(peers[fastest])), note=f"beside CVODES ({fastest})")
    for name, samples in peers.items():
        yield Row(f"20 s run, CVODES: {name}", "ms", samples, note=error(calls[name]()))
    for tolerance in (1e-7, 1e-8, 1e-9, 1e-10):
        tight = cvodes(c, {**METHODS[fastest], "abstol": tolerance, "reltol": tolerance})
        if off(tight()) <= off(c.own()):
            yield Row(f"20 s run, CVODES: {fastest}, asked for {tolerance:g}", "ms", timed(tight, 3), note=error(tight()))
            break
    slow = lsoda(c)
    yield Row("20 s run, LSODA", "ms", timed(slow, 3), note=error(slow()))
