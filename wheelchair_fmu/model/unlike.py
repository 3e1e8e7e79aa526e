"""Where the units of a typed expression do not fit, in words: by the rules of dimensions, part by part."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping

from ..quantities import Quantity
from . import arithmetic

Exponents = tuple[float, float, float]  # of kg, m and s
PLAIN: Exponents = (0.0, 0.0, 0.0)
OF_NUMBERS = ("sin", "cos", "tan", "atan", "exp", "log", "tanh")  # functions of a plain number
OF_LIKES = ("atan2", "fmin", "fmax", "min", "max", "magnitude", "direction")  # of two of one unit
RATIOS = ("atan2", "direction")  # whose value is a plain number
NUMBERS = "a number may have its unit behind it, as in 0.1"


class _Unlike(Exception):
    """The first part that does not fit, in words."""


def unlike(text: str, known: Mapping[str, Quantity], named: Callable[..., str]) -> str:
    """The part of an expression whose units do not fit, as a clause; nothing where none is found. `q` counts as plain, as it is
    a factor of the whole; `named` makes a unit's name from whole exponents."""
    tree, numbers = arithmetic.parsed(text)
    try:
        _Units(known, numbers, named).of(tree)
    except _Unlike as found:
        return str(found)
    return ""


class _Units:
    def __init__(self, known: Mapping[str, Quantity], numbers: arithmetic.Numbers, named: Callable[..., str]):
        self.known, self.numbers, self.named = known, numbers, named
        self._told: dict[ast.expr, Exponents] = {}  # each part is asked for once by what it is in, and again by its message

    def of(self, node: ast.expr) -> Exponents:
        if node not in self._told:
            self._told[node] = self._found(node)
        return self._told[node]

    def _found(self, node: ast.expr) -> Exponents:
        match node:
            case ast.Constant():
                number = self.numbers.get(node.col_offset)
                return PLAIN if number is None else _floats(number.exponents)
            case ast.Name(id=name):
                unit = self.known[name].unit if name in self.known else None
                return PLAIN if unit is None else (float(unit.kg), float(unit.m), float(unit.s))
            case ast.UnaryOp(operand=inner) | ast.Subscript(value=inner):
                return self.of(inner)
            case ast.BinOp(left=left, op=op, right=right):
                return self._joined(left, op, right)
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return self._called(name, arguments)
        raise TypeError(f"{type(node).__name__} in a checked expression")

    def _joined(self, left: ast.expr, op: ast.operator, right: ast.expr) -> Exponents:
        a, b = self.of(left), self.of(right)
        match op:
            case ast.Add() | ast.Sub():
                self._alike(left, right, "are subtracted" if isinstance(op, ast.Sub) else "are added")
                return a
            case ast.Mult():
                return _sum(a, b, 1.0)
            case ast.Div():
                return _sum(a, b, -1.0)
        self._plain(right, "an exponent")
        if a != PLAIN and arithmetic.names(right):
            raise _Unlike(f"{self.told(left)} has an exponent that is not one number")
        exponent = float(arithmetic.value(right, {}, {})) if a != PLAIN else 0.0
        return (exponent * a[0], exponent * a[1], exponent * a[2])

    def _called(self, name: str, arguments: list[ast.expr]) -> Exponents:
        if name in OF_NUMBERS:
            self._plain(arguments[0], name)
            return PLAIN
        if name in OF_LIKES:
            self._alike(arguments[0], arguments[1], f"are compared by {name}")
            return PLAIN if name in RATIOS else self.of(arguments[0])
        found = [self.of(argument) for argument in arguments]
        return (found[0][0] / 2, found[0][1] / 2, found[0][2] / 2) if name == "sqrt" else found[0]

    def _alike(self, left: ast.expr, right: ast.expr, what: str) -> None:
        a, b = self.of(left), self.of(right)
        if a == b:
            return
        said = f"{self.told(left)} and {self.told(right)} {what}"
        for one, other in ((left, right), (right, left)):
            if self.of(one) == PLAIN and self._has_bare_number(one):
                raise _Unlike(f"{said}; {NUMBERS} [{self._unit(other)}]")
        ratio = _sum(b, a, -1.0)
        whole = all(exponent == round(exponent) for exponent in ratio)
        raise _Unlike(
            f"{said}; multiply {self._text(left)} by something in {self.named(*map(round, ratio))}" if whole else said
        )

    def _plain(self, node: ast.expr, what: str) -> None:
        if self.of(node) == PLAIN:
            return
        text, unit = self._text(node), self._unit(node)
        cure = f"; {NUMBERS} [{unit}]" if self._has_bare_number(node) else ""
        raise _Unlike(f"{what} takes a plain number, and {text} is in {unit}: divide it by something in {unit}{cure}")

    def _has_bare_number(self, node: ast.expr) -> bool:
        """Has a part a number without a unit that may be given one, which an exponent and an index may not?"""
        match node:
            case ast.Constant():
                return self.numbers.get(node.col_offset) is None
            case ast.BinOp(left=left, op=ast.Pow()):
                return self._has_bare_number(left)
            case ast.BinOp(left=left, right=right):
                return self._has_bare_number(left) or self._has_bare_number(right)
            case ast.UnaryOp(operand=inner) | ast.Subscript(value=inner):
                return self._has_bare_number(inner)
            case ast.Call(args=arguments):
                return any(map(self._has_bare_number, arguments))
        return False

    def told(self, node: ast.expr) -> str:
        """A part with its unit."""
        return f"{self._text(node)} ({self._unit(node) if self.of(node) != PLAIN else 'a plain number'})"

    def _text(self, node: ast.expr) -> str:
        return arithmetic.written(node, {place: number.written for place, number in self.numbers.items()})

    def _unit(self, node: ast.expr) -> str:
        if isinstance(node, ast.Name) and node.id in self.known:
            return self.known[node.id].unit.name
        return self.named(*map(round, self.of(node)))


def _floats(exponents: tuple[int, int, int]) -> Exponents:
    return float(exponents[0]), float(exponents[1]), float(exponents[2])


def _sum(a: Exponents, b: Exponents, times: float) -> Exponents:
    return a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]
