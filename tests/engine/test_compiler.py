"""How compiled kernels are told apart."""

from __future__ import annotations

import os
import re
import shlex
import sys
from pathlib import Path

import pytest

from wheelchair_fmu.engine import cache, compiler, objects
from wheelchair_fmu.errors import BuildError
from wheelchair_fmu.model.wheelchair import Choice

# The same program, which the package does not know for its own.
ZIG_BY_ITS_FILE = (sys.executable, "-c", "import runpy; runpy.run_module('ziglang', run_name='__main__')", "cc")
posix = pytest.mark.skipif(os.name == "nt", reason="a shell's script")


def test_flags_of_a_compiler_make_it_another(monkeypatch):
    plain = compiler.version.__wrapped__()
    compiler.command.cache_clear()
    monkeypatch.setenv("CC", " ".join((*compiler.command(), "-O1")))
    compiler.command.cache_clear()
    try:
        assert compiler.version.__wrapped__() != plain
    finally:
        compiler.command.cache_clear()


def test_zig_is_the_same_compiler_whatever_the_path_of_the_interpreter_that_runs_it(monkeypatch):
    """Or two folders give two libraries: for macOS objects are linked in the order of their names, which are keys."""
    pytest.importorskip("ziglang")
    here = compiler.version.__wrapped__((*compiler.ZIG, "-target", "x86_64-macos.11.0"))
    monkeypatch.setattr(compiler, "ZIG", ("/elsewhere/python", *compiler.ZIG[1:]))
    assert compiler.version.__wrapped__((*compiler.ZIG, "-target", "x86_64-macos.11.0")) == here
    assert re.fullmatch(r"ziglang [\d.]+\S* -target x86_64-macos\.11\.0", here)


@pytest.mark.parametrize("by_environment", [False, True])
def test_asking_zig_for_its_version_leaves_nothing_behind(cc, tmp_path, monkeypatch, by_environment):
    pytest.importorskip("ziglang")
    monkeypatch.chdir(tmp_path)
    asked = (*compiler.ZIG, "-target", "x86_64-macos.11.0")
    if by_environment:
        cc(shlex.join((*ZIG_BY_ITS_FILE, *asked[len(compiler.ZIG) :])))
    assert compiler.version.__wrapped__(None if by_environment else asked)
    assert not list(tmp_path.iterdir())


@pytest.fixture
def cc(monkeypatch):
    """Sets $CC."""
    yield lambda text: (monkeypatch.setenv("CC", text), compiler.command.cache_clear())
    compiler.command.cache_clear()


def script(folder: Path, text: str) -> str:
    """A program that is a compiler by name."""
    file = folder / "compiler"
    file.write_text(f"#!/bin/sh\n{text}\n")
    file.chmod(0o755)
    return str(file)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ("false", "the C compiler failed; set CC to another"),
        ("no-such-compiler", "set CC to one that runs"),
        ('gcc "-O2', "CC = .* is no command: no closing quotation; set it as a shell would read it"),
        ("sh -c :", "sh -c : --version says nothing, so it is no C compiler; set CC to one, or unset it"),
    ],
)
def test_a_compiler_that_does_not_work_is_an_error_with_a_cure(cc, words, says):
    cc(words)
    with pytest.raises(BuildError, match=says):
        compiler.version.__wrapped__()


def test_a_variable_that_is_blank_asks_for_nothing(cc):
    cc(" ")
    assert compiler.command() and compiler.version.__wrapped__()


@posix
@pytest.mark.parametrize(
    ("does", "says"),
    [
        ("true", "has written nothing, so it is no C compiler"),
        ("sleep 60", "was ended after 0.3 s without a result; set CC to one"),
        ("kill -s KILL $$", "was ended by SIGKILL, perhaps for want of memory"),
        ("echo 'x.s: No space left on device' >&2; exit 1", "no room for what the C compiler writes; make room"),
        ("printf '\\377\\376' >&2; exit 1", "the C compiler failed"),
    ],
)
def test_a_compiler_that_makes_nothing_is_said_in_a_sentence(cc, does, says, tmp_path, monkeypatch):
    cc(script(tmp_path, does))
    monkeypatch.setattr(compiler, "LONGEST", 0.3)
    (tmp_path / "x.c").write_text("int x;\n")
    with pytest.raises(BuildError, match=says):
        compiler.compile_shared([tmp_path / "x.c"], tmp_path / "x.so")
    assert not (tmp_path / "x.so").exists()


@posix
def test_a_compiler_for_another_machine_is_said(cc, tmp_path, monkeypatch):
    cc(script(tmp_path, 'echo 1.0; for last; do :; done; [ "$last" = --version ] || echo text > "$last"'))
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))
    compiler.version.cache_clear()
    try:
        with pytest.raises(BuildError, match=r"cannot be loaded here .* set CC to a compiler for this machine"):
            cache.helper("innovations")
    finally:
        compiler.version.cache_clear()


def test_generated_code_is_compiled_once_whatever_it_is_derived_for(monkeypatch, tmp_path):
    """The steps of a model are the same for who simulates and for who differentiates, and after a change of what made them."""
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))
    compiled: list[str] = []
    by_compiler = compiler.compile_object

    def compile_object(source: Path, *rest) -> Path:
        compiled.append(source.name)
        return by_compiler(source, *rest)

    monkeypatch.setattr(compiler, "compile_object", compile_object)
    cache.library(Choice(), ())
    assert sorted(compiled) == ["advance.c", "model.c", "processor.c"]
    cache.library(Choice(), (), ["tyre.C_lambda"])
    by_hand = ["evaluation.c", "innovations.c", "rodas.c", "tangent.c"]
    assert sorted(compiled[3:]) == [*by_hand, "tangent_lanes.c", "tangent_model.c"]
    cache.library(Choice(caster="swivelling"), ())
    assert compiled[9:] == ["model.c"]
    monkeypatch.setattr(cache, "sources", lambda: "changed, but not what is generated")
    cache.library(Choice(), (), ["tyre.C_lambda"])
    assert sorted(compiled[10:]) == sorted([*by_hand, "processor.c"])


def test_generated_code_depends_on_what_it_includes(monkeypatch, tmp_path):
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))
    text = "int one;\n"
    one, other = objects.compiled("equations", text, ("-O2",)), objects.compiled("equations", text, ("-O0",))
    assert objects.compiled("equations", text, ("-O2",)) == one != other
    monkeypatch.setattr(objects, "headers", lambda: "another header")
    assert objects.compiled("equations", text, ("-O2",)) not in (one, other)
