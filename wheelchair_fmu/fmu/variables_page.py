"""docs/variables.md: every variable of the FMU, with each effect and each law of casters and wheels, from its records.

`python -m wheelchair_fmu.fmu.variables_page docs/variables.md` writes it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..model.choice import Choice, names
from ..model.variant import Variant
from ..writing import written
from .build import with_chosen_effects
from .documentation import bounds
from .variables import Variable, interface

HEAD = """# The FMU's variables

What the FMU has: units are SI, axes those of SAE J670 (x forward, y to the right, ψ clockwise from above). A tunable parameter
may change while a simulation runs, a fixed one not. The first tables are of what every FMU has; then come the parameters of the
[effects](effects.md) that `wheelchair build` builds in, all off at the start; what `--effects` adds to them; and what other
[laws](physics.md) of casters and wheels bring. The same tables, with sources, lie in each archive as
`documentation/index.html`, of what is in it. The page is written by `make docs`.
"""
BUILT_IN = """Sizes are zero at the start, and with a size of zero an effect does nothing. With `--effects none` an FMU has none
of these, with `--effects` and ids separated by commas those that are named."""
MORE = """Effects that bring states of their own, or casters that swing. `--effects all` builds in every one,
`--effects relaxation_length,caster_trail` these two. Their states are outputs."""
LAWS = """A variant's file chooses laws (`[laws]`, then `caster = "slipping"` or `wheel = "spinning"`), and
`wheelchair build --variant FILE` builds it. What one law of a kind has in common with another is listed once."""
GROUPS = (("Inputs", "input"), ("Parameters", "parameter"), ("Outputs", "output"))
COLUMNS = "| name | unit | start | bounds | what it is |\n|---|---|---|---|---|"


def page() -> str:
    """The whole page."""
    return "\n\n".join([HEAD.rstrip(), *_sections()]) + "\n"


def _sections() -> Iterator[str]:
    seen: set[str] = set()
    yield from _tables(Variant(), "none", seen)
    yield f"## Effects that are built in\n\n{BUILT_IN}"
    yield from _tables(Variant(), "default", seen, level=3)
    yield f"## With more effects\n\n{MORE}"
    yield from _tables(Variant(), "all", seen, level=3)
    yield f"## With other laws\n\n{LAWS}"
    for kind in ("caster", "wheel"):
        for name in names()[kind]:
            law = Variant(Choice().with_laws({kind: name}))
            tables = list(_tables(law, "none", seen, level=4))
            if tables:
                yield f'### `{kind} = "{name}"`'
                yield from tables


def _tables(variant: Variant, effects: str, seen: set[str], level: int = 2) -> Iterator[str]:
    """What this variant with these effects has that was not listed yet; it is added to what was."""
    face = interface(with_chosen_effects(variant, effects))
    for title, kind in GROUPS:
        new = [v for v in face.of(kind) if v.name not in seen]
        seen.update(v.name for v in new)
        if new:
            yield f"{'#' * level} {title}\n\n{_table(new)}"


def _table(variables: Iterable[Variable]) -> str:
    return "\n".join([COLUMNS, *map(_row, variables)])


def _row(v: Variable) -> str:
    start = "" if v.start is None else v.choices[int(v.start) - 1] if v.choices else f"{v.start:.6g}"
    words = v.description.replace("|", r"\|") + ("; fixed" if v.fixed else "")
    return f"| `{v.name}` | {v.unit.name} | {start} | {', '.join(v.choices) or bounds(v)} | {words} |"


if __name__ == "__main__":
    with written(Path(sys.argv[1])) as beside:
        beside.write_text(page(), encoding="utf-8")
