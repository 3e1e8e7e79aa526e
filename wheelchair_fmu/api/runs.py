"""The chair put through a manoeuvre, or through push forces of one's own."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ..errors import UsageError
from ..handling.manoeuvres import Manoeuvre, manoeuvre
from ..model.choice import Choice
from ..model.former import renamed
from ..studies import Fmu, Result, fmu_of
from .frames import framed
from .variants import Values, Variant, chair_of


def simulate(
    course: str | pd.DataFrame,
    *,
    speed: float | None = None,
    delta_force: float | None = None,
    period: float | None = None,
    time: float | None = None,
    variant: Variant | str | Path | None = None,
    values: Values | None = None,
    effects: str | Sequence[str] = "default",
    equations: str | None = None,
    fmu: str | Path | None = None,
    **options: float,
) -> pd.DataFrame:
    """Put the chair through a manoeuvre, as an FMU, and return all inputs and outputs over time.

    `course` is a manoeuvre ("steady-turn", "slalom", "coast-down", "start-stop", "spin"), of which `speed` [m/s], `delta_force`
    [N] (F_rl − F_rr = 2ΔF, positive turns right), `period` [s] and `time` [s] may be given, and `options` of one of
    your own; or a frame of inputs by FMI name
    (`push.F_rl` [N], `push.F_rr`, …; linear between samples, the rest at their start values) over an index of times [s].
    `values` are FMI parameters by name, SI units. `variant` and `effects` are as in `build`; or `fmu` is a finished FMU 2.0.

    Returns a frame with a row for each sample, its index the time [s], its columns inputs and outputs by FMI name, SI units,
    which `frame.attrs["units"]` has by column; `save` writes it with them. What the FMU warns of is a RuntimeWarning.

    Raises UsageError for an unknown name or a value out of bounds, BuildError where the FMU cannot be built, and
    SimulationError, with the FMU's own sentence, where it cannot go on.

    >>> turn = wc.simulate("steady-turn", speed=1.0, delta_force=10.0)
    >>> print(turn["chair.curvature"].iloc[-1].round(3), turn.attrs["units"]["chair.curvature"])
    0.303 1/m
    >>> import pandas as pd
    >>> push = pd.DataFrame({"push.F_rl": [0, 20, 0], "push.F_rr": [0, 20, 0]}, index=[0.0, 0.5, 1.0])
    >>> wc.simulate(push, values={"start.u": 0})["chair.u"].round(2).tolist()
    [0.0, 0.06, 0.11]
    """
    if isinstance(course, str):
        chosen = manoeuvre(course, speed=speed, delta_force=delta_force, period=period, time=time, **options)
    else:
        chosen = _recorded(course, speed=speed, delta_force=delta_force, period=period, time=time, **options)
    result, _ = driven(chosen, variant, values or {}, effects, equations, fmu)
    for words in result.warnings:
        warnings.warn(words, RuntimeWarning, stacklevel=2)
    return frame_of(chosen, result)


def driven(
    course: Manoeuvre,
    variant: Variant | str | Path | None,
    values: Values,
    effects: str | Sequence[str],
    equations: str | None,
    fmu: str | Path | None,
) -> tuple[Result, Mapping[str, float]]:
    """What the FMU of the chair asked for does on a course, and the values that it was given. Raises as `simulate`."""
    if fmu and (variant or effects != "default" or equations):
        raise UsageError("a finished FMU has its variant, effects and equations; leave these out, or the FMU")
    own: dict[str, float | str] = {}
    if fmu is None:
        chair, chosen = chair_of(variant, values, effects, equations)
        any_law = replace(chair, choice=replace(chair.choice, tyre=Choice().tyre))  # one FMU holds all tyre laws
        fmu, own = fmu_of(any_law, chosen), {**chair.values, "tyre.law": chair.choice.tyre}
        values = renamed(values, chair.values)[0]
    with Fmu(fmu) as drive:
        known = {n: v for n, v in own.items() if n in drive.parameters}
        given = drive.checked({**known, **course.values, **values})
        return drive.run(course.time, course.inputs, given), given


def frame_of(course: Manoeuvre, result: Result) -> pd.DataFrame:
    """Inputs and outputs over time."""
    return framed(result.time, {**course.inputs, **result.columns}, result.units)


def _recorded(inputs: pd.DataFrame, **options: float | None) -> Manoeuvre:
    """A frame of inputs as a course."""
    for name, value in options.items():
        if value is not None:
            raise UsageError(f"{name} is of a manoeuvre; leave it out, or give a manoeuvre by name in place of the inputs")
    columns: dict[str, Any] = {str(name): inputs[name].to_numpy(float) for name in inputs.columns}
    return Manoeuvre("inputs", "given inputs", {}, np.asarray(inputs.index, float), columns, "chair.u")
