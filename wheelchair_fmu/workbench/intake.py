"""What files a session takes in, under what names, and how much they may unpack to."""

from __future__ import annotations

import gzip
import os
import stat
import zlib
from pathlib import Path, PurePosixPath
from typing import BinaryIO

from ..campaign.formats import bundled as formats
from ..errors import UsageError

SUFFIXES = (".toml", ".gz", *sorted({suffix for record in formats().values() for suffix in record.suffixes}))
PROGRAMS = (".py", ".pyc", ".pyw", ".fmu", ".ssp")
LONGEST_PART, MOST_PARTS = 120, 6  # characters of a name (bytes, so that the system takes it), folders within each other
MOST_BYTES = 512_000_000  # of recordings at once, and of what one of them unpacks to
PIECE = 1 << 20


class NoRecording(UsageError):
    """A file of a kind that no campaign is made of, as notes and pictures are."""


def safe_path(name: str) -> PurePosixPath:
    """The path of a file within its campaign. Raises UsageError for a name that cannot belong to one, NoRecording where it is
    only of another kind."""
    path, shown = PurePosixPath(name.replace("\\", "/")), repr(name if len(name) <= 80 else f"{name[:77]}...")
    if path.is_absolute() or not path.name or any(p == ".." or p.startswith(".") for p in path.parts) or not name.isprintable():
        raise UsageError(f"{shown} is no name for a file of a campaign; give a plain name")
    if len(path.parts) > MOST_PARTS or any(len(p.encode(errors="replace")) > LONGEST_PART for p in path.parts):
        raise UsageError(f"{shown} is too long for a file of a campaign; give each part at most {LONGEST_PART} characters")
    if path.suffix.lower() in PROGRAMS:
        raise UsageError(
            f"{shown} is a program, and the workbench runs none that is dropped into it; where you trust it, give "
            "its folder to `wheelchair diagnose --effects DIR`"
        )
    if path.suffix.lower() not in SUFFIXES:
        raise NoRecording(f"{path}: {path.suffix or 'no ending'} is no recording; give one of {', '.join(SUFFIXES)}")
    return path


def refuse_bomb(file: BinaryIO, name: str, most: int) -> None:
    """Unpacks a .gz piece by piece, keeps nothing, and raises UsageError where it grows beyond all reason.

    A broken one is taken in: its fault is told with all others.
    """
    grown = 0
    try:
        with gzip.open(file) as unpacked:
            while piece := unpacked.read(PIECE):
                grown += len(piece)
                if grown > most:
                    raise UsageError(
                        f"{name} unpacks to more than {most / 1e6:g} MB; raise --upload-limit, or use `wheelchair diagnose`"
                    )
    except (EOFError, OSError, zlib.error):
        return


def close_to_others(root: Path, sessions: list[Path]) -> None:
    """Make these folders, and all in them, readable by their owner alone: they hold recordings of people.

    The root as well, where nothing else is in it. Links are not followed, and what belongs to somebody else stays as it is.
    """
    everything = [Path(at) / name for s in sessions for at, folders, files in os.walk(s) for name in (*folders, *files)]
    alone = {p.name for p in root.iterdir()} <= {s.name for s in sessions}
    for path in (*([root] if alone else []), *sessions, *everything):
        mode = path.lstat().st_mode
        if stat.S_ISLNK(mode) or not stat.S_IMODE(mode) & 0o077:
            continue
        try:
            path.chmod(0o700 if stat.S_ISDIR(mode) else 0o600)
        except PermissionError:
            continue
