"""The steps of a session, which somebody or something may have broken: then what variants there are make another."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

PLAIN = re.compile(r"\w[\w.-]{0,80}")
History = dict[str, Any]


def recovered(session: Path) -> History:
    """What history.json says; where it cannot be read, one step for each variant in the folder, in their order."""
    found = _read(session)
    if isinstance(found, dict):
        return found
    files = sorted((f.name for f in (session / "variants").glob("*.toml") if PLAIN.fullmatch(f.name)), key=_place)
    steps = [{"label": f"variant {i}", "file": name, "ladder": None, "campaign": None} for i, name in enumerate(files)]
    return {"at": len(steps) - 1, "steps": steps}


def broken(session: Path) -> str:
    """Why history.json cannot be read, in a sentence; nothing where it can."""
    found = _read(session)
    return found if isinstance(found, str) else ""


def _read(session: Path) -> History | str:
    file = session / "history.json"
    if not file.exists():
        return {"at": -1, "steps": []}
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        return f"{file}: cannot be read ({' '.join(str(error).split())[:200]}); what variants there are stand in its place"
    if _sound(found, session):
        return dict(found)
    return f"{file}: does not say what was done; what variants there are stand in its place"


def _sound(found: Any, session: Path) -> bool:
    if not isinstance(found, dict) or not isinstance(found.get("steps"), list) or type(found.get("at")) is not int:
        return False
    steps = found["steps"]
    return 0 <= found["at"] < len(steps) and all(_sound_step(step, session) for step in steps)


def _sound_step(step: Any, session: Path) -> bool:
    if not isinstance(step, dict) or not isinstance(step.get("label"), str) or "ladder" not in step:
        return False
    file, campaign = step.get("file"), step.get("campaign")
    named = isinstance(file, str) and PLAIN.fullmatch(file) and (session / "variants" / file).is_file()
    return bool(named) and (campaign is None or (isinstance(campaign, str) and bool(PLAIN.fullmatch(campaign))))


def _place(name: str) -> tuple[int, str]:
    number = re.match(r"\d+", name)
    return (int(number[0]) if number else 0, name)
