"""What the sign of an effect's parameter means for a chair, as a claim that is tried by simulation, and in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Manoeuvre = Literal["coast-down", "steady-turn", "spin", "start-stop", "slalom"]
DOING = {
    "coast-down": "coasting straight ahead",
    "steady-turn": "in a turn to the right",
    "spin": "spinning on the spot to the right",
    "start-stop": "pushed off from rest",
    "slalom": "in a slalom",
}
WORDS = {  # what more of a result is, and what less of it is
    "chair.psi": ("the chair veers to the right", "the chair veers to the left"),
    "chair.psi_dot": ("the chair turns faster", "the chair turns more slowly"),
    "chair.curvature": ("the turn is tighter", "the turn is wider"),
    "chair.u": ("the chair is faster", "the chair is slower"),
    "chair.v": ("the chair moves aside to the right", "the chair moves aside to the left"),
    "chair.y": ("the chair comes away to the right", "the chair comes away to the left"),
    "slip.rr": ("the right rear wheel slips more", "the right rear wheel slips less"),
    "push.total_needed": ("holding the speed takes more push", "holding the speed takes less push"),
}


@dataclass(frozen=True)
class Shows:
    """What a value above zero does: in the first `seconds` of `manoeuvre` the mean of `result` is greater than without it, or
    less. `either`: a value below zero does the same."""

    manoeuvre: Manoeuvre
    result: str
    more: bool
    either: bool = False
    seconds: float = 3.0

    @property
    def words(self) -> str:
        said = WORDS.get(self.result)
        what = said[not self.more] if said else f"`{self.result}` reads {'more' if self.more else 'less'}"
        return f"{DOING.get(self.manoeuvre, self.manoeuvre)}, {what}{', whatever its sign' if self.either else ''}"
