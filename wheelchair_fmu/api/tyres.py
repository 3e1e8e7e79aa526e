"""A tyre identified from rig data."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from ..errors import UsageError
from ..report.tyre_figures import paper_figures
from ..tyres import Identified, identify
from ..tyres import read as read_rig
from ..tyres.identify import TOLERANCE
from ..tyres.parameters import chair, chosen
from ..tyres.summary import summary
from ..tyres.tir import tir_text
from ..writing import written
from .variants import Variant, of_record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STIFFNESSES = {"C_lambda": "N/rad", "C_m_lambda": "N.m/rad", "C_phi": "N/rad", "C_m_phi": "N.m/rad"}
UNITS = {"pressure": "Pa", "load": "N", "speed": "m/s", **STIFFNESSES}


class Tyre:
    """Laws of one or several tyres, fitted to what a rig measured; `Tyre.fit` makes it.

    >>> tyre
    Tyre(['A', 'B'], 8 conditions)
    """

    def __init__(self, found: Identified, warnings: tuple[str, ...]) -> None:
        self._found, self._warnings = found, warnings

    @classmethod
    def fit(cls, path: str | Path, *, axes: str = "sae", tolerance: float = TOLERANCE) -> Tyre:
        """Fit linear, Dugoff and Magic Formula laws to every condition in a file, and one law across load and pressure.

        `path` is rig data as .csv, TYDEX 1.3 (.tdx) or .tir; `axes` says of a .csv whether y points right ("sae") or left
        ("iso"); `tolerance` is the relative error that the linear law may have of the curve within its range.

        Raises UsageError for an unknown ending or axes, and FileError with all faults of the file.

        >>> tyre = wc.Tyre.fit("rig/rotating-disc.csv")
        >>> tyre.names
        ('A', 'B')
        """
        if not 0 < tolerance < 1:
            raise UsageError(f"tolerance {tolerance:g} is no fraction; give one between 0 and 1, such as 0.05")
        measured = read_rig(path, axes.lower())
        found = identify(measured.sweeps, tolerance)
        of_laws = (f"{each.condition}: {words}" for each in found.conditions for words in each.warnings)
        return cls(found, (*map(str, measured.warnings), *of_laws))

    @property
    def names(self) -> tuple[str, ...]:
        """The tyres in the file.

        >>> tyre.names
        ('A', 'B')
        """
        return tuple(self._found.tyres)

    @property
    def warnings(self) -> tuple[str, ...]:
        """A sentence for each thing that the data do not support, or that is odd.

        >>> tyre.warnings
        ()
        """
        return self._warnings

    @property
    def conditions(self) -> pd.DataFrame:
        """A row for each condition: tyre, `pressure` [Pa], `load` [N], `speed` [m/s], the stiffnesses of the linear law with
        standard errors (`C_lambda`, `C_lambda.se`, …; SI), NaN where there is none. `frame.attrs["units"]` has the units.

        >>> print(*tyre.conditions.loc[0, ["tyre", "pressure", "load"]])
        A 400000.0 400.0
        """
        rows = []
        for told in self.as_dict()["conditions"]:
            row = {name: told[name] for name in ("tyre", "pressure", "load", "speed")}
            for name in STIFFNESSES:
                row |= {name: told["linear"][name], f"{name}.se": told["linear"]["se"][name]}
            rows.append(row)
        frame = pd.DataFrame(rows)
        columns = [name for name in frame.columns if name != "tyre"]
        frame[columns] = frame[columns].astype(float)
        frame.attrs["units"] = {name: UNITS[name.removesuffix(".se")] for name in columns}
        return frame

    def as_dict(self) -> dict[str, Any]:
        """All that was fitted as plain data, SI units, as `wheelchair tyre fit --json` prints it.

        >>> round(tyre.as_dict()["conditions"][0]["linear"]["C_lambda"])
        5064
        """
        return summary(self._found)

    def variant(
        self,
        *,
        tyre: str | None = None,
        pressure: float | None = None,
        load: float | None = None,
        speed: float | None = None,
        law: str = "magic_formula",
    ) -> Variant:
        """The chair on one of these tyres, under a law ("linear", "dugoff" or "magic_formula").

        The condition is at `pressure` [bar], `load` [N] and `speed` [m/s]; what is left open is taken nearest to 4 bar, 400 N
        and 4 km/h. `tyre` may be left out where the file has one. Raises UsageError where there is no such condition, and
        Failure where the data do not support the law.

        >>> soft = tyre.variant(tyre="A", pressure=2)
        >>> soft.laws["tyre"], soft.values["tyre.pressure"]
        ('magic_formula', 2.0)
        """
        return of_record(chair(self._found, chosen(self._found, tyre, pressure, load, speed), law))

    def save(self, path: str | Path, **condition: Any) -> Path:
        """Write the condition of a tyre, chosen as by `variant`, as a tyre property file (.tir), and return the path.

        >>> tyre.save("soft.tir", tyre="A", pressure=2).name
        'soft.tir'
        """
        path = Path(path)
        if path.suffix.lower() != ".tir":
            raise UsageError(f"{path}: write a .tir; `Tyre.variant(…).save` writes a .toml")
        keys = ("tyre", "pressure", "load", "speed")
        text = tir_text(self._found, chosen(self._found, *(condition.get(key) for key in keys)))
        with written(path) as beside:
            beside.write_text(text, encoding="utf-8")
        return path

    def plot(self) -> dict[str, Figure]:
        """The curves and their laws as in Figs. 4 to 9 of the paper, by what they show.

        >>> sorted(tyre.plot())[:2]
        ['A-force', 'A-torque']
        """
        return dict(paper_figures(self._found))

    def __repr__(self) -> str:
        return f"Tyre({list(self.names)}, {len(self._found.conditions)} conditions)"

    def _repr_html_(self) -> str:
        return str(self.conditions.to_html(index=False, na_rep="", float_format="%.4g"))
