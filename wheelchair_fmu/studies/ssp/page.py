"""documentation/index.html inside an .ssp: what the system is, a diagram, its values, and how it is run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from html import escape
from string import Template

from ...fmu.describe import number
from ...fmu.parameter_set import ParameterSet
from ...resources import SYSTEMS
from .records import Connection, MappingEntry, System
from .sources import interface
from .structure import Model, parted, usual_file

TEMPLATE = SYSTEMS / "pages" / "system" / "index.html"
WORDS = {"Pusher": "a person who pushes in strokes", "Floor": "slopes and rolling resistance", "Chair": "on real tyres"}
BOX, GAP, ROW, TOP = 200, 440, 150, 20  # px: a box's width, from box to box, a box's row, the upper margin


def page(
    plain: System,
    models: Mapping[str, Model],
    sets: Mapping[str, ParameterSet],
    handles: ParameterSet,
    entries: Iterable[MappingEntry],
) -> bytes:
    """The page of a system: `sets` by component, with their choices; `handles`, and where `entries` lead them."""
    step, stop = plain.step or 0.0, plain.stop or 0.0
    text = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=escape(plain.description),
        name=escape(plain.name),
        file=escape(usual_file(plain.name)),
        stop=number(stop),
        step=number(round(1000 * step, 6)),
        seconds=number(step),
        steps=round(stop / step),
        diagram=diagram(plain),
        connections=_rows(_connection(c, models) for c in plain.connections),
        handles=_rows(_handle(entry, models, handles) for entry in entries),
        parameters=_rows(_parameter(c, name, models, sets) for c in sets for name in sets[c].settings),
    )
    return text.encode()


def diagram(plain: System) -> str:
    """The components as boxes, the chair on the right and what is around it on the left, and arrows with their signals."""
    others = [c.name for c in plain.components if c.name != "Chair"]
    height = ROW * len(others)
    parts = [_box("Chair", BOX + GAP, TOP, height - 2 * TOP)]
    for i, name in enumerate(others):
        y = TOP + i * ROW
        parts.append(_box(name, 0, y, ROW - 2 * TOP))
        for start, end, at in ((name, "Chair", y + 40), ("Chair", name, y + 85)):
            if signals := _signals(plain, start, end):
                parts.append(_arrow(", ".join(signals), at, back=start == "Chair"))
    return (
        f'<svg viewBox="-2 0 {2 * BOX + GAP + 4} {height}" width="{2 * BOX + GAP + 4}" role="img" '
        f'aria-label="The components and the signals between them">\n' + "\n".join(parts) + "\n</svg>"
    )


def _signals(plain: System, start: str, end: str) -> list[str]:
    return [c.start_connector for c in plain.connections if (c.start_element, c.end_element) == (start, end)]


def _box(name: str, x: float, y: float, height: float) -> str:
    middle, centre = y + height / 2, x + BOX / 2
    return (
        f'<rect x="{x}" y="{y}" width="{BOX}" height="{height}" rx="6" fill="#eef3f8" stroke="#345"/>'
        f'<text class="name" x="{centre}" y="{middle - 4}" text-anchor="middle">{escape(name)}</text>'
        f'<text class="what" x="{centre}" y="{middle + 16}" text-anchor="middle">{WORDS.get(name, "")}</text>'
    )


def _arrow(text: str, y: float, back: bool) -> str:
    left, right = BOX, BOX + GAP
    tip, inward = (left, 9) if back else (right, -9)
    return (
        f'<line x1="{left}" y1="{y}" x2="{right}" y2="{y}" stroke="#345"/>'
        f'<path d="M{tip} {y} l{inward} -5 v10 z" fill="#345"/>'
        f'<text x="{(left + right) / 2}" y="{y - 7}" text-anchor="middle">{escape(text)}</text>'
    )


def _connection(c: Connection, models: Mapping[str, Model]) -> tuple[str, ...]:
    variable = models[c.start_element].variable(c.start_connector)
    return c.start_connector, variable.unit or "", c.start_element, c.end_element, variable.description


def _handle(entry: MappingEntry, models: Mapping[str, Model], handles: ParameterSet) -> tuple[str, ...]:
    path = interface()["parameters"][entry.source][0]
    element, inner = parted(path)
    setting = handles.settings[entry.source]
    return entry.source, f"{setting.value:.6g}", setting.unit, path, models[element].variable(inner).description


def _parameter(component: str, name: str, models: Mapping[str, Model], sets: Mapping[str, ParameterSet]) -> tuple[str, ...]:
    setting = sets[component].settings[name]
    return f"{component}.{name}", _value(setting.value), setting.unit, models[component].variable(name).description


def _value(value: float | bool | str) -> str:
    return value if isinstance(value, str) else number(float(value))


def _rows(rows: Iterable[tuple[str, ...]]) -> str:
    return "\n".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
