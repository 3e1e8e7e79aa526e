"""One archive for five systems: what is in its libraries, and that those which can run here give one trajectory."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.errors import UsageError
from wheelchair_fmu.fmu.build import build_each
from wheelchair_fmu.fmu.native import headers
from wheelchair_fmu.fmu.platforms import HOST, PLATFORMS, chosen

from .chair import Unpacked

HERE = Path(__file__).parent
INPUTS = ("push.F_rl", "push.F_rr")
OUTPUTS = ("chair.x", "chair.y", "chair.psi", "chair.u", "chair.v", "chair.psi_dot", "slip.rl", "load.fr", "sensor.a_y")
WINE = shutil.which("wine64") or next((p for p in ("/usr/lib/wine/wine64",) if Path(p).exists()), None)
needs_zig = pytest.mark.skipif(not find_spec("ziglang"), reason="ziglang is not installed: `pip install ziglang`")
MARKERS = {"_mh_dylib_header", "__dso_handle"}  # zig's linker exports these two addresses of every macOS library
RUNNERS = {
    "x86_64-linux": ([] if HOST == "x86_64-linux" else None, "this is no x86-64 Linux"),
    "aarch64-linux": (
        ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"] if shutil.which("qemu-aarch64") else None,
        "no qemu-user: `apt-get install qemu-user libc6-arm64-cross`",
    ),
    "x86_64-windows": ([WINE] if WINE else None, "no wine: `apt-get install wine64`"),
}


@pytest.fixture(scope="module")
def everywhere(workshop) -> dict[str, Unpacked]:
    paths = {v: workshop / f"everywhere{v}.fmu" for v in ("2", "3")}
    build_each(paths, effects="default", platforms="all")
    return {v: Unpacked.of(p, p.with_suffix("")) for v, p in paths.items()}


def test_platforms_by_name():
    assert [p.name for p in chosen("all")] == list(PLATFORMS)
    assert [(p.name, p.target) for p in chosen("host")] == [(HOST, "")]
    with pytest.raises(UsageError, match="no platform 'x86_64-windos'; did you mean 'x86_64-windows'"):
        chosen("x86_64-linux,x86_64-windos")


@pytest.mark.skipif(not HOST.endswith("-linux") or not shutil.which("readelf"), reason="asks readelf about a Linux library")
def test_a_library_for_this_system_loads_on_old_ones_too(native):
    assert _newest_glibc(native.library) <= (2, 17)


def _trajectory(unpacked: Unpacked, library: Path, program: Path, version: str, runner: list[str]) -> np.ndarray:
    references = [str(unpacked.reference(n)) for n in (*INPUTS, *OUTPUTS)]
    words = [*runner, str(program), str(library), unpacked.description.guid, version, "400", "0.01", *references]
    done = subprocess.run(words, capture_output=True, text=True, env={**os.environ, "WINEDEBUG": "-all"}, timeout=300)
    assert done.returncode == 0, done.stderr
    return np.array([line.split() for line in done.stdout.splitlines()], float)


def _host(folder: Path, target: str = "") -> Path:
    program = folder / f"trajectory-{target or 'here'}.exe"
    command = (*compiler.ZIG, "-target", target) if target else compiler.command()
    libraries = ["-lm"] if "windows" in target else ["-lm", "-ldl"]
    words = [*command, "-std=gnu11", "-O1", "-fno-sanitize=all", "-ffp-contract=off", f"-I{headers()}"]
    done = subprocess.run([*words, str(HERE / "trajectory.c"), "-o", str(program), *libraries], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return program


def test_a_plain_host_gets_the_same_through_both_versions(native, native3, workshop):
    program = _host(workshop)
    runs = [_trajectory(u, u.library, program, v, []) for u, v in ((native, "2"), (native3, "3"))]
    assert runs[0].shape == (400, len(OUTPUTS)) and (runs[0] == runs[1]).all()


@needs_zig
@pytest.mark.nightly
@pytest.mark.parametrize("name", RUNNERS)
def test_the_trajectory_is_the_same_on(name, everywhere, native, workshop):
    runner, why = RUNNERS[name]
    if runner is None:
        pytest.skip(why)
    expected = _trajectory(native, native.library, _host(workshop), "2", [])
    program = _host(workshop, PLATFORMS[name].target)
    for version, unpacked in everywhere.items():
        folder = PLATFORMS[name].folder if version == "2" else name
        library = unpacked.folder / "binaries" / folder / f"Wheelchair{PLATFORMS[name].suffix}"
        np.testing.assert_allclose(_trajectory(unpacked, library, program, version, runner), expected, rtol=1e-12, atol=1e-12)


@needs_zig
@pytest.mark.nightly
def test_libraries_export_fmi_and_need_the_system_only(everywhere):
    for name, platform in PLATFORMS.items():
        library = everywhere["3"].folder / "binaries" / name / f"Wheelchair{platform.suffix}"
        exported, needed = (_windows if "windows" in name else _mach if "darwin" in name else _elf)(library)
        ours = set(exported) - (MARKERS if "darwin" in name else set())
        assert len(ours) > 100 and all(re.fullmatch(r"fmi[23]\w+", symbol) for symbol in ours), name
        assert all(
            re.match(r"lib[cm]\.so|ld-linux|KERNEL32|api-ms-win-crt|ucrtbase|msvcrt|/usr/lib/libSystem", n) for n in needed
        ), (name, needed)
        if "linux" in name:
            assert _newest_glibc(library) <= (2, 17), name


@needs_zig
@pytest.mark.nightly
def test_two_builds_for_all_platforms_are_the_same_bytes(everywhere, tmp_path, monkeypatch):
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "empty"))  # all is compiled once more
    build_each({"3": tmp_path / "again.fmu"}, platforms="all")
    assert (tmp_path / "again.fmu").read_bytes() == everywhere["3"].path.read_bytes()


def _newest_glibc(library: Path) -> tuple[int, int]:
    versions = re.findall(r"GLIBC_(\d+)\.(\d+)", _said("readelf", "-V", str(library)))
    return max((int(a), int(b)) for a, b in versions)


def _said(*words: str) -> str:
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def _elf(library: Path) -> tuple[list[str], list[str]]:
    table = _said("readelf", "-W", "--dyn-syms", str(library)).splitlines()
    rows = [line.split() for line in table if re.search(r" (GLOBAL|WEAK) +DEFAULT +\d+ ", line)]
    return [row[-1] for row in rows], re.findall(r"\(NEEDED\).*\[(.+)]", _said("readelf", "-d", str(library)))


def _windows(library: Path) -> tuple[list[str], list[str]]:
    """From the export and import directories of a PE32+ file."""
    b = library.read_bytes()
    u2, u4 = (lambda at: int.from_bytes(b[at : at + 2], "little")), (lambda at: int.from_bytes(b[at : at + 4], "little"))
    pe = u4(0x3C)
    sections = [pe + 24 + u2(pe + 20) + 40 * i for i in range(u2(pe + 6))]

    def place(address: int) -> int:
        s = next(s for s in sections if u4(s + 12) <= address < u4(s + 12) + max(u4(s + 8), u4(s + 16)))
        return address - u4(s + 12) + u4(s + 20)

    def name(at: int) -> str:
        return b[at : b.index(b"\0", at)].decode()

    exports, imports = place(u4(pe + 24 + 112)), place(u4(pe + 24 + 120))
    names = place(u4(exports + 32))
    found = [name(place(u4(names + 4 * i))) for i in range(u4(exports + 24))]
    needed = []
    while u4(imports + 12):
        needed.append(name(place(u4(imports + 12))))
        imports += 20
    return found, needed


def _mach(library: Path) -> tuple[list[str], list[str]]:
    """From the load commands of a 64-bit Mach-O file: libraries, and the external symbols that it defines."""
    b = library.read_bytes()
    u4 = lambda at: int.from_bytes(b[at : at + 4], "little")  # noqa: E731
    at, exported, needed = 32, [], []
    for _ in range(u4(16)):
        command, size = u4(at), u4(at + 4)
        if command == 0xC:  # LC_LOAD_DYLIB
            needed.append(b[at + u4(at + 8) : at + size].split(b"\0")[0].decode())
        if command == 2:  # LC_SYMTAB
            symbols, count, strings = u4(at + 8), u4(at + 12), u4(at + 16)
            for i in range(count):
                kind = b[symbols + 16 * i + 4]
                if kind & 0x1F == 0xF:  # external, defined in a section, and not for this library only
                    start = strings + u4(symbols + 16 * i)
                    exported.append(b[start : b.index(b"\0", start)].decode().removeprefix("_"))
        at += size
    return exported, needed
