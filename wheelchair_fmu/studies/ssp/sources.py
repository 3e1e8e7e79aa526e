"""The sources in the folder `ssp`: systems, parameter sets and the interface, as TOML."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...contracts.own import variant_in
from ...errors import Failure, UsageError, unknown
from ...fmu.parameter_set import ParameterSet, from_values, from_variant, reference
from ...given import toml
from ...model.stage import Effect
from ...model.variant import number
from ...quantities import Parameter
from ...resources import SYSTEMS
from ...surroundings import floor, pusher
from ...surroundings.surfaces import surface

RECORDS: Mapping[str, tuple[Parameter, ...]] = {"Pusher": pusher.PARAMETERS, "Floor": floor.PARAMETERS}
VERSIONS = {"1": "1.0", "2": "2.0"}
COMPONENTS = ("Chair", "Pusher", "Floor")
FLOOR = "carpet.rolling_factor"  # a number, or the name of a surface in its place


@dataclass(frozen=True)
class Source:
    """A system: what it is, how long it runs [s], and values by component."""

    name: str
    title: str
    stop: float
    step: float
    values: Mapping[str, Mapping[str, float | str]]


def systems() -> tuple[str, ...]:
    return _names("systems")


def parameter_sets() -> tuple[str, ...]:
    return ("reference", *_names("parameters"))


def system(name: str) -> Source:
    """A system by name, or in a TOML file. Raises UsageError and Failure that name the fault."""
    path = _path(name, "systems", systems(), "system")
    table = _load(path)
    if lost := [key for key in ("title", "stop", "step") if key not in table]:
        raise Failure(f'{path}: no {" and no ".join(lost)}; write title = "…", stop and step in seconds')
    for key in table:
        if key not in ("title", "stop", "step", *COMPONENTS):
            raise unknown(f"component in {path}", key, COMPONENTS)
    for key in ("stop", "step"):
        if not isinstance(table[key], int | float) or not 0 < table[key] <= 1e6:
            raise Failure(f"{path}: {key} = {table[key]!r} is no time; give seconds above 0")
    values = {c: dict(table.get(c, {})) for c in COMPONENTS}
    for component in RECORDS:
        values[component] = _checked(component, values[component], f"{path} [{component}]")
    return Source(path.stem, str(table["title"]), float(table["stop"]), float(table["step"]), values)


def parameter_set(name: str, catalogue: Mapping[str, Effect] | None = None) -> tuple[str, ParameterSet]:
    """The component that a set is for, and the set: by name, or in a TOML file as `wheelchair add` writes it, whose effects
    are of this `catalogue` (the bundled one unless given)."""
    if name == "reference":
        return "Chair", reference()
    path = _path(name, "parameters", parameter_sets(), "parameter set")
    table = _load(path)
    component, title = str(table.get("for", "Chair")), str(table.get("title", ""))
    if component == "Chair":
        return component, replace(from_variant(variant_in(path, catalogue), path.stem), description=title)
    if component not in RECORDS:
        raise unknown(f"component in {path}", component, COMPONENTS)
    values = _checked(component, table.get("values", {}), f"{path} [values]")
    return component, from_values(path.stem, values, RECORDS[component], title)


def _checked(component: str, given: Mapping[str, float | str], place: str) -> dict[str, float | str]:
    """The values, with the factor of a floor that is given by its name. Raises Failure for one that cannot be."""
    known = {p.name: p for p in RECORDS[component]}
    values = dict(given)
    try:
        if isinstance(name := values.get(FLOOR), str):
            values[FLOOR] = surface(name).factor()
        for parameter, value in values.items():
            number(known, parameter, value)
    except UsageError as error:
        raise Failure(f"{place}: {error}") from None
    return values


def version(short: str) -> str:
    """A version of the standard as its files write it. Raises UsageError for one that there is not."""
    if short not in VERSIONS:
        raise UsageError(f"there is no SSP {short}; choose {' or '.join(VERSIONS)}")
    return VERSIONS[short]


def interface() -> Mapping[str, Mapping[str, Any]]:
    return _load(SYSTEMS / "interface.toml")


def _names(folder: str) -> tuple[str, ...]:
    return tuple(sorted(f.stem for f in (SYSTEMS / folder).glob("*.toml")))


def _path(name: str, folder: str, known: Iterable[str], kind: str) -> Path:
    if name.endswith(".toml"):
        return Path(name)
    if name not in known:
        raise unknown(kind, name, known)
    return SYSTEMS / folder / f"{name}.toml"


def _load(path: Path) -> dict[str, Any]:
    try:
        return toml(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise Failure(f"{path}: no such file; give a TOML file that is there") from None
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Failure(f"{path}: not a TOML file in UTF-8: {error}") from error
