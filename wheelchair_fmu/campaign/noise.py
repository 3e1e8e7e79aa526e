"""Noise of each channel: as the campaign states it, or from the channel's own high frequencies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..units import UnitError, quantity
from .channels import BY_NAME, CHANNEL_NAMES, INPUT_NAMES, MOMENTUM, PUSH_NAMES
from .document import Document, number
from .recorded import Recorded
from .series import estimate

QUIETEST, LOUDEST = 1e-13, 1e3  # noise, as a share of the largest plausible reading
NAMES = (*CHANNEL_NAMES, *PUSH_NAMES, MOMENTUM)  # what [noise] may name


@dataclass(frozen=True)
class Noise:
    """Standard deviations in SI by channel or push.

    `seen` is what the data show, `estimated` those taken from it, `unknown` those that neither the file nor the
    data give. `faults` are (dotted key, error) of what [noise] and [nuisance] state wrongly.
    """

    sd: dict[str, float]
    seen: dict[str, float | None]
    estimated: frozenset[str]
    unknown: tuple[str, ...]
    nuisance_sd: dict[str, float]
    faults: tuple[tuple[str, UnitError], ...]


def gather(doc: Document, runs: Sequence[Recorded]) -> Noise:
    """Noise of everything measured or pushed: as stated, else as the data show."""
    sd, faults = _stated(doc, "noise", NAMES, runs)
    nuisance_sd, more = _stated(doc, "nuisance", NAMES, runs)
    wrong = {path for path, _ in faults}
    seen: dict[str, float | None] = {}
    estimated, missing = set(), []
    for name in NAMES:
        logged = [d.logged[name] for d in runs if name in d.logged and _moves(d.logged[name])]
        made = [d.noise[name] for run in runs for d in run.drafts if name in d.noise]
        if logged:
            seen[name] = float(np.median(made)) if made else estimate(logged)
        if name in sd or f"noise.{name}" in wrong:
            continue
        value = seen.get(name)
        if value is not None and _possible(name, value):
            sd[name] = value
            estimated.add(name)
        elif name in INPUT_NAMES:
            if logged or name in ("F_rl", "F_rr"):
                sd[name] = 0.0  # nobody pushed, and the file knows it exactly
        elif any(name in run.measured for run in runs):
            missing.append(name)
    return Noise(sd, seen, frozenset(estimated), tuple(missing), nuisance_sd, (*faults, *more))


def _moves(series: np.ndarray) -> bool:
    """Whether there is anything but gaps and one value: a sensor that is stuck shows no noise."""
    finite = series[np.isfinite(series)]
    return finite.size > 1 and bool(finite.min() < finite.max())


def _stated(
    doc: Document, table: str, names: Sequence[str], runs: Sequence[Recorded]
) -> tuple[dict[str, float], list[tuple[str, UnitError]]]:
    """What a table states, in SI: a number is in the unit of the channel's column, text brings its own."""
    found, faults = {}, []
    for name, value in doc.table(table).items():
        if name not in names or (table == "nuisance" and isinstance(value, bool)):
            continue
        try:
            found[name] = _sd(name, value, runs)
        except UnitError as error:
            faults.append((f"{table}.{name}", UnitError(f"[{table}] {name}: {error.fact}", error.cure)))
    return found, faults


def _sd(name: str, value: Any, runs: Sequence[Recorded]) -> float:
    unit = BY_NAME[name].unit.name
    if isinstance(value, str):
        sd = quantity(value, unit)
    else:
        plain = number(value)
        if plain is None:
            raise UnitError(f"{value!r} is not a number", "give a standard deviation above 0")
        found = [d.bindings.found for run in runs for d in run.drafts]
        scales = {abs(bound[name].scale) for bound in found if name in bound}
        if len(scales) > 1:
            cure = f"write the unit with it, as in {name} = '{plain:g} {unit}'"
            raise UnitError(f"{plain:g} could be in several units, as the runs' columns differ", cure)
        sd = plain * (scales.pop() if scales else 1.0)
    if not sd > 0:
        raise UnitError(f"{value!r} is not positive", "give a standard deviation above 0")
    if not _possible(name, sd):
        raise UnitError(f"{sd:g} {unit} is no noise of a sensor", f"give a standard deviation in {unit}, or with its unit")
    return sd


def _possible(name: str, sd: float) -> bool:
    """Neither below the rounding of what is measured, nor far above all that is."""
    high = BY_NAME[name].high
    return QUIETEST * high < sd < LOUDEST * high
