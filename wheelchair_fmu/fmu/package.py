"""The archive: the same files give the same bytes, and it appears whole or not at all."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from pathlib import Path

from ..errors import BuildError
from ..writing import written

EPOCH = datetime(1980, 1, 1, tzinfo=UTC)  # the earliest a zip file can say, so that no build shows its date
Files = Mapping[str, bytes]


def moment() -> datetime | None:
    """When the archive counts as made: $SOURCE_DATE_EPOCH, in seconds since 1970; None where that is not set.

    Raises BuildError where it is no such number.
    """
    seconds = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not seconds:
        return None
    try:
        return datetime.fromtimestamp(int(seconds), UTC)
    except (ValueError, OverflowError, OSError):
        raise BuildError(f"SOURCE_DATE_EPOCH = {seconds!r} is no number of seconds since 1970; give one or unset it") from None


def write(target: Path, files: Files, faults: Callable[[Path], list[str]]) -> Path:
    """Write an archive of `files` by path, if it has no faults. Raises BuildError where that is not possible."""
    try:
        with written(target) as beside:
            _zip(beside, files)
            if found := faults(beside):
                raise BuildError(f"{target}: would not be valid: {'; '.join(found)}")
    except OSError as error:
        raise BuildError(f"{target}: cannot be written: {error.strerror}; give another place with -o") from error
    return target


def _zip(path: Path, files: Files) -> None:
    # What describes an archive comes first, as readers expect; the rest in alphabetical order.
    order = sorted(files, key=lambda name: (name not in ("modelDescription.xml", "SystemStructure.ssd"), name))
    date = max(moment() or EPOCH, EPOCH).timetuple()[:6]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in order:
            entry = zipfile.ZipInfo(name, date)
            entry.create_system = 3  # unix, so that permissions mean the same wherever it was built
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, files[name])
