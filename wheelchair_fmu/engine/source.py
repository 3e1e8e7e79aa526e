"""A kernel as C: CasADi's functions, and one record that names them for `advance.h`."""

from __future__ import annotations

import tempfile
from pathlib import Path

import casadi as cs

from . import rodas
from .kernel import NAMES, Kernel
from .tangent import NAMES as TANGENT_NAMES
from .tangent import Tangent

CSRC = Path(__file__).parent / "csrc"
RECORD = """
#include "advance.h"

static const double {prefix}_nominal[] = {{{nominal}}};
const wc_kernel {prefix}_kernel = {{
    {states}, {inputs}, {parameters}, {outputs}, {prefix}_nominal,
    {functions}}};
"""


TANGENT_RECORD = """
#include "tangent.h"

static const int {prefix}_rows[] = {{{rows}}};
const wc_tangent {prefix}_tangent = {{
    {columns}, {sensors}, {curvatures}, {prefix}_rows,
    {functions}}};
"""


def c_source(kernel: Kernel, prefix: str) -> str:
    """C text that defines `const wc_kernel <prefix>_kernel`, and no other name without the prefix."""
    model = kernel.model
    text = _generated(kernel.functions, NAMES, prefix)
    nominal = [s.nominal for s in model.states for _ in s.names]
    return text + RECORD.format(
        prefix=prefix,
        nominal=", ".join(map(repr, nominal)) or "0",
        states=model.x.numel(),
        inputs=model.w.numel(),
        parameters=model.p.numel(),
        outputs=model.y.numel(),
        functions=", ".join(f"{prefix}_{name}" for name in NAMES),
    )


def tangent_source(tangent: Tangent, prefix: str) -> str:
    """C text that defines `const wc_tangent <prefix>_tangent`."""
    return _generated(tangent.functions, TANGENT_NAMES, prefix) + TANGENT_RECORD.format(
        prefix=prefix,
        rows=", ".join(map(str, tangent.rows)),
        columns=len(tangent.columns),
        sensors=len(tangent.rows),
        curvatures=tangent.length("curvature_all"),
        functions=", ".join(f"{prefix}_{name}" for name in TANGENT_NAMES),
    )


def coefficients() -> str:
    """The method's coefficients as C, for `tangent.c`."""

    def numbers(name: str, values: tuple[float, ...]) -> str:
        return f"static const double wc_{name}[6] = {{{', '.join(map(repr, values))}}};\n"

    def triangle(name: str, rows: tuple[tuple[float, ...], ...]) -> str:
        lines = ",\n".join("    {" + (", ".join(map(repr, row)) or "0") + "}" for row in rows)
        return f"static const double wc_{name}[6][6] = {{\n{lines}}};\n"

    return (f"static const double wc_GAMMA = {rodas.GAMMA!r};\n" + numbers("ALPHA", rodas.ALPHA)
            + numbers("GAMMA_I", rodas.GAMMA_I) + triangle("A", rodas.A) + triangle("C", rodas.C))  # fmt: skip


def _generated(functions: dict[str, cs.Function], names: tuple[str, ...], prefix: str) -> str:
    # Not a header: the functions are seen by the record that follows and by nobody else.
    generator = cs.CodeGenerator(f"{prefix}.c", {"with_header": False})
    for name in names:
        generator.add(_renamed(functions[name], f"{prefix}_{name}"))
    with tempfile.TemporaryDirectory() as folder:
        return Path(generator.generate(folder + "/")).read_text()


def _renamed(function: cs.Function, name: str) -> cs.Function:
    inputs = function.sx_in()
    return cs.Function(name, inputs, function.call(inputs))
