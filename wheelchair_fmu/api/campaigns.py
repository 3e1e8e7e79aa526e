"""Measurements: a campaign that was read without errors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from .. import campaign as measured
from ..contracts.own import catalogue
from ..errors import unknown
from ..inference.subject import known_parameters
from .frames import framed

if TYPE_CHECKING:
    from .comparisons import Comparison
    from .diagnoses import Diagnosis
    from .variants import Values, Variant

UNIT_OF = {c.name: c.unit.name for c in measured.CHANNELS} | {c.fmu: c.unit.name for c in measured.INPUTS}


def read(path: str | Path, *, own_effects: str | Path | None = None) -> Campaign:
    """The campaign in a folder, or of a campaign.toml, in SI units and the axes of SAE J670.

    Where it gives sizes to effects of your own, `own_effects` is the folder of their files, which are programs.

    Raises CampaignError with every fault of its files, each with place, fact and cure (what `wheelchair check` prints as
    errors); what is odd but no error is in `Campaign.warnings`.

    >>> campaign = wc.read("my-campaign")
    >>> campaign.name, len(campaign.runs)
    ('sample-chair', 10)
    """
    return Campaign(measured.read(path, known_parameters(catalogue(None if own_effects is None else Path(own_effects)))))


class Campaign:
    """Runs with what is known of the chair and its sensors; `read` makes it.

    >>> campaign
    Campaign('sample-chair', 10 runs)
    """

    def __init__(self, record: measured.Campaign) -> None:
        self._record = record

    @property
    def name(self) -> str:
        """What the campaign is called.

        >>> campaign.name
        'sample-chair'
        """
        return self._record.name

    @property
    def path(self) -> Path:
        """Its campaign.toml.

        >>> campaign.path.name
        'campaign.toml'
        """
        return self._record.path

    @property
    def fingerprint(self) -> str:
        """SHA-256 over campaign.toml and every file that it names: which measurements a result is of.

        >>> len(campaign.fingerprint)
        64
        """
        return self._record.fingerprint

    @property
    def warnings(self) -> tuple[str, ...]:
        """A sentence for each thing that is odd, but no error.

        >>> campaign.warnings
        ()
        """
        return tuple(str(fault) for fault in self._record.warnings)

    @property
    def runs(self) -> pd.DataFrame:
        """A row for each run, by its name: role ("fit" or "holdout"), manoeuvre, samples, and duration [s].

        >>> print(*campaign.runs.loc["coast-down"])
        fit coast-down 1101 11.0
        """
        rows = {r.name: (r.role, r.manoeuvre, len(r.time), round(float(r.time[-1] - r.time[0]), 9)) for r in self._record.runs}
        return pd.DataFrame.from_dict(rows, "index", columns=["role", "manoeuvre", "samples", "duration"])

    @property
    def noise(self) -> pd.DataFrame:
        """A row for each channel and input that was recorded: one standard deviation `sd`, its unit, and whether it was
        estimated from the data, because campaign.toml does not give it.

        >>> print(*campaign.noise.loc["yaw_rate"])
        0.006 rad/s False
        """
        names = {**UNIT_OF, **{c.name: c.unit.name for c in measured.INPUTS}}
        rows = {n: (sd, names[n], n in self._record.noise_estimated) for n, sd in self._record.noise.items()}
        return pd.DataFrame.from_dict(rows, "index", columns=["sd", "unit", "estimated"])

    def frame(self, run: str) -> pd.DataFrame:
        """What was recorded in a run: inputs by FMI name and channels by their own, SI units, over time [s]; NaN in gaps.

        `frame.attrs["units"]` has the units by column. Raises UsageError for an unknown run.

        >>> campaign.frame("coast-down").columns.tolist()[-2:]
        ['a_x', 'a_y']
        """
        found = self._run(run)
        return framed(found.time, {**found.inputs, **found.channels}, UNIT_OF)

    def compare(
        self, variant: Variant | str | Path | None = None, *, values: Values | None = None, calibrate: Sequence[str] = ()
    ) -> Comparison:
        """Simulate every run as an FMU, and say how far off the model is, in standard deviations of what noise accounts for.

        `variant` is the chair (a Variant, a TOML file, or None for the paper's with what the campaign says of it), `values` are
        FMI parameters by name, SI units, which go before the campaign's, and `calibrate` names parameters to be fitted first.

        Raises UsageError for an unknown name, and SimulationError where the model cannot run.

        >>> compared = campaign.compare(values={"effect.rolling_resistance_asymmetry.D": 1.6})
        >>> bool(compared.holdout < campaign.compare().holdout)
        True
        """
        from .comparisons import compare

        return compare(self, variant, values=values, calibrate=calibrate)

    def diagnose(
        self,
        variant: Variant | str | Path | None = None,
        *,
        values: Values | None = None,
        own_effects: str | Path | None = None,
        among: Iterable[str] | None = None,
        progress: Callable[[str], None] | None = None,
    ) -> Diagnosis:
        """The same as `wc.diagnose(campaign, …)`.

        >>> campaign.diagnose().verdict
        'missing'
        """
        from .diagnoses import diagnose

        return diagnose(self, variant, values=values, own_effects=own_effects, among=among, progress=progress)

    def export(
        self, folder: str | Path, variant: Variant | str | Path | None = None, *, fit: Sequence[str] = ()
    ) -> tuple[Path, ...]:
        """Write the problem of fitting a chair to this campaign for other programs, and return the paths, problem.yaml first.

        Tables are after PEtab 2: parameters with bounds and priors (what is calibrated, those of the effects named in `fit`,
        and each run's start), conditions, experiments, measurements, observables and a mapping to FMI names; runs held out are
        in holdout.tsv. Offsets of sensors that the campaign leaves open are parameters of the observables. The model is an FMU
        2.0, and inputs/ has each run's pushes as they were recorded, both of which PEtab itself has not.

        Raises UsageError for an unknown effect, and for one that is no part of an FMU.

        >>> campaign.export("problem", fit=["rolling_resistance_asymmetry"])[0].name
        'problem.yaml'
        """
        from .problems import export
        from .variants import plain

        return export(self._record, plain(variant), tuple(fit), Path(folder))

    def _run(self, name: str) -> measured.Run:
        found = {r.name: r for r in self._record.runs}
        if name not in found:
            raise unknown("run", name, found)
        return found[name]

    def __repr__(self) -> str:
        return f"Campaign({self.name!r}, {len(self._record.runs)} runs)"

    def _repr_html_(self) -> str:
        warned = "".join(f"<li>{escape(words)}</li>" for words in self.warnings)
        return f"<h4>{escape(self.name)}</h4>{self.runs.to_html()}{warned and f'<ul>{warned}</ul>'}"
