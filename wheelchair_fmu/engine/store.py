"""Files kept between sessions, each with a digest of its content in its name: what was damaged since is made again.

Two processes that make the same file at once do not disturb one another, also where their compilers give different bytes.
"""

from __future__ import annotations

import atexit
import hashlib
import logging
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from threading import RLock

import platformdirs

from ..errors import BuildError
from ..writing import settle

MAKING = "making-"  # folders of files that are not finished, with the id of the process that makes them
ABANDONED = 86_400.0  # seconds without a change
DIGITS = 32  # of the digest: it is to show damage, not to stop forgers, who have no rights here
log = logging.getLogger(__name__)
_sound: set[Path] = set()  # files that this process has looked at


def folder() -> Path:
    """Where files are kept: `compiled` in $WHEELCHAIR_CACHE, or in the user's cache folder.

    What is in it is run, so it is for this user alone. Where there can be no such folder, it is one that goes with this
    process.
    """
    place = Path(os.environ.get("WHEELCHAIR_CACHE") or platformdirs.user_cache_dir("wheelchair-fmu")) / "compiled"
    try:
        place.mkdir(mode=0o700, parents=True, exist_ok=True)
        why = _not_ours(place)
    except OSError as error:
        why = (error.strerror or str(error)).lower()
    return _instead_of(place, why) if why else place


def found(name: str, suffix: str, place: Path | None = None) -> Path | None:
    """The file of this name in `folder()`, or another place, if it is there and as it was made."""
    for path in sorted((place or folder()).glob(f"{name}-*{suffix}")):
        if _is_sound(name, path, suffix):
            return path
        log.warning("%s was damaged; it is made again", path)
    return None


def kept(name: str, suffix: str, make: Callable[[Path], object]) -> Path:
    """The file of this name; `make(path)` makes it where it is missing or damaged, in one thread at a time.

    Raises BuildError where it cannot be kept, and what `make` raises.
    """
    with _turn(f"{name}{suffix}"):
        return found(name, suffix) or _made(name, suffix, make)


@cache
def _turn(name: str) -> RLock:
    return RLock()


def _made(name: str, suffix: str, make: Callable[[Path], object]) -> Path:
    try:
        with making() as work:
            beside = work / f"{name}{suffix}"
            make(beside)
            target = work.parent / named(name, beside, suffix)
            for other in work.parent.glob(f"{name}-*{suffix}"):
                if not _is_sound(name, other, suffix):  # what another process has just made is
                    other.unlink(missing_ok=True)
            settle(beside, target)
    except OSError as error:
        if isinstance(error.filename, str) and not Path(error.filename).is_relative_to(folder()):
            raise  # of a file that somebody else keeps
        raise BuildError(
            f"{folder()}: cannot keep there what was compiled: {(error.strerror or str(error)).lower()}; make "
            "room, or set WHEELCHAIR_CACHE to another folder"
        ) from error
    _sound.add(target)
    return target


@contextmanager
def making() -> Iterator[Path]:
    """A folder in `folder()` to make files in, gone afterwards."""
    place = folder()
    try:
        work = tempfile.TemporaryDirectory(prefix=f"{MAKING}{os.getpid()}-", dir=place)
    except OSError as error:
        place = _instead_of(place, (error.strerror or str(error)).lower())
        work = tempfile.TemporaryDirectory(prefix=f"{MAKING}{os.getpid()}-", dir=place)
    _sweep(place)
    with work as name:
        yield Path(name)


def _is_sound(name: str, path: Path, suffix: str) -> bool:
    try:
        if path not in _sound and named(name, path, suffix) != path.name:
            return False
    except FileNotFoundError:  # another process has just removed it for that
        return False
    _sound.add(path)
    return True


def named(name: str, content: Path, suffix: str) -> str:
    """What a file of this content is called."""
    with content.open("rb") as file:
        return f"{name}-{hashlib.file_digest(file, 'sha256').hexdigest()[:DIGITS]}{suffix}"


def _not_ours(place: Path) -> str:
    """Why others could change what is in a folder; "" where they cannot."""
    if os.name == "nt":  # whose folders of users are closed to others
        return ""
    owners = {place.lstat().st_uid, place.stat().st_uid}
    if not owners <= {os.getuid(), 0}:
        return "it is another user's"
    if place.stat().st_uid == os.getuid():
        place.chmod(0o700)
    return "everybody can write there" if place.stat().st_mode & 0o022 else ""


@cache
def _instead_of(place: Path, why: str) -> Path:
    """A folder for this process and its children, once for all that it keeps."""
    try:
        instead = Path(tempfile.mkdtemp(prefix="wheelchair-cache-"))
        atexit.register(shutil.rmtree, instead, ignore_errors=True)
        (instead / "compiled").mkdir(mode=0o700)
    except OSError as error:
        raise BuildError(
            f"{place}: {why}; and nothing can be written to {tempfile.gettempdir()} either; set WHEELCHAIR_CACHE "
            "to a folder of your own"
        ) from error
    os.environ["WHEELCHAIR_CACHE"] = str(instead)
    log.warning(
        "%s: %s; what is compiled is kept until this command ends; set WHEELCHAIR_CACHE to a folder of your own", place, why
    )
    return instead / "compiled"


@cache
def _sweep(place: Path) -> None:
    """Remove what processes that were ended have left."""
    for work in place.glob(f"{MAKING}*"):
        try:
            changed = max(f.stat().st_mtime for f in (work, *work.rglob("*")))
        except FileNotFoundError:  # it is just being finished
            continue
        if time.time() - changed > ABANDONED and not _alive(work.name.removeprefix(MAKING).partition("-")[0]):
            shutil.rmtree(work, ignore_errors=True)


def _alive(process: str) -> bool:
    if os.name == "nt":  # where this question would end it; files in use cannot be removed there anyway
        return False
    try:
        os.kill(int(process), 0)
    except ProcessLookupError:
        return False
    except PermissionError:  # somebody else's, so not the one that made it
        return False
    return True
