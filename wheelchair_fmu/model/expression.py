"""Effects written as an expression: "-q * sin(delta)" becomes a law, and a file that a user may edit.

A number may have a unit in brackets behind it, "-q * tanh(u / 3 [km/h])"; it counts in SI.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable
from functools import cache
from typing import Any

import casadi as cs

from ..errors import UsageError
from ..quantities import UNITS, Unit
from ..units import UnitError, coherent
from .smooth import direction, grip, magnitude

FUNCTIONS: dict[str, Callable[..., Any]] = {
    name: getattr(cs, name)
    for name in ("sin", "cos", "tan", "atan", "atan2", "exp", "log", "sqrt", "tanh", "fmin", "fmax", "fabs", "sum1", "vertcat")
} | {"magnitude": magnitude, "direction": direction, "grip": grip}
ALLOWED = (ast.Expression, ast.BinOp, ast.UnaryOp, ast.Call, ast.Name, ast.Load, ast.Constant, ast.Subscript, ast.Add,
           ast.Sub, ast.Mult, ast.Div, ast.Pow, ast.USub, ast.UAdd)  # fmt: skip


WITH_UNIT = re.compile(r"(?<![\w.\])])((?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*\[([\w\s.·⋅*/^°²³µΩ%-]*)\]")


@cache
def law(expression: str) -> Callable[..., Any]:
    """The expression as a function of the quantities it names.

    Raises UsageError for anything but arithmetic, numbers (with units), names and the functions above.
    """
    made = _function(WITH_UNIT.sub(lambda number: repr(_in_si(number)[0]), expression))
    made.__dict__["expression"] = expression  # from which the units of its numbers can be read
    return made


def law_of_constants(expression: str) -> tuple[Callable[..., Any], dict[str, tuple[float, Unit]]]:
    """The law as a function of its numbers with units too; by their names there, those numbers in SI and their units."""
    constants: dict[str, tuple[float, Unit]] = {}

    def named(number: re.Match[str]) -> str:
        name = f"constant_{len(constants)}"
        constants[name] = _in_si(number)
        return name

    return _function(WITH_UNIT.sub(named, expression)), constants


def _in_si(number: re.Match[str]) -> tuple[float, Unit]:
    if number[2].strip() in UNITS:
        return float(number[1]), UNITS[number[2].strip()]
    try:
        factor, kg, m, s = coherent(number[2])
    except UnitError as error:
        raise UsageError(f"{number[0]}: {error}") from None
    return float(number[1]) * factor, Unit(number[2].strip(), kg=kg, m=m, s=s)


def _function(expression: str) -> Callable[..., Any]:
    try:
        tree = ast.parse(expression, mode="eval")
    except SyntaxError as error:
        raise UsageError(f"{expression!r} is no expression: {error.msg} at place {error.offset}") from None
    names: dict[str, None] = {}
    called = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    for node in ast.walk(tree):
        if not isinstance(node, ALLOWED):
            raise UsageError(f"{expression!r}: {type(node).__name__} is not allowed; use numbers, + − * / **, "
                             f"quantities and {', '.join(FUNCTIONS)}")  # fmt: skip
        if isinstance(node, ast.Name) and id(node) in called and node.id not in FUNCTIONS:
            raise UsageError(f"{expression!r}: no function {node.id!r}; known: {', '.join(FUNCTIONS)}")
        if isinstance(node, ast.Name) and node.id not in FUNCTIONS:
            names[node.id] = None
    made: Callable[..., Any] = eval(f"lambda {', '.join(names)}: {expression}", {"__builtins__": {}, **FUNCTIONS})
    return made


FILE = '''"""{title}:  {to} += {expression}"""

from wheelchair_fmu.model.expression import law
from wheelchair_fmu.model.stage import Effect, adds
from wheelchair_fmu.quantities import Parameter, Unit

UNIT = {unit!r}
Q = Parameter("q", UNIT, "size of: {title}", off=0.0, smallest_interesting={size!r}, lower={lower!r}, upper={upper!r},
              source="{source}")

EFFECT = Effect(
    "{id}",
    "{title}",
    parameters=(Q,),
    contributions=({kind}("{to}", law("{expression}")),),
)
'''


def effect_file(id: str, title: str, to: str, unit: Unit, expression: str, *, size: float, lower: float, upper: float,
                source: str = "proposed", factor: bool = False) -> str:  # fmt: skip
    """The text of an effect file that adds `expression`, which has q in it, to the quantity `to` (or scales it)."""
    text = FILE.format(title=title, to=to, expression=expression, unit=unit, size=size, lower=lower, upper=upper,
                       source=source, id=id, kind="scales" if factor else "adds")  # fmt: skip
    imports = "DisplayUnit, Parameter, Unit" if unit.display else "Parameter, Unit"
    text = text.replace("Parameter, Unit\n", imports + "\n", 1)
    return text.replace("import Effect, adds", "import Effect, scales") if factor else text
