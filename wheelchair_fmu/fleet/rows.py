"""One diagnosis as a row of numbers and words; and the same by effect."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd
import pyarrow as pa

from ..chunks import ERROR
from ..inference.decision.diagnosis import Diagnosis
from ..inference.estimation.statistics import finite
from ..inference.explain.ranking import ranking
from ..model.variant import Variant

WORDS = {
    "folder": "where the campaign is",
    "campaign": "its name",
    "verdict": "missing, tie, small, adequate, cannot_see or outside",
    "effects": "what is missing, in the order found, with commas; in a tie what is tied",
    "ties": "effects that this campaign cannot tell apart, with commas; groups with semicolons",
    "proposal": "where the verdict is outside: the term that would explain it",
    "key": "of what decides this row: the campaign's files, the question and the program",
    "notes": "what the diagnosis says beside, with semicolons",
}
NUMBERS = {
    "rms_fit_nominal": "whitened RMS error over fitted runs, with what the campaign file says",
    "rms_holdout_nominal": "over runs held out",
    "rms_fit_calibrated": "over fitted runs, calibrated",
    "rms_holdout_calibrated": "over runs held out, calibrated",
    "rms_fit": "over fitted runs, with what was found",
    "rms_holdout": "over runs held out, with what was found",
}
SE, KEY = ".se", "key"


def schema(chair: Variant, metadata: Mapping[str, str]) -> pa.Schema:
    """Columns of the table: words, numbers, and each parameter of the catalogue with its standard error, by FMI name."""
    records = [p for e in chair.catalogue.values() for p in e.owned if p.estimated]
    units = [(name, p.unit.name) for p in records for name in (p.name, p.name + SE)]
    return pa.schema(
        [
            *(pa.field(name, pa.string(), metadata={"meaning": meaning}) for name, meaning in WORDS.items()),
            *(pa.field(name, pa.float64(), metadata={"unit": "1", "meaning": meaning}) for name, meaning in NUMBERS.items()),
            pa.field(ERROR, pa.string(), metadata={"meaning": "why this campaign was not diagnosed; empty where it was"}),
            *(pa.field(name, pa.float64(), metadata={"unit": unit}) for name, unit in units),
        ],
        metadata=dict(metadata),
    )


def of_diagnosis(d: Diagnosis) -> dict[str, Any]:
    """What a row says of a diagnosis. Parameters are those of effects found and of their rivals in a tie."""
    nominal, calibrated, last = d.ladder[0], d.ladder[1], d.ladder[-1]
    return {
        "verdict": d.verdict,
        "effects": ", ".join(d.effects),
        "ties": "; ".join(", ".join(group) for group in d.ties),
        "proposal": d.proposal.effect if d.proposal else "",
        "notes": "; ".join(d.notes),
        "rms_fit_nominal": nominal.fit,
        "rms_holdout_nominal": finite(nominal.heldout),
        "rms_fit_calibrated": calibrated.fit,
        "rms_holdout_calibrated": finite(calibrated.heldout),
        "rms_fit": last.fit,
        "rms_holdout": finite(last.heldout),
        **_estimates(d),
    }


def _estimates(d: Diagnosis) -> dict[str, float | None]:
    named = {*d.effects, *(effect for group in d.ties for effect in group)}
    found: dict[str, float | None] = {}
    for row in ranking(d):
        for name, value in row["parameters"].items() if row["effect"] in named else ():
            full = f"effect.{row['effect']}.{name}"
            found |= {full: value["estimate"], full + SE: value["se"]}
    return found


def long(table: pa.Table) -> pd.DataFrame:
    """A line for each campaign and parameter of an effect it names: `folder`, `campaign`, `verdict`, `effect`, `parameter`,
    `unit`, `estimate`, `se` (empty where the data do not tell)."""
    lines = []
    units = {
        field.name: field.metadata[b"unit"].decode()
        for field in table.schema
        if field.name.startswith("effect.") and not field.name.endswith(SE)
    }
    for row in table.to_pylist():
        for name, unit in units.items():
            if row[name] is not None:
                effect, _, parameter = name.removeprefix("effect.").rpartition(".")
                about = (row["folder"], row["campaign"], row["verdict"])
                lines.append((*about, effect, parameter, unit, row[name], row[name + SE]))
    columns = ["folder", "campaign", "verdict", "effect", "parameter", "unit", "estimate", "se"]
    return pd.DataFrame(lines, columns=columns)
