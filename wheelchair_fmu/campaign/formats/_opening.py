"""Opening a recording: by the format that the run names, else by what the file holds, else by its name."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...dialect import is_binary
from ...faults import Fault, run_fault, suggestion
from ...tables import Table, unreadable
from ._defined import read_head
from ._record import Format
from ._registry import formats

_BINARIES = (
    (b"PK\x03\x04", "a ZIP archive", "unpack it and name the file that it holds"),
    (b"PK\x05\x06", "an empty ZIP archive", "export the recording again"),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an OLE2 file, such as an old .xls workbook", "save it as .xlsx or CSV"),
    (b"\x89PNG\r\n\x1a\n", "a PNG picture", "name the recording instead"),
    (b"\xff\xd8\xff", "a JPEG picture", "name the recording instead"),
    (b"GIF8", "a GIF picture", "name the recording instead"),
    (b"%PDF-", "a PDF document", "export the numbers as CSV"),
    (b"SQLite format 3\x00", "an SQLite database", "export the table as CSV"),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file", 'if MATLAB wrote it, write format = "mat"; else export it as CSV'),
    (b"\x1f\x8b", "compressed by gzip", "let its name end in .gz, as in run.csv.gz"),
    (b"BZh", "compressed by bzip2", "unpack it"),
    (b"\xfd7zXZ\x00", "compressed by xz", "unpack it"),
    (b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive", "unpack it and name the file that it holds"),
    (b"Rar!", "a RAR archive", "unpack it and name the file that it holds"),
    (b"TDSm", "a TDMS file of LabVIEW", "export it as CSV"),
    (b"ARROW1", "an Arrow file (Feather)", "save it as Parquet"),
    (b"\x93NUMPY", "a NumPy array", "save it as CSV or Parquet with names of the columns"),
)


def open_recording(path: Path, file: str, options: Mapping[str, Any]) -> tuple[Table | None, list[Fault]]:
    """The recording at `path`, which the user calls `file`, and what is wrong with it; without a table where it cannot be read.

    `options` are the keys of its run; `format` among them says what it is. The file exists.
    """
    known, _ = formats()
    asked = options.get("format")
    if isinstance(asked, str) and asked:
        if asked not in known:
            return None, [run_fault(file, f"there is no format {asked!r}", suggestion(asked, known))]
        return known[asked].read(path, file, options)
    try:
        head = read_head(path)
    except OSError as error:
        return None, [unreadable(file, error)]
    record = _recognised(known, path, head) or _by_name(known, path)
    if record is not None and record.id != "csv":
        return record.read(path, file, options)
    if told := _named(head):
        return None, [run_fault(file, f"the file is {told[0]}, not a recording", told[1])]
    if is_binary(head):
        return None, [run_fault(file, "the file is binary, of no kind that is known", "export it as CSV, or name its format")]
    return known["csv"].read(path, file, options)


def format_of(path: Path) -> str:
    """What a file is, in words: the title of its format."""
    known, _ = formats()
    try:
        head = read_head(path)
    except OSError:
        return "unreadable"
    return (_recognised(known, path, head) or _by_name(known, path) or known["csv"]).title


def _recognised(known: Mapping[str, Format], path: Path, head: bytes) -> Format | None:
    """The format that finds its own in the content; of several, the one whose suffix the file has."""
    found = [record for record in known.values() if record.recognises(path, head)]
    return min(found, key=lambda record: path.suffix.lower() not in record.suffixes, default=None)


def _by_name(known: Mapping[str, Format], path: Path) -> Format | None:
    suffix = path.suffix.lower() if path.suffix.lower() != ".gz" else Path(path.stem).suffix.lower()
    return next((record for record in known.values() if suffix in record.suffixes), None)


def _named(head: bytes) -> tuple[str, str] | None:
    """What a file is that is no recording, and what to do about it."""
    return next(((what, cure) for magic, what, cure in _BINARIES if head.startswith(magic)), None)
