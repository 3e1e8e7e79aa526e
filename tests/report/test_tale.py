"""What the page tells in words: cards and screens of every verdict, from diagnoses made up and from the sample campaign's."""

from __future__ import annotations

import json
import re

import pytest

from tests.kit import SAMPLE_DIAGNOSIS
from wheelchair_fmu.campaign import CHANNELS
from wheelchair_fmu.inference.decision.among_forces import FORCES
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.generic import library
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.report.advice import INSPECT, inspect, inspect_term
from wheelchair_fmu.report.markup import cards_html, screens_html
from wheelchair_fmu.report.tale import story_of, texts
from wheelchair_fmu.report.told import Told, actions, exceeds, near_rivals
from wheelchair_fmu.report.words import headline, in_full, needed, probability_words, verdict_words

EFFECTS = {**bundled(), **library()}
TITLES = {name: e.title for name, e in bundled().items()}
RECORDS = {p.name: p for e in EFFECTS.values() for p in e.owned}
UNITS = {c.name: c.unit for c in CHANNELS}
SAMPLE = json.loads(SAMPLE_DIAGNOSIS.read_text())
DRAG, LEAN = "rolling_resistance_asymmetry", "camber_misalignment"
JARGON = ("likelihood", "whitened", "RMS", "p-value", "covariance", "posterior", "σ")


def told(verdict, effects=(), ties=(), **more):
    return {**SAMPLE, "verdict": verdict, "effects": list(effects), "ties": [list(t) for t in ties], **more}


def tale(diagnosis):
    return story_of(diagnosis, TITLES, RECORDS, UNITS)


LEVEL = [{**SAMPLE["ladder"][0]}, *({**step, "fit": 1.0, "heldout": 1.0} for step in SAMPLE["ladder"][1:])]
LED = {**SAMPLE["ladder"][1], "step": FORCES, "fit": 0.96, "heldout": 0.92}  # with forces that nobody recorded among the noise
CASES = {
    "missing": told("missing", [DRAG]),
    "two": told("missing", [DRAG, LEAN]),
    "together": told("missing", [DRAG, LEAN], groups=[{"effects": [DRAG, LEAN], "found": True}]),
    "no fall": told("missing", [DRAG], ladder=LEVEL),
    "tie": told("tie", [DRAG, LEAN], [[DRAG, LEAN]]),
    "small": told("small", [DRAG]),
    "small, left out": told("small", [DRAG], ladder=[*SAMPLE["ladder"][:2], LED]),
    "with forces": told("missing", [DRAG], ladder=[*SAMPLE["ladder"][:2], LED, {**SAMPLE["ladder"][2], "heldout": 0.8}]),
    "outside": told(
        "outside", leftover={"p": 1e-9, "where": None, "proposal": {"term": "generic_M_w_spring", "estimate": 2.5, "se": 0.14}}
    ),
    "outside, no term": told("outside"),
    "adequate": told("adequate"),
    "cannot_see": told("cannot_see"),
}


def test_what_forces_brought_down_is_not_told_as_the_work_of_an_effect():
    """From 2.14 to 0.92 the error came by forces among the noise, and no further by an effect too small to matter."""
    story = tale(CASES["small, left out"])
    said = " ".join(texts([*story.cards, *story.screens]))
    assert "falls" not in said and "is 0.92 times what noise alone gives, and to put it in hardly changes that" in said
    assert "Without them the calibrated model is off by 2.14 times" in story.cards[1]["lines"][-1]
    assert story.screens[2]["title"] == "Put it in: hardly anything changes"
    assert "falls from 0.92 to 0.80" in tale(CASES["with forces"]).cards[1]["lines"][0]


def test_a_tie_beside_what_is_sure():
    """What is sure is no part of the tie; errors that were found along other forces than the last step's are not told."""
    sure = next(r["effect"] for r in SAMPLE["ranking"] if r["effect"] not in (DRAG, LEAN) and r["values"])
    ladder = [
        *SAMPLE["ladder"][:2],
        LED,
        {**LED, "step": f"+{sure}", "heldout": 0.88},
        {**LED, "step": f"+{DRAG}", "heldout": 0.8},
    ]
    story = tale(told("tie", [sure, DRAG, LEAN], [[DRAG, LEAN]], ladder=ladder))
    assert story.cards[0]["lead"] == "One effect, and one of two causes"
    assert story.cards[1]["lines"][0].startswith("With one rear wheel") and "comes to 0.80" in story.cards[1]["lines"][0]
    assert story.screens[2]["lines"][0].startswith(
        "With rear wheels that do not point straight ahead in the model, and one rear"
    )
    assert not any(TITLES[sure] in line.lower() for line in story.screens[3]["lines"])
    assert [b["error"] for b in story.screens[3]["bars"]] == [0.92, 0.8]


def test_of_several_sizes_cards_tell_what_is_seen():
    """The difference of two wheels' lean, of which these runs know nothing, is for the expert's figures."""
    lean = {"sum": {"estimate": 0.025, "se": 0.0005, "unit": "rad", "smallest_interesting": 0.005}}
    lean["difference"] = {**lean["sum"], "estimate": 0.0001, "se": 0.05}
    rows = [{**r, "parameters": lean} if r["effect"] == LEAN else r for r in SAMPLE["ranking"]]
    lines = tale(told("missing", [LEAN], ranking=rows)).cards[0]["lines"]
    assert len(lines) == 2 and "1.43 ± 0.03°" in lines[0] and lines[1].startswith("That is ")
    floor = {name: {**lean["sum"], "estimate": size} for name, size in (("sum", 0.025), ("difference", 0.04))}
    rows = [{**r, "parameters": floor} if r["effect"] == LEAN else r for r in SAMPLE["ranking"]]
    assert tale(told("missing", [LEAN], ranking=rows)).cards[0]["lines"][-1].startswith("The larger is 8 times the size")


@pytest.mark.parametrize("case", CASES)
def test_three_cards_and_five_screens_in_plain_sentences(case):
    story = tale(CASES[case])
    assert [c["head"] for c in story.cards] == ["What", "How sure", "What to do"]
    assert [s["kind"] for s in story.screens] == ["errs", "guess", "put", "rivals", "next"]
    for line in texts([*story.cards, *story.screens]):
        assert line and line[0] == line[0].upper(), line
        plain = re.sub(r"wheelchair (add|improve) [\w ]+ -o better.toml", "", line)
        assert "_" not in plain, f"a code name: {line}"
        assert "None" not in line and "nan" not in line.lower().split(), line
    for line in texts(story.cards):
        assert not [word for word in JARGON if word in line], line


def test_what_is_missing_is_told_as_a_multiple_of_what_matters():
    what, sure, do = tale(CASES["missing"]).cards
    assert what["lead"] == "One rear wheel that rolls harder than the other"
    assert what["lines"][-1] == "That is 4 times the size that would matter, 0.4 N."
    assert sure["lead"] == "A chance of 99.8 % that it is large enough to matter"
    before, after = (CASES["missing"]["ladder"][i]["heldout"] for i in (1, -1))
    assert f"from {before:.2f} to {after:.2f}" in sure["lines"][0]
    assert do["lead"] == "Lift the rear and spin both wheels."
    assert do["lines"][-1].endswith(f"wheelchair add {DRAG} CAMPAIGN -o better.toml.")
    assert "wheelchair improve CAMPAIGN" in tale(CASES["two"]).cards[2]["lines"][-1], "which adds all, as add takes one"


@pytest.mark.parametrize(("chance", "hedge"), [(0.61, "probably "), (0.95, "")])
def test_what_is_not_very_likely_to_matter_is_probably_missing(chance, hedge):
    less = [{**r, "probability": chance} if r["effect"] == DRAG else r for r in SAMPLE["ranking"]]
    diagnosis = told("missing", [DRAG], ranking=less)
    lead = f"{hedge}one rear wheel that rolls harder than the other"
    assert tale(diagnosis).cards[0]["lead"] == lead[0].upper() + lead[1:]
    assert headline(diagnosis, TITLES) == f"Missing from the model: {lead}."


def test_what_is_small_is_told_by_how_sure_it_is_that_it_is_small():
    small = [{**r, "probability": 0.03} if r["effect"] == DRAG else r for r in SAMPLE["ranking"]]
    sure = tale(told("small", [DRAG], ranking=small)).cards[1]
    assert sure["lead"] == "A chance of 97 % that it is too small to matter"


def test_an_adequate_model_explains_what_it_leaves_only_where_that_is_noise():
    ends = SAMPLE["ladder"][:2]
    what, sure, _ = tale(told("adequate", ladder=ends)).cards
    assert what["lines"] == ["What the model leaves, 2.14 times the noise of the sensors, no effect in the catalogue explains."]
    assert sure["lines"][1].endswith("the error is 2.14 times what noise alone gives.")
    what, _, _ = tale(told("adequate", ladder=LEVEL)).cards
    assert what["lines"] == ["The model explains these runs to within the noise of the sensors."]


def test_a_model_that_leaves_more_than_noise_explains_no_run():
    what = tale(told("cannot_see", ladder=SAMPLE["ladder"][:2])).cards[0]["lines"]
    assert what[0] == "What the model leaves, 2.14 times the noise of the sensors, no effect in the catalogue explains."
    assert what[1] == "Beside that, many effects could be large enough to matter and not show in these runs."
    assert tale(told("cannot_see", ladder=LEVEL)).cards[0]["lines"][0].startswith("The model explains these runs, but many")


def test_a_tie_that_gains_nothing_on_runs_kept_back_says_so():
    rows = [{**r, "heldout_after": 1.0} for r in SAMPLE["ranking"]]
    sure = tale(told("tie", [DRAG, LEAN], [[DRAG, LEAN]], ladder=LEVEL, ranking=rows)).cards[1]["lines"][0]
    nothing = "On runs that were kept back nothing is gained: the error is 1.00 before, and 1.00 with either."
    assert sure == f"{nothing} What they explain shows in the runs that were fitted."


def test_outside_says_how_sure_that_is_what_comes_near_and_where_to_look():
    _, sure, do = tale(CASES["outside"]).cards
    chance = "Of a million campaigns in which nothing was missing, fewer than one would leave a pattern as plain by chance."
    assert sure["lines"][0] == chance
    assert any(line.startswith("The nearest is ") and "a torque on each caster" in line for line in sure["lines"])
    assert do["lead"].startswith("Swing each caster by hand") and "wheelchair improve" in do["lines"][-1]
    unsure = told("outside", leftover={**CASES["outside"]["leftover"], "p": 0.2})
    assert not tale(unsure).cards[1]["lines"][0].startswith("Of a")


def test_every_generic_term_can_be_inspected():
    for term in library():
        assert inspect_term(term).endswith(".")


def test_what_rivals_leave_is_told_beside_their_bars():
    farther = [r["effect"] for r in SAMPLE["ranking"] if r["effect"] != DRAG and (r["heldout_after"] or 0) > 1.1]
    rivals = tale(told("missing", [DRAG])).screens[3]
    assert farther and any(line.startswith("In its place, ") for line in rivals["lines"])
    said = next(line for line in rivals["lines"] if line.startswith("In its place, "))
    assert (
        f"{TITLES[farther[0]]} leaves {next(r for r in SAMPLE['ranking'] if r['effect'] == farther[0])['heldout_after']:.2f}"
        in said
    )


def test_what_the_first_of_two_does_by_itself_is_told_and_drawn():
    ladder = [
        *SAMPLE["ladder"][:2],
        {**SAMPLE["ladder"][2], "step": f"+{DRAG}", "heldout": 1.2},
        {**SAMPLE["ladder"][2], "step": f"+{LEAN}"},
    ]
    screens = tale({**CASES["together"], "ladder": ladder}).screens
    assert f"By itself, {TITLES[DRAG]} brings it to 1.20." in screens[2]["lines"]
    assert ("one rear wheel that rolls harder than the other", 1.2) in [(b["title"], b["error"]) for b in screens[3]["bars"]]


def test_nothing_suffices_though_something_comes_near():
    """What an effect of the catalogue leaves stands beside what the missing force does."""
    lines = tale(CASES["outside"]).screens[3]["lines"]
    nearest = min((r for r in SAMPLE["ranking"] if r["heldout_after"]), key=lambda r: r["heldout_after"])
    assert lines[1].startswith(f"The nearest is {TITLES[nearest['effect']]} with 1.00, where")
    assert len(tale(CASES["outside, no term"]).screens[3]["lines"]) == 1


def test_where_nothing_suffices_and_nothing_went_in_the_likeliest_is_tried():
    """Errors that were found along other forces are not told, so sizes are, and nobody is told of a fall from 0.92 to 0.92."""
    forces = tale(told("outside", ladder=[*SAMPLE["ladder"][:2], LED]))
    _, guess, put, rivals, _ = forces.screens
    first = next(r["effect"] for r in SAMPLE["ranking"] if r["values"])
    assert put["effect"] == first and put["lines"][0].startswith(f"The likeliest is {TITLES[first]}")
    assert len(rivals["bars"]) == 1 and "these are their sizes" in rivals["lines"][0]
    assert {c["answer"] for c in guess["choices"]} == {"No: put in and fitted, it does not suffice."}


def test_what_is_in_the_model_and_too_small_to_matter_is_told():
    """The last step has it in as well, so its error is no work of what was found alone."""
    slight = [{**r, "verdict": "small"} if r["effect"] == LEAN else r for r in SAMPLE["ranking"]]
    ladder = [*SAMPLE["ladder"][:2], {**SAMPLE["ladder"][2], "step": f"+{LEAN}"}, SAMPLE["ladder"][2]]
    story = tale(told("missing", [DRAG], ranking=slight, ladder=ladder))
    screens, fall = story.screens, story.cards[1]["lines"][0]
    assert fall.endswith(" noise alone gives, with rear wheels that lean put in as well, too little of it to matter.")
    assert screens[2]["lines"][0] == fall and not any(
        "In the model as well" in line for line in screens[2]["lines"]
    )  # said once
    answer = next(c["answer"] for c in screens[1]["choices"] if c["effect"] == LEAN)
    assert answer.startswith("It is in the model, at ") and "The error" not in answer


def test_what_is_in_the_model_and_may_be_large_is_not_called_too_small():
    """An effect that helps, at 2.9 times the size that matters and as uncertain as that, was called "too small to matter"."""
    unsure = [{**r, "verdict": "cannot_see", "in_model": True} if r["effect"] == LEAN else r for r in SAMPLE["ranking"]]
    ladder = [*SAMPLE["ladder"][:2], {**SAMPLE["ladder"][2], "step": f"+{LEAN}"}, SAMPLE["ladder"][2]]
    story = tale(told("missing", [DRAG], ranking=unsure, ladder=ladder))
    said = " of a size that these runs leave open."
    assert story.cards[1]["lines"][0].endswith(f"with rear wheels that lean put in as well,{said}")
    answer = next(c["answer"] for c in story.screens[1]["choices"] if c["effect"] == LEAN)
    assert answer.startswith("It is in the model, at ") and answer.endswith("which these runs leave open.")
    assert verdict_words({"verdict": "cannot_see", "p": 0.01, "in_model": True}) == "size unsure"


def test_centre_of_mass_is_written_in_full():
    assert in_full("moment about the CM, by the CMs") == "moment about the centre of mass, by the CMs"


def test_two_effects_are_a_list_and_a_tie_shows_both_sizes():
    two, tie = tale(CASES["two"]).cards[0], tale(CASES["tie"]).cards
    assert two["lead"] == "Two effects" and len(two["lines"]) == 2
    assert tie[0]["lead"] == "One of two causes"
    assert [line.partition(":")[0] for line in tie[0]["lines"]] == [
        "One rear wheel that rolls harder than the other",
        "Rear wheels that lean",
    ]
    assert "which one, these runs do not say" in tie[1]["lead"]


def test_small_effects_that_these_runs_cannot_tell_apart_are_one():
    two = tale(told("small", [DRAG, LEAN], ladder=[*SAMPLE["ladder"][:2], LED])).cards
    assert two[0]["lead"] == "One of two causes" and len(two[0]["lines"]) == 2
    assert "The chance that one of them is there at all is above 95 %" in two[1]["lines"][0]
    bars = tale(told("small", [DRAG, LEAN], ladder=[*SAMPLE["ladder"][:2], LED])).screens[3]["bars"]
    assert "all that was found together" not in [b["title"] for b in bars]  # nothing was put in
    one = tale(CASES["small, left out"]).cards[1]["lines"]
    assert one[0] == "The chance that it is there at all is above 95 %, by the fitted runs and those kept back together."


def test_an_effect_that_was_tried_beside_others_is_no_rival_of_theirs():
    """Its error on runs held out is theirs as well, and no work of its own."""
    beside = next(r["effect"] for r in SAMPLE["ranking"] if r["effect"] not in (DRAG, LEAN) and r["values"])
    top = SAMPLE["ladder"][-1]["heldout"]
    ranking = [{**r, "heldout_before": top, "heldout_after": top} if r["effect"] == beside else r for r in SAMPLE["ranking"]]
    ranking.sort(key=lambda r: r["effect"] not in (DRAG, beside))
    screens = tale(told("missing", [DRAG], ranking=ranking)).screens
    answer = next(c["answer"] for c in screens[1]["choices"] if c["effect"] == beside)
    assert answer == "No: beside what was found it changes nothing, and the error stays as it is."
    titles = [b["title"] for b in screens[3]["bars"]]
    assert TITLES[beside] not in titles and TITLES[LEAN] in titles
    said = f"Put in beside it, the error comes down no further with {TITLES[beside]}."
    assert said in screens[3]["lines"] and said not in tale(CASES["missing"]).screens[3]["lines"]


def test_rivals_stand_back_each_for_a_reason_of_its_own():
    """One explains the fitted runs better, and those kept back not so well; another has more sizes to choose."""
    lean = next(r for r in SAMPLE["ranking"] if r["effect"] == LEAN)
    more = {**lean, "lr": 5 * lean["lr"], "parameters": {"sum": lean["parameters"]["sum"]}}
    ranking = [more if r is lean else r for r in SAMPLE["ranking"]]
    lines = tale(told("missing", [DRAG], ranking=ranking)).cards[1]["lines"]
    assert "Rear wheels that lean would do as well, though the runs that were kept back speak less for that." in lines
    assert any(line.endswith("would do nearly as well, with two sizes to choose where this has one.") for line in lines)


@pytest.mark.parametrize(("verdict", "wanted"), [("adequate", max), ("cannot_see", min)])
def test_where_nothing_was_found_one_is_tried_that_says_why(verdict, wanted):
    """What these runs would have shown most plainly, or what they hide."""
    put = tale(told(verdict)).screens[2]
    known = [r for r in SAMPLE["ranking"] if (r["power"] >= 0.8) == (verdict == "adequate")]
    known = [r for r in known if any(v["se"] for v in r["parameters"].values())]  # of others nothing is known
    plain = {
        r["effect"]: max((v["smallest_interesting"] / v["se"] for v in r["parameters"].values() if v["se"]), default=0)
        / (1 if verdict == "adequate" else max(1 - r["hidden_in_fit"], 1e-6) ** 0.5)
        for r in known
    }
    assert plain[put["effect"]] == wanted(plain.values())
    assert ("these runs would have shown that" in put["lines"][0]) == (verdict == "adequate")
    assert not [line for line in (put["title"], *put["lines"]) if "rises" in line]  # to two digits it may not


@pytest.mark.parametrize(("verdict", "only"), [("adequate", ""), ("cannot_see", "Only ")])
def test_how_sure_it_is_that_nothing_is_missing_is_told_by_what_decides_it(verdict, only):
    """The verdict counts causes; an older diagnosis does not say how many, and then effects are counted."""
    sure = tale(told(verdict, seen=0.824)).cards[1]
    assert sure["lead"].startswith(f"{only}82 % of all causes") and "Effects of one cause count as one" in sure["lines"][0]
    known = sum(r["power"] >= 0.8 for r in SAMPLE["ranking"])
    assert tale(told(verdict)).cards[1]["lead"].startswith(f"{only}{known} of {len(SAMPLE['ranking'])} effects")


def test_where_nothing_was_found_one_guesses_what_these_runs_would_show():
    choices = tale(CASES["cannot_see"]).screens[1]["choices"]
    assert {c["right"] for c in choices} == {True, False}
    assert all(("would have shown it" in c["answer"]) == c["right"] for c in choices)


def test_where_these_runs_cannot_see_what_they_could_not_show_is_named():
    rows = [{**r, "power": 0.05 + 0.1 * i} if i < 3 else {**r, "power": 1.0} for i, r in enumerate(SAMPLE["ranking"])]
    rivals = tale(told("cannot_see", ranking=rows)).screens[3]
    hidden, said = [TITLES[r["effect"]] for r in rows[:3]], rivals["lines"][1].lower()
    assert rivals["title"] == "What these runs could not show" and rivals["bars"] == []
    assert all(title.lower() in said for title in hidden) and "(5 %)" in said
    assert not any(TITLES[r["effect"]].lower() in said for r in rows[3:])


def test_an_effect_whose_size_is_left_open_is_not_said_to_be_smaller():
    """These runs would have shown it, and yet its interval goes beyond the smallest size that matters."""
    wide = {r["effect"]: {**r, "power": 1.0} for r in SAMPLE["ranking"]}
    first = next(e for e, r in wide.items() if len(r["parameters"]) == 1)
    ((name, v),) = wide[first]["parameters"].items()
    wide[first]["parameters"] = {name: {**v, "estimate": 0.6 * v["smallest_interesting"], "se": v["smallest_interesting"]}}
    order = sorted(wide.values(), key=lambda r: r["effect"] != first)
    answers = {c["effect"]: c for c in tale(told("adequate", ranking=order)).screens[1]["choices"]}
    assert "leave open" in answers[first]["answer"] and not answers[first]["right"]


def test_what_is_small_may_be_something_else_that_is_large():
    """With odds of 1 to 1 against that, the chance that it is small is half of what it would be."""
    found = tale(told("small", [DRAG], larger=[{"effect": LEAN, "times": 1.1, "odds_against": 1.0}])).cards[1]
    alone = tale(told("small", [DRAG])).cards[1]
    assert "1.1 times the size that would matter" in " ".join(found["lines"]) and "1 to 1 against" in " ".join(found["lines"])
    chance = 1 - exceeds(next(r for r in SAMPLE["ranking"] if r["effect"] == DRAG))
    assert probability_words(0.5 * chance) in found["lead"] and found["lead"] != alone["lead"]


def test_a_value_that_came_out_as_nobody_would_measure_it_is_a_doubt_on_the_card():
    bent = {"chair.a": {**SAMPLE["calibration"]["chair.a"], "value": 0.21, "prior": 0.25, "prior_sd": 0.01, "beyond": True}}
    records = RECORDS | {p.name: p for p in Variant().parameters()}
    doubted = story_of(told("missing", [DRAG], calibration=bent), TITLES, records, UNITS).cards[1]["lines"]
    (doubt,) = (line for line in doubted if line.startswith("One doubt: the "))
    assert "0.21 m" in doubt and "0.250 ± 0.010 m was given" in doubt
    assert not any("doubt" in line for line in tale(CASES["missing"]).cards[1]["lines"])


def test_a_tie_says_what_tells_the_two_apart():
    following = {"manoeuvre": "a slalom at 1 m/s", "separates": [DRAG, LEAN], "repeats": 2, "why": ""}
    do = tale(told("tie", [DRAG, LEAN], [[DRAG, LEAN]], next_experiment=following)).cards[2]
    assert do["lead"] == "Measure a slalom at 1 m/s, 2 times: it would tell them apart."


def test_a_rival_that_does_nearly_as_well_is_named():
    """With as good an error on runs held out, it must not read as if the runs told the two apart without doubt."""
    t = Told(CASES["missing"], TITLES, RECORDS)
    assert LEAN in [r["effect"] for r in near_rivals(t)]
    assert any("nearly as well" in line for line in tale(CASES["missing"]).cards[1]["lines"])
    poor = [{**r, "lr": r["lr"] / (1 if r["effect"] == DRAG else 5)} for r in SAMPLE["ranking"]]
    alone = tale(told("missing", [DRAG], ranking=poor)).cards[1]["lines"]
    assert alone[-1] == "No other effect in the catalogue explains these runs equally well."


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        ({"probability": 0.25}, 0.25),
        ({"parameters": {"k": {"estimate": 1.0, "se": 0.5, "smallest_interesting": 1.0}}}, 0.5),
        ({"parameters": {"k": {"estimate": 0.0, "se": 1.0, "smallest_interesting": 1.96}}}, 0.05),
        ({"parameters": {"k": {"estimate": -2.0, "se": None, "smallest_interesting": 1.0}}}, 1.0),
    ],
)
def test_the_chance_that_a_size_matters(row, expected):
    assert exceeds({"parameters": {}, **row}) == pytest.approx(expected, abs=1e-3)


def test_what_is_left_is_told_in_units_of_sensors_where_it_is_known():
    physical = {"yaw_rate": {"heldout_rms": 0.35, "unit": "deg/s", "share_of_sd": 0.04, "constant_rms": 8.6}}
    assert tale(told("missing", [DRAG], physical=physical)).physical == [
        "The yaw rate is predicted to within 0.35 °/s, 4 % of how much it varies."
    ]
    merely = {"yaw_rate": {**physical["yaw_rate"], "share_of_sd": 1.02}}
    assert tale(told("missing", [DRAG], physical=merely)).physical[0].endswith("0.35 °/s, as much as it varies at all.")
    assert SAMPLE["physical"]["yaw_rate"]["unit"] == "deg/s"  # a diagnosis has it in the unit in which it is told
    assert not tale(told("missing", [DRAG], physical={})).physical


def test_the_right_guess_is_among_the_choices_and_the_rest_are_not_right():
    choices = next(s for s in tale(CASES["two"]).screens if s["kind"] == "guess")["choices"]
    assert {c["effect"] for c in choices if c["right"]} == {DRAG, LEAN}
    assert len(choices) > 2 and all(c["answer"] for c in choices)


def test_effects_that_were_put_in_at_once_are_told_as_one():
    story = tale(CASES["together"])
    assert "These were put in together, as one acts through the other." in story.cards[0]["lines"]
    guess, rivals = (next(s for s in story.screens if s["kind"] == kind) for kind in ("guess", "rivals"))
    answers = [c["answer"] for c in guess["choices"] if c["right"]]
    assert len(answers) == 2 and all("together with" in answer for answer in answers)
    found = [bar["title"] for bar in rivals["bars"] if bar["found"]]
    assert found == ["one rear wheel that rolls harder than the other with rear wheels that lean"]
    others = [{"effects": [DRAG, LEAN], "found": False}], [{"effects": [DRAG, "toe_misalignment"], "found": True}]
    for groups in others:  # of which not all was kept
        assert not any("at once" in line for line in tale(told("missing", [DRAG, LEAN], groups=groups)).cards[0]["lines"])


def test_bars_of_several_sizes_are_in_the_order_of_the_sentences():
    """What is sure comes before what is tied, as it does in the sentences."""
    tie = tale(told("tie", [DRAG, LEAN], [[DRAG, LEAN]])).cards[0]["gauge"]
    sizes = {e: Told(SAMPLE, TITLES, RECORDS).multiple(e) for e in (DRAG, LEAN, "toe_misalignment")}
    assert tie["bars"] == [("first 4×", sizes[DRAG]), ("second 13×", sizes[LEAN])]
    beside = tale(told("tie", [DRAG, LEAN, "toe_misalignment"], [[DRAG, LEAN]])).cards[0]
    assert [length for _, length in beside["gauge"]["bars"]] == [sizes[e] for e in ("toe_misalignment", DRAG, LEAN)]
    assert beside["lines"][0].startswith("Rear wheels that do not point")


def test_bars_show_the_size_and_the_fall_where_there_are_any():
    what, sure, do = tale(CASES["missing"]).cards
    assert what["gauge"]["bars"] == [("size 4×", pytest.approx(4.0, abs=0.05))] and what["gauge"]["mark"] == 1.0
    assert [label.split()[0] for label, _ in sure["gauge"]["bars"]] == ["before", "after"] and "gauge" not in do
    assert cards_html([what]).count("<u ") == 1 and cards_html([sure]).count("<u ") == 2
    assert "gauge" not in tale(CASES["adequate"]).cards[0] and "gauge" not in tale(CASES["no fall"]).cards[1]


def test_where_no_error_falls_nobody_is_told_to_watch_one():
    put = next(s for s in tale(CASES["no fall"]).screens if s["kind"] == "put")
    assert "fall" not in put["title"]
    errs = [a["answer"] for s in tale(CASES["no fall"]).screens for a in s.get("choices", ()) if not a["right"]]
    assert not any("helps" in answer and "1.00" in answer for answer in errs)


def test_outside_names_the_term_that_helps_and_shows_its_error():
    screens = {s["kind"]: s for s in tale(CASES["outside"]).screens}
    size = tale(CASES["outside"]).cards[0]["lines"][0].partition(": ")[2]
    assert size == "2.50 ± 0.14 N m with the casters at 90°, 12 times the size that would matter."
    assert "a torque on each caster" in screens["put"]["lines"][0]
    assert "a torque on each caster" in screens["rivals"]["bars"][-1]["title"]
    assert screens["rivals"]["bars"][-1]["error"] == SAMPLE["ladder"][-1]["heldout"]


def test_every_effect_of_the_catalogue_can_be_inspected():
    assert set(INSPECT) == set(bundled())
    assert inspect("rubbing_brake", "a brake that rubs") == "Look at the chair for a brake that rubs."


def test_nothing_in_a_sentence_becomes_markup():
    line = ['<script>alert(1)</script> & "x"']
    html = cards_html([{"head": "<b>", "lead": line[0], "lines": line}]) + screens_html(
        [{"kind": '"><i>', "title": "<b>", "lines": line}]
    )
    assert "<script" not in html and "<i>" not in html and "<b>" not in html


@pytest.mark.parametrize("case", CASES)
def test_a_campaign_without_runs_held_out_is_told_by_those_it_was_fitted_to(case):
    ladder = [{**step, "heldout": None} for step in SAMPLE["ladder"]]
    ranking = [{**row, "heldout_before": None, "heldout_after": None} for row in SAMPLE["ranking"]]
    story = tale({**CASES[case], "ladder": ladder, "ranking": ranking})
    lines = texts([*story.cards, *story.screens])
    assert not [line for line in lines if "kept back" in line or "None" in line]


def test_values_to_be_measured_again_have_names_and_the_headline_stays_short():
    """A search that bends what was given: no code names, no “measure … measured”, a headline that fits above the cards."""
    bent = {**SAMPLE["calibration"]["chair.m"], "beyond": True}
    following = {"manoeuvre": "chair.m measured again", "separates": [], "repeats": 1, "why": ""}
    calibration = {**SAMPLE["calibration"], "chair.m": bent}
    diagnosis = told("outside", [DRAG], ladder=LEVEL, calibration=calibration, next_experiment=following, leftover=None)
    records = {**RECORDS, "chair.m": RECORDS[f"effect.{DRAG}.D"]}  # any record has a meaning
    story = story_of(diagnosis, TITLES, records, UNITS)
    lines = texts([*story.cards, *story.screens])
    assert not [line for line in lines if "chair.m" in line or "measured again" in line]
    assert story.following[0] == f"Next, measure the {records['chair.m'].meaning} again."
    assert len(headline(diagnosis, TITLES, records)) < 90
    answers = [c["answer"] for c in story.screens[1]["choices"] if c["right"]]
    assert answers and not [a for a in answers if a.startswith("Yes")]  # what does not suffice is no answer


def test_a_size_that_may_as_well_be_none_is_no_multiple_of_what_matters():
    row = next(r for r in SAMPLE["ranking"] if r["effect"] == DRAG)
    size = {**row["parameters"]["D"], "estimate": 1.6, "se": 1.2, "interval": None}
    ranking = [{**r, "parameters": {"D": size}} if r["effect"] == DRAG else r for r in SAMPLE["ranking"]]
    line = tale(told("tie", [DRAG, LEAN], [[DRAG, LEAN]], ranking=ranking)).cards[0]["lines"][0]
    assert line.endswith("a size that these runs leave open.")


def test_of_a_size_below_zero_it_is_said_what_it_is_of():
    """The wheel that drags is the other one."""
    row = next(r for r in SAMPLE["ranking"] if r["effect"] == DRAG)
    size = {**row["parameters"]["D"], "estimate": -1.6, "se": 0.1, "interval": None}
    ranking = [{**r, "parameters": {"D": size}} if r["effect"] == DRAG else r for r in SAMPLE["ranking"]]
    line = tale(told("tie", [DRAG, LEAN], [[DRAG, LEAN]], ranking=ranking)).cards[0]["lines"][0]
    assert ": the rolling resistance of the left wheel less the right wheel's is −1.60 ± 0.10 N, 4 times" in line
    assert ": 1.61 N (95 % sure: 1.49 to 1.73 N), 4 times" in tale(CASES["tie"]).cards[0]["lines"][0]


def test_a_size_whose_interval_has_nought_in_it_is_not_on_the_card():
    """Though its standard error, which knows nothing of how runs differ, is far less than it."""
    row = next(r for r in SAMPLE["ranking"] if r["effect"] == "trunk_motion")
    size = row["parameters"]["amplitude"]
    forward = {**size, "estimate": 0.0232, "se": 0.0003, "interval": [0.0131, 0.0336]}
    swing = {**size, "estimate": 0.00013, "se": 0.00006, "interval": [-0.0008, 0.0012]}
    ranking = [{**r, "parameters": {"amplitude": forward, "swing": swing}} if r is row else r for r in SAMPLE["ranking"]]
    lines = tale(told("missing", ["trunk_motion"], ranking=ranking)).cards[0]["lines"]
    assert len(lines) == 2 and lines[0].endswith("0.023 m (95 % sure: 0.013 to 0.034 m).")


def test_what_is_small_and_brings_the_error_down_is_worth_putting_in():
    do = tale(CASES["small"]).cards[2]
    assert (
        do["lead"]
        == f"Put it into the model, which leaves more than noise without: wheelchair add {DRAG} CAMPAIGN -o better.toml."
    )
    assert tale(CASES["small, left out"]).cards[2]["lead"] == "Use the model as it is."
    assert needed(CASES["small"]) and not needed(CASES["small, left out"]) and not needed(CASES["missing"])


def test_a_held_out_run_that_shows_more_is_to_be_fitted_before_anything_else():
    """Not "compare the missing force", of which the fitted runs have none."""
    t = Told({**CASES["outside"], "to_fit": "slalom-2"}, TITLES, RECORDS)
    first, *others = actions(t)
    assert first.startswith('Give slalom-2 role = "fit" in campaign.toml') and others
    assert actions(Told({**CASES["outside"], "to_fit": None}, TITLES, RECORDS))[0] != first
