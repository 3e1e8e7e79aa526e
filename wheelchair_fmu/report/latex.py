"""Text for LaTeX, and estimates as a table in the style of the package booktabs."""

from __future__ import annotations

import re
from collections.abc import Iterable
from math import isfinite

from ..quantities import ONE
from .words import value_text

SPECIAL = {
    **{c: f"\\{c}" for c in "_%&#${}"},
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "`": r"\textasciigrave{}",
    "±": r"$\pm$",
    "−": "$-$",
    "×": r"$\times$",
    "·": r"$\cdot$",
    "²": "$^2$",
    "½": r"$\frac12$",
    "°": r"$^\circ$",
    "–": "--",
    "—": "---",
    "“": "``",
    "”": "''",
    "…": r"\dots{}",
    "\N{NO-BREAK SPACE}": "~",
    "\N{NARROW NO-BREAK SPACE}": r"\,",
}
GREEK = {
    **{"α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "varepsilon", "ζ": "zeta", "η": "eta", "θ": "theta"},
    **{"κ": "kappa", "λ": "lambda", "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi", "ρ": "rho", "σ": "sigma", "τ": "tau"},
    **{"φ": "varphi", "χ": "chi", "ψ": "psi", "ω": "omega", "Γ": "Gamma", "Δ": "Delta", "Λ": "Lambda", "Σ": "Sigma"},
    **{"Φ": "Phi", "Ψ": "Psi", "Ω": "Omega"},
}
POWER = re.compile(r"e([+-]?)0*(\d+)")

Row = tuple[str, float, float, float, float, str]


def escaped(text: str) -> str:
    """Any text as LaTeX has it: no letter is a command, Greek is mathematics, and control characters are blanks."""
    return "".join(_letter(c) for c in text)


def _letter(c: str) -> str:
    if c in GREEK:
        return rf"$\{GREEK[c]}$"
    return SPECIAL.get(c, c if c.isprintable() else " ")


def table(rows: Iterable[Row]) -> str:
    """A tabular of (name, estimate, standard error, lower, upper, unit), in SI units; NaN where there is none."""
    lines = [_line(*row) for row in rows]
    return "\n".join(
        [
            r"\begin{tabular}{lrrl}",
            r"\toprule",
            r"parameter & estimate & 95\,\% interval & unit \\",
            r"\midrule",
            *lines,
            r"\bottomrule",
            r"\end{tabular}",
            "",
        ]
    )


def _line(name: str, estimate: float, se: float, lower: float, upper: float, unit: str) -> str:
    value = _math(value_text(estimate, se if isfinite(se) else None, ONE))
    ends = _math(f"[{lower:.4g}, {upper:.4g}]") if isfinite(lower) and isfinite(upper) else "--"
    return rf"\texttt{{{escaped(name)}}} & {value} & {ends} & {unit_text(unit)} \\"


def _math(text: str) -> str:
    plain = text.replace("±", r"\pm").replace("−", "-")
    return "$" + POWER.sub(lambda found: rf" \times 10^{{{found[1].replace('+', '')}{found[2]}}}", plain) + "$"


def unit_text(unit: str) -> str:
    """A unit as FMI writes it, N.m/rad or m/s2, for LaTeX; a dash where there is none."""
    if unit == "1":
        return "--"
    return r"$\mathrm{" + re.sub(r"(?<=[a-z])(\d)", r"^{\1}", unit).replace(".", r"\,") + "}$"
