"""What somebody has written into a campaign goes with it when its files are read anew."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

FOUND = ("campaign", "columns", "recording", "run", "nuisance")  # what an import finds out by itself
OF_A_RUN = ("role", "manoeuvre", "u0", "constant", "set", "from", "to")


def carried(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, Any]:
    """What an import wrote, `after`, with what was there `before` and no file tells: values, noise, priors, and what is known
    of a run. What was said for the import itself stands."""
    more: dict[str, Any] = {}
    for name, table in before.items():
        if name not in FOUND and isinstance(table, Mapping) and isinstance(after.get(name, {}), Mapping):
            more[name] = {**table, **after.get(name, {})}
    known = {_name(run): run for run in _runs(before)}
    runs = [
        {**run, **{key: known[_name(run)][key] for key in OF_A_RUN if key in known.get(_name(run), {})}} for run in _runs(after)
    ]
    return {**after, **more, **({"run": runs} if runs else {})}


def _runs(content: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    runs = content.get("run")
    return [run for run in runs if isinstance(run, Mapping)] if isinstance(runs, list) else []


def _name(run: Mapping[str, Any]) -> str:
    return str(run.get("name") or run.get("file"))
