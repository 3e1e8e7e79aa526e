"""A kernel as C: CasADi's functions, and one record that names them for `advance.h`."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import casadi as cs

from . import rodas
from .inverses import dividing_once
from .kernel import NAMES, Kernel, seldom, switches
from .tangent import NAMES as TANGENT_NAMES
from .tangent import Tangent

CSRC = Path(__file__).parent / "csrc"
NOTHING = "0"  # instead of a function that nobody calls
RECORD = """
#include "advance.h"

static const double {prefix}_nominal[] = {{{nominal}}}, {prefix}_resting[] = {{{resting}}};
static const int {prefix}_seldom[] = {{{places}}}, {prefix}_switches[] = {{{switches}}};
WC_LOCAL const wc_kernel {prefix}_kernel = {{
    {states}, {inputs}, {parameters}, {outputs}, {prefix}_nominal, {seldom}, {prefix}_seldom, {prefix}_resting,
    {switched}, {prefix}_switches,
    {functions}}};
"""


TANGENT_RECORD = """
#include "tangent.h"

static const int {prefix}_rows[] = {{{rows}}}, {prefix}_places[] = {{{places}}}, {prefix}_touched[] = {{{touched}}};
const wc_tangent {prefix}_tangent = {{
    {columns}, {sensors}, {prepared}, {side}, {touches}, {prefix}_touched, {prefix}_rows, {prefix}_places,
    {functions}}};
"""


def c_source(kernel: Kernel, prefix: str, by_hand: Mapping[str, str] | None = None) -> str:
    """C text that defines `const wc_kernel <prefix>_kernel`, and no other name without the prefix.

    `by_hand` names C functions that stand for some of the kernel's.
    """
    model = kernel.model
    by_hand = {name: NOTHING for name in NAMES if name not in kernel.functions} | dict(by_hand or {})
    names = [name for name in NAMES if name not in by_hand]
    text = _generated(kernel.functions, names, prefix) + _declared(by_hand)
    nominal = [s.nominal for s in model.states for _ in s.names]
    places, off = seldom(model), switches(model)
    return text + RECORD.format(
        prefix=prefix,
        nominal=", ".join(map(repr, nominal)) or "0",
        states=model.x.numel(),
        inputs=model.w.numel(),
        parameters=model.p.numel(),
        outputs=model.y.numel(),
        seldom=len(places),
        places=", ".join(map(str, places)) or "0",
        resting=", ".join(repr(model.inputs[i].start) for i in places) or "0",
        switched=len(off),
        switches=", ".join(map(str, off)) or "0",
        functions=", ".join(by_hand.get(name, f"{prefix}_{name}") for name in NAMES),
    )


def tangent_source(tangent: Tangent, prefix: str, by_hand: Mapping[str, str] | None = None, side: int = 1) -> str:
    """C text that defines `const wc_tangent <prefix>_tangent`; `by_hand` as in `c_source`, `side` as in `tangent.h`."""
    by_hand = by_hand or {}
    names = [name for name in TANGENT_NAMES if name not in by_hand]
    return (
        _generated(tangent.functions, names, prefix)
        + _declared(by_hand)
        + TANGENT_RECORD.format(
            prefix=prefix,
            rows=", ".join(map(str, tangent.rows)),
            places=", ".join(map(str, tangent.places)) or "0",
            columns=len(tangent.columns),
            sensors=len(tangent.rows),
            prepared=max(tangent.length(name) for name in ("prepare", "prepare_all")),
            side=side,
            touches=len(tangent.touched),
            touched=", ".join(map(str, tangent.touched)) or "0",
            functions=", ".join(by_hand.get(name, f"{prefix}_{name}") for name in TANGENT_NAMES),
        )
    )


def _declared(by_hand: Mapping[str, str]) -> str:
    return "".join(
        f"extern int {name}(const double **, double **, long long *, double *, int);\n"
        for name in by_hand.values()
        if name != NOTHING
    )


def coefficients() -> str:
    """The method's coefficients as C, for `tangent.c`."""

    def numbers(name: str, values: tuple[float, ...]) -> str:
        return f"static const double wc_{name}[6] = {{{', '.join(map(repr, values))}}};\n"

    def triangle(name: str, rows: tuple[tuple[float, ...], ...]) -> str:
        lines = ",\n".join("    {" + (", ".join(map(repr, row)) or "0") + "}" for row in rows)
        return f"static const double wc_{name}[6][6] = {{\n{lines}}};\n"

    return (
        f"static const double wc_GAMMA = {rodas.GAMMA!r};\n"
        + numbers("ALPHA", rodas.ALPHA)
        + numbers("GAMMA_I", rodas.GAMMA_I)
        + numbers("DENSE_2", rodas.DENSE_2)
        + numbers("DENSE_3", rodas.DENSE_3)
        + triangle("A", rodas.A)
        + triangle("C", rodas.C)
    )


def _generated(functions: dict[str, cs.Function], names: Sequence[str], prefix: str) -> str:
    # Not a header: the functions are seen by the record that follows and by nobody else.
    generator = cs.CodeGenerator(f"{prefix}.c", {"with_header": False})
    for name in names:
        generator.add(dividing_once(functions[name], f"{prefix}_{name}"))
    return _in_place(
        _unchecked(generator.dump())
    )  # a file that it writes may be cut off where the disk is full, without a word


def _unchecked(text: str) -> str:
    """Functions whose arguments and results are all there: CasADi asks for each number anew, which takes compilers a third of
    their time."""
    return re.sub(r"if \(res\[\d+\]!=0\) ", "", re.sub(r"(arg\[\d+\])\? (\1\[\d+\]) : 0", r"\2", text))


def _in_place(text: str) -> str:
    """Squares and larger numbers where they stand: in a long function compilers call CasADi's own for each, and put away
    all numbers at hand before."""
    squared = re.sub(r"casadi_sq\((\w+)\)", r"(\1*\1)", text)
    return re.sub(r"casadi_fmax\((\w+),(\w+)\)", r"(\1>\2?\1:\2)", squared)
