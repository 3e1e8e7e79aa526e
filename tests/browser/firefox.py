"""Firefox, driven by WebDriver BiDi: its own program and a socket, https://w3c.github.io/webdriver-bidi."""

from __future__ import annotations

import json
import re
import subprocess
import time
from base64 import b64decode
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

PATIENCE = 60.0  # s; what takes long on a busy machine is no fault
LISTENS = re.compile(r"WebDriver BiDi listening on (ws://\S+)")


class Page:
    """A tab. `complaints` are the errors and warnings of its scripts."""

    def __init__(self, socket: ClientConnection, width: int, height: int):
        self._socket, self._asked, self.complaints = socket, 0, list[str]()
        self._context = self._ask("browsingContext.create", type="tab")["context"]
        self._ask("browsingContext.setViewport", context=self._context, viewport={"width": width, "height": height})
        self._ask("session.subscribe", events=["log.entryAdded"], contexts=[self._context])

    def _ask(self, method: str, **params: Any) -> dict[str, Any]:
        self._asked += 1
        self._socket.send(json.dumps({"id": self._asked, "method": method, "params": params}))
        while True:
            told = json.loads(self._socket.recv(PATIENCE))
            if told.get("method") == "log.entryAdded" and told["params"]["level"] in ("error", "warn"):
                self.complaints.append(told["params"]["text"])
            if told.get("id") == self._asked:
                if told["type"] == "error":
                    raise AssertionError(f"{method}: {told['message']}")
                return dict(told["result"])

    def goto(self, address: str) -> None:
        self._ask("browsingContext.navigate", context=self._context, url=address, wait="complete")

    def evaluate(self, expression: str) -> Any:
        """The value of a JavaScript expression, awaited, as JSON has it."""
        told = self._ask(
            "script.evaluate",
            expression=f"(async () => JSON.stringify(await ({expression})))()",
            target={"context": self._context},
            awaitPromise=True,
        )
        assert told["type"] == "success", told
        value = told["result"].get("value")
        return None if value is None else json.loads(value)

    def wait(self, expression: str, seconds: float = PATIENCE) -> None:
        until = time.monotonic() + seconds
        while not self.evaluate(f"Boolean({expression})"):
            assert time.monotonic() < until, f"never: {expression}"
            time.sleep(0.1)

    def printed(self) -> bytes:
        """The page as PDF, on the paper that its style sheet asks for."""
        return b64decode(self._ask("browsingContext.print", context=self._context, background=True)["data"])

    def close(self) -> None:
        self._ask("browsingContext.close", context=self._context)
        assert not self.complaints


@contextmanager
def firefox(program: str, profile: Path) -> Iterator[ClientConnection]:
    """A session of a browser that nobody sees, with a profile of its own."""
    words = [program, "--headless", "--no-remote", "--profile", str(profile), "--remote-debugging-port", "0", "about:blank"]
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr
        try:
            address = next(found[1] for line in process.stderr if (found := LISTENS.search(line)))
            with connect(f"{address}/session", max_size=None) as socket:
                socket.send(json.dumps({"id": 0, "method": "session.new", "params": {"capabilities": {}}}))
                assert json.loads(socket.recv(PATIENCE))["type"] == "success"
                yield socket
        finally:
            process.terminate()
