"""Random input for the command line: options, campaigns, tyre files and archives that are broken somewhere.

Each example ends in an exit code of 0, 1 or 2 and in sentences, soon. Failing examples print what reproduces them.
"""

from __future__ import annotations

import contextlib
import faulthandler
import io
import os
import random
import shutil
import signal
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from tests.campaign.small import HEAD, NOISE, RUNS, SI, csv_text, motion, rows
from tests.tyres.test_formats import BY_HAND, TIR
from wheelchair_fmu.cli.group import TRACEBACK
from wheelchair_fmu.cli.main import COMMANDS, app
from wheelchair_fmu.studies.ssp.building import build

NO_ALARM = not hasattr(signal, "SIGALRM")
pytestmark = [pytest.mark.nightly, pytest.mark.skipif(NO_ALARM, reason="needs an alarm to stop what hangs")]
RIG = Path(__file__).parents[2] / "examples" / "rotating-disc.csv"
LONGEST = 60  # s for one example; on an idle machine most take milliseconds
QUIET = settings(max_examples=300, deadline=None, print_blob=True, suppress_health_check=list(HealthCheck))


class _Hangs(BaseException):
    """No command may catch it."""


@contextlib.contextmanager
def limited(seconds: int) -> Iterator[None]:
    def stop(*_: object) -> None:
        faulthandler.dump_traceback()
        raise _Hangs(f"more than {seconds} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def wheelchair(words: Sequence[str]) -> None:
    os.environ.pop(TRACEBACK, None)
    with limited(LONGEST):
        done = CliRunner().invoke(app, list(words))
    said = f"wheelchair {' '.join(map(repr, words))}\n{done.output[-2000:]}"
    assert done.exception is None or isinstance(done.exception, SystemExit), f"{said}\n{done.exception!r}"
    assert done.exit_code in (0, 1, 2), said
    assert "Traceback" not in done.output and "nobody expected" not in done.output, said
    assert "\x1b" not in done.output, said


# ---- options ----

OPTIONS = [
    "--set",
    "--variant",
    "--effects",
    "--json",
    "-o",
    "--speed",
    "--time",
    "--delta-force",
    "--calibrate",
    "--help",
    "--version",
    "--bootstrap",
    "--equations",
    "--axes",
    "--law",
    "--workers",
    "--step",
    "--parameters",
]
WORDS = [
    "chair.m=90",
    "chair.m=",
    "=",
    "effect.nothing.x=1",
    "effect.floor_slope.x=nan",
    "nowhere",
    "0",
    "-1",
    "1e308",
    "nan",
    "inf",
    "",
    "[red]",
    ":car:",
    "\x1b[31m",
    "list",
    "show",
    "fit",
    "plot",
    "export",
    "build",
    "check",
    "run",
    "steady-turn",
    "coast-down",
    "slalom",
    "/dev/null",
    "/dev/zero",
    ".",
    "..",
    "/",
    "a" * 300,
    "\udcff",
]
SAFE = [name for name in COMMANDS if name not in ("workbench", "fleet", "sweep", "paper", "improve")]  # the others start work
words = st.one_of(st.sampled_from(OPTIONS), st.sampled_from(WORDS), st.text(max_size=12).filter(lambda w: "\0" not in w))


@QUIET
@given(command=st.sampled_from(SAFE), rest=st.lists(words, max_size=5))
def test_random_options(tmp_path_factory, command, rest):
    folder = tmp_path_factory.mktemp("options")
    with contextlib.chdir(folder):
        wheelchair([command, *rest])
    shutil.rmtree(folder)


@QUIET
@given(command=st.sampled_from(["workbench", "fleet", "sweep", "paper", "improve"]), word=st.sampled_from(WORDS[:14]))
def test_unknown_options_of_the_commands_that_work_long(command, word):
    wheelchair([command, "--no-such-option", word])


# ---- mutations ----


def mutated(content: bytes, rng: random.Random) -> bytes:
    """The content with some bytes, lines or cells changed, as a bad disk, a bad editor or a bad mood would."""
    for _ in range(rng.choice((1, 1, 2, 5, 20))):
        lines = content.split(b"\n")
        i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
        at = rng.randrange(len(content)) if content else 0
        what = rng.randrange(11)
        if what == 0:
            content = content[:at] + bytes([rng.randrange(256)]) + content[at + 1 :]
        elif what == 1:
            content = content[:at]
        elif what == 2:
            content = content[:at] + rng.randbytes(rng.randrange(40)) + content[at:]
        elif what == 3:
            lines[i], lines[j] = lines[j], lines[i]
        elif what == 4:
            lines.insert(i, lines[j])
        elif what == 5:
            del lines[i]
        elif what == 6:
            lines[i] = lines[i].replace(rng.choice((b",", b"=", b'"', b"[", b".")), rng.choice((b"", b";", b",,", b"'", b"]")))
        elif what == 7:
            numbers = (b"1e308", b"-1e300", b"nan", b"inf", b"1e-320", b"9" * 400, b"0", b"-0.0", b"1_0", "１".encode())
            cells = lines[i].split(b",")
            cells[rng.randrange(len(cells))] = rng.choice(numbers)
            lines[i] = b",".join(cells)
        elif what == 8:
            key, sign, _ = lines[i].partition(b"=")
            values = (b" -1", b' ""', b" []", b" {}", b" true", b" 1e308", b" 1e-320", b' "\\u0000"', b' "kg"', b" 1979-05-27")
            lines[i] = key + sign + rng.choice(values) if sign else lines[i]
        elif what == 9:
            content = content.replace(b"\n", rng.choice((b"\r", b"\r\n", b"\n\n", b"\0\n")))
        else:
            content = rng.choice((b"", b"\xff\xfe", b"\xef\xbb\xbf" + content, content.decode("latin-1").encode("utf-16")))
        if what in (3, 4, 5, 6, 7, 8):
            content = b"\n".join(lines)
    return content


seeds = st.integers(0, 2**32 - 1)


@pytest.fixture(scope="module")
def sound() -> dict[str, bytes]:
    """A small campaign's files."""
    return {
        "campaign.toml": (HEAD + '[columns]\nyaw_rate = { column = "yaw_rate [rad/s]" }\n' + NOISE + RUNS).encode(),
        **{f"{name}.csv": csv_text(SI, rows(motion(seed=i))).encode() for i, name in enumerate("ab")},
    }


@QUIET
@given(seed=seeds)
def test_broken_campaigns(tmp_path_factory, sound, seed):
    rng, folder = random.Random(seed), tmp_path_factory.mktemp("campaign")
    for name, content in sound.items():
        (folder / name).write_bytes(mutated(content, rng) if rng.random() < 0.5 else content)
    wheelchair(["check", str(folder), *(["--json"] if rng.random() < 0.3 else [])])
    if rng.random() < 0.1:
        wheelchair(["compare", str(folder)])
    shutil.rmtree(folder)


TYRES = {"disc.csv": RIG.read_bytes(), "hand.tdx": BY_HAND.encode(), "hand.tir": TIR.encode()}


@QUIET
@given(seed=seeds)
def test_broken_tyre_files(tmp_path_factory, seed):
    rng, folder = random.Random(seed), tmp_path_factory.mktemp("tyre")
    name = rng.choice(sorted(TYRES))
    path = folder / name
    path.write_bytes(mutated(TYRES[name], rng))
    wheelchair(["tyre", "fit", str(path)])
    shutil.rmtree(folder)


@pytest.fixture(scope="module")
def archive(tmp_path_factory) -> dict[str, bytes]:
    with zipfile.ZipFile(build("slalom", tmp_path_factory.mktemp("ssp") / "slalom.ssp")) as packed:
        return {name: packed.read(name) for name in packed.namelist()}


@QUIET
@given(seed=seeds)
def test_broken_archives(tmp_path_factory, archive, seed):
    rng, folder = random.Random(seed), tmp_path_factory.mktemp("ssp")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as out:
        for name, content in archive.items():
            if rng.random() < 0.05:
                continue
            text = name.endswith((".ssd", ".ssv", ".ssm"))
            out.writestr(name, mutated(content, rng) if rng.random() < (0.5 if text else 0.05) else content)
    raw = packed.getvalue()
    if rng.random() < 0.2:
        at = rng.randrange(len(raw))
        raw = raw[:at] + bytes([rng.randrange(256)]) + raw[at + 1 :]
    (folder / "x.ssp").write_bytes(raw)
    wheelchair(["ssp", "check", str(folder / "x.ssp")])
    shutil.rmtree(folder)
