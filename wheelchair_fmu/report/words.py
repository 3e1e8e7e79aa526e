"""A diagnosis in the words of a person."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from ..inference.decision.among_forces import FORCES
from ..inference.policy import DEFAULT
from ..inference.search.ties import grouped
from ..model.choice import KINDS, Choice
from ..model.generic import told_at
from ..quantities import DisplayUnit, Quantity, Unit

HELPERS = 3  # that are named, rivals among them
SEEN = 0.05  # a p below which the data show something like an effect that was not chosen
# Chance of being large enough to matter, below which a cause is "probably" it: "very likely" of Mastrandrea et al. (2010).
LIKELY = 0.9
STILL = 0.015  # whitened RMS error over all channels: a change that nobody would call a fall
NOTHING = "Something is left that no effect in the catalogue explains."
AGAIN = " measured again"  # the end of a next experiment that is no manoeuvre but values of the chair
CHANNELS = {
    "wheel_speed_l": "the left wheel's speed",
    "wheel_speed_r": "the right wheel's speed",
    "yaw_rate": "the yaw rate",
    "a_x": "the forward acceleration",
    "a_y": "the sideways acceleration",
    "u": "the forward speed",
    "v": "the sideways speed",
    "x": "the position along x",
    "y": "the position along y",
    "yaw": "the heading",
    "rider.s": "the body's motion forward",
    "rider.momentum": "the body's momentum",
    "rider.force": "the force on the body",
}
LAWS = {
    "tyre": {
        "linear": "side force and aligning torque grow with slip, without a limit",
        "dugoff": "the side force bends over as it comes near friction, and the aligning torque is that force times a trail",
        "magic_formula": "side force and aligning torque each follow the Magic Formula, the force up to friction",
    },
    "caster": {
        "ideal": "each trails its pivot at once",
        "swivelling": "each swings behind its pivot as its patch rolls without side slip",
        "slipping": "each has a tyre, inertia and friction of its own, swings round, kicks the chair and may shimmy",
    },
    "wheel": {
        "rolling": "each turns as its hub moves, until a brake locks it",
        "spinning": "the speed of each rim is a state: it locks under a brake and spins under a push, and both cost side grip",
    },
    "equations": {"paper": "those of the paper to the letter, for forward motion"},
}  # what each law says, by what it is for
ITS_OWN = "a law of somebody's own"
UNIT = re.compile(r"(?<=\d )[A-Za-z]+(?:[./][A-Za-z]+\d?)+")  # behind a number, of several parts
CENTRE = re.compile(r"\bCM\b")
NAME = re.compile(r"\b[a-z]\w*(?:\.\w+)*")  # what may be the code name of a parameter or of an effect


def laws_of(choice: Choice) -> list[dict[str, str]]:
    """The laws of a model, by what each is for, with what it says; the paper's own equations have those of casters and wheels
    in them."""
    if choice.equations == "paper":
        return [law_told("tyre", choice.tyre), law_told("equations", choice.equations)]
    return [law_told(kind, getattr(choice, kind)) for kind in KINDS]


def law_told(kind: str, name: str) -> dict[str, str]:
    return {"of": kind, "name": name, "says": LAWS.get(kind, {}).get(name, ITS_OWN)}


def sentence(diagnosis: Mapping[str, Any], titles: Mapping[str, str], records: Mapping[str, Quantity] | None = None) -> str:
    """The verdict in one sentence; `titles` say what each effect is, `records` what each parameter means."""
    if diagnosis["verdict"] == "tie":
        return tied(diagnosis["effects"], diagnosis["ties"], titles)
    names = [title_of(e, titles) for e in diagnosis["effects"]]
    missing = [probably(diagnosis, e) + name for e, name in zip(diagnosis["effects"], names, strict=True)]
    helping = helpers(diagnosis["effects"], diagnosis["ties"], titles)
    return {
        "missing": f"Missing from the model: {_all_of(missing)}.",
        "small": _small(names, needed(diagnosis)),
        "adequate": "The model is adequate: nothing is missing that this campaign could have shown.",
        "cannot_see": "Nothing was found for sure; an effect could be of a size that matters without these runs showing it.",
        "outside": outside(diagnosis, records).removesuffix(".")
        + (f"; what helps but does not suffice: {helping}." if helping else "."),
    }[diagnosis["verdict"]]


def _small(names: Sequence[str], helps: bool) -> str:
    if helps:
        there = f"{capital(listed(names, 'or'))} is there, too small to matter by itself"
        return f"{there}; without it the model leaves more than noise."
    return f"The model is adequate: {listed(names, 'or')} is there, but too small to matter."


def needed(diagnosis: Mapping[str, Any]) -> bool:
    """Does what is small bring the error down by what one would see, so that the model is not adequate without it?"""
    before, after = fall(diagnosis)
    return diagnosis["verdict"] == "small" and put_in(diagnosis) and before - after > STILL


def put_in(diagnosis: Mapping[str, Any]) -> bool:
    """Is any of what was found a step of the search?"""
    steps = {s["step"] for s in diagnosis["ladder"]}
    return any(f"+{effect}" in steps for effect in diagnosis["effects"])


def judged_by(diagnosis: Mapping[str, Any]) -> str:
    """Which error is told: on runs held out, where there are any."""
    return "heldout" if diagnosis["ladder"][-1].get("heldout") is not None else "fit"


def fall(diagnosis: Mapping[str, Any]) -> tuple[float, float]:
    """The error before anything was put in, and at the end."""
    ladder, key = diagnosis["ladder"], judged_by(diagnosis)
    before = [s for s in ladder if s["step"] in (diagnosis.get("begins", "calibrated"), FORCES)] or ladder
    return float(before[-1][key]), float(ladder[-1][key])


def probably(diagnosis: Mapping[str, Any], effect: str) -> str:
    """ "probably ", of an effect that is missing, where it is not very likely to be large enough to matter."""
    rows = (row for row in diagnosis["ranking"] if row["effect"] == effect)
    chance = next((row.get("probability") for row in rows), None)
    return "probably " if diagnosis["verdict"] == "missing" and chance is not None and chance < LIKELY else ""


def capital(words: str) -> str:
    return f"{words[:1].upper()}{words[1:]}"


def _all_of(names: Sequence[str]) -> str:
    """ "a, and b": with a comma, as each is long and may have an "and" of its own."""
    return ", and ".join((", ".join(names[:-1]), names[-1])) if len(names) > 1 else "".join(names)


def outside(diagnosis: Mapping[str, Any], records: Mapping[str, Quantity] | None = None) -> str:
    """What "outside" means here: an error that nothing brings down, or one that only values bring down that nobody measured."""
    bent = strained(diagnosis, records or {})
    last, left = diagnosis["ladder"][-1], (diagnosis.get("leftover") or {}).get("proposal")
    if not bent or left or max(last["fit"], last.get("heldout") or 0.0) > DEFAULT.a_little:
        return NOTHING
    return (
        f"The error comes down to the noise only with {listed(bent, 'and')} as nobody would have measured it: "
        "what was given is wrong, or it stands in for what the model lacks."
    )


def headline(diagnosis: Mapping[str, Any], titles: Mapping[str, str], records: Mapping[str, Quantity] | None = None) -> str:
    """The verdict in a sentence short enough to stand above a page; what it rests on stands below it."""
    if diagnosis["verdict"] != "outside":
        return sentence(diagnosis, titles, records)
    if outside(diagnosis, records).startswith(NOTHING):
        return NOTHING
    return "The model follows these runs only with values that nobody would have measured."


def to_measure(manoeuvre: str, records: Mapping[str, Quantity]) -> str:
    """What is to be measured next, after the word “measure”; values of the chair by what they are."""
    values = manoeuvre.removesuffix(AGAIN)
    if values == manoeuvre:
        return manoeuvre
    return f"{listed([f'the {records[n].meaning}' if n in records else n for n in values.split(' and ')], 'and')} again"


def strained(diagnosis: Mapping[str, Any], records: Mapping[str, Quantity]) -> list[str]:
    """Calibrated values that came out as nobody would have measured them, in words."""
    bent = [name for name, v in (diagnosis.get("calibration") or {}).items() if v.get("beyond")]
    return [f"the {records[name].meaning}" if name in records else name for name in bent]


def printed(text: str) -> str:
    """Text of the search with its per cent as they are printed."""
    return re.sub(r"(?<=\d)%", " %", text)


def channel_words(channel: str) -> str:
    """A channel in a sentence."""
    return CHANNELS.get(channel, channel.replace("_", " "))


def named(text: str, titles: Mapping[str, str], records: Mapping[str, Quantity]) -> str:
    """Text of the search with what code names mean in their place, and units as they are printed."""
    text = UNIT.sub(lambda found: found.group().replace(".", " ").replace("2", "²"), text)
    text = re.sub(r"([\d.]+) standard deviations from the ", r"\1 times the ± away from the ", text)

    def plain(found: re.Match[str]) -> str:
        name = found.group()
        if "." in name and name in records:
            return f"the {records[name].meaning}"
        if "_" in name and name in titles:
            return titles[name]
        return channel_words(name) if "_" in name and name in CHANNELS else name

    channel, colon, rest = text.partition(": ")
    about = f"{channel_words(channel)}{colon}" if channel in CHANNELS else NAME.sub(plain, f"{channel}{colon}")
    return about + NAME.sub(plain, rest)


def tied(effects: Sequence[str], ties: Sequence[Sequence[str]], titles: Mapping[str, str]) -> str:
    """What is missing where this campaign cannot tell some effects apart."""
    together = grouped(effects, ties)
    sure = [title_of(group[0], titles) for group in together if len(group) == 1]
    groups = [listed([title_of(e, titles) for e in group], "or") for group in together if len(group) > 1]
    first, *more = [f"one of these is missing, and this campaign cannot tell which: {group}" for group in groups]
    said = "; ".join([first, *(f"and {words}" for words in more)])
    said = f"missing: {listed(sure, 'and')}; and {said}" if sure else said
    return f"{said[0].upper()}{said[1:]}."


def helpers(effects: Sequence[str], ties: Sequence[Sequence[str]], titles: Mapping[str, str]) -> str:
    """Effects that help, each with those this campaign cannot tell it from: three in all, as a long list says nothing."""
    named: list[str] = []
    room = HELPERS
    for group in grouped(effects, ties):
        some, room = group[:room], max(0, room - len(group))
        if some:
            named.append(listed([title_of(e, titles) for e in some], "or"))
    return listed(named, "and")


def in_full(words: str) -> str:
    """A title or a meaning for readers who do not know what the equations are written in."""
    return CENTRE.sub("centre of mass", words)


def title_of(effect: str, titles: Mapping[str, str]) -> str:
    """What an effect is, in words."""
    return titles.get(effect, effect.replace("_", " "))


def particulars(
    diagnosis: Mapping[str, Any], records: Mapping[str, Quantity], titles: Mapping[str, str] | None = None
) -> list[str]:
    """What comes next to the verdict: sizes, the fall of the error, the next experiment, notes."""
    titles = titles or {}
    rows = {row["effect"]: row for row in diagnosis["ranking"]}
    said = [_size(e, rows[e], records, titles) for e in diagnosis["effects"] if e in rows and rows[e]["verdict"] != "tie"]
    said += _proposal(diagnosis.get("leftover") or {}, records)
    said.append(_fall(diagnosis["ladder"]))
    said += map(printed, (diagnosis.get("disturbance") or {}).get("words", ()))
    following = diagnosis.get("next_experiment")
    if following:
        times = "" if following["repeats"] == 1 else f", {following['repeats']} times"
        said.append(f"Next, measure {to_measure(following['manoeuvre'], records)}{times}.")
    return [*said, *(f"Note: {named(note, titles, records)}." for note in diagnosis.get("notes", ()))]


def _size(effect: str, row: Mapping[str, Any], records: Mapping[str, Quantity], titles: Mapping[str, str]) -> str:
    known = {name: records[f"effect.{effect}.{name}"] for name in row["parameters"] if f"effect.{effect}.{name}" in records}
    parts = [
        f"{record.meaning.partition(';')[0]} = {estimated(row['parameters'][name], record.unit)}"
        for name, record in known.items()
    ]
    title = title_of(effect, titles)
    return f"{title[:1].upper()}{title[1:]}: {', '.join(parts)}."


def _proposal(leftover: Mapping[str, Any], records: Mapping[str, Quantity]) -> list[str]:
    found = leftover.get("proposal")
    record = records.get(f"effect.{found['term']}.q") if found else None
    if not found or record is None:
        return []
    size = f"{spoken(found['estimate'], found['se'], record.unit)}{told_at(found['term'])}"
    return [f"The term that helps most: {record.meaning}, {size}."]


def _fall(ladder: Sequence[Mapping[str, Any]]) -> str:
    before = next((s for s in ladder if s["step"] == "calibrated"), ladder[0])
    forces, last = next((s for s in ladder if s["step"] == FORCES), None), ladder[-1]
    key, runs = ("heldout", "runs held out") if last.get("heldout") is not None else ("fit", "the fitted runs")
    if forces:
        found = "" if last is forces else f", and to {last[key]:.2f} with what was found"
        counted = "once forces that nobody recorded count as noise"
        return (
            f"The error on {runs} falls from {before[key]:.2f} to {forces[key]:.2f} {counted}{found}, where 1.0 is noise alone."
        )
    if last is before:
        return f"The error on {runs} is {last[key]:.2f} times what noise alone gives, after calibration."
    if abs(last[key] - before[key]) < STILL:
        return f"The error on {runs} is {last[key]:.2f} times what noise alone gives, about as after calibration."
    verb = "falls" if last[key] < before[key] else "rises"
    return f"The error on {runs} {verb} from {before[key]:.2f} to {last[key]:.2f}, where 1.0 is noise alone."


def value_text(value: float, se: float | None, unit: Unit) -> str:
    """ "1.607 ± 0.008 N": the error to one or two digits, the value to the same place; angles in degrees."""
    shown = _shown(unit)
    value, se = value * shown.factor, se * shown.factor if se else None
    if not se or se <= 0:
        return f"{value:.3g}{_behind(shown)}".replace("-", "−")
    place = _place(se)
    return f"{_to_place(value, place)} ± {se:.{place}f}{_behind(shown)}".replace("-", "−")


def spoken(value: float, se: float | None, unit: Unit) -> str:
    """The same as it is printed: degrees by their sign."""
    return _by_sign(value_text(value, se, unit))


def estimated(size: Mapping[str, Any], unit: Unit) -> str:
    """A size of the ranking: with its 95 % interval where the diagnosis has one, which allows for runs that differ by more than
    their noise, as a standard error does not; else with that."""
    ends = size.get("interval")
    if not ends or not ends[1] > ends[0]:
        return spoken(size["estimate"], size["se"], unit)
    shown = _shown(unit)
    place, name = _place((ends[1] - ends[0]) / 2 * shown.factor), _by_sign(_behind(shown))
    value, low, high = (_to_place(v * shown.factor, place) for v in (size["estimate"], *ends))
    return f"{value}{name} (95 % sure: {low} to {high}{name})".replace("-", "−")


def _shown(unit: Unit) -> DisplayUnit:
    """What a value is told in: angles in degrees, all else as it is."""
    return next((d for d in unit.display if d.name.startswith("deg")), DisplayUnit(unit.name, 1.0))


def _behind(shown: DisplayUnit) -> str:
    """A unit as it stands behind a number."""
    return "" if shown.name == "1" else f" {shown.name.replace('.', ' ').replace('2', '²')}"


def _by_sign(text: str) -> str:
    """Degrees at the end of a text by their sign."""
    return re.sub(r" deg$", "°", re.sub(r" deg/s$", " °/s", text))


def _place(error: float) -> int:
    """The decimal place to which an error has one or two digits."""
    first, exponent = f"{error:.0e}".split("e")
    return max(0, (1 if first in "12" else 0) - int(exponent))


def _to_place(value: float, place: int) -> str:
    return f"{round(value, place) + 0.0:.{place}f}"  # + 0.0: a zero has no sign


def probability_words(p: float) -> str:
    """A probability as a person says it; none is said to be certain."""
    if p > 0.999:
        return "more than 999 in 1000"
    if p < 0.001:
        return "less than 1 in 1000"
    return f"{p:.1%}".replace(".0%", "%").replace("%", " %") if p > 0.99 or p < 0.01 else f"{p:.0%}".replace("%", " %")


def verdict_words(row: Mapping[str, Any]) -> str:
    """What became of an effect of the ranking. One that the data show was seen, even where others explain them better. Of a
    cause with several forms the law is one. What only helps the model may be of any size."""
    if row["verdict"] == "cannot_see" and row.get("in_model"):
        return "size unsure"
    if row["verdict"] == "cannot_see" and row["p"] < SEEN:
        return "not chosen"
    words = str(row["verdict"]).replace("_", " ")
    return f"{words} in this form" if row["verdict"] == "not needed" and row.get("one_form_of") else words


def listed(names: Sequence[str], word: str) -> str:
    """ "a, b and c"."""
    return f" {word} ".join((", ".join(names[:-1]), names[-1])) if len(names) > 1 else "".join(names)
