"""The generated C: kernels, and the tables that fmu_src/model.h asks for."""

from __future__ import annotations

import re
from collections.abc import Iterable
from math import isinf

import casadi as cs

from ..engine.kernel import crossings
from ..errors import BuildError
from ..model.wheelchair import Model
from .variables import GRID, TOLERANCE, Interface, Variable

LIMITS = {"parameters": 256, "outputs": 128, "states": 32, "inputs": 32, "crossings": 8}  # as in model.h and advance.h


def generate(face: Interface) -> dict[str, str]:
    """C files by name, all but the tables, which need the token that depends on these."""
    _refuse_too_large(face.model)
    texts = [*(face.c_source(law) for law in face.models), _rules(face.model)]
    return dict(zip(names(face), map(_hidden, texts), strict=True))


def names(face: Interface) -> list[str]:
    """What `generate` makes."""
    return [*kernels(face), "rules.c"]


def kernels(face: Interface) -> list[str]:
    """Those with the equations of one law each, and its kernel."""
    return [f"{law}.c" for law in face.models]


def _hidden(text: str) -> str:
    """CasADi's own helpers are seen outside of their file, unlike all else."""
    return re.sub(r"^(?=casadi_real casadi_)", "static ", text, flags=re.MULTILINE)


def _refuse_too_large(m: Model) -> None:
    sizes = {"parameters": m.p, "outputs": m.y, "states": m.x, "inputs": m.w, "crossings": crossings(m)}
    for what, symbol in sizes.items():
        if symbol.numel() > LIMITS[what]:
            raise BuildError(
                f"the model has {symbol.numel()} {what}, more than the {LIMITS[what]} that an instance "
                f"holds; raise WC_MAX_{what.upper()}"
            )


def _rules(m: Model) -> str:
    """How the states at the start change along changes of parameters and inputs."""
    dp, dw = cs.SX.sym("dp", m.p.numel()), cs.SX.sym("dw", m.w.numel())
    dx = cs.densify(cs.jtimes(m.start, cs.vertcat(m.p, m.w), cs.vertcat(dp, dw)))
    generator = cs.CodeGenerator("rules.c", {"with_header": False})
    generator.add(cs.Function("wc_start_forward", [m.p, m.w, dp, dw], [dx]))
    return str(generator.dump())


def tables(face: Interface, name: str, token: str) -> str:
    """model_data.c: `model`, from what the generated files before it define."""
    laws = ", ".join(f"&{law}_kernel" if law in face.models else "0" for law in face.choices)
    chooser = face.by_name[face.chooser].index if face.chooser else -1
    return "\n".join(
        [
            '#include "model.h"',
            "",
            "#include <math.h>",
            "",
            *(_choices(v) for v in face.variables if v.choices),
            *_array("wc_variable", "variables", map(_variable, face.variables)),
            *_array("wc_jump", "jumps", (f"{{{j.parameter.index}, {j.mode.index}, {j.when}, {j.state}}}" for j in face.jumps)),
            *(
                f"static const double limits_{i}[] = {{{', '.join(map(_number, w.limits))}}};"
                for i, w in enumerate(face.watches)
            ),
            *_array(
                "wc_watch",
                "watches",
                (
                    f"{{{w.variables[0].reference}, {len(w.variables)}, limits_{i}, {w.guard.index if w.guard else -1}, "
                    f"{_number(w.guard_limit)}, {_string(w.meaning)}}}"
                    for i, w in enumerate(face.watches)
                ),
            ),
            *_array("wc_idle", "idles", (f"{{{i.input.reference}, {i.parameter.reference}}}" for i in face.idles)),
            *_array(
                "wc_state", "states", (f"{{{place}, {v.reference}, {_number(v.nominal)}}}" for place, v in face.states.items())
            ),
            *_array("int", "crossings", (str(v.index) for v in face.of("output") if v.type == "Boolean")),
            f"static const wc_kernel *const kernels[] = {{{laws}}};",
            "",
            "static const wc_model the_model = {",
            f"    {_string(name)}, {_string(token)}, {len(face.variables)}, variables, kernels,",
            f"    {chooser}, wc_start_forward, {len(face.jumps)}, jumps, {len(face.watches)}, "
            f"watches, {len(face.idles)}, idles, {_number(TOLERANCE)}, {_number(GRID)},",
            f"    {len(face.states)}, states, {len(face.of('indicator'))}, crossings}};",
            "static const wc_model *const model = &the_model;",
            "",
        ]
    )


def _choices(v: Variable) -> str:
    words = ", ".join(map(_string, v.choices))
    return f"static const char *const choices_{v.reference}[] = {{{words}}};"


def _array(kind: str, name: str, rows: Iterable[str]) -> list[str]:
    # Standard C knows no empty array: one row of zeros, which the count beside it leaves out.
    filled = list(rows) or ["0" if kind == "int" else "{0}"]
    return [f"static const {kind} {name}[] = {{", *(f"    {row}," for row in filled), "};"]


def _variable(v: Variable) -> str:
    start = 0.0 if v.start is None else v.start
    return (
        f"{{{_string(v.name)}, {_string(v.unit.name)}, WC_{v.kind.upper()}, WC_{v.type.upper()}, {v.index}, "
        f"{int(v.fixed)}, {_number(start)}, {_number(v.lower)}, {_number(v.upper)}, "
        f"{f'choices_{v.reference}' if v.choices else '0'}}}"
    )


def _number(value: float) -> str:
    return ("-" if value < 0 else "") + "INFINITY" if isinf(value) else repr(float(value))


def _string(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
