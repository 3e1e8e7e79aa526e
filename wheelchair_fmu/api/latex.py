"""Estimates as a LaTeX table, in the style of the package booktabs."""

from __future__ import annotations

import re
from collections.abc import Iterable
from math import isfinite

from ..quantities import ONE
from ..report.words import value_text

SPECIAL = re.compile(r"([_%&#])")
POWER = re.compile(r"e([+-]?)0*(\d+)")

Row = tuple[str, float, float, float, float, str]


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
    shown = SPECIAL.sub(r"\\\1", name)
    return rf"\texttt{{{shown}}} & {value} & {ends} & {_unit(unit)} \\"


def _math(text: str) -> str:
    plain = text.replace("±", r"\pm").replace("−", "-")
    return "$" + POWER.sub(lambda found: rf" \times 10^{{{found[1].replace('+', '')}{found[2]}}}", plain) + "$"


def _unit(unit: str) -> str:
    """As FMI writes units: N.m/rad, m/s2."""
    if unit == "1":
        return "--"
    return r"$\mathrm{" + re.sub(r"(?<=[a-z])(\d)", r"^{\1}", unit).replace(".", r"\,") + "}$"
