"""The page's words and its one file, without a browser."""

from __future__ import annotations

import re
from types import SimpleNamespace

import pytest

from wheelchair_fmu.model.choice import Choice, names
from wheelchair_fmu.quantities import N_S_M, RAD, M, N, Parameter
from wheelchair_fmu.report.content import layers
from wheelchair_fmu.report.markup import marked
from wheelchair_fmu.report.page import MODULES, asset, page, unpacked
from wheelchair_fmu.report.tale import Story
from wheelchair_fmu.report.words import ITS_OWN, law_told, laws_of, particulars, sentence, value_text

TITLES = {"drag": "air that resists", "slope": "a floor that slopes"}
LADDER = [
    {"step": "nominal", "fit": 9.0, "heldout": 8.0},
    {"step": "calibrated", "fit": 2.0, "heldout": 1.9},
    {"step": "+drag", "fit": 1.01, "heldout": 1.02},
]


def told(verdict, effects=(), ties=(), **more):
    ranking = [
        {
            "effect": e,
            "parameters": {"k": {"estimate": 1.2345, "se": 0.021, "unit": "N.s/m"}},
            "p": 1e-3,
            "verdict": "tie" if any(e in group for group in ties) else "missing",
        }
        for e in effects
    ]
    return {"verdict": verdict, "effects": list(effects), "ties": ties, "ranking": ranking, "ladder": LADDER, **more}


@pytest.mark.parametrize(
    ("verdict", "effects", "expected"),
    [
        ("missing", ["drag"], "Missing from the model: air that resists."),
        ("missing", ["drag", "slope"], "Missing from the model: air that resists, and a floor that slopes."),
        (
            "small",
            ["drag"],
            "Air that resists is there, too small to matter by itself; without it the model leaves more than noise.",
        ),
        ("adequate", [], "The model is adequate: nothing is missing that this campaign could have shown."),
        ("outside", [], "Something is left that no effect in the catalogue explains."),
        (
            "outside",
            ["slope"],
            "Something is left that no effect in the catalogue explains; what helps but does not suffice: a floor that slopes.",
        ),
    ],
)
def test_a_verdict_is_one_sentence(verdict, effects, expected):
    assert sentence(told(verdict, effects), TITLES) == expected


def test_what_is_small_is_there_whatever_a_test_of_the_fitted_runs_alone_says():
    """The verdict rests on fitted and held-out runs together; of several that are named, these runs cannot tell which it is."""
    found = told("small", ["drag", "slope"])
    found["ranking"][0]["p"] = 0.8
    found["ladder"] = [step for step in found["ladder"] if not step["step"].startswith("+")]
    said = "The model is adequate: air that resists or a floor that slopes is there, but too small to matter."
    assert sentence(found, TITLES) == said


@pytest.mark.parametrize(
    ("effects", "ties", "expected"),
    [
        (
            ["drag", "slope"],
            [["drag", "slope"]],
            "One of these is missing, and this campaign cannot tell which: air that resists or a floor that slopes.",
        ),
        (
            ["drag", "slope", "toe"],
            [["drag", "slope"]],
            "Missing: toe; and one of these is missing, and this campaign cannot tell which: air that resists or a floor that "
            "slopes.",
        ),
        (
            ["drag", "slope", "toe", "trail"],
            [["drag", "slope"], ["toe", "trail"]],
            "One of these is missing, and this campaign cannot tell which: air that resists or a floor that slopes; and one of "
            "these is missing, and this campaign cannot tell which: toe or trail.",
        ),
    ],
)
def test_a_tie_names_what_is_sure_first(effects, ties, expected):
    assert sentence(told("tie", effects, ties), TITLES) == expected


def test_what_helps_is_named_with_its_ties():
    said = sentence(told("outside", ["drag", "slope", "toe"], [["slope", "toe"]]), TITLES)
    assert said.endswith("what helps but does not suffice: air that resists and a floor that slopes or toe.")
    many = sentence(told("outside", ["drag", "slope", "toe", "trail"], [["drag", "slope"], ["toe", "trail"]]), TITLES)
    assert many.endswith("what helps but does not suffice: air that resists or a floor that slopes and toe.")


def test_an_error_that_only_bent_values_bring_down_is_said_so():
    calibration = {"chair.a": {"beyond": True}, "chair.m": {"beyond": False}}
    low = [{"step": "calibrated", "fit": 0.99, "heldout": 1.01}]
    said = sentence(told("outside", calibration=calibration) | {"ladder": low}, TITLES)
    assert said.startswith("The error comes down to the noise only with chair.a as nobody would have measured it")
    known = {"chair.a": Parameter("chair.a", M, "way to the casters")}
    assert "only with the way to the casters as nobody" in sentence(
        told("outside", calibration=calibration) | {"ladder": low}, TITLES, known
    )
    for more in ({"ladder": [low[0] | {"heldout": 1.2}]}, {"ladder": low, "leftover": {"proposal": {"term": "odd"}}}):
        other = sentence(told("outside", calibration=calibration) | more, TITLES)
        assert other.startswith("Something is left")


def test_the_sizes_and_the_fall_come_next():
    records = {
        "effect.drag.k": Parameter("effect.drag.k", N_S_M, "size of the drag"),
        "effect.odd.q": Parameter("effect.odd.q", RAD, "a lean"),
    }
    lines = particulars(told("missing", ["drag"]), records)
    left = {"proposal": {"term": "odd", "estimate": -0.01, "se": 0.001}}
    assert particulars(told("outside", leftover=left), records)[0] == "The term that helps most: a lean, −0.57 ± 0.06°."
    assert particulars(told("tie", ["drag"], [["slope", "toe"]]), records) == lines
    assert particulars(told("tie", ["drag", "slope"], [["drag", "slope"]]), records) == lines[1:]  # no size of what may not be
    level = [{"step": "calibrated", "fit": 1.0, "heldout": 1.001}, {"step": "+drag", "fit": 1.0, "heldout": 1.003}]
    still = particulars({**told("missing", ["drag"]), "ladder": level, "notes": ["drag_k of chair.a is odd, see x.y"]}, records)
    assert still[-2] == "The error on runs held out is 1.00 times what noise alone gives, about as after calibration."
    assert still[-1] == "Note: drag_k of chair.a is odd, see x.y."  # names that nobody knows stay
    known = {**records, "chair.a": Parameter("chair.a", M, "way to the casters")}
    plain = particulars(
        told("missing", ["drag"], notes=["chair.a beside toe_in is odd"]), known, {"toe_in": "wheels that toe in"}
    )
    assert plain[-1] == "Note: the way to the casters beside wheels that toe in is odd."
    noise = particulars(
        told("missing", notes=["x: its noise is about 1 m/s2, or 3 ± 1 kg.m2", "wheel_speed_l is odd, and x.y: no"]), {}
    )
    assert noise[-2:] == [
        "Note: the position along x: its noise is about 1 m/s², or 3 ± 1 kg m².",
        "Note: the left wheel's speed is odd, and x.y: no.",
    ]
    assert lines == [
        "Drag: size of the drag = 1.234 ± 0.021 N s/m.",
        "The error on runs held out falls from 1.90 to 1.02, where 1.0 is noise alone.",
    ]


@pytest.mark.parametrize(
    ("value", "se", "text"),
    [
        (1.60688, 0.0083, "1.607 ± 0.008 N"),
        (1.60688, 0.0123, "1.607 ± 0.012 N"),
        (1234.5, 34.0, "1234 ± 34 N"),
        (0.5, None, "0.5 N"),
        (0.018, 0.00998, "0.018 ± 0.010 N"),
    ],
)
def test_no_more_digits_than_are_known(value, se, text):
    assert value_text(value, se, N) == text


def test_nothing_in_the_data_becomes_markup():
    name = "</script><script>alert(1)</script>{{title}}<b>"
    screens = [{"kind": "errs", "title": "<b>", "lines": ["<i>"]}]
    html = page({"name": name}, "a < b", ["<i>"], Story([{"head": "<i>", "lead": name, "lines": [name]}], screens))
    assert "<script>alert" not in html
    assert "<i>" not in html.partition("<main>")[2].partition("Try it")[0]
    assert unpacked(html)["name"] == name


@pytest.mark.parametrize(
    ("given", "found", "expected"),
    [
        ("", "", ["ab", "abc", "abcd"]),
        ("", "c", ["ab", "abc", "abcd"]),
        ("", "d", ["ab", "abd", "abc", "abcd"]),
        ("a", "", ["ab", "abc", "abcd"]),
        ("d", "", ["abd", "abcd"]),
        ("c", "d", ["abc", "abcd"]),
    ],
)
def test_the_page_carries_no_heavier_model_than_it_needs(given, found, expected):
    factory = SimpleNamespace(light="ab", heavy="c", demanding="d")
    assert layers(factory, given, found) == [tuple(ids) for ids in expected]


def test_every_module_is_in_the_import_map():
    imported = {m for name in MODULES for m in re.findall(r'from "page/(\w+)"', asset(f"{name}.js"))}
    assert imported == set(MODULES) - {"app"}


def test_every_colour_of_the_page_has_one_on_paper():
    text = asset("draw.js")
    names = re.search(r"const NAMES = \[(.*?)\]", text)[1]
    print_colours = re.search(r"export const PRINT = \{(.*?)\};", text, re.DOTALL)[1]
    assert set(re.findall(r'"([\w-]+)"', names)) <= set(re.findall(r'"?([\w-]+)"?:', print_colours))


def test_the_plotting_library_comes_with_its_licence():
    html = page({"name": "a"}, "", [], Story([], []))
    assert "uPlot" in html and "Permission is hereby granted" in html


def test_a_page_says_what_it_was_made_by():
    story = Story([], [])
    diagnosis = {"made_by": {"version": "1.2.3", "code": "c" * 64}, "fingerprint": "f" * 64}
    html = page({"name": "n", "diagnosis": diagnosis}, "s", [], story)
    assert "Found by wheelchair-fmu 1.2.3 (code cccccccccccc) in measurements with the fingerprint ffffffffffff." in html
    assert "Found by wheelchair-fmu." in page({"name": "n"}, "s", [], story)  # of a diagnosis that says nothing of itself


def test_commands_and_symbols_are_printed_as_such():
    for command in ("wheelchair add drag CAMPAIGN -o better.toml", "wheelchair improve CAMPAIGN -o better.toml"):
        assert marked(f"Put it in: {command}.") == f"Put it in: <code>{command}</code>"
    assert marked("Stiffness C_λ of one_tyre & more") == "Stiffness C<sub>λ</sub> of one_tyre &amp; more"
    assert marked("1 ± 2 m, 95 % of") == "1\u00a0±\u00a02 m, 95\u00a0% of"  # no line ends between them


def test_a_note_on_the_page_has_no_statistics_in_it():
    note = "resistance.f_f comes out at 0.02, 2.2 standard deviations from the usual 0.01 ± 0.004"
    said = particulars(told("adequate", notes=[note]), {})[-1]
    assert said.endswith("comes out at 0.02, 2.2 times the ± away from the usual 0.01 ± 0.004.")


def test_every_law_to_choose_from_has_words():
    """Also where the words are of somebody's own law, of which nothing more is known."""
    bundled = [(kind, name) for kind, some in names().items() for name in some if (kind, name) != ("equations", "extended")]
    assert all(law_told(kind, name)["says"] not in ("", ITS_OWN) for kind, name in bundled)
    assert law_told("tyre", "brush")["says"] == ITS_OWN


@pytest.mark.parametrize(
    ("choice", "expected"),
    [
        (Choice(), ["tyre linear", "caster ideal", "wheel rolling"]),
        (Choice(tyre="dugoff", wheel="spinning"), ["tyre dugoff", "caster ideal", "wheel spinning"]),
        (Choice(equations="paper"), ["tyre linear", "equations paper"]),
    ],
)
def test_a_page_tells_the_laws_of_a_model(choice, expected):
    assert [f"{law['of']} {law['name']}" for law in laws_of(choice)] == expected
