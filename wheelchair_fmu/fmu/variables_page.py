"""docs/variables.md: every variable of the FMU as it is built by default, from its records.

`python -m wheelchair_fmu.fmu.variables_page docs/variables.md` writes it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from ..model.variant import Variant
from ..writing import written
from .build import with_chosen_effects
from .documentation import bounds
from .variables import Variable, interface

HEAD = """# The FMU's variables

What the FMU has when it is built by `wheelchair build`: units are SI, axes those of SAE J670 (x forward, y to the right, ψ
clockwise from above). A tunable parameter may change while a simulation runs, a fixed one not. Beside these it has
`effect.<id>.<parameter>` for each [effect](effects.md) that is built in, with sizes of zero at the start; states of effects
and casters are outputs as well. The same tables, with sources, lie in the archive as `documentation/index.html`. The page is
written by `make docs`.
"""
GROUPS = (("Inputs", "input"), ("Parameters", "parameter"), ("Outputs", "output"))
COLUMNS = "| name | unit | start | bounds | what it is |\n|---|---|---|---|---|"


def page() -> str:
    """The whole page."""
    face = interface(with_chosen_effects(Variant()))
    tables = (f"## {title}\n\n{_table(v for v in face.of(kind) if not _of_effect(v))}" for title, kind in GROUPS)
    return "\n\n".join([HEAD.rstrip(), *tables]) + "\n"


def _of_effect(variable: Variable) -> bool:
    return variable.name.startswith("effect.")


def _table(variables: Iterable[Variable]) -> str:
    return "\n".join([COLUMNS, *map(_row, variables)])


def _row(v: Variable) -> str:
    start = "" if v.start is None else v.choices[int(v.start) - 1] if v.choices else f"{v.start:.6g}"
    words = v.description.replace("|", r"\|") + ("; fixed" if v.fixed else "")
    return f"| `{v.name}` | {v.unit.name} | {start} | {', '.join(v.choices) or bounds(v)} | {words} |"


if __name__ == "__main__":
    with written(Path(sys.argv[1])) as beside:
        beside.write_text(page(), encoding="utf-8")
