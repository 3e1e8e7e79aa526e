"""Of the methods: what came of it, in numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ...campaign.channels import CHANNEL_NAMES
from ...inference.estimation.calibration import DOUBTED
from ...inference.policy import DEFAULT
from ..told import NAMED, Told, near_rivals
from ..words import AGAIN, listed, sentence, title_of
from .case import EFFECT, PROFILE, Case, interval
from .markup import cite, code, meaning, plain, symbols
from .numbers import amount, capital, chance, ends, read_out, several


def estimates(case: Case) -> str:
    """Sizes of the effects in the last model, and values at a bound."""
    told = [_effect(case, e) for e in case.effects]
    calibrated = [p for p in case.parameters if not p["name"].startswith(EFFECT)]
    if calibrated:
        the = "The other" if told else "The"
        verb = "is" if len(calibrated) == 1 else "are"
        told.append(f"{the} {several(len(calibrated), 'estimated value')} {verb} in {code('estimates.csv')}.")
    told += [_bent(p) for p in calibrated if p["prior_sd"] and abs(p["estimate"] - p["prior"]) > DOUBTED * p["prior_sd"]]
    if stopped := [code(p["name"]) for p in case.parameters if p["at_bound"]]:
        told.append(
            f"{listed(stopped, 'and')} came out where the search stops; {'its' if len(stopped) == 1 else 'their'} standard "
            f"{'error means' if len(stopped) == 1 else 'errors mean'} little."
        )
    return " ".join(told)


def _bent(p: Mapping[str, Any]) -> str:
    off = abs(p["estimate"] - p["prior"]) / p["prior_sd"]
    value = amount(p["estimate"], None if p["at_bound"] else p["se"], p["unit"])
    return f"{capital(meaning(p['meaning']))} came out at {value}, {off:.1f} standard deviations from its prior."


def _effect(case: Case, effect: str) -> str:
    own = [p for p in case.parameters if p["name"].startswith(f"{EFFECT}{effect}.")]
    sizes, kind = listed([_size(p) for p in own], "and"), case.kind(own[0]["name"])
    if kind == "proposed term":
        return f"The last model has in it the generic term that explains most, {code(effect)}: {sizes}."
    done = {
        "effect found": "was added to the model",
        "effect that helps": "was added to the model because that makes the runs likelier, though the verdict does not name it",
        "effect from the start": "was in the model from the start",
    }[kind]
    return f"{capital(symbols(title_of(effect, case.titles)))} ({code(effect)}) {done}: {sizes}.{_tied(case, effect)}"


def _tied(case: Case, effect: str) -> str:
    others = [code(e) for tie in case.told["ties"] if effect in tie for e in tie if e != effect]
    if not others:
        return ""
    whom = "which" if len(others) == 1 else "any of which"
    return f" It stands there in the place of {listed(others, 'or')} as well, from {whom} this campaign cannot tell it."


def _size(p: Mapping[str, Any]) -> str:
    lower, upper, how = interval(p)
    if not p["se"] or not how:
        return f"{meaning(p['meaning'])}, {amount(p['estimate'], None, p['unit'])}"
    value = f"{meaning(p['meaning'])}, {amount(p['estimate'], p['se'], p['unit'])}"
    by = "profile-likelihood interval" if how == PROFILE else "interval"
    return f"{value} (estimate ± standard error; 95 % {by} {ends(lower, upper, p['se'], p['unit'])})"


def fall(case: Case) -> str:
    """The errors, whitened and in the units of the instruments, before and after."""
    steps = [s for s in (case.ladder[0], case.begins, case.top) if s]
    steps = [s for i, s in enumerate(steps) if s["step"] not in {t["step"] for t in steps[:i]}]
    which = "runs held out" if case.held else "the fitted runs"
    names = [_step(case, s) for s in steps]
    figures = [f"{s[case.key]:.2f} {name}" for s, name in zip(steps, names, strict=True)]
    known = "the pushes of the run and " if case.pushed else ""
    told = [
        f"Errors are readings less a simulation that knows {known}where the run started; whitened, they are "
        "divided by what the noise alone would give, so that 1 is the noise floor.",
        f"The whitened RMS error on {which} was {listed(figures, 'and')}.",
        f"In the units of the instruments, the RMS errors on {which} {listed(names, 'and')} were, in this order, "
        + "; ".join(_channel(case, steps, c) for c in CHANNEL_NAMES if c in case.top["channels"])
        + ".",
    ]
    return " ".join(told)


def _step(case: Case, step: Mapping[str, Any]) -> str:
    if step["step"] == "nominal":
        return "with the values as given" + (" and no effect" if case.already else "")
    if step["step"] == case.begins["step"]:
        return "as calibrated"
    return "with the last model"


def _channel(case: Case, steps: list[Mapping[str, Any]], channel: str) -> str:
    unit = case.top["channels"][channel]["unit"]
    values = [_of(case, s["channels"][channel]) for s in steps if channel in s["channels"]]
    figures = [read_out(v, "1") for v in values[:-1]] + [read_out(values[-1], unit)]
    return f"{listed(figures, 'and')} in {code(channel)}"


def _of(case: Case, told: Mapping[str, Any]) -> float:
    held = told[f"{case.key}_rms"]
    return float(told["fit_rms"] if held is None else held)


def verdict(case: Case) -> str:
    """What the diagnosis says, and how probable it is."""
    told = [f"The diagnosis reads: “{symbols(sentence(case.told, case.titles))}”"]
    rows = {row["effect"]: row for row in case.told["ranking"]}
    sure = [e for e in case.told["effects"] if e in rows and rows[e].get("probability") is not None]
    if case.told["odds"]:
        told += [
            "If one of these is what is missing, the probabilities are "
            + listed([f"{chance(p)} for {code(e)}" for e, p in odds.items()], "and")
            + "."
            for odds in case.told["odds"]
        ]
    elif sure and case.told["verdict"] != "outside":
        told += [_probable(rows[e], case.told["verdict"] == "small") for e in sure]
    told += _rivals(case)
    if case.told["odds"] or (sure and case.told["verdict"] != "outside"):
        told.append(_probability(bool(sure)))
    return " ".join([*told, *_next(case)])


def _probability(averaged: bool) -> str:
    """What a probability is."""
    means = f"; those of what was found are means over resampled blocks of the runs {cite('HugginsMiller2023')}"
    return (
        f"Probabilities compare marginal likelihoods {cite('KassRaftery1995')} of an effect that is there, with a size about "
        f"zero that has a standard deviation of {DEFAULT.large:g} δ, and of one that is not, with the slight size of "
        f"{DEFAULT.slight:g} δ that every chair has of everything{means if averaged else ''}. Beforehand, "
        f"{DEFAULT.expected:g} effect of the catalogue was expected to be missing."
    )


def _probable(row: Mapping[str, Any], small: bool) -> str:
    own = row["parameters"].values()
    sizes = [amount(p["smallest_interesting"], None, p["unit"]) for p in own if p["smallest_interesting"]]
    delta = f", δ = {sizes[0]}" if len(set(sizes)) == 1 else ""
    there = "is no slight one, as every chair has," if small else "is there"
    return (
        f"The probability that {code(row['effect'])} {there} is {chance(row['probability_there'])}, and that it is larger "
        f"than its smallest interesting size{delta}, {chance(row['probability'])}."
    )


def _rivals(case: Case) -> Iterator[str]:
    """Effects that were tried in the place of what was found, and explain nearly as much."""
    near = [r for r in near_rivals(Told(case.told, case.titles, {})) if r.get("probability") is not None][:NAMED]
    if not near:
        return
    names, chances = [code(r["effect"]) for r in near], [chance(r["probability"]) for r in near]
    one, where = len(near) == 1, "In its place" if len(case.told["effects"]) == 1 else "In the place of one of them"
    yield (
        f"{where} {listed(names, 'and')} {'explains' if one else 'explain'} the fitted runs nearly as well; the "
        f"{'probability that it is larger than its' if one else 'probabilities that they are larger than their'} δ "
        f"{'is' if one else 'are'} {listed(chances, 'and')}."
    )


def _next(case: Case) -> Iterator[str]:
    following = case.told.get("next_experiment")
    if following and following["manoeuvre"].endswith(AGAIN):
        yield f"To be measured again: {plain(following['manoeuvre'].removesuffix(AGAIN))}."
    elif following:
        times = "" if following["repeats"] == 1 else f", {following['repeats']} times"
        yield f"To be measured next: {plain(following['manoeuvre'])}{times}."


def disturbance(case: Case) -> str:
    """The force and the moment that nobody recorded."""
    told = case.told.get("disturbance")
    if not told:
        return ""
    before, after = (_strength(s) for s in (told["calibrated"], told))
    words = [
        f"The most likely strength of a random force along the heading and of a random moment, forgotten over a second or "
        f"less, and of a momentum of the rider's body that nobody recorded was {before} for the calibrated model"
        + (f" and {after} for the last one." if case.grew else ".")
    ]
    words += [f"{capital(plain(o['words']))}." for o in told["orders"]]
    return " ".join(words)


def _strength(told: Mapping[str, Any]) -> str:
    """Standard deviations in N, N m and N s."""
    sizes = (told["force"], told["moment"], told.get("body", 0.0))
    return "{:.2g} N, {:.2g} N m and {:.2g} N s".format(*sizes) if any(sizes) else "zero"
