"""Generated C as object files, each compiled once for all libraries that have the same of it, whatever it was derived for."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from . import compiler
from .source import CSRC
from .store import kept


def compiled(name: str, text: str, flags: Sequence[str], cross: tuple[str, ...] | None = None) -> Path:
    """The object of C `text`, which may include the headers of `csrc`, kept between sessions. `cross` is the compiler for
    another system than this. Raises BuildError with the compiler's own words."""
    words = "\n".join((text, headers(), compiler.version(cross), *compiler.FLAGS, *flags))

    def make(path: Path) -> None:
        source = path.with_name(f"{name}.c")
        source.write_text(text, encoding="utf-8")
        compiler.compile_object(source, path, [f"-I{CSRC}", *flags], cross)

    return kept(f"{name}-{hashlib.sha256(words.encode()).hexdigest()[:24]}", ".o", make)


@cache
def headers() -> str:
    """What generated C includes, by its content."""
    return hashlib.sha256(b"".join(f.read_bytes() for f in sorted(CSRC.glob("*.h")))).hexdigest()
