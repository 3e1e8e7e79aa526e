"""Cornering stiffness that depends on the load, but less than in proportion:  C_λ (N / 400 N)^exponent."""

import casadi as cs

from ...quantities import ONE, N, Parameter
from ..stage import Effect, scales

EXPONENT = Parameter("exponent", ONE, "exponent of the load in the cornering stiffness: 0 none, 1 in proportion", off=0.0,
                     smallest_interesting=0.1, lower=-1.0, upper=2.0, source="Doria, Fig. 7")  # fmt: skip
REFERENCE = Parameter("N_ref", N, "load at which C_λ was measured", default=400.0, lower=1.0, upper=1e4,
                      source="Doria, Table 1")  # fmt: skip
LIGHTEST = 0.01  # of the reference load; a wheel that carries less is off the ground

EFFECT = Effect(
    "load_sensitivity",
    "cornering stiffness that grows less than the load",
    parameters=(EXPONENT,),
    constants=(REFERENCE,),
    contributions=(scales("k_F", lambda exponent, N_r, N_ref: cs.exp(exponent * cs.log(cs.fmax(N_r / N_ref, LIGHTEST)))),),
)
