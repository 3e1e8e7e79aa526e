"""Sketches as SVG: grey is the chair, blue how it moves, orange the part in question, red what is positive."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from math import cos, radians, sin

from .sketch import (
    HEIGHT,
    PIVOT_LEFT,
    PIVOT_RIGHT,
    RADIUS,
    REAR_LEFT,
    REAR_RIGHT,
    Arrow,
    Curve,
    Length,
    Mark,
    Place,
    Sketch,
    Spot,
    Turn,
    Wheel,
)

SCALE, WIDE, HIGH = 200.0, 240, 220  # px per m, and of one drawing
ORIGIN = {"above": (120.0, 100.0), "rear": (120.0, 176.0), "side": (112.0, 176.0), "graph": (40.0, 180.0)}  # px
GRAPH = (180.0, 150.0)  # px of its axes
GREY, BLUE, ORANGE, RED, INK = "#9aa3ab", "#1f5582", "#c8591a", "#b02020", "#222"
CASTER, FORK = 0.07, 0.05  # radius and trail, as drawn
WHEELS = {
    "rl": REAR_LEFT,
    "rr": REAR_RIGHT,
    "fl": (PIVOT_LEFT[0], PIVOT_LEFT[1] - FORK),
    "fr": (PIVOT_RIGHT[0], PIVOT_RIGHT[1] - FORK),
}
TIPS = "".join(
    f'<marker id="{name}" viewBox="0 0 10 10" refX="8" refY="5" markerWidth="6" markerHeight="6" orient="auto-start-reverse">'
    f'<path d="M0 0 10 5 0 10z" fill="{color}"/></marker>'
    for name, color in (("red", RED), ("blue", BLUE), ("ink", INK))
)


def svg(sketches: Sequence[Sketch], words: str) -> str:
    """The drawings side by side; `words` say what they show."""
    width = WIDE * len(sketches)
    inside = "\n".join(f'<g transform="translate({WIDE * i} 0)">\n{_drawing(s)}\n</g>' for i, s in enumerate(sketches))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {HIGH}" width="{width}" height="{HIGH}" role="img" '
        f'aria-label="{escape(words)}" font-family="sans-serif" font-size="13" fill="none" stroke-linecap="round">\n'
        f'<defs>{TIPS}</defs>\n<rect width="{width}" height="{HIGH}" rx="6" fill="#fff"/>\n{inside}\n</svg>\n'
    )


def _drawing(sketch: Sketch) -> str:
    pen = _Pen(sketch)
    first = [*pen.graph()] if sketch.view == "graph" else [*pen.chair()]
    body = "\n".join(filter(None, first + [line for mark in sketch.marks for line in pen.mark(mark)]))
    x, y = ORIGIN[sketch.view]
    tilted = f'<g transform="rotate({sketch.tilt:g} {x:g} {y:g})">\n{body}\n</g>' if sketch.tilt else body
    return "\n".join(filter(None, (tilted, pen.text(10, HIGH - 8, sketch.of))))


class _Pen:
    """Draws in the axes of one sketch's view."""

    def __init__(self, sketch: Sketch):
        self.view, self.axes = sketch.view, sketch.axes
        self.turned = {m.name: m.turned for m in sketch.marks if isinstance(m, Wheel)}

    def at(self, place: Place) -> tuple[float, float]:
        x, y = ORIGIN[self.view]
        across, up = GRAPH if self.view == "graph" else (SCALE, SCALE)
        return x + across * place[0], y - up * place[1]

    def chair(self) -> Iterator[str]:
        """The chair without what is marked."""
        if self.view == "above":
            yield self.path([PIVOT_LEFT, PIVOT_RIGHT], GREY)
            yield self.path([(0, PIVOT_LEFT[1]), (0, REAR_LEFT[1])], GREY)
            yield self.path([REAR_LEFT, REAR_RIGHT], GREY)
            for name, place in WHEELS.items():
                yield self.tread(place, RADIUS if name[0] == "r" else CASTER, *self.look(name))
            yield self.dot((0, 0), 3, INK)
        elif self.view == "rear":
            yield self.path([(-0.5, 0), (0.5, 0)], INK, 1)
            yield self.path([(REAR_LEFT[0], RADIUS), (REAR_RIGHT[0], RADIUS)], GREY)
            yield self.path([(0, RADIUS), (0, HEIGHT)], GREY)
            for name in ("rl", "rr"):
                yield self.tread((WHEELS[name][0], RADIUS), RADIUS, *self.look(name))
            yield self.dot((0, HEIGHT), 3, INK)
        else:
            yield self.path([(-0.55, 0), (0.62, 0)], INK, 1)
            yield self.path([(-0.24, 0.92), (-0.2, 0.48), (0.2, 0.5), (0.27, 0.3), (0.25, 2 * CASTER)], GREY)
            yield self.path([(REAR_LEFT[1], RADIUS), (-0.1, 0.49)], GREY)
            yield self.ring((REAR_LEFT[1], RADIUS), RADIUS, self.look("rear")[0])
            yield self.ring((PIVOT_LEFT[1] - FORK, CASTER), CASTER, self.look("front")[0])
            yield self.dot((0, HEIGHT), 3, INK)

    def graph(self) -> Iterator[str]:
        for end in ((1.05, 0.0), (0.0, 1.08)):
            yield self.arrow((0, 0), end, INK, "ink", 1)
        (x, y), (left, top) = self.at((1.05, 0)), self.at((0, 1.08))
        yield self.text(x, y + 18, self.axes[0], "end")
        yield self.text(left + 8, top + 4, self.axes[1], "start")

    def mark(self, mark: Mark) -> Iterator[str]:
        if isinstance(mark, Arrow):
            color, tip = (BLUE, "blue") if mark.moves else (RED, "red")
            yield self.arrow(mark.start, mark.end, color, tip)
            yield from self.beside(mark.end, mark.start, mark.label, color)
        elif isinstance(mark, Turn):
            yield from self.turn(mark)
        elif isinstance(mark, Spot):
            yield self.box(mark.at, mark.turned) if mark.box else self.dot(mark.at, 5, ORANGE)
            x, y = self.at(mark.at)
            yield self.text(x + 10, y + 4, mark.label, "start", ORANGE)
        elif isinstance(mark, Length):
            yield self.arrow(mark.start, mark.end, RED, "red", 1.5, both=True)
            yield from self.beside(mark.end, mark.start, mark.label, RED, middle=True)
        elif isinstance(mark, Curve):
            yield from self.curve(mark)

    def turn(self, mark: Turn) -> Iterator[str]:
        color, tip = (BLUE, "blue") if mark.moves else (RED, "red")
        x, y = self.at(mark.at)
        r, way = SCALE * mark.radius, 1 if mark.clockwise else -1
        begin, end = (radians(-90 + way * a) for a in (-120, 120))
        ends = [f"{x + r * cos(a):.1f} {y + r * sin(a):.1f}" for a in (begin, end)]
        sweep = 1 if mark.clockwise else 0
        way_round = f"M{ends[0]}A{r:g} {r:g} 0 1 {sweep} {ends[1]}"
        yield f'<path d="{way_round}" stroke="{color}" stroke-width="2" marker-end="url(#{tip})"/>'
        right = self.view == "side" or x >= ORIGIN[self.view][0] - 1
        down = y + r + 10 if mark.moves else y - r + 2
        yield self.text(x + r - 4 if right else x - r + 4, down, mark.label, "start" if right else "end", color)

    def curve(self, mark: Curve) -> Iterator[str]:
        points = [(i / 60, mark.law(i / 60)) for i in range(61)]
        color, dash = (GREY, ' stroke-dasharray="5 4"') if mark.before else (RED, "")
        line = "L".join(f"{x:.1f} {y:.1f}" for x, y in map(self.at, points))
        yield f'<path d="M{line}" stroke="{color}" stroke-width="2.5"{dash}/>'
        x, y = self.at(points[-1])
        yield self.text(x, y - 6, mark.label, "end", "#5b656d" if mark.before else RED)

    def look(self, name: str) -> tuple[str, float]:
        """Color of a wheel, and how far it is turned."""
        return (ORANGE, self.turned[name]) if name in self.turned else (GREY, 0.0)

    def tread(self, place: Place, radius: float, color: str, turned: float) -> str:
        """A wheel seen along the floor or from above; from behind it leans about where it stands."""
        (x, y), r = self.at(place), SCALE * radius
        width = 10 if radius == RADIUS else 8
        pivot = y + r if self.view == "rear" else y if radius == RADIUS else y - SCALE * FORK
        turn = f' transform="rotate({turned:g} {x:g} {pivot:g})"' if turned else ""
        return f'<rect x="{x - width / 2:g}" y="{y - r:g}" width="{width}" height="{2 * r:g}" rx="4" fill="{color}"{turn}/>'

    def ring(self, place: Place, radius: float, color: str) -> str:
        x, y = self.at(place)
        return f'<circle cx="{x:g}" cy="{y:g}" r="{SCALE * radius - 2:g}" stroke="{color}" stroke-width="4"/>'

    def dot(self, place: Place, r: float, color: str) -> str:
        x, y = self.at(place)
        return f'<circle cx="{x:g}" cy="{y:g}" r="{r:g}" fill="{color}"/>'

    def box(self, place: Place, turned: float) -> str:
        x, y = self.at(place)
        turn = f' transform="rotate({turned:g} {x:g} {y:g})"' if turned else ""
        return f'<rect x="{x - 9:g}" y="{y - 6:g}" width="18" height="12" rx="2" fill="{ORANGE}"{turn}/>'

    def path(self, places: Sequence[Place], color: str, width: float = 3) -> str:
        line = "L".join(f"{x:g} {y:g}" for x, y in map(self.at, places))
        return f'<path d="M{line}" stroke="{color}" stroke-width="{width:g}"/>'

    def arrow(self, start: Place, end: Place, color: str, tip: str, width: float = 2.5, both: bool = False) -> str:
        (a, b), (c, d) = self.at(start), self.at(end)
        back = f' marker-start="url(#{tip})"' if both else ""
        return f'<path d="M{a:g} {b:g}L{c:g} {d:g}" stroke="{color}" stroke-width="{width:g}" marker-end="url(#{tip})"{back}/>'

    def beside(self, end: Place, start: Place, label: str, color: str, middle: bool = False) -> Iterator[str]:
        """A word at an arrow's tip, or at its middle, on the side that is free."""
        (x, y), (a, b) = self.at(end), self.at(start)
        if middle:
            x, y = (x + a) / 2, (y + b) / 2
            yield (
                self.text(x + 6, y + 4, label, "start", color)
                if abs(b - y) > abs(a - x)
                else self.text(x, y - 6, label, "middle", color)
            )
        elif abs(y - b) > abs(x - a):
            yield self.text(x + 7, y + (12 if y > b else 2), label, "start", color)
        elif x >= a:
            yield self.text(x + 4, y - 6, label, "middle", color)
        else:
            yield self.text(x - 2, y - 6, label, "middle", color)

    @staticmethod
    def text(x: float, y: float, words: str, anchor: str = "start", color: str = INK) -> str:
        if not words:
            return ""
        halo = 'stroke="#fff" stroke-width="4" paint-order="stroke"'
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{color}" {halo}>{escape(words)}</text>'
