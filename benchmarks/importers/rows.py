"""What is run in which importer, and what came of it: the rows of two tables."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

REFERENCE = "the archive's reference inputs, 5 s"
BOUND = "a brake that leaves its lower bound by 1e-12, 1 s"
TWO = "two chairs in one process, coupled, 3 s"
STROKES = "strokes that turn right and left, 4 s"
SLIDES = "wheels with spin as a state, on a wet floor: they spin, then lock, 2 s"
CS, ME = "CoSimulation", "ModelExchange"
SYSTEMS = {"slalom": 20.0, "cross-slope": 10.0}  # s: while the chair still moves, so that a difference shows
ALLOWED = 1e-5  # of any output at the end, relative to 1 + its size
ALLOWED_IN_SYSTEM = 1e-3  # m, rad and m/s, of the chair at the end


@dataclass(frozen=True)
class Row:
    """One importer on one archive: `script` is its driver, or `reason` why there is none."""

    tool: str
    script: str
    fmi: str = "2"
    interface: str = CS
    run: str = REFERENCE
    here: bool = False  # in this project's own environment
    reason: str = ""

    @property
    def key(self) -> tuple[str, ...]:
        """What tells the row from others, as it stands in the table."""
        return (self.tool, f"{self.fmi}.0", self.interface, self.run) if self.run not in SYSTEMS else (self.tool, self.run)


@dataclass(frozen=True)
class Result:
    """What came of a row: `deviation` from what is right at the end, or why there is none."""

    row: Row
    version: str = ""
    deviation: float | None = None
    trouble: str = ""

    @property
    def good(self) -> bool:
        allowed = ALLOWED_IN_SYSTEM if self.row.run in SYSTEMS else ALLOWED
        return self.deviation is not None and self.deviation <= allowed

    @property
    def verdict(self) -> str:
        if self.deviation is None:
            return self.trouble
        size = f"to {self.deviation:.0e}" if self.deviation else "to the last bit"
        return f"{'agrees' if self.good else 'differs'}, {size}"

    def line(self) -> str:
        tool, *others = self.row.key
        return "| " + " | ".join((tool, self.version or "–", *others, self.verdict)) + " |"


OTHERS = (
    ("libcosimpy", "libcosimpy"),
    ("CoFMUPy", "cofmupy"),
    ("Ecos", "ecospy"),
    ("fmuloader", "fmuloader"),
    ("PathSim", "pathsim"),
    ("FMU Manipulation Toolbox", "toolbox"),
)
COUPLED = ("libcosimpy", "CoFMUPy")
NOT_HAD = {
    "OMSimulator": "not run: PyPI's package fetches the program from openmodelica.org when it is installed",
    "PyFMI": "not run: PyPI's package is to be compiled, and needs FMI Library and Assimulo with SUNDIALS first",
}
FMU_HEAD = ("importer", "version", "FMI", "interface", "what was run", "result")
SSP_HEAD = ("importer", "version", "system", "result")


def fmu_rows(fmi: str) -> tuple[Row, ...]:
    """What is done with the archives of one version of FMI."""
    mine = [Row("FMPy", "fmpy", fmi, interface, run, here=True) for interface in (CS, ME) for run in (REFERENCE, BOUND, SLIDES)]
    theirs = [
        Row(tool, script, fmi, CS, run)
        for tool, script in OTHERS
        for run in (REFERENCE, BOUND, *([TWO] if tool in COUPLED else []), SLIDES)
    ]
    lost = [Row(tool, "", fmi, CS, REFERENCE, reason=reason) for tool, reason in NOT_HAD.items()]
    return (*mine, Row("plain C host", "", fmi, CS, STROKES, here=True), *theirs, *lost)


def ssp_rows() -> tuple[Row, ...]:
    """What is done with archives of systems."""
    tools = (
        ("FMPy", "ssp_fmpy", True),
        ("libcosimpy", "ssp_libcosimpy", False),
        ("Ecos", "ssp_ecospy", False),
        ("FMU Manipulation Toolbox", "ssp_toolbox", False),
    )
    run = [Row(tool, script, run=system, here=here) for tool, script, here in tools for system in SYSTEMS]
    return (*run, Row("OMSimulator", "", run="slalom", reason=NOT_HAD["OMSimulator"]))


def head(names: Iterable[str]) -> str:
    names = tuple(names)
    return f"| {' | '.join(names)} |\n|{'---|' * len(names)}"
