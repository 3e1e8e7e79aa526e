"""FMUs, each built once for all tests."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.kit import shared
from wheelchair_fmu.engine import compiler
from wheelchair_fmu.fmu.build import VERSIONS, build, build_each
from wheelchair_fmu.fmu.native import headers

from .chair import FEW, Unpacked


@pytest.fixture(scope="session")
def workshop(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("fmus")


@pytest.fixture(scope="session")
def built(tmp_path_factory, workshop) -> Callable[..., Unpacked]:
    """`built(name, version, **options)`: an FMU, of which one compilation makes the archives of both versions."""

    def unpacked(name: str, version: str, **options) -> Unpacked:
        def make(folder: Path) -> None:
            build_each({v: folder / f"{v}.fmu" for v in VERSIONS}, **options)

        return Unpacked.of(shared(tmp_path_factory, f"fmu-{name}", make) / f"{version}.fmu", workshop / f"{name}{version}")

    return unpacked


@pytest.fixture(scope="session")
def native(built) -> Unpacked:
    return built("native", "2")


@pytest.fixture(scope="session")
def native3(built) -> Unpacked:
    return built("native", "3")


@pytest.fixture(scope="session")
def everything(built) -> Unpacked:
    return built("everything", "2", effects="all")


@pytest.fixture(scope="session")
def everything3(built) -> Unpacked:
    return built("everything", "3", effects="all")


@pytest.fixture(scope="session")
def few(built) -> Unpacked:
    """With two effects: for who compiles the sources again, which takes half as long as those of `native`."""
    return built("few", "2", effects=FEW)


@pytest.fixture(scope="session")
def few3(built) -> Unpacked:
    return built("few", "3", effects=FEW)


@pytest.fixture(scope="session")
def in_python(workshop) -> Unpacked:
    return Unpacked.of(build(target=workshop / "in_python.fmu", flavour="python"), workshop / "in_python")


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
