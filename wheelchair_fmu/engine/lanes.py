"""CasADi functions as C over lanes: the same operations in the same order as `source` writes them, each for several chairs."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import casadi as cs

from ..errors import BuildError
from .inverses import dividing_once
from .tangent import Tangent

HEADER = '#include "lanes.h"\n'
OPERATIONS = {
    cs.OP_ASSIGN: "{0}",
    cs.OP_ADD: "{0} + {1}",
    cs.OP_SUB: "{0} - {1}",
    cs.OP_MUL: "{0} * {1}",
    cs.OP_DIV: "{0} / {1}",
    cs.OP_NEG: "-{0}",
    cs.OP_SQ: "{0} * {0}",
    cs.OP_TWICE: "2 * {0}",
    cs.OP_INV: "1 / {0}",
    cs.OP_LT: "WC_TRUE({0} < {1})",
    cs.OP_LE: "WC_TRUE({0} <= {1})",
    cs.OP_EQ: "WC_TRUE({0} == {1})",
    cs.OP_NE: "WC_TRUE({0} != {1})",
    cs.OP_NOT: "WC_TRUE({0} == 0)",
    cs.OP_AND: "WC_TRUE(({0} != 0) & ({1} != 0))",
    cs.OP_OR: "WC_TRUE(({0} != 0) | ({1} != 0))",
    cs.OP_IF_ELSE_ZERO: "WC_BITS({0} != 0, {1})",
}
OF_ONE = ("sqrt", "fabs", "sign", "sin", "cos", "atan", "exp", "log")  # lanes.h has them
OF_TWO = ("fmax", "fmin", "copysign", "atan2")
ANEW = ("tan", "asin", "acos", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "floor", "ceil", "erf")  # lane by lane
ANEW_OF_TWO = ("pow", "fmod")
OPERATIONS |= {getattr(cs, f"OP_{name.upper()}"): f"lanes_{name}({{0}})" for name in OF_ONE}
OPERATIONS |= {getattr(cs, f"OP_{name.upper()}"): f"lanes_{name}({{0}}, {{1}})" for name in OF_TWO}
OPERATIONS |= {getattr(cs, f"OP_{name.upper()}"): f"lanes_anew(WC_ALL, {{0}}, {name}, {{0}})" for name in ANEW}
OPERATIONS |= {getattr(cs, f"OP_{name.upper()}"): f"lanes_anew2(WC_ALL, {{0}}, {name}, {{0}}, {{1}})" for name in ANEW_OF_TWO}
STAGEWISE = {"slopes_all": (2,), "bend_all": (0,)}  # what is the same for all stages: parameters, what was prepared
OPERATIONS[cs.OP_CONSTPOW] = OPERATIONS[cs.OP_POW]


def lanes_source(functions: Mapping[str, cs.Function], same: Mapping[str, Container[int]] = MappingProxyType({})) -> str:
    """C text that defines `void lanes_<name>(const lanes **arg, lanes **res)`, whose arguments and results are all there.

    `same`: by the function's name, arguments that are single numbers, the same in each lane.
    """
    written = (_written(dividing_once(f, name), name, same.get(name, ())) for name, f in functions.items())
    return f"{HEADER}{''.join(written)}"


def in_two(function: cs.Function, name: str, resting: Container[int]) -> str:
    """C text of a function that is called again and again while its `resting` arguments are the same: what follows from these
    alone is `void lanes_<name>_once(const lanes **arg, lanes *kept)`, of `lanes_<name>_kept` numbers, and the rest `void
    lanes_<name>(const lanes **arg, lanes **res, const lanes *kept)`. Results are to the bit those of `lanes_source`."""
    steps = list(_steps(dividing_once(function, name), name, ()))
    moves: dict[int, bool] = {}
    for s in steps:
        moves[s.place] = s.result or (any(moves[i] for i in s.of) if s.argument is None else s.argument not in resting)
    constants = {s.place for s in steps if s.constant}
    kept = sorted({i for s in steps if moves[s.place] for i in s.of if not moves[i]} - constants)
    once, again = ([s.text for s in steps if moves[s.place] is moving or s.constant] for moving in (False, True))
    once += [f"kept[{n}] = a{i};" for n, i in enumerate(kept)]
    again = [f"lanes a{i} = kept[{n}];" for n, i in enumerate(kept)] + again
    return (
        f"{HEADER}const int lanes_{name}_kept = {len(kept)};\n"
        + _function(f"lanes_{name}_once(const lanes **arg, lanes *kept)", once)
        + _function(f"lanes_{name}(const lanes **arg, lanes **res, const lanes *kept)", again)
    )


def of_stages(tangent: Tangent, prefix: str) -> tuple[str, dict[str, str]]:
    """C text with those of a tangent's functions that are evaluated stage by stage, of several stages at once; and their names,
    which stand `by_hand` in its record."""
    functions = {name: tangent.functions[name] for name in STAGEWISE}
    names = {name: f"{prefix}_{name}_of_stages" for name in functions}
    doors = "".join(
        f"int {names[name]}(const double **arg, double **res, long long *iw, double *w, int mem) {{\n"
        f"    (void)iw, (void)w, (void)mem;\n    lanes_{name}((const lanes **)arg, (lanes **)res);\n    return 0;\n}}\n"
        for name in functions
    )
    return lanes_source(functions, STAGEWISE) + doors, names


@dataclass(frozen=True)
class _Step:
    """One line of C: the number of its instruction, the numbers of those it is made of, or which argument it reads."""

    text: str
    place: int
    of: tuple[int, ...] = ()
    argument: int | None = None
    result: bool = False

    @property
    def constant(self) -> bool:
        return not self.of and self.argument is None


def _written(function: cs.Function, name: str, same: Container[int]) -> str:
    return _function(f"lanes_{name}(const lanes **arg, lanes **res)", [s.text for s in _steps(function, name, same)])


def _function(head: str, lines: Iterable[str]) -> str:
    body = "".join(f"    {line}\n" for line in lines)
    return f"void {head} {{\n{body}}}\n"


def _steps(function: cs.Function, name: str, same: Container[int]) -> Iterator[_Step]:
    at: dict[int, int] = {}
    for k in range(function.n_instructions()):
        op, given, to = function.instruction_id(k), function.instruction_input(k), function.instruction_output(k)
        argument: int | None = None
        of: tuple[int, ...] = ()
        if op == cs.OP_OUTPUT:
            yield _Step(f"res[{to[0]}][{to[1]}] = a{at[given[0]]};", k, (at[given[0]],), result=True)
            continue
        if op == cs.OP_INPUT:
            argument, place = given[0], f"[{given[0]}]"
            value = f"WC_EVEN(((const double *)arg{place})[{given[1]}])" if given[0] in same else f"arg{place}[{given[1]}]"
        elif op == cs.OP_CONST:
            value = f"WC_EVEN({float(function.instruction_constant(k))!r})"
        elif op in OPERATIONS:
            of = tuple(at[i] for i in given)
            value = OPERATIONS[op].format(*(f"a{i}" for i in of))
        else:
            raise BuildError(f"{name}: operation {op} of CasADi has no form over lanes; simulate this model chair by chair")
        at[to[0]] = k
        yield _Step(f"lanes a{k} = {value};", k, of, argument)
