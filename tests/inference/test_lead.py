"""What to measure next where nothing in the catalogue explains what is left."""

from dataclasses import replace

import pytest

from wheelchair_fmu.inference.estimation.calibration import Calibrated
from wheelchair_fmu.inference.evidence.disturbance import Strength
from wheelchair_fmu.inference.residual.lead import LEADS, lead
from wheelchair_fmu.inference.residual.unexplained import VARIABLES, Order, Unexplained
from wheelchair_fmu.model.variant import Variant

RECORD = next(p for p in Variant().parameters() if p.name == "chair.a")
GOOD = Calibrated(RECORD, 0.32, 0.001, 0.32, 0.01, False)
LEFT = Unexplained(Strength(20.0, 1.0, 0.0, 100.0), Strength(11.0, 0.5, 0.0, 50.0), ())


def test_whatever_orders_a_force_has_a_lead():
    assert set(LEADS) == {*VARIABLES, "run"}


@pytest.mark.parametrize("by", LEADS)
def test_the_plainest_order_leads(by):
    orders = (Order("force", by, 0.6, "the missing force does so"), Order("moment", "speed", 0.3, "less"))
    told = lead([GOOD], replace(LEFT, orders=orders))
    assert told["manoeuvre"] == LEADS[by][0] and told["gain"] == 0.6
    assert told["why"].endswith("the missing force does so")


def test_a_value_that_nobody_would_have_measured_comes_first():
    bent = replace(GOOD, value=GOOD.prior + 4 * GOOD.prior_sd)
    told = lead([GOOD, bent], replace(LEFT, orders=(Order("force", "speed", 0.9, "words"),)))
    assert told["manoeuvre"] == "chair.a measured again"


def test_where_nothing_orders_it_a_line_of_the_floor_is_run_twice():
    assert "same line of the floor" in lead([GOOD], LEFT)["manoeuvre"]
    assert "same line of the floor" in lead([GOOD], None)["manoeuvre"]
