"""What an import only guessed: remembered until somebody changes it, so that the page can say it where it stands."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..writing import written
from .faults import to_look_at

FILE = "guesses.json"


def remember(folder: Path, content: Mapping[str, Any], unsure: Iterable[Mapping[str, Any]]) -> None:
    """Keep what `wheelchair import --json` was unsure of, with what its campaign.toml has in these places."""
    kept = [{**one, "stood": [_at(content, place) for place in one["places"]]} for one in unsure]
    with written(folder / FILE) as beside:
        beside.touch(mode=0o600)
        beside.write_text(json.dumps(kept, default=str), encoding="utf-8")


def standing(folder: Path, content: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Those guesses of which campaign.toml still has what it had, as faults are told."""
    try:
        kept = json.loads((folder / FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return  # nothing was imported here
    for one in kept:
        if json.loads(json.dumps([_at(content, place) for place in one["places"]], default=str)) == one["stood"]:
            at = ".".join(one["places"][0]) if not one["device"] else ""
            yield to_look_at(one["what"], one["device"], one["header"], _file_of(content, one["device"]), at)


def _at(content: Any, place: Sequence[str]) -> Any:
    """What stands in a place; a table [[recording]] by its device."""
    for key in place:
        if isinstance(content, list):
            content = next((one for one in content if isinstance(one, Mapping) and one.get("device") == key), None)
        else:
            content = content.get(key) if isinstance(content, Mapping) else None
    return content


def _file_of(content: Mapping[str, Any], device: str) -> str:
    """The first file of a device; of the only one, the first there is."""
    runs = content.get("run")
    for run in runs if isinstance(runs, list) else ():
        files = run.get("files") if isinstance(run, Mapping) else None
        name = files.get(device) if isinstance(files, Mapping) else run.get("file") if isinstance(run, Mapping) else None
        if isinstance(name, str):
            return name
    return ""
