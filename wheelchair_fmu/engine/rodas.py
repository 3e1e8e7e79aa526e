"""Rodas4: the Rosenbrock method of order 4 with an embedded order 3, L-stable and stiffly accurate.

Coefficients and notation: Hairer & Wanner, Solving ODEs II, section VI.4 (method RODAS, its first set
of coefficients), in the form without matrix products:

    (M/(hγ) − J) U_i = f(t + α_i h, x + Σ a_ij U_j) + M Σ (c_ij/h) U_j + γ_i h ∂f/∂t
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as cs

from ..model.wheelchair import Model
from .lu import factorise

GAMMA = 0.25
ALPHA = (0.0, 0.386, 0.21, 0.63, 1.0, 1.0)
GAMMA_I = (0.25, -0.1043, 0.1035, -0.3620000000000023e-01, 0.0, 0.0)
A = (
    (),
    (0.1544000000000000e01,),
    (0.9466785280815826e00, 0.2557011698983284e00),
    (0.3314825187068521e01, 0.2896124015972201e01, 0.9986419139977817e00),
    (0.1221224509226641e01, 0.6019134481288629e01, 0.1253708332932087e02, -0.6878860361058950e00),
    (0.1221224509226641e01, 0.6019134481288629e01, 0.1253708332932087e02, -0.6878860361058950e00, 1.0),
)
C = (
    (),
    (-0.5668800000000000e01,),
    (-0.2430093356833875e01, -0.2063599157091915e00),
    (-0.1073529058151375e00, -0.9594562251023355e01, -0.2047028614809616e02),
    (0.7496443313967647e01, -0.1024680431464352e02, -0.3399990352819905e02, 0.1170890893206160e02),
    (0.8083246795921522e01, -0.7981132988064893e01, -0.3152159432874371e02, 0.1631930543123136e02, -0.6058818238834054e01),
)
DENSE_2 = (0.1012623508344586e02, -0.7487995877610167e01, -0.3480091861555747e02, -0.7992771707568823e01, 0.1025137723295662e01)
DENSE_3 = (-0.6762803392801253e00, 0.6087714651680015e01, 0.1643084320892478e02, 0.2476722511418386e02, -0.6594389125716872e01)


@dataclass(frozen=True)
class Step:
    """One step as expressions of (x, w0, w1, h, p).

    Inside the step, x(t + s h) = (1−s) x + s (x1 + (1−s) (d2 + s d3)), good to order 3.
    """

    w1: cs.SX
    h: cs.SX
    x1: cs.SX
    error: cs.SX
    d2: cs.SX
    d3: cs.SX
    U: list[cs.SX]


def step(model: Model) -> Step:
    """One step of length h over which the inputs go linearly from w0 (`model.w`) to w1."""
    x, w, p = model.x, model.w, model.p
    f = cs.Function("f", [x, w, p], [model.f])
    w1, h = cs.SX.sym("w1", w.numel()), cs.SX.sym("h")
    slope = cs.jtimes(model.f, w, w1 - w)  # h ∂f/∂t
    factors = factorise(cs.diag(model.mass) / (h * GAMMA) - cs.jacobian(model.f, x))
    U: list[cs.SX] = []
    for a, c, alpha, gamma_i in zip(A, C, ALPHA, GAMMA_I, strict=True):
        at = x + sum((a_j * U_j for a_j, U_j in zip(a, U, strict=True)), cs.SX.zeros(x.numel()))
        right = f(at, w + alpha * (w1 - w), p) + gamma_i * slope if U else model.f + gamma_i * slope
        if U:
            right += model.mass * sum(c_j * U_j for c_j, U_j in zip(c, U, strict=True)) / h
        U.append(factors.solve(right))
    x1 = x + sum(a_j * U_j for a_j, U_j in zip((*A[5], 1.0), U, strict=True))
    d2, d3 = (cs.horzcat(*U[:5]) @ cs.DM(d) for d in (DENSE_2, DENSE_3))
    return Step(w1, h, x1, U[5], d2, d3, U)
