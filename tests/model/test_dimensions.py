"""Units of typed expressions."""

from __future__ import annotations

from math import pi

import pytest

from wheelchair_fmu.errors import UsageError
from wheelchair_fmu.model.dimensions import unit_of_q
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.expression import law


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
        ("q * (u + psi_dot)", "F_x", "the units do not fit"),
        ("q * magnitude(u, 0.01)", "F_x", "a plain number stands where"),
        ("q + u", "F_x", "q must be a factor"),
        ("u", "F_x", "no q in it"),
        ("q * foo", "F_x", "reads 'foo', which is no quantity"),
        ("q * F_y", "F_x", "only known further down the line"),
        ("q * v_xr", "F_x", "shape"),
        ("q * sin(u, v)", "F_x", "cannot be evaluated"),
        ("q * tanh(u / 0.3 [N])", "F_x", "the units do not fit"),
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
