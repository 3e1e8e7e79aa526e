"""The table that says how well the loop diagnoses, from the trials."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from rich import box
from rich.table import Table

from ..independent.hidden import of_every_chair

Trial = dict[str, Any]
SHOWS = 1.01  # ratio of the whitened RMS on fitted runs, calibrated, to that where nothing is hidden
FLOOR = 0.995  # whitened RMS where nothing is hidden in white noise; coloured noise has one for each draw
QUIET = ("adequate", "cannot_see", "small")
OF_THE_CATALOGUE = ("null", "effect", "pair", "rider", "casters", "near-tie")  # kinds of trials of which all is in it
SAID = (0.0, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.95, 1.0)  # edges of the bins in which probabilities are tallied
ALIASES = (
    {"aerodynamic_drag", "rolling_resistance_speed"},
    {"push_force_gain", "wheel_radius_error"},
    {"scrub_torque", "scrub_torque_viscous"},
    {"accelerometer_tilt", "accelerometer_bias"},
    {"toe_misalignment", "rolling_resistance_asymmetry", "floor_cross_slope", "camber_misalignment", "cm_lateral_offset"},
)
"""Effects that are known to look alike unless the data separate them."""


def detectable(t: Trial, floors: Mapping[tuple[str, int], float]) -> bool:
    """Large enough to matter, and to lift the calibrated model's error off the floor of its noise and seed."""
    return t["times"] >= 1 and t["ladder"][1]["fit"] > SHOWS * floors.get((t["noise"], t["seed"]), FLOOR)


def floors(trials: Sequence[Trial]) -> dict[tuple[str, int], float]:
    """The calibrated model's error by noise and seed where nothing is hidden."""
    return {(t["noise"], t["seed"]): t["ladder"][1]["fit"] for t in trials if t["kind"] == "null"}


def named(t: Trial) -> set[str]:
    return set(t["found"]) | {e for group in t["ties"] for e in group}


def all_named(t: Trial) -> bool:
    """Is all that is hidden named, alone or in a tie?"""
    return set(t["effects"]) <= named(t)


def by_size(trials: Sequence[Trial]) -> list[tuple[str, list[Trial]]]:
    """The trials of each size and kind of noise, the largest and the white ones first, and what these are called."""
    kinds = sorted({(-t["times"], t["noise"] != "white", t["noise"]) for t in trials})
    return [
        (f"{-times:g} δ, {noise} noise", [t for t in trials if (t["times"], t["noise"]) == (-times, noise)])
        for times, _, noise in kinds
    ]


def share(trials: Sequence[Any], true: Callable[[Any], bool]) -> str:
    hits = sum(map(true, trials))
    return f"{hits} of {len(trials)} ({hits / len(trials):.0%})" if trials else "none run"


def order(t: Trial) -> list[str]:
    """The ranking without what every chair has in such runs, but for what is hidden."""
    return [e for e in t["order"] if e in t["effects"] or e not in t["own"]]


def first(t: Trial) -> bool:
    return order(t)[:1] == list(t["effects"])


def false_alarm(t: Trial) -> bool:
    """Is something said to be missing that no chair has in such runs?"""
    return t["verdict"] == "missing" and not named(t) <= set(t["own"])


def alike(t: Trial) -> bool:
    """Is one that looks like the hidden one named, if not the hidden one itself?"""
    hidden, said = set(t["effects"]), named(t)
    return hidden <= said or any(hidden & group and said & group for group in ALIASES)


def outside(t: Trial) -> bool:
    return t["verdict"] == "outside"


def slipped(t: Trial) -> bool:
    """Is it said that wheels slipped, and does no effect make up for that? Patches that hold creep, and rims have inertia."""
    return any("so it slipped" in note for note in t["notes"]) and named(t) <= {"longitudinal_slip", "wheel_inertia"}


def remains(t: Trial, floors: Mapping[tuple[str, int], float]) -> bool:
    """Is the error off the floor of its noise and seed in the end, with all in that was found?"""
    effects = [step["fit"] for step in t["ladder"] if not step["step"].startswith("+generic")]
    return effects[-1] > SHOWS * floors.get((t["noise"], t["seed"]), FLOOR)


def covered(t: Trial) -> list[bool]:
    out = []
    for effect, values in t["true"].items():
        for name, true in values.items():
            p = t["rows"].get(effect, {}).get("parameters", {}).get(name)
            if p and p["se"] is not None and effect in named(t):
                out.append(abs(p["estimate"] - true) < 1.96 * p["se"])
    return out


def covered_by(t: Trial, kind: str) -> list[bool]:
    """Does the profile-likelihood or the bootstrap interval of each hidden value that was found hold it?"""
    hidden = {f"effect.{e}.{n}": v for e, values in t["true"].items() for n, v in values.items()}
    return [low <= hidden[n] <= high for n, (low, high) in t["intervals"][kind].items() if n in hidden]


def probabilities(trials: Sequence[Trial]) -> list[tuple[float, bool]]:
    """Every probability that an effect is larger than δ, and whether it was hidden so. What was hidden at δ itself is neither
    larger nor smaller, and what every chair has is there whatever was hidden: neither counts."""
    of_a_size = (t for t in trials if t["kind"] in OF_THE_CATALOGUE and t["times"] != 1)
    return [
        (p, e in t["effects"] and t["times"] > 1)
        for t in of_a_size
        for e, p in t.get("probabilities", {}).items()
        if p is not None and e not in of_every_chair()
    ]


def calibration(told: Sequence[tuple[float, bool]]) -> list[tuple[str, str, str]]:
    """By bin of what was said, how many there are, what was said of them on the mean, and how many of them are so."""
    p, true = np.array([one for one, _ in told]), np.array([one for _, one in told], bool)
    within = np.digitize(p, SAID[1:-1])
    lines = []
    for i, (low, high) in enumerate(pairwise(SAID)):
        some = within == i
        if some.any():
            hits = f"{np.sum(true[some])} of {np.sum(some)} ({np.mean(true[some]):.1%})"
            lines.append((f"  larger than δ with {low:g} to {high:g}", hits, f"{np.mean(p[some]):.1%} said"))
    return lines


def gains(trials: Sequence[Trial]) -> list[float]:
    """(E0 − E1)/(E0 − 1) of the held-out squared error, where there was something to gain."""
    out = []
    for t in trials:
        before, after = t["ladder"][1]["heldout"] ** 2, t["ladder"][-1]["heldout"] ** 2
        if before > 1.1:
            out.append((before - after) / (before - 1))
    return out


def summary(trials: Sequence[Trial], floor: Mapping[tuple[str, int], float]) -> list[tuple[str, str, str]]:
    """(what, figure, target) by line; `floor` as of `floors`."""
    by = {kind: [t for t in trials if t["kind"] == kind] for kind in {t["kind"] for t in trials}}
    single = [t for t in by.get("effect", []) if detectable(t, floor)]
    nulls, small = by.get("null", []), [t for t in by.get("effect", []) if t["times"] < 1]
    still, moved = ([t for t in by.get("casters", []) if bool(t["effects"]) == there] for there in (False, True))
    missing = [t for t in single if t["verdict"] in ("missing", "tie")]
    inside = [c for t in missing for c in covered(t)]
    won = gains(missing)
    lines = [
        ("hidden effect first, of those the data can show", share(single, first), ""),
        ("  among the first three", share(single, lambda t: bool(set(order(t)[:3]) & set(t["effects"]))), ""),
        ("  named, alone or in a tie", share(single, all_named), ""),
        *((f"    {size}", share(some, all_named), "") for size, some in by_size(single)),
        ("  it or its known double named", share(single, alike), "99 %"),
        ("  verdict missing or tie", share(single, lambda t: t["verdict"] in ("missing", "tie")), ""),
        ("  wrongly outside", share(single, outside), "2 %"),
        ("false alarms where nothing is hidden", share(nulls, lambda t: t["verdict"] not in QUIET), "5 %"),
        ("of a quarter δ, something said to be missing", share(small, false_alarm), ""),
        ("outside found, truth left out of the catalogue", share(by.get("left-out", []), outside), "85 %"),
        ("  of those that leave more than noise", share([t for t in by.get("left-out", []) if remains(t, floor)], outside), ""),
        ("outside found, effect that no catalogue has", share(by.get("outside", []), outside), "85 %"),
        *((f"  {size}", share(some, outside), "") for size, some in by_size(by.get("outside", []))),
        ("wheels that slip: said so, and nothing named", share(by.get("slipping", []), slipped), ""),
        ("pairs: both found", share(by.get("pair", []), all_named), ""),
        ("pairs: at least one found", share(by.get("pair", []), lambda t: bool(set(t["effects"]) & named(t))), ""),
        ("a body that goes on after the push: named, be it as small", share(by.get("rider", []), all_named), ""),
        ("casters that swing by law: nothing said to be missing", share(still, lambda t: t["verdict"] in QUIET), ""),
        ("  hidden effect named", share(moved, all_named), ""),
        ("near-ties: hidden one in the tie", share(by.get("near-tie", []), all_named), "99 %"),
        ("held-out gain, median", f"{np.median(won):.2f} of {len(won)}" if won else "none run", ""),
        ("true value within the 95 % interval", f"{np.mean(inside):.0%} of {len(inside)}" if inside else "none run", "93–97 %"),
        *(
            ("  within the " + kind + " interval", share([c for t in missing for c in covered_by(t, kind)], bool), "93–97 %")
            for kind in ("profile", "bootstrap")
        ),
        ("probabilities: effects that are larger than δ, of those said to be", "", ""),
        *calibration(probabilities(trials)),
        ("processor seconds, median", f"{np.median([t['cpu'] for t in trials]):.1f}", ""),
    ]
    for method in next((t["baselines"] for t in trials if t["baselines"]), {}):
        hits = [t["baselines"][method] in t["effects"] for t in single if t["baselines"]]
        alarms = [t["baselines"][method] is not None for t in nulls if t["baselines"]]
        lines.append((f"baseline {method}: hidden effect named", share(hits, bool), ""))
        lines.append(("  names something where nothing is hidden", share(alarms, bool), ""))
    return lines


def as_table(trials: Sequence[Trial], floor: Mapping[tuple[str, int], float], title: str) -> Table:
    table = Table(box=box.SIMPLE, title=title, title_justify="left")
    for head, side in (("what", "left"), ("share", "right"), ("target", "right")):
        table.add_column(head, justify=side)
    for line in summary(trials, floor):
        table.add_row(*line)
    return table
