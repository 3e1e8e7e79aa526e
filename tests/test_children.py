"""What this process starts ends when it does, however it ends."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from wheelchair_fmu.children import child, run

from .kit import descendants, gone

ROOT = Path(__file__).parents[1]
pytestmark = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="asks /proc who is whose child")
PARENT = """
import subprocess, sys
from wheelchair_fmu.children import child
with child(["/bin/sh", "-c", "sleep 300 & sleep 300"], stdout=subprocess.PIPE) as process:
    print("begun", flush=True)
    process.wait()
"""


def test_what_it_says_and_how_it_ends():
    done = run(["/bin/sh", "-c", "echo said; echo beside >&2; exit 3"], 30)
    assert (done.returncode, done.stdout, done.stderr) == (3, "said\n", "beside\n")
    assert run(["/bin/sh", "-c", "kill -s TERM $$"], 30).returncode == -signal.SIGTERM
    assert run(["/bin/cat"], 30).stdout == ""  # there is nothing to read


def test_a_command_that_is_not_there():
    with pytest.raises(FileNotFoundError):
        run(["no-such-command"], 30)


def test_time_is_limited():
    begun = time.monotonic()
    with pytest.raises(subprocess.TimeoutExpired):
        run(["/bin/sh", "-c", "sleep 60 & sleep 60"], 0.2)
    assert time.monotonic() - begun < 10


def test_it_ends_with_the_block_and_so_does_what_it_has_started():
    with child(["/bin/sh", "-c", "sleep 300 & sleep 300"]) as process:
        time.sleep(0.2)
        family = descendants(process.pid)
        assert len(family) >= 2 and process.poll() is None
    assert gone(family)


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_it_ends_with_its_parent(how):
    script = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)" + PARENT
    with subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, cwd=ROOT
    ) as parent:
        assert parent.stdout and parent.stdout.readline() == "begun\n"
        time.sleep(0.2)
        family = descendants(parent.pid)
        assert len(family) >= 3
        os.kill(parent.pid, how)
        parent.wait(20)
    assert gone(family)
