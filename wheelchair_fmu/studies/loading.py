"""Load an FMU by fmpy so that what it has to say can always be heard."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from fmpy.fmi2 import FMU2Slave
from fmpy.model_description import ModelDescription
from fmpy.simulation import instantiate_fmu

_latest: list[Any] = []


def loaded(folder: str, description: ModelDescription, log: Callable[..., None]) -> FMU2Slave:
    """An instance of the unpacked FMU, for co-simulation, whose messages go to `log`.

    fmpy's proxy keeps one logger for the whole process, by its address, and calls it whichever FMU speaks, even when the
    instance that brought it is gone: so the latest is kept alive here.
    """
    slave = instantiate_fmu(folder, description, "CoSimulation", logger=log)
    _latest[:] = [slave.callbacks]
    return slave
