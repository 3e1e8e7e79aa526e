"""Every fault of an .ssp: one small check for each kind, all of them run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from ...faults import suggestion
from ...fmu.parameter_set import SspUnit
from .binding import Values, resolve
from .faults import Fault
from .reading import Archive, Fmu, opened
from .records import MAIN, Component, Connection, Connector, System

Fmus = Mapping[str, Fmu]
PAIRS = {("output", "input"), ("calculatedParameter", "parameter")}  # between elements
KINDS = {
    "input": ("input",),
    "output": ("output",),
    "parameter": ("parameter",),
    "calculatedParameter": ("calculatedParameter", "output"),
    "inout": ("input", "output"),
}
TYPES = {"Float64": "Real", "Int32": "Integer"}


def check(path: Path) -> list[Fault]:
    """Every fault of an archive; none in a good one. Raises Failure for a file that is no archive."""
    with opened(path) as archive:
        if MAIN not in archive.systems():
            archive.blame(archive.path.name, "", f"there is no {MAIN}", "give the system's description that name")
        for file in archive.systems():
            check_system(archive, file)
        for kind, read in (("ssv", archive.parameter_set), ("ssm", archive.mapping)):
            for found in sorted(archive.folder.glob(f"resources/*.{kind}")):
                read(found.relative_to(archive.folder).as_posix())
        return archive.faults


def check_system(archive: Archive, file: str) -> tuple[System | None, dict[str, Fmu], Values]:
    """One description, the FMUs of its components and the values that these are given; faults go to the archive."""
    system = archive.system(file)
    if system is None:
        return None, {}, {}
    fmus = _fmus(archive, file, system)
    for judge in CHECKS:
        judge(archive, file, system, fmus)
    return system, fmus, resolve(archive, file, system, fmus)


def _fmus(archive: Archive, file: str, system: System) -> dict[str, Fmu]:
    """By component; one that is missing or cannot be used is told."""
    found = {}
    for c in system.components:
        if not archive.has(c.source):
            there = [f.relative_to(archive.folder).as_posix() for f in archive.folder.rglob("*.fmu")]
            archive.blame(
                file,
                f"Component {c.name}",
                f"source {c.source!r} is not in the archive",
                suggestion(c.source, there) if there else "put the FMU there",
                c.line,
            )
        elif (fmu := archive.fmu(c.source)) is not None:
            found[c.name] = fmu
    return found


def components_differ(archive: Archive, file: str, system: System, fmus: Fmus) -> None:
    names = [c.name for c in system.components]
    for i, c in enumerate(system.components):
        if c.name in names[:i]:
            archive.blame(file, f"Component {c.name}", "the name stands here twice", "give each its own", c.line)
    if not names:
        archive.blame(file, "System", "there are no components", "put at least one into Elements", system.line)


def connectors_are_variables(archive: Archive, file: str, system: System, fmus: Fmus) -> None:
    for c in system.components:
        for k in c.connectors if c.name in fmus else ():
            variable = fmus[c.name].variables.get(k.name)
            who = f"Connector {c.name}.{k.name}"
            if variable is None:
                archive.blame(
                    file, who, "the FMU has no such variable", suggestion(k.name, _of_kind(fmus[c.name], k.kind)), k.line
                )
            elif variable.causality not in KINDS.get(k.kind, ()):
                archive.blame(
                    file,
                    who,
                    f"it is of kind {k.kind}, but the FMU has it as {variable.causality}",
                    f'write kind="{variable.causality}"',
                    k.line,
                )
            elif TYPES.get(k.type, k.type) != variable.type:
                archive.blame(
                    file,
                    who,
                    f"it is of type {k.type}, but the FMU has it as {variable.type}",
                    f"write ssc:{variable.type}",
                    k.line,
                )
            elif k.unit and variable.unit and k.unit != variable.unit:
                archive.blame(
                    file,
                    who,
                    f"it is in {k.unit}, but the FMU has it in {variable.unit}",
                    f'write unit="{variable.unit}"',
                    k.line,
                )


def connectors_have_known_units(archive: Archive, file: str, system: System, fmus: Fmus) -> None:
    known = {u.name for u in system.units}
    owners: tuple[System | Component, ...] = (system, *system.components)
    for owner in owners:
        for k in owner.connectors:
            if k.unit and k.unit not in known:
                archive.blame(
                    file,
                    f"Connector {k.name}",
                    f"unit {k.unit!r} is not defined in Units",
                    suggestion(k.unit, known) if known else "define it there",
                    k.line,
                )


def connections_lead_somewhere(archive: Archive, file: str, system: System, fmus: Fmus) -> None:
    for c in system.connections:
        ends = [
            _end(archive, file, system, c, e, k)
            for e, k in ((c.start_element, c.start_connector), (c.end_element, c.end_connector))
        ]
        if None in ends:
            continue
        start, end = (k.kind for k in ends if k)
        inner = bool(c.start_element) == bool(c.end_element)
        if (inner and (start, end) not in PAIRS) or (not inner and start != end):
            cure = (
                "lead from an output to an input"
                if inner
                else "lead from the system's input to an input, or from an output to the system's output"
            )
            archive.blame(file, str(c), f"it leads from kind {start} to kind {end}", cure, c.line)


def inputs_are_fed_once(archive: Archive, file: str, system: System, fmus: Fmus) -> None:
    seen = set[tuple[str, str]]()
    for c in system.connections:
        end = (c.end_element, c.end_connector)
        if end in seen:
            archive.blame(file, str(c), "another connection ends there too", "leave one of them out", c.line)
        seen.add(end)


def connections_keep_the_dimension(archive: Archive, file: str, system: System, fmus: Fmus) -> None:
    for c in system.connections:
        start, end = (_unit(fmus, e, k) for e, k in ((c.start_element, c.start_connector), (c.end_element, c.end_connector)))
        if c.scaling.suppress_units:
            continue
        if start and end and dict(start.exponents) != dict(end.exponents):
            archive.blame(
                file,
                str(c),
                f"it leads from {start.name} to {end.name}, which is another dimension",
                "connect what measures the same",
                c.line,
            )


CHECKS: tuple[Callable[[Archive, str, System, Fmus], None], ...] = (
    components_differ,
    connectors_are_variables,
    connectors_have_known_units,
    connections_lead_somewhere,
    inputs_are_fed_once,
    connections_keep_the_dimension,
)


def _unit(fmus: Fmus, element: str, name: str) -> SspUnit | None:
    """The unit of an end of a connection, where the FMU gives it one."""
    variable = fmus[element].variables.get(name) if element in fmus else None
    return None if variable is None else fmus[element].units.get(variable.unit or "")


def _of_kind(fmu: Fmu, kind: str) -> list[str]:
    return [n for n, v in fmu.variables.items() if v.causality in KINDS.get(kind, ())]


def _end(archive: Archive, file: str, system: System, c: Connection, element: str, name: str) -> Connector | None:
    owner: Component | System | None = system.component(element) if element else system
    if owner is None:
        archive.blame(
            file, str(c), f"there is no element {element!r}", suggestion(element, (k.name for k in system.components)), c.line
        )
        return None
    found = next((k for k in owner.connectors if k.name == name), None)
    if found is None:
        there = [k.name for k in owner.connectors]
        archive.blame(
            file,
            str(c),
            f"{element or 'the system'} has no connector {name!r}",
            suggestion(name, there) if there else "add it",
            c.line,
        )
    return found
