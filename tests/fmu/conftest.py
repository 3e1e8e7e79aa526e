"""FMUs, each built once for all tests."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.fmu.build import build
from wheelchair_fmu.fmu.native import headers

from .chair import Unpacked


@pytest.fixture(scope="session")
def workshop(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("fmus")


def _built(workshop: Path, name: str, **options) -> Unpacked:
    return Unpacked.of(build(target=workshop / f"{name}.fmu", **options), workshop / name)


@pytest.fixture(scope="session")
def native(workshop) -> Unpacked:
    return _built(workshop, "native")


@pytest.fixture(scope="session")
def everything(workshop) -> Unpacked:
    return _built(workshop, "everything", effects="all")


@pytest.fixture(scope="session")
def native3(workshop) -> Unpacked:
    return _built(workshop, "native3", fmi="3")


@pytest.fixture(scope="session")
def everything3(workshop) -> Unpacked:
    return _built(workshop, "everything3", effects="all", fmi="3")


@pytest.fixture(scope="session")
def in_python(workshop) -> Unpacked:
    return _built(workshop, "in_python", flavour="python")


@pytest.fixture(scope="session")
def host(workshop):
    """Runs the C host on an FMU: `host(unpacked, mode, steps, length)` gives the numbers it prints."""
    program = workshop / "host"
    source = Path(__file__).with_name("host.c")
    done = subprocess.run(
        [
            *compiler.command(),
            "-O2",
            "-Wall",
            "-Wextra",
            "-Werror",
            f"-I{headers()}",
            str(source),
            "-o",
            str(program),
            "-ldl",
            "-lm",
        ],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr

    def run(unpacked: Unpacked, mode: str, steps: int, length: float) -> list[float]:
        names = ("push.F_rl", "push.F_rr", "chair.x", "chair.u", "chair.psi")
        words = [
            str(unpacked.library),
            unpacked.description.guid,
            mode,
            str(steps),
            str(length),
            *(str(unpacked.reference(n)) for n in names),
        ]
        done = subprocess.run([str(program), *words], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return [float(word) for word in done.stdout.split()]

    return run
