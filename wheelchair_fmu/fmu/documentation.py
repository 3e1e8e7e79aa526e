"""documentation/index.html inside the archive, and what lies beside it."""

from __future__ import annotations

from html import escape
from math import isfinite
from string import Template

from ..model import frames
from . import describe3
from .describe import number
from .variables import SOURCE, Interface, Variable

LICENCE = SOURCE / "documentation" / "license.txt"


def files(face: Interface) -> dict[str, bytes]:
    """Documentation and licence by their path in the archive."""
    page = (face.pages / "index.html").read_text(encoding="utf-8")
    choice = face.variant.choice
    filled = Template(page).substitute(
        axes=(SOURCE / "documentation" / "axes.svg").read_text(encoding="utf-8"),
        frames=escape((frames.__doc__ or "").split("::", 1)[1].strip("\n")),
        parameters=_table(face, "parameter"),
        inputs=_table(face, "input"),
        outputs=_table(face, "output"),
        effects=_effects(face),
        equations=escape(choice.equations),
        caster=escape(choice.caster),
    )
    return {
        "documentation/index.html": filled.encode(),
        "documentation/licenses/license.txt": LICENCE.read_bytes(),
    }


def icons(face: Interface) -> dict[str, bytes]:
    """The model's icon and its terminals', by their path in the archive: drawn, and as pixels for who cannot draw."""
    places = {"icon": face.pages / "model", **{name: SOURCE / "icons" / name for name in describe3.terminal_icons(face)}}
    return {f"terminalsAndIcons/{name}.{kind}": place.with_suffix(f".{kind}").read_bytes()
            for name, place in places.items() for kind in ("png", "svg")}  # fmt: skip


def _effects(face: Interface) -> str:
    active = face.model.effects
    return "\n".join(f"<li><code>{escape(e.id)}</code>: {escape(e.title)}</li>" for e in active) or "<li>none</li>"


def _table(face: Interface, kind: str) -> str:
    return "\n".join(_row(v) for v in face.of(kind))


def _row(v: Variable) -> str:
    bounds = " to ".join(number(b) if isfinite(b) else "…" for b in (v.lower, v.upper))
    start = "" if v.start is None else v.choices[int(v.start) - 1] if v.choices else number(v.start)
    cells = (v.name, v.unit.name, start, "" if bounds == "… to …" else bounds, v.variability, v.description, v.source)
    return "<tr>" + "".join(f"<td>{escape(str(c))}</td>" for c in cells) + "</tr>"
