"""A moment that turns the chair to one side while it rolls:  M_z += q u / √(u² + v_eps²)

This is a whole effect that keeps every contract. To make it yours, change from the top:

1. This text and the title at the end: say in a few words what it is.
2. Q, the size that is estimated: its unit (one of wheelchair_fmu.quantities), its meaning, the smallest size that
   would matter to you, its bounds, and where these numbers come from. 0 is the chair without the effect. Its mirror
   is "-", because a mirror along the chair turns right into left; what is the same on both sides has "+"; leave
   mirror= out where you make no claim.
3. LAW, the equation. It may name what `wheelchair effects quantities` lists. direction(u, v_eps) is the sign of u
   without its jump. A number that is no plain number has its unit behind it, as in tanh(psi_dot / 0.2 [rad/s]).
4. What it acts on: adds("M_z", LAW) adds a term to M_z, clockwise from above.
"""

from wheelchair_fmu.model.expression import law
from wheelchair_fmu.model.stage import Effect, adds
from wheelchair_fmu.quantities import N_M, Parameter

Q = Parameter(
    "q",
    N_M,
    "moment while it rolls forward, clockwise from above",
    off=0.0,
    smallest_interesting=0.2,
    lower=-20.0,
    upper=20.0,
    mirror="-",
    source="say where its size comes from",
)
LAW = law("q * direction(u, v_eps)")

EFFECT = Effect("my_effect", "a moment that turns the chair to one side", parameters=(Q,), contributions=(adds("M_z", LAW),))
