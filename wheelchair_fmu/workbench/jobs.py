"""Long work as child processes: the wheelchair command itself, its steps line by line, cancelled by ending it."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..children import child
from ..errors import UsageError, WheelchairError

COMMAND = (sys.executable, "-m", "wheelchair_fmu")
SEARCHED = os.pathsep.join(p for p in sys.path if p)  # the child finds what this process found, wherever it runs
KEPT = 200  # lines of a job that are kept


@dataclass
class Job:
    """What one session is busy with: commands, one after the other. `state` is running, done, failed or cancelled."""

    kind: str
    commands: Sequence[Sequence[str]]
    after: Callable[[list[str]], None]  # told of what each command printed, once all went well
    lines: list[str] = field(default_factory=list)
    state: str = "running"
    process: subprocess.Popen[str] | None = None
    lock: threading.Lock = field(default_factory=threading.Lock)
    began: float = field(default_factory=time.monotonic)
    ended: float | None = None
    usual: tuple[int, float] | None = None  # steps and seconds of the last one of its kind
    result: Any = None  # what the page shows of it

    @property
    def seconds(self) -> float:
        return (time.monotonic() if self.ended is None else self.ended) - self.began

    def told(self) -> dict[str, Any]:
        shown = ["wheelchair " + shlex.join(words) for words in self.commands]
        usual = None if self.usual is None else {"steps": self.usual[0], "seconds": self.usual[1]}
        told = {"kind": self.kind, "state": self.state, "lines": self.lines[-KEPT:], "commands": shown}
        return {**told, "steps": len(self.lines), "seconds": round(self.seconds, 1), "usual": usual, "result": self.result}

    def run(self, folder: Path) -> None:
        outputs = []
        try:
            for words in self.commands:
                out = self._one(words, folder)
                if out is None:
                    return
                outputs.append(out)
            self.after(outputs)
        except (OSError, ValueError, KeyError, WheelchairError) as error:
            self.lines.append(str(error) if isinstance(error, WheelchairError) else f"{type(error).__name__}: {error}")
            self.state = "failed"
        else:
            self.state = "done"
        finally:
            self.ended = time.monotonic()

    def _one(self, words: Sequence[str], folder: Path) -> str | None:
        """What the command printed; None where it failed or was cancelled."""
        with ExitStack() as stack:
            with self.lock:
                if self.state != "running":
                    return None
                process = stack.enter_context(
                    child(
                        [*COMMAND, *words],
                        cwd=folder,
                        stdout=subprocess.PIPE,
                        stderr=subprocess.PIPE,
                        env={**os.environ, "PYTHONPATH": SEARCHED},
                    )
                )
                self.process = process
            said = threading.Thread(target=self._listen, args=(process.stderr,), daemon=True)
            said.start()
            assert process.stdout
            out = process.stdout.read()
            code = process.wait()
            said.join()
        with self.lock:
            if self.state == "running" and code:
                self.state = "failed"
            return out if self.state == "running" else None

    def _listen(self, stream: Any) -> None:
        for line in stream:
            self.lines.append(line.rstrip())

    def cancel(self) -> None:
        """End the command that runs; what it had not finished leaves nothing behind."""
        with self.lock:
            if self.state != "running":
                return
            self.state = "cancelled"
            if self.process and self.process.poll() is None:
                self.process.terminate()


class Jobs:
    """One job at a time for each session."""

    def __init__(self) -> None:
        self._jobs: dict[str, Job] = {}
        self._took: dict[tuple[str, str], tuple[int, float]] = {}  # by session and kind of work
        self._starting = threading.Lock()

    def start(self, session: str, job: Job, folder: Path) -> None:
        """Raises UsageError where the session is busy."""
        with self._starting:
            self.refuse_busy(session)
            job.usual, self._jobs[session] = self._took.get((session, job.kind)), job
        threading.Thread(target=self._run, args=(session, job, folder), daemon=True).start()

    def refuse_busy(self, session: str) -> None:
        """Raises UsageError where something is being done."""
        now = self._jobs.get(session)
        if now and now.state == "running":
            raise UsageError(f"{now.kind} is still running; wait for it, or cancel it")

    def _run(self, session: str, job: Job, folder: Path) -> None:
        job.run(folder)
        if job.state == "done":
            self._took[session, job.kind] = (len(job.lines), job.seconds)

    def told(self, session: str) -> dict[str, Any] | None:
        job = self._jobs.get(session)
        return job.told() if job else None

    def cancel(self, session: str) -> None:
        if session in self._jobs:
            self._jobs[session].cancel()

    def cancel_all(self) -> None:
        for job in self._jobs.values():
            job.cancel()


def printed_json(text: str) -> Any:
    """The JSON that a command printed, after whatever other lines it printed first."""
    return json.loads(text[text.index("{") :])
