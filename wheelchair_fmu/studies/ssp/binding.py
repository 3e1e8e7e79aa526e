"""Which value each parameter of each component gets: parameter sets, mapped, converted and checked.

A set that is bound to the system goes over those bound to components, and a later one over an earlier one. A name in a
system's set is that of a parameter connector of the system, which connections lead on, or `Component.parameter`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from fmpy.model_description import ScalarVariable

from ...errors import UsageError
from ...faults import suggestion
from ...fmu.parameter_set import Setting, SspUnit
from ...model.former import current, former
from .reading import Archive, Fmu
from .records import Binding, MappingEntry, Scaling, System

Values = dict[str, dict[str, float]]  # by component and variable


@dataclass(frozen=True)
class Given:
    """A setting on its way to a parameter: what scales it, and where it was written."""

    setting: Setting
    unit: SspUnit | None
    scaling: Scaling
    file: str


def resolve(archive: Archive, file: str, system: System, fmus: Mapping[str, Fmu]) -> Values:
    """Values by component and FMI name, as numbers in the FMU's own units; faults go to the archive."""
    values: Values = {name: {} for name in fmus}
    for component in system.components:
        if component.name in fmus:
            for binding in component.bindings:
                for name, given in _given(archive, file, binding, f"Component {component.name}"):
                    _put(archive, values, fmus, component.name, name, given)
    for binding in system.bindings:
        for name, given in _given(archive, file, binding, "System"):
            target = _target(system, name)
            if target is None:
                known = [
                    *(c.name for c in system.connectors if c.kind == "parameter"),
                    *(f"{c}.{v}" for c, fmu in fmus.items() for v in _settable(fmu)),
                ]
                archive.blame(
                    given.file,
                    f"Parameter {name}",
                    f"{file} has no such parameter",
                    suggestion(name, known),
                    given.setting.line,
                )
            elif target[0] in fmus:
                _put(archive, values, fmus, *target, given)
    return {name: _today(archive, file, name, fmus[name], found, {}) for name, found in values.items()}


def put_set(archive: Archive, values: Values, fmus: Mapping[str, Fmu], component: str, source: str) -> None:
    """A parameter set of the archive on top of a component's values."""
    own: Values = {component: {}}
    for name, given in _given(archive, source, Binding(source), f"Component {component}"):
        _put(archive, own, fmus, component, name, given)
    values[component] |= _today(archive, source, component, fmus[component], own[component], values[component])


def _today(
    archive: Archive, file: str, component: str, fmu: Fmu, given: dict[str, float], before: Mapping[str, float]
) -> dict[str, float]:
    """The values by the names that the FMU has, where they were given by former ones; the rest of it is as it was `before`."""
    if not any(former(given, fmu.variables)):
        return given
    starts = {n: float(v.start or 0.0) for n, v in fmu.variables.items() if v.causality == "parameter" and v.type == "Real"}
    try:
        found = current(given, {**starts, **before}, known=fmu.variables)
    except UsageError as error:
        fact, _, cure = str(error).partition("; ")
        archive.blame(file, "Parameters", fact, cure)
        return {}
    for name in found.keys() - given.keys():
        _within(archive, Given(Setting(found[name]), None, Scaling(), file), component, fmu.variables[name], found[name])
    return found


def _given(archive: Archive, file: str, binding: Binding, owner: str) -> Iterable[tuple[str, Given]]:
    """Names as the element knows them, and what they are given."""
    for source in filter(None, (binding.source, binding.mapping)):
        if not archive.has(source):
            archive.blame(file, owner, f"{source!r} is not in the archive", _files(archive, source), binding.line)
            return
    if not binding.source or (found := archive.parameter_set(binding.source)) is None:
        return
    units = {u.name: u for u in found.units}
    mapped: dict[str, list[MappingEntry]] = {}
    for entry in archive.mapping(binding.mapping) or () if binding.mapping else ():
        mapped.setdefault(entry.source, []).append(entry)
        if entry.source not in found.settings:
            archive.blame(
                binding.mapping,
                f"MappingEntry {entry.source}",
                f"{binding.source} has no such parameter",
                suggestion(entry.source, found.settings),
                entry.line,
            )
    for name, setting in found.settings.items():
        if setting.unit and setting.unit not in units:
            archive.blame(
                binding.source,
                f"Parameter {name}",
                f"unit {setting.unit!r} is not defined in Units",
                suggestion(setting.unit, units) if units else "define it there",
                setting.line,
            )
        unit = units.get(setting.unit)
        entries = mapped.get(name) or [MappingEntry(name, binding.prefix + name)]
        for entry in entries:
            yield entry.target, Given(setting, unit, entry.scaling, binding.source)


def _target(system: System, name: str) -> tuple[str, str] | None:
    """Component and parameter that a name in the system's set means."""
    if any(c.name == name and c.kind in ("parameter", "input") for c in system.connectors):
        for c in system.connections:
            if not c.start_element and c.start_connector == name and c.end_element:
                return c.end_element, c.end_connector
            if not c.end_element and c.end_connector == name and c.start_element:
                return c.start_element, c.start_connector
        return None
    component, dot, parameter = name.partition(".")
    return (component, parameter) if dot and system.component(component) else None


def _put(archive: Archive, values: Values, fmus: Mapping[str, Fmu], component: str, name: str, given: Given) -> None:
    fmu = fmus[component]
    instead = dict(former([name], fmu.variables)).get(name, ())
    variable = fmu.variables.get(instead[0].name if instead else name)
    who, line = f"Parameter {name}", given.setting.line
    if variable is None or variable.name not in _settable(fmu):
        if variable is None:
            fact, cure = f"{component} has no such variable", suggestion(name, _settable(fmu))
        else:
            fact, cure = f"{component} has it as {variable.causality}, which nobody sets", "leave it out"
        archive.blame(given.file, who, fact, cure, line)
        return
    number = _number(archive, given, fmu, variable, who)
    if number is not None and (instead or _within(archive, given, component, variable, number)):
        values[component][name] = number


def _within(archive: Archive, given: Given, component: str, variable: ScalarVariable, number: float) -> bool:
    """Is the number within the bounds of the variable? If not, that is told."""
    lower, upper = (
        float(b) if b is not None else default for b, default in ((variable.min, float("-inf")), (variable.max, float("inf")))
    )
    if lower <= number <= upper:
        return True
    archive.blame(
        given.file,
        f"Parameter {variable.name}",
        f"{number:g} is outside the bounds {lower:g} to {upper:g} {variable.unit or ''} of {component}",
        "give a value between them",
        given.setting.line,
    )
    return False


def _number(archive: Archive, given: Given, fmu: Fmu, variable: ScalarVariable, who: str) -> float | None:
    value, line = given.setting.value, given.setting.line
    if variable.type == "Enumeration":
        items = {item.name: float(item.value) for item in variable.declaredType.items}
        if isinstance(value, str) and value not in items and value not in map(str, map(int, items.values())):
            archive.blame(given.file, who, f"{value!r} is no choice", f"choose {' or '.join(items)}", line)
            return None
        return items.get(value, float(value)) if isinstance(value, str) else float(value)
    if isinstance(value, str) or isinstance(value, bool) != (variable.type == "Boolean"):
        kind = "an Enumeration" if isinstance(value, str) else "a Boolean" if isinstance(value, bool) else "a number"
        archive.blame(given.file, who, f"{kind}, but the FMU has a {variable.type}", f"give a {variable.type}", line)
        return None
    if isinstance(value, bool):
        return float(value)
    scaled = given.scaling.factor * value + given.scaling.offset
    own = fmu.units.get(variable.unit or "")
    if given.unit is None or own is None or given.scaling.suppress_units:
        return scaled
    if dict(given.unit.exponents) != dict(own.exponents):
        archive.blame(
            given.file, who, f"unit {given.unit.name!r} has another dimension than {own.name!r}", f"give it in {own.name}", line
        )
        return None
    return converted(scaled, given.unit, own)


def converted(value: float, unit: SspUnit, to: SspUnit) -> float:
    """A value in another unit of the same dimension."""
    if (unit.factor, unit.offset) == (to.factor, to.offset):
        return value
    return (unit.factor * value + unit.offset - to.offset) / to.factor


def _settable(fmu: Fmu) -> list[str]:
    return [n for n, v in fmu.variables.items() if v.causality in ("parameter", "input")]


def _files(archive: Archive, source: str) -> str:
    there = [f.relative_to(archive.folder).as_posix() for f in archive.folder.rglob(f"*{source[-4:]}")]
    return suggestion(source, sorted(there)) if there else "put it there, under that name"
