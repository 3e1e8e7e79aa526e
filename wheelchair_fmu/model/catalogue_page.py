"""docs/effects.md: every effect of the catalogue with its drawing, its law, its parameters and their signs, what it acts on,
from the records.

`python -m wheelchair_fmu.model.catalogue_page docs/effects.md` writes it, and the drawings into docs/effects.
"""

from __future__ import annotations

import inspect
import sys
from importlib import import_module
from pathlib import Path

from ..quantities import Parameter, Quantity
from ..writing import written
from . import effects as package
from .alike import look_alikes
from .effects import bundled
from .sketch_svg import svg
from .stage import Alike, Effect
from .wheelchair import Choice, assemble

HEAD = """# The effects

Each adds one thing to [the model](physics.md) that the paper leaves out. A parameter is zero where its effect is off, and `δ`
is its smallest size of interest, against which a diagnosis calls it missing or small. In the FMU a parameter is
`effect.<id>.<name>`. The page is written by `make docs` from the files in `wheelchair_fmu/model/effects`;
[your own](your-own-effect.md) is one more such file.

In the drawings grey is the chair, orange the part in question, and red what is added where the parameter is above zero; blue is
how the chair moves, a dashed curve the model without the effect. The chair is seen from above, from behind, or from its right
side. What a value above zero does is one thing that shows it plainly, as a test finds by simulation at the size δ; below zero
it is the opposite, where the bounds let it be.
"""
DRAWINGS = "effects"  # the folder beside the page


def page() -> str:
    """The whole page."""
    catalogue = bundled()
    contents = "\n".join(f"- [`{id}`](#{id}): {effect.title}" for id, effect in catalogue.items())
    return "\n\n".join([HEAD.rstrip(), contents, *(section(e) for e in catalogue.values())]) + "\n"


def section(effect: Effect) -> str:
    """One effect: what its file says of it, its parameters, what it acts on and what it needs."""
    said = inspect.getdoc(import_module(f"{package.__name__}.{effect.id}")) or ""
    parts = [f"## {effect.id}", f"![{_drawn(effect)}]({DRAWINGS}/{effect.id}.svg)", said, _table(effect)]
    parts += [f"Acts on {_targets(effect)}.{_needs(effect)}"]
    parts += [_alike(effect, a) for a in effect.alike]
    for what, adjusted in (("Adjusted with it, as chairs differ", True), ("Not estimated", False)):
        of_that = [c for c in effect.owned if not c.estimated and c.adjusted is adjusted]
        if of_that:
            parts.append(f"{what}: {'; '.join(map(_constant, of_that))}.")
    return "\n\n".join(parts)


def _constant(c: Parameter) -> str:
    known = f" ± {c.known_to:g}" if c.adjusted else ""
    return f"`{c.name.rpartition('.')[2]}` = {c.default:g}{known}{c.unit.behind}, {c.meaning} ({c.source})"


def drawings() -> dict[str, str]:
    """The drawing of every effect, by the name of its file."""
    return {f"{id}.svg": svg(effect.sketches, _drawn(effect)) for id, effect in bundled().items()}


def _drawn(effect: Effect) -> str:
    return f"Drawing: {effect.title}"


def _alike(effect: Effect, a: Alike) -> str:
    return (
        f"Looks like {', '.join(f'`{other}`' for other in look_alikes(effect, a, bundled()))} in {a.what}; told by {a.told_by}."
    )


def _table(effect: Effect) -> str:
    head = "| parameter | unit | meaning | above zero | δ | bounds | source |\n|---|---|---|---|---|---|---|"
    rows = (
        f"| `{p.name}` | {p.unit.name} | {p.meaning} | {sign.words} | {p.delta:g} | {p.lower:g} to {p.upper:g} | {p.source} |"
        for p, sign in zip(effect.parameters, effect.signs, strict=True)
    )
    return "\n".join([head, *rows])


def _targets(effect: Effect) -> str:
    if effect.delays_record:
        return "the recorded pushes, which it shifts in time; it is no part of the FMU"
    known = _quantities(effect)
    return "; ".join(dict.fromkeys(f"`{c.to}`, {known[c.to].meaning}" for c in effect.contributions))


def _quantities(effect: Effect) -> dict[str, Quantity]:
    return dict(assemble(Choice().with_laws(effect.needs), [effect]).records)


def _needs(effect: Effect) -> str:
    needs = "".join(f" Needs the {kind} law `{name}`." for kind, name in effect.needs.items())
    states = ", ".join(f"`{row.state.name}`" for row in effect.rows)
    through = " and ".join(f"`{other}`" for other in effect.through)
    return (
        needs
        + (f" Brings the state {states}." if states else "")
        + (f" Acts through {through}, and is looked for together with it as well." if through else "")
    )


def write(page_file: Path) -> None:
    """The page, and its drawings in a folder beside it."""
    texts = {page_file: page(), **{page_file.parent / DRAWINGS / name: text for name, text in drawings().items()}}
    for file, text in texts.items():
        with written(file) as beside:
            beside.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write(Path(sys.argv[1]))
