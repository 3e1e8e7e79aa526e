"""One piece of work as a folder: measurements, effects of one's own, the variants so far, what was found.

::

    campaign/campaign.toml, *.csv    what was dropped, and how its columns are read
    effects/*.py                     effects written in the page
    variants/N.toml                  one for each step; history.json says which, and where undo has gone
    campaigns/*.toml                 campaign.toml as it was at each step
    diagnosis.json, report.html      of the last diagnosis
"""

from __future__ import annotations

import json
import os
import re
import shutil
import time
import tomllib
from collections.abc import Iterator, Mapping
from hashlib import sha256
from pathlib import Path, PurePosixPath
from typing import Any
from uuid import uuid4

from ..campaign import CHANNELS, INPUTS, check, read
from ..campaign.binding import split
from ..campaign.channels import BY_NAME, TIME
from ..campaign.formats import bundled as bundled_formats
from ..campaign.formats import open_recording
from ..campaign.layout import relaid
from ..contracts.own import load
from ..errors import CampaignError, Failure, UsageError
from ..model.effects import bundled
from ..model.stage import Effect
from ..model.variant import Variant, read_variant, variant_text
from ..writing import written

SUFFIXES = (".toml", ".gz", *sorted({suffix for record in bundled_formats().values() for suffix in record.suffixes}))
MOST_BYTES = 200_000_000  # of one file
MANOEUVRES = ("coast-down", "slalom", "straight", "steady", "random", "strokes", "spin")
KEPT = 90  # days for which work is kept after it was last looked at
SCRATCH = 1  # the same, for what holds no recordings
DAY = 86400.0  # s
NAME = re.compile(r"[0-9a-f]{12}")
FIRST_HOLDOUT = "holdout"  # a file whose name says so is held out


class Session:
    """The folder `root / id`. Everything is read from and written to it at once; nothing is kept in memory."""

    def __init__(self, root: Path, id: str):
        if not NAME.fullmatch(id):
            raise UsageError(f"{id!r} is no session; open the workbench's first page")
        self.id, self.folder = id, root / id
        self.campaign, self.effects, self.variants, self.campaigns = (
            self.folder / n for n in ("campaign", "effects", "variants", "campaigns"))  # fmt: skip

    @classmethod
    def begin(cls, root: Path, campaign: Path | None = None) -> Session:
        """A new session, with a copy of `campaign` where one is given."""
        session = cls(root, uuid4().hex[:12])
        for folder in (session.campaign, session.effects, session.variants):
            folder.mkdir(parents=True)
        session.keep(Variant(), "nominal")
        for file in sorted(campaign.rglob("*")) if campaign else ():
            if campaign and file.is_file() and file.suffix.lower() in SUFFIXES:
                session.put(file.relative_to(campaign).as_posix(), file.read_bytes())
        session.draft()
        return session

    @classmethod
    def latest(cls, root: Path, most: int) -> list[Session]:
        """Sessions that hold recordings, the last looked at first."""
        newest = sorted(cls.every(root), key=lambda s: s.looked_at, reverse=True)
        return [s for s in newest[: 4 * most] if s.files()][:most]

    @classmethod
    def every(cls, root: Path) -> list[Session]:
        return [cls(root, p.name) for p in root.iterdir() if NAME.fullmatch(p.name) and (p / "history.json").is_file()]

    @property
    def looked_at(self) -> float:
        """When somebody last had it open, in seconds since 1970."""
        return self.folder.stat().st_mtime

    def touch(self) -> None:
        os.utime(self.folder)

    @property
    def name(self) -> str:
        name = (self.content() or {}).get("campaign", {}).get("name")
        return name if isinstance(name, str) else "campaign"

    @property
    def there(self) -> bool:
        return self.folder.is_dir()

    # -- measurements ---------------------------------------------------------------------------------------

    def put(self, name: str, content: bytes) -> None:
        """Take in a file of the campaign. Raises UsageError for one that cannot belong to it."""
        path = PurePosixPath(name.replace("\\", "/"))
        if path.is_absolute() or ".." in path.parts or not path.name or path.name.startswith("."):
            raise UsageError(f"{name!r} is no name for a file of a campaign; give a plain name")
        if path.suffix.lower() not in SUFFIXES:
            raise UsageError(f"{name}: {path.suffix or 'no ending'} is no recording; give one of {', '.join(SUFFIXES)}")
        if len(content) > MOST_BYTES:
            raise UsageError(f"{name}: {len(content) / 1e6:.0f} MB is too much for the workbench; use `wheelchair diagnose`")
        write(self.campaign / path, content)

    def draft(self) -> None:
        """A run for each recording that has none yet; columns as their headers say, where they do."""
        content = self.content()
        if content is None:
            return  # what is there is no TOML: its fault is shown, and nothing is written over it
        content.setdefault("campaign", {}).setdefault("name", "campaign")
        content["campaign"].setdefault("axes", "SAE-J670")
        runs = content.setdefault("run", [])
        named = {run.get("file") for run in runs if isinstance(run, Mapping)} if isinstance(runs, list) else None
        if named is None:
            return
        for name in self.files():
            if name not in named:
                runs.append(_run(name))
        for header in self.headers():
            channel = _guess(header)
            columns = content.setdefault("columns", {})
            if channel and channel != split(header)[0] and channel not in columns and isinstance(columns, dict):
                columns[channel] = {"column": header}
        if not content.get("columns"):
            content.pop("columns", None)
        self.write_content(content)

    def files(self) -> list[str]:
        """Recordings, by their names as campaign.toml writes them."""
        every = (p for p in self.campaign.rglob("*") if p.is_file() and p.suffix.lower() in SUFFIXES)
        return sorted(p.relative_to(self.campaign).as_posix() for p in every if p.suffix != ".toml")

    def headers(self) -> dict[str, list[str]]:
        """Every header there is, with the files that have it."""
        found: dict[str, list[str]] = {}
        for name in self.files():
            table, _ = open_recording(self.campaign / name, name, {})
            for header in table.headers if table else ():
                if header:
                    found.setdefault(header, []).append(name)
        return found

    def content(self) -> dict[str, Any] | None:
        """campaign.toml as data; None where it is no TOML, {} where there is none."""
        file = self.campaign / "campaign.toml"
        try:
            return tomllib.loads(file.read_text(encoding="utf-8-sig")) if file.exists() else {}
        except (tomllib.TOMLDecodeError, UnicodeDecodeError):
            return None

    def write_content(self, content: Mapping[str, Any]) -> None:
        """Change campaign.toml to this; comments and layout stay. Raises UsageError for what TOML cannot hold."""
        file = self.campaign / "campaign.toml"
        text = file.read_bytes().decode("utf-8-sig") if self.content() else ""
        try:
            write(file, relaid(text, content).encode())
        except TypeError as error:
            raise UsageError(f"campaign.toml cannot hold this: {error}") from None

    def faults(self, known: Mapping[str, tuple[float, float]]) -> list[dict[str, Any]]:
        if not self.files() and not (self.campaign / "campaign.toml").exists():
            return []
        return [{"text": str(f), "severity": f.severity} for f in check(self.campaign, dict(known))]

    # -- effects and variants -------------------------------------------------------------------------------

    def own_effects(self) -> dict[str, Effect]:
        return load(self.effects)

    def catalogue(self) -> dict[str, Effect]:
        return {**bundled(), **self.own_effects()}

    def history(self) -> dict[str, Any]:
        """{"at": place, "steps": [{"label", "file", "ladder", "campaign"}]}"""
        file = self.folder / "history.json"
        return json.loads(file.read_text()) if file.exists() else {"at": -1, "steps": []}  # type: ignore[no-any-return]

    def keep(self, variant: Variant | Path, label: str, ladder: Any = None) -> None:
        """One step more; what had been undone is forgotten."""
        steps = self._steps_so_far()
        file = self.variants / f"{len(steps)}-{uuid4().hex[:6]}.toml"
        text = variant_text(variant) if isinstance(variant, Variant) else variant.read_text(encoding="utf-8")
        write(file, text.encode())
        self._append(steps, label, file.name, ladder)

    def edit(self, content: Mapping[str, Any]) -> None:
        """Another campaign.toml: one step more, with the same variant, where anything is different."""
        steps, before = self._steps_so_far(), self.content() or {}
        self.write_content(content)
        if label := _difference(before, content):
            self._append(steps, label, steps[-1]["file"], None)

    def go(self, by: int) -> None:
        """Undo (−1) or redo (1)."""
        history = self.history()
        at, steps = history["at"] + by, history["steps"]
        if not 0 <= at < len(steps):
            raise UsageError("there is nothing to undo" if by < 0 else "there is nothing to redo")
        steps[history["at"]]["campaign"] = self._snapshot()
        if steps[at].get("campaign"):
            self._restore(self.campaigns / steps[at]["campaign"])
        self._write_history(at, steps)

    def _steps_so_far(self) -> list[dict[str, Any]]:
        """Steps up to now, the last with the campaign as it is: recordings may have come since."""
        history = self.history()
        steps: list[dict[str, Any]] = history["steps"][: history["at"] + 1]
        if steps:
            steps[-1]["campaign"] = self._snapshot()
        return steps

    def _append(self, steps: list[dict[str, Any]], label: str, file: str, ladder: Any) -> None:
        steps.append({"label": label, "file": file, "ladder": ladder, "campaign": self._snapshot()})
        self._write_history(len(steps) - 1, steps)

    def _snapshot(self) -> str | None:
        """campaign.toml as it is now, under a name of its content's; None where there is none."""
        file = self.campaign / "campaign.toml"
        if not file.exists():
            return None
        content = file.read_bytes()
        kept = self.campaigns / f"{sha256(content).hexdigest()[:16]}.toml"
        if not kept.exists():
            write(kept, content)
        return kept.name

    def _restore(self, kept: Path) -> None:
        """campaign.toml as it was, for the recordings that there are."""
        file = self.campaign / "campaign.toml"
        if file.exists() and file.read_bytes() == kept.read_bytes():
            return
        write(file, kept.read_bytes())
        content = self.content()
        if content and isinstance(content.get("run"), list):
            there = set(self.files())
            self.write_content({**content, "run": [r for r in content["run"] if r.get("file") in there]})
        self.draft()

    def _write_history(self, at: int, steps: list[dict[str, Any]]) -> None:
        write(self.folder / "history.json", json.dumps({"at": at, "steps": steps}).encode())

    @property
    def variant_file(self) -> Path:
        history = self.history()
        return self.variants / str(history["steps"][history["at"]]["file"])

    def variant(self) -> Variant:
        return read_variant(self.variant_file, self.catalogue())

    def noise(self) -> dict[str, float]:
        """Standard deviations in SI as the campaign has them, stated or estimated; none where it has faults."""
        try:
            return read(self.campaign).noise
        except CampaignError:
            return {}

    def known(self) -> dict[str, float]:
        """What the campaign file says of the chair. Raises Failure where the campaign has faults."""
        try:
            return read(self.campaign).known
        except CampaignError as error:
            raise Failure(f"the campaign has faults: {error}") from None


def prune(root: Path, days: float = KEPT) -> list[str]:
    """Remove work that nobody has looked at for so many `days`, and after a day what holds no recordings.

    Returns the names of what held some. A folder that the system will not remove stays until the next time.
    """
    gone = []
    for session in Session.every(root):
        age, name = (time.time() - session.looked_at) / DAY, session.name if session.files() else None
        if age > (days if name else min(days, SCRATCH)):
            shutil.rmtree(session.folder, ignore_errors=True)
            if name and not session.there:
                gone.append(name)
    return gone


def _difference(before: Mapping[str, Any], after: Mapping[str, Any]) -> str:
    """What an edit did, in words: "noise.yaw_rate = 0.2 deg/s"; nothing where nothing changed."""
    old, new = dict(_flat(before)), dict(_flat(after))
    keys = [k for k in {**old, **new} if old.get(k) != new.get(k)]
    if not keys:
        return ""
    said = f"{keys[0]} = {new[keys[0]]}" if keys[0] in new else f"{keys[0]} taken out"
    return said if len(keys) == 1 else f"{said}, and {len(keys) - 1} more"


def _flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """(dotted place, value) of everything in a campaign; runs by their files."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _flat(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from _flat(inner, str(inner.get("file", i)) if isinstance(inner, Mapping) else f"{path} {i + 1}")
    else:
        yield path, value


def write(path: Path, content: bytes) -> None:
    """Beside its place, then renamed."""
    with written(path) as beside:
        beside.write_bytes(content)


def _run(name: str) -> dict[str, Any]:
    stem = PurePosixPath(name).name.partition(".")[0]
    manoeuvre = next((m for m in MANOEUVRES if m in stem.lower()), stem)
    return {"file": name, "manoeuvre": manoeuvre, "role": "holdout" if FIRST_HOLDOUT in stem.lower() else "fit"}


def _guess(header: str) -> str | None:
    """The channel whose name is the header's but for case, spaces and dots."""
    plain = re.sub(r"[^a-z0-9]+", "_", split(header)[0].lower()).strip("_")
    names = {c.lower(): c for c in (TIME.name, *BY_NAME)}
    return names.get(plain) or {"t": "time", "gyro_z": "yaw_rate", "yawrate": "yaw_rate", "ax": "a_x", "ay": "a_y"}.get(plain)


def channel_list() -> list[dict[str, str]]:
    """What a column may be."""
    return [{"name": c.name, "unit": c.unit.name, "meaning": c.meaning} for c in (TIME, *INPUTS, *CHANNELS)]
