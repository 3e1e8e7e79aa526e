"""Find a C compiler and make a shared library with it: the system's, else PyPI's ziglang."""

from __future__ import annotations

import errno
import os
import platform
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Sequence
from functools import cache
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from ..children import run
from ..errors import BuildError

# Contracting a·b + c to one rounding would give other digits on other machines. Nobody asks errno after a square root.
FLAGS = ("-std=c11", "-O2", "-g0", "-ffp-contract=off", "-fno-math-errno", "-fPIC", "-fvisibility=hidden", "-fno-sanitize=all")
ZIG = (sys.executable, "-m", "ziglang", "cc")
LONGEST = 900.0  # seconds: ziglang compiles its C library at first, which takes slow machines minutes
CURE = "set CC to one, or unset it"
MACHINE = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
SYSTEM = f"{MACHINE}-{ {'win32': 'windows'}.get(sys.platform, sys.platform) }"  # as FMI 3.0 calls it
SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")


@cache
def command() -> tuple[str, ...]:
    """The compiler as a command: $CC, cc, gcc, clang, or ziglang.

    Raises BuildError where there is none.
    """
    try:
        if words := shlex.split(os.environ.get("CC", "")):
            return tuple(words)
    except ValueError as error:
        raise BuildError(
            f"CC = {os.environ['CC']!r} is no command: {str(error).lower()}; set it as a shell would read it, or unset it"
        ) from None
    for name in ("cc", "gcc", "clang"):
        if path := shutil.which(name):
            return (path,)
    if find_spec("ziglang"):
        return ZIG
    raise BuildError("no C compiler found; install gcc or clang, or `pip install ziglang`")


@cache
def version(cross: tuple[str, ...] | None = None) -> str:
    """What is asked for, by $CC or as the compiler for another system, and what the compiler says of itself, for keys of what
    is kept."""
    asked = cross or command()
    if asked[: len(ZIG)] == ZIG and find_spec("ziglang"):
        # Objects are named by keys, and linked for macOS in the order of their names: another path would be another library.
        return shlex.join(("ziglang", metadata.version("ziglang"), *asked[len(ZIG) :]))
    said = _asked(asked)
    if not said:
        raise BuildError(f"{shlex.join(asked)} --version says nothing, so it is no C compiler; {CURE}")
    return f"{shlex.join(cross) if cross else os.environ.get('CC', '')} {said.splitlines()[0]}"


def _asked(words: Sequence[str]) -> str:
    """What a compiler says of its version."""
    if not any("zig" in Path(word).name for word in words):
        return _run([*words, "--version"], 60.0).strip()
    with TemporaryDirectory() as folder:  # for macOS, zig leaves an empty object in the folder where it is asked
        program = str(Path(words[0]).absolute()) if Path(words[0]).name != words[0] else words[0]
        return _run([program, *words[1:], "--version"], 60.0, folder).strip()


def compile_shared(
    sources: Sequence[Path], target: Path, extra: Sequence[str] = (), cross: tuple[str, ...] | None = None
) -> Path:
    """Compile `sources`, C files or objects, into the shared library `target`.

    `cross` is the compiler for another system than this.

    Raises BuildError with the compiler's own words.
    """
    # Or linkers write in where a library was made, on macOS, and for Windows a name made up for each.
    named = [f"-Wl,-install_name,@rpath/{target.name}"] if target.suffix == ".dylib" else []
    stripped = ["-s"] if cross else []
    return _compiled([*(cross or command()), *FLAGS, "-shared"], sources, target, [*extra, *named, *stripped, "-lm"])


def compile_object(source: Path, target: Path, extra: Sequence[str] = (), cross: tuple[str, ...] | None = None) -> Path:
    """Compile one C file into an object that `compile_shared` takes. Raises BuildError with the compiler's own words."""
    return _compiled([*(cross or command()), *FLAGS, "-c"], [source], target, extra)


def compile_wasm(sources: Sequence[Path], target: Path, flags: Sequence[str]) -> Path:
    """Compile `sources` into a WebAssembly module by ziglang, the only compiler that brings its own C library for it."""
    return _compiled([*ZIG], sources, target, flags)


def _compiled(compiler: list[str], sources: Sequence[Path], target: Path, flags: Sequence[str]) -> Path:
    _run([*compiler, *map(str, sources), *flags, "-o", str(target)])
    if not target.exists():
        raise BuildError(f"the C compiler {compiler[0]!r} has written nothing, so it is no C compiler; {CURE}")
    return target


def _run(words: list[str], seconds: float | None = None, folder: str | None = None) -> str:
    """What a compiler prints, run in a folder or in the current one. Raises BuildError, in one sentence and the compiler's own
    words."""
    seconds = seconds or LONGEST
    try:
        done = run(words, seconds, folder)
    except OSError as error:
        raise BuildError(f"cannot run the C compiler {words[0]!r}: {error.strerror}; set CC to one that runs") from error
    except subprocess.TimeoutExpired:
        raise BuildError(f"the C compiler {words[0]!r} was ended after {seconds:g} s without a result; {CURE}") from None
    if done.returncode < 0:
        raise BuildError(
            f"the C compiler {words[0]!r} was ended by {_signal(-done.returncode)}, perhaps for want of memory; "
            "run the same again, with less beside it"
        )
    said = "\n".join(filter(None, (shlex.join(words), done.stderr.strip())))
    if done.returncode and os.strerror(errno.ENOSPC) in said:
        raise BuildError(
            f"no room for what the C compiler writes; make room, or set TMPDIR and WHEELCHAIR_CACHE to folders on "
            f"another disk: {said}"
        )
    if done.returncode:
        raise BuildError(f"the C compiler failed; set CC to another, or unset it and `pip install ziglang`: {said}")
    return done.stdout


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
