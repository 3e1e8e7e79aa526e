"""Find a C compiler and make a shared library with it: the system's, else PyPI's ziglang."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from ..errors import BuildError

# Contracting a·b + c to one rounding would give other digits on other machines. Nobody asks errno after a square root.
FLAGS = ("-std=c11", "-O2", "-g0", "-ffp-contract=off", "-fno-math-errno", "-fPIC", "-fvisibility=hidden",
         "-fno-sanitize=all")  # fmt: skip
SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")


@cache
def command() -> tuple[str, ...]:
    """The compiler as a command: $CC, cc, gcc, clang, or ziglang.

    Raises BuildError where there is none.
    """
    if os.environ.get("CC"):
        return tuple(shlex.split(os.environ["CC"]))
    for name in ("cc", "gcc", "clang"):
        if path := shutil.which(name):
            return (path,)
    if find_spec("ziglang"):
        return (sys.executable, "-m", "ziglang", "cc")
    raise BuildError("no C compiler found; install gcc or clang, or `pip install ziglang`")


@cache
def version() -> str:
    """What $CC asks for, and what the compiler says of itself, for the cache's key."""
    return f"{os.environ.get('CC', '')} {_run([*command(), '--version']).splitlines()[0]}"


def compile_shared(
    sources: Sequence[Path], target: Path, extra: Sequence[str] = (), cross: tuple[str, ...] | None = None
) -> Path:
    """Compile `sources`, C files or objects, into the shared library `target`, which appears whole or not at all.

    `cross` is the compiler for another system than this.

    Raises BuildError with the compiler's own words.
    """
    return _compiled([*(cross or command()), *FLAGS, "-shared"], sources, target, [*extra, "-lm"])


def compile_object(source: Path, target: Path, extra: Sequence[str] = ()) -> Path:
    """Compile one C file into an object that `compile_shared` takes. Raises BuildError with the compiler's own words."""
    return _compiled([*command(), *FLAGS, "-c"], [source], target, extra)


def compile_wasm(sources: Sequence[Path], target: Path, flags: Sequence[str]) -> Path:
    """Compile `sources` into a WebAssembly module by ziglang, the only compiler that brings its own C library for it."""
    return _compiled([sys.executable, "-m", "ziglang", "cc"], sources, target, flags)


def _compiled(compiler: list[str], sources: Sequence[Path], target: Path, flags: Sequence[str]) -> Path:
    with TemporaryDirectory(dir=target.parent) as folder:
        beside = Path(folder) / target.name  # some linkers write the file's name into it
        _run([*compiler, *map(str, sources), *flags, "-o", str(beside)])
        beside.replace(target)
    return target


def _run(words: list[str]) -> str:
    try:
        done = subprocess.run(words, capture_output=True, text=True, check=False)
    except OSError as error:
        raise BuildError(f"cannot run the C compiler {words[0]!r}: {error.strerror}; set CC to one that runs") from error
    if done.returncode:
        said = "\n".join(filter(None, (shlex.join(words), done.stderr.strip())))
        raise BuildError(f"the C compiler failed; set CC to another, or unset it and `pip install ziglang`: {said}")
    return done.stdout
