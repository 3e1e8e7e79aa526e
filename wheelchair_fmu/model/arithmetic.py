"""What an expression may be: text becomes a checked tree, and the tree a value. Text is never run as code.

The grammar is Python's, of which only arithmetic passes; everything has a limit, so that whatever was typed ends soon.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Callable, Mapping
from copy import deepcopy
from dataclasses import dataclass
from math import isfinite
from typing import Any

import casadi as cs
import numpy as np

from ..errors import UsageError
from ..quantities import UNITS
from ..units import UnitError, coherent
from .smooth import direction, grip, magnitude

LONGEST = 2000  # characters of an expression
MOST_NODES = 600  # numbers, names, operators and calls in it
DEEPEST = 60  # of them within each other
MOST_EXPONENT = 64  # where the exponent is a number
MOST_COMPONENTS = 16
FUNCTIONS: dict[str, tuple[Callable[..., Any], int]] = {
    **{name: (getattr(cs, name), 1) for name in ("sin", "cos", "tan", "atan", "exp", "log", "sqrt", "tanh", "fabs", "sum1")},
    **{name: (getattr(cs, name), 2) for name in ("atan2", "fmin", "fmax")},
    "abs": (cs.fabs, 1),  # as most people write these three
    "min": (cs.fmin, 2),
    "max": (cs.fmax, 2),
    "vertcat": (cs.vertcat, 0),
    "magnitude": (magnitude, 2),
    "direction": (direction, 2),
    "grip": (grip, 3),
}
"""Each with how many values it takes; 0 stands for one or more."""
ALLOWED = (
    ast.Expression,
    ast.BinOp,
    ast.UnaryOp,
    ast.Call,
    ast.Name,
    ast.Load,
    ast.Constant,
    ast.Subscript,
    ast.Add,
    ast.Sub,
    ast.Mult,
    ast.Div,
    ast.Pow,
    ast.USub,
    ast.UAdd,
)
NUMBER = r"(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.]))"
TOKEN = re.compile(rf"{NUMBER}|[A-Za-z_]\w*|\*\*|[-+*/(),.\[\]]|[ \t]+", re.ASCII)
SIGNS = {ord(sign): plain for sign, plain in {"−": "-", "×": "*", "·": "*"}.items()}  # as they are set in print
INSTEAD = {
    "^": "write ** for a power, as in u**2",
    "²": "write **2 for a square",
    "³": "write **3 for a cube",
    "|": "write abs(...)",
}
BESIDE = re.compile(r"[\w)] +[\w(]|\d[A-Za-z_(]|\)[\w(]")  # what has no sign between
BRACKET = re.compile(r"[ \t]*\[([^\[\]]*)\]")


@dataclass(frozen=True)
class Number:
    """A number with a unit behind it: in SI, with its exponents of kg, m, s, and as it was written."""

    value: float
    unit: str
    exponents: tuple[int, int, int]
    written: str


Numbers = Mapping[int, Number]  # by their place in the text, which is the col_offset of their node


def parsed(text: str) -> tuple[ast.expr, Numbers]:
    """The tree of an expression in which nothing but arithmetic can be, and its numbers that have units.

    Raises UsageError with the reason in a sentence.
    """
    text = text.strip().translate(SIGNS)
    if len(text) > LONGEST:
        raise UsageError(f"an expression of {len(text)} characters is too long; write it in {LONGEST} at most")
    plain, numbers = _without_units(text)
    try:
        tree = ast.parse(plain, mode="eval").body
    except SyntaxError as error:
        where = _where(error, plain)
        raise UsageError(f"{shown(text)} is no expression: {where}") from None
    except (RecursionError, MemoryError):
        raise _too_deep(text) from None
    except ValueError as error:  # Python's, for an integer of thousands of digits
        raise UsageError(f"{shown(text)} is no expression: {error}") from None
    _within_limits(tree, text)
    for node in ast.walk(tree):
        _check(node, text)
    _varies(tree, {place: number.value for place, number in numbers.items()}, text)
    return tree, numbers


def _where(error: SyntaxError, plain: str) -> str:
    """What is wrong, and at which place; between two names or numbers a sign lacks."""
    if not error.offset:
        return "it breaks off at its end"
    if BESIDE.search(plain):
        return "between two numbers or names a sign is missing, as * in q * u, or a unit has no brackets, as in 3 [km/h]"
    return f"{error.msg} at place {error.offset}"


def shown(text: str) -> str:
    """A text in quotes as messages have it, cut where it is long."""
    return repr(text if len(text) <= 80 else f"{text[:77]}...")


def names(tree: ast.expr) -> tuple[str, ...]:
    """The quantities that an expression names, in the order of its text."""
    called = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    found = [node for node in ast.walk(tree) if isinstance(node, ast.Name) and id(node) not in called]
    return tuple(dict.fromkeys(node.id for node in sorted(found, key=lambda node: node.col_offset)))


def written(node: ast.expr, words: Mapping[int, str]) -> str:
    """The text of a checked tree, with these words for the numbers that have units, by their place."""

    class Worded(ast.NodeTransformer):
        def visit_Constant(self, node: ast.Constant) -> ast.expr:
            return ast.Name(words[node.col_offset]) if node.col_offset in words else node

    return ast.unparse(Worded().visit(deepcopy(node)))


def value(node: ast.expr, known: Mapping[str, Any], numbers: Mapping[int, Any]) -> Any:
    """The value of a checked tree, where names and numbers with units have these values."""
    match node:
        case ast.Constant(value=float() | int() as number):
            return numbers.get(node.col_offset, float(number))
        case ast.Name(id=name):
            return known[name]
        case ast.UnaryOp(op=op, operand=operand):
            inner = value(operand, known, numbers)
            return -inner if isinstance(op, ast.USub) else inner
        case ast.BinOp(left=left, op=op, right=right):
            return _combined(op, value(left, known, numbers), value(right, known, numbers))
        case ast.Subscript(value=whole, slice=ast.Constant(value=int() as place)):
            return value(whole, known, numbers)[place]
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return FUNCTIONS[name][0](*(value(a, known, numbers) for a in arguments))
    raise TypeError(f"{type(node).__name__} in a checked expression")


def _combined(op: ast.operator, a: Any, b: Any) -> Any:
    """Plain numbers as IEEE has them, so that nothing is ever an integer without end, complex, or an exception."""
    if isinstance(a, float) and isinstance(b, float):
        with np.errstate(all="ignore"):
            return float(_operated(op, np.float64(a), np.float64(b)))
    return _operated(op, a, b)


def _operated(op: ast.operator, a: Any, b: Any) -> Any:
    match op:
        case ast.Add():
            return a + b
        case ast.Sub():
            return a - b
        case ast.Mult():
            return a * b
        case ast.Div():
            return a / b
    return a**b


def _without_units(text: str) -> tuple[str, Numbers]:
    """The text with blanks in place of units, so that all else stands where it stood, and the numbers that had them."""
    at, plain, numbers = 0, [], {}
    while at < len(text):
        token = TOKEN.match(text, at)
        if not token:
            cure = INSTEAD.get(text[at], f"use numbers, + − * / **, quantities and {', '.join(FUNCTIONS)}")
            raise UsageError(f"{shown(text)} is no expression: {text[at]!r} at place {at + 1} is not allowed; {cure}")
        end = token.end()
        plain.append(token[0])
        if token["number"] and (bracket := BRACKET.match(text, end)):
            numbers[at] = _in_si(token["number"], bracket[1])
            plain.append(" " * len(bracket[0]))
            end = bracket.end()
        at = end
    return "".join(plain), numbers


def _in_si(number: str, unit: str) -> Number:
    written = f"{number} [{unit.strip()}]"
    if known := UNITS.get(unit.strip()):  # which pint need not be loaded for
        factor, kg, m, s = 1.0, known.kg, known.m, known.s
    else:
        try:
            factor, kg, m, s = coherent(unit)
        except UnitError as error:
            raise UsageError(f"{shown(written)}: {error}") from None
    if not isfinite(float(number) * factor):
        raise UsageError(f"{shown(written)} is no number to count with; give a finite one")
    return Number(float(number) * factor, unit.strip(), (kg, m, s), written)


def _within_limits(tree: ast.expr, text: str) -> None:
    """Looks at one level after the other, because a deep tree must not be walked by recursion."""
    level, nodes = [tree], 0
    for _ in range(DEEPEST):
        nodes += len(level)
        if nodes > MOST_NODES:
            raise UsageError(f"{shown(text)} has more than {MOST_NODES} numbers, names and operators; write a shorter term")
        level = [c for node in level for c in ast.iter_child_nodes(node) if isinstance(c, ast.expr)]
        if not level:
            return
    raise _too_deep(text)


def _too_deep(text: str) -> UsageError:
    return UsageError(f"{shown(text)} is nested or goes on more than {DEEPEST} deep; write it with fewer terms and brackets")


def _check(node: ast.AST, text: str) -> None:
    if isinstance(node, ast.Tuple):
        raise UsageError(f"{shown(text)} has a comma where none belongs; write the decimals of a number behind a point")
    if isinstance(node, ast.Attribute):
        raise UsageError(
            f"{shown(text)}: {ast.unparse(node)} has a point in it; name a quantity by its symbol alone, as m or psi_dot"
        )
    if not isinstance(node, ALLOWED):
        raise UsageError(
            f"{shown(text)}: {type(node).__name__} is not allowed; use numbers, + − * / **, "
            f"quantities and {', '.join(FUNCTIONS)}"
        )
    match node:
        case ast.Call():
            _check_call(node, text)
        case ast.Name(id=name) if name.startswith("_") or "__" in name:
            raise UsageError(f"{shown(text)}: {name!r} is no name of a quantity; these begin with a letter")
        case ast.Constant(value=number) if not _finite(number):
            raise UsageError(f"{shown(text)}: {shown(str(number))} is no number to count with; give a finite one")
        case ast.Subscript(slice=ast.Constant(value=int() as place)) if place < MOST_COMPONENTS:
            pass
        case ast.Subscript():
            raise UsageError(f"{shown(text)}: a component is asked for by its number, as in F_t[0]")


def _finite(number: object) -> bool:
    return isinstance(number, int | float) and not isinstance(number, bool) and abs(number) <= sys.float_info.max


def _check_call(call: ast.Call, text: str) -> None:
    name = call.func.id if isinstance(call.func, ast.Name) else ast.unparse(call.func)
    if name not in FUNCTIONS or not isinstance(call.func, ast.Name):
        known = f"known: {', '.join(FUNCTIONS)}"
        cure = "write tanh(u / v), which passes from −1 to 1 over about v" if name in ("sgn", "sign") else known
        raise UsageError(f"{shown(text)}: no function {name!r}; {cure}")
    takes, given = FUNCTIONS[name][1], len(call.args)
    if call.keywords or (given != takes if takes else not 1 <= given <= MOST_COMPONENTS):
        wanted = f"{takes} value{'s' * (takes > 1)}" if takes else f"1 to {MOST_COMPONENTS} values"
        raise UsageError(f"{shown(text)} cannot be evaluated: {name} takes {wanted}, not {given}")


def _varies(node: ast.expr, numbers: Mapping[int, float], text: str) -> bool:
    """Does this depend on a quantity? What does not must be a finite number. Raises UsageError where it is none."""
    if isinstance(node, ast.Name):
        if node.id in FUNCTIONS:
            raise UsageError(f"{shown(text)}: {node.id} is a function; write {node.id}(...) of something")
        return True
    parts = {ast.BinOp: ("left", "right"), ast.UnaryOp: ("operand",), ast.Subscript: ("value",)}.get(type(node), ())
    inner = [*(getattr(node, part) for part in parts), *(node.args if isinstance(node, ast.Call) else ())]
    varies = [_varies(part, numbers, text) for part in inner]
    if isinstance(node, ast.Subscript) and not any(varies):
        raise UsageError(f"{shown(text)}: a plain number has no components; ask for those of a quantity, as in F_t[0]")
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) and not varies[1]:
        _check_exponent(value(node.right, {}, numbers), text)
    if not any(varies) and not np.all(np.isfinite(np.array(cs.DM(value(node, {}, numbers))))):
        raise UsageError(f"{shown(text)}: {ast.unparse(node)} is no finite number; leave it out")
    return any(varies)


def _check_exponent(exponent: Any, text: str) -> None:
    if not isinstance(exponent, float) or not abs(exponent) <= MOST_EXPONENT:
        raise UsageError(f"{shown(text)}: an exponent is one number between −{MOST_EXPONENT} and {MOST_EXPONENT}")
