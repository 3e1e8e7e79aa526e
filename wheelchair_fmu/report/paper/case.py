"""What a supplement is about: a campaign, the chair it was compared with, and the diagnosis of both."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import nan
from typing import Any

from ...campaign import Campaign, Run
from ...campaign.windows import PIECE
from ...errors import Failure
from ...inference.decision.among_forces import FORCES
from ...model.generic import library
from ...model.variant import Variant

NORMAL = 1.96  # standard errors either way, where no profile of the likelihood was taken
PROFILE, BY_ERRORS = "profile likelihood", "standard errors"
NEEDED = ("final", "fingerprint", "made_by")  # keys of a diagnosis that earlier versions did not write
GENERIC = "generic_"
EFFECT, OFFSET = "effect.", "offset."


@dataclass(frozen=True)
class Case:
    """`told` is the diagnosis as `diagnose --json` writes it; `chair` has in its catalogue every effect that `told` has in its
    last model."""

    campaign: Campaign
    chair: Variant
    told: Mapping[str, Any]
    fixed: Sequence[str] = ()

    @property
    def final(self) -> Mapping[str, Any]:
        return dict(self.told["final"])

    @property
    def parameters(self) -> list[Mapping[str, Any]]:
        """A record for each value of the last model."""
        return list(self.final["parameters"])

    @property
    def ladder(self) -> list[Mapping[str, Any]]:
        return list(self.told["ladder"])

    @property
    def begins(self) -> Mapping[str, Any]:
        """The step of the staircase from which the search began: calibrated, with what the chair had from the start."""
        return next((s for s in self.ladder if s["step"] == self.told["begins"]), self.ladder[0])

    @property
    def top(self) -> Mapping[str, Any]:
        """The last step."""
        return self.ladder[-1]

    @property
    def grew(self) -> bool:
        """Has the last model more in it than the calibrated one?"""
        return bool(self.top["step"] != self.begins["step"])

    @property
    def held(self) -> bool:
        """Were runs held out?"""
        return self.top["heldout"] is not None

    @property
    def key(self) -> str:
        """Which error is told: on runs held out, where there are any."""
        return "heldout" if self.held else "fit"

    @property
    def with_forces(self) -> bool:
        """Were forces that nobody recorded among the noise in the end?"""
        return any(s["step"] == FORCES for s in self.ladder)

    @property
    def pushed(self) -> bool:
        """Was any push recorded?"""
        return any(v.any() for run in self.campaign.runs for name, v in run.inputs.items() if name.startswith("push."))

    def pieces(self, run: Run) -> list[Mapping[str, Any]]:
        """What of a run the last model was compared with: all of it, a part, or several where the chair stood in between."""
        used, runs = self.final["runs"], {r.name for r in self.campaign.runs}
        parts = [name for name in used if name.startswith(f"{run.name}{PIECE}") and name not in runs]
        return [used[name] for name in (run.name, *parts) if name in used]

    def used(self, run: Run) -> list[tuple[float, float]]:
        """From when to when (s) that is."""
        return sorted((piece["from"], piece["to"]) for piece in self.pieces(run))

    @cached_property
    def effects(self) -> tuple[str, ...]:
        """Ids of the effects in the last model, the proposed term among them."""
        return tuple(dict.fromkeys(p["name"].split(".")[1] for p in self.parameters if p["name"].startswith(EFFECT)))

    @cached_property
    def already(self) -> frozenset[str]:
        """Those of them that the chair had before the search."""
        return frozenset(self.chair.effects).intersection(self.effects)

    @cached_property
    def titles(self) -> dict[str, str]:
        return {e.id: e.title for e in self.chair.catalogue.values()}

    def kind(self, name: str) -> str:
        """What a parameter of the last model is."""
        if name.startswith(OFFSET):
            return "sensor offset"
        if not name.startswith(EFFECT):
            return "calibrated value"
        effect = name.split(".")[1]
        if effect.startswith(GENERIC):
            return "proposed term"
        if effect in self.already:
            return "effect from the start"
        return "effect found" if effect in self.told["effects"] else "effect that helps"


def interval(parameter: Mapping[str, Any]) -> tuple[float, float, str]:
    """The ends of a 95 % interval (SI) and how it was found; NaN where there is none, as of a value that a bound stopped."""
    if parameter["interval"]:
        lower, upper = parameter["interval"]
        return float(lower), float(upper), PROFILE if parameter.get("interval_by", "profile") == "profile" else BY_ERRORS
    if parameter["se"] is None or parameter["at_bound"]:
        return nan, nan, ""
    half = NORMAL * parameter["se"]
    return parameter["estimate"] - half, parameter["estimate"] + half, BY_ERRORS


def checked(campaign: Campaign, chair: Variant, told: Mapping[str, Any], fixed: Sequence[str], place: str) -> Case:
    """The case, if the diagnosis is of this campaign and this chair. `place` is what messages call the diagnosis.

    Raises Failure for a diagnosis of an earlier version, of other data, or of another chair.
    """
    if absent := [key for key in NEEDED if key not in told]:
        raise Failure(f"{place}: has no {absent[0]!r}, as earlier versions wrote it; diagnose the campaign again")
    if told["fingerprint"] != campaign.fingerprint:
        raise Failure(f"{place}: its data are not those of {campaign.name!r} as they are now; diagnose the campaign again")
    case = Case(campaign, chair, told, fixed)
    if strange := [e for e in case.effects if e not in chair.catalogue and e not in library()]:
        raise Failure(f"{place}: has the effect {strange[0]!r}, which is not in the catalogue; give its folder by --effects")
    if set(case.final["fixed"]) != set(fixed):
        named = ", ".join(sorted(case.final["fixed"])) or "nothing"
        raise Failure(f"{place}: was made with {named} set by --set; give the same values")
    return case
