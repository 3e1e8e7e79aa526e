"""Child processes that end when this one does, however it ends: what SIGKILL ends can tell nobody.

On Windows only those end that this process can still tell.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from typing import IO, Any

# The guard's standard input is a pipe whose other end this process alone holds. It closes when this process lets go or ends;
# then the guard ends the group that it leads, so also what the child itself has started.
GUARD = ("/bin/sh", "-c", "while read -r _; do :; done; kill -s KILL 0")

_held: set[IO[bytes]] = set()  # one for each child: it ends when this is closed


@contextmanager
def child(words: Sequence[str], **options: Any) -> Iterator[subprocess.Popen[str]]:
    """A command as a process that reads nothing; it and what it has started end with this block at the latest.

    Raises FileNotFoundError or PermissionError where there is no such command.
    """
    options |= {"stdin": subprocess.DEVNULL, "text": True, "errors": "replace"}
    if os.name == "nt":
        with subprocess.Popen(words, **options) as process:
            try:
                yield process
            finally:
                process.kill()
        return
    with subprocess.Popen(GUARD, stdin=subprocess.PIPE, stderr=subprocess.DEVNULL, process_group=0) as guard:
        assert guard.stdin
        _held.add(guard.stdin)
        try:
            with ExitStack() as stack:
                process = stack.enter_context(subprocess.Popen(words, process_group=guard.pid, **options))
                stack.callback(guard.stdin.close)  # first of all, so that what is waited for ends
                yield process
        finally:
            _held.discard(guard.stdin)


def run(words: Sequence[str], seconds: float, folder: str | None = None) -> subprocess.CompletedProcess[str]:
    """What a command says that runs in a folder, or in the current one, and its exit code. Raises TimeoutExpired after
    `seconds`, and as `child`."""
    with child(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=folder) as process:
        out, err = process.communicate(timeout=seconds)
    return subprocess.CompletedProcess(words, process.returncode, out, err)


@contextmanager
def side_by_side(workers: int | None = None) -> Iterator[ThreadPoolExecutor]:
    """Threads that wait for children. Where one fails no other is begun; on Ctrl-C those at work are ended, too."""
    with ThreadPoolExecutor(workers) as pool:
        try:
            yield pool
        except BaseException as error:
            pool.shutdown(wait=False, cancel_futures=True)
            if not isinstance(error, Exception):
                for held in list(_held):
                    held.close()
            raise
