"""A measured run through an FMU: the recorded pushes in, what the sensors should have read out."""

from __future__ import annotations

import numpy as np

from ..campaign import CHANNELS, Run
from ..errors import SimulationError
from .driving import Fmu, Values

PREDICTS = {channel.name: channel.fmu for channel in CHANNELS}
STARTS = {channel.starts: channel.name for channel in CHANNELS if channel.starts and channel.drifts}  # where tracking tells it

CASTER_START = "start.caster_"


def run_campaign_run(fmu: Fmu, run: Run, values: Values) -> dict[str, np.ndarray]:
    """Predictions (n,) of the run's channels, by channel name, SI units and SAE J670 axes.

    `values` are FMI parameters for all runs; the run's own `set` goes before them. Unless they say otherwise the
    chair starts at `run.u0`, and where position was tracked at its first reading.

    Raises UsageError for an unknown or impossible value and SimulationError, naming the run, where the FMU refuses.
    """
    try:
        result = fmu.run(run.time, run.inputs, {**_starts(fmu, run), **values, **_set(fmu, run)})
    except SimulationError as error:
        raise SimulationError(f"run {run.name}: {error}") from error
    return {name: result[PREDICTS[name]] for name in run.channels}


def _starts(fmu: Fmu, run: Run) -> dict[str, float]:
    found = {start: _first(run.channels[name]) for start, name in STARTS.items() if name in run.channels}
    if run.u0 is not None:
        found["start.u"] = run.u0
    return {name: value for name, value in found.items() if name in fmu.parameters}


def _set(fmu: Fmu, run: Run) -> dict[str, float]:
    """What the run sets, but for where its casters start in a chair whose casters have no angle of their own."""
    return {name: v for name, v in run.set.items() if name in fmu.parameters or not name.startswith(CASTER_START)}


def _first(series: np.ndarray) -> float:
    """The first reading that is not a gap; a channel has at least one."""
    return float(series[np.isfinite(series)][0])
