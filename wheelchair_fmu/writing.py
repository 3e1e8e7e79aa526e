"""Files written beside their place, then renamed, so that nothing there is replaced by half a result."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4

FULL = tuple(getattr(errno, name) for name in ("ENOSPC", "EDQUOT", "EFBIG") if hasattr(errno, name))  # the disk, or one's share


@contextmanager
def written(path: Path) -> Iterator[Path]:
    """A path to write to, with the same ending; what is there becomes `path` if all goes well.

    Several threads and processes may write the same path; the last one stands. Raises OSError, naming `path`, where the
    folder cannot be made or written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{os.getpid()}-{uuid4().hex[:6]}-{path.name}")
    try:
        yield beside
        settle(beside, path)
    except OSError as error:
        # nobody asked for the file beside; and a disk that is full names none
        if error.filename == str(beside) or (error.filename is None and error.errno in FULL):
            error.filename, error.filename2 = str(path), None
        raise
    finally:
        beside.unlink(missing_ok=True)


def settle(beside: Path, path: Path) -> None:
    """Rename a finished file to `path` in such an order that a power failure leaves the old one or the new one, whole."""
    with beside.open("rb+") as file:
        os.fsync(file.fileno())
    beside.replace(path)
    if os.name == "nt":  # where a folder cannot be opened
        return
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    except OSError as error:
        if error.errno != errno.EINVAL:  # what file systems say that have nothing to flush for a folder
            raise
    finally:
        os.close(folder)
