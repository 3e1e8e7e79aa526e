"""The two descriptions of a system: its components and what connects them; and the same, with an interface of its own."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import fmpy
from fmpy.model_description import ModelDescription, ScalarVariable

from ...fmu.parameter_set import ParameterSet, Setting, SspUnit
from ...units import factor
from . import sources
from .reading import fmu_units
from .records import Binding, Component, Connection, Connector, MappingEntry, System

FMUS = {"Chair": "Wheelchair", "Pusher": "Pusher", "Floor": "Floor"}
PLACES = {"Chair": (300.0, 0.0, 620.0, 420.0), "Pusher": (0.0, 210.0, 200.0, 420.0), "Floor": (0.0, 0.0, 200.0, 110.0)}


@dataclass(frozen=True)
class Model:
    """An FMU: its bytes, and what it says of itself."""

    archive: bytes
    description: ModelDescription

    @staticmethod
    def of(path: Path) -> Model:
        return Model(path.read_bytes(), fmpy.read_model_description(str(path)))

    def variable(self, name: str) -> ScalarVariable:
        return next(v for v in self.description.modelVariables if v.name == name)

    def units(self) -> dict[str, SspUnit]:
        return fmu_units(self.description)

    def connectors(self) -> tuple[Connector, ...]:
        return tuple(
            Connector(v.name, v.causality, v.type, v.unit or "")
            for v in self.description.modelVariables
            if v.causality in ("input", "output")
        )


def plain_system(source: sources.Source, models: dict[str, Model], version: str) -> System:
    """What every importer reads: the connectors that lead somewhere, connections by name, one set for each component."""
    everything = tuple(
        Component(c, f"resources/{FMUS[c]}.fmu", m.connectors(), (Binding(f"resources/{c}.ssv"),), PLACES[c])
        for c, m in models.items()
    )
    connections = tuple(_same_names(everything))
    components = tuple(_without_loose_ends(everything, connections))
    units = {k.unit: models[c.name].units()[k.unit] for c in components for k in c.connectors if k.unit}
    return System(
        source.name,
        components,
        connections,
        units=tuple(units.values()),
        stop=source.stop,
        step=source.step,
        description=source.title,
        version=version,
    )


def _same_names(components: tuple[Component, ...]) -> Iterable[Connection]:
    """Every input is fed by the output of the same name, where another component has one."""
    outputs = {k.name: c.name for c in components for k in c.connectors if k.kind == "output"}
    for component in components:
        for connector in component.connectors:
            if connector.kind == "input" and connector.name in outputs:
                yield Connection(outputs[connector.name], connector.name, component.name, connector.name)


def _without_loose_ends(components: Iterable[Component], connections: Iterable[Connection]) -> Iterable[Component]:
    """Components with the connectors that lead somewhere, and the outputs that the interface shows."""
    ends = [((c.start_element, c.start_connector), (c.end_element, c.end_connector)) for c in connections]
    used = {end for pair in ends for end in pair} | {parted(path) for path in sources.interface()["outputs"].values()}
    for component in components:
        kept = tuple(k for k in component.connectors if (component.name, k.name) in used)
        yield replace(component, connectors=kept)


def usual_file(name: str) -> str:
    """What the archive of a system is called where nobody says otherwise."""
    return f"{name.title().replace('-', '')}.ssp"


def parted(path: str) -> tuple[str, str]:
    """The element and its variable in `Element.variable`."""
    element, _, inner = path.partition(".")
    return element, inner


def with_interface(
    plain: System, models: dict[str, Model], sets: dict[str, ParameterSet]
) -> tuple[System, ParameterSet, list[MappingEntry]]:
    """The system with connectors of its own, the values of its handles, and which handle goes to which of its parameters."""
    table = sources.interface()
    connectors, connections, entries = [], list(plain.connections), []
    settings, units = dict[str, Setting](), {u.name: u for u in plain.units}
    shown: dict[str, list[Connector]] = {c: [] for c in models}
    for kind in ("input", "output"):
        for name, path in table[f"{kind}s"].items():
            element, inner = parted(path)
            unit = models[element].variable(inner).unit
            units[unit] = models[element].units()[unit]
            connectors.append(Connector(name, kind, "Real", unit))
            if kind == "input":
                shown[element].append(Connector(inner, kind, "Real", unit))
            outer = ("", name), (element, inner)
            connections.append(Connection(*(outer[0] + outer[1] if kind == "input" else outer[1] + outer[0])))
    for handle, (path, unit) in table["parameters"].items():
        element, inner = parted(path)
        variable, name = models[element].variable(inner), handle.rpartition(".")[2]
        own = models[element].units()[variable.unit]
        units[unit] = own if unit == own.name else SspUnit(unit, own.exponents, own.factor * factor(unit, own.name))
        units[own.name] = own
        connectors.append(Connector(name, "parameter", "Real", unit))
        shown[element].append(Connector(inner, "parameter", "Real", own.name))
        connections.append(Connection("", name, element, inner))
        entries.append(MappingEntry(handle, name))
        value = _start(sets[element], variable) * own.factor / units[unit].factor
        settings[handle] = Setting(float(f"{value:.12g}"), unit)  # as people write it
    used = {s.unit for s in settings.values()}
    handles = ParameterSet(
        "handles",
        settings,
        tuple(u for u in units.values() if u.name in used),
        "the parameters that a user turns, in everyday units",
    )
    components = tuple(replace(c, connectors=(*c.connectors, *shown[c.name])) for c in plain.components)
    binding = Binding("resources/handles.ssv", mapping="resources/handles.ssm")
    # A name of its own: OMSimulator takes the descriptions of an archive as variants, and refuses two of one name.
    outer_system = replace(
        plain,
        name=f"{plain.name}-interface",
        components=components,
        connections=tuple(connections),
        connectors=tuple(connectors),
        bindings=(binding,),
        units=tuple(units.values()),
    )
    return outer_system, handles, entries


def _start(bound: ParameterSet, variable: ScalarVariable) -> float:
    setting = bound.settings.get(variable.name)
    return float(variable.start if setting is None else setting.value)
