"""One text, as Markdown and as LaTeX, whatever names files have."""

from __future__ import annotations

import re

import pytest

from wheelchair_fmu.report.latex import escaped
from wheelchair_fmu.report.paper.markup import cite, cited, code, latex, meaning, plain, symbols

NASTY = r"50% of_$x$ & {\input{/etc/passwd}} #1 ~^ `a` *b* [@Key] <i> | \\"


def well_formed(text: str) -> None:
    """Braces and dollars have partners, and no letter that is a command in LaTeX stands alone."""
    bare = re.sub(r"\\[\\%&#$_{}]", "", re.sub(r"(?m)^%.*$", "", text))
    depth = 0
    for c in bare:
        depth += (c == "{") - (c == "}")
        assert depth >= 0, text
    assert depth == 0 and bare.count("$") % 2 == 0, text
    outside = re.sub(r"\$[^$]*\$", "", re.sub(r"\\cite\{[^}]*\}", "", bare))
    assert not re.findall(r"[_%#^`~]", outside.replace("``", "")), outside


@pytest.mark.parametrize("text", [code(NASTY), plain(NASTY), symbols(NASTY), plain("a\x07b\nc")])
def test_names_from_files_are_no_markup(text):
    found = latex(f"It was {text} that {cite('Doria2016')} saw.")
    well_formed(found)
    assert r"\input" not in found and found.count(r"\cite") == 1


def test_a_text_becomes_latex():
    text = f"**Chair.** About 1 ± 2 N/m² and {code('tyre.C_lambda')} {cite('A1', 'B2')}: ½ of “it”, $10^{{-4}}$.\n\n**Runs.** δ"
    assert latex(text) == (
        r"\paragraph{Chair.} About 1 $\pm$ 2 N/m$^2$ and \texttt{tyre.C\_lambda} \cite{A1,B2}: $\frac12$ of ``it'', $10^{-4}$."
        "\n\n"
        r"\paragraph{Runs.} $\delta$"
    )
    assert cited(text) == ["A1", "B2"]


def test_symbols_are_mathematics_and_remarks_of_a_record_are_left_out():
    assert symbols("stiffness C_mλ of x_y_z") == r"stiffness $C_{m\lambda}$ of x\_y\_z"
    assert meaning("radius R; an axle torque M pushes with M/R") == "radius R"
    assert latex(meaning("rear tread t_r")) == r"rear tread $t_{r}$"


def test_what_latex_cannot_print_is_a_blank():
    assert escaped("a\x00b\\") == r"a b\textbackslash{}"
