"""Input that nobody would give on purpose: each ends in sentences and an exit code, soon, and in no traceback."""

from __future__ import annotations

import gzip
import os
import shutil
import socket
import time
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from typer.testing import CliRunner

from tests.campaign.small import HEAD, NOISE, RUNS, SI, csv_text, motion, rows
from wheelchair_fmu import tables
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.given import DEEPEST

SOON = 60.0  # s, also on a machine that is busy with something else


def wheelchair(*words: object):
    begun = time.monotonic()
    done = CliRunner().invoke(app, [str(word) for word in words])
    assert done.exception is None or isinstance(done.exception, SystemExit), repr(done.exception)
    assert done.exit_code in (0, 1, 2) and "Traceback" not in done.output and "nobody expected" not in done.output
    assert time.monotonic() - begun < SOON
    return done


@pytest.fixture
def small(tmp_path: Path) -> Callable[..., Path]:
    """A sound small campaign in which one thing is replaced."""

    def write(toml: str = HEAD + NOISE + RUNS, a: str | bytes | None = None) -> Path:
        (tmp_path / "campaign.toml").write_text(toml, encoding="utf-8")
        for name, seed in (("a.csv", 0), ("b.csv", 1)):
            (tmp_path / name).write_text(csv_text(SI, rows(motion(seed=seed))), encoding="utf-8")
        if a is not None:
            (tmp_path / "a.csv").write_bytes(a if isinstance(a, bytes) else a.encode())
        return tmp_path

    return write


def data(row: int, column: int, value: float) -> str:
    changed = motion()
    changed[row:, column] = changed[row:, column] + value if column == 0 else value
    return csv_text(SI, rows(changed))


DOCUMENTS = {
    "no file name": (RUNS.replace('"a.csv"', '""'), "run 1 names no file"),
    "blank file name": (RUNS.replace('"a.csv"', '"  "'), "run 1 (  ) names no file"),
    "runs that are none": ("run = [1, 2]\n", "2 of the runs are no tables"),
    "deep lists": ("x = " + "[" * 5000 + "]" * 5000 + "\n" + RUNS, "nested too deeply"),
    "deep tables": ("".join(f"[{'.'.join(['a'] * n)}]\n" for n in (DEEPEST + 5,)) + RUNS, f"nested more than {DEEPEST} deep"),
    "a number of 5000 digits": (RUNS.replace("u0 = 1.0", "u0 = 1" + "0" * 5000), "a number is too long"),
    "a number of 4000 digits": (RUNS.replace("u0 = 1.0", "u0 = 1" + "0" * 4000), "which is no number"),
    "noise of nothing": (RUNS + "[noise]\nyaw_rate = 1e-300\n", "1e-300 rad/s is no noise of a sensor"),
    "noise of everything": (RUNS + "[noise]\na_y = 1e300\n", "1e+300 m/s2 is no noise of a sensor"),
    "a hundred thousand keys": (
        RUNS + "[chair]\n" + "".join(f"k{i} = {i}\n" for i in range(100_000)),
        "[chair] has 100000 keys, but at most 1000 make sense",
    ),
    "nine hundred keys": (RUNS + "[chair]\n" + "".join(f"k{i} = {i}\n" for i in range(900)), "and 890 more like these"),
    "the speed of a rocket": (RUNS.replace("u0 = 1.0", "u0 = 1e12", 1), "u0 = 1e+12 m/s is no speed of a wheelchair"),
    "a name that no disk can have": (RUNS.replace("a.csv", "a" * 5000), "no such file"),
    "a name with a zero": (RUNS.replace("a.csv", "a\\u0000.csv"), "no such file"),
}


@pytest.mark.parametrize("name", DOCUMENTS)
def test_an_odd_campaign_file(small, name):
    text, sentence = DOCUMENTS[name]
    bare = "[chair]" in text or "[noise]" in text
    folder = small(('[campaign]\naxes = "SAE-J670"\n' if bare else "") + text if bare else text)
    done = wheelchair("check", folder)
    assert done.exit_code == 1 and sentence in done.output
    assert all(len(line) < 3000 for line in done.output.splitlines()) and len(done.output.splitlines()) < 60


RECORDINGS = {
    "a long cell": (
        lambda: csv_text(SI, [["1" * 200_000, *row[1:]] if i == 3 else row for i, row in enumerate(rows(motion()))]).replace(
            "0.05", '"0.05"', 1
        ),
        "field larger than field limit (131072)",
    ),
    "a long header": (lambda: "x" * 200_000 + csv_text(SI, rows(motion())), "no time column among"),
    "a gap of 30 years": (lambda: data(100, 0, 1e9), "the largest is 1e+09 s"),
    "a push of a trillion newton": (lambda: data(50, 1, 1e12), "F_rl reaches 1e+12 N, above any plausible 2000 N"),
    "a hundred thousand columns": (
        lambda: csv_text([*SI, *(f"c{i}" for i in range(100_000))], [row + ["0"] * 100_000 for row in rows(motion(20))]),
        "and 99990 more not used",
    ),
    "a hundred thousand times the same": (
        lambda: csv_text([*SI, *(f"c{i // 2}" for i in range(100_000))], [row + ["0"] * 100_000 for row in rows(motion(20))]),
        "49990 more headers like these",
    ),
}


@pytest.mark.parametrize("name", RECORDINGS)
def test_an_odd_recording(small, name):
    made, sentence = RECORDINGS[name]
    done = wheelchair("check", small(a=made()))
    assert sentence in done.output and len(done.output.splitlines()) < 60
    assert done.exit_code == (0 if "columns" in name else 1)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_what_is_no_file_is_called_what_it_is(small, tmp_path):
    folder = small()
    os.mkfifo(folder / "pipe")
    (folder / "sub").mkdir()
    with socket.socket(socket.AF_UNIX) as open_socket:
        os.chdir(folder)  # the whole path may be too long for a socket
        open_socket.bind("plug")
        for name, kind in (("pipe", "a named pipe"), ("sub", "a folder"), ("plug", "a socket"), ("/dev/null", "a device")):
            (folder / "campaign.toml").write_text(HEAD + NOISE + RUNS.replace("a.csv", name), encoding="utf-8")
            done = wheelchair("check", folder)
            assert f"this is {kind}, not a recording" in done.output and done.exit_code == 1
            assert f"this is {kind}" in wheelchair("tyre", "fit", folder / name).output
            assert f"this is {kind}" in wheelchair("ssp", "check", folder / name).output
    assert "this is a named pipe" in wheelchair("check", folder / "pipe").output


@pytest.fixture(autouse=True)
def _here():
    before = Path.cwd()
    yield
    os.chdir(before)


def test_a_packed_recording_is_unpacked_up_to_a_limit(small, monkeypatch):
    monkeypatch.setattr(tables, "MOST", 2**20)
    folder = small(HEAD + NOISE + RUNS.replace("a.csv", "a.csv.gz"))
    (folder / "a.csv.gz").write_bytes(gzip.compress(b"0" * (2**20 + 1)))
    done = wheelchair("check", folder)
    assert done.exit_code == 1 and "unpacks to more than 0.000976562 GiB" in done.output
    (folder / "a.csv.gz").write_bytes(gzip.compress(csv_text(SI, rows(motion())).encode()))
    assert wheelchair("check", folder).exit_code == 0


def test_of_a_parquet_file_only_what_is_asked_for_is_read(small, monkeypatch):
    import pyarrow.parquet

    folder = small(HEAD + NOISE + RUNS.replace("a.csv", "a.parquet"))
    frame = pd.DataFrame(dict(zip(SI, motion().T, strict=True))).assign(**{f"c{i}": "text" for i in range(50)})
    frame.to_parquet(folder / "a.parquet")
    read, asked = pyarrow.parquet.ParquetFile.read, []
    monkeypatch.setattr(
        pyarrow.parquet.ParquetFile,
        "read",
        lambda self, columns=None, **how: asked.extend(columns) or read(self, columns=columns, **how),
    )
    done = wheelchair("check", folder)
    assert done.exit_code == 0 and "and 40 more not used" in done.output
    assert set(asked) == set(SI)


def test_names_reach_the_terminal_as_text(small):
    name = "a\\u001b[31m:car:[red]\\u0007.csv"
    folder = small(HEAD + NOISE + RUNS.replace("a.csv", name))
    shutil.move(folder / "a.csv", folder / "a\x1b[31m:car:[red]\x07.csv")
    for words in (("check", folder), ("check", folder, "--json")):
        done = wheelchair(*words)
        assert done.exit_code == 0 and "\x1b" not in done.output and "\x07" not in done.output
    assert "a\\x1b[31m:car:[red]\\x07" in wheelchair("check", folder).output


@pytest.mark.parametrize("body", ["raise SystemExit(0)", "import sys\nsys.exit(3)"])
def test_an_effect_file_cannot_end_the_command(tmp_path, small, body):
    (tmp_path / "effects").mkdir()
    (tmp_path / "effects" / "quits.py").write_text(body + "\n", encoding="utf-8")
    done = wheelchair("compare", small(), "--effects", tmp_path / "effects")
    assert done.exit_code == 1 and "it ends the program instead of defining an effect" in done.output
