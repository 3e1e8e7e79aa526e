"""From a source to an .ssp: three FMUs, what connects them, and parameter sets.

An archive holds two descriptions of one system. SystemStructure.ssd is plain: components, connections, and one parameter set
for each component, which is what every importer reads; libcosim stops at a connection to the system itself and takes the
first set of a component only. Interface.ssd is the same system with connectors of its own, for use inside another, and
with handles: a few parameters in everyday units, which a mapping takes to the components.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy
from fmpy.model_description import ModelDescription, ScalarVariable

from ...fmu import package, parameter_set
from ...fmu.companions import Recording, build_floor, build_pusher
from ...fmu.documentation import LICENCE
from ...fmu.parameter_set import ParameterSet, Setting, SspUnit
from ...model.variant import Variant
from ...units import factor
from ..archives import fmu_of
from . import checking, sources, writing
from .reading import fmu_units
from .records import MAIN, Binding, Component, Connection, Connector, MappingEntry, System

FMUS = {"Chair": "Wheelchair", "Pusher": "Pusher", "Floor": "Floor"}
PLACES = {"Chair": (300.0, 0.0, 620.0, 420.0), "Pusher": (0.0, 210.0, 200.0, 420.0), "Floor": (0.0, 0.0, 200.0, 110.0)}
INTERFACE = "Interface.ssd"


def build(
    name: str = "slalom",
    target: Path | None = None,
    *,
    version: str = "1",
    variant: Variant | None = None,
    parameters: Iterable[str] = (),
    recording: Recording | None = None,
) -> Path:
    """Build the archive of a system, by its name in ssp/systems or by a file, and return its path.

    `parameters` are sets by name or file that go on top of Table 1 and of the variant's values. With a recording the pusher
    replays it. Raises UsageError for an unknown name, and Failure where something cannot be built or is not valid.
    """
    written_as = sources.version(version)
    source = sources.system(name)
    if recording:
        source = replace(source, title="Recorded pushes, replayed")
    chair = (variant or Variant()).with_values(source.values["Chair"])  # which may switch effects on
    with TemporaryDirectory() as folder:
        models = {c: _Model.of(f) for c, f in _fmus(Path(folder), source, chair, recording).items()}
    sets = _bound(source, chair, parameters)
    files = _files(source, models, sets, written_as)
    path = target or Path("dist") / f"{source.name.title().replace('-', '')}.ssp"
    return package.write(path, files, lambda made: [str(fault) for fault in checking.check(made)])


@dataclass(frozen=True)
class _Model:
    """An FMU: its bytes, and what it says of itself."""

    archive: bytes
    description: ModelDescription

    @staticmethod
    def of(path: Path) -> _Model:
        return _Model(path.read_bytes(), fmpy.read_model_description(str(path)))

    def variable(self, name: str) -> ScalarVariable:
        return next(v for v in self.description.modelVariables if v.name == name)

    def units(self) -> dict[str, SspUnit]:
        return fmu_units(self.description)

    def connectors(self) -> tuple[Connector, ...]:
        return tuple(Connector(v.name, v.causality, v.type, v.unit or "") for v in self.description.modelVariables
                     if v.causality in ("input", "output"))  # fmt: skip


def _fmus(folder: Path, source: sources.Source, chair: Variant, recording: Recording | None) -> dict[str, Path]:
    mode = "replay" if recording else source.values["Pusher"].get("pusher.mode", "open_loop")
    return {
        "Chair": fmu_of(chair),
        "Pusher": build_pusher(folder / "Pusher.fmu", {"pusher.mode": mode}, recording),
        "Floor": build_floor(folder / "Floor.fmu", {}),
    }


def _bound(source: sources.Source, chair: Variant, chosen: Iterable[str]) -> dict[str, ParameterSet]:
    """One set for each component: for the chair Table 1 at the bottom, and the system's own values on top."""
    sets = {component: ParameterSet(component, {}) for component in sources.COMPONENTS}
    sets["Chair"] = parameter_set.from_variant(chair).over(parameter_set.reference())
    for name in chosen:
        component, more = sources.parameter_set(name)
        sets[component] = more.over(sets[component])
    for component, values in source.values.items():
        own = parameter_set.from_values(component, values, sources.RECORDS.get(component) or chair.parameters())
        sets[component] = own.over(sets[component])
    return {component: _numbers(replace(s, name=component)) for component, s in sets.items()}


def _numbers(parameters: ParameterSet) -> ParameterSet:
    """Without choices, which libcosim cannot read: those are start values of the FMUs."""
    plain = {n: s for n, s in parameters.settings.items() if not isinstance(s.value, str)}
    return replace(parameters, settings=plain)


def _files(
    source: sources.Source, models: dict[str, _Model], sets: dict[str, ParameterSet], version: str
) -> dict[str, bytes]:
    plain = _plain(source, models, version)
    outer, handles, entries = _with_interface(plain, models, sets)
    known = [sources.parameter_set(name)[1] for name in sources.parameter_sets()]
    written = {f"resources/{s.name}.ssv": parameter_set.text(s, version) for s in (*known, *sets.values(), handles)}
    return {
        MAIN: writing.description(plain),
        INTERFACE: writing.description(outer),
        **{f"resources/{FMUS[c]}.fmu": m.archive for c, m in models.items()},
        **written,
        "resources/handles.ssm": writing.mapping(entries, version),
        "documentation/licenses/license.txt": LICENCE.read_bytes(),
    }


def _plain(source: sources.Source, models: dict[str, _Model], version: str) -> System:
    components = tuple(
        Component(c, f"resources/{FMUS[c]}.fmu", m.connectors(), (Binding(f"resources/{c}.ssv"),), PLACES[c])
        for c, m in models.items()
    )
    units = {c.unit: models[m].units()[c.unit] for m in models for c in models[m].connectors() if c.unit}
    return System(source.name, components, tuple(_same_names(components)), units=tuple(units.values()), stop=source.stop,
                  step=source.step, description=source.title, version=version)  # fmt: skip


def _same_names(components: tuple[Component, ...]) -> Iterable[Connection]:
    """Every input is fed by the output of the same name, where another component has one."""
    outputs = {k.name: c.name for c in components for k in c.connectors if k.kind == "output"}
    for component in components:
        for connector in component.connectors:
            if connector.kind == "input" and connector.name in outputs:
                yield Connection(outputs[connector.name], connector.name, component.name, connector.name)


def _with_interface(
    plain: System, models: dict[str, _Model], sets: dict[str, ParameterSet]
) -> tuple[System, ParameterSet, list[MappingEntry]]:
    """The system with connectors of its own, the values of its handles, and which handle goes to which of its parameters."""
    table = sources.interface()
    connectors, connections, entries = [], list(plain.connections), []
    for kind in ("input", "output"):
        for name, path in table[f"{kind}s"].items():
            element, _, inner = path.partition(".")
            connectors.append(Connector(name, kind, "Real", models[element].variable(inner).unit))
            outer = ("", name), (element, inner)
            connections.append(Connection(*(outer[0] + outer[1] if kind == "input" else outer[1] + outer[0])))
    settings, units, shown = {}, {u.name: u for u in plain.units}, {c: [] for c in models}
    for handle, (path, unit) in table["parameters"].items():
        element, _, inner = path.partition(".")
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
    handles = ParameterSet("handles", settings, tuple(u for u in units.values() if u.name in used),
                           "the parameters that a user turns, in everyday units")  # fmt: skip
    components = tuple(replace(c, connectors=(*c.connectors, *shown[c.name])) for c in plain.components)
    binding = Binding("resources/handles.ssv", mapping="resources/handles.ssm")
    outer_system = replace(plain, components=components, connections=tuple(connections), connectors=tuple(connectors),
                           bindings=(binding,), units=tuple(units.values()))  # fmt: skip
    return outer_system, handles, entries


def _start(bound: ParameterSet, variable: ScalarVariable) -> float:
    setting = bound.settings.get(variable.name)
    return float(variable.start if setting is None else setting.value)
