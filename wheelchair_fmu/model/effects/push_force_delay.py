"""The recorded pushes come late or early against the other instruments. It shifts the record, not the chair."""

from ...quantities import Parameter, S
from ..stage import Effect

TAU = Parameter(
    "tau",
    S,
    "how much earlier the record is than the push that acts",
    off=0.0,
    smallest_interesting=0.01,
    lower=-1.0,
    upper=1.0,
    source="instrument",
)

EFFECT = Effect("push_force_delay", "recorded pushes that are early or late", parameters=(TAU,), delays_record=True)
