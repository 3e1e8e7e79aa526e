"""A yaw rate sensor that reads too much in fast turns:  read_yaw_rate · (1 + q ψ'²)

This is a whole effect that keeps every contract. To make it yours, change from the top:

1. This text and the title at the end: say in a few words what it is.
2. Q, the size that is estimated: its unit, its meaning, the smallest size that would matter to you, its bounds, and
   where these numbers come from. 0 is the sensor that reads right. Its mirror is "+", because a sensor that reads too
   much to the right does so to the left; an offset has "-"; leave mirror= out where you make no claim.
3. LAW, the factor, which is 1 where q is 0. It may name what `wheelchair effects quantities` lists.
4. Which reading: scales("read_yaw_rate", LAW) multiplies it, adds("read_yaw_rate", law("q")) would be an offset in
   rad/s.
"""

from wheelchair_fmu.model.expression import law
from wheelchair_fmu.model.stage import Effect, scales
from wheelchair_fmu.quantities import Parameter, Unit

PER_RATE2 = Unit("s2/rad2", s=2, rad=-2)  # one that wheelchair_fmu.quantities does not have: exponents of kg, m, s, rad
Q = Parameter(
    "q",
    PER_RATE2,
    "by how much it reads too much at 1 rad/s",
    off=0.0,
    smallest_interesting=0.01,
    lower=-0.1,
    upper=1.0,
    mirror="+",
    source="say where its size comes from",
)
LAW = law("1 + q * psi_dot * psi_dot")

EFFECT = Effect(
    "my_effect",
    "yaw rate sensor that reads too much in fast turns",
    parameters=(Q,),
    contributions=(scales("read_yaw_rate", LAW),),
)
