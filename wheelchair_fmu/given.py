"""Files that others give: what stands at a path, and TOML that is neither too deep nor too long to be read."""

from __future__ import annotations

import stat
import tomllib
from pathlib import Path
from typing import Any

DEEPEST = 30  # tables in tables: no file of this program has more than four
_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a named pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}


def what_is(path: Path) -> str:
    """What stands there if that is no file: "a folder", "a named pipe", ...; "" for a file, "no file" where nothing is."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):  # among them names that no disk can have
        return "no file"
    return "" if stat.S_ISREG(mode) else _KINDS.get(stat.S_IFMT(mode), "no file")


def toml(text: str) -> dict[str, Any]:
    """As tomllib reads it. Raises TOMLDecodeError, for tables nested too deeply and numbers that are too long as well."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError:
        raise tomllib.TOMLDecodeError("Tables or lists are nested too deeply") from None
    except ValueError as error:  # of an integer of more than 4300 digits
        raise tomllib.TOMLDecodeError(f"A number is too long: {error}".partition(";")[0]) from None
    if _deeper(data, DEEPEST):
        raise tomllib.TOMLDecodeError(f"Tables or lists are nested more than {DEEPEST} deep")
    return data


def _deeper(data: Any, most: int) -> bool:
    level = [data]
    for _ in range(most):
        level = [
            inner
            for outer in level
            for inner in (outer.values() if isinstance(outer, dict) else outer)
            if isinstance(inner, dict | list)
        ]
        if not level:
            return False
    return True
