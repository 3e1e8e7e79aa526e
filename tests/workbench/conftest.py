"""The real server as a child process, and somebody who has opened the address that it printed."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest

ROOT = Path(__file__).parents[2]


@dataclass
class Server:
    """A running `wheelchair workbench`: the address that it printed, where it keeps its work, and what it said."""

    printed: str
    folder: Path
    said: Path

    @property
    def address(self) -> str:
        parts = urlsplit(self.printed)
        return f"{parts.scheme}://{parts.netloc}"

    @property
    def token(self) -> str:
        return parse_qs(urlsplit(self.printed).query)["token"][0]

    def visitor(self, **more):
        """Somebody with a browser who has opened the printed address: a cookie, and headers as the page sends them."""
        import httpx

        client = httpx.Client(base_url=self.address, headers={"x-workbench": "1"}, timeout=120, **more)
        assert client.get(self.printed, follow_redirects=True).status_code == 200
        return client


def started(folder: Path, *options: str) -> Iterator[Server]:
    for name in ("httpx", "uvicorn", "starlette", "multipart", "filelock"):
        pytest.importorskip(name, reason="the workbench's libraries are not installed")
    words = [
        sys.executable,
        "-m",
        "wheelchair_fmu",
        "workbench",
        "--port",
        "0",
        "--no-open",
        "--folder",
        str(folder / "work"),
        *options,
    ]
    said = folder / "said.txt"
    with (
        said.open("wb") as errors,
        subprocess.Popen(
            words, stdout=subprocess.PIPE, stderr=errors, text=True, cwd=folder, env={**os.environ, "PYTHONPATH": str(ROOT)}
        ) as process,
    ):
        assert process.stdout
        try:
            yield Server(process.stdout.readline().split()[0], folder / "work", said)
        finally:
            process.terminate()


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    yield from started(tmp_path_factory.mktemp("bench"), "--upload-limit", "3")
