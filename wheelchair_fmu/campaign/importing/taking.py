"""Which files are meant: those that are named, and those in folders, each once."""

from __future__ import annotations

import hashlib
import os
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from ...errors import UsageError
from ...faults import WARNING, Fault
from ...given import what_is

MADE = ("preview.html", "preview.png", "clocks.png")  # that this program puts beside a campaign.toml


def taken(paths: Sequence[Path]) -> tuple[list[tuple[Path, str]], list[Fault]]:
    """The files, with the names that tell them apart, and a sentence for each that is there twice.

    Raises UsageError for a path that is no file and no folder.
    """
    files = list(dict.fromkeys(file for path in paths for file in _files(path)))
    names = _names(files)
    seen: dict[object, str] = {}
    kept, faults = [], []
    sizes = Counter(file.stat().st_size for file in files)
    for file, name in zip(files, names, strict=True):
        keys = [file.resolve(), *([_content(file)] if sizes[file.stat().st_size] > 1 else [])]
        same = next((seen[key] for key in keys if key in seen), None)
        if same is None:
            kept.append((file, name))
            seen |= dict.fromkeys(keys, name)
        elif file.stat().st_size:
            fact = f"left out: it holds the same as {same}"
            faults.append(Fault(name, None, None, fact, "export it again if it should be another recording", WARNING))
        else:
            kept.append((file, name))
    return kept, faults


def _files(path: Path) -> Iterator[Path]:
    if path.is_dir():
        inside = sorted(p for p in path.rglob("*") if not any(part.startswith(".") for part in p.relative_to(path).parts))
        yield from (p for p in inside if p.is_file() and p.name not in MADE)
    elif kind := what_is(path):
        raise UsageError(f"{path} is {kind}; give recordings, or a folder of them")
    else:
        yield path


def _names(files: Sequence[Path]) -> list[str]:
    """Names without folders where these are enough to tell files apart, else with the folders in which they differ."""
    often = Counter(file.name for file in files)
    if all(n == 1 for n in often.values()):
        return [file.name for file in files]
    shared = Path(os.path.commonpath([file.resolve().parent for file in files]))
    return [file.resolve().relative_to(shared).as_posix() for file in files]


def _content(file: Path) -> str:
    with file.open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()
