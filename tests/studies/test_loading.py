"""fmpy's logger proxy outlives the instance that brought it."""

from __future__ import annotations

import gc

import fmpy
import numpy as np

from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies import Fmu, fmu_of


def test_an_fmu_may_speak_after_an_earlier_ones_logger_is_gone():
    archive = fmu_of(Variant())
    with Fmu(archive) as fmu:
        fmu.run(np.linspace(0, 1, 11), {}, {})
    del fmu
    gc.collect()
    pushes = np.array([(0.0, 0.0, 0.0), (2.0, 400.0, -400.0)], dtype=[(n, float) for n in ("time", "push.F_rl", "push.F_rr")])
    values = {"effect.lateral_load_transfer.h": 1.0, "start.u": 2.0, "chair.t_r": 0.3}
    names = {v.name for v in fmpy.read_model_description(str(archive)).modelVariables}
    result = fmpy.simulate_fmu(
        str(archive),
        stop_time=2,
        input=pushes,
        output=["load.lifted"],
        start_values={n: v for n, v in values.items() if n in names},
    )
    assert result["load.lifted"][-1]  # and so it has said that a wheel left the ground
