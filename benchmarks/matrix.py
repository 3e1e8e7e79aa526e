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

from wheelchair_fmu.children import child

ROOT = Path(__file__).parents[1]
PLACE = ROOT / ".venv-matrix"
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
RESOLUTIONS = ("lowest-direct", "highest")
EXTRAS = ("dev", "ssp")
# Each library that the package needs is used by some of these, with the least work besides; TESTS=tests is everything.
TESTS = (
    # Files of loggers, their units and damage: pandas, pyarrow, ezc3d, h5py, odfpy, openpyxl, Pint, tomlkit, Hypothesis.
    "tests/campaign/test_formats.py",
    "tests/campaign/test_loggers.py",
    "tests/campaign/test_units.py",
    "tests/campaign/test_reading.py",
    "tests/campaign/test_bad_files.py",
    "tests/campaign/test_layout.py",
    # Tyre files: SciPy, lxml.
    "tests/tyres/test_formats.py",
    "tests/tyres/test_parameters.py::test_the_parameter_set_is_valid_and_holds_the_variant",
    # FMUs built, by the system's compiler, Zig and pythonfmu, and simulated: CasADi, FMPy.
    "tests/fmu/test_simulation.py::test_fmpy_coasts_to_rest",
    "tests/fmu/test_simulation.py::test_python_gives_the_same_as_native",
    "tests/fmu/test_archive.py::test_builds_with_zig_instead_of_a_system_compiler",
    # Systems of FMUs, as others read and run them: lxml, pyssp_standard, libcosimpy.
    "tests/ssp/test_archives.py::test_an_archive_holds_fmus_sets_and_a_mapping_and_has_no_fault",
    "tests/ssp/test_archives.py::test_pyssp_standard_finds_it_valid",
    "tests/ssp/test_running.py::test_libcosim_gives_the_same[slalom-0.01-sets0]",
    # A sweep's chairs and indices: SALib, SciPy; its table: pyarrow.
    "tests/studies/sweep/test_design.py",
    "tests/studies/sweep/test_sweep.py::test_columns_say_their_units",
    # A few chairs diagnosed on a cluster, and their sizes together: SciPy, threadpoolctl, distributed, statsmodels.
    "tests/fleet/test_fleet.py::test_a_dask_cluster_gives_the_same_bytes",
    "tests/fleet/test_summary.py",
    "tests/handling/test_linearize.py::test_python_control_takes_it",
    # Frames of the Python interface, and what is written of them: pandas, pyarrow, Pint.
    "tests/api/test_results.py::test_what_was_simulated_is_a_recording_with_its_units",
    "tests/api/test_results.py::test_parquet_has_units_in_its_fields",
    "tests/api/test_results.py::test_variants_go_from_hand_to_hand",
    # Figures: matplotlib, Pillow. What was made is kept where platformdirs says.
    "tests/report/test_figures.py",
    "tests/engine/test_store.py",
    # The workbench's routes, and the server itself: Starlette, uvicorn, python-multipart, filelock, HTTPX.
    "tests/workbench/test_server.py",
    "tests/workbench/test_attacks.py::test_nobody_is_answered_without_the_token",
    "tests/workbench/test_attacks.py::test_an_effect_that_cannot_be_is_refused_at_once",
    "tests/workbench/test_attacks.py::test_a_bomb_is_not_unpacked",
    # The command line: Typer, Rich, tomli-w.
    "tests/cli/test_cli.py::test_set_reaches_the_fmu_and_more_cornering_stiffness_tightens_the_turn",
    "tests/cli/test_cli.py::test_bad_input_gets_one_sentence_and_writes_nothing",
    "tests/cli/test_handling_commands.py::test_linearize_refuses_in_one_sentence",
)
MISSING = "not on this machine"
LIMIT = 900.0  # s for the tests of one environment, after which they are ended
STUCK = 300  # s after which a test that still runs tells in pytest's words where it is
# A file's tests stay together, so that what they share is made once.
OPTIONS = ("-rfE", "--tb=short", "--dist=loadfile", "-p", "no:cacheprovider", "-o", f"faulthandler_timeout={STUCK}")
SUMMARY = ("FAILED ", "ERROR ")  # how the lines of pytest's summary begin, one for each
MOST, WIDTH = 40, 160  # lines shown of an environment, and characters of each

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


def tested(python: Path, place: Path, tests: list[str]) -> tuple[bool, str]:
    """Whether the tests pass, and pytest's last line. What fails is named, and all that pytest said is in `place`."""
    log = place / "tests.txt"
    words = [str(python), "-m", "pytest", "-n", str(min(2, os.cpu_count() or 1)), *OPTIONS, *tests]
    with log.open("wb") as said, child(words, cwd=ROOT, stdout=said, stderr=subprocess.STDOUT) as process:
        try:
            code = process.wait(LIMIT)
        except subprocess.TimeoutExpired:  # the end of `child` ends its process group
            code = None
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    last = next((line.strip(" =") for line in reversed(lines) if line.strip()), "pytest said nothing")
    if code == 0:
        return True, last
    named = [line for line in lines if line.startswith(SUMMARY)]
    # Without a summary there is what was said at the end, as of a crash or of where a test was: without the frames of pytest.
    ours = [line for line in lines if "site-packages" not in line and 'File "<' not in line]
    shown = [cut(line) for line in named[:MOST] or ours[-MOST:]]
    if len(named) > MOST:
        shown.append(f"and {len(named) - MOST} more")
    print(*shown, f"all that pytest said is in {log.relative_to(ROOT)}", sep="\n", flush=True)
    return False, f"ended after {LIMIT / 60:.0f} min" if code is None else last


def cut(line: str) -> str:
    return line if len(line) <= WIDTH else line[: WIDTH - 1] + "…"


def row(version: str, resolution: str, tests: list[str]) -> tuple[bool, str]:
    python = found(version)
    if not python:
        return True, f"skipped: {MISSING}"
    try:
        name = f"{version}-{resolution}"
        return tested(environment(python, name, resolution), PLACE / name, tests)
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
