"""Killed at any moment, on a full disk, with a damaged cache: what is there is the old or the new, whole, and then the same.

$NIGHTLY_SEED gives other moments and other places.
"""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.independent.campaigns import make
from benchmarks.independent.hidden import usual

from .fleet.conftest import SHORT
from .kit import descendants, gone

ROOT = Path(__file__).parents[1]
SEED = int(os.environ.get("NIGHTLY_SEED", "1"))
OLD = b"what was there before"
WHEELCHAIR = (sys.executable, "-m", "wheelchair_fmu")
PLAN = """
[sweep]
method = "random"
samples = 600
[parameters]
"tyre.C_lambda" = { from = 2500, to = 10000 }
[[manoeuvre]]
name = "slalom"
time = 6
"""
pytestmark = [pytest.mark.nightly, pytest.mark.skipif(os.name == "nt", reason="SIGKILL and limits are POSIX")]


@pytest.fixture(autouse=True)
def rng() -> random.Random:
    print(f"NIGHTLY_SEED={SEED}")
    return random.Random(SEED)


@pytest.fixture(scope="module")
def campaign(tmp_path_factory) -> Path:
    """Six seconds a run, with more drag of the air than the model has."""
    folder = tmp_path_factory.mktemp("hardship") / "chair"
    make(folder, {"aerodynamic_drag": usual("aerodynamic_drag", 4.0)}, manoeuvres=SHORT, seed=SEED)
    return folder


def command(kind: str, campaign: Path, out: Path) -> list[str]:
    if kind == "build":
        return [sys.executable, str(ROOT / "build_fmu.py"), "--fmi", "2", "-o", str(out)]
    if kind == "diagnose":
        return [*WHEELCHAIR, "diagnose", str(campaign), "--json", str(out)]
    if kind == "add":
        return [*WHEELCHAIR, "add", "aerodynamic_drag", str(campaign), "-o", str(out)]
    if kind == "fleet":
        return [*WHEELCHAIR, "fleet", str(campaign.parent), "-o", str(out), "--workers", "2"]
    (campaign.parent / "plan.toml").write_text(PLAN)
    return [*WHEELCHAIR, "sweep", str(campaign.parent / "plan.toml"), "-o", str(out), "--workers", "2"]


def content(file: Path) -> bytes:
    """But for the seconds that it took."""
    return re.sub(rb'"seconds": [0-9.]+', b'"seconds": 0', file.read_bytes())


def run(words: list[str], **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, capture_output=True, text=True, cwd=ROOT, env={**os.environ, **environment}, timeout=600)


def killed(words: list[str], after: float) -> bool:
    """Whether it was still at work then; it and all that it has started are gone afterwards."""
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=ROOT) as process:
        try:
            process.wait(after)
            return False
        except subprocess.TimeoutExpired:
            family = descendants(process.pid)
            os.kill(process.pid, signal.SIGKILL)
            process.wait()
    assert gone(family, 30)
    return True


@pytest.mark.parametrize("kind", ["build", "diagnose", "add"])
def test_killed_at_any_moment_a_result_is_old_or_whole(kind, campaign, tmp_path, rng):
    whole = tmp_path / "whole" / "result"
    whole.parent.mkdir()
    run(command(kind, campaign, whole))  # compiles
    begun = time.monotonic()
    assert (done := run(command(kind, campaign, whole))).returncode == 0, done.stderr
    lasts, out, ended = time.monotonic() - begun, tmp_path / "out", 0
    # the end, where files are written, is when it matters most
    for after in sorted(lasts * rng.choice((rng.uniform(0, 1), rng.uniform(0.9, 1.1))) for _ in range(8)):
        out.write_bytes(OLD)
        ended += killed(command(kind, campaign, out), after)
        assert content(out) in (OLD, content(whole))
    assert ended
    assert run(command(kind, campaign, out)).returncode == 0
    assert content(out) == content(whole)


@pytest.mark.parametrize("kind", ["sweep", "fleet"])
def test_killed_again_and_again_what_is_resumed_is_the_same(kind, campaign, tmp_path, rng):
    garage = tmp_path / "garage"
    for name in ("a", "b", "c"):
        shutil.copytree(campaign, garage / name)
    whole, out = tmp_path / "whole.parquet", tmp_path / "out.parquet"
    run(command(kind, garage / "a", whole))  # compiles
    whole.unlink()
    begun = time.monotonic()
    assert (done := run(command(kind, garage / "a", whole))).returncode == 0, done.stderr
    lasts = time.monotonic() - begun
    ended = sum(killed(command(kind, garage / "a", out), lasts * rng.uniform(0.3, 0.9)) for _ in range(6))
    assert ended
    assert (done := run(command(kind, garage / "a", out))).returncode == 0, done.stderr
    assert out.read_bytes() == whole.read_bytes()
    assert not out.with_name(out.name + ".parts").exists()


def verdict(campaign: Path, out: Path, cache: Path) -> bytes:
    done = run(command("diagnose", campaign, out), WHEELCHAIR_CACHE=str(cache))
    assert done.returncode == 0, done.stderr
    return content(out)


def test_a_cache_that_rots_changes_no_digit(campaign, tmp_path, rng):
    cache = tmp_path / "cache"
    expected = verdict(campaign, tmp_path / "first.json", cache)
    assert json.loads(expected)["verdict"]
    for _ in range(3):
        files = sorted(f for f in (cache / "compiled").iterdir() if f.is_file())
        for file in rng.sample(files, 3):
            rotten = bytearray(file.read_bytes())
            if rng.random() < 0.3:
                rotten = rotten[: rng.randrange(len(rotten))]
            for place in (rng.randrange(len(rotten)) for _ in range(3) if rotten):
                rotten[place] ^= 1 << rng.randrange(8)
            file.write_bytes(rotten)
        assert verdict(campaign, tmp_path / "again.json", cache) == expected


@pytest.fixture(params=["a small disk", "small files"])
def cramped(request, tmp_path) -> Iterator[tuple[Path, list[str]]]:
    """A folder with room for 64 kB, and what must stand before a command for that."""
    if request.param == "small files":
        yield tmp_path, ["/bin/sh", "-c", 'ulimit -f 128; exec "$@"', "sh"]  # of 512 bytes
        return
    place = tmp_path / "disk"
    place.mkdir()
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", str(place)], capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"a small disk needs root: {done.stderr.strip()}")
    try:
        yield place, []
    finally:
        subprocess.run(["umount", str(place)], check=True)


@pytest.mark.parametrize("kind", ["build", "diagnose", "sweep"])
@pytest.mark.parametrize("full", ["results", "cache"])
def test_a_full_disk_is_one_sentence(kind, full, campaign, cramped, tmp_path):
    place, before = cramped
    if (full, kind) == ("cache", "build"):
        pytest.skip("a build keeps nothing in the cache")
    if full == "results" and kind != "build" and before:
        pytest.skip("its results are smaller than that")
    out = (place if full == "results" else tmp_path) / "out.parquet"
    cache = {} if full == "results" else {"WHEELCHAIR_CACHE": str(place / "cache")}
    if full == "results":
        out.write_bytes(OLD)
        if not before:
            (place / "filled").write_bytes(b"x" * (place_left(place) - 100))
    done = run([*before, *command(kind, campaign, out)], **cache)
    said = done.stderr.strip().splitlines()
    assert done.returncode == 1 and "Traceback" not in done.stderr, done.stderr
    assert any("no space left" in line.lower() or "file too large" in line.lower() or "room" in line for line in said), said
    assert full == "cache" or out.read_bytes() == OLD


def place_left(place: Path) -> int:
    free = os.statvfs(place)
    return free.f_bavail * free.f_frsize
