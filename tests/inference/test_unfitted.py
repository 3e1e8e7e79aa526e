"""An effect of which the campaign says how large it is: what is off from that is its size, not what is off from zero."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.search.refitting import candidate
from wheelchair_fmu.inference.search.screen import screen
from wheelchair_fmu.model.variant import Variant

from .forces import ridden

SENSOR, AT = "accelerometer_offset", {"effect.accelerometer_offset.x": -0.22, "effect.accelerometer_offset.y": 0.1}


@pytest.fixture(scope="module")
def turned(sample):
    """A chair whose accelerometer sits where it is said to sit."""
    noise = {**sample.noise, "a_x": 0.05, "a_y": 0.05}
    runs = tuple(replace(r, channels={**r.channels, "a_x": 0 * r.time, "a_y": 0 * r.time}) for r in sample.runs)
    known = {**sample.known, **AT}
    said = replace(sample, noise=noise, runs=runs, known=known)
    return ridden(said, np.random.default_rng(3), lambda run, without: (0 * run.time, 0 * run.time))


def test_a_sensor_that_sits_where_it_is_said_to_sit_is_no_effect(turned):
    models = Models.of(ModelFactory(turned, Variant()))
    models, base, *_ = models.calibrated()
    (scored,) = screen(models, base, [SENSOR])
    c = candidate(models, base, scored, 1)
    assert c is not None
    np.testing.assert_allclose(c.estimate, [*AT.values()], atol=4 * np.sqrt(np.diag(c.covariance)).max())
    np.testing.assert_allclose(c.size, c.estimate - [*AT.values()])
    assert c.p > 1e-3 and not c.matters
    found = models.refit((SENSOR,), {**base.fit.values, **AT})
    assert (
        models.weight(found, SENSOR)
        < 20
        < Models.weight(Models.of(ModelFactory(replace(turned, known={}), Variant())), found, SENSOR)
    )
