"""`make matrix`: the tests with each Python, and with the lowest and the highest versions of what the package needs.

uv makes an environment for each under .venv-matrix. A Python that this machine lacks is a row of the table too.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path

from rich.console import Console
from rich.table import Table

ROOT = Path(__file__).parents[1]
PLACE = ROOT / ".venv-matrix"
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
RESOLUTIONS = ("lowest-direct", "highest")
EXTRAS = ("dev", "ssp")
# What touches libraries of others, some way through all of the package; TESTS=tests is everything.
TESTS = (
    "tests/test_writing.py",
    "tests/campaign",
    "tests/engine",
    "tests/cli/test_cli.py",
    "tests/cli/test_tyre.py",
    "tests/cli/test_sweep.py",
    "tests/fmu/test_archive.py",
    "tests/tyres",
    "tests/workbench",
    "tests/ssp/test_archives.py",
    "tests/studies/sweep",
)
MISSING = "not on this machine"


WHEELS = ("--only-binary", ":all:", "--no-binary", "odfpy")  # which is of Python alone, and has never had any


def uv(*words: str) -> str:
    """What uv says. Raises CalledProcessError, after uv's own words on stderr."""
    command = [sys.executable, "-m", "uv", "--no-progress", *words]
    return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout.strip()


def found(version: str) -> str | None:
    """The path of this Python, if the machine has it: where uv finds it, or among pyenv's, which need not be on PATH."""
    words = [sys.executable, "-m", "uv", "python", "find", "--no-python-downloads", "--no-project", "--system", version]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
    if done.returncode == 0:
        return done.stdout.strip()
    pyenv = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv") / "versions"
    return next((str(path) for path in sorted(pyenv.glob(f"{version}.*/bin/python"))), None)


def environment(python: str, name: str, resolution: str) -> Path:
    """The Python of an environment with the package and what the resolution gives, as wheels where there are any."""
    place = PLACE / name
    if not place.exists():
        uv("venv", "--quiet", "--python", python, str(place))
    inside = next(p for p in (place / "bin" / "python", place / "Scripts" / "python.exe") if p.exists())
    wanted = place / "requirements.txt"
    extras = [word for extra in EXTRAS for word in ("--extra", extra)]
    uv(
        "pip",
        "compile",
        "--quiet",
        "pyproject.toml",
        *extras,
        *WHEELS,
        "--resolution",
        resolution,
        "--upgrade",
        "--python",
        str(inside),
        "-o",
        str(wanted),
    )
    uv("pip", "sync", "--quiet", "--python", str(inside), str(wanted))
    uv("pip", "install", "--quiet", "--python", str(inside), "--no-deps", "-e", ".")
    return inside


def tested(python: Path, tests: list[str]) -> tuple[bool, str]:
    """Whether the tests pass, and pytest's last line. What fails is shown."""
    words = [str(python), "-m", "pytest", "-n", str(min(2, os.cpu_count() or 1)), "-p", "no:cacheprovider", *tests]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
    if done.returncode:
        print(done.stdout[-20_000:], done.stderr[-4_000:], sep="\n")
    return done.returncode == 0, (done.stdout.strip().splitlines() or ["pytest said nothing"])[-1].strip(" =")


def row(version: str, resolution: str, tests: list[str]) -> tuple[bool, str]:
    python = found(version)
    if not python:
        return True, f"skipped: {MISSING}"
    try:
        return tested(environment(python, f"{version}-{resolution}", resolution), tests)
    except subprocess.CalledProcessError as error:
        return False, f"uv cannot make it (exit code {error.returncode}, see above)"


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.matrix", description=__doc__)
    parser.add_argument("--pythons", nargs="+", default=list(PYTHONS))
    parser.add_argument("--resolutions", nargs="+", choices=RESOLUTIONS, default=list(RESOLUTIONS))
    parser.add_argument("--tests", nargs="+", default=list(TESTS))
    chosen = parser.parse_args()
    table = Table("Python", "versions", "good", "tests", "seconds", box=None)
    good = True
    for version in chosen.pythons:
        for resolution in chosen.resolutions:
            begun = time.monotonic()
            passed, said = row(version, resolution, chosen.tests)
            good &= passed
            told = "-" if MISSING in said else "yes" if passed else "NO"
            cells = (version, resolution, told, said, f"{time.monotonic() - begun:.0f}")
            print(*cells, sep="  ", file=sys.stderr, flush=True)
            table.add_row(*cells)
    Console(width=None if sys.stdout.isatty() else 160).print(table)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
