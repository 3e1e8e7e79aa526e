"""What is known of units without pint is what pint says."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from wheelchair_fmu import units
from wheelchair_fmu.quantities import UNITS


@pytest.mark.parametrize(("text", "si"), list(units.USUAL))
def test_usual_units_are_those_of_pint(text, si, monkeypatch):
    known = units.USUAL[text, si]
    monkeypatch.setattr(units, "USUAL", {})
    by_pint = units.factor.__wrapped__(text, si)
    assert known == pytest.approx(by_pint, rel=1e-15)


@pytest.mark.parametrize("text", list(UNITS))
def test_coherent_units_are_those_of_pint(text):
    known = UNITS[text]
    assert (1.0, known.kg, known.m, known.s) == pytest.approx(units.coherent.__wrapped__(text), rel=1e-15)


def test_dimensions_are_those_of_pint(monkeypatch):
    names = [si for text, si in units.SI_OF.items() if text == si]
    by_hand = {(text, si): units.same_dimension(text, si) for text in units.SI_OF for si in names}
    monkeypatch.setattr(units, "SI_OF", {})
    assert by_hand == {(text, si): units.same_dimension(text, si) for text, si in by_hand}
    assert 0 < sum(by_hand.values()) < len(by_hand)


def test_most_files_are_read_without_pint(monkeypatch):
    monkeypatch.setattr(units, "_parse", lambda text: pytest.fail("pint was asked"))
    units.factor.cache_clear()
    assert units.factor("deg/s", "rad/s") == pytest.approx(0.017453292519943295)
    assert units.factor("N", "N") == 1.0
    assert not units.same_dimension("m/s", "rad/s") and units.same_dimension("deg/s", "rad/s")


@pytest.mark.parametrize(
    ("spellings", "si", "value"),
    [
        ("N.m|Nm|N m|N·m|N-m|N*m|newton meter|m.N|kg.m2/s2|kg·m²·s⁻²", "N.m", 1.0),
        ("lbf.ft|lbf ft|ft-lb|ft lb|ft·lb|lb-ft|ft.lbf", "N.m", 1.3558179483314004),
        ("deg/s|°/s|dps|deg.s-1|degree/second|deg*s**-1|deg per s", "rad/s", 0.017453292519943295),
        ("rpm|rev/min", "rad/s", 0.10471975511965977),
        ("m/s2|m/s²|m/s^2|m/s/s|m.s-2|m s^-2|m/s**2|m*s^(-2)|m/(s.s)|(m/s)/s", "m/s2", 1.0),
        ("g|G|gn", "m/s2", 9.80665),
        ("km/h|kph|km.h-1|km / h|km/hour", "m/s", 1 / 3.6),
        ("us|µs|μs", "s", 1e-6),
        ("%|percent", "1", 0.01),
        ("|-|1|rad", "1", 1.0),
    ],
)
def test_loggers_spell_units_in_many_ways(spellings, si, value):
    for text in spellings.split("|"):
        assert units.factor(text, si) == pytest.approx(value), text


@pytest.mark.parametrize(
    "text",
    [
        "9**9**9",
        "m**9**9",
        "m^10",
        "m^9.m",
        "((m^9)^9)",
        "m12",
        "m^0.5",
        "2 m",
        "m/",
        "/s",
        ".m",
        "m..s",
        "(m",
        "m)",
        "()",
        "m;s",
        "m\n*s__",
        "__import__('os')",
        "m.__class__",
        "m" * 61,
        "(" * 1000,
    ],
)
def test_what_is_no_unit_is_said_at_once(text):
    with pytest.raises(units.UnitError, match=r"is unknown|which no unit is") as refused:
        units.factor(text, "m")
    assert len(str(refused.value)) < 200
    with pytest.raises(units.UnitError):
        units.coherent(text)


@pytest.mark.parametrize(
    ("text", "si", "why"),
    [
        ("mV", "N", "unit 'mV' measures a voltage, but 'N' is needed, which measures a force"),
        ("°C", "m", "measures a temperature"),
        ("dB", "1", "is no multiple of '1'"),
    ],
)
def test_what_measures_something_else_is_said(text, si, why):
    with pytest.raises(units.UnitError, match=why):
        units.factor(text, si)


def test_a_unit_that_no_number_can_hold_is_refused():
    with pytest.raises(units.UnitError, match="not made of whole powers"):
        units.coherent("lightyear^9.parsec^9.Ym^9")


PIECES = [
    "m",
    "s",
    "N",
    "lbf",
    "km",
    "deg",
    "rev",
    "per",
    "1",
    "9",
    "2",
    "-",
    "^",
    "**",
    "*",
    "/",
    ".",
    "·",
    "²",
    "⁻",
    "(",
    ")",
    " ",
    "%",
    "°",
    "µ",
    "_",
    "dB",
    "degC",
    "é",
    "\0",
    "[",
]


@settings(deadline=2000)  # ms; the first asks pint, which loads
@given(st.one_of(st.text(max_size=80), st.lists(st.sampled_from(PIECES), max_size=20).map("".join)))
@example("9**9**9")
def test_any_text_is_a_unit_or_is_refused_soon(text):
    try:
        scale, kg, m, s = units.coherent(text)
    except units.UnitError as error:
        assert str(error)
        return
    assert math.isfinite(scale) and scale != 0
    assert max(map(abs, (kg, m, s))) < 1000
