"""The five screens of the story: from the error to what to do next.

Sentences are complete and plain; code names stand in commands alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..inference.policy import DEFAULT
from .told import (
    SURE,
    Told,
    actions,
    capital,
    fall_words,
    forces_words,
    helping,
    it,
    multiple_words,
    near_rivals,
    nearest_words,
    number,
    rival_words,
    sized,
    together_words,
    why_not,
)
from .words import STILL, listed, printed, strained

CHOICES = 3  # guesses that are offered beside what was found
TRIED = 6  # effects in the picture of the rivals
PARTING = "Look at where the two curves part."
BELOW = "In some runs and channels it misses more: below the curves, the mean error over half a second shows where."
LITTLE = "Over all readings the error may hardly rise; below the curves, the mean error over half a second shows where."
ANY = "Any effect can be tried below, at any size."
LIVE = (PARTING, BELOW, LITTLE, ANY)  # what is said of pictures that only a model that runs can draw
TINY = 1e-6  # of a signature that calibrated values imitate wholly


def screens(t: Told) -> list[dict[str, Any]]:
    """Five screens: [{"kind", "title", "lines"}], and of `guess` the "choices", of `rivals` the "bars"."""
    before, after = t.fall
    return [
        {"kind": "errs", **_errs(t, before)},
        {"kind": "guess", **_guess(t)},
        {"kind": "put", **_put(t, before, after)},
        {"kind": "rivals", **_rivals(t)},
        {"kind": "next", "title": "Do this next", "lines": actions(t)},
    ]


def _errs(t: Told, before: float) -> dict[str, Any]:
    calm = before < 1.1 and t.verdict not in ("tie", "missing", "outside")
    if before < 1.1 and not calm:
        return {
            "title": "Here the model errs, a little",
            "lines": [
                "Over all that was recorded, the calibrated model is off by hardly more than the noise of the sensors.",
                BELOW,
                *forces_words(t),
            ],
        }
    how = f"{before:.2f} times" if before < 10 else f"{before:.0f} times"
    lines = [f"On {t.runs}, the calibrated model is off by {how} what the noise of the sensors gives."]
    if calm:
        return {
            "title": "Where the model errs most, the error is next to nothing",
            "lines": [*lines, f"What remains {'is hardly more than' if t.found else 'looks like'} noise.", *forces_words(t)],
        }
    return {"title": "Here the model errs", "lines": [*lines, PARTING, *forces_words(t)]}


def _guess(t: Told) -> dict[str, Any]:
    if t.verdict in ("adequate", "cannot_see"):
        lines = ["Suppose one of these were missing. Which would these runs show?"]
    elif t.slight:
        lines = ["Something is there that is too small to matter. Which of these would you say it is?"]
    elif t.verdict == "outside" and not t.found:
        lines = ["Which of these explains it?"]
    else:
        lines = ["Which of these would you say is behind it?"]
    return {"title": "Guess what it is", "lines": lines, "choices": choices(t)}


def choices(t: Told) -> list[dict[str, Any]]:
    """Guesses, the right ones among them, in the order of their titles so that their place tells nothing."""
    others = [r["effect"] for r in t.diagnosis["ranking"] if r["effect"] not in t.found and r["effect"] in t.titles]
    right = set(t.found)
    offered = [*t.found[: CHOICES + 1], *others[:CHOICES]]
    if t.verdict in ("adequate", "cannot_see"):  # what these runs would show, and what not
        right = {e for e in others if _absent(t.rows[e])}
        offered = [*[e for e in others if e in right][:2], *[e for e in others if e not in right][:2]]
    guesses = (
        {
            "effect": e,
            "title": t.title(e),
            "right": e in right,
            "answer": _answer(t, e),
            "beside": e in others and not t.alone(e),
        }
        for e in offered
    )
    return sorted(guesses, key=lambda guess: str(guess["title"]))


def _answer(t: Told, effect: str) -> str:
    row = t.rows[effect]
    if t.slight and effect in t.found:
        return f"Yes, at {multiple_words(t, effect)} the size that would matter."
    if t.verdict in ("adequate", "cannot_see"):
        if _absent(row):
            return "These runs would have shown it at the smallest size that matters: it is not there, or smaller than that."
        if row["power"] >= DEFAULT.power:
            return "At the smallest size that matters it would have shown; but how large it is, these runs leave open."
        chance = printed(f"{row['power']:.0%}")
        return f"At the smallest size that matters, these runs would show it with a chance of {chance} only."
    if effect in t.slightly_in:
        return (
            f"It is in the model, at {multiple_words(t, effect)} the size that would matter: too little to be what is missing."
        )
    if effect in t.unsurely_in:
        return f"It is in the model, at {multiple_words(t, effect)} the size that would matter, which these runs leave open."
    comes = t.error(effect)
    error = "" if comes is None else f" {_moves(t, comes)}{_with(t, effect)}."
    if effect in t.found:
        tied = t.verdict == "tie" and effect in t.tied
        if t.verdict == "outside":
            return f"It helps, but does not suffice.{error}"
        return ("It may be: this or its rival." if tied else "Yes.") + error
    if any(effect == r["effect"] for r in near_rivals(t)):
        return f"Nearly: it would foretell the runs about as well, {why_not(t, [row])}.{error}"
    if comes is None and t.verdict == "outside" and row["values"]:
        return "No: put in and fitted, it does not suffice."
    if comes is None and t.without_forces is not None and row["values"]:
        return "No: with forces that nobody recorded among the noise, the runs speak less for it."
    if comes is None:
        return "No: it promised too little to be put in."
    if not t.alone(effect):
        return _beside(t, row, comes)
    if not t.falls:
        return "No: over all moments the runs speak less for it."
    if row["heldout_before"] is not None and row["heldout_before"] - comes < STILL:
        return f"No: the error on {t.runs} stays at {t.fall[0]:.2f}."
    if comes < t.fall[1] + STILL:
        return f"Close, but over all moments these runs are explained less well by it.{error}"
    return f"It helps, but not enough.{error}"


def _absent(row: Mapping[str, Any]) -> bool:
    """Would these runs have shown an effect, and is each of its sizes, as far as it is known, surely smaller than what would
    matter?"""
    if row["power"] < DEFAULT.power:
        return False
    known = [v for v in row["parameters"].values() if v["se"] and v["smallest_interesting"]]
    return all(abs(v["estimate"]) + SURE * v["se"] < v["smallest_interesting"] for v in known)


def _moves(t: Told, comes: float) -> str:
    """What an effect does to the error."""
    before = t.fall[0]
    return f"The error goes from {before:.2f} to {comes:.2f}" if before - comes > STILL else f"The error comes to {comes:.2f}"


def _with(t: Told, effect: str) -> str:
    """Of an error with an effect in, what else was put in at once."""
    partners = [e for e in t.partners(effect) if e != effect]
    return f" together with {listed([t.title(e) for e in partners], 'and')}" if partners else ""


def _beside(t: Told, row: Mapping[str, Any], comes: float) -> str:
    """What an effect does that was put in beside others."""
    others = "what was found" if t.found else "the likeliest other effect"
    if row["heldout_before"] - comes < STILL:
        return f"No: beside {others} it changes nothing, and the error stays as it is."
    return f"Beside {others} it helps, but not enough: the error comes to {comes:.2f}."


def _put(t: Told, before: float, after: float) -> dict[str, Any]:
    whose = t.runs
    if t.verdict in ("adequate", "cannot_see"):
        return _tried(t)
    if t.verdict == "outside" and not t.found and not t.proposal:
        return _likeliest(t)
    if t.verdict == "outside":
        verb = "falls" if t.falls else "goes"
        return {
            "title": "Put in what helps most",
            "lines": [f"With {helping(t)}, the error on {whose} {verb} from {before:.2f} to {after:.2f}."],
        }
    if t.verdict == "tie":
        known = [e for e in t.tied if t.error(e) is not None]
        each = (
            ("either" if len(t.tied) == 2 else "any" if set(t.found) - set(t.tied) else "any of them")
            if known in ([], t.tied)
            else listed([t.title(e) for e in known], "or")
        )
        if not t.falls:
            return {
                "title": "Put one in: these runs hardly change",
                "lines": [
                    "The effect shows in the runs it was fitted to, a little at a time, not yet in those that were kept back.",
                    f"There the error is {after:.2f} times the noise with {each}.",
                ],
            }
        sure = [t.title(e) for e in t.found if e not in t.tied]
        rest = f"{each} of the other {number(len(t.tied)).lower()}" if known in ([], t.tied) else each
        beside = f"With {listed(sure, 'and')} in the model, and {rest}" if sure else ""
        return {
            "title": "Put them in and watch the error fall" if sure else "Put one in and watch the error fall",
            "lines": [f"{beside or f'With {each}'}, the error on {whose} falls to {_comes(t)}.", *_as_well(t)],
        }
    if t.slight:
        return {"title": f"Put {it(t)} in: hardly anything changes", "lines": [fall_words(t)]}
    watch = "and watch the error fall" if t.falls else "and look where the two curves part"
    return {
        "title": f"Put {it(t)} in {watch}",
        "lines": [fall_words(t), *together_words(t), *_by_itself(t), "1.00 is what the noise of the sensors leaves."],
    }


def _by_itself(t: Told) -> list[str]:
    """Of effects that were put in together, what the first does alone."""
    return [f"By itself, {t.title(e)} brings it to {error:.2f}." for e, error in t.firsts.items()]


def _tried(t: Told) -> dict[str, Any]:
    """Where nothing was found, an effect to put in at the smallest size that would matter: one that these runs would plainly
    have shown, or one that they could hardly show."""
    adequate = t.verdict == "adequate"
    known = [r for r in t.diagnosis["ranking"] if r["effect"] in t.titles and (r["power"] >= DEFAULT.power) == adequate]
    known = [r for r in known if any(v["se"] for v in r["parameters"].values())] or known  # of others nothing is known
    if not known:
        return {"title": "Put one in", "lines": [ANY]}
    row = max(known, key=_plain) if adequate else min(known, key=_plain_unfitted)
    what = f"{capital(t.title(row['effect']))}, at the smallest size that would matter:"
    if adequate:
        title, lines = (
            "Put one in, and look where it shows",
            [f"{what} the model parts from what was measured, and these runs would have shown that.", LITTLE],
        )
    else:
        title, lines = (
            "Put one in: these runs hardly tell",
            [f"{what} the error hardly changes, and these runs could not have shown that."],
        )
    return {"title": title, "lines": lines, "effect": row["effect"]}


def _likeliest(t: Told) -> dict[str, Any]:
    """Where nothing was put in as nothing suffices: the likeliest effect of those that were fitted, or any."""
    fitted = next((r["effect"] for r in t.diagnosis["ranking"] if r["effect"] in t.titles and r["values"]), None)
    if fitted is None:
        return {"title": "Put one in: none suffices", "lines": [ANY]}
    lines = [f"The likeliest is {t.title(fitted)}, here at the size that fits best: it does not explain what is left."]
    return {"title": "Put in the likeliest: it does not suffice", "lines": lines, "effect": fitted}


def _as_well(t: Told) -> list[str]:
    """What the last step has in it beside what was found."""
    sizes = ((t.slightly_in, "at a size too small to matter"), (t.unsurely_in, "at a size that these runs leave open"))
    return [f"In the model as well, {size}: {listed([t.title(e) for e in names], 'and')}." for names, size in sizes if names]


def _plain(row: Mapping[str, Any]) -> float:
    """How plainly runs show an effect of the smallest size that would matter, in standard errors."""
    return max(((v["smallest_interesting"] or 0.0) / v["se"] for v in row["parameters"].values() if v["se"]), default=0.0)


def _plain_unfitted(row: Mapping[str, Any]) -> float:
    """The same where calibrated values are not fitted again beside it, which would imitate a part of it."""
    return _plain(row) / max(1 - row["hidden_in_fit"], TINY) ** 0.5


def _comes(t: Told) -> str:
    """What the error comes to with each of a tie."""
    errors = [error for e in t.tied if (error := t.error(e)) is not None] or [t.fall[1]]
    least, most = f"{min(errors):.2f}", f"{max(errors):.2f}"
    return least if least == most else f"between {least} and {most}"


def _rivals(t: Told) -> dict[str, Any]:
    if t.verdict == "tie":
        title, lines = (
            "Why these runs do not say which",
            ["Each would do at a size of its own.", *(sized(t, e) for e in t.tied)],
        )
    elif t.found and t.verdict != "outside":
        title, lines = "Why not the rivals", [*rival_words(t), *_farther(t), *_beside_it(t), *_unmoved(t)]
    elif t.verdict == "outside":
        title, lines = (
            "Why nothing in the catalogue",
            [
                "Each of the likeliest was put in and its size fitted; this is the error that each leaves."
                if len(bars(t)) > 1
                else "Every effect of the catalogue was held against what the model leaves over; these are their sizes.",
                *nearest_words(t),
                *_bent(t),
            ],
        )
    elif t.verdict == "cannot_see":
        title, lines = "What these runs could not show", _unseen(t)
    elif len(bars(t)) > 1:
        title, lines = (
            "Why nothing else",
            ["This is the error that each leaves when it is put in: none brings it down by more than chance would."],
        )
    else:
        title, lines = (
            "Why nothing else",
            ["Every effect of the catalogue was held against what the model leaves over.", _nothing(t)],
        )
    return {"title": title, "lines": lines, "bars": [] if t.verdict == "cannot_see" else bars(t)}


def _unseen(t: Told) -> list[str]:
    """Effects that could be large and hide, the least visible first, with the chance that these runs would have shown each."""
    hidden = sorted(
        (r for r in t.rows.values() if r["power"] < DEFAULT.power and r["effect"] in t.titles), key=lambda r: r["power"]
    )
    named = [printed(f"{t.title(r['effect'])} ({r['power']:.0%})") for r in hidden[:TRIED]]
    more = [f"{number(len(hidden) - TRIED).lower()} more"] if len(hidden) > TRIED else []
    return [
        "At the smallest size that matters, each of these could be there and not show. In brackets stands the chance that "
        "these runs would have shown it.",
        f"{capital(listed([*named, *more], 'and'))}.",
    ]


def _nothing(t: Told) -> str:
    """What was found of effects of which none was."""
    if t.verdict == "adequate":
        return "Not one is there at a size that would matter, as far as these runs could show it."
    return "Not one shows in it, but many of them could hide."


def _farther(t: Told) -> list[str]:
    """What rivals leave that do not come near."""
    known = {*t.found, *(r["effect"] for r in near_rivals(t))}
    tried = [(e, error) for e, error in t.alone_errors.items() if e not in known]
    worse = [(e, error) for e, error in tried[:CHOICES] if error > t.fall[1] + STILL]
    if t.slight or not worse:
        return []
    place = "In its place" if it(t) == "it" else "In their place"
    return [f"{place}, {listed([f'{t.title(e)} leaves {error:.2f}' for e, error in worse], 'and')}."]


def _beside_it(t: Told) -> list[str]:
    """What was put in as well, and brings nothing more."""
    tried = [
        r
        for r in t.diagnosis["ranking"]
        if r["effect"] in t.titles and r["effect"] not in (*t.found, *t.slightly_in, *t.unsurely_in) and r["values"]
    ]
    idle = [r["effect"] for r in tried if not t.alone(r["effect"]) and t.error(r["effect"]) is not None]
    if t.slight or not idle or any(t.rows[e]["heldout_before"] - t.rows[e]["heldout_after"] > STILL for e in idle):
        return []
    more = [f"{number(len(idle) - CHOICES).lower()} more"] if len(idle) > CHOICES else []
    which = listed([*(t.title(e) for e in idle[:CHOICES]), *more], "and")
    any_of = "any of these: " if len(idle) > 1 else ""
    return [f"Put in beside {it(t)}, the error comes down no further with {any_of}{which}."]


def _bent(t: Told) -> list[str]:
    """Why what helps is not the answer all the same."""
    bent = strained(t.diagnosis, t.records)
    if not t.found or not bent:
        return []
    come = "come" if len(bent) > 1 else "comes"
    return [f"With what helps most in the model, {listed(bent, 'and')} {come} out as nobody would measure it."]


def _unmoved(t: Told) -> list[str]:
    """Where errors over all channels tell little, what the choice rests on."""
    if t.falls or t.slight or near_rivals(t):
        return []
    return ["Over all channels the error is about the same before and after; moment by moment the runs tell them apart."]


def bars(t: Told) -> list[dict[str, Any]]:
    """The error on runs held out with each effect that was refitted, and without any: [{"title", "error", "found"}]. Effects
    that were put in together are one; what was put in beside others is none of these, as its error is theirs as well."""
    known = [r["effect"] for r in t.diagnosis["ranking"] if r["effect"] in t.titles and t.error(r["effect"]) is not None]
    tried = [e for e in known if e in t.found or t.alone(e)]
    groups = list(dict.fromkeys(tuple(t.partners(e)) for e in tried))[:TRIED]
    each: list[dict[str, Any]] = [
        {"title": listed([t.title(e) for e in g], "with"), "error": t.error(g[-1]), "found": g[0] in t.found} for g in groups
    ]
    before, after = t.fall
    each = [*({"title": t.title(e), "error": error, "found": True} for e, error in t.firsts.items()), *each]
    several = len(t.found) > 1 and t.verdict != "tie" and not t.slight and set(t.found) != set(t.partners(t.found[0]))
    whole = [{"title": "all that was found together", "error": after, "found": True}] if several else []
    term = [{"title": helping(t), "error": after, "found": True}] if t.verdict == "outside" and t.proposal else []
    return [{"title": "the calibrated model alone", "error": before, "found": False}, *each, *whole, *term]
