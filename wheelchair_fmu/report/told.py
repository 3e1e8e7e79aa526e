"""A diagnosis in sentences that cards and screens share: sizes, chances, rivals, and what to do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import erf, sqrt
from typing import Any

from ..inference.decision.among_forces import FORCES
from ..inference.policy import DEFAULT
from ..quantities import Quantity
from .advice import inspect, inspect_term
from .words import (
    AGAIN,
    STILL,
    capital,
    estimated,
    fall,
    judged_by,
    listed,
    needed,
    printed,
    probability_words,
    put_in,
    spoken,
    strained,
    title_of,
    to_measure,
)

NEAR = 0.97  # of the gain in likelihood of what was found: a rival that gains as much does about as well
NAMED = 3  # rivals in a sentence
ALIKE = 0.005  # whitened RMS error by which that of one model differs, told twice
IMPROVE = "wheelchair improve CAMPAIGN -o better.toml"
UNLIKELY = 0.01  # chance of a pattern by noise alone, above which it is not told
SURE = 1.96  # standard errors from nought, within which a size may as well be none


@dataclass(frozen=True)
class Told:
    """A diagnosis with what it takes to put it in words: titles of effects and records of their parameters."""

    diagnosis: Mapping[str, Any]
    titles: Mapping[str, str]
    records: Mapping[str, Quantity]
    rows: Mapping[str, Mapping[str, Any]] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "rows", {row["effect"]: row for row in self.diagnosis["ranking"]})

    @property
    def verdict(self) -> str:
        return str(self.diagnosis["verdict"])

    @property
    def found(self) -> list[str]:
        return [e for e in self.diagnosis["effects"] if e in self.rows]

    @property
    def key(self) -> str:
        """Which error is told: on runs held out, where there are any."""
        return judged_by(self.diagnosis)

    @property
    def runs(self) -> str:
        return "runs that were kept back" if self.key == "heldout" else "the runs it was fitted to"

    @property
    def fall(self) -> tuple[float, float]:
        """The error before anything was put in, and at the end."""
        return fall(self.diagnosis)

    @property
    def without_forces(self) -> float | None:
        """The error of the calibrated model before forces that nobody recorded were counted among the noise, if they were."""
        steps = {s["step"]: s for s in self.diagnosis["ladder"]}
        return float(steps["calibrated"][self.key]) if FORCES in steps else None

    @property
    def slight(self) -> bool:
        """Was all that was found left out of the model, as it is too small to matter?"""
        return self.verdict == "small" and not put_in(self.diagnosis)

    @property
    def falls(self) -> bool:
        """Does the error come down by what one would see?"""
        before, after = self.fall
        return before - after > STILL

    @property
    def together(self) -> list[list[str]]:
        """Of what was found, effects that were put in together, as one acts through the other."""
        groups = [[e for e in self.found if e in g["effects"]] for g in self.diagnosis.get("groups") or () if g["found"]]
        return [group for n, group in enumerate(groups) if len(group) > 1 and group not in groups[:n]]

    def partners(self, effect: str) -> list[str]:
        """Those that were put in together with an effect, which is among them; it alone, where there are none."""
        return next((group for group in self.together if effect in group), [effect])

    def error(self, effect: str) -> float | None:
        """The error on runs held out with an effect in; of all that was found, that of the last step, as everywhere. None where
        it is not known, or was found along other unrecorded forces than those of the last step."""
        last = self.diagnosis["ladder"][-1]["step"]
        whole = set(self.found) == set(self.partners(effect)) or (self.key == "heldout" and last == f"+{effect}")
        if effect in self.found and whole and not self.slight:
            return self.fall[1]
        return None if self.without_forces is not None else self.rows[effect]["heldout_after"]

    def step_error(self, effect: str) -> float | None:
        """The error after an effect was put in, as a step of the search."""
        steps = {s["step"]: s for s in self.diagnosis["ladder"]}
        return float(steps[f"+{effect}"][self.key]) if f"+{effect}" in steps else None

    def alone(self, effect: str) -> bool:
        """Was an effect put into the model that the search began with, and not beside others?"""
        before = self.rows[effect]["heldout_before"]
        return before is None or abs(before - self.fall[0]) < ALIKE

    @property
    def alone_errors(self) -> dict[str, float]:
        """The error with each effect that was put in alone, the likeliest first, where it is known."""
        alone = [e for e in self.rows if e in self.titles and self.alone(e)]
        return {e: error for e in alone if (error := self.error(e)) is not None}

    @property
    def firsts(self) -> dict[str, float]:
        """Of effects that were put in together, the first of each group, with the error that it alone leaves, where the others
        bring that down."""
        alone = {group[0]: self.step_error(group[0]) for group in self.together}
        return {e: error for e, error in alone.items() if error is not None and error - self.fall[1] > STILL}

    @property
    def tied(self) -> list[str]:
        """Those found that these runs cannot tell apart."""
        return [e for e in self.found if any(e in tie for tie in self.diagnosis["ties"])]

    @property
    def proposal(self) -> Mapping[str, Any] | None:
        return (self.diagnosis.get("leftover") or {}).get("proposal")

    @property
    def slightly_in(self) -> list[str]:
        """What the search put into the model beside what was found, and which is too small there to matter."""
        return self._helping("small")

    @property
    def unsurely_in(self) -> list[str]:
        """The same of what may be of any size."""
        return self._helping("cannot_see")

    def _helping(self, verdict: str) -> list[str]:
        steps = [s["step"].removeprefix("+") for s in self.diagnosis["ladder"] if s["step"].startswith("+")]
        return [e for e in steps if e in self.rows and e not in self.found and self.rows[e]["verdict"] == verdict]

    def title(self, effect: str) -> str:
        return title_of(effect, self.titles)

    def sizes(self, effect: str) -> list[tuple[str, Mapping[str, Any], Quantity]]:
        """(full name, what was estimated, its record) of each parameter."""
        return [
            (name, v, self.records[name])
            for short, v in self.rows[effect]["parameters"].items()
            if (name := f"effect.{effect}.{short}") in self.records
        ]

    def multiple(self, effect: str) -> float:
        """The size found over the smallest that would interest anyone; of several parameters the largest."""
        ratios = [abs(v["estimate"]) / v["smallest_interesting"] for _, v, _ in self.sizes(effect) if v["smallest_interesting"]]
        return max(ratios, default=0.0)


def exceeds(row: Mapping[str, Any]) -> float:
    """The probability that an effect is larger than the smallest size of interest; where the diagnosis has none, that of a
    normal error about the estimate. Of several parameters, that one of them is: the surest counts."""
    if row.get("probability") is not None:
        return float(row["probability"])

    def beyond(v: Mapping[str, Any]) -> float:
        if not v["se"]:
            return float(abs(v["estimate"]) > v["smallest_interesting"])
        above, below = (
            (abs(v["estimate"]) - v["smallest_interesting"]) / v["se"],
            (-abs(v["estimate"]) - v["smallest_interesting"]) / v["se"],
        )
        return _normal(above) + _normal(below)

    return max((beyond(v) for v in row["parameters"].values()), default=0.0)


def _normal(z: float) -> float:
    return 0.5 * (1 + erf(z / sqrt(2)))


def fall_words(t: Told) -> str:
    """How far the error came down, in units of the noise."""
    before, after = t.fall
    if abs(before - after) < STILL:
        unmoved = "" if t.verdict in ("adequate", "cannot_see") else ", before and after"  # nothing was put in
        where = f", and to put {it(t)} in hardly changes that" if t.slight else unmoved
        if t.found and not t.slight:
            told = [f"{error:.2f}" for error in t.fall]
            moves = f"is {told[1]}" if told[0] == told[1] else f"hardly changes, from {' to '.join(told)}"
            shows = "what was found shows at few moments, and there it is gone"
            return f"On {t.runs} the error {moves} times what noise alone gives: {shows}."
        return f"On {t.runs} the error is {after:.2f} times what noise alone gives{where}."
    verb = "falls" if after < before else "rises"
    return f"On {t.runs} the error {verb} from {before:.2f} to {after:.2f} times what noise alone gives{_beside_words(t)}."


def _beside_words(t: Told) -> str:
    """What else is in the model at the end: a fall is not the work of what was found alone."""
    some = ((t.slightly_in, "too little of it to matter"), (t.unsurely_in, "of a size that these runs leave open"))
    told = [f"with {listed([t.title(e) for e in which], 'and')} put in as well, {size}" for which, size in some if which]
    return "".join(f", {words}" for words in told) if t.found else ""


def left_words(t: Told) -> list[str]:
    """How sure it is that what no effect explains is not chance."""
    chance = (t.diagnosis.get("leftover") or {}).get("p")
    if chance is None or chance > UNLIKELY:
        return []
    rare = "a million" if chance < 1e-6 else "a thousand" if chance < 1e-3 else "a hundred"
    return [f"Of {rare} campaigns in which nothing was missing, fewer than one would leave a pattern as plain by chance."]


def nearest_words(t: Told) -> list[str]:
    """Which effect of the catalogue comes nearest to a term that none of them is."""
    known = t.alone_errors
    if not t.proposal or not known:
        return []
    best = min(known, key=lambda e: known[e])
    return [f"The nearest is {t.title(best)} with {known[best]:.2f}, where {helping(t)} leaves {t.fall[1]:.2f}."]


def helping(t: Told) -> str:
    """What was put in where nothing in the catalogue suffices."""
    record = t.records.get(f"effect.{t.proposal['term']}.q") if t.proposal else None
    if record is not None:
        return record.meaning
    return listed([t.title(e) for e in t.found], "and") if t.found else "what is known"


def forces_words(t: Told) -> list[str]:
    """What forces that nobody recorded have to do with the error."""
    without = t.without_forces
    if without is None:
        return []
    return [
        "Forces that nobody recorded, of an uneven floor or of a body that swings, count as noise here. "
        f"Without them the calibrated model is off by {without:.{2 if without < 10 else 0}f} times the noise of the sensors."
    ]


def it(t: Told) -> str:
    """What was found, in a word; of several that are small it is one."""
    return "it" if len(t.found) == 1 or t.verdict == "small" else "them"


def there_words(t: Told) -> list[str]:
    """How sure it is that something small is there at all, which is another question than how large it is."""
    if t.verdict != "small" or not t.found:
        return []
    by = "the fitted runs and those kept back together" if t.key == "heldout" else "the fitted runs"
    which = "it is" if len(t.found) == 1 else "one of them is"
    return [f"The chance that {which} there at all is above {DEFAULT.sure:.0%}, by {by}.".replace("%", " %")]


def larger_words(t: Told) -> list[str]:
    """What would be large instead of what is small."""
    return [
        f"If it is {t.title(other['effect'])} instead, which has odds of {other['odds_against']:.0f} to 1 against it, that is "
        f"{times_words(other['times'])} the size that would matter."
        for other in t.diagnosis.get("larger") or ()
        if other["effect"] in t.titles
    ]


def together_words(t: Told) -> list[str]:
    """Which of what was found act only together."""
    every = len(t.together) == 1 and len(t.together[0]) == len(t.found)
    names = ["these" if every else listed([t.title(e) for e in group], "and") for group in t.together]
    return [f"{capital(name)} were put in together, as one acts through the other." for name in names]


def near_rivals(t: Told) -> list[Mapping[str, Any]]:
    """Refitted effects that explain the runs nearly as well as what was found in their place, though they were not chosen."""
    if t.verdict not in ("missing", "small"):
        return []
    named = {*t.found, *(e for tie in t.diagnosis["ties"] for e in tie)}
    others = [r for r in t.diagnosis["ranking"] if r["effect"] not in named and r["values"] and r["effect"] in t.titles]
    return [r for r in others if any(_beside(t.rows[e], r) and r["lr"] > NEAR * t.rows[e]["lr"] for e in t.found)]


def _beside(row: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Were both put into the same model?"""
    return bool(row["heldout_before"] == other["heldout_before"])


def odds_words(t: Told) -> list[str]:
    """How likely each of those is that are tied, if one of them is what is missing."""
    said = []
    for odds in t.diagnosis.get("odds") or ():
        shares = listed([f"{probability_words(p)} for {t.title(e)}" for e, p in odds.items()], "and")
        said.append(
            f"If it is one of these, the chance is {shares}. To name one of them would take odds of more than a hundred to one."
        )
    return said or ["These runs do not tell them apart."]


def doubts(t: Told) -> list[str]:
    """Calibrated values that came out as nobody would measure them, beside which a size is less sure than it seems."""
    bent = {name: v for name, v in (t.diagnosis.get("calibration") or {}).items() if v.get("beyond") and name in t.records}
    return [
        f"One doubt: the {t.records[name].meaning} comes out at {spoken(v['value'], None, t.records[name].unit)}, where "
        f"{spoken(v['prior'], v['prior_sd'], t.records[name].unit)} was given."
        for name, v in bent.items()
    ]


def rival_words(t: Told) -> list[str]:
    """What else would explain the runs."""
    if not t.found:
        return []
    alike: dict[tuple[bool, bool], list[Mapping[str, Any]]] = {}
    for rival in near_rivals(t)[:NAMED]:
        alike.setdefault((_has_more(t, rival), _better(t, rival)), []).append(rival)
    if not alike:
        return ["No other effect in the catalogue explains these runs equally well."]
    return [_stands_back(t, rivals) for rivals in alike.values()]


def _stands_back(t: Told, rivals: Sequence[Mapping[str, Any]]) -> str:
    names = listed([t.title(r["effect"]) for r in rivals], "and")
    would, well = "would each do" if len(rivals) > 1 else "would do", "as" if _better(t, rivals[0]) else "nearly as"
    return f"{capital(names)} {would} {well} well, {why_not(t, rivals)}."


def _has_more(t: Told, rival: Mapping[str, Any]) -> bool:
    """Has a rival more sizes to choose than what was found?"""
    return len(rival["parameters"]) > max(len(t.rows[e]["parameters"]) for e in t.found)


def _better(t: Told, rival: Mapping[str, Any]) -> bool:
    """Does a rival explain the fitted runs better than what was found?"""
    return bool(rival["lr"] > max(t.rows[e]["lr"] for e in t.found))


def why_not(t: Told, rivals: Sequence[Mapping[str, Any]]) -> str:
    """Why near rivals stand back, which do so for one reason."""
    if _has_more(t, rivals[0]):
        own = max(len(t.rows[e]["parameters"]) for e in t.found)
        most = number(max(len(r["parameters"]) for r in rivals)).lower()
        return f"with {most} sizes to choose where this has {number(own).lower()}"
    if _better(t, rivals[0]):
        return "though the runs that were kept back speak less for " + ("them" if len(rivals) > 1 else "that")
    return f"though the runs speak a little less for {'them' if len(rivals) > 1 else 'that'}"


def size_lines(t: Told, effect: str) -> list[str]:
    sizes = t.sizes(effect)
    seen = [size for size in sizes if _seen(size[1])] or sizes
    lines = [f"{capital(r.meaning)}: {estimated(v, r.unit)}." for _, v, r in seen]
    larger = "The larger" if len(seen) == 2 else "The largest" if len(seen) > 2 else "That"
    return [*lines, f"{larger} is {multiple_words(t, effect)} the size that would matter{_interest(t, effect)}."]


def _seen(size: Mapping[str, Any]) -> bool:
    """Is a size surely not nought?"""
    if size.get("interval"):
        return not size["interval"][0] <= 0 <= size["interval"][1]
    return bool(not size["se"] or abs(size["estimate"]) > SURE * size["se"])


def sized(t: Told, effect: str) -> str:
    every = t.sizes(effect)
    seen = [size for size in every if _seen(size[1])] or every
    sizes = " and ".join(f"{_which(name, every)}{estimated(v, r.unit)}" for name, v, r in seen)
    if len(every) == 1 and every[0][1]["estimate"] < 0:  # of which the sign says something
        sizes = f"the {every[0][2].meaning} is {sizes}"
    sure = any(_seen(v) for _, v, _ in every)
    size = f"{multiple_words(t, effect)} the size that would matter" if sure else "a size that these runs leave open"
    return f"{capital(t.title(effect))}: {sizes}, {size}."


def _which(name: str, sizes: Sequence[tuple[str, Mapping[str, Any], Quantity]]) -> str:
    """Which of an effect's sizes one is, where it has several."""
    return f"{name.rpartition('.')[2].replace('_', ' ')} " if len(sizes) > 1 else ""


def _interest(t: Told, effect: str) -> str:
    sizes = [spoken(v["smallest_interesting"], None, r.unit) for _, v, r in t.sizes(effect) if v["smallest_interesting"]]
    return f", {sizes[0]}" if len(set(sizes)) == 1 else ""


def multiple_words(t: Told, effect: str) -> str:
    """The size found as a multiple of the smallest that would interest anyone."""
    return times_words(t.multiple(effect))


def times_words(multiple: float) -> str:
    return f"{times_text(multiple)} times"


def times_text(multiple: float) -> str:
    """The number alone."""
    if multiple < 0.95:
        return f"{multiple:.2g}"
    return f"{multiple:.1f}".removesuffix(".0") if multiple < 9.95 else f"{multiple:.0f}"


def number(n: int) -> str:
    return ("No", "One", "Two", "Three", "Four", "Five", "Six")[n] if n < 7 else str(n)


def _lower(words: str) -> str:
    return f"{words[:1].lower()}{words[1:]}"


def actions(t: Told) -> list[str]:
    """What to do, the first thing first: inspect, measure, add."""
    found, following, run = t.found, t.diagnosis.get("next_experiment"), t.diagnosis.get("to_fit")
    if run:
        return [f'Give {run} role = "fit" in campaign.toml, hold another run out, and diagnose again.', *_whatever_comes(t)]
    measure = [f"Measure {_what_next(t)}: {_why_next(t)}."] if following else []
    if t.verdict == "tie":
        return [*measure, *(inspect(e, t.title(e)) for e in found)] or ["Measure again where the causes differ."]
    if t.verdict == "missing":
        near = near_rivals(t)
        look = [inspect(e, t.title(e)) for e in found]
        also = (
            [f"To rule out {t.title(near[0]['effect'])}, {_lower(inspect(near[0]['effect'], t.title(near[0]['effect'])))}"]
            if near
            else []
        )
        return [*look, *also, *measure, f"Put {it(t)} into the model: {_command(found)}."]
    if t.verdict == "outside":
        orders = [f"{printed(capital(o['words']))}." for o in (t.diagnosis.get("disturbance") or {}).get("orders", ())]
        if strained(t.diagnosis, t.records) and not t.proposal:
            return [
                *measure,
                *orders,
                "If it comes out as before, the model lacks something: write the effect as a file of one expression.",
            ]
        return [*_after(t), *orders, *measure, _written(t)]
    if t.verdict == "small":
        look = [inspect(e, t.title(e)) for e in found]
        if needed(t.diagnosis):
            return [f"Put {it(t)} into the model, which leaves more than noise without: {_command(found[:1])}.", *look]
        return ["Use the model as it is.", *look]
    if t.verdict == "adequate":
        return [
            "Use the model as it is, for manoeuvres like these.",
            *measure,
            "For other manoeuvres, record some of them first and have them diagnosed too.",
        ]
    return [*measure, "Make livelier runs: tighter turns, other speeds, stronger pushes."]


def _whatever_comes(t: Told) -> list[str]:
    """What to do about what was found, where a run that was held out is to be fitted as well."""
    return [inspect(e, t.title(e)) for e in t.found] or ["Until then, trust the model for runs like the fitted ones only."]


def _command(found: Sequence[str]) -> str:
    """What puts effects into the model, as somebody types it."""
    return f"wheelchair add {found[0]} CAMPAIGN -o better.toml" if len(found) == 1 else IMPROVE


def _after(t: Told) -> list[str]:
    """What to look at for a term that helps most."""
    return [inspect_term(t.proposal["term"])] if t.proposal else ["Compare the missing force with what you know of the chair."]


def _written(t: Told) -> str:
    if not t.proposal:
        return "Write the effect that it suggests: a file of one expression is enough."
    return f"Put it into the model, as a file of one expression that is written for you: {IMPROVE}."


def next_words(t: Told) -> list[str]:
    """What to measure next and what that is for, in two sentences; none where nothing is to be measured."""
    return [f"Next, measure {_what_next(t)}.", f"{capital(_why_next(t))}."] if t.diagnosis.get("next_experiment") else []


def _what_next(t: Told) -> str:
    following = t.diagnosis["next_experiment"]
    times = "" if following["repeats"] == 1 else f", {following['repeats']} times"
    return f"{to_measure(following['manoeuvre'], t.records)}{times}"


def _why_next(t: Told) -> str:
    following = t.diagnosis["next_experiment"]
    effects = following["separates"]
    if following["manoeuvre"].endswith(AGAIN):
        return "with what was given, the model cannot follow these runs"
    if not effects:
        return str(following["why"]) or "it would tell more"
    if t.verdict in ("adequate", "cannot_see"):
        more = "effects" if len(effects) > 1 else "effect"
        return f"it would show {number(len(effects)).lower()} {more} that these runs could not"
    if set(effects) <= set(t.diagnosis["effects"]):
        return "it would tell them apart" if set(effects) == set(t.found) else "it would tell the causes apart"
    return (
        f"it would tell {listed([t.title(e) for e in effects], 'and')} apart"
        if 1 < len(effects) <= NAMED
        else "it would tell more"
    )
