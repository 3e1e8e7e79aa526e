"""What `Campaign.compare` gives."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from ..inference.subject import applied
from ..report.figures import overlay_figure, where_figure
from .campaigns import UNIT_OF, Campaign
from .comparing import Compared, compared
from .frames import calibration_frame, framed, save
from .variants import Values, Variant, plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIMULATED = ".simulated"  # behind a channel's name


class Comparison:
    """Errors of a model on a campaign, whitened: 1.0 is what noise accounts for. `Campaign.compare` makes it.

    >>> compared
    Comparison(fit=16.956, holdout=18.259)
    """

    def __init__(self, found: Compared) -> None:
        self._campaign, self._compared = Campaign(found.campaign), found
        self._found, self._values = found.errors, found.values

    @property
    def values(self) -> dict[str, float]:
        """Values that the chair was given, those calibrated among them, by FMI name, SI units.

        >>> campaign.compare(values={"resistance.f_r": 0.015}).values["resistance.f_r"]
        0.015
        """
        return dict(self._values)

    @property
    def calibration(self) -> pd.DataFrame:
        """What became of the values that were fitted, as `Diagnosis.calibration` has it.

        >>> campaign.compare(calibrate=["chair.m"]).calibration.index.tolist()
        ['chair.m']
        """
        return calibration_frame(self._compared.calibration)

    @property
    def notes(self) -> tuple[str, ...]:
        """A sentence for each fault of the recordings, as of noise that is not as stated, for each fitted value that ends at a
        bound, or far from what was given, and for each run in which the model is beyond a limit of its own, as where a wheel
        leaves the ground.

        >>> compared.notes
        ()
        """
        return tuple(self._compared.notes)

    @property
    def rms(self) -> pd.DataFrame:
        """A row for each run: its role, and the whitened RMS error of each channel; NaN for a channel that it lacks.

        >>> compared.rms["yaw_rate"].round(1)["coast-down"].item()
        6.0
        """
        rows = {r.name: {"role": r.role, **r.rms} for r in self._found.runs}
        return pd.DataFrame.from_dict(rows, "index")

    @property
    def fit(self) -> float:
        """Whitened RMS error over all fitted runs; NaN where there are none.

        >>> compared.fit > 1
        True
        """
        return self._found.rms("fit")

    @property
    def holdout(self) -> float:
        """The same over all runs held out.

        >>> round(compared.holdout, 1)
        18.3
        """
        return self._found.rms("holdout")

    @property
    def excess(self) -> pd.DataFrame:
        """Where the error is: what share of the excess over noise lies where a regime (yaw rate, lateral force, …) is between
        `from` and `to` [SI], a quarter of the samples each.

        >>> compared.excess.columns.tolist()
        ['regime', 'from', 'to', 'share']
        """
        rows = [(n, *row) for n in self._found.runs[0].regime for row in self._found.excess_by(n)]
        return pd.DataFrame(rows, columns=["regime", "from", "to", "share"])

    def frame(self, run: str) -> pd.DataFrame:
        """A run as it was recorded and as the model has it, SI units, over time [s]: inputs by FMI name, each channel, and the
        same with `.simulated` behind its name. What was recorded more than 75 times a second is in means over 20 ms. Raises
        UsageError for an unknown run.

        >>> compared.frame("coast-down").columns.tolist()[-2:]
        ['a_y', 'a_y.simulated']
        """
        recorded = self._campaign._run(run)
        found = next(r for r in self._found.runs if r.name == run)
        columns, units = dict(recorded.inputs), dict(UNIT_OF)
        for i, channel in enumerate(found.channels):
            columns |= {channel: recorded.channels[channel], channel + SIMULATED: found.predicted[:, i]}
            units[channel + SIMULATED] = UNIT_OF[channel]
        return framed(recorded.time, columns, units)

    def save(self, folder: str | Path, *, kind: str = "csv") -> tuple[Path, ...]:
        """Write `frame` of each run into a folder, run-NAME.csv or with `kind` "parquet" .parquet, and return the paths.

        >>> compared.save("out", kind="parquet")[0].name
        'run-coast-down.parquet'
        """
        return tuple(save(self.frame(r.name), Path(folder) / f"run-{r.name}.{kind}") for r in self._found.runs)

    def plot_where(self) -> Figure:
        """The errors of each run and channel as a chart.

        >>> compared.plot_where().savefig("where.pdf")
        """
        channels = list(dict.fromkeys(ch for r in self._found.runs for ch in r.channels))
        rms = np.array([[r.rms.get(ch, np.nan) for ch in channels] for r in self._found.runs])
        return where_figure([r.name for r in self._found.runs], channels, rms)

    def plot_run(self, run: str) -> Figure:
        """What was recorded in a run and what the model has, the difference below. Raises UsageError for an unknown run.

        >>> compared.plot_run("coast-down").savefig("coast-down.png")
        """
        recorded, measured = self._campaign._run(run), self._campaign._record
        found = next(r for r in self._found.runs if r.name == run)
        offsets = {c: self._values[f"offset.{c}"] for c in measured.nuisance if f"offset.{c}" in self._values}
        return overlay_figure(
            run,
            recorded.time,
            {ch: recorded.channels[ch] for ch in found.channels},
            {ch: found.predicted[:, i] for i, ch in enumerate(found.channels)},
            {ch: self._compared.noise[ch] * recorded.noise_share(ch) for ch in found.channels},
            units=UNIT_OF,
            offsets=offsets,
        )

    def __repr__(self) -> str:
        return f"Comparison(fit={self.fit:.3f}, holdout={self.holdout:.3f})"

    def _repr_html_(self) -> str:
        return f"<p>whitened RMS error, 1.0 is the noise floor</p>{self.rms.round(2).to_html(na_rep='')}"


def compare(
    campaign: Campaign, variant: Variant | str | Path | None, *, values: Values | None, calibrate: Sequence[str]
) -> Comparison:
    """See `Campaign.compare`."""
    chair, measured, _ = applied(values or {}, plain(variant), campaign._record)
    return Comparison(compared(measured, chair, tuple(calibrate), lambda words: None))
