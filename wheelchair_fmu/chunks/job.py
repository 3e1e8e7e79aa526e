"""What a pool and the parts need to know of the work."""

from __future__ import annotations

from typing import ClassVar, Protocol

import pyarrow as pa

ERROR = "error"  # the column that says why a row gave nothing; empty where it did
FINGERPRINT = b"fingerprint"  # in the schema's metadata


class Job(Protocol):
    """Work in chunks, which are tables. It can be pickled, and two jobs with the same `fingerprint` have the same result.

    `what` it is made of, for a sentence: parts are of another such.
    """

    what: ClassVar[str]

    @property
    def by_threads(self) -> bool:
        """Whether threads of one process do it side by side: nearly all of its time is outside of Python."""
        ...

    @property
    def fingerprint(self) -> str: ...

    @property
    def chunks(self) -> int: ...

    @property
    def total(self) -> int:
        """Rows of the result."""
        ...

    def rows(self, chunk: int) -> int:
        """Rows of a chunk."""
        ...

    def schema(self) -> pa.Schema:
        """The result's columns; the metadata has the fingerprint."""
        ...

    def table(self, chunk: int) -> pa.Table:
        """Do the chunk."""
        ...
