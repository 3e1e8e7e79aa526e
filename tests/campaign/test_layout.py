"""Comments and layout of a campaign.toml outlast a change of its content."""

from __future__ import annotations

import tomllib
from difflib import ndiff
from pathlib import Path

import pytest

pytest.importorskip("tomlkit", reason="the workbench's libraries are not installed")
from hypothesis import given, settings
from hypothesis import strategies as st

from wheelchair_fmu.campaign.layout import relaid

SAMPLE = (Path(__file__).parents[2] / "examples" / "sample-campaign" / "campaign.toml").read_text(encoding="utf-8")
ODD = """# ours
campaign.name = "a"   # dotted
chair = { m = 80, "b" = 0.2 }   # inline

[tyre]
C_lambda = 5_000.0   # rig
[[run]]   # first
file = "a.csv"
set = { "chair.m" = 90 }   # heavy
[[run]]
file = "a.csv"
  from   =   3.0   # odd

# the second day
[[run]]
file = "b.csv"
[run.set]
"start.psi" = 1
[tyre.force]
C = 1.3
# end
"""


def changed(text: str, content) -> tuple[set[str], set[str]]:
    """Lines taken out, and put in."""
    lines = list(ndiff(text.splitlines(), relaid(text, content).splitlines()))
    out, into = ({line[2:] for line in lines if line[0] == sign} for sign in "-+")
    return out, into


@pytest.mark.parametrize("text", [SAMPLE, ODD, SAMPLE.replace("\n", "\r\n"), "# nothing yet\n", ""])
def test_the_same_content_is_the_same_text(text):
    assert relaid(text, tomllib.loads(text)) == text


def test_only_the_lines_that_change_do():
    content = tomllib.loads(SAMPLE)
    content["chair"]["m"] = 80  # as JavaScript writes 80.0
    content["noise"]["yaw_rate"] = "0.5 deg/s"
    content["run"][0]["u0"] = 0.35
    del content["noise"]["a_x"]
    about = "   # m/s at the first sample, about"
    assert changed(SAMPLE, content) == (
        {"yaw_rate = 0.006", "a_x = 0.05", f"u0 = 0.3{about}"},
        {'yaw_rate = "0.5 deg/s"', f"u0 = 0.35{about}"},
    )


def test_runs_come_and_go():
    content = tomllib.loads(ODD)
    content["run"] = [*content["run"][:2], {"file": "c.csv", "role": "fit"}]
    assert changed(ODD, content) == ({'file = "b.csv"', "[run.set]", '"start.psi" = 1'}, {"", 'file = "c.csv"', 'role = "fit"'})


def test_new_tables_come_last():
    content = {**tomllib.loads(SAMPLE), "prior": {"chair": {"m": 2.0}}}
    assert changed(SAMPLE, content) == (set(), {"", "[prior.chair]", "m = 2.0"})


leaves = st.none() | st.booleans() | st.integers(0, 3) | st.just("text")
names = st.sampled_from(["campaign", "name", "chair", "m", "tyre", "force", "run", "file", "set", "x.y"])
values = st.recursive(leaves, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(names, inner))


@settings(deadline=None)  # how long it takes is nobody's fault
@given(st.sampled_from([SAMPLE, ODD]), st.dictionaries(names, values), st.data())
def test_whatever_comes_is_what_is_written(text, more, data):
    """Some of what was there, and anything besides: the content goes before the layout."""
    content = tomllib.loads(text)
    content = {key: content[key] for key in data.draw(st.sets(st.sampled_from(sorted(content))))} | more
    if "None" in repr(content):
        with pytest.raises(TypeError):
            relaid(text, content)
    else:
        assert tomllib.loads(relaid(text, content)) == content
