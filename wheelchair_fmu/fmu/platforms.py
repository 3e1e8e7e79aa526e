"""The systems an archive can carry a library for, and the compiler for each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib.util import find_spec

from ..engine import compiler
from ..errors import BuildError, unknown

# -Bsymbolic: our calls reach our functions, whatever the importer has loaded before.
ELF = ("-Wl,-Bsymbolic", "-Wl,--no-undefined", "-s")

# glibc has newer versions of these, which differ in errno alone. Linked with the oldest, a library loads on systems as old
# as those that ziglang builds for.
RENEWED = ("exp", "exp2", "fmod", "hypot", "log", "log2", "pow")
OLDEST_GLIBC = f"""
#include <stdlib.h>
#ifdef __GLIBC__
#ifdef __x86_64__
{"".join(f'__asm__(".symver {name},{name}@GLIBC_2.2.5");' for name in RENEWED)}
#elif defined(__aarch64__)
{"".join(f'__asm__(".symver {name},{name}@GLIBC_2.17");' for name in RENEWED)}
#endif
#endif
"""


@dataclass(frozen=True)
class Platform:
    """A system by FMI 3.0's name, FMI 2.0's folder for it, and what ziglang calls it ("": the system's own compiler)."""

    name: str
    folder: str
    target: str
    suffix: str
    link: tuple[str, ...]

    def command(self) -> tuple[str, ...] | None:
        """The cross compiler; None where the system's own compiler serves."""
        if not self.target:
            return None
        if not find_spec("ziglang"):
            raise BuildError(f"to build for {self.name} by name, a cross compiler is needed; `pip install ziglang`")
        return (*compiler.ZIG, "-target", self.target)


# FMI 2.0 has no folder names for ARM; importers that run there look for FMI 3.0's.
PLATFORMS = {
    p.name: p
    for p in (
        Platform("x86_64-linux", "linux64", "x86_64-linux-gnu.2.17", ".so", ELF),
        Platform("aarch64-linux", "aarch64-linux", "aarch64-linux-gnu.2.17", ".so", ELF),
        Platform("x86_64-windows", "win64", "x86_64-windows-gnu", ".dll", ("-s",)),
        Platform("x86_64-darwin", "darwin64", "x86_64-macos.11.0", ".dylib", ("-s",)),
        Platform("aarch64-darwin", "aarch64-darwin", "aarch64-macos.11.0", ".dylib", ("-s",)),
    )
}


HOST = compiler.SYSTEM


def chosen(words: str) -> list[Platform]:
    """Platforms by "host", "all" or names with commas.

    "host" is built by the system's compiler and needs its libc; the others, this system's own among them, need no newer
    libc than their target says. Raises UsageError for an unknown one.
    """
    found: dict[str, Platform] = {}
    for word in words.split(","):
        for name in PLATFORMS if word == "all" else [HOST if word == "host" else word]:
            if name not in PLATFORMS:
                raise unknown("platform", name, ("host", "all", *PLATFORMS))
            platform = PLATFORMS[name]
            found[name] = replace(platform, target="") if word == "host" else platform
    return list(found.values())


def for_oldest_libc(p: Platform, text: str) -> str:
    """C text that, compiled for a platform and linked, loads on systems as old as the platform's target says."""
    return OLDEST_GLIBC + text if p.link == ELF and not p.target else text
