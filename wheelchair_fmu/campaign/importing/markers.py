"""Which markers are the ends of the rear axle, and how the laboratory's axes lie to the room: from distances, heights and the
way the chair goes. Markers on the rider's body go by their names."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ...units import same_dimension, split
from .. import body
from ..derived import coordinate
from .gathering import Column, Source, scale_of
from .guesses import side_of

HUB = re.compile(r"hub|axle|axis|wheel|rad|nabe|achse|moyeu|essieu|roue|rim", re.IGNORECASE)
TRACK = (0.4, 0.9)  # m between the ends of a rear axle
HEIGHT = (0.2, 0.45)  # m of them above the floor
RIGID = 0.006  # m by which their distance may vary
AXES = "xyz"


BODY = {  # how names of markers on a body begin, but for their side
    "head": ("HEAD", "VERTEX", "FOREHEAD", "KOPF", "TETE"),
    "c7": ("C7",),
    "sternum": ("STERN", "STRN", "CLAV", "MANUB", "SUPRAST", "BRUSTBEIN"),
    "shoulder": ("SHO", "ACR", "SCHULTER", "EPAULE"),
    "elbow": ("ELB", "ELLBOGEN", "COUDE"),
    "wrist": ("WRI", "HANDGELENK", "POIGNET"),
    "hand": ("HAND", "MCP", "METAC"),
    "hip": ("HIP", "TROCH", "GTROC", "HUEFTE", "HANCHE"),
}


@dataclass(frozen=True)
class Axle:
    """The markers of the axle's ends, the laboratory's axes as campaign.toml names them, and what told all that."""

    left: str
    right: str
    x: str
    y: str
    why: str
    swapped: bool


def triples(source: Source) -> dict[str, dict[str, Column]]:
    """Markers with columns NAME.x, NAME.y and NAME.z; or NAME_X and so on, where their unit is one of length, as sensors on a
    frame have axes, too."""
    found: dict[str, dict[str, Column]] = {}
    for column in source.columns:
        bare = split(column.header)[0].strip()
        if (of := coordinate(column.header)) and (
            bare[:-1].endswith(".") or (column.unit and same_dimension(column.unit, "m"))
        ):
            found.setdefault(bare[: len(of[0])], {})[of[1]] = column
    return {name: by for name, by in found.items() if len(by) == len(AXES)}


def is_markers(source: Source) -> bool:
    """Two markers at least, in units of length."""
    of = triples(source)
    lengths = [
        by["x"] for by in of.values() if by["x"].unit is None or scale_of(by["x"].unit, "m") != 1.0 or by["x"].unit == "m"
    ]
    return len(lengths) >= 2 and not any("acc" in n.lower() or "gyr" in n.lower() for n in of)


def axle(source: Source) -> Axle | str:
    """The axle that the markers show; a sentence where they show none."""
    seen = {name: _paths(source, by) for name, by in triples(source).items()}
    pairs = [(name, other) for name, other in combinations(seen, 2) if _rigid(seen[name], seen[other])]
    hubs = [pair for pair in pairs if all(HUB.search(name) for name in pair)]
    low = [pair for pair in hubs or pairs if _upward(seen[pair[0]], seen[pair[1]]) is not None]
    if not low:
        return (
            f"no two of the markers {', '.join(seen)} are the ends of an axle (as far apart as wheels all the time, as high as "
            "a hub): write markers = { axle_l = ..., axle_r = ... }"
        )
    one, other = low[0]
    up = _upward(seen[one], seen[other])
    assert up is not None
    left, right, named = _named(one, other)
    x, y = _room(seen[left], seen[right], up)
    ahead = _ahead(seen[left], seen[right], x, y)
    if ahead < 0:
        left, right = right, left
    apart = float(np.median(np.concatenate([np.linalg.norm(a - b, axis=1) for a, b in _both(seen[one], seen[other])])))
    why = f"by their signals: {apart:.3f} m apart all the time, as high as a hub; {_word(up)} is up"
    return Axle(left, right, _word(x), _word(y), why, named and ahead < 0)


Way = tuple[int, float]  # one of the laboratory's axes, and its sign


def _word(way: Way) -> str:
    return ("-" if way[1] < 0 else "") + AXES[way[0]]


def _paths(source: Source, by: Mapping[str, Column]) -> list[np.ndarray]:
    """In each run (n, 3), m."""
    found = []
    for run in source.files:
        series = [source.series(run, by[axis], "m") for axis in AXES]
        if all(one is not None for one in series):
            found.append(np.stack([one[1] for one in series if one is not None], axis=1))
    return found


def _both(one: list[np.ndarray], other: list[np.ndarray]) -> list[tuple[np.ndarray, np.ndarray]]:
    """The moments at which both are seen."""
    found = []
    for a, b in zip(one, other, strict=False):
        seen = np.isfinite(a).all(axis=1) & np.isfinite(b).all(axis=1) if len(a) == len(b) else np.zeros(len(a), bool)
        if seen.sum() > 10:
            found.append((a[seen], b[seen]))
    return found


def _rigid(one: list[np.ndarray], other: list[np.ndarray]) -> bool:
    both = _both(one, other)
    if not both:
        return False
    apart = np.concatenate([np.linalg.norm(a - b, axis=1) for a, b in both])
    low, middle, high = np.percentile(apart, [5, 50, 95])
    return bool(TRACK[0] < middle < TRACK[1] and high - low < 2 * RIGID)


def _upward(one: list[np.ndarray], other: list[np.ndarray]) -> Way | None:
    """The axis on which both stay where they are, as high as a hub."""
    both = np.concatenate([0.5 * (a + b) for a, b in _both(one, other)])
    spread = np.ptp(np.percentile(both, [5, 95], axis=0), axis=0)
    for axis in np.argsort(spread):
        middle = float(np.median(both[:, axis]))
        if HEIGHT[0] < abs(middle) < HEIGHT[1] and spread[axis] < 0.05:
            return int(axis), float(np.sign(middle))
    return None


def _named(one: str, other: str) -> tuple[str, str, bool]:
    """Left and right by their names, and whether these say so."""
    for left, right in ((one, other), (other, one)):
        words = side_of(left) == "l" and side_of(right) == "r"
        first = left[:1].upper() == "L" and right[:1].upper() == "R" and left[1:] == right[1:]
        last = left[-1:].upper() == "L" and right[-1:].upper() == "R" and left[:-1] == right[:-1]
        if words or first or last:
            return left, right, True
    return one, other, False


def _room(left: list[np.ndarray], right: list[np.ndarray], up: Way) -> tuple[Way, Way]:
    """x along most of the way; y to the right of it: x, y and down are right-handed, as the laboratory's axes are."""
    flat = [axis for axis in range(3) if axis != up[0]]
    moved = np.zeros(3)
    for a, b in _both(left, right):
        moved += (0.5 * (a + b))[-1] - (0.5 * (a + b))[0]
    spans = [np.ptp(0.5 * (a + b), axis=0) for a, b in _both(left, right)]
    along = max(flat, key=lambda axis: max(span[axis] for span in spans))
    x = along, float(np.sign(moved[along])) or 1.0
    across = np.cross(x[1] * np.eye(3)[along], up[1] * np.eye(3)[up[0]])  # forward × up is to the right
    y = int(np.argmax(np.abs(across)))
    return x, (y, float(np.sign(across[y])))


def _ahead(left: list[np.ndarray], right: list[np.ndarray], x: Way, y: Way) -> float:
    """How far the axle moves ahead of itself, less what it backs up, if left and right are called so."""
    total = 0.0
    for a, b in _both(left, right):
        across = np.stack([way[1] * (b - a)[:, way[0]] for way in (x, y)], axis=1)
        middle = np.stack([way[1] * 0.5 * (a + b)[:, way[0]] for way in (x, y)], axis=1)
        heading = np.stack([across[:, 1], -across[:, 0]], axis=1) / np.linalg.norm(across, axis=1)[:, None]
        total += float((np.diff(middle, axis=0) * heading[1:]).sum())
    return total


def on_the_body(source: Source) -> dict[str, str]:
    """Markers that every recording has on the rider's body, as campaign.toml calls them; none unless one is on the trunk."""
    found: dict[str, str] = {}
    for name, by in triples(source).items():
        everywhere = all(c.header in one.table.headers for c in by.values() for one in source.files.values())
        place = place_on_body(name) if everywhere else ""
        if place in body.MARKERS:
            found.setdefault(place, name)
    return {place: found[place] for place in body.MARKERS if place in found} if body.TRUNKS & found.keys() else {}


def place_on_body(name: str) -> str:
    """Where on a body a marker of this name is: "shoulder_l"; nothing for one that is elsewhere."""
    bare = name.upper().rpartition(":")[2]  # a subject's name stands before
    for place, words in BODY.items():
        sided = f"{place}_l" in body.MARKERS
        for side, rest in _ways(bare, name) if sided else [("", bare)]:
            if rest.startswith(words):
                return f"{place}_{side}" if sided else place
    return ""


def _ways(bare: str, name: str) -> list[tuple[str, str]]:
    """The side that a name may tell, and what is left of it: by its first letter, its last one, or a word."""
    ways = [(bare[:1].lower(), bare[1:].lstrip("_-. ")), (bare[-1:].lower(), bare), (side_of(name), bare)]
    return [(side, rest) for side, rest in ways if side in ("l", "r")]


def pose(source: Source, run: str, found: Axle) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """x, y and yaw of the axle's middle in a run, for setting it beside other devices."""
    by = triples(source)
    series = {
        (end, w): source.series(run, by[end][w[-1]], "m") for end in (found.left, found.right) for w in (found.x, found.y)
    }
    if any(one is None for one in series.values()):
        return {}
    value = {key: (-1.0 if key[1].startswith("-") else 1.0) * one[1] for key, one in series.items() if one is not None}
    time = next(one[0] for one in series.values() if one is not None)
    middle = [0.5 * (value[found.left, w] + value[found.right, w]) for w in (found.x, found.y)]
    across = [value[found.right, w] - value[found.left, w] for w in (found.x, found.y)]
    return {"x": (time, middle[0]), "y": (time, middle[1]), "yaw": (time, np.arctan2(-across[0], across[1]))}
