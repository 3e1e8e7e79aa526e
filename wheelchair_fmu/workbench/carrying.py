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
    known = {_name(run): run for run in _tables(before.get("run"))}
    runs = [
        {**run, **{key: known[_name(run)][key] for key in OF_A_RUN if key in known.get(_name(run), {})}}
        for run in _tables(after.get("run"))
    ]
    found = {**after, **more, **({"run": runs} if runs else {})}
    if isinstance(after.get("recording"), list):
        devices = {str(one.get("device")): one for one in _tables(before.get("recording"))}
        found["recording"] = [_as_said(one, devices.get(str(one.get("device")), {})) for one in _tables(after["recording"])]
    elif isinstance(after.get("columns"), Mapping) and isinstance(before.get("columns"), Mapping):
        found["columns"] = _units(after["columns"], before["columns"])
    return found


def _as_said(device: Mapping[str, Any], before: Mapping[str, Any]) -> dict[str, Any]:
    """A device with its place and with the units of its columns, where these were said and no file tells them."""
    place = {"at": before["at"]} if "at" in before and "at" not in device else {}
    columns, said = device.get("columns"), before.get("columns")
    units = {"columns": _units(columns, said)} if isinstance(columns, Mapping) and isinstance(said, Mapping) else {}
    return {**device, **place, **units}


def _units(columns: Mapping[str, Any], before: Mapping[str, Any]) -> dict[str, Any]:
    def unit(entry: Any) -> Any:
        return entry.get("unit") if isinstance(entry, Mapping) else None

    def header(entry: Any) -> Any:
        return entry.get("column") if isinstance(entry, Mapping) else entry

    same = {name for name, entry in columns.items() if header(entry) == header(before.get(name)) and unit(before.get(name))}
    return {
        name: {"column": header(entry), **(entry if isinstance(entry, Mapping) else {}), "unit": unit(before[name])}
        if name in same and not unit(entry)
        else entry
        for name, entry in columns.items()
    }


def _tables(value: Any) -> list[Mapping[str, Any]]:
    return [one for one in value if isinstance(one, Mapping)] if isinstance(value, list) else []


def _name(run: Mapping[str, Any]) -> str:
    return str(run.get("name") or run.get("file"))
