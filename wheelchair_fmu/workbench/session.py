"""One piece of work as a folder: measurements, effects of one's own, the variants so far, what was found.

::

    campaign/campaign.toml, *.csv    what was dropped, and how its columns are read
    effects/*.py                     effects written in the page
    variants/N.toml                  one for each step; history.json says which, and where undo has gone
    campaigns/*.toml                 campaign.toml as it was at each step
    taken-out/                       recordings that were taken out, for undo
    guesses.json                     what the last import only guessed, to be looked at
    diagnosis.json, report.html      of the last diagnosis; diagnosed.json says of which variant and campaign.toml
"""

from __future__ import annotations

import json
import os
import re
import shutil
import time
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from hashlib import sha256
from pathlib import Path, PurePosixPath
from typing import Any, BinaryIO
from uuid import uuid4

import numpy as np

from ..campaign import CHANNELS, INPUTS, Judged, judged, read
from ..campaign.binding import split
from ..campaign.channels import BY_NAME, MOUNTED, TIME
from ..campaign.formats import open_recording
from ..campaign.layout import relaid
from ..contracts.own import checked, text_of, variant_in
from ..contracts.trust import remember
from ..errors import CampaignError, EffectError, Failure, ModelError, UsageError, unknown
from ..model.choice import KINDS, names, serves
from ..model.effects import bundled, sources
from ..model.stage import Effect
from ..model.variant import Variant, programs_in, variant_text
from ..resources import EXAMPLES
from ..writing import written
from . import guesses
from .bodies import refuse_unusual, too_deep
from .carrying import carried
from .faults import told
from .history import broken, recovered
from .intake import MOST_BYTES, SUFFIXES, refuse_bomb, safe_path

MANOEUVRES = ("coast-down", "slalom", "straight", "steady", "random", "strokes", "spin")
KEPT = 90  # days for which work is kept after it was last looked at
SCRATCH = 1  # the same, for what holds no recordings
DAY = 86400.0  # s
NAME = re.compile(r"[0-9a-f]{12}")
SAMPLE = "sample-campaign"
UNNAMED, LONGEST_NAME = "campaign", 120  # of a campaign
READ_ANEW = "files read anew"  # label of an import
THUMB = 120  # values of a signal that is drawn beside its column
FIRST_HOLDOUT = "holdout"  # a file whose name says so is held out


class Session:
    """The folder `root / id`. Everything is read from and written to it at once; nothing is kept in memory."""

    def __init__(self, root: Path, id: str):
        if not NAME.fullmatch(id):
            raise UsageError(f"{id!r} is no session; open the workbench's first page")
        self.id, self.folder = id, root / id
        self.campaign, self.effects, self.variants, self.campaigns, self.aside = (
            self.folder / n for n in ("campaign", "effects", "variants", "campaigns", "taken-out")
        )

    @classmethod
    def begin(cls, root: Path, campaign: Path | None = None) -> Session:
        """A new session, with a copy of `campaign` where one is given."""
        session = cls(root, uuid4().hex[:12])
        for folder in (session.folder, session.campaign, session.effects, session.variants, session.campaigns):
            folder.mkdir(mode=0o700, parents=True)
        session.keep(Variant(), "nominal")
        if campaign:
            session._copy(campaign)
        session.draft()
        return session

    def _copy(self, campaign: Path) -> None:
        for file in sorted(campaign.rglob("*")):
            if file.is_file() and file.suffix.lower() in SUFFIXES:
                with file.open("rb") as content:
                    self.put(file.relative_to(campaign).as_posix(), content)

    def try_sample(self) -> None:
        """Take in the sample campaign. Raises UsageError where there are recordings already."""
        if self.files():
            raise UsageError("there are recordings here already; begin new work, and try the sample there")
        self._copy(EXAMPLES / SAMPLE)

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
        about = (self.content() or {}).get("campaign")
        name = about.get("name") if isinstance(about, Mapping) else None
        return "".join(c for c in name if c.isprintable()) if isinstance(name, str) else UNNAMED

    @property
    def label(self) -> str:
        """By what one knows it again: its name, or else its first file."""
        files = self.files()
        if self.name != UNNAMED or not files:
            return self.name
        return f"{files[0]} and {len(files) - 1} more" if len(files) > 1 else files[0]

    @property
    def there(self) -> bool:
        return self.folder.is_dir()

    # -- measurements ---------------------------------------------------------------------------------------

    def put(self, name: str, content: BinaryIO, most: int = MOST_BYTES) -> None:
        """Take in a file of the campaign. Raises UsageError for one that cannot belong to it."""
        path = self.campaign / safe_path(name)
        if path.suffix.lower() == ".gz":
            refuse_bomb(content, name, most)
            content.seek(0)
        try:
            with written(path) as beside, beside.open("wb") as file:
                beside.chmod(0o600)
                shutil.copyfileobj(content, file)
        except OSError as error:
            raise UsageError(f"{name!r} cannot be kept: {error.strerror}") from None

    def draft(self, name: str = "") -> None:
        """A run for each recording that has none yet; columns as their headers say, where they do; `name`, of the folder that
        they come from, where the campaign has none.

        Where campaign.toml is no TOML, or has something else in the place of a table, its fault is shown, and nothing is
        written over it.
        """
        content = self.content()
        if content is None or not isinstance(content.setdefault("campaign", {}), dict):
            return
        if name.isprintable() and name and content["campaign"].get("name") in (None, UNNAMED):
            content["campaign"]["name"] = name[:LONGEST_NAME]
        content["campaign"].setdefault("name", UNNAMED)
        content["campaign"].setdefault("axes", "SAE-J670")
        runs, columns = content.setdefault("run", []), content.setdefault("columns", {})
        if not isinstance(runs, list) or not isinstance(columns, dict):
            return
        content["run"] = self._every_run(runs)
        devices = [run for run in content["run"] if isinstance(run, Mapping) and isinstance(run.get("files"), Mapping)]
        of_devices = {name for run in devices for name in _files_of(run)}
        for header, files in self.headers().items():
            channel = _guess(header) if set(files) - of_devices else None
            if channel and channel != split(header)[0] and channel not in columns:
                columns[channel] = {"column": header}
        if not columns:
            content.pop("columns")
        self.write_content(content)

    def _every_run(self, runs: list[Any]) -> list[Any]:
        """These, and one for each recording that has none yet."""
        named = {name for run in runs for name in _files_of(run)}
        return [*runs, *(_run(name) for name in self.files() if name not in named)]

    def files(self) -> list[str]:
        """Recordings, by their names as campaign.toml writes them."""
        every = (p for p in self.campaign.rglob("*") if p.is_file() and p.suffix.lower() in SUFFIXES)
        return sorted(p.relative_to(self.campaign).as_posix() for p in every if p.suffix != ".toml")

    def headers(self) -> dict[str, list[str]]:
        """Every header there is, with the files that have it."""
        return {header: column["files"] for header, column in self.columns().items()}

    def columns(self) -> dict[str, dict[str, Any]]:
        """Every header there is, with the `files` that have it, and its `signals`, in the first of them and in the first of
        each device: few values, null in gaps, so that a sign or a unit that is wrong can be seen, empty where there are no
        numbers; and whether the files call it their `time`."""
        found: dict[str, dict[str, Any]] = {}
        firsts = self._first_of_devices()
        for name in self.files():
            table, _ = open_recording(self.campaign / name, name, {})
            if table is None:
                continue
            for i, header in enumerate(table.headers):
                if not header:
                    continue
                column = found.setdefault(header, {"files": [], "signals": {}, "time": table.time == i})
                if name in firsts or not column["signals"]:
                    column["signals"][name] = _thinned(table.rows([i]).values[i])
                column["files"].append(name)
        return found

    def _first_of_devices(self) -> set[str]:
        """The first recording of each device that campaign.toml knows."""
        runs, first = (self.content() or {}).get("run"), dict[str, str]()
        for run in runs if isinstance(runs, list) else ():
            files = run.get("files") if isinstance(run, dict) else None
            for device, file in files.items() if isinstance(files, dict) else ():
                first.setdefault(device, str(file))
        return set(first.values())

    def content(self) -> dict[str, Any] | None:
        """campaign.toml as data; None where it is no TOML, or nothing that anybody writes; {} where there is none."""
        content, _ = self._toml()
        return content

    def _toml(self) -> tuple[dict[str, Any] | None, str]:
        """campaign.toml, and where the fault is none that `check` tells, what it is."""
        file = self.campaign / "campaign.toml"
        try:
            content = tomllib.loads(file.read_text(encoding="utf-8-sig")) if file.exists() else {}
            refuse_unusual(content, "campaign.toml")
        except (tomllib.TOMLDecodeError, UnicodeDecodeError):
            return None, ""
        except RecursionError:
            return None, str(too_deep("campaign.toml"))
        except (ValueError, UsageError) as error:  # Python's, for an integer of thousands of digits
            return None, f"campaign.toml: {error}" if isinstance(error, ValueError) else str(error)
        return content, ""

    def write_content(self, content: Mapping[str, Any]) -> None:
        """Change campaign.toml to this; comments and layout stay. Raises UsageError for what TOML cannot hold."""
        file = self.campaign / "campaign.toml"
        text = file.read_bytes().decode("utf-8-sig") if self.content() else ""
        try:
            write(file, relaid(text, content).encode())
        except (TypeError, ValueError) as error:
            raise UsageError(f"campaign.toml cannot hold this: {error}") from None

    def without(self, keep: Callable[[Any], bool]) -> None:
        """Leave out the runs of campaign.toml of which a file is not to be kept."""
        content = self.content()
        if content and isinstance(content.get("run"), list):
            runs = [r for r in content["run"] if not isinstance(r, Mapping) or _kept(r, keep)]
            self.write_content({**content, "run": runs})

    def drop(self, name: str) -> str:
        """Take a recording out, which undo brings back, and say so. Raises UsageError for one that is not there."""
        if name not in self.files():
            raise unknown("file", name, self.files())
        steps = self._steps_so_far()
        self._move(name, self.campaign, self.aside)
        self.without(lambda file: file != name)
        if steps:
            self._append(steps, f"{name} taken out", self.variant_file.name, None, name)
        return f"{name} was taken out; undo brings it back."

    def _move(self, name: str, source: Path, target: Path) -> None:
        """A recording from one folder into another, where it is there."""
        there = target / safe_path(name)
        if (source / name).is_file():
            there.parent.mkdir(parents=True, exist_ok=True)
            (source / name).replace(there)

    def judged(self, known: Mapping[str, tuple[float, float]]) -> tuple[list[dict[str, Any]], dict[str, float]]:
        """What is wrong with the recordings and with the session itself; standard deviations of the noise in SI, as stated or
        as estimated, where nothing is wrong with the recordings."""
        strange = self._toml()[1]
        own = [text for text in (*self.own_faults(), broken(self.folder), strange) if text]
        found: list[dict[str, Any]] = [{"text": text, "what": text, "where": "", "severity": "error"} for text in own]
        content = self.content()
        if strange or (content is not None and not self.files() and not content.get("run")):  # nothing was given yet
            return found, {}
        seen = self.seen(known)
        campaign, faults = seen.campaign, seen.faults
        found += map(told, faults)
        found += guesses.standing(self.folder, content or {})
        return found, campaign.noise if campaign else {}

    def seen(self, known: Mapping[str, tuple[float, float]]) -> Judged:
        """The recordings as they are read, with all that is wrong with them."""
        return judged(self.campaign, dict(known))

    # -- effects and variants -------------------------------------------------------------------------------

    def own_effects(self) -> dict[str, Effect]:
        """Those whose files can be read; `own_faults` tells of the others."""
        return {id: effect for id, effect in self._own().items() if isinstance(effect, Effect)}

    def own_faults(self) -> list[str]:
        return [effect for effect in self._own().values() if isinstance(effect, str)]

    def _own(self) -> dict[str, Effect | str]:
        """By the name of its file, each effect, or why it is none."""
        found: dict[str, Effect | str] = {}
        try:
            files = sources(self.effects) if self.effects.is_dir() else ()
        except ModelError as error:
            return {"": f"{error}; mend or remove the file"}
        for file, content in files:
            try:
                found |= checked(((file, content),))
            except (EffectError, ModelError) as error:
                found[Path(file).stem] = f"{error}; mend or remove the file"
        return found

    def write_effect(self, id: str, source: str) -> str:
        """Put an effect into the catalogue, once its file is known to define it; says which one it takes the place of. Raises
        EffectError where it defines none."""
        file, before = self.effects / f"{id}.py", self.own_effects().get(id)
        checked(((str(file), source.encode()),))
        write(file, source.encode())
        return f"This replaces your effect {id}, “{before.title}”." if before else ""

    def catalogue(self) -> dict[str, Effect]:
        return {**bundled(), **self.own_effects()}

    def history(self) -> dict[str, Any]:
        """{"at": place, "steps": [{"label", "file", "ladder", "campaign"}]}, some with the recording that was "taken" out; what
        variants there are, where it is broken."""
        return recovered(self.folder)

    def keep(self, variant: Variant | Path, label: str, ladder: Any = None) -> None:
        """One step more; what had been undone is forgotten."""
        steps = self._steps_so_far()
        file = self.variants / f"{len(steps)}-{uuid4().hex[:6]}.toml"
        text = text_of(variant) if isinstance(variant, Variant) else variant.read_text(encoding="utf-8")
        write(file, text.encode())
        self._append(steps, label, file.name, ladder)

    def edit(self, content: Mapping[str, Any], said: str = "") -> None:
        """Another campaign.toml: one step more, with the same variant, where anything is different; `said` is that in words.

        Recordings that came while it was written, so that it does not know them, are added to its runs.
        """
        variant = self.variant_file.name
        content = {**content, "run": self._every_run(content["run"])} if isinstance(content.get("run"), list) else content
        steps, before = self._steps_so_far(), self.content() or {}
        self.write_content(content)
        if label := _difference(before, content):
            self._append(steps, said[:LONGEST_NAME] if said.isprintable() and said else label, variant, None)

    def go(self, by: int) -> None:
        """Undo (−1) or redo (1)."""
        history = self.history()
        at, steps = history["at"] + by, history["steps"]
        if not 0 <= at < len(steps):
            raise UsageError("there is nothing to undo" if by < 0 else "there is nothing to redo")
        steps[history["at"]]["campaign"] = self._snapshot()
        if taken := steps[max(at, history["at"])].get("taken"):
            folders = (self.aside, self.campaign) if by < 0 else (self.campaign, self.aside)
            self._move(str(taken), *folders)
        if steps[at].get("campaign") and (self.campaigns / steps[at]["campaign"]).is_file():
            self._restore(self.campaigns / steps[at]["campaign"])
        self._write_history(at, steps)

    def note_campaign(self) -> None:
        """Keep campaign.toml as it is now, because something else is about to write it."""
        steps = self._steps_so_far()
        self._write_history(len(steps) - 1, steps)

    def read_anew(self, name: str, unsure: Iterable[Mapping[str, Any]] = ()) -> None:
        """One step more, with a campaign.toml that an import has written, which keeps the campaign's `name`, and what was
        written by hand since an earlier import; what it was `unsure` of is remembered."""
        content = self.content()
        if content and isinstance(content.get("campaign"), dict):
            content = {**content, "campaign": {**content["campaign"], "name": name}}
            self.write_content(carried(self._since_an_import(), content))
        guesses.remember(self.folder, self.content() or {}, unsure)
        history = self.history()
        steps = history["steps"][: history["at"] + 1]
        self._append(steps, READ_ANEW, self.variant_file.name, None)

    def _since_an_import(self) -> dict[str, Any]:
        """campaign.toml as it was before the import that is just done, where an earlier one had written it."""
        history = self.history()
        steps = history["steps"][: history["at"] + 1]
        kept = str(steps[-1].get("campaign")) if steps else ""
        if not any(step["label"] == READ_ANEW for step in steps) or not (self.campaigns / kept).is_file():
            return {}
        return tomllib.loads((self.campaigns / kept).read_text(encoding="utf-8-sig"))

    def at_hand(self) -> list[str | None]:
        """Which model and which campaign.toml there are now, by their names."""
        file = self.campaign / "campaign.toml"
        return [self.variant_file.name, _named(file.read_bytes()) if file.exists() else None]

    def note_diagnosed(self, what: list[str | None]) -> None:
        """The last diagnosis is of the model and the campaign that `at_hand` told when it began."""
        write(self.folder / "diagnosed.json", json.dumps(what).encode())

    @property
    def diagnosed(self) -> bool:
        """Is the last diagnosis of the model and the campaign as they are?"""
        try:
            return bool(json.loads((self.folder / "diagnosed.json").read_text(encoding="utf-8")) == self.at_hand())
        except (OSError, ValueError, Failure):
            return False

    def _steps_so_far(self) -> list[dict[str, Any]]:
        """Steps up to now, the last with the campaign as it is: recordings may have come since."""
        history = self.history()
        steps: list[dict[str, Any]] = history["steps"][: history["at"] + 1]
        if steps:
            steps[-1]["campaign"] = self._snapshot()
        return steps

    def _append(self, steps: list[dict[str, Any]], label: str, file: str, ladder: Any, taken: str | None = None) -> None:
        step = {"label": label, "file": file, "ladder": ladder, "campaign": self._snapshot()}
        steps.append(step if taken is None else {**step, "taken": taken})
        self._write_history(len(steps) - 1, steps)

    def _snapshot(self) -> str | None:
        """campaign.toml as it is now, under a name of its content's; None where there is none."""
        file = self.campaign / "campaign.toml"
        if not file.exists():
            return None
        content = file.read_bytes()
        kept = self.campaigns / _named(content)
        if not kept.exists():
            write(kept, content)
        return kept.name

    def _restore(self, kept: Path) -> None:
        """campaign.toml as it was, for the recordings that there are."""
        file = self.campaign / "campaign.toml"
        if file.exists() and file.read_bytes() == kept.read_bytes():
            return
        write(file, kept.read_bytes())
        there = self.files()  # a list: what campaign.toml names may be anything
        self.without(lambda file: file in there)
        self.draft()

    def _write_history(self, at: int, steps: list[dict[str, Any]]) -> None:
        write(self.folder / "history.json", json.dumps({"at": at, "steps": steps}).encode())

    @property
    def variant_file(self) -> Path:
        """The variant at hand. Raises Failure where every one is gone."""
        history = self.history()
        if not history["steps"]:
            raise Failure("this session has no variants left; start new work, and drop its recordings there")
        return self.variants / str(history["steps"][history["at"]]["file"])

    def variant(self) -> Variant:
        return variant_in(self.variant_file, self.catalogue(), trust=True)  # which this session has written

    def trust_variant(self) -> None:
        """What this session has written may run in its jobs, also where the user's cache was emptied since."""
        with suppress(OSError):  # then the job says it
            remember(programs_in(self.variant_file).values())

    def variant_text(self) -> str:
        return self.variant_file.read_text(encoding="utf-8") if self.history()["steps"] else variant_text(Variant())

    def laws(self) -> dict[str, str]:
        """The laws of the model at hand, by what each is for, as its file has them; the usual ones where it names none, or is
        gone."""
        usual = {kind: str(getattr(Variant().choice, kind)) for kind in KINDS}
        with suppress(OSError, ValueError, Failure):
            named = tomllib.loads(self.variant_text()).get("laws")
            given = named if isinstance(named, Mapping) else {}
            return {kind: str(given.get(kind, law)) for kind, law in usual.items()}
        return usual

    def choose(self, kind: str, name: str) -> None:
        """One step more, by another law. Raises UsageError for an unknown one, and for one by which an effect of this model
        cannot act."""
        before = self.variant()
        if kind not in KINDS:
            raise unknown("kind of law", kind[:40], KINDS)
        if name not in names(before.choice)[kind]:
            raise unknown(f"{kind} law", name[:40], names(before.choice)[kind])
        if name != getattr(before.choice, kind):
            self.keep(_by_law(before, kind, name), f"{kind} law {name}".replace("_", " "))

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


def _by_law(chair: Variant, kind: str, name: str) -> Variant:
    """The chair by another law, without the values that only the law before had."""
    after = replace(chair, choice=chair.choice.with_laws({kind: name}))
    for effect in after.active():
        for of, needed in effect.needs.items():
            if not serves(after.choice, of, needed):
                raise UsageError(f"“{effect.title}” is in this model and needs the {of} law {needed}")
    there = {p.name for p in after.parameters()}
    return replace(after, values={n: v for n, v in chair.values.items() if n in there})


def _thinned(values: np.ndarray) -> list[float | None]:
    step = max(1, len(values) // THUMB)
    return [float(f"{v:.4g}") if np.isfinite(v) else None for v in values[::step]] if np.isfinite(values).any() else []


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
    """Beside its place, then renamed; for its owner alone."""
    with written(path) as beside:
        beside.touch(mode=0o600)
        beside.write_bytes(content)


def _named(content: bytes) -> str:
    return f"{sha256(content).hexdigest()[:16]}.toml"


def _kept(run: Mapping[str, Any], keep: Callable[[Any], bool]) -> bool:
    files = _files_of(run)
    return all(map(keep, files)) if files else keep(run.get("file"))


def _files_of(run: Any) -> list[str]:
    """The recordings of a run, of one device or of several."""
    if not isinstance(run, Mapping):
        return []
    several = run.get("files")
    names = several.values() if isinstance(several, Mapping) else [run.get("file")]
    return [name for name in names if isinstance(name, str)]


def _run(name: str) -> dict[str, Any]:
    stem = PurePosixPath(name).name.partition(".")[0]
    manoeuvre = next((m for m in MANOEUVRES if m in stem.lower()), stem)
    return {"file": name, "manoeuvre": manoeuvre, "role": "holdout" if FIRST_HOLDOUT in stem.lower() else "fit"}


def _guess(header: str) -> str | None:
    """The channel whose name is the header's but for case, spaces and dots."""
    plain = re.sub(r"[^a-z0-9]+", "_", split(header)[0].lower()).strip("_")
    names = {c.lower(): c for c in (TIME.name, *BY_NAME)}
    return names.get(plain) or {"t": "time", "gyro_z": "yaw_rate", "yawrate": "yaw_rate", "ax": "a_x", "ay": "a_y"}.get(plain)


def channel_list() -> list[dict[str, Any]]:
    """What a column may be."""
    every, placed = (TIME, *INPUTS, *CHANNELS), {name for names in MOUNTED.values() for name in names}
    return [
        {
            "name": c.name,
            "unit": c.unit.name,
            "meaning": c.meaning,
            "mirrored": c.iso_sign < 0,
            "placed": c.name in placed,  # where it is read makes a difference
        }
        for c in every
    ]
