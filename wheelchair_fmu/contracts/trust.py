"""Which programs in other people's files this user has said to trust, by the digests of their texts.

They are remembered beside the compiled models, in a folder that this user alone can write and whose files are run anyway.
"""

from __future__ import annotations

from collections.abc import Iterable

from ..engine.store import folder
from ..model.stage import Program


def is_trusted(program: Program) -> bool:
    return (folder() / _name(program)).is_file()


def remember(programs: Iterable[Program]) -> None:
    """Trust these from now on, on this machine. Raises OSError where this cannot be written."""
    for program in programs:
        (folder() / _name(program)).touch(mode=0o600)


def _name(program: Program) -> str:
    return f"trusted-{program.sha256}"
