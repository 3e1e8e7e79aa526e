"""A drag in proportion to speed:  F_x += −q u

This is a whole effect that keeps every contract. To make it yours, change from the top:

1. This text and the title at the end: say in a few words what it is.
2. Q, the size that is estimated: its unit (one of wheelchair_fmu.quantities), its meaning, the smallest size that
   would matter to you, its bounds, and where these numbers come from. 0 is the chair without the effect. Its mirror
   is "+", because a drag is the same in a mirror along the chair; what pulls to one side has "-"; leave mirror= out
   where you make no claim.
3. LAW, the equation. It may name what `wheelchair effects quantities` lists. A number that is no plain number has its
   unit behind it, as in tanh(u / 0.1 [m/s]).
4. What it acts on: adds("F_x", LAW) adds a term to F_x, scales("D_r", law("1 + q")) would multiply D_r. opposes="u"
   promises that the term never pushes along u; leave it out where that is not so.
"""

from wheelchair_fmu.model.expression import law
from wheelchair_fmu.model.stage import Effect, adds
from wheelchair_fmu.quantities import N_S_M, Parameter

Q = Parameter(
    "q",
    N_S_M,
    "drag at a speed of 1 m/s",
    off=0.0,
    smallest_interesting=0.5,
    lower=0.0,
    upper=100.0,
    mirror="+",
    source="say where its size comes from",
)
LAW = law("-q * u")

EFFECT = Effect("my_effect", "a drag in proportion to speed", parameters=(Q,), contributions=(adds("F_x", LAW, opposes="u"),))
