"""How far off a chair is on a campaign: every run driven through the FMU, from the starts that its evidence finds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import chain, islice
from os import cpu_count
from typing import TypeVar

from ..campaign import Campaign, condensed, pieces, windows
from ..errors import UsageError, unknown
from ..inference.estimation.calibration import Calibrated, calibration, doubts
from ..inference.estimation.fit import fit
from ..inference.estimation.problem import start_values
from ..inference.evidence.initial_state import TUNING
from ..inference.evidence.likelihood import Likelihood
from ..inference.residual.compare import Comparison, RunErrors, errors_of, together
from ..inference.search.recordings import Taken, taken
from ..model.variant import Variant
from ..model.wheelchair import REGIMES
from ..studies import Fmu, fmu_of
from ..studies.measured import run_campaign_run

PIECE = 60.0  # s: a longer run is compared piece by piece
AT_ONCE = cpu_count() or 1  # pieces whose filters are made together, while those before them go through the FMU

Item = TypeVar("Item")


@dataclass(frozen=True)
class Compared:
    """Errors, the campaign as it was compared, the chair's values by FMI name (SI), what became of those that were fitted,
    sentences `heard` of recordings, and by channel the noise (SI) that errors are told in."""

    errors: Comparison
    campaign: Campaign
    values: Mapping[str, float]
    noise: Mapping[str, float]
    calibration: tuple[Calibrated, ...] = ()
    heard: tuple[str, ...] = ()

    @property
    def notes(self) -> list[str]:
        """A sentence for each fault of the recordings, for each fitted value that nobody should believe, and for each run in
        which the model holds no longer."""
        return [*self.heard, *doubts(self.calibration), *self.errors.limits]


def compared(
    measured: Campaign, chair: Variant, calibrate: Sequence[str], say: Callable[[str], None], *, brief: bool = False
) -> Compared:
    """Errors of the chair, by the columns, clocks and noise that a search of it finds, with the values of `calibrate` fitted;
    `brief` without what was simulated.

    Raises UsageError for a name that cannot be calibrated.
    """
    chair = chair.with_effects(measured.effects)  # for the FMU to have
    records = [p.name for p in chair.parameters()]
    for name in calibrate:
        if name not in records:  # before anything is compiled or fitted
            raise unknown("parameter", name, records)
    recordings = taken(condensed(measured), chair, say)
    fitted, told = _calibrated(recordings, chair, calibrate)
    values = {**chair.values, **fitted}
    runs = tuple(r.summary() if brief else r for r in _through_fmu(recordings, chair, values, say))
    noise = recordings.noise_model.sd
    return Compared(Comparison(runs), recordings.campaign, values, noise, tuple(told), recordings.notes)


def _calibrated(recordings: Taken, chair: Variant, names: Sequence[str]) -> tuple[Mapping[str, float], Sequence[Calibrated]]:
    """Fitted values of these parameters and of sensors' offsets, from windows of the campaign where it is large, and what there
    is to say of each parameter."""
    if not names and not recordings.campaign.nuisance:
        return {}, ()
    likelihood = Likelihood(windows(recordings.campaign), chair, recordings.noise_model)
    for name in names:
        if name not in likelihood.sensitivities.columns:
            raise UsageError(f"{name} cannot be calibrated; choose among {', '.join(likelihood.sensitivities.columns)}")
    wanted = [*names, *likelihood.offsets]  # sensors' offsets, where the campaign names them, are nobody's error
    if not wanted:
        return {}, ()
    found = fit(likelihood, wanted, start_values(likelihood, wanted))
    return found.values, calibration(likelihood, found)


def _through_fmu(
    recordings: Taken, chair: Variant, values: dict[str, float], say: Callable[[str], None]
) -> Iterator[RunErrors]:
    """Each run driven through the FMU, a long one piece by piece, from the starts that its evidence finds."""
    measured = recordings.campaign
    cut = {run.name: pieces(run, PIECE) for run in measured.runs}
    whole = replace(measured, runs=tuple(piece for run in cut.values() for piece in run))
    likelihood = Likelihood(whole, chair, recordings.noise_model)
    outputs = chair.model().outputs
    batches = (parts[i : i + AT_ONCE] for parts in cut.values() for i in range(0, len(parts), AT_ONCE))
    batch_by_batch = _ahead(likelihood.only(batch).evidence(batch, values, (), tune_start=TUNING).runs for batch in batches)
    evidence = chain.from_iterable(batch_by_batch)
    with Fmu(fmu_of(chair)) as fmu:
        for name, parts in cut.items():
            say(f"simulating {name}")
            found = []
            for e in islice(evidence, len(parts)):
                given = {**measured.known, **values, **e.started}
                given = {n: v for n, v in given.items() if n in fmu.parameters}
                predicted = run_campaign_run(fmu, likelihood.on_time(e.run, values, e.start), given)
                found.append(errors_of(e, predicted, REGIMES, outputs))
            yield together(name, found)


def _ahead(items: Iterable[Item]) -> Iterator[Item]:
    """The same items, each made while the one before it is used."""
    with ThreadPoolExecutor(1) as beside:
        making = beside.submit(next, iterator := iter(items), None)
        while (item := making.result()) is not None:
            making = beside.submit(next, iterator, None)
            yield item
