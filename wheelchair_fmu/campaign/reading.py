"""From a folder to a Campaign, or to all the faults that stand in the way."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..errors import CampaignError
from ..faults import ERROR, SHOWN, Fault, once
from ..given import what_is
from ..model.chassis import DEFAULTS
from ..model.former import renamed
from .axes import SAE
from .channels import BY_NAME, CHANNEL_NAMES, MOUNTED, PUSH_NAMES
from .checks import CAMPAIGN_CHECKS, CLOCK_CHECKS, DOCUMENT_CHECKS, FILE_CHECKS, HEADING_CHECKS, RUN_CHECKS, Assembly
from .checks.document import Known, crowded, parameter_tables
from .checks.sides import exchanged
from .checks.turned import pushes_turned
from .devices import Part, parts, point_of
from .document import FILE, Document, Entry, flatten, load, numbers
from .draft import Draft, prepare
from .noise import gather
from .recorded import Recorded
from .records import Campaign, Run
from .rims import Rim, corrected, rims, unasked, unfounded
from .strokes import with_strokes
from .windows import between, covered


def read(path: str | Path, known_parameters: Known | None = None) -> Campaign:
    """The campaign in a folder (or of a campaign.toml).

    `known_parameters` maps dotted names to (lower, upper) in SI; with it, unknown and impossible parameters are
    found too. Raises CampaignError with every error that `check` finds; warnings are in the campaign, but for those that only
    `check` looks for.
    """
    assembly, faults = _assess(path, known_parameters)
    errors = [fault for fault in faults if fault.severity == ERROR]
    if assembly is None or errors:
        raise CampaignError(errors)
    return _campaign(assembly, known_parameters, tuple(faults))


@dataclass(frozen=True, eq=False)
class Judged:
    """The campaign, None where it has errors; every run that can be read, as its devices recorded it; and every fault."""

    campaign: Campaign | None
    runs: tuple[Recorded, ...]
    faults: list[Fault]


def judged(path: str | Path, known_parameters: Known | None = None) -> Judged:
    """What `read` and `check` say of a campaign; recordings are read once."""
    assembly, faults = _assess(path, known_parameters)
    if assembly is None:
        return Judged(None, (), faults)
    wrong = any(fault.severity == ERROR for fault in faults)
    campaign = None if wrong else _campaign(assembly, known_parameters, tuple(faults))
    every = [*exchanged(assembly.runs), *pushes_turned(assembly.runs), *faults, *unasked(assembly.runs, _asked(assembly.doc))]
    return Judged(campaign, assembly.runs, every)


def check(path: str | Path, known_parameters: Known | None = None) -> list[Fault]:
    """Every fault of a campaign at once, errors and warnings; empty where there is nothing to say."""
    return judged(path, known_parameters).faults


def _assess(path: str | Path, known: Known | None) -> tuple[Assembly | None, list[Fault]]:
    """Runs every check that an analysis needs on everything that can be read."""
    doc, faults = load(path)
    if doc is None:
        return None, faults
    faults += crowded(doc) or _by_line(fault for judge in DOCUMENT_CHECKS for fault in _few(judge(doc, known)))
    runs, of_runs, tables = [], list[Fault](), dict[Any, Any]()
    of_run = [parts(doc, entry) for entry in doc.entries]
    left = Counter(part.file for some in of_run for part in some)
    for entry, some in zip(doc.entries, of_run, strict=True):
        recorded, met = _recorded(doc, entry, some, tables)
        if recorded is not None:
            runs.append(recorded.slim())
        of_runs += met
        for part in some:
            left[part.file] -= 1
        if not any(left[part.file] for part in some):
            tables.clear()  # cuts of one file stand together as a rule; what is needed again is read again
    faults += [*_of_headings(runs), *of_runs]  # a heading first, as it is the cause of what a run lacks
    asked = _asked(doc)
    shown = rims(runs, asked) if asked else {}
    faults += unfounded(runs, shown)
    assembly = Assembly(doc, tuple(runs), gather(doc, runs), shown)
    if runs:
        faults += [fault for judge in CAMPAIGN_CHECKS for fault in judge(assembly)]
    return assembly, once(faults)


def _of_headings(runs: Iterable[Recorded]) -> list[Fault]:
    """What is odd in the headings of each device's files, beside one another."""
    devices: dict[str, list[Draft]] = {}
    for draft in (draft for run in runs for draft in run.drafts):
        devices.setdefault(draft.part.device.name, []).append(draft)
    return [fault for judge in HEADING_CHECKS for own in devices.values() for fault in judge(own)]


def _asked(doc: Document) -> list[str]:
    """The pushes whose rims are to be corrected."""
    return [name for name, value in doc.table("nuisance").items() if name in PUSH_NAMES and value is not False]


def _recorded(doc: Document, entry: Entry, some: Sequence[Part], tables: dict[Any, Any]) -> tuple[Recorded | None, list[Fault]]:
    """The files of one run, and what is wrong with each of them and with all together."""
    drafts, faults = [], []
    for part in some:
        file = doc.folder / part.file
        if not part.file.strip() or what_is(file):
            continue  # a check of the document says so
        draft, met = prepare(doc, part, file, tables)
        if draft is not None:
            met += [fault for judge in (*CLOCK_CHECKS, *FILE_CHECKS) for fault in judge(draft)]
            drafts.append(draft)
        faults.append(met)
    if not drafts:
        return None, _by_line(fault for met in faults for fault in met)
    run = Recorded(doc, entry, tuple(drafts))
    of_run = [fault for judge in RUN_CHECKS for fault in judge(run)]
    if len(some) == 1:
        return run, _by_line((*faults[0], *of_run))
    return run, [*(fault for met in faults for fault in _by_line(met)), *of_run]


def _few(faults: Iterable[Fault]) -> list[Fault]:
    """Of one kind: those that a reader will read, and how many more there are."""
    faults = list(faults)
    if len(faults) <= SHOWN:
        return faults
    return [*faults[:SHOWN], replace(faults[SHOWN], fact=f"and {len(faults) - SHOWN} more like these")]


def _by_line(faults: Iterable[Fault]) -> list[Fault]:
    """In the order in which a reader of the file meets them; what has no line comes last."""
    return sorted(faults, key=lambda fault: (fault.line is None, fault.line or 0))


def _campaign(assembly: Assembly, known: Known | None, warnings: tuple[Fault, ...]) -> Campaign:
    doc, noise = assembly.doc, assembly.noise
    name = doc.table("campaign").get("name")
    nuisance = {key: value for key, value in doc.table("nuisance").items() if value is not False}
    runs = [run for run in assembly.runs if not run.silent]
    names = _unique([run.name for run in runs])
    stated = doc.known(parameter_tables(known))
    return Campaign(
        name=name if isinstance(name, str) else doc.folder.resolve().name,
        path=doc.path,
        axes=doc.axes or SAE,
        known={**_mounted(doc, runs), **stated},
        priors=numbers(dict(flatten(doc.table("prior")))),
        noise=noise.sd,
        noise_estimated=noise.estimated,
        nuisance=tuple(channel for channel in CHANNEL_NAMES if channel in nuisance),
        nuisance_sd=noise.nuisance_sd,
        runs=tuple(
            _run(run, name, assembly.rims.get(run.entry.place, {}), stated) for run, name in zip(runs, names, strict=True)
        ),
        fingerprint=_fingerprint(doc),
        warnings=warnings,
        rims={
            name: taken
            for run, name in zip(runs, names, strict=True)
            if (
                taken := {
                    push: rim.as_json() for push, rim in assembly.rims.get(run.entry.place, {}).items() if rim.found.enough
                }
            )
        },
    )


def _run(run: Recorded, name: str, of: Mapping[str, Rim], stated: Mapping[str, float]) -> Run:
    entry = run.entry
    corrected_inputs, unsure = corrected(run, of)
    assert run.time is not None  # a file without time is an error, so no campaign is made
    inputs = with_strokes(run.time, corrected_inputs, stated.get("wheel.R", DEFAULTS["wheel.R"]))
    whole = Run(
        name=name,
        file=run.doc.folder / run.drafts[0].file,
        manoeuvre=entry.text("manoeuvre"),
        role=entry.text("role"),
        u0=run.u0,
        set=renamed(numbers(dict(flatten(entry.table("set")))), stated)[0],
        time=run.time,
        inputs={BY_NAME[c].fmu: series for c, series in inputs.items()},
        channels=run.measured,
        clocks=run.clocks,
        baselines=unsure,
        steps=run.steps,
        devices=len(run.drafts),
    )
    whole = covered(whole, run.late)
    return between(whole, *run.seen) if run.seen else whole


def _mounted(doc: Document, runs: Iterable[Recorded]) -> dict[str, float]:
    """Where the accelerometers and the markers sit, as the parameters that say so: the first of each, and how far others are
    from it."""
    points = {name: d.part.device.at for run in runs for d in run.drafts for name in d.channels}
    points |= {name: point for name, entry in doc.table("sensor").items() if (point := point_of(entry))}
    known: dict[str, float] = {}
    for effect, names in MOUNTED.items():
        given = {name: at for name in names if (at := points.get(name))}
        first, *others = given or ("",)
        known |= {f"effect.{effect}.{axis}": value for axis, value in zip("xy", given.get(first, ()), strict=False)}
        for name in (o for o in others if given[o] != given[first]):
            way = zip(("ahead", "right"), given[name], given[first], strict=True)
            known |= {f"effect.{effect}.{name}_{side}": there - here for side, there, here in way}
    if any(d.part.device.markers and "x" in d.channels for run in runs for d in run.drafts):
        known["effect.marker_offset.from_axle"] = 1.0
    return known


def _unique(names: Sequence[str]) -> list[str]:
    """The same names, with -2, -3, ... where one comes again."""
    taken: list[str] = []
    for name in names:
        free, n = name, 1
        while free in taken or (n > 1 and free in names):
            n += 1
            free = f"{name}-{n}"
        taken.append(free)
    return taken


def fingerprint(path: str | Path) -> str:
    """As a campaign has it, of one that may have faults: what is not there does not count."""
    doc, faults = load(path)
    return hashlib.sha256("\n".join(map(str, faults)).encode()).hexdigest() if doc is None else _fingerprint(doc)


def data_files(path: str | Path) -> dict[str, str]:
    """SHA-256 of campaign.toml and of every recording it names, by the name it gives them. Raises CampaignError where it cannot
    be read, and OSError where a recording is not there."""
    doc, faults = load(path)
    if doc is None:
        raise CampaignError(faults)
    found = {FILE: hashlib.sha256(doc.raw).hexdigest()}
    for file in _files(doc):
        with (doc.folder / file).open("rb") as recording:
            found[file] = hashlib.file_digest(recording, "sha256").hexdigest()
    return found


def _files(doc: Document) -> list[str]:
    """The recordings that campaign.toml names, in order."""
    return list(dict.fromkeys(part.file for entry in doc.entries for part in parts(doc, entry)))


def _fingerprint(doc: Document) -> str:
    """SHA-256 over campaign.toml and the files it names, in order."""
    digest = hashlib.sha256(doc.raw)
    for file in _files(doc):
        digest.update(f"\0{file}\0".encode())
        if not what_is(doc.folder / file):
            with (doc.folder / file).open("rb") as recording:
                digest.update(hashlib.file_digest(recording, "sha256").digest())
    return digest.hexdigest()
