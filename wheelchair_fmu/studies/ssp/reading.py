"""From an .ssp to records, and every fault met on the way."""

from __future__ import annotations

import tempfile
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

import fmpy
from fmpy.model_description import ModelDescription, ScalarVariable
from lxml import etree

from ...errors import Failure
from ...fmu.parameter_set import NAMESPACE, ParameterSet, Setting, SspUnit, qualified
from ...given import what_is
from .faults import Fault
from .records import Binding, Component, Connection, Connector, MappingEntry, Scaling, System
from .unpacking import too_much, unpack

SCHEMAS = {
    "ssd": "SystemStructureDescription.xsd",
    "ssv": "SystemStructureParameterValues.xsd",
    "ssm": "SystemStructureParameterMapping.xsd",
}
ROOTS = {"ssd": "SystemStructureDescription", "ssv": "ParameterSet", "ssm": "ParameterMapping"}
FMU_TYPES = ("application/x-fmu-sharedlibrary", "")
T = TypeVar("T")


@dataclass(frozen=True)
class Fmu:
    """An FMU of the archive, as it describes itself."""

    path: Path
    description: ModelDescription
    variables: MappingProxyType[str, ScalarVariable]
    units: MappingProxyType[str, SspUnit]


@dataclass
class Archive:
    """An unpacked .ssp. Files are read once; faults are told once, in the order in which they are met."""

    path: Path
    folder: Path
    faults: list[Fault] = field(default_factory=list)
    _read: dict[tuple[str, str], Any] = field(default_factory=dict, repr=False)

    def blame(self, file: str, element: str, fact: str, cure: str, line: int = 0) -> None:
        fault = Fault(file, element, fact, cure, line)
        if fault not in self.faults:
            self.faults.append(fault)

    def systems(self) -> list[str]:
        return sorted(f.name for f in self.folder.glob("*.ssd"))

    def has(self, source: str) -> bool:
        """Whether a relative address leads to a file inside the archive."""
        target = (self.folder / source).resolve()
        return target.is_relative_to(self.folder.resolve()) and target.is_file()

    def system(self, file: str) -> System | None:
        return self._once("ssd", file, _system)

    def parameter_set(self, file: str) -> ParameterSet | None:
        return self._once("ssv", file, _parameter_set)

    def mapping(self, file: str) -> tuple[MappingEntry, ...] | None:
        return self._once("ssm", file, _mapping)

    def fmu(self, file: str) -> Fmu | None:
        if ("fmu", file) not in self._read:
            self._read["fmu", file] = _fmu(self, file)
        found: Fmu | None = self._read["fmu", file]
        return found

    def _once(self, kind: str, file: str, convert: Callable[[Archive, str, etree._Element], T]) -> T | None:
        if (kind, file) not in self._read:
            root = self._root(kind, file)
            self._read[kind, file] = None if root is None else convert(self, file, root)
        found: T | None = self._read[kind, file]
        return found

    def _root(self, kind: str, file: str) -> etree._Element | None:
        parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, remove_comments=True, remove_pis=True)
        try:
            root = etree.fromstring((self.folder / file).read_bytes(), parser)
        except etree.XMLSyntaxError as error:
            self.blame(
                file, "", f"not well-formed XML: {error.msg}", "correct it, or build the archive again", error.lineno or 0
            )
            return None
        if root.getroottree().docinfo.internalDTD is not None:  # entities could stand for other files, or for gigabytes
            self.blame(
                file,
                "",
                "it begins with a document type declaration (DTD), and entities are not read here",
                "take the declaration out and write what its entities stand for",
            )
            return None
        wanted = qualified(f"{kind}:{ROOTS[kind]}")
        if root.tag != wanted:
            self.blame(
                file,
                _local(root),
                f"the root is {root.tag}, not {wanted}",
                f"write {kind}:{ROOTS[kind]} of SSP 1.0 or 2.0, with the namespace {NAMESPACE[kind]}",
                root.sourceline,
            )
            return None
        version = root.get("version", "")
        schema = _schema(kind, version)
        if schema is None and not version.startswith("1."):
            if version != "2.0":
                self.blame(file, _local(root), f"version {version!r} is unknown", "give 1.0 or 2.0", root.sourceline)
        elif schema is not None and not schema.validate(root):
            for entry in schema.error_log:
                text = entry.message.replace(f"{{{NAMESPACE[kind]}}}", f"{kind}:").replace(f"{{{NAMESPACE['ssc']}}}", "ssc:")
                self.blame(
                    file,
                    "",
                    f"not as the schema of SSP {version} wants it: {text}",
                    "put elements in the schema's order, with the attributes it asks for",
                    entry.line,
                )
        return root


@contextmanager
def opened(path: Path) -> Iterator[Archive]:
    """The archive, unpacked for as long as it is in use. Raises Failure for a file that is no archive."""
    path = Path(path)
    if kind := what_is(path):
        there = "no such file" if kind == "no file" else f"this is {kind}"
        raise Failure(f"{path}: {there}; build one with `wheelchair ssp build`")
    with tempfile.TemporaryDirectory(prefix="wheelchair-") as folder:
        archive = Archive(path, Path(folder))
        for name in unpack(path, archive.folder):
            archive.blame(path.name, name, "the name leads out of the archive", "pack files under relative names")
        yield archive


@cache
def _schema(kind: str, version: str) -> etree.XMLSchema | None:
    """The schema: of 1.0 from fmpy, of 2.0 from pyssp_standard where it is installed."""
    if version.startswith("1."):
        folder = Path(fmpy.__file__).parent / "ssp" / "schema"
    elif version == "2.0" and (spec := find_spec("pyssp_standard")) and spec.origin:
        folder = Path(spec.origin).parent / "resources" / "ssp2"
    else:
        return None
    return etree.XMLSchema(etree.parse(folder / SCHEMAS[kind]))


# ---- elements to records ----


def _local(node: etree._Element) -> str:
    return etree.QName(node).localname


def _all(parent: etree._Element, *path: str) -> list[etree._Element]:
    return parent.findall("/".join(map(qualified, path)))


def _system(archive: Archive, file: str, root: etree._Element) -> System | None:
    inner = root.find(qualified("ssd:System"))
    if inner is None:
        archive.blame(file, "", "there is no System", "write a System with Elements and Connections", root.sourceline)
        return None
    components = []
    for node in (n for group in _all(inner, "ssd:Elements") for n in group):
        if _local(node) == "Component":
            components.append(_component(archive, file, node))
        else:
            archive.blame(
                file,
                f"{_local(node)} {node.get('name', '')}".strip(),
                "only components are run here",
                "put the components of an inner system into the outer one",
                node.sourceline,
            )
    start, stop, step = _experiment(archive, file, root)
    return System(
        name=root.get("name", ""),
        components=tuple(components),
        connections=tuple(_connection(archive, file, n) for n in _all(inner, "ssd:Connections", "ssd:Connection")),
        connectors=_connectors(inner),
        bindings=_bindings(archive, file, inner, "System"),
        units=_units(archive, file, root),
        start=start,
        stop=stop,
        step=step,
        description=root.get("description", ""),
        version=root.get("version", ""),
        line=inner.sourceline,
    )


def _component(archive: Archive, file: str, node: etree._Element) -> Component:
    name = node.get("name", "")
    if node.get("type", "") not in FMU_TYPES:
        archive.blame(
            file,
            f"Component {name}",
            f"type {node.get('type')!r} is no FMU",
            "give an FMU: application/x-fmu-sharedlibrary",
            node.sourceline,
        )
    if node.get("implementation") == "ModelExchange":
        archive.blame(file, f"Component {name}", "ModelExchange is asked for", "ask for CoSimulation", node.sourceline)
    return Component(
        name,
        node.get("source", ""),
        _connectors(node),
        _bindings(archive, file, node, f"Component {name}"),
        line=node.sourceline,
    )


def _connectors(parent: etree._Element) -> tuple[Connector, ...]:
    found = []
    for node in _all(parent, "ssd:Connectors", "ssd:Connector"):
        kind = next((c for c in node if etree.QName(c).namespace == NAMESPACE["ssc"] and _local(c) != "Annotations"), None)
        type_, unit = ("Real", "") if kind is None else (_local(kind), kind.get("unit", ""))
        found.append(Connector(node.get("name", ""), node.get("kind", ""), type_, unit, node.sourceline))
    return tuple(found)


def _bindings(archive: Archive, file: str, parent: etree._Element, owner: str) -> tuple[Binding, ...]:
    found = []
    for node in _all(parent, "ssd:ParameterBindings", "ssd:ParameterBinding"):
        mapping = node.find(qualified("ssd:ParameterMapping"))
        inside = node.find(qualified("ssd:ParameterValues"))
        source = node.get("source") or _inline(archive, file, node, inside, "ssv", owner)
        mapped = ""
        if mapping is not None:
            mapped = mapping.get("source") or _inline(archive, file, mapping, mapping, "ssm", owner)
        for what in (node, mapping):
            if what is not None and what.get("sourceBase", "SSD") != "SSD":
                archive.blame(
                    file,
                    owner,
                    "sourceBase = component is not read here",
                    "take the file out of the FMU, into resources",
                    what.sourceline,
                )
        found.append(Binding(source, node.get("prefix", ""), mapped, node.sourceline))
    return tuple(found)


def _inline(archive: Archive, file: str, node: etree._Element, holder: etree._Element | None, kind: str, owner: str) -> str:
    """What stands inside the description, laid beside it as a file of its own, so that there is one way to read it."""
    content = None if holder is None else holder.find(qualified(f"{kind}:{ROOTS[kind]}"))
    if content is None:
        archive.blame(
            file,
            owner,
            f"a binding with neither a source nor a {ROOTS[kind]} inside",
            f'give source="resources/….{kind}"',
            node.sourceline,
        )
        return ""
    name = f"{file} line {content.sourceline}.{kind}"
    (archive.folder / name).write_bytes(etree.tostring(content))
    return name


def _connection(archive: Archive, file: str, node: etree._Element) -> Connection:
    get = node.get
    made = Connection(get("startElement", ""), get("startConnector", ""), get("endElement", ""), get("endConnector", ""))
    scaling = _scaling(archive, file, node, str(made))
    return Connection(made.start_element, made.start_connector, made.end_element, made.end_connector, scaling, node.sourceline)


def _scaling(archive: Archive, file: str, node: etree._Element, owner: str) -> Scaling:
    for other in node:
        if _local(other).endswith("MappingTransformation"):
            archive.blame(file, owner, f"{_local(other)} is not read here", "use a LinearTransformation", other.sourceline)
    linear = node.find(qualified("ssc:LinearTransformation"))
    given = {} if linear is None else {k: _number(archive, file, linear, k, owner) for k in ("factor", "offset")}
    read = {k: v for k, v in given.items() if v is not None}
    return Scaling(**read, suppress_units=node.get("suppressUnitConversion", "false") in ("true", "1"))


def _experiment(archive: Archive, file: str, root: etree._Element) -> tuple[float, float | None, float | None]:
    node = root.find(qualified("ssd:DefaultExperiment"))
    if node is None:
        return 0.0, None, None
    start, stop = _number(archive, file, node, "startTime") or 0.0, _number(archive, file, node, "stopTime")
    step = next((_number(archive, file, a, "baseStepSize") for a in node.iter(qualified("osp:FixedStepAlgorithm"))), None)
    if stop is not None and not stop > start:
        archive.blame(
            file,
            "DefaultExperiment",
            f"stopTime {stop:g} s is not after startTime {start:g} s",
            "give a later stopTime",
            node.sourceline,
        )
        stop = None
    if step is not None and not step > 0:
        archive.blame(
            file, "DefaultExperiment", f"baseStepSize {step:g} s is not above 0", "give a step such as 0.01", node.sourceline
        )
        step = None
    return start, stop, step


def _parameter_set(archive: Archive, file: str, root: etree._Element) -> ParameterSet:
    settings: dict[str, Setting] = {}
    for node in _all(root, "ssv:Parameters", "ssv:Parameter"):
        name = node.get("name", "")
        value = next((c for c in node if etree.QName(c).namespace == NAMESPACE["ssv"]), None)
        if name in settings:
            archive.blame(file, f"Parameter {name}", "the name stands here twice", "leave one of them out", node.sourceline)
        if value is None:
            archive.blame(file, f"Parameter {name}", "there is no value", 'write <ssv:Real value="…"/>', node.sourceline)
            continue
        setting = _setting(archive, file, name, value)
        if setting is not None:
            settings[name] = setting
    return ParameterSet(root.get("name", ""), settings, _units(archive, file, root), root.get("description", ""))


def _setting(archive: Archive, file: str, name: str, node: etree._Element) -> Setting | None:
    kind, text = _local(node), node.get("value", "")
    if kind in ("Real", "Float64", "Float32", "Integer", "Int32", "Int64"):
        value = _number(archive, file, node, "value", f"Parameter {name}")
        return None if value is None else Setting(value, node.get("unit", ""), node.sourceline, kind.startswith("Int"))
    if kind == "Enumeration":
        return Setting(text, line=node.sourceline)
    if kind == "Boolean":
        return Setting(text in ("true", "1"), line=node.sourceline)
    archive.blame(
        file,
        f"Parameter {name}",
        f"a value of type {kind} is not read here",
        "give a Real, Integer, Boolean or Enumeration",
        node.sourceline,
    )
    return None


def _mapping(archive: Archive, file: str, root: etree._Element) -> tuple[MappingEntry, ...]:
    return tuple(
        MappingEntry(
            n.get("source", ""),
            n.get("target", ""),
            _scaling(archive, file, n, f"MappingEntry {n.get('source')}"),
            n.sourceline,
        )
        for n in _all(root, "ssm:MappingEntry")
    )


def _units(archive: Archive, file: str, root: etree._Element) -> tuple[SspUnit, ...]:
    kind = "ssd:Units" if etree.QName(root).namespace == NAMESPACE["ssd"] else "ssv:Units"
    found = []
    for node in _all(root, kind, "ssc:Unit"):
        base = node.find(qualified("ssc:BaseUnit"))
        if base is None:
            archive.blame(file, f"Unit {node.get('name')}", "there is no BaseUnit", "give one", node.sourceline)
            continue
        numbers = {k: v for k in base.attrib if (v := _number(archive, file, base, k, f"Unit {node.get('name')}")) is not None}
        factor, offset = numbers.pop("factor", 1.0), numbers.pop("offset", 0.0)
        found.append(SspUnit(node.get("name", ""), {k: int(e) for k, e in numbers.items() if e}, factor, offset))
    return tuple(found)


def _number(archive: Archive, file: str, node: etree._Element, key: str, owner: str = "") -> float | None:
    """An attribute as a finite number; None where there is none, or it is no number, which is told."""
    text = node.get(key)
    try:
        value = None if text is None else float(text)
    except ValueError:
        value = float("nan")
    if text is not None and not abs(value or 0.0) < float("inf"):
        archive.blame(
            file, owner or _local(node), f"{key} = {text!r} is not a finite number", "write a number", node.sourceline
        )
        return None
    return value


def _fmu(archive: Archive, file: str) -> Fmu | None:
    def refuse(fact: str, cure: str) -> None:
        archive.blame(file, "", fact, cure)

    path = archive.folder / file
    try:
        with zipfile.ZipFile(path) as packed:
            if fact := too_much(packed):
                refuse(fact, "pack less into one FMU")
                return None
        description = fmpy.read_model_description(str(path))
    except Exception as error:  # fmpy raises whatever its parsers raise, zipfile what zlib does
        what = " ".join(str(error).split()) or type(error).__name__
        refuse(f"not an FMU: {what}", "give a file that `fmpy validate` accepts")
        return None
    if description.fmiVersion != "2.0" or description.coSimulation is None:
        refuse(f"FMI {description.fmiVersion} without co-simulation by FMI 2.0", "give an FMU 2.0 for co-simulation")
        return None
    platforms = fmpy.supported_platforms(str(path))
    if fmpy.platform not in platforms:
        refuse(f"built for {', '.join(platforms) or 'no platform'}, not for {fmpy.platform}", "build it here")
        return None
    variables = MappingProxyType({v.name: v for v in description.modelVariables})
    return Fmu(path, description, variables, MappingProxyType(fmu_units(description)))


def fmu_units(description: ModelDescription) -> dict[str, SspUnit]:
    """The units that an FMU defines, by name."""
    found = {}
    for unit in description.unitDefinitions:
        base = unit.baseUnit
        if base is not None:
            exponents = {k: int(e) for k in ("kg", "m", "s", "A", "K", "mol", "cd", "rad") if (e := getattr(base, k))}
            found[unit.name] = SspUnit(unit.name, exponents, float(base.factor), float(base.offset))
    return found
