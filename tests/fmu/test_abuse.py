"""Whatever a host does: a status and a sentence, never a crash."""

from __future__ import annotations

import os
import shutil
import subprocess
import threading
import zipfile
from pathlib import Path

import pytest

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.fmu.native import headers

from .chair import ERROR, Unpacked, chair, pushed

HERE = Path(__file__).parent
NIGHTLY_SEEDS = int(os.environ.get("FUZZ_SEEDS", "20000"))
SANITIZERS = "address,undefined"


def _fuzzer(native: Unpacked, native3: Unpacked, program: Path, command: list[str]) -> Path:
    """fuzz.c and the FMU's sources in one program, by this compiler with these flags."""
    if not program.exists():
        units = [str(archive.folder / "sources" / "all.c") for archive in (native, native3)]
        words = [*command, "-std=gnu11", "-g1", f"-I{headers()}", f"-I{native.folder / 'sources'}"]
        words += [str(HERE / "fuzz.c"), *units, "-o", str(program), "-lm"]
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode and ("san" in done.stderr or "fuzzer" in done.stderr):
            pytest.skip(f"{command[0]} lacks a library of its sanitizers: `apt-get install gcc clang libclang-rt-dev`")
        assert done.returncode == 0, done.stderr
    return program


def _facts(native: Unpacked) -> list[str]:
    """Token, number of variables, number of states."""
    d = native.description
    return [d.guid, str(len(d.modelVariables)), str(d.numberOfContinuousStates)]


def _fuzzed(program: Path, facts: list[str], seeds: int, under: tuple[str, ...] = ()) -> str:
    """What the fuzzer prints at the end of lives from these seeds."""
    done = subprocess.run([*under, str(program), *facts, "1", str(seeds)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-4000:]
    return done.stdout


@pytest.mark.parametrize(
    ("archives", "level"), [(("few", "few3"), "-O0"), pytest.param(("native", "native3"), "-O2", marks=pytest.mark.nightly)]
)
def test_random_calls_crash_nothing(archives, level, request, workshop):
    """The calls take no time, but compiling them does."""
    two, three = (request.getfixturevalue(a) for a in archives)
    program = _fuzzer(two, three, workshop / f"fuzz-{archives[0]}", [*compiler.command(), level])
    sentences, taken, refusals = map(int, _fuzzed(program, _facts(two), 200).split()[::2])
    assert sentences > 1000  # that many refusals had a reason
    assert taken > 10 and refusals > 100  # of states that were forged


@pytest.mark.nightly
def test_random_calls_are_sound_under_sanitizers(native, native3, workshop):
    flags = ["-O1", f"-fsanitize={SANITIZERS}", "-fno-sanitize-recover=all"]
    program = _fuzzer(native, native3, workshop / "fuzz-sanitized", [*compiler.command(), *flags])
    _fuzzed(program, _facts(native), NIGHTLY_SEEDS)


@pytest.mark.nightly
@pytest.mark.skipif(not shutil.which("valgrind"), reason="no valgrind: `apt-get install valgrind`")
def test_random_calls_are_sound_under_valgrind(native, native3, workshop):
    program = _fuzzer(native, native3, workshop / "fuzz-valgrind", [*compiler.command(), "-O2"])
    _fuzzed(program, _facts(native), 30, under=("valgrind", "--quiet", "--error-exitcode=99", "--leak-check=full"))


@pytest.mark.nightly
@pytest.mark.skipif(not shutil.which("clang"), reason="no clang: `apt-get install clang libclang-rt-dev`")
def test_calls_that_seek_new_code_are_sound(native, native3, workshop, tmp_path):
    """By libFuzzer, which keeps the lives that reached code no other had and goes on from them."""
    flags = ["-DLIBFUZZER", "-O1", f"-fsanitize=fuzzer,{SANITIZERS}", "-fno-sanitize-recover=all"]
    program = _fuzzer(native, native3, workshop / "libfuzzer", ["clang", *flags])
    facts = dict(zip(("TOKEN", "VARIABLES", "STATES"), _facts(native), strict=True))
    words = [str(program), "-seed=1", "-len_control=0", "-max_len=3200", f"-runs={2 * NIGHTLY_SEEDS}"]
    done = subprocess.run(words, capture_output=True, text=True, env={**os.environ, **facts}, cwd=tmp_path)
    assert done.returncode == 0, done.stderr[-4000:]


def test_a_freed_instance_is_no_instance(native, host):
    """With a host whose memory outlives the instance, so that the calls are no undefined behaviour themselves."""
    assert host(native, "freed", 1, 0.01) == [ERROR, ERROR, 1]  # of doStep and get; and it is freed once


def test_ten_thousand_instances_come_and_go(native, host):
    different, grown = host(native, "cycles", 10_000, 0.001)
    assert different == 0 and grown < 512  # KiB, of stdio and stack


def test_two_threads_with_an_instance_each(native):
    def ride(turn: float, into: dict[float, list[float]]) -> None:
        with chair(native) as c:
            c.start()
            for i in range(300):
                c.set({**pushed(i), "push.M_rl": turn})
                c.step(0.01)
            into[turn] = c.outputs()

    alone: dict[float, list[float]] = {}
    together: dict[float, list[float]] = {}
    for turn in (1.0, -2.0):
        ride(turn, alone)
    threads = [threading.Thread(target=ride, args=(turn, together)) for turn in (1.0, -2.0)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert together == alone


@pytest.mark.parametrize("archive", ["native", "native3"])
def test_parameters_may_change_while_it_runs(archive, request):
    """Every tunable parameter to its bounds and back, in the middle of a stroke: no step fails, and nothing is left behind."""
    unpacked: Unpacked = request.getfixturevalue(archive)
    with chair(unpacked) as c:
        c.start({"push.F_rl": 20.0, "push.F_rr": 15.0}).step(0.01, 5)
        for name, v in c.types.items():
            if v.causality != "parameter" or v.variability != "tunable":
                continue
            old, state = c.get(name)[0], c.save()
            for value in (v.min, v.max):
                if value is None or abs(float(value)) > 1e4 or name in ("regularisation.v_eps",):
                    continue
                c.set({name: float(value)})
                try:
                    c.fmu.doStep(c.time, 0.01)
                except Exception:
                    assert "change inputs or parameters" in c.sentences[-1], name
                c.restore(state)
                assert c.get(name)[0] == old
            c.drop(state)
        c.step(0.01)


@pytest.mark.parametrize("what", ["nothing", "text", "no description", "no library"])
def test_a_bad_archive_gets_a_sentence(what, native, tmp_path):
    """From the command that reads archives which others have made."""
    from typer.testing import CliRunner

    from wheelchair_fmu.cli.main import app

    bad = tmp_path / "bad.fmu"
    if what == "text":
        bad.write_text("this is no archive")
    elif what != "nothing":
        with zipfile.ZipFile(native.path) as good, zipfile.ZipFile(bad, "w") as z:
            for name in good.namelist():
                if not name.startswith("modelDescription" if what == "no description" else "binaries"):
                    z.writestr(name, good.read(name))
    done = CliRunner().invoke(app, ["simulate", "steady-turn", "--fmu", str(bad), "-o", str(tmp_path / "out")])
    assert done.exit_code == 1 and "bad.fmu" in done.output + done.stderr
    assert not isinstance(done.exception, Exception) or isinstance(done.exception, SystemExit)
