"""A drag that follows the speed with a lag:  F_x += −D,  T D' + D = q u

This is a whole effect that keeps every contract. To make it yours, change from the top:

1. This text and the title at the end: say in a few words what it is.
2. Q, the size that is estimated: its unit (one of wheelchair_fmu.quantities), its meaning, the smallest size that
   would matter to you, its bounds, and where these numbers come from. 0 is the chair without the effect. Its mirror
   is "+", because a drag is the same in a mirror along the chair; what pulls to one side has "-"; leave mirror= out
   where you make no claim.
3. T, a constant: a number with a unit that belongs to the effect and that no fit touches.
4. LAGGED, the state, and its row: mass(...) · x' = rate(...), from start(...) on. The arguments of these functions
   are what they read, by the symbols that `wheelchair effects quantities` lists, and the effect's own.
5. What it acts on: adds("F_x", drag) adds a term to F_x.
"""

from wheelchair_fmu.model.stage import Effect, Row, adds
from wheelchair_fmu.quantities import N_S_M, N, Parameter, S, State

Q = Parameter(
    "q",
    N_S_M,
    "drag at a steady speed of 1 m/s",
    off=0.0,
    smallest_interesting=0.5,
    lower=0.0,
    upper=100.0,
    mirror="+",
    source="say where its size comes from",
)
T = Parameter("T", S, "time by which the drag follows the speed", default=0.5, lower=0.01, upper=10.0, source="chosen")
LAGGED = State("lagged", N, "drag that acts", nominal=1.0)


def mass(T):
    return T


def rate(lagged, q, u):
    return q * u - lagged


def start(q, start_u):
    return q * start_u


def drag(lagged):
    return -lagged


EFFECT = Effect(
    "my_effect",
    "a drag that follows the speed with a lag",
    parameters=(Q,),
    constants=(T,),
    contributions=(adds("F_x", drag),),
    rows=(Row(LAGGED, mass, rate, start),),
)
