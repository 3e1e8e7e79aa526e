"""Faults as the page says them."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

import wheelchair_fmu
from wheelchair_fmu.faults import WARNING, Fault, run_fault
from wheelchair_fmu.workbench.faults import CURES, told
from wheelchair_fmu.workbench.session import Session

PLACES = ("[columns]", "[noise]", "[[run", "constant =", " = {")  # of campaign.toml, which the page shows to nobody
BAD = b"Time,F_rl [N],speed,gyro_z\n" + b"\n".join(b"%.2f,1,2,3" % (i / 50) for i in range(40))


def test_a_cure_names_the_form_in_which_it_is_done() -> None:
    fault = run_fault(
        "a.csv", "no push force F_rl", "add a column 'F_rl [N]', name it in [columns], or write constant = ...", 1
    )
    assert told(fault)["text"] == (
        "a.csv: the push on the left wheel is missing; choose its column under “Columns and their units”, "
        "or say under “Runs” that nobody pushed"
    )
    assert told(fault)["file"] == "a.csv" and told(fault)["column"] is None
    note = Fault("campaign.toml", None, None, "all is well", "nothing is to be done")
    assert told(note)["text"] == "all is well"
    strange = Fault("campaign.toml", 3, None, "odd", "make it even")
    assert told(strange)["text"] == "campaign.toml line 3: odd; make it even"


@pytest.mark.parametrize(
    ("fact", "said"),
    [
        ("no u0 and no speed measured to take it from", "no speed at the start and no speed measured to take it from"),
        ("F_rl reaches 3000 N", "the push on the left wheel reaches 3000 N"),
        ("the baseline of F_rr cannot be told", "the baseline of the push on the right wheel cannot be told"),
        ("no column for yaw_rate, which [columns] renames", "no column for the yaw rate"),
        ("the header 'F_rl [N]' stands there 2 times", "the header 'F_rl [N]' stands there 2 times"),
    ],
)
def test_channels_are_called_by_words_but_for_what_stands_in_a_file(fact, said) -> None:
    assert told(run_fault("a.csv", fact, "nothing is to be done", 1))["what"] == said


def test_a_misspelt_column_is_asked_after_beside_it() -> None:
    cure = "correct the header, or name it in [columns]"
    fault = told(run_fault("a.csv", "it looks like a_y, but is not used", cure, 1, "ay [m/s2]", WARNING))
    said = "it looks like the sideways acceleration, but is not used; say what it is under “Columns and their units”"
    assert fault["what"] == said
    assert fault["column"] == "ay [m/s2]" and fault["file"] == "a.csv"


def test_a_heading_that_one_file_spells_otherwise_is_corrected_in_the_file() -> None:
    fact = "it is called 'v links' in 6 other files, and wheel_speed_l is not read from it"
    fault = told(run_fault("a.csv", fact, "correct the header in this file", 1, "v link", WARNING))
    said = fact.replace("wheel_speed_l", "the left wheel's speed")
    assert fault["what"] == f"{said}; correct it in the file, and drop the file here again"
    assert fault["column"] == "v link" and fault["file"] == "a.csv"


def test_faults_of_a_loggers_file_name_no_place_of_a_file_that_nobody_sees(tmp_path) -> None:
    session = Session.begin(tmp_path)
    (session.campaign / "odd.csv").write_bytes(BAD)
    (session.campaign / "empty.csv").write_bytes(b"")
    (session.campaign / "binary.csv").write_bytes(bytes(range(256)) * 4)
    session.draft()
    found, _ = session.judged({})
    assert len(found) > 5
    for fault in found:
        assert not any(place in fault["text"] for place in PLACES), fault["text"]


@cache
def sources() -> str:
    """All that may say a cure, but for the page's own words of them."""
    files = Path(wheelchair_fmu.__file__).parent.rglob("*.py")
    return "\n".join(f.read_text(encoding="utf-8") for f in files if f.parent.name != "workbench").replace('\\"', '"')


@pytest.mark.parametrize("pattern", [pattern for pattern, _ in CURES])
def test_what_the_page_says_in_other_words_is_a_cure_that_there_is(pattern) -> None:
    begins = re.sub(r"\\(.)", r"\1", pattern.partition(".*")[0].partition("F_r")[0]).rstrip(" '")
    assert len(begins) > 3 and begins in sources(), begins


@pytest.mark.parametrize("words", [words for _, words in CURES])
def test_a_cure_in_the_pages_words_is_a_plain_clause(words) -> None:
    assert words == words.strip() and not words.endswith(".") and "_" not in words


def test_a_campaign_has_the_name_of_the_folder_it_comes_from(tmp_path) -> None:
    session = Session.begin(tmp_path)
    session.draft("hall in may")
    assert session.name == "hall in may"
    session.draft("other")
    assert session.name == session.label == "hall in may"


def test_work_without_a_name_is_known_again_by_its_files(tmp_path) -> None:
    session = Session.begin(tmp_path)
    assert session.label == "campaign"
    for name in ("b.csv", "a.csv", "c.csv"):
        (session.campaign / name).write_bytes(BAD)
    assert session.label == "a.csv and 2 more"
