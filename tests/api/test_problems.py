"""A campaign as a problem for other programs: its tables and its FMU are all that one needs."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import wheelchair_fmu as wc
from wheelchair_fmu.api import problems
from wheelchair_fmu.studies import Fmu

FOUND = {  # what was hidden in the sample, and what its calibration gives
    "tyre_C_lambda": 4930,
    "resistance_f_r": 0.0182,
    "resistance_f_f": 0.0178,
    "chair_I_z": 3.074,
    "effect_rolling_resistance_asymmetry_D": 1.606,
}


@pytest.fixture(scope="module")
def problem(campaign, tmp_path_factory) -> Path:
    return campaign.export(tmp_path_factory.mktemp("problem"), fit=["rolling_resistance_asymmetry"])[0].parent


def rows(file: Path) -> list[dict[str, str]]:
    with file.open(newline="", encoding="utf-8") as text:
        return list(csv.DictReader(text, delimiter="\t"))


def test_what_its_tables_name_is_there(problem):
    known = {r["petabEntityId"] for r in rows(problem / "mapping.tsv")}
    own = {r["parameterId"] for r in rows(problem / "parameters.tsv")}
    conditions = rows(problem / "conditions.tsv")
    assert {r["targetId"] for r in conditions} <= known
    assert {r["targetValue"] for r in conditions if r["targetValue"].startswith("start_")} == own - known
    assert set(FOUND) <= own & known
    observables = {r["observableId"]: r["observableFormula"] for r in rows(problem / "observables.tsv")}
    assert set(observables.values()) <= known
    experiments = {r["experimentId"] for r in rows(problem / "experiments.tsv")}
    measured = rows(problem / "measurements.tsv") + rows(problem / "holdout.tsv")
    assert {r["observableId"] for r in measured} == set(observables) and {r["experimentId"] for r in measured} == experiments
    for line in (problem / "problem.yaml").read_text(encoding="utf-8").split():
        assert "." not in line or line.startswith(("2.", "1.")) or (problem / line).exists(), line


@pytest.mark.parametrize("run", ["coast_down", "steady_left"])
def test_its_fmu_comes_near_the_noise_with_the_values_that_were_found(problem, run):
    """As a stranger would: values by the conditions, nominal or found, the run's inputs, and the residuals over their noise."""
    names = {r["petabEntityId"]: r["modelEntityId"] for r in rows(problem / "mapping.tsv")}
    nominal = {r["parameterId"]: float(r["nominalValue"]) for r in rows(problem / "parameters.tsv")}
    inputs = pd.read_csv(problem / "inputs" / f"{run}.csv", index_col=0)
    pushes = {name.partition(" [")[0]: inputs[name].to_numpy() for name in inputs}

    def deviance(values: dict[str, float]) -> float:
        given = {names[n]: v for n, v in values.items() if n in names}
        for r in rows(problem / "conditions.tsv"):
            if r["conditionId"] == run:
                value = values.get(r["targetValue"])
                given[names[r["targetId"]]] = float(r["targetValue"]) if value is None else value
        with Fmu(problem / "chair.fmu") as fmu:
            result = fmu.run(inputs.index.to_numpy(float), pushes, given)
        table = pd.read_csv(problem / "measurements.tsv", sep="\t")
        squares = []
        for o in rows(problem / "observables.tsv"):
            here = table[(table.observableId == o["observableId"]) & (table.experimentId == run)]
            predicted = np.interp(here.time, result.time, result[names[o["observableFormula"]]])
            squares.append(((here.measurement - predicted) / float(o["noiseFormula"])) ** 2)
        return float(np.sqrt(np.concatenate(squares).mean()))

    assert deviance({**nominal, **FOUND}) < 2.0 < deviance(nominal) / 3


def test_a_sensor_s_open_offset_is_a_parameter_of_what_it_reads(tmp_path, monkeypatch):
    """With a prior where one is given, else anywhere that the sensor could read."""
    toml = wc.sample(tmp_path / "open")[0]
    toml.write_text(toml.read_text(encoding="utf-8") + "\n[nuisance]\nyaw_rate = 0.02\na_x = true\n", encoding="utf-8")
    monkeypatch.setattr(problems, "build", lambda chair, path, effects: path)
    folder = wc.read(toml.parent).export(tmp_path / "problem")[0].parent
    observables = {r["observableId"]: r["observableFormula"] for r in rows(folder / "observables.tsv")}
    assert observables["yaw_rate"] == "sensor_yaw_rate + offset_yaw_rate" and observables["a_y"] == "sensor_a_y"
    own = {r["parameterId"]: r for r in rows(folder / "parameters.tsv") if r["parameterId"].startswith("offset_")}
    assert own["offset_yaw_rate"]["priorParameters"] == "0;0.02" and own["offset_a_x"]["priorDistribution"] == "uniform"
    assert all(np.isfinite(float(own["offset_a_x"][key])) for key in ("lowerBound", "upperBound"))


def test_what_an_fmu_cannot_have_is_refused(campaign, tmp_path):
    with pytest.raises(wc.UsageError, match="shifts recorded pushes in time"):
        campaign.export(tmp_path, fit=["push_force_delay"])
    with pytest.raises(wc.UsageError, match="no effect 'relaxation'"):
        campaign.export(tmp_path, fit=["relaxation"])
    assert not list(tmp_path.iterdir())


@pytest.mark.nightly
def test_petab_finds_no_error_in_its_tables(problem):
    """By petab's own rules, for all but the model, which is an FMU here; runs that are held out are no part of the fit."""
    pytest.importorskip("petab", reason="needs petab 0.8 or newer: pip install petab scipy")
    import yaml
    from petab.v2 import core, lint

    class Entities:
        """What petab asks of a model: which entities it has."""

        model_id, type_id = "chair", "fmu"
        names = frozenset(r["modelEntityId"] for r in rows(problem / "mapping.tsv"))

        def has_entity_with_id(self, id: str) -> bool:
            return id in self.names

        symbol_allowed_in_observable_formula = has_entity_with_id

        def get_parameter_ids(self) -> list[str]:
            return sorted(self.names)

        get_valid_parameters_for_parameter_table = get_valid_ids_for_condition_table = get_parameter_ids

        def get_free_parameter_ids_with_values(self) -> list[tuple[str, float]]:
            return [(name, 0.0) for name in sorted(self.names)]

        def is_valid(self) -> bool:
            return True

        def is_state_variable(self, _: str) -> bool:
            return False

    config = core.ProblemConfig(**yaml.safe_load((problem / "problem.yaml").read_text(encoding="utf-8")), base_path=problem)
    kinds = ("condition", "experiment", "observable", "measurement", "parameter", "mapping")
    files = {kind: str(next(problem.glob(f"{kind}*.tsv"))) for kind in kinds}
    tables = {f"{kind}_tables": [getattr(core, f"{kind.title()}Table").from_tsv(file)] for kind, file in files.items()}
    whole = core.Problem(models=[Entities()], config=config, **tables)
    found = [issue for task in lint.default_validation_tasks if (issue := task.run(whole)) is not None]
    assert [str(issue.message) for issue in found if issue.level >= lint.ValidationIssueSeverity.ERROR] == []
    assert all("not used in the measurements" in str(issue.message) for issue in found)
