"""Tables of series that know their units, files of them, and tables of fitted values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from ..errors import unknown
from ..inference.estimation.calibration import Calibrated
from ..writing import written

UNITS = "units"  # the key of `DataFrame.attrs` under which a frame has its units by column, and that of its index


def framed(time: np.ndarray, columns: Mapping[str, np.ndarray], units: Mapping[str, str]) -> pd.DataFrame:
    """Series (n,) by name over `time` (n,) in s, with their units."""
    frame = pd.DataFrame(dict(columns), index=pd.Index(time, name="time"))
    frame.attrs[UNITS] = {"time": "s", **{name: units[name] for name in columns}}
    return frame


def calibration_frame(values: Sequence[Calibrated]) -> pd.DataFrame:
    """A row for each value that was given and fitted, by its FMI name."""
    rows = {c.record.name: {**c.as_json(), "unit": c.record.unit.name} for c in values}
    return pd.DataFrame.from_dict(rows, "index").rename_axis("parameter")


def save(frame: pd.DataFrame, path: str | Path) -> Path:
    """Write a frame to a .csv, with headers `name [unit]` and ten digits, or to a .parquet, with units in the fields' metadata.

    `frame` is what `simulate`, `Campaign.frame` or `Comparison.frame` gave, or has units by column in `frame.attrs["units"]`.
    The file is a recording that `wheelchair import` and a campaign read. Returns the path.

    Raises UsageError for another ending, and OSError where it cannot be written.

    >>> turn = wc.simulate("steady-turn", speed=1.0, time=0.1)
    >>> wc.save(turn[["chair.u", "chair.psi_dot"]], "turn.csv").read_text().splitlines()[:2]
    ['time [s],chair.u [m/s],chair.psi_dot [rad/s]', '0,1,0']
    """
    path = Path(path)
    writers = {".csv": _csv, ".parquet": _parquet}
    if path.suffix.lower() not in writers:
        raise unknown("table that ends in", path.suffix, writers)
    with written(path) as beside:
        writers[path.suffix.lower()](frame, beside)
    return path


def _csv(frame: pd.DataFrame, path: Path) -> None:
    units = frame.attrs.get(UNITS, {})
    flat = frame.reset_index()
    flat.columns = [f"{name} [{units[name]}]" if name in units else str(name) for name in flat.columns]
    flat.to_csv(path, index=False, float_format="%.10g", lineterminator="\n")


def _parquet(frame: pd.DataFrame, path: Path) -> None:
    units = frame.attrs.get(UNITS, {})
    bare = frame.reset_index()
    bare.attrs = {}
    table = pa.Table.from_pandas(bare, preserve_index=False)
    fields = [f.with_metadata({"unit": units[f.name]}) if f.name in units else f for f in table.schema]
    pq.write_table(table.cast(pa.schema(fields, metadata=table.schema.metadata)), path)
