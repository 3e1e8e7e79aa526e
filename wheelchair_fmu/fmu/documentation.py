"""documentation/index.html inside the archive, and what lies beside it."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from math import inf, isfinite
from string import Template

from .. import __version__
from ..model import frames
from ..quantities import REACH
from ..resources import FMU_SOURCES
from . import describe3, literature, related
from .describe import number
from .variables import STEP, Interface, Variable

MOVED = {  # how inputs move inside a step
    "2": "fmi2SetRealInputDerivatives",
    "3": "intermediate updates, once a millisecond; a step may return early there",
}
LICENCE = FMU_SOURCES / "documentation" / "license.txt"


def files(face: Interface, version: str, results: Mapping[str, bytes]) -> dict[str, bytes]:
    """Documentation and licence by their path in the archive for a version of FMI; `results` are the reference run's."""
    page = (face.pages / "index.html").read_text(encoding="utf-8")
    known = literature.entries()
    choice = face.variant.choice
    filled = Template(page).substitute(
        axes=_drawing("axes"),
        ports=_drawing("ports"),
        frames=escape((frames.__doc__ or "").split("::", 1)[1].strip("\n")),
        parameters=_rows([v for v in face.of("parameter") if not v.name.startswith("effect.")], known),
        inputs=_rows(face.of("input"), known),
        outputs=_rows(face.of("output"), known),
        effects=_effects(face, known),
        references=literature.listed(literature.keys_in([v.source for v in face.variables], known), known),
        equations=escape(choice.equations),
        caster=escape(choice.caster),
        wheel=escape(choice.wheel),
        version=__version__,
        fmi=version,
        step=number(1000 * STEP),
        slopes=MOVED[version],
        reference=_reference(results),
    )
    return {"documentation/index.html": filled.encode(), "documentation/licenses/license.txt": LICENCE.read_bytes()}


def icons(face: Interface) -> dict[str, bytes]:
    """The model's icon and its terminals', by their path in the archive: drawn, and as pixels for who cannot draw."""
    places = {"icon": face.pages / "model", **{name: FMU_SOURCES / "icons" / name for name in describe3.terminal_icons(face)}}
    return {
        f"terminalsAndIcons/{name}.{kind}": place.with_suffix(f".{kind}").read_bytes()
        for name, place in places.items()
        for kind in ("png", "svg")
    }


def _drawing(name: str) -> str:
    return (FMU_SOURCES / "documentation" / f"{name}.svg").read_text(encoding="utf-8")


def _reference(results: Mapping[str, bytes]) -> str:
    if not results:
        return "<p>Only the native flavour carries a reference run.</p>"
    from . import plot  # matplotlib takes its time

    folder = f"../{related.FOLDER}"
    return (
        f'<p><a href="{folder}/reference.csv">reference.csv</a> is what this build should give for <a '
        f'href="{folder}/reference_in.csv">reference_in.csv</a>, whose values are held over steps of 10&nbsp;ms; <a '
        f'href="{folder}/start.ssv">start.ssv</a> is the set of values that it starts from.</p>\n'
        f"<figure>{plot.reference_run(results['reference.csv'])}</figure>"
    )


def _effects(face: Interface, known: dict[str, dict[str, str]]) -> str:
    """Each effect with its parameters, folded up."""
    folded = [
        _effect(e.id, e.title, [v for v in face.of("parameter") if v.name.startswith(f"effect.{e.id}.")], known)
        for e in face.model.effects
    ]
    return "\n".join(folded) or "<p>none</p>"


def _effect(name: str, title: str, parameters: list[Variable], known: dict[str, dict[str, str]]) -> str:
    rows = f"<table>{HEAD}\n{_rows(parameters, known)}\n</table>" if parameters else ""
    return f"<details><summary><code>{escape(name)}</code> {escape(title)}</summary>{rows}</details>"


HEAD = "<tr><th>name</th><th>unit</th><th>start</th><th>bounds</th><th>variability</th><th>meaning</th><th>source</th></tr>"


def _rows(variables: list[Variable] | tuple[Variable, ...], known: dict[str, dict[str, str]]) -> str:
    """Rows of a table, with a line above each group that begins with the same word."""
    groups: dict[str, list[str]] = {}
    for v in variables:
        groups.setdefault(v.name.partition(".")[0] if "." in v.name else "", []).append(_row(v, known))
    lines = []
    for group, rows in groups.items():
        head = [f'<tr class="group"><th colspan="7">{escape(group)}</th></tr>'] if group not in ("", "effect") else []
        lines += [*head, *rows]
    return "\n".join(lines)


def _row(v: Variable, known: dict[str, dict[str, str]]) -> str:
    start = "" if v.start is None else v.choices[int(v.start) - 1] if v.choices else f"{v.start:.6g}"
    may_be = ", ".join(v.choices) if v.choices else bounds(v)
    cells = [escape(c) for c in (v.name, v.unit.name, start, may_be, v.variability, v.description)]
    return "<tr>" + "".join(f"<td>{c}</td>" for c in [*cells, literature.linked(v.source, known)]) + "</tr>"


def bounds(v: Variable) -> str:
    """What a variable may be, in words."""
    if v.type == "Boolean":
        return "false, true"
    # Results are told to FMI to stay within reach of anything at all, which is no bound that a reader would miss.
    reach = REACH.get(v.unit.name, 1e9) if v.kind == "output" else inf
    ends = [number(b) if isfinite(b) and abs(b) < reach else "" for b in (v.lower, v.upper)]
    return " to ".join(end or "…" for end in ends) if any(ends) else "unbounded"
