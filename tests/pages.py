"""Pages of docs/ as a reader follows them: files of a configuration with their tests, and commands with what they print."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app

ROOT = Path(__file__).parents[1]
BLOCK = re.compile(r"`([\w/]+\.py)`:\n\n```python\n(.*?)```", re.DOTALL)
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
STEP = re.compile(r"^  (\+?\w[\w ]*\w) +([\d.]+) +([\d.]+)$", re.MULTILINE)
PARTS = ("laws", "channels", "formats", "manoeuvres")  # of a configuration


def page(name: str) -> str:
    return (ROOT / "docs" / name).read_text(encoding="utf-8")


def with_example(name: str, folder: Path) -> Path:
    """Puts the page's file into the configuration `folder`/config, and its test into `folder`; returns the test."""
    tests = []
    for path, text in BLOCK.findall(page(name)):
        own = path.split("/")[0] in PARTS
        file = folder / "config" / path if own else folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        tests += [] if own else [file]
    (test,) = tests
    return test


def attempt(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Python in the folder, with its configuration."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "WHEELCHAIR_CONFIG": str(folder / "config")}
    return subprocess.run([sys.executable, *words], cwd=folder, env=environment, capture_output=True, text=True)


def run(folder: Path, *words: str) -> str:
    """What Python prints there; raises AssertionError with it where it fails."""
    done = attempt(folder, *words)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def its_test_passes(name: str, folder: Path) -> None:
    """The page's own test, with the page's file in the configuration."""
    test = with_example(name, folder)
    told = run(folder, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(test))
    assert " passed" in told, told


def shown_commands(name: str) -> list[tuple[str, str]]:
    """Each command that a page shows behind "$ ", on one line, with what stands below it up to the next one."""
    blocks = re.findall(r"^```(?:console)?\n(\$ .*?)^```", page(name).replace("\\\n", " "), re.DOTALL | re.MULTILINE)
    entries = (entry for block in blocks for entry in block[2:].split("\n$ "))
    return [(command.split("   #")[0].strip(), shown) for command, _, shown in (e.partition("\n") for e in entries)]


def shown_steps(name: str) -> list[tuple[str, str, str]]:
    """Each step of the staircase that a page shows, with its errors on fitted and on held-out runs."""
    return STEP.findall(page(name))


def told_by(command: str, folder: Path, code: int | None = None) -> str:
    """What a command of a page prints, in the folder; figures are not waited for. `code` is what `wheelchair` has to end with,
    if that matters."""
    words = [word for word in shlex.split(command) if word != "--show-plot"]
    if words[0] == "wheelchair":
        done = CliRunner().invoke(app, words[1:], catch_exceptions=False)
        assert code in (None, done.exit_code), (command, done.output)
        return done.output
    if words[0] == "python":
        words = [sys.executable, str(ROOT / words[1]), *words[2:]]
    programs = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    ended = subprocess.run(words, cwd=folder, capture_output=True, text=True, env={**os.environ, "PATH": programs})
    assert ended.returncode == 0, (command, ended.stdout, ended.stderr)
    return ended.stdout


def agrees(shown: str, told: str) -> list[str]:
    """The lines that a page shows and a command did not print, in this order; numbers may differ by rounding."""
    rest, lost = told.splitlines(), []
    for line in filter(None, (text.strip() for text in shown.splitlines())):
        if line == "...":
            continue
        at = next((i for i, other in enumerate(rest) if _alike(line, other)), None)
        if at is None:
            lost.append(line)
        else:
            rest = rest[at + 1 :]
    return lost


def _alike(shown: str, told: str) -> bool:
    """Word by word; a line that ends in "..." is a beginning. Bars that only show a number's size are no words."""
    here, there = shown.split(), [w for w in told.split() if not set(w) <= set("█▏▎▍▌▋▊▉")]
    if here and here[-1] == "...":
        here, there = here[:-1], there[: len(here) - 1]
    return len(here) == len(there) and all(map(_same, here, there))


def _same(shown: str, told: str) -> bool:
    if shown == told or set(shown) == set(told) == {"─"}:
        return True
    numbers = [NUMBER.findall(word) for word in (shown, told)]
    if NUMBER.sub("0", shown) != NUMBER.sub("0", told) or not numbers[0]:
        return False
    return all(abs(float(a) - float(b)) <= 1.5 * _last_place(a) + 0.005 * abs(float(a)) for a, b in zip(*numbers, strict=True))


def _last_place(number: str) -> float:
    digits, _, power = number.partition("e")
    return 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))
