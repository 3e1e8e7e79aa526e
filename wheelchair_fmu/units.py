"""Units as loggers write them, by pint.

Pint takes a third of a second to load, so what most files have is known without; a test holds it against pint.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import cache, lru_cache, wraps
from threading import RLock
from typing import Any, ParamSpec, TypeVar

from . import unit_text

STANDARD_GRAVITY = 9.80665  # m/s2
_GRAVITY = {
    **dict.fromkeys(("g", "G", "g0", "gn"), STANDARD_GRAVITY),
    "mg": STANDARD_GRAVITY / 1e3,
}  # pint: gram, gauss, milligram
_FOOT_POUND = ("ft-lb", "ft.lb", "ft·lb", "ft lb", "ft*lb", "lb-ft", "lb.ft", "lb·ft", "lb ft", "lb*ft")
_ASIDE = {
    **dict.fromkeys(("Nm", "N·m", "N-m", "N m", "N*m"), "N.m"),
    **dict.fromkeys(("Ns", "N·s", "N s", "N*s", "kg.m/s", "kg·m/s", "kg m/s", "kg*m/s"), "N.s"),
    **dict.fromkeys(("", "-", "dimensionless"), "1"),
    **dict.fromkeys(("m/s²", "m/s^2"), "m/s2"),
    **dict.fromkeys(_FOOT_POUND, "lbf.ft"),  # nobody means a mass times a length
}
USUAL = {
    ("ms", "s"): 1e-3,
    ("mm", "m"): 1e-3,
    ("cm", "m"): 1e-2,
    ("km/h", "m/s"): 1 / 3.6,
    ("deg", "rad"): math.radians(1),
    ("deg/s", "rad/s"): math.radians(1),
    ("rpm", "rad/s"): math.pi / 30,
    ("%", "1"): 1e-2,
}
_EXAMPLES = {
    "s": "s or ms",
    "m": "m or mm",
    "m/s": "m/s or km/h",
    "m/s2": "m/s2 or g",
    "rad": "rad or deg",
    "rad/s": "rad/s or deg/s",
    "N": "N or lbf",
    "N.m": "N.m or lbf.ft",
    "N.s": "N.s or kg.m/s",
    "1": "1 or %",
    "bar": "bar or kPa",
}
KEPT = 4096  # units that are remembered
_PLAIN = {"rad": "1"}  # an angle is a plain number
SI_OF = {**{si: si for si in _EXAMPLES}, **{text: si for text, si in USUAL}}


class UnitError(ValueError):
    """A unit that is unknown or of another dimension: a fact and a cure."""

    def __init__(self, fact: str, cure: str):
        self.fact, self.cure = fact, cure
        super().__init__(f"{fact}; {cure}")


_Given = ParamSpec("_Given")
_Found = TypeVar("_Found")
_turn = RLock()


def _alone(asks: Callable[_Given, _Found]) -> Callable[_Given, _Found]:
    """One thread at a time: pint's registry grows while it is asked, and units of two registries do not meet."""

    @wraps(asks)
    def alone(*args: _Given.args, **options: _Given.kwargs) -> _Found:
        with _turn:
            return asks(*args, **options)

    return alone


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(cache_folder=None)


@lru_cache(KEPT)
def _parse(text: str) -> Any:
    """A pint unit, or None where the text is no unit. Pint is asked for one name at a time, and evaluates nothing."""
    powers = {} if text == "1" else unit_text.parsed(_ASIDE.get(text, text))
    if powers is None:
        return None
    registry = _registry()
    found: dict[str, int] = {}
    for name, exponent in powers.items():
        known = _known_name(name)
        if known is None:
            return None
        found[known] = found.get(known, 0) + exponent
    return registry.Unit(registry.UnitsContainer(found))


def _known_name(name: str) -> str | None:
    """What pint calls this unit; None where it knows none."""
    import pint

    try:
        return str(_registry().get_name(name)) or None
    except pint.PintError:
        return None


def _unknown(text: str, cure: str) -> UnitError:
    if len(text) > unit_text.LONGEST:
        return UnitError(f"{text[:20]!r}… is {len(text)} characters long, which no unit is", cure)
    return UnitError(f"unit {text!r} is unknown", cure)


def _in(target: Any, unit: Any) -> float | None:
    """How much of `target`, of the same dimension, one of `unit` is; None where it is no finite multiple of it."""
    import pint

    one = _registry().Quantity(1.0, unit)
    if not one._is_multiplicative:  # such as °C and dB
        return None
    try:
        found = float(one.to(target).magnitude)
    except (pint.PintError, ArithmeticError, TypeError, ValueError):  # beyond what a float can hold
        return None
    return found if math.isfinite(found) and found != 0 else None


@lru_cache(KEPT)
@_alone
def factor(text: str, si: str) -> float:
    """`value in SI = factor · value in text`.

    `si` is the name of a coherent SI unit from `quantities`. Raises UnitError for an unknown unit and for one of
    another dimension. In an acceleration, g is standard gravity.
    """
    text = text.strip()
    if text == si or _ASIDE.get(text) == si:
        return 1.0
    if (text, si) in USUAL:
        return USUAL[text, si]
    if si == "m/s2" and text in _GRAVITY:
        return _GRAVITY[text]
    unit = _parse(text)
    if unit is None:
        raise _unknown(text, f"write it as, for example, {_EXAMPLES[si]}")
    target = _parse(si)
    if unit.dimensionality != target.dimensionality:
        raise UnitError(
            f"unit {text!r} measures {_dimension(unit)}, but {si!r} is needed, which measures {_dimension(target)}",
            f"give a unit such as {_EXAMPLES[si]}",
        )
    found = _in(target, unit)
    if found is None:
        raise UnitError(f"unit {text!r} is no multiple of {si!r}", f"give a unit such as {_EXAMPLES[si]}")
    return found


@lru_cache(KEPT)
@_alone
def coherent(text: str) -> tuple[float, int, int, int]:
    """`value in SI = factor · value in text`, and the exponents of kg, m, s that it has there; angles are plain numbers.

    Raises UnitError for an unknown unit, and for one that needs more than mass, length and time, in whole powers.
    """
    text, cure = text.strip(), "write a unit of mass, length, time or angle, such as N.m, km/h or deg"
    unit = _parse(text) if text else None
    if unit is None:
        raise _unknown(text, cure)
    exponents = dict(unit.dimensionality)
    powers = [exponents.pop(name, 0) for name in ("[mass]", "[length]", "[time]")]
    if not exponents and all(p == int(p) for p in powers):
        kg, m, s = map(int, powers)
        target = {name: p for name, p in zip(("kilogram", "meter", "second"), (kg, m, s), strict=True) if p}
        found = _in(_registry().Unit(_registry().UnitsContainer(target)), unit)
        if found is not None:
            return found, kg, m, s
    raise UnitError(f"unit {text!r} is not made of whole powers of mass, length and time", cure)


def same_dimension(text: str, si: str) -> bool:
    """Whether `text` is a unit of the dimension of `si`."""
    known = SI_OF.get(_ASIDE.get(text.strip(), text.strip()))
    if known is not None:
        return _PLAIN.get(known, known) == _PLAIN.get(si, si)
    try:
        factor(text, si)
    except UnitError:
        return False
    return True


def quantity(text: str, si: str) -> float:
    """A number with a unit, such as "0.3 deg/s", in SI. Raises UnitError."""
    match = re.fullmatch(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*", text)
    if not match:
        raise UnitError(f"{text!r} is not a number with a unit", f"write it as, for example, '0.1 {si}'")
    return float(match[1]) * factor(match[2] or si, si)


_SUFFIXES = {
    "_degps": "deg/s",
    "_deg_s": "deg/s",
    "_dps": "deg/s",
    "_radps": "rad/s",
    "_rad_s": "rad/s",
    "_rpm": "rpm",
    "_mps2": "m/s2",
    "_m_s2": "m/s2",
    "_ms2": "m/s2",
    "_mps": "m/s",
    "_m_s": "m/s",
    "_kmh": "km/h",
    "_km_h": "km/h",
    "_kph": "km/h",
    "_Nm": "N.m",
    "_N_m": "N.m",
    "_N": "N",
    "_ns": "ns",
    "_us": "us",
    "_ms": "ms",
    "_s": "s",
    "_mm": "mm",
    "_cm": "cm",
    "_m": "m",
    "_deg": "deg",
    "_rad": "rad",
    "_g": "g",
}
_ELECTRIC = ("uT", "µT", "V", "mV", "A", "mA", "degC", "°C", "°", "counts", "-")


def split(header: str) -> tuple[str, str | None]:
    """'yaw_rate [deg/s]' is ('yaw_rate', 'deg/s'), and so is 'yaw_rate (deg/s)'; no bracket, no unit.

    What stands in a bracket is a unit, whatever it says; in parentheses only what is known as one: 'speed (left)' is a name.
    """
    name, bracket, unit = header.partition("[")
    if bracket and unit.rstrip().endswith("]"):
        return name.strip(), unit.rstrip()[:-1].strip()
    found = re.fullmatch(r"(.*?)\s*\(([^()]+|[^()]*\([^()]*\)[^()]*)\)\s*", header)
    if found and found[1] and is_unit(found[2].strip()):
        return found[1].strip(), found[2].strip()
    return header.strip(), None


def suffixed(header: str) -> tuple[str, str | None]:
    """'yaw_rate_dps' is ('yaw_rate', 'deg/s'), by the usual endings; no such ending, no unit."""
    for suffix in sorted(_SUFFIXES, key=len, reverse=True):
        if header.endswith(suffix) and len(header) > len(suffix):
            return header[: -len(suffix)], _SUFFIXES[suffix]
    return header, None


def unit_of(header: str) -> str | None:
    """The unit that a header gives, by its bracket, its parenthesis or its ending."""
    name, unit = split(header)
    return unit if unit is not None else suffixed(name)[1]


@cache
def is_unit(text: str) -> bool:
    """Is this text a unit of something that loggers log? A single letter may be a side or a direction."""
    if text in _GRAVITY or text in SI_OF or text in _ASIDE or text in _ELECTRIC:
        return bool(text)
    if len(text) < 2 or not re.search(r"[A-Za-zµΩ°]", text):
        return text in ("h", "W", "°")
    try:
        coherent(text)
    except UnitError:
        return False
    return True


def _dimension(unit: Any) -> str:
    """What a unit measures, in words where there are any."""
    names = {
        "m": "a length",
        "s": "a time",
        "m/s": "a speed",
        "m/s2": "an acceleration",
        "N": "a force",
        "N.m": "a torque",
        "N.s": "a momentum",
        "1": "an angle or a plain number",
        "rad/s": "an angular rate",
        "kg": "a mass",
        "Pa": "a pressure",
        "V": "a voltage",
        "A": "a current",
        "K": "a temperature",
        "W": "a power",
    }
    for si, name in names.items():
        if _parse(si).dimensionality == unit.dimensionality:
            return name
    return f"{unit.dimensionality}"
