"""Small motions about a steady state:  z' = A z + B w,  y = C z + D w, exact by CasADi's derivatives.

States are u (at free speed), v, ψ' and those of active effects. The pose is left out: no steady turn has one. Rows
of M x' = f without mass are algebraic equations for their unknowns a, and are eliminated: da = −f_a⁻¹ (f_z dz + f_w dw).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .trim import MOTION, PSI, SteadyState, U


@dataclass(frozen=True, eq=False)
class Linear:
    """A (nz, nz), B (nz, nw), C (ny, nz), D (ny, nw) about `trim`, SI units, with the names of z, w and y."""

    trim: SteadyState
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray

    @cached_property
    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Eigenvalues (nz,) in 1/s, the slowest to die out first, and their shapes as columns (nz, nz) of length 1."""
        values, shapes = np.linalg.eig(self.A)
        order = np.lexsort((values.imag, -values.real))
        return values[order], shapes[:, order]

    @property
    def eigenvalues(self) -> np.ndarray:
        return self.modes[0]

    def state_space(self) -> Any:
        """As python-control's StateSpace, with the names, in which python-control wants _ for every dot."""
        import control  # takes a second, which only who asks for it waits

        names = {key: [n.replace(".", "_") for n in getattr(self, key)] for key in ("states", "inputs", "outputs")}
        return control.ss(self.A, self.B, self.C, self.D, name="wheelchair", **names)

    def matrices(self) -> dict[str, Any]:
        """What a .mat file holds: the matrices, the names, and the state and inputs they are about."""
        names = {key: np.array(getattr(self, key), object) for key in ("states", "inputs", "outputs")}
        about = {"speed": self.trim.speed, "delta_force": self.trim.delta_force, "w0": self.trim.w}
        return {"A": self.A, "B": self.B, "C": self.C, "D": self.D, **names, **about}


def linearize(state: SteadyState, *, free_speed: bool = False) -> Linear:
    """The linear model about a steady state, at a prescribed forward speed or with u as a state by (20)."""
    model = state.chair.model
    names = [n for s in model.states for n in s.names]
    _, _, mass, f_x, f_w, _, y_x, y_w, *_ = state.derivatives if free_speed else state.derivatives_held
    moving = [i for i in range(U if free_speed else MOTION, len(names)) if mass[i, 0] != 0]
    algebraic = [i for i in range(MOTION, len(names)) if mass[i, 0] == 0]
    follow_z, follow_w = (
        -np.linalg.solve(f_x[np.ix_(algebraic, algebraic)], by[algebraic][:, columns])
        for by, columns in ((f_x, moving), (f_w, slice(None)))
    )
    shown = _shown(state)

    def eliminated(by_x: np.ndarray, by_w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return by_x[:, moving] + by_x[:, algebraic] @ follow_z, by_w + by_x[:, algebraic] @ follow_w

    A, B = (part / mass[moving] for part in eliminated(f_x[moving], f_w[moving]))
    C, D = eliminated(y_x[shown], y_w[shown])
    outputs = tuple(model.outputs[i].name for i in shown)
    inputs = tuple(i.name for i in model.inputs)
    return Linear(state, tuple(names[i] for i in moving), inputs, outputs, A, B, C, D)


def radius_slopes(state: SteadyState) -> dict[str, float]:
    """∂ ln R / ∂p of every real parameter p by name, in 1/unit, at the same speed and ΔF; the total push follows.

    Empty straight on, where R is infinite. `speed.u` is the speed itself. What tilts the floor is left out: it ends
    every steady turn.
    """
    if state.straight:
        return {}
    chair, path_squared = state.chair, state.speed**2 + state.v**2
    f_x, f_w, f_p = state.derivatives[3:6]
    by_z = np.hstack([f_x[U:, MOTION:], f_w[U:] @ chair.pushes[:, :1]])  # without ΔF
    by_p = f_p[U:].copy()
    speed = chair.parameters.index("speed.u")
    by_p[:, speed] = f_x[U:, U]
    slopes = np.linalg.solve(by_z, -by_p)
    radius = state.v * slopes[0] / path_squared - slopes[1] / state.psi_dot  # (23)
    radius[speed] += state.speed / path_squared
    level = ~np.any(state.derivatives[9], axis=0)
    real = {
        p.name
        for p, stays in zip(chair.model.parameters, level, strict=True)
        if stays and not p.choices and not p.name.startswith("start.")
    }
    return {n: float(s) for n, s in zip(chair.parameters, radius, strict=True) if n in real}


def radius_sensitivities(state: SteadyState, slopes: Mapping[str, float]) -> dict[str, float]:
    """d ln R / d ln p from the slopes; 0 where p is 0."""
    values = dict(zip(state.chair.parameters, state.chair.p, strict=True)) | {"speed.u": state.speed}
    return {name: slope * float(values[name]) for name, slope in slopes.items()}


def _shown(state: SteadyState) -> list[int]:
    """Places of the results that a steady turn has: no pose, and nothing that is true or false."""
    outputs = state.chair.model.outputs
    y_x, y_w = state.derivatives[6:8]
    pose = [i for i in range(len(outputs)) if y_x[i, : PSI + 1].any() and not (y_x[i, U:].any() or y_w[i].any())]
    return [i for i, o in enumerate(outputs) if not o.boolean and i not in pose]
