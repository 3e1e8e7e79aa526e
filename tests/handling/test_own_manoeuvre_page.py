"""docs/your-own-manoeuvre.md: its two files do what it says, and so does its table."""

from __future__ import annotations

import doctest

import pytest

from tests.pages import attempt, its_test_passes, page, run, with_example

PAGE = "your-own-manoeuvre.md"


def test_the_page_s_manoeuvre_passes_the_page_s_test(tmp_path):
    its_test_passes(PAGE, tmp_path)


@pytest.mark.nightly
def test_it_is_known_by_name(tmp_path):
    its_test_passes(PAGE, tmp_path)
    lanes = ("-m", "wheelchair_fmu", "simulate", "lane-change", "--period", "3", "--straight", "0.5")
    assert "out/lane-change.csv" in run(tmp_path, *lanes)


def test_a_table_is_enough():
    test = doctest.DocTestParser().get_doctest(page(PAGE).replace("```", ""), {}, PAGE, PAGE, 0)
    done = doctest.DocTestRunner().run(test)
    assert done.attempted == 4 and not done.failed


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--width", "2"), "lane-change has no --width; it takes --speed, --delta-force, --period, --straight, --time"),
        (("--straight", "long"), "--straight long: 'long' is no number; give one, as in --straight 1.5"),
    ],
)
def test_an_option_that_it_has_not_is_refused_in_a_sentence(tmp_path, words, says):
    with_example(PAGE, tmp_path)
    done = attempt(tmp_path, "-m", "wheelchair_fmu", "simulate", "lane-change", *words)
    assert done.returncode == 2 and done.stderr.strip() == says
