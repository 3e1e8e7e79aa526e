"""Kernels that come with an installed package serve without a compiler, and only for what they were made of."""

from __future__ import annotations

import logging
import os
import sys
from pathlib import Path

import pytest

from wheelchair_fmu.engine import cache, compiler, objects, shipped, store
from wheelchair_fmu.errors import BuildError
from wheelchair_fmu.fmu.platforms import PLATFORMS
from wheelchair_fmu.model.wheelchair import Choice

PAPER = cache.Wanted.of(Choice(), ())


@pytest.fixture
def installed(monkeypatch, tmp_path):
    """The paper's chair came with the package, nothing has been compiled, and there is no compiler."""
    monkeypatch.setattr(shipped, "FOLDER", tmp_path / "kernels")
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "made elsewhere"))
    path = cache.ship(PAPER, compiler.SYSTEM, compiler.SUFFIX, None)
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(store, "_sound", set())

    def none(*_) -> str:
        raise BuildError("no C compiler found")

    monkeypatch.setattr(compiler, "version", none)
    return path


def test_a_kernel_that_came_along_needs_no_compiler(installed):
    assert cache.library(Choice(), ())._name == str(installed)


@pytest.mark.parametrize(
    ("choice", "columns"), [(Choice(caster="swivelling"), None), (Choice(), ["tyre.C_lambda"])], ids=["law", "derivatives"]
)
def test_another_model_is_compiled(installed, choice, columns):
    with pytest.raises(BuildError, match="no C compiler"):
        cache.library(choice, (), columns)


def test_other_equations_are_compiled(installed, monkeypatch):
    """As with a law of one's own, or in a later version."""
    monkeypatch.setattr(cache, "equations", lambda: "others")
    with pytest.raises(BuildError, match="no C compiler"):
        cache.library(Choice(), ())


def test_what_was_damaged_is_compiled(installed, caplog):
    installed.write_bytes(installed.read_bytes()[:-1] + b"\1")
    with pytest.raises(BuildError, match="no C compiler"):
        cache.library(Choice(), ())
    assert "was damaged" in caplog.text


def test_what_does_not_load_here_is_compiled_and_said(installed, monkeypatch, caplog):
    """As with another C library than the one that it was made for."""
    installed.unlink()
    shipped.put(cache._independent(PAPER.words), compiler.SYSTEM, compiler.SUFFIX, lambda path: path.write_text("no library"))
    with caplog.at_level(logging.INFO), pytest.raises(BuildError, match="no C compiler"):
        cache.library(Choice(), ())
    assert "does not load here" in caplog.text


def another_path(folder):
    """Ziglang as it is run by this interpreter, from an environment that is called by another path."""
    inside = Path(sys.executable)
    if os.name == "nt" or not inside.is_relative_to(sys.prefix):
        pytest.skip("this interpreter's environment cannot be called by another path")
    environment = folder / "environment"
    environment.symlink_to(sys.prefix)
    return (str(environment / inside.relative_to(sys.prefix)), *compiler.ZIG[1:])


@pytest.mark.parametrize(
    "system",
    [
        "aarch64-darwin",
        pytest.param("x86_64-darwin", marks=pytest.mark.nightly),
        pytest.param("x86_64-windows", marks=pytest.mark.nightly),  # ziglang makes that system's C library first
    ],
)
def test_a_library_for_another_system_is_the_same_wherever_it_is_made(tmp_path, monkeypatch, system):
    """Linkers write in a library's own path, or a name made up for each, unless they are told otherwise, and for macOS they
    put objects in the order of their names."""
    pytest.importorskip("ziglang")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    texts = [f'__attribute__((visibility("default"))) int f{n}(void) {{ return {n}; }}\n' for n in range(6)]
    made = []
    for name in ("here", "elsewhere"):
        place = tmp_path / name
        place.mkdir()
        monkeypatch.setenv("WHEELCHAIR_CACHE", str(place / "cache"))
        monkeypatch.setattr(compiler, "ZIG", another_path(place))
        cross = PLATFORMS[system].command()
        parts = [objects.compiled("equations", text, (), cross) for text in texts]
        target = place / f"kernel{PLATFORMS[system].suffix}"
        made.append(compiler.compile_shared(parts, target, PLATFORMS[system].link, cross).read_bytes())
    assert made[0] == made[1] and b"elsewhere" not in made[1]
