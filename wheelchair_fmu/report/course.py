"""A chair on its course, from above: a figure, and an animation in which the person strokes it round the cones.

Data in, a matplotlib Figure or pictures out. x, the way of travel, points to the right and y, the chair's right, down.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch, Polygon, Rectangle

from .figures import BLACK, BLUE, GREEN, GREY, ORANGE, tidy

CONE = 0.12  # m, radius
WHEEL = 0.31  # m, radius of a rear wheel as drawn
FORCE = 0.012  # m of arrow per N
EVERY = 2.0  # s from one chair in the figure to the next
PLAYED = 0.1  # s of film from one frame to the next
SPEED = 2.0  # times real time
WIDTH = 9.0  # inches


@dataclass(frozen=True, eq=False)
class Course:
    """What is drawn: time (n,) in s, and by name x, y, psi, u, F_rl, F_rr and, where there is one, path_y (n,), SI units.

    `cones` are (x, y); `patches` are parts of the floor (x1, x2, y1, y2, what it is); a, b, t_r and t_f are the chair's.
    """

    title: str
    time: np.ndarray
    columns: Mapping[str, np.ndarray]
    cones: Sequence[tuple[float, float]]
    patches: Sequence[tuple[float, float, float, float, str]]
    size: Mapping[str, float]


def course_figure(course: Course) -> Figure:
    """The path with the chair every two seconds, the pushes of both hands and the speed."""
    figure = Figure(figsize=(11, 6.4), layout="constrained")
    axes = figure.subplot_mosaic([["path"], ["push"], ["speed"]], height_ratios=[1.15, 1, 0.8])
    figure.suptitle(course.title)
    _ground(axes["path"], course)
    c = course.columns
    axes["path"].plot(c["x"], c["y"], color=BLUE, label="path of the CM")
    seconds = np.arange(course.time[0], course.time[-1], EVERY)
    for i in np.searchsorted(course.time, seconds):
        for part in _chair(course, i):
            axes["path"].add_patch(part)
    axes["path"].set_ylabel("y, to the right [m]")
    axes["path"].set_xlabel("x, forward [m]")
    axes["path"].legend(loc="lower right", bbox_to_anchor=(1, 1), frameon=False, ncols=4)
    for name, text, colour, style in (("F_rl", "left hand", BLUE, "-"), ("F_rr", "right hand", ORANGE, "--")):
        axes["push"].plot(course.time, c[name], style, color=colour, lw=1.2, label=text)
    axes["push"].set_ylabel("push [N]")
    axes["push"].legend(loc="lower right", bbox_to_anchor=(1, 1), frameon=False, ncols=2)
    axes["push"].tick_params(labelbottom=False)
    axes["speed"].plot(course.time, c["u"], color=BLACK)
    axes["speed"].set_ylabel("speed u [m/s]")
    axes["speed"].set_xlabel("time [s]")
    for name in ("push", "speed"):
        axes[name].set_xlim(course.time[0], course.time[-1])
        tidy(axes[name])
    return figure


def course_frames(course: Course) -> Iterator[np.ndarray]:
    """Pictures (height, width, 3) of the chair on its course at twice real time, an arrow for the push of each hand."""
    figure = Figure(figsize=(WIDTH, WIDTH * _shape(course)), dpi=120)
    canvas = FigureCanvasAgg(figure)
    ax = figure.add_axes((0, 0, 1, 1))
    _ground(ax, course)
    ax.set_xticks([])
    ax.set_yticks([])
    ax.spines[:].set_visible(False)
    trail = ax.plot([], [], color=BLUE, lw=1.5)[0]
    clock = ax.text(0.01, 0.97, "", transform=ax.transAxes, va="top")
    moving: list[Patch] = []
    for t in np.arange(course.time[0], course.time[-1] + 1e-9, PLAYED * SPEED):
        i = int(np.searchsorted(course.time, t - 1e-9))
        for part in moving:
            part.remove()
        moving[:] = [ax.add_patch(part) for part in (*_chair(course, i), *_pushes(course, i))]
        trail.set_data(course.columns["x"][: i + 1], course.columns["y"][: i + 1])
        clock.set_text(f"{t:4.1f} s   {course.columns['u'][i]:.2f} m/s")
        canvas.draw()
        yield np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _ground(ax: Axes, course: Course) -> None:
    """Floor, cones and the path that was meant, with equal scales."""
    (x1, x2), (y1, y2) = _extent(course)
    for a, b, c, d, text in course.patches:
        ax.add_patch(Rectangle((a, c), b - a, d - c, fc="#EAF3EE", ec=GREEN, lw=0.8, ls=":"))
        ax.text(max(a, x1) + 0.1, max(c, y1) + 0.1, text, va="top", fontsize=9, color=GREEN)
    if "path_y" in course.columns:
        ax.plot(course.columns["x"], course.columns["path_y"], ":", color=GREY, lw=1.2, label="path that was meant")
    for i, (x, y) in enumerate(course.cones):
        ax.add_patch(Circle((x, y), CONE, fc=ORANGE, ec="white", zorder=3, label="" if i else "cone"))
    ax.set_aspect("equal")
    ax.set_xlim(x1, x2)
    ax.set_ylim(y2, y1)  # y points to the chair's right: down, where it goes to the right of the picture
    tidy(ax)


def _extent(course: Course) -> tuple[tuple[float, float], tuple[float, float]]:
    x, y = course.columns["x"], course.columns["y"]
    aside = max(1.1, float(np.abs(y).max()) + 0.7)
    return (float(x.min()) - 0.8, float(x.max()) + 0.8), (-aside, aside)


def _shape(course: Course) -> float:
    """Height over width."""
    (x1, x2), (y1, y2) = _extent(course)
    return min(1.0, (y2 - y1) / (x2 - x1))


def _placed(course: Course, i: int, points: Sequence[tuple[float, float]]) -> np.ndarray:
    """Points of the chair (x_m forward, y_m right), (k, 2), in the room at sample i."""
    x, y, psi = (course.columns[k][i] for k in ("x", "y", "psi"))
    turn = np.array([[np.cos(psi), np.sin(psi)], [-np.sin(psi), np.cos(psi)]])
    return np.array(points) @ turn + (x, y)


def _chair(course: Course, i: int) -> list[Polygon]:
    """Rear wheels, casters and frame at sample i."""
    a, b, t_r, t_f = (course.size[k] for k in ("a", "b", "t_r", "t_f"))

    def bar(x: float, y: float, length: float, width: float, colour: str) -> Polygon:
        corners = [(x - length, y - width), (x + length, y - width), (x + length, y + width), (x - length, y + width)]
        return Polygon(_placed(course, i, corners), fc=colour, ec="none", zorder=4)

    frame = [(-b, -t_r / 2), (a, -t_f / 2), (a + 0.15, -0.1), (a + 0.15, 0.1), (a, t_f / 2), (-b, t_r / 2)]
    wheels = [bar(-b, side * t_r / 2, WHEEL, 0.025, BLACK) for side in (-1, 1)]
    casters = [bar(a, side * t_f / 2, 0.07, 0.02, BLACK) for side in (-1, 1)]
    return [Polygon(_placed(course, i, frame), fc="#9FC8E0", ec=BLUE, lw=0.8, zorder=3), *wheels, *casters]


def _pushes(course: Course, i: int) -> list[Polygon]:
    """An arrow beside each rear wheel, as long as the hand's push."""
    made = []
    for name, side in (("F_rl", -1), ("F_rr", 1)):
        length = FORCE * float(course.columns[name][i])
        if abs(length) > 0.03:
            y, x = side * (course.size["t_r"] / 2 + 0.13), -course.size["b"]
            head = np.sign(length) * min(abs(length), 0.18)
            points = [
                (x, y - 0.03),
                (x + length - head, y - 0.03),
                (x + length - head, y - 0.09),
                (x + length, y),
                (x + length - head, y + 0.09),
                (x + length - head, y + 0.03),
                (x, y + 0.03),
            ]
            made.append(Polygon(_placed(course, i, points), fc=ORANGE, ec="none", zorder=5))
    return made
