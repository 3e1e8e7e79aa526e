"""Which version of this package is at work, to the letter: for results that somebody will want to make again."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

from .configuration import FORMATS, MANOEUVRES, OF_MODELS
from .configuration import digest as own

PACKAGE = Path(__file__).parent
CODE = (".py", ".c", ".h")


@cache
def code_fingerprint() -> str:
    """SHA-256 over every file of code in the package, by its place and content; line ends do not count. Laws, channels,
    manoeuvres and formats of a user's own are in it."""
    digest = hashlib.sha256()
    for file in sorted(PACKAGE.rglob("*")):
        place = file.relative_to(PACKAGE)
        if file.suffix in CODE and file.is_file() and "share" not in place.parts[:1]:
            digest.update(f"\0{place.as_posix()}\0".encode() + file.read_bytes().replace(b"\r\n", b"\n"))
    digest.update(own(*OF_MODELS, MANOEUVRES, FORMATS).encode())
    return digest.hexdigest()
