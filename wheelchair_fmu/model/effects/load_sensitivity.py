"""Stiffnesses that depend on the load:  C_λ (N / N_ref)^exponent, less than in proportion, and C_mλ (N / N_ref)^exponent_M."""

import casadi as cs

from ...quantities import ONE, N, Parameter
from ..signs import Shows
from ..sketch import Curve, graph
from ..stage import Effect, scales

EXPONENT = Parameter(
    "exponent",
    ONE,
    "exponent of the load in the cornering stiffness: 0 none, 1 in proportion",
    off=0.0,
    smallest_interesting=0.1,
    lower=-1.0,
    upper=2.0,
    source="Doria, Fig. 7",
)
EXPONENT_M = Parameter(
    "exponent_M",
    ONE,
    "exponent of the load in the self-aligning stiffness; a rig tells it, driving hardly",
    default=0.0,
    lower=-1.0,
    upper=3.0,
    source="Doria, Fig. 7",
)
REFERENCE = Parameter(
    "N_ref", N, "load at which C_λ and C_mλ were measured", default=400.0, lower=50.0, upper=2000.0, source="Doria, Table 1"
)
LIGHTEST = 0.01  # of the reference load; a wheel that carries less is off the ground


def power(exponent, N_r, N_ref):
    return cs.exp(exponent * cs.log(cs.fmax(N_r / N_ref, LIGHTEST)))


EFFECT = Effect(
    "load_sensitivity",
    "cornering stiffness that grows less than the load",
    parameters=(EXPONENT,),
    constants=(EXPONENT_M, REFERENCE),
    contributions=(scales("q_F", power), scales("q_M", lambda exponent_M, N_r, N_ref: power(exponent_M, N_r, N_ref))),
    signs=(Shows("steady-turn", "slip.rr", more=True),),
    sketches=(
        graph(
            "load N",
            "stiffness C_λ",
            Curve(lambda x: 0.7, "", before=True),
            Curve(lambda x: 0.7 * (x / 0.75) ** 0.5, "exponent above 0"),
        ),
    ),
)
