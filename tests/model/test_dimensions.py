"""Units of typed expressions."""

from __future__ import annotations

from math import pi

import pytest

from wheelchair_fmu.errors import UsageError
from wheelchair_fmu.model.dimensions import orders, unit_of_q, vocabulary
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.expression import law
from wheelchair_fmu.model.wheelchair import assemble


@pytest.mark.parametrize(
    ("expression", "to", "unit"),
    [
        ("-q * u", "F_x", "N.s/m"),
        ("-q * u * magnitude(u, v_eps)", "F_x", "N.s2/m2"),
        ("-q * psi_dot", "M_z", "N.m.s/rad"),
        ("-q * sin(delta)", "M_w", "N.m"),
        ("q * m * g * atan2(v, u)", "F_y", "1"),
        ("q * u**2 / g", "F_y", "kg/s2"),
        ("q * I_z / b", "F_y", "1/s2"),
        ("-q * tanh(u / 0.3 [km/h])", "F_x", "N"),
        ("q * (0.3 [N.m] + 2.5 [lbf.ft]) * delta", "M_w", "1"),
        ("q * magnitude(u, 1e-2[m/s])", "F_x", "N.s/m"),
        ("q * sin(psi_dot * 2 [s] + 10 [deg])", "F_x", "N"),
    ],
)
def test_the_unit_of_q_follows(expression, to, unit):
    found = unit_of_q(expression, to)
    assert (found.kg, found.m, found.s) == EXPONENTS[unit]


EXPONENTS = {
    "N.s/m": (1, 0, -1),
    "N.s2/m2": (1, -1, 0),
    "N.m.s/rad": (1, 2, -1),
    "N.m": (1, 2, -2),
    "1": (0, 0, 0),
    "kg/s2": (1, 0, -2),
    "1/s2": (0, 0, -2),
    "N": (1, 1, -2),
}


@pytest.mark.parametrize(
    ("expression", "to", "why"),
    [
        ("q * (u + psi_dot)", "F_x", r"u \(m/s\) and psi_dot \(rad/s\) are added; multiply u by something in 1/m$"),
        ("q * (u + m)", "F_x", r"u \(m/s\) and m \(kg\) are added; multiply u by something in .*kg"),
        ("q * magnitude(u, 0.01)", "F_x", r"0.01 \(a plain number\) are compared by magnitude; a number may have its unit"),
        ("q * sin(u)", "F_x", "sin takes a plain number, and u is in m/s"),
        ("q * tanh(u / 0.1)", "F_x", r"u / 0.1 is in m/s: divide it by something in m/s; a number may .* 0.1 \[m/s\]"),
        ("q * exp(-psi_dot * 2 [s] / 1 [m])", "F_x", r"exp takes a plain number, and -psi_dot \* 2 \[s\] / 1 \[m\] is in 1/m"),
        ("q * u**m", "F_x", "an exponent takes a plain number, and m is in kg"),
        ("q * u**psi", "F_x", "has an exponent that is not one number"),
        ("q * sqrt(u)", "F_x", "a root of a unit is left over; make what is under the root a plain number"),
        ("q * u^2", "F_x", r"write \*\* for a power"),
        ("q * 2,5 * u", "F_x", "decimals of a number behind a point"),
        ("q * chair.m", "F_x", "chair.m has a point in it"),
        ("q *", "F_x", "breaks off at its end"),
        ("q * mass", "F_x", r"reads 'mass', which is no quantity of this model; did you mean .*m \(total mass m of chair"),
        ("q * yawrate", "F_x", "did you mean"),
        ("q + u", "F_x", "the size q must be a factor"),
        ("u", "F_x", "no q in it"),
        ("q * foo", "F_x", "reads 'foo', which is no quantity"),
        ("q * F_y", "F_x", "only known further down the line"),
        ("q * v_xr", "F_x", "has 2 values, where F_x has 1; take one of them"),
        ("-q u", "F_x", "a sign is missing"),
        ("q * sgn(u)", "F_x", r"write tanh"),
        ("q * U", "F_x", r"did you mean u \(forward speed"),
        ("q * sin(u, v)", "F_x", "cannot be evaluated"),
        ("q * tanh(u / 0.3)", "F_x", r"the units do not fit: tanh takes a plain number, .*; a number may have its unit"),
        ("q * tanh(u / 0.3 [N])", "F_x", r"and u / 0.3 \[N\] is in s/kg: divide it by something in s/kg$"),
        ("q * (sqrt(u) + v)", "F_x", r"are added$"),
        ("q * (psi**2 + u)", "F_x", r"are added; multiply .* by something in m/s$"),
        ("q * u * 3 [furlongs_]", "F_x", "unit 'furlongs_' is unknown"),
        ("q * u * 3 [degC]", "F_x", "not made of whole powers"),
        ("q * u * 3 [A]", "F_x", "not made of whole powers"),
        ("q * (", "F_x", "is no expression"),
        ("q * u", "F_z", "no quantity to act on 'F_z'"),
    ],
)
def test_what_does_not_fit_is_said(expression, to, why):
    with pytest.raises(UsageError, match=why):
        unit_of_q(expression, to)


def test_a_number_with_a_unit_counts_in_si():
    assert law("2 * (3.6 [km/h] + u)")(u=0.5) == pytest.approx(3.0)
    assert law("q * 90 [deg]")(q=1.0) == pytest.approx(pi / 2)


def test_the_catalogues_own_drag_agrees():
    record = bundled()["rolling_resistance_speed"].parameters[0].unit
    found = unit_of_q("-q * u", "F_x")
    assert (found.kg, found.m, found.s) == (record.kg, record.m, record.s)


def test_a_long_sum_is_refused_as_soon_as_a_short_one():
    """What a part is in is found once, and not twice for every sum that it is within."""
    with pytest.raises(UsageError, match=r"\(m/s\) and m \(kg\) are added"):
        unit_of_q(f"q * ({' + '.join(['u'] * 50)} + m)", "F_x")


def test_signs_of_print_are_those_of_the_keyboard():
    assert law("−q × u · 2").expression == law("-q * u * 2").expression


@pytest.mark.parametrize("to", ["F_x", *(pytest.param(symbol, marks=pytest.mark.nightly) for symbol in ("delta", "N_f"))])
def test_a_term_may_read_what_is_known_before_what_it_acts_on(to):
    """Places in the line say so: below its own it can be evaluated, from there on it is refused."""
    model = assemble()
    place, known = orders(model), vocabulary(model)
    refused = []
    for name in known:
        part = name if known[name].size == 1 else f"{name}[0]"
        try:
            unit_of_q(f"q * {part}" if known[to].size == 1 or known[name].size == 1 else f"q * {name}", to)
        except UsageError as error:
            refused += [name] if "further down the line" in str(error) else []
    assert set(refused) == {name for name in known if place[name] >= place[to]}
    assert len(refused) > 20
