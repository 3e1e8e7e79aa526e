"""A load that slides forward on the frame, held by a spring and a damper:  M = [[m, l], [l, l]] for u' and the load's s''

This is a whole effect that keeps every contract. To make it yours, change from the top:

1. This text and the title at the end: say in a few words what it is.
2. LOAD, the size that is estimated: its unit (one of wheelchair_fmu.quantities), its meaning, the smallest size that
   would matter to you, its bounds, and where these numbers come from. 0 is the chair without the effect.
3. The constants: numbers with units that belong to the effect and that no fit touches.
4. The states, and their rows: mass(...) · x' = rate(...). The arguments of these functions are what they read, by the
   symbols that `wheelchair effects quantities` lists, and the effect's own.
5. What of its inertia the body shares with the chair: coupled={"u": ...}, "v" or "psi_dot", is the entry of the mass matrix
   beside the diagonal. It stands in the body's row and in the chair's, and `rate` is then the force on the body. A trunk of
   mass l that pitches by an angle about a pivot has its inertia about that pivot as mass, and shares l times its height with u.
"""

from wheelchair_fmu.model.stage import Effect, Row
from wheelchair_fmu.quantities import KG, M_S, N_S_M, M, Parameter, State, Unit

LOAD = Parameter(
    "load",
    KG,
    "mass that slides, part of chair.m",
    off=0.0,
    smallest_interesting=1.0,
    lower=0.0,
    upper=60.0,
    mirror="+",
    source="say where its size comes from",
)
K = Parameter("k", Unit("N/m", kg=1, s=-2), "stiffness of what holds it", default=2000.0, lower=1.0, upper=1e6, source="chosen")
D = Parameter("d", N_S_M, "its damping", default=100.0, lower=0.0, upper=1e5, symbol="damping", source="chosen")
PLACE = State("place", M, "how far the load has moved forward", nominal=0.01)
SPEED = State("speed", M_S, "how fast it moves", nominal=0.1, symbol="sliding_speed")


def moving(sliding_speed):
    return sliding_speed


def inertia(load):
    return load


def force(k, place, damping, sliding_speed):
    return -k * place - damping * sliding_speed


EFFECT = Effect(
    "my_effect",
    "a load that slides on the frame",
    parameters=(LOAD,),
    constants=(K, D),
    rows=(Row(PLACE, lambda: 1.0, moving), Row(SPEED, inertia, force, coupled={"u": inertia})),
)
