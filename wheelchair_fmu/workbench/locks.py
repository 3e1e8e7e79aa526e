"""One change of a session after the other, whoever asks: threads of this server, and another server over the same folder."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock

from filelock import FileLock, Timeout

from ..errors import Failure
from .session import Session

PATIENCE = 120.0  # s; a change takes far less, even of recordings of hours


class Locks:
    """A lock for each session. Not to be taken twice by one thread."""

    def __init__(self) -> None:
        self._mine = Lock()
        self._locks: dict[str, Lock] = {}

    @contextmanager
    def held(self, session: Session) -> Iterator[None]:
        """Raises Failure where another server holds the session for too long."""
        with self._mine:
            lock = self._locks.setdefault(session.id, Lock())
        with lock:
            try:
                with FileLock(session.folder / ".lock", mode=0o600).acquire(timeout=PATIENCE, poll_interval=0.01):
                    yield
            except Timeout:
                raise Failure("another workbench has held this session for two minutes; end it, or try again") from None
