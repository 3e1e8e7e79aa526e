"""Unpack an archive inside one folder, if it is of a sensible size: an archive comes from who knows where."""

from __future__ import annotations

import lzma
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path

from ...errors import Failure

MOST_FILES, MOST_BYTES = 10_000, 1_000_000_000  # of one archive, unpacked
BROKEN = (zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, NotImplementedError, RuntimeError, OSError)


def unpack(path: Path, folder: Path) -> Iterator[str]:
    """Unpack what belongs inside `folder`, and yield the names that lead out of it, which are left out.

    Raises Failure for a file that is no archive, or one that is too much.
    """
    try:
        with zipfile.ZipFile(path) as packed:
            if fact := too_much(packed):
                raise Failure(f"{path}: {fact}; pack less into one archive")
            for name in packed.namelist():
                if (folder / name).resolve().is_relative_to(folder.resolve()):
                    packed.extract(name, folder)
                else:
                    yield name
    except BROKEN as error:
        raise Failure(
            f"{path}: not a zip archive that can be read ({error}); an .ssp is one, with SystemStructure.ssd in it"
        ) from None


def too_much(packed: zipfile.ZipFile) -> str:
    """What is too much about an archive; "" where nothing is. Of an entry no more is ever read than it announces here."""
    entries = packed.infolist()
    size = sum(entry.file_size for entry in entries)
    if len(entries) <= MOST_FILES and size <= MOST_BYTES:
        return ""
    return (
        f"{len(entries)} files of {size / 1e6:.0f} MB in all, unpacked, are more than {MOST_FILES} files or "
        f"{MOST_BYTES / 1e6:.0f} MB"
    )
