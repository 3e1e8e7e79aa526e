"""What is kept between sessions is what was made, whatever has happened to it since."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from wheelchair_fmu.engine import store
from wheelchair_fmu.errors import BuildError

CONTENT = bytes(range(256)) * 40
ROOT = Path(__file__).parents[2]
posix = pytest.mark.skipif(os.name == "nt", reason="Windows has other rights")


@pytest.fixture(autouse=True)
def place(monkeypatch, tmp_path) -> Path:
    """A cache of this test's own, which nobody has looked at yet."""
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(store, "_sound", set())
    for cached in (store._instead_of, store._sweep):
        cached.cache_clear()
    return tmp_path / "cache" / "compiled"


def kept(made: list[Path], content: bytes = CONTENT) -> Path:
    def make(path: Path) -> None:
        made.append(path)
        path.write_bytes(content)

    return store.kept("thing", ".so", make)


def flipped(content: bytes) -> bytes:
    return content[:5000] + bytes([content[5000] ^ 1]) + content[5001:]


def test_made_once_and_found_again():
    made: list[Path] = []
    assert kept(made) == kept(made) and len(made) == 1
    store._sound.clear()
    assert kept(made).read_bytes() == CONTENT and len(made) == 1


@pytest.mark.parametrize(
    "damage",
    [flipped, lambda c: b"", lambda c: c[: len(c) // 2], lambda c: c + b"\0"],
    ids=["a bit flipped", "emptied", "halved", "grown"],
)
def test_what_was_damaged_is_made_again(damage, place, caplog):
    made: list[Path] = []
    path = kept(made)
    path.write_bytes(damage(CONTENT))
    store._sound.clear()  # as in another process
    assert kept(made).read_bytes() == CONTENT and len(made) == 2
    assert "was damaged; it is made again" in caplog.text
    assert [f.read_bytes() for f in place.iterdir()] == [CONTENT]


def test_a_file_without_its_digest_is_not_taken(place):
    made: list[Path] = []
    path = kept(made)
    path.rename(place / "thing-.so")
    store._sound.clear()
    assert kept(made) == path and len(made) == 2 and list(place.iterdir()) == [path]


def test_two_compilers_that_give_different_bytes_do_not_disturb_one_another(place):
    made: list[Path] = []

    def make(path: Path) -> None:
        kept(made, b"another's")  # is done while this one is at work
        store._sound.clear()  # and by another process
        path.write_bytes(CONTENT)

    assert store.kept("thing", ".so", make).read_bytes() == CONTENT
    store._sound.clear()
    assert kept(made) == min(place.iterdir()) and len(list(place.iterdir())) == 2 and len(made) == 1


def test_a_maker_that_fails_leaves_nothing(place):
    with pytest.raises(ZeroDivisionError):
        store.kept("thing", ".so", lambda path: 1 / 0)
    assert list(place.iterdir()) == []


WRITE = """
import sys, time
from pathlib import Path
from wheelchair_fmu.engine import store
def make(path):
    path.write_bytes(sys.argv[1].encode() * 100_000)
    Path(sys.argv[2]).touch()
    while not Path(sys.argv[3]).exists(): time.sleep(0.01)
print(store.kept("thing", ".so", make).read_bytes()[:1].decode())
"""


def test_two_processes_make_the_same_file_at_once(place, tmp_path):
    ends = tmp_path / "a", tmp_path / "b"
    both = [
        subprocess.Popen(
            [sys.executable, "-c", WRITE, letter, str(mine), str(other)], stdout=subprocess.PIPE, text=True, cwd=ROOT
        )
        for letter, mine, other in (("x", *ends), ("y", *ends[::-1]))
    ]
    assert [p.communicate(timeout=60)[0].strip() for p in both] == ["x", "y"]
    assert kept([]).read_bytes() in (b"x" * 100_000, b"y" * 100_000) and len(list(place.iterdir())) == 2


@posix
def test_the_folder_is_for_its_owner_alone(place):
    place.mkdir(parents=True, mode=0o777)
    kept([])
    assert place.stat().st_mode & 0o777 == 0o700


@posix
@pytest.mark.parametrize("kind", ["a file", "another's"])
def test_a_folder_that_cannot_be_used_is_said_once(kind, place, caplog, monkeypatch):
    if kind == "a file":
        place.parent.write_text("no folder")
    else:
        place.mkdir(parents=True)
        me = os.getuid()
        if me == 0:
            os.chown(place, 12345, -1)
        else:
            monkeypatch.setattr(os, "getuid", lambda: me + 1)
    made: list[Path] = []
    assert kept(made) == kept(made) and len(made) == 1 and place not in kept(made).parents
    assert len(caplog.records) == 1 and "set WHEELCHAIR_CACHE to a folder of your own" in caplog.text
    assert not place.is_dir() or list(place.iterdir()) == []


@posix
def test_a_read_only_folder_gives_what_it_has_and_takes_nothing(place, caplog, monkeypatch):
    made: list[Path] = []
    there = kept(made)

    def refused(*args, **kwargs):
        if kwargs["dir"] == place:
            raise PermissionError(13, "Permission denied", str(place))
        return real(*args, **kwargs)

    real = store.tempfile.TemporaryDirectory
    monkeypatch.setattr(store.tempfile, "TemporaryDirectory", refused)
    store._sound.clear()
    assert kept(made) == there and len(made) == 1 and not caplog.records
    other = store.kept("other", ".so", lambda path: path.write_bytes(b"other"))
    assert other.read_bytes() == b"other" and place not in other.parents and list(place.iterdir()) == [there]
    assert "permission denied" in caplog.text


def test_a_full_disk_is_one_sentence(place):
    def make(path: Path) -> None:
        raise OSError(28, "No space left on device", str(path))

    with pytest.raises(BuildError, match=r"compiled: cannot keep there .* no space left on device; make room, or set WHEEL"):
        store.kept("thing", ".so", make)
    assert list(place.iterdir()) == []


def abandoned(place: Path, process: int, age: float) -> Path:
    work = place / f"{store.MAKING}{process}-x"
    work.mkdir(parents=True)
    (work / "half.so").write_bytes(b"half")
    for path in (work / "half.so", work):
        os.utime(path, (time.time() - age,) * 2)
    return work


def test_a_file_that_is_missing_elsewhere_is_no_matter_of_room(place, tmp_path):
    def make(path: Path) -> None:
        path.write_bytes((tmp_path / "law.c").read_bytes())

    with pytest.raises(FileNotFoundError, match=r"law\.c"):
        store.kept("thing", ".so", make)
    assert list(place.iterdir()) == []


@posix
def test_what_others_abandoned_is_swept_and_what_they_use_is_not(place):
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    old = abandoned(place, ended.pid, 2 * store.ABANDONED)
    new = abandoned(place, ended.pid + 10_000_000, 60.0)
    used = abandoned(place, os.getpid(), 2 * store.ABANDONED)
    kept([])
    assert not old.exists() and new.exists() and used.exists()
