"""Chairs with effects: driven for a while, or looked at in one moment."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from wheelchair_fmu.contracts.places import Place, evaluate
from wheelchair_fmu.engine.kernel import kernel, rate
from wheelchair_fmu.engine.simulate import Simulator, Trajectory
from wheelchair_fmu.model.choice import Choice
from wheelchair_fmu.model.variant import Variant

G, MASS, I_Z, A, B, T_R, T_F = 9.81, 80.0, 3.08, 0.25, 0.20, 0.55, 0.45  # Table 1
C_LAMBDA, C_M_LAMBDA, C_PHI, C_M_PHI = 5038.0, 45.0, 464.0, 3.0
# No rolling resistance, and slip angles as good as exact: what closed forms take for granted.
SMOOTH = {"resistance.f_r": 0.0, "resistance.f_f": 0.0, "regularisation.slip_speed": 1e-5}
# The CM over the rear axle and no self-aligning torque: a chair that spins on the spot as freely as a top.
TOP = {**SMOOTH, "chair.b": 0.0, "tyre.C_m_lambda": 0.0, "start.u": 0.0}

Push = float | Callable[[np.ndarray], np.ndarray]


def run(
    values: Mapping[str, float | str],
    inputs: Mapping[str, Push] | None = None,
    T: float = 5.0,
    n: int = 501,
    states: Mapping[str, float] | None = None,
    among: tuple[str, ...] = (),
    choice: Choice = Choice(),
) -> Trajectory:
    """Drive for T seconds; `states` are those at the start that no start parameter gives.

    `among`: effects to build in besides, at zero, so that several runs share what is compiled.
    """
    simulator = Simulator(Variant(choice).with_effects(among).with_values(values))
    t = np.linspace(0, T, n)
    w = simulator.inputs(n, {name: push(t) if callable(push) else push for name, push in (inputs or {}).items()})
    start = None
    if states is not None:
        start = kernel(simulator.model).functions["start"](simulator.variant.vector(), w[0]).full().ravel()
        _put(simulator.model, start, states)
    return simulator.run(t, w, tolerance=1e-9, start=start)


def snapshot(
    values: Mapping[str, float | str],
    inputs: Mapping[str, float] | None = None,
    states: Mapping[str, float] | None = None,
    choice: Choice = Choice(),
) -> dict:
    """Everything about a chair in one moment.

    Outputs go by name, quantities of the equations by symbol, and rates of states by name and prime: `now["psi_dot'"]`.
    """
    variant = Variant(choice).with_values(values)
    model = variant.model()
    functions, p = kernel(model).functions, variant.vector()
    w = np.array([(inputs or {}).get(i.name, i.start) for i in model.inputs])
    x = functions["start"](p, w).full().ravel()
    _put(model, x, states or {})
    for _ in range(5):  # algebraic states into their places
        x = functions["project"](x, w, p).full().ravel()
    y, x_dot, *quantities = evaluate(model, Place(x, w, p), model.y, rate(model), *model.quantities.values())
    return {
        **{symbol: v.item() if v.size == 1 else v for symbol, v in zip(model.quantities, quantities, strict=True)},
        **dict(zip((o.name for o in model.outputs), y, strict=True)),
        **dict(zip((f"{name}'" for s in model.states for name in s.names), x_dot, strict=True)),
    }


def _put(model, x: np.ndarray, states: Mapping[str, float]) -> None:
    names = [name for s in model.states for name in s.names]
    for name, value in states.items():
        x[names.index(name)] = value
