"""A kernel as C: CasADi's functions, and one record that names them for `advance.h`."""

from __future__ import annotations

import tempfile
from pathlib import Path

import casadi as cs

from .kernel import NAMES, Kernel

CSRC = Path(__file__).parent / "csrc"
RECORD = """
#include "advance.h"

static const double {prefix}_nominal[] = {{{nominal}}};
const wc_kernel {prefix}_kernel = {{
    {states}, {inputs}, {parameters}, {outputs}, {prefix}_nominal,
    {functions}}};
"""


def c_source(kernel: Kernel, prefix: str) -> str:
    """C text that defines `const wc_kernel <prefix>_kernel`, and no other name without the prefix."""
    model = kernel.model
    # Not a header: the functions are seen by the record below and nobody else.
    generator = cs.CodeGenerator(f"{prefix}.c", {"with_header": False})
    for name in NAMES:
        generator.add(_renamed(kernel.functions[name], f"{prefix}_{name}"))
    with tempfile.TemporaryDirectory() as folder:
        text = Path(generator.generate(folder + "/")).read_text()
    nominal = [s.nominal for s in model.states for _ in s.names]
    return text + RECORD.format(
        prefix=prefix,
        nominal=", ".join(map(repr, nominal)),
        states=model.x.numel(),
        inputs=model.w.numel(),
        parameters=model.p.numel(),
        outputs=model.y.numel(),
        functions=", ".join(f"{prefix}_{name}" for name in NAMES),
    )


def _renamed(function: cs.Function, name: str) -> cs.Function:
    inputs = function.sx_in()
    return cs.Function(name, inputs, function.call(inputs))
