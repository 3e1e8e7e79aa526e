"""What every law keeps; and that a law which does not is told so, with the fact and the cure."""

from __future__ import annotations

import re

import pytest

from tests.pages import BLOCK, page
from wheelchair_fmu.contracts.of_laws import law_breaches
from wheelchair_fmu.model.choice import KINDS, Choice, OwnLaw, names

BRUSH = dict(BLOCK.findall(page("your-own-law.md")))["laws/tyre/brush.py"]


def breaches(kind: str, name: str, text: str) -> list[str]:
    choice = Choice(own=(OwnLaw(kind, name, text, f"{name}.py"),)).with_laws({kind: name})
    return [str(breach) for breach in law_breaches(kind, choice)]


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind in KINDS for name in names()[kind]])
def test_the_bundled_laws_keep_them(kind, name):
    assert law_breaches(kind, Choice().with_laws({kind: name})) == []


def test_the_page_s_law_keeps_them():
    assert breaches("tyre", "brush", BRUSH) == []


@pytest.mark.parametrize(
    ("was", "becomes", "says"),
    [
        ("return -k_M * cs.tan", "return -k_F * cs.tan", "units: its M_lam comes out in N where N.m belongs"),
        ("return 3 * cs.fmax", "return -3 * cs.fmax", "passive: at a slip angle of .* let the force have the sign of the slip"),
        ("return -k_M * cs.tan(lam_F)", "return -k_M * cs.tan(lam_F + 0.01)", "neutral without slip: at a slip angle of 0 rad"),
        ("k_F * cs.tan(lam)", "k_F * cs.sqrt(cs.fabs(lam))", "finite at standstill: off and at rest, the slope of"),
        ('define("M_lam"', 'define("M_other"', "equations: .*reads 'M_lam'"),
        ("theta * theta / 3)", "theta * theta / 3) * cs.DM([1, 1.1])", "mirror: in a mirror along the chair"),
        ("    theta = share(", "    if k_F > 0: pass\n    theta = share(", "equations: it fails: "),
    ],
)
def test_a_tyre_law_that_breaks_one_is_told(was, becomes, says):
    assert was in BRUSH
    told = breaches("tyre", "brush", BRUSH.replace(was, becomes))
    assert told and all(line.startswith("tyre law brush, ") for line in told)
    assert any(re.search(says, line) for line in told), told


DRIVEN = """
from . import ideal
from ..stage import Alternative, Stage


def casters(v_xf, v_yf, D_f, d_f, M_w, M_p, rolling, trail, drag_eps, v_onset):
    F_xf, F_yf, M_f = ideal.casters.law(v_xf, v_yf, D_f, d_f, M_w, M_p, rolling, trail, drag_eps, v_onset)
    return -F_xf, F_yf, M_f


LAW = Alternative(
    "driven", (ideal.angles, ideal.patches, ideal.torques, Stage(casters, ideal.casters.defines)), ideal.PARAMETERS
)
"""


def test_a_caster_law_that_drives_the_chair_is_told():
    assert breaches("caster", "driven", DRIVEN.replace("return -F_xf", "return F_xf")) == []
    (told,) = breaches("caster", "driven", DRIVEN)
    assert told.startswith("caster law driven, energy: ") and "the casters give the chair" in told
