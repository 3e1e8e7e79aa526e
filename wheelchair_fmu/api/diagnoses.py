"""Which effect is missing: what `diagnose` gives."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from io import StringIO
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from .. import campaign as measured
from ..errors import Failure, unknown
from ..inference.decision import improve, verdict
from ..inference.subject import applied, known_parameters, narrowed
from ..model import variant as chairs
from ..report import latex
from ..report.estimates_figure import estimates_figure
from ..report.figures import missing_figure, staircase_figure
from ..report.saving import save_svg
from ..report.words import particulars, sentence
from ..writing import written
from .campaigns import Campaign
from .diagnosing import page_of, searched, supplement_of
from .frames import calibration_frame
from .variants import Values, Variant, of_record, plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NORMAL = 1.96  # standard errors, where no profile of the likelihood was taken
LIKELIEST = 10  # estimates that are drawn


def diagnose(
    campaign: Campaign | str | Path,
    variant: Variant | str | Path | None = None,
    *,
    values: Values | None = None,
    own_effects: str | Path | None = None,
    among: Iterable[str] | None = None,
    progress: Callable[[str], None] | None = None,
) -> Diagnosis:
    """Find which physical effects a chair lacks, as a campaign shows it, or that this campaign cannot tell.

    `campaign` is what `read` gave, or its folder; `variant` is the chair to start from (a Variant, a TOML file, or None for the
    paper's with what the campaign says of it). `values` are FMI parameters by name, SI units, which go before the campaign's
    and are not estimated. `own_effects` is a folder of effect files of your own, which are programs. `among` are ids of the
    effects that are asked about, all of the catalogue unless given; what is not asked about can be neither found nor tied, so
    that a verdict says less. `progress` is told what is being done, a sentence at a time. The first time, models are compiled.

    Raises CampaignError for a campaign with faults, UsageError for an unknown name, and EffectError for effect files with
    faults. How verdicts come about, and how far to trust them, is in docs/verdicts.md.

    >>> found = wc.diagnose(campaign)
    >>> found.verdict, found.effects
    ('missing', ('rolling_resistance_asymmetry',))
    """
    start = plain(variant, own_effects)
    given = (
        campaign._record
        if isinstance(campaign, Campaign)
        else measured.read(campaign, known_parameters(start.catalogue, start.choice))
    )
    chair, known, fixed = applied(values or {}, start, given)
    if among is not None:
        chair = narrowed(chair, among)
    known = measured.windows(known)
    found, told = searched(known, chair, fixed, progress or (lambda words: None))
    return Diagnosis(known, chair, fixed, found, told)


class Diagnosis:
    """A verdict with its evidence; `diagnose` makes it.

    >>> found
    Diagnosis('sample-chair', verdict='missing', effects=['rolling_resistance_asymmetry'])
    """

    def __init__(
        self,
        campaign: measured.Campaign,
        chair: chairs.Variant,
        fixed: Sequence[str],
        found: verdict.Diagnosis,
        told: dict[str, Any],
    ) -> None:
        self._campaign, self._chair, self._fixed, self._found, self._told = campaign, chair, tuple(fixed), found, told

    @property
    def verdict(self) -> str:
        """One of "missing", "tie" (one of these, and the campaign cannot tell which), "small" (there, but too small to matter),
        "adequate" (nothing is missing), "cannot_see" (these runs could not show many effects) and "outside" (nothing in the
        catalogue explains what is left).

        >>> found.verdict
        'missing'
        """
        return str(self._told["verdict"])

    @property
    def effects(self) -> tuple[str, ...]:
        """Ids of the effects that are missing, in the order in which they were found, or of those that tie.

        >>> found.effects
        ('rolling_resistance_asymmetry',)
        """
        return tuple(self._told["effects"])

    @property
    def ties(self) -> tuple[tuple[str, ...], ...]:
        """Groups of effects that this campaign cannot tell apart.

        >>> found.ties
        ()
        """
        return tuple(map(tuple, self._told["ties"]))

    @property
    def sentence(self) -> str:
        """The verdict for a person.

        >>> found.sentence
        'Missing from the model: one rear wheel that rolls harder than the other.'
        """
        return sentence(self._told, {e.id: e.title for e in self._found.models.factory.catalogue.values()})

    @property
    def probabilities(self) -> dict[str, float]:
        """The probability of each effect, by its id, that its size exceeds the smallest interesting one, the likeliest effect
        first.

        >>> effect, probability = next(iter(found.probabilities.items()))
        >>> print(f"{effect}: {probability:.2f}")
        rolling_resistance_asymmetry: 1.00
        """
        return probabilities_in(self._told["ranking"])

    @property
    def estimates(self) -> pd.DataFrame:
        """A row for each parameter of each effect of the catalogue, the likeliest effect first, by (effect, parameter): its
        `estimate`, standard error `se` and the ends `lower` and `upper` of a 95 % interval in `unit` (SI), the size that is
        `smallest_interesting`, the effect's `p` that chance alone does as much, the `probability` that it exceeds that size,
        and its `verdict`. Intervals of effects that were found are by the profile of the likelihood, others are ± 1.96
        standard errors. An effect that was not found is estimated alone, in the place of those that were: what looks like one
        of them has a size and a small `p` there, too. It is "not needed" beside what was found, or these runs "cannot_see" it.

        >>> D = found.estimates.loc[("rolling_resistance_asymmetry", "D")]
        >>> print(f"{D.estimate:.2f} ± {D.se:.2f} {D.unit}")
        1.61 ± 0.01 N
        """
        rows = list(_estimates(self._told["ranking"]))
        return pd.DataFrame(rows).set_index(["effect", "parameter"])

    @property
    def calibration(self) -> pd.DataFrame:
        """A row for each value that was given and fitted, by its FMI name: value, `se`, `prior`, `prior_sd` (NaN: nothing was
        known), in `unit` (SI), whether it lies `at_bound` or `beyond` what anybody would have measured, and how far a fit may
        go, `lower` and `upper`.

        >>> m = found.calibration.loc["chair.m"]
        >>> print(f"{m.value:.0f} {m.unit}, given as {m.prior:.0f} ± {m.prior_sd:.0f}")
        80 kg, given as 80 ± 2
        """
        return calibration_frame(self._found.calibration)

    @property
    def staircase(self) -> pd.DataFrame:
        """The error falling: a row for each step ("nominal", "calibrated", "+id", …) with the whitened RMS error on fitted
        runs, `fit`, and on runs held out, `heldout` (NaN where there are none); 1.0 is the noise floor.

        >>> found.staircase.index.tolist()
        ['nominal', 'calibrated', '+rolling_resistance_asymmetry']
        """
        return steps(self._told["ladder"])

    @property
    def errors(self) -> pd.DataFrame:
        """What the last model leaves of each channel, in its `unit` (m/s, deg/s, …): RMS on held-out and on fitted runs, its
        share of the readings' standard deviation, and what the best constant for each run would leave.

        >>> found.errors.loc["yaw_rate", "unit"]
        'deg/s'
        """
        rows = {c: {k: v for k, v in told.items() if k != "runs"} for c, told in self._told["physical"].items()}
        return pd.DataFrame.from_dict(rows, "index").rename_axis("channel")

    @property
    def odds(self) -> tuple[dict[str, float], ...]:
        """For each group of effects that tie, the probability that it is each of them.

        >>> found.odds
        ()
        """
        return tuple(dict(one) for one in self._told["odds"])

    @property
    def next_experiment(self) -> dict[str, Any] | None:
        """What to measure next (`manoeuvre`, `separates`, `repeats`, `why`), where that would tell more.

        Of a tie it says as well what there is to see: `shows` has the `channel` to look at, `time` [s], `readings` (SI) by each
        of the two, and the `noise` of one reading.

        >>> found.next_experiment is None
        True
        """
        following = self._told["next_experiment"]
        return None if following is None else dict(following)

    @property
    def notes(self) -> tuple[str, ...]:
        """A sentence for each thing that is odd about the measurements or the values.

        >>> found.notes
        ()
        """
        return tuple(self._told["notes"])

    @property
    def seconds(self) -> float:
        """How long it took [s].

        >>> found.seconds > 0
        True
        """
        return float(self._told["seconds"])

    def as_dict(self) -> dict[str, Any]:
        """All of it as plain data, as `wheelchair diagnose --json` writes it; docs/diagnosis.md has the keys.

        >>> found.as_dict()["verdict"]
        'missing'
        """
        return dict(json.loads(json.dumps(self._told)))

    def add(self, *effects: str) -> Variant:
        """Fit the chair again with one more effect, or several, and return it; its `staircase` shows what that does.

        Raises UsageError for an unknown id, and Failure where such a chair cannot be simulated on these runs, or fits them
        worse than without.

        >>> better = found.add("rolling_resistance_asymmetry")
        >>> round(better.values["effect.rolling_resistance_asymmetry.D"], 1), bool(better.staircase["heldout"].iloc[-1] < 1.05)
        (1.6, True)
        """
        for effect in effects:
            if effect not in self._chair.catalogue:
                raise unknown("effect", effect, self._chair.catalogue)
        better = improve.add(self._campaign, self._chair, effects, self._fixed)
        return of_record(better.variant, steps(step.as_json() for step in better.ladder))

    def save(self, path: str | Path) -> Path:
        """Write it by the path's ending, and return the path: .json (`as_dict`), .csv (`estimates`), .tex (estimates of the
        effects found and the calibrated values, as a table for LaTeX with booktabs) or .html (the page of `wheelchair report`,
        for which ziglang has to be installed). Raises UsageError for another ending.

        >>> found.save("estimates.tex").read_text().splitlines()[0]
        '\\\\begin{tabular}{lrrl}'
        """
        path = Path(path)
        writers = {".json": self._json, ".csv": self._csv, ".tex": self._tex, ".html": self._page}
        if path.suffix.lower() not in writers:
            raise unknown("form of a diagnosis that ends in", path.suffix, writers)
        text = writers[path.suffix.lower()]()
        with written(path) as beside:
            beside.write_text(text, encoding="utf-8", newline="\n")
        return path

    def paper(self, folder: str | Path) -> tuple[Path, ...]:
        """Write what a paper's supplement needs into a folder, and return the files: the methods with every number filled in
        (Markdown and LaTeX, with their references), estimates with 95 % intervals and covariance, errors by channel at every
        step, what was left out and why, fingerprints of data and code, and two figures, 170 mm wide. Other files there stay.

        Raises OSError where nothing can be written, and CampaignError where the campaign's files are no longer there; see
        docs/supplement.md.

        >>> [file.name for file in found.paper("supplement")][:4]
        ['methods.md', 'methods.tex', 'references.bib', 'estimates.csv']
        """
        return supplement_of(self._campaign, self._chair, self._told, self._fixed, Path(folder), str(self._told["campaign"]))

    def plot_staircase(self) -> Figure:
        """The error falling, step by step.

        >>> found.plot_staircase().savefig("staircase.pdf")
        """
        return staircase_figure(self._told["ladder"])

    def plot_estimates(self) -> Figure:
        """Estimates of the likeliest effects with their intervals, beside what would be of interest.

        >>> found.plot_estimates().savefig("estimates.pdf")
        """
        rows = [
            {**row, "name": f"{row['effect']}.{row['parameter']}", "found": row["effect"] in self._found.included}
            for row in _estimates(self._told["ranking"])
        ]
        return estimates_figure(rows[:LIKELIEST])

    def plot_missing(self) -> Figure:
        """What is missing, as the data would have it, against speed, yaw rate, heading, push and caster angle; where no term is
        proposed, the force that nobody recorded, against what orders it.

        Raises Failure unless the verdict is "outside" with one of these.

        >>> found.plot_missing()
        Traceback (most recent call last):
        wheelchair_fmu.errors.Failure: the verdict is missing, and no term is proposed whose form could be shown
        """
        lacking = self._told["missing"]
        if lacking is None:
            raise Failure(f"the verdict is {self.verdict}, and no term is proposed whose form could be shown")
        return missing_figure(lacking["words"], lacking["unit"], lacking["panels"])

    def _json(self) -> str:
        return json.dumps(self._told, indent=2, ensure_ascii=False) + "\n"

    def _csv(self) -> str:
        return str(self.estimates.to_csv(float_format="%.10g", lineterminator="\n"))

    def _tex(self) -> str:
        found = (r for r in _estimates(self._told["ranking"]) if r["effect"] in self.effects)
        effects = [
            (f"{r['effect']}.{r['parameter']}", *(r[k] for k in ("estimate", "se", "lower", "upper", "unit"))) for r in found
        ]
        ends = {p["name"]: p["interval"] for p in self._told["final"]["parameters"] if p["interval"]}
        others = [
            (c.record.name, c.value, c.se, *ends.get(c.record.name, _ends(c.value, c.se)), c.record.unit.name)
            for c in self._found.calibration
        ]
        return latex.table([*effects, *others])

    def _page(self) -> str:
        return page_of(self._campaign, self._chair, self._told, self._fixed)

    def __repr__(self) -> str:
        return f"Diagnosis({self._told['campaign']!r}, verdict={self.verdict!r}, effects={list(self.effects)})"

    def _repr_html_(self) -> str:
        records = {p.name: p for e in self._found.models.factory.catalogue.values() for p in e.owned}
        said = "".join(f"<li>{escape(words)}</li>" for words in particulars(self._told, records))
        picture = StringIO()
        save_svg(self.plot_staircase(), picture)
        drawn = picture.getvalue()
        return f"<h4>{escape(self.sentence)}</h4><ul>{said}</ul>{drawn[drawn.index('<svg') :]}"


def probabilities_in(ranking: Iterable[Mapping[str, Any]]) -> dict[str, float]:
    """By effect, from the rows of a ranking that have one."""
    found = {row["effect"]: float(row["probability"]) for row in ranking if row.get("probability") is not None}
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def steps(ladder: Iterable[Mapping[str, Any]]) -> pd.DataFrame:
    """A staircase as a frame."""
    return pd.DataFrame([{k: row[k] for k in ("step", "fit", "heldout")} for row in ladder]).set_index("step").astype(float)


def _estimates(ranking: Iterable[Mapping[str, Any]]) -> Iterable[dict[str, Any]]:
    for row in ranking:
        for name, p in row["parameters"].items():
            se = nan if p["se"] is None else p["se"]
            lower, upper = p.get("interval") or _ends(p["estimate"], se)
            yield {
                "effect": row["effect"],
                "parameter": name,
                "estimate": p["estimate"],
                "se": se,
                "lower": lower,
                "upper": upper,
                "unit": p["unit"],
                "smallest_interesting": p["smallest_interesting"],
                "p": row["p"],
                "probability": nan if row["probability"] is None else row["probability"],
                "verdict": row["verdict"],
            }


def _ends(estimate: float, se: float) -> tuple[float, float]:
    return estimate - NORMAL * se, estimate + NORMAL * se
