"""The three cards above the fold: what is missing, how sure that is, what to do."""

from __future__ import annotations

from typing import Any

from ..inference.policy import DEFAULT
from ..inference.search.ties import grouped
from ..model.generic import told_at
from ..quantities import Parameter
from .told import (
    Told,
    actions,
    capital,
    doubts,
    exceeds,
    fall_words,
    forces_words,
    it,
    larger_words,
    left_words,
    nearest_words,
    number,
    odds_words,
    rival_words,
    size_lines,
    sized,
    there_words,
    times_text,
    times_words,
    together_words,
)
from .words import listed, probability_words, probably, spoken, strained

ORDER = ("first", "second", "third", "fourth")
MATTERS = {"mark": 1.0, "words": "would matter"}
EXPLAINED = 1.05  # whitened RMS error that is 1.0 to the digit that one would say


def cards(t: Told) -> list[dict[str, Any]]:
    """What, how sure, what to do: [{"head", "lead", "lines"}], some with a "gauge" of bars:
    {"bars": [(label, length)], "mark": a length, "words": what it is}."""
    lead, lines = _what(t)
    sure, reasons = _how_sure(t)
    first, *more = [f"{part}." for line in actions(t)[:1] for part in line.rstrip(".").split(". ")] + actions(t)[1:]
    return [
        {"head": "What", "lead": lead, "lines": lines, **_size_gauge(t)},
        {"head": "How sure", "lead": sure, "lines": reasons, **_fall_gauge(t)},
        {"head": "What to do", "lead": first, "lines": more},
    ]


def _size_gauge(t: Told) -> dict[str, Any]:
    """How large each of what was found is; of several, in the order of the sentences."""
    if t.verdict not in ("missing", "small", "tie") or not 0 < len(t.found) <= len(ORDER):
        return {}
    groups = grouped(t.found, t.diagnosis["ties"]) if t.verdict == "tie" else [(e,) for e in t.found]
    each = [e for group in sorted(groups, key=lambda group: len(group) > 1) for e in group]
    labels = ORDER if len(each) > 1 else ("size",)
    bars = [(f"{label} {times_text(t.multiple(e))}×", t.multiple(e)) for label, e in zip(labels, each, strict=False)]
    return {"gauge": {"bars": bars, **MATTERS}}


def _fall_gauge(t: Told) -> dict[str, Any]:
    before, after = t.fall
    bars = [(f"{when} {error:.2f}", error) for when, error in (("before", before), ("after", after))]
    return {"gauge": {"bars": bars, "mark": 1.0, "words": "noise alone"}} if t.falls else {}


def _what(t: Told) -> tuple[str, list[str]]:
    if t.verdict == "tie":
        sure = [e for e in t.found if e not in t.tied]
        groups = [
            [sized(t, e) for e in group] for group in grouped(t.diagnosis["effects"], t.diagnosis["ties"]) if len(group) > 1
        ]
        lead = "One of two causes" if len(groups) == 1 and len(groups[0]) == 2 else "One of several causes"
        if sure:
            lead = f"{number(len(sure))} {'effect' if len(sure) == 1 else 'effects'}, and {lead[0].lower()}{lead[1:]}"
        return lead, [*(sized(t, e) for e in sure), *(line for group in groups for line in group)]
    if t.slight and len(t.found) > 1:
        return f"One of {number(len(t.found)).lower()} causes", [sized(t, e) for e in t.found]
    if t.verdict in ("missing", "small") and t.found:
        if len(t.found) == 1:
            return capital(probably(t.diagnosis, t.found[0]) + t.title(t.found[0])), size_lines(t, t.found[0])
        return f"{number(len(t.found))} effects", [*(sized(t, e) for e in t.found), *together_words(t)]
    if t.verdict == "outside":
        return _outside(t)
    if t.verdict == "adequate":
        return "Nothing is missing", [_explained(t)]
    hide = "many effects could be large enough to matter and not show in"
    if t.fall[1] < EXPLAINED:
        return "Nothing was found", [f"The model explains these runs, but {hide} them."]
    return "Nothing was found", [_explained(t), f"Beside that, {hide} these runs."]


def _explained(t: Told) -> str:
    left = t.fall[1]
    if left < EXPLAINED:
        return "The model explains these runs to within the noise of the sensors."
    return f"What the model leaves, {left:.2f} times the noise of the sensors, no effect in the catalogue explains."


def _outside(t: Told) -> tuple[str, list[str]]:
    found = t.proposal
    if found:
        record = t.records[f"effect.{found['term']}.q"]
        size = spoken(found["estimate"], found["se"], record.unit)
        delta = record.smallest_interesting if isinstance(record, Parameter) else None
        times = f", {times_words(abs(found['estimate']) / delta)} the size that would matter" if delta else ""
        return "A force or torque that no effect in the catalogue describes", [
            f"What helps most is {record.meaning}: {size}{told_at(found['term'])}{times}."
        ]
    bent = strained(t.diagnosis, t.records)
    helped = [sized(t, e) for e in t.found]
    come = "come" if len(bent) > 1 else "comes"
    only = [f"The error comes down only where {listed(bent, 'and')} {come} out as nobody would measure it."] if bent else []
    if bent and not helped:
        return "A given value that is wrong, or an effect that nobody knows", only
    return "Something that no effect in the catalogue describes", [*helped, *only]


def _how_sure(t: Told) -> tuple[str, list[str]]:
    fall, rivals, forces = fall_words(t), rival_words(t), forces_words(t)
    if t.verdict == "tie":
        left = {e: error for e in t.tied if (error := t.error(e))}
        errors = {f"{error:.2f}" for error in left.values()}
        if len(left) == len(t.tied) > 1 and len(errors) == 1:
            each = "either" if len(left) == 2 else "any of them"
            if not t.falls:
                nothing = f"On {t.runs} nothing is gained: the error is {t.fall[0]:.2f} before, and {errors.pop()} with {each}."
                together = [f"{nothing} What they explain shows in the runs that were fitted."]
            else:
                together = [f"With {each}, the error on {t.runs} comes to {errors.pop()} times what noise alone gives."]
        elif left:
            together = [f"With {t.title(e)}, the error on {t.runs} comes to {error:.2f}." for e, error in left.items()]
        else:
            together = [fall]
        among = f"the other {number(len(t.tied)).lower()}" if set(t.found) - set(t.tied) else "them"
        return f"One of {among} is there; which one, these runs do not say", [*together, *odds_words(t), *doubts(t), *forces]
    if t.verdict in ("missing", "small") and t.found:
        large, several = [exceeds(t.rows[e]) for e in t.found], "both are" if len(t.found) == 2 else "all are"
        what = several if it(t) == "them" else "it is"
        sure, size = (_small(t, max(large)), "too small") if t.verdict == "small" else (min(large), "large enough")
        return f"A chance of {probability_words(sure)} that {what} {size} to matter", [
            *there_words(t),
            *larger_words(t),
            fall,
            *rivals,
            *doubts(t),
            *forces,
        ]
    if t.verdict == "outside":
        return "Sure that something is there, less so what", [*left_words(t), fall, *nearest_words(t), *rivals, *forces]
    lead, explained = _would_be_seen(t)
    return lead, [explained, fall, *forces]


def _small(t: Told, large: float) -> float:
    """The chance that what is there is small: that what was found is not large, and that it is nothing else, which would be."""
    return (1 - large) / (1 + sum(1 / other["odds_against"] for other in t.diagnosis.get("larger") or ()))


def _would_be_seen(t: Told) -> tuple[str, str]:
    """What the verdict rests on where nothing was found, and how it is counted. A diagnosis of an older version does not say
    it: then effects are counted that these runs would show."""
    share, adequate = t.diagnosis.get("seen"), t.verdict == "adequate"
    counted = (
        "An effect counts as seen if, at the smallest size that would matter, it would show in at least "
        f"{DEFAULT.power:.0%} of such campaigns."
    ).replace("%", " %")
    if share is None:
        many = f"{sum(r['power'] >= DEFAULT.power for r in t.rows.values())} of {len(t.rows)} effects"
        return f"{many} would have been seen" if adequate else f"Only {many} could have been seen", counted
    causes = f"{share:.0%} of all causes".replace("%", " %")
    lead = f"{causes} would have been seen" if adequate else f"Only {causes} could have been seen"
    apart = (
        "Effects of one cause count as one, and one counts as seen that a mass or a size given a little wrong could imitate."
    )
    return lead, f"{counted} {apart}"
