"""Which run and which device a file belongs to, from names: the part that changes with the run is the run.

::

    run01_SWL.csv  run01_SWR.csv  run01.trc        runs run01, run02, ...; devices SWL, SWR, trc
    m01.xlsx       m01_Moment.csv                  runs m01, m02, ...; devices xlsx, Moment
    slalom.csv     coast-down.csv                  runs slalom, coast-down; one device, where both have the same columns
"""

from __future__ import annotations

import re
import unicodedata
from collections import Counter, defaultdict
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import PurePath
from typing import Any

RUN_WORDS = (
    "run",
    "trial",
    "take",
    "test",
    "m",
    "messung",
    "versuch",
    "fahrt",
    "lauf",
    "essai",
    "mesure",
    "passage",
    "rec",
    "recording",
    "aufnahme",
    "r",
    "t",
)
# words that say who recorded, or where: never the name of a run
_WHO = """
    left right links rechts gauche droite l r lh rh frame rahmen cadre seat sitz imu gyro wheel wheels rad raeder roue roues
    swl swr sw smartwheel optipush markers marker mocap vicon optitrack trc moment torque drehmoment couple force encoder
    speed push rim rims pushrim sensor sensors xsens movella ngimu logger amplifier
"""
PLACES = frozenset(_WHO.split())
LONG_PLACES = tuple(word for word in PLACES if len(word) > 2)  # which may begin a word: imu2, leftwheel
LONGEST = 5  # digits of a run's number: more are a date or a serial number
_PACKED = (".gz", ".bz2", ".xz")
_BETWEEN = re.compile(r"[-_ .]+")
_NUMBERED = re.compile(r"([^\W\d]*?)(\d+)")


@dataclass(frozen=True)
class Name:
    """A file's name in parts: words of its stem, and its ending without the dot."""

    file: str
    words: tuple[str, ...]
    ending: str


@dataclass(frozen=True)
class Placed:
    """A file of a run and a device."""

    file: str
    run: str
    device: str


Split = tuple[str, tuple[str, ...]]  # the run, and the words that are left for the device


def parted(file: str) -> Name:
    """A file's name in parts; folders that it names count as words."""
    path = PurePath(file)
    packed = path.suffix.lower() in _PACKED
    plain = path.with_suffix("") if packed else path
    words = _BETWEEN.split("_".join((*plain.parent.parts, plain.stem)))
    return Name(file, tuple(word for word in words if word), plain.suffix.lstrip(".").lower())


Alike = Callable[[Any, Any], bool]  # of two kinds
Judge = Callable[[Mapping[str, Sequence[Hashable]]], dict[str, set[Hashable]]]  # by device, kinds that its files may have


def placed(files: Sequence[str], kind: Mapping[str, Hashable], respelt: Alike | None = None) -> list[Placed]:
    """The run and the device of each file. Files of equal `kind` have the same columns: only these can be one device's, as a
    pattern that takes loggers for runs has files of several loggers as one device's.

    Where no pattern holds then, one does in which most files of each device have the same columns, so that a wrong heading in
    one file takes no lab apart. Most are more than half, and the others have to be `respelt`, the same columns but for how
    headings are spelt; or half of the devices, at least, have to agree in all their files, which they do not where loggers are
    taken for runs: there each device has files of every logger.

    A number that all files have, as of the subject or the date, makes one run of them; one that parts them into several runs of
    several devices each is taken before it.
    """
    names = [parted(file) for file in files]
    ways = [*_by_number(names), *_by_word(names)]
    alike = respelt or (lambda one, other: False)
    for judge in (_as_they_are, partial(_spelt_alike, alike=alike), _outvoted):
        found = [placed for way in ways if (placed := _tried(names, way, kind, judge))]
        if found:
            crossed = [one for one in found if _crossed(one)]
            return min(crossed, key=_lacking, default=found[0]) if len({one.run for one in found[0]}) == 1 else found[0]
    return _apart(names, _joined(kind, alike))


def _lacking(of: Sequence[Placed]) -> tuple[int, int]:
    """How many files are not there, if each device recorded each run; and how many devices there are."""
    runs, devices = {one.run for one in of}, {one.device for one in of}
    return len(runs) * len(devices) - len(of), len(devices)


def _crossed(of: Sequence[Placed]) -> bool:
    """Are these several runs of several devices, and the runs no devices under one run's name: run1_left, run1_right?"""
    runs = {one.run: one.run.split("_") for one in of}
    shared = set.intersection(*map(set, runs.values()))
    merely = all(_of_devices([word for word in words if word not in shared]) for words in runs.values())
    devices = {one.device for one in of}
    return len(runs) > 1 and len(devices) > 1 and len(of) > max(len(runs), len(devices)) and not merely


def slug(text: str) -> str:
    """A name as a key of TOML: lower case, letters and digits of ASCII, with _ between words."""
    plain = unicodedata.normalize("NFKD", text.replace("ß", "ss")).encode("ascii", "ignore").decode()
    return re.sub(r"[^a-z0-9]+", "_", plain.lower()).strip("_")


def _by_number(names: Sequence[Name]) -> Iterator[Callable[[Name], Split | None]]:
    """Ways to take a numbered word for the run: run01, m03, trial 2. Those with a word for a run first, then those that most
    files have."""
    counts: dict[tuple[str, bool], set[str]] = defaultdict(set)
    for name in names:
        for prefix, alone, _ in _numbers(name):
            counts[prefix, alone].add(name.file)
    order = sorted(counts, key=lambda key: (-len(counts[key]), key[0] not in RUN_WORDS, not key[0]))
    order.sort(key=lambda key: key[0] not in RUN_WORDS or len(counts[key]) < 2)
    for key in order:
        yield partial(_numbered, key=key)


def _numbers(name: Name) -> Iterator[tuple[str, bool, int]]:
    """(prefix, whether the number is a word of its own, place of the number) of each numbered word."""
    for i, word in enumerate(name.words):
        found = _NUMBERED.fullmatch(word)
        if found and len(found[2]) <= LONGEST:
            alone = not found[1]
            before = name.words[i - 1].lower() if alone and i and name.words[i - 1].isalpha() else ""
            yield (before if alone else found[1].lower()), alone, i


def _numbered(name: Name, key: tuple[str, bool]) -> Split | None:
    for prefix, alone, i in _numbers(name):
        if (prefix, alone) == key:
            first = i - 1 if alone and prefix else i
            return "_".join(name.words[first : i + 1]), name.words[:first] + name.words[i + 1 :]
    return None


def _by_word(names: Sequence[Name]) -> Iterator[Callable[[Name], Split | None]]:
    """Ways to take the words from the beginning, or from the end, for the run: slalom_imu, slalom_wheels, coast_imu."""
    most = max((len(name.words) for name in names), default=0)
    for k in range(1, most + 1):
        yield partial(_first_words, k=k)
        yield partial(_last_words, k=k)


def _first_words(name: Name, k: int) -> Split | None:
    return ("_".join(name.words[:k]), name.words[k:]) if len(name.words) >= k else None


def _last_words(name: Name, k: int) -> Split | None:
    return ("_".join(name.words[-k:]), name.words[:-k]) if len(name.words) > k else None


def _tried(
    names: Sequence[Name], way: Callable[[Name], Split | None], kind: Mapping[str, Hashable], judge: Judge
) -> list[Placed] | None:
    """The files placed by one way; None where it places one not at all, two alike, or files of several kinds as one device's,
    or where each run has a device of its own."""
    splits = [way(name) for name in names]
    if any(split is None for split in splits):
        return None
    found = [(name, *split) for name, split in zip(names, splits, strict=True) if split is not None]
    devices = _devices([(name, rest) for name, _, rest in found], kind)
    result = [Placed(name.file, run, device) for (name, run, _), device in zip(found, devices, strict=True)]
    runs, every = defaultdict(set), defaultdict(list)
    for one in result:
        runs[one.run].add(one.device)
        every[one.device].append(kind.get(one.file))
    kinds = judge(every)
    twice = len({(one.run, one.device) for one in result}) < len(result)
    crossed = len(runs) == 1 or len(kinds) < len(result)
    mixed = any(len(of) > 1 for of in kinds.values()) or any(_of_devices(run.split("_")) for run in runs)
    return None if twice or mixed or not crossed or _merely_named(kinds) else result


def _as_they_are(of: Mapping[str, Sequence[Hashable]]) -> dict[str, set[Hashable]]:
    return {device: set(kinds) for device, kinds in of.items()}


def _spelt_alike(of: Mapping[str, Sequence[Hashable]], alike: Alike) -> dict[str, set[Hashable]]:
    """The kind of more than half of a device's files alone, where all others are like it."""
    return {device: _usual(kinds, alike) for device, kinds in of.items()}


def _outvoted(of: Mapping[str, Sequence[Hashable]]) -> dict[str, set[Hashable]]:
    """The kind of more than half of a device's files alone, where at least half of the devices agree in all their files."""
    several = [kinds for kinds in of.values() if len(kinds) > 1]
    agreeing = sum(len(set(kinds)) == 1 for kinds in several)
    if not agreeing or 2 * agreeing < len(several):
        return _as_they_are(of)
    return {device: _usual(kinds, lambda one, other: True) for device, kinds in of.items()}


def _usual(kinds: Sequence[Hashable], alike: Alike) -> set[Hashable]:
    (usual, most), *others = Counter(kinds).most_common()
    return {usual} if 2 * most > len(kinds) and all(alike(other, usual) for other, _ in others) else set(kinds)


def _joined(kind: Mapping[str, Hashable], alike: Alike) -> dict[str, Hashable]:
    """The kinds of files; in the place of one that is like another, which more files have, that other."""
    counts = Counter(kind.values()).most_common()
    meant = {one: next((other for other, more in counts if more > n and alike(one, other)), one) for one, n in counts}
    return {file: meant[one] for file, one in kind.items()}


def _of_devices(words: Sequence[str]) -> bool:
    return all(word.rstrip("0123456789").lower() in PLACES for word in words)


def _merely_named(kinds: Mapping[str, set[Hashable]]) -> bool:
    """Are there devices with the same columns whose names do not say that they are several, such as slow and quick?"""
    for device, of in kinds.items():
        alike = [other for other in kinds if other != device and kinds[other] & of]
        if alike and not any(word.startswith(LONG_PLACES) or word in PLACES for word in device.split("_")):
            return True
    return False


def _devices(rests: Sequence[tuple[Name, tuple[str, ...]]], kind: Mapping[str, Hashable]) -> list[str]:
    """Names of devices: the words that are left of a file's name, with its ending where these do not tell devices apart."""
    plain = [slug("_".join(rest)) for _, rest in rests]
    endings: dict[str, set[str]] = defaultdict(set)
    for (name, _), device in zip(rests, plain, strict=True):
        endings[device].add(name.ending)
    return [
        slug(name.ending) or "file" if not device else f"{device}_{name.ending}" if len(endings[device]) > 1 else device
        for (name, _), device in zip(rests, plain, strict=True)
    ]


def _apart(names: Sequence[Name], kind: Mapping[str, Hashable]) -> list[Placed]:
    """No pattern: files that are called as devices are of one run, left.csv and right.csv; else each file is a run of its own,
    of one device for all that have the same columns."""
    stems = ["_".join(name.words) for name in names]
    if len(names) > 1 and all(map(_of_devices, (name.words for name in names))):
        own = [
            slug(stem) if stems.count(stem) == 1 else slug(f"{stem}_{n.ending}") for stem, n in zip(stems, names, strict=True)
        ]
        return [Placed(name.file, "run", device) for name, device in zip(names, own, strict=True)]
    kinds = list(dict.fromkeys(kind.get(name.file) for name in names))
    devices = [next(slug("_".join(n.words)) or "file" for n in names if kind.get(n.file) == one) for one in kinds]
    return [
        Placed(
            name.file, stem if stems.count(stem) == 1 else f"{stem}_{name.ending}", devices[kinds.index(kind.get(name.file))]
        )
        for name, stem in zip(names, stems, strict=True)
    ]
