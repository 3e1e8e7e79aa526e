"""What is hidden in the benchmark's campaigns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ..independent.campaigns import CHANNELS
from ..independent.hidden import CATALOGUE, EFFECTS, OUTSIDE, own, usual

SIZES = (0.25, 1.0, 3.0)  # of δ
PAIRS = (
    ("caster_friction", "floor_cross_slope"),
    ("relaxation_length", "rolling_resistance_speed"),
    ("scrub_torque", "gyro_scale"),
    ("trunk_motion", "rolling_resistance_asymmetry"),
    ("cm_lateral_offset", "wheel_radius_error"),
    ("gyro_bias", "aerodynamic_drag"),
)
ALONE = (("trunk_motion", "swing"),)  # a body that goes on after the push, of second order where the catalogue's law is linear
SWINGING: tuple[tuple[tuple[str, ...], str], ...] = (  # asked by a law of casters that swing, as the other chair's do
    ((), "everyday"),
    ((), "slow"),
    (("rolling_resistance_asymmetry",), "everyday"),
    (("pivot_torque",), "one-handed"),
    (("rolling_resistance_asymmetry",), "slow"),
    (("turn_slip",), "slow"),
    (("pivot_torque",), "slow"),
    (("scrub_torque",), "slow"),
)
NEAR_TIES = ("aerodynamic_drag", "rolling_resistance_speed")  # on straight runs, where nobody can tell them apart


@dataclass(frozen=True)
class Case:
    """One campaign. `left_out` are effects that the catalogue is not to have."""

    kind: str
    effects: tuple[str, ...] = ()
    times: float = 1.0
    noise: str = "white"
    manoeuvres: str = "everyday"
    left_out: tuple[str, ...] = ()
    seed: int = 0
    only: str = ""  # the one parameter of the effect that is hidden, where not all are
    casters: str = "ideal"  # the law of casters that it is asked by

    @property
    def name(self) -> str:
        what = "+".join(self.effects) or "none"
        what += f".{self.only}" if self.only else ""
        by = f"-{self.casters}" if self.casters != "ideal" else ""
        return f"{self.kind}-{what}-{self.times:g}-{self.noise}-{self.manoeuvres}{by}-{self.seed}"

    @property
    def channels(self) -> tuple[str, ...]:
        """The usual ones, and those that show what is hidden."""
        return (*CHANNELS, *dict.fromkeys(c for e in self.effects for c in EFFECTS[e].channels))

    @property
    def hidden(self) -> Mapping[str, Mapping[str, float]]:
        if self.only:
            return {e: {self.only: self.times * EFFECTS[e].parameters[self.only].delta} for e in self.effects}
        return {e: usual(e, self.times) for e in self.effects}

    @property
    def true(self) -> Mapping[str, Mapping[str, float]]:
        """What the chair has of these effects in all, with what of them is its own."""
        return {e: {n: EFFECTS[e].parameters[n].whole(v) for n, v in values.items()} for e, values in self.hidden.items()}

    @property
    def own(self) -> tuple[str, ...]:
        """Effects that these runs show of every chair, whatever is hidden."""
        return own(self.manoeuvres)


@dataclass
class Plan:
    """All cases of a benchmark with these seeds."""

    seeds: Sequence[int]
    cases: list[Case] = field(default_factory=list)

    def __post_init__(self) -> None:
        for seed in self.seeds:
            for noise in ("white", "ar1"):
                self._add("null", (), (0.0,), noise, seed)
                for effect in CATALOGUE:
                    self._add("effect", (effect,), SIZES, noise, seed, EFFECTS[effect].sees)
            for effect in CATALOGUE:
                self._add("left-out", (effect,), (3.0,), "white", seed, EFFECTS[effect].sees, (effect,))
            for effect in OUTSIDE:
                self._add("outside", (effect,), (1.0, 3.0), "white", seed)
            self._add("slipping", ("slipping_wheels",), (2.0, 3.0), "white", seed, EFFECTS["slipping_wheels"].sees)
            for pair in PAIRS:
                self._add("pair", pair, (3.0,), "white", seed)
            for effect, parameter in ALONE:
                self.cases += [Case("rider", (effect,), times, seed=seed, only=parameter) for times in SIZES]
            for hidden, manoeuvres in SWINGING:
                self.cases.append(Case("casters", hidden, 3.0, manoeuvres=manoeuvres, seed=seed, casters="slipping"))
            for effect in NEAR_TIES:
                self._add("near-tie", (effect,), (2.0,), "white", seed, "straight")

    def _add(
        self,
        kind: str,
        effects: tuple[str, ...],
        sizes: tuple[float, ...],
        noise: str,
        seed: int,
        manoeuvres: str = "everyday",
        left_out: tuple[str, ...] = (),
    ) -> None:
        self.cases += [Case(kind, effects, times, noise, manoeuvres, left_out, seed) for times in sizes]
