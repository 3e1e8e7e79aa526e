"""How a command ends when something goes wrong that no check foresaw."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from wheelchair_fmu.cli import check
from wheelchair_fmu.cli.group import TRACEBACK
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.cli.terminal import printable
from wheelchair_fmu.errors import Failure
from wheelchair_fmu.writing import written

SAMPLE = str(Path(__file__).parents[2] / "examples" / "sample-campaign")


def ended(monkeypatch, error: BaseException):
    def fails(*_: object) -> None:
        raise error

    monkeypatch.delenv(TRACEBACK, raising=False)
    monkeypatch.setattr(check, "judged", fails)
    done = CliRunner().invoke(app, ["check", SAMPLE])
    assert isinstance(done.exception, SystemExit) and "Traceback" not in done.output
    assert len(done.output.splitlines()) <= 1
    return done


@pytest.mark.parametrize(
    ("error", "code", "sentence"),
    [
        (Failure("the fact; the cure"), 1, "the fact; the cure"),
        (KeyboardInterrupt(), 130, "interrupted"),
        (MemoryError(), 1, "not enough memory"),
        (RecursionError("maximum recursion depth exceeded"), 1, "nested too deeply"),
        (SystemExit(0), 1, "code that was run ended the command (exit code 0)"),
        (OSError(errno.ENOSPC, "No space left on device", "out.csv"), 1, "out.csv: no space left on device; make room"),
        (PermissionError(errno.EACCES, "Permission denied", "out.csv"), 1, "out.csv: permission denied; give another place"),
        (
            ValueError("need at\n least one"),
            1,
            "an error that nobody expected (ValueError: need at least one); please report it",
        ),
    ],
)
def test_one_sentence_and_a_code(monkeypatch, error, code, sentence):
    done = ended(monkeypatch, error)
    assert done.exit_code == code and sentence in done.output


def test_who_wants_the_traceback_gets_it(monkeypatch):
    assert f"{TRACEBACK}=1" in ended(monkeypatch, ValueError("why")).output
    monkeypatch.setenv(TRACEBACK, "1")
    assert isinstance(CliRunner().invoke(app, ["check", SAMPLE]).exception, ValueError)


def test_a_full_disk_names_the_file(tmp_path):
    with pytest.raises(OSError) as caught, written(tmp_path / "out.csv"):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    assert caught.value.filename == str(tmp_path / "out.csv")


@pytest.mark.skipif(sys.platform == "win32", reason="needs pipes of a shell")
def test_a_reader_that_has_seen_enough_ends_it_without_a_word():
    command = [sys.executable, "-m", "wheelchair_fmu", "effects", "list", "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout and process.stderr
        process.stdout.close()
        said = process.stderr.read()
    assert not said and process.returncode == 1


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
def test_an_interrupt_while_the_command_loads_ends_with_one_line_and_130():
    code = (
        "import signal, sys, builtins\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "real = builtins.__import__\n"
        "def stop(name, *a, **k):\n"
        "    if name == 'typer': signal.raise_signal(signal.SIGINT)\n"
        "    return real(name, *a, **k)\n"
        "builtins.__import__ = stop\n"
        "sys.argv = ['wheelchair', 'check', '.']\n"
        "from wheelchair_fmu.cli.start import main\n"
        "main()\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 128 + signal.SIGINT
    assert done.stderr.splitlines() == ["interrupted; files already there are as they were"]


def test_python_runs_the_package_as_the_command(tmp_path):
    said = [
        subprocess.run([sys.executable, "-m", "wheelchair_fmu", *words], capture_output=True, text=True, cwd=tmp_path)
        for words in (["--version"], ["check", "nowhere"], ["check", "--help"])
    ]
    assert said[0].stdout.startswith("wheelchair-fmu ") and [done.returncode for done in said] == [0, 1, 0]
    assert said[1].stdout.splitlines()[0].startswith("nowhere: no such folder or file")
    assert said[2].stdout.startswith("Usage: wheelchair check")


def test_what_could_command_a_terminal_is_written_out():
    assert printable("a\x1b[31mb\x07\x9b\u202e\udcff\n\tµ ± …") == "a\\x1b[31mb\\x07\\x9b\\u202e\\udcff\n\tµ ± …"
