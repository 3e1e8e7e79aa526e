"""The folder that goes with a paper: methods, tables, figures and fingerprints of one diagnosis."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pandas as pd

from ... import __version__
from ...resources import REFERENCES
from ...writing import written
from ..saving import save
from . import tables
from .case import Case
from .figures import PRINT, forest_figure, residuals_figure
from .fingerprints import fingerprints
from .left_out import left_out
from .markup import cited
from .methods import markdown, methods, tex
from .replay import Replay, replay

SOFTWARE = f"""@misc{{wheelchairfmu,
  author = {{{{The wheelchair-fmu authors}}}},
  title  = {{{{wheelchair-fmu}}: a manual wheelchair on real tyres as an {{FMU}}}},
  note   = {{Version {__version__}}},
}}"""


def supplement(case: Case, folder: Path, say: Callable[[str], None] = lambda words: None) -> tuple[Path, ...]:
    """Write the folder, and return its files; what else is in it stays.

    Raises Failure where the last model cannot be simulated again as the diagnosis has it, and OSError where nothing can be
    written.
    """
    say("simulating the last model again")
    again = replay(case)
    remarks, estimated = left_out(case), tables.estimates(case)
    text = methods(case, len(remarks))
    say("writing the supplement")
    texts = {
        "methods.md": markdown(text),
        "methods.tex": tex(text),
        "references.bib": bibliography(cited(text)),
        "estimates.csv": _csv(estimated),
        "estimates.tex": tables.estimates_tex(estimated),
        "covariance.csv": _csv(tables.covariance(case)),
        "errors.csv": _csv(tables.errors(case).set_index("step")),
        "left_out.csv": _csv(remarks.set_index("place")),
        "fingerprints.json": json.dumps(fingerprints(case), indent=2, ensure_ascii=False) + "\n",
        "README.md": _readme(case, again),
    }
    for name, content in texts.items():
        with written(folder / name) as beside:
            beside.write_text(content, encoding="utf-8", newline="\n")
    return (*(folder / name for name in texts), *_figures(case, again, folder))


def _figures(case: Case, again: Replay, folder: Path) -> list[Path]:
    from matplotlib import rc_context  # here, not above: see `canvas`

    files = []
    with rc_context(PRINT):
        for name, figure in (("residuals", residuals_figure(again, case.grew)), ("estimates", forest_figure(case))):
            for ending in (".pdf", ".svg"):
                with written(folder / f"{name}{ending}") as beside:
                    save(figure, beside)
                files.append(folder / f"{name}{ending}")
    return files


def _csv(table: pd.DataFrame) -> str:
    return str(table.to_csv(float_format="%.10g", lineterminator="\n"))


def bibliography(keys: list[str]) -> str:
    """The entries of references.bib with these keys, and the software's own, as BibTeX."""
    found = dict(re.findall(r"^(?=@\w+\{(\w+),\n)(@.*?^\})", REFERENCES.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL))
    return "\n\n".join([*(found[key] for key in keys if key in found), SOFTWARE]) + "\n"


def _readme(case: Case, again: Replay) -> str:
    kept = "held out" if again.role == "holdout" else "fitted"
    return f"""# Supplement to the diagnosis of {case.campaign.name}

- `methods.md`, `methods.tex`: the methods with all numbers filled in, for pandoc and LaTeX; `references.bib` goes with them.
- `estimates.csv`, `estimates.tex`, `covariance.csv`: all estimates with 95 % intervals, and their covariance, in SI units.
- `errors.csv`: RMS errors at every step, fitted and held out, by channel; whitened (1 is the noise floor) and in its unit.
- `left_out.csv`, `fingerprints.json`: what was left out or found odd, and why; SHA-256 of data and code, versions of libraries.
- `residuals` (of `{again.run}`, of the runs {kept} the one foretold least; bands hold 95 % of a sensor's noise) and\
 `estimates` with their 95 % intervals: PDF and SVG, 170 mm wide.
"""
