"""Records as the standard's XML."""

from __future__ import annotations

from collections.abc import Iterable

from lxml import etree

from ...fmu.describe import number
from ...fmu.parameter_set import TOOL, add_units, child, element, to_bytes
from .records import Binding, Component, Connection, Connector, MappingEntry, Scaling, System

SIDE = {"input": 0.0, "output": 1.0, "parameter": 0.5}  # where connectors sit on an element: left, right, in between
MARGIN = 40.0


def description(system: System) -> bytes:
    """The .ssd of a system."""
    root = element(
        "ssd:SystemStructureDescription", version=system.version, name=system.name, generationTool=TOOL, license="MIT"
    )
    if system.description:
        root.set("description", system.description)
    inner = child(root, "ssd:System", name=system.name)
    # The schema wants connectors, then bindings, then what is inside.
    _connectors(inner, system.connectors)
    _bindings(inner, system.bindings)
    elements = child(inner, "ssd:Elements")
    for component in system.components:
        _component(elements, component)
    connections = child(inner, "ssd:Connections")
    for connection in system.connections:
        _connection(connections, connection)
    _canvas(inner, system.components)
    if system.units:
        add_units(child(root, "ssd:Units"), system.units)
    _experiment(root, system)
    return to_bytes(root)


def mapping(entries: Iterable[MappingEntry], version: str = "1.0") -> bytes:
    """The .ssm of some entries."""
    root = element("ssm:ParameterMapping", version=version, generationTool=TOOL)
    for entry in entries:
        made = child(root, "ssm:MappingEntry", source=entry.source, target=entry.target, **_suppressed(entry.scaling))
        _transformation(made, entry.scaling)
    return to_bytes(root)


def _connectors(parent: etree._Element, connectors: tuple[Connector, ...]) -> None:
    if not connectors:
        return
    group = child(parent, "ssd:Connectors")
    counts = {kind: sum(c.kind == kind for c in connectors) for kind in SIDE}
    seen = dict.fromkeys(SIDE, 0)
    for connector in connectors:
        made = child(group, "ssd:Connector", name=connector.name, kind=connector.kind)
        child(made, f"ssc:{connector.type}", **({"unit": connector.unit} if connector.unit else {}))
        seen[connector.kind] += 1
        across, down = SIDE[connector.kind], 1 - seen[connector.kind] / (counts[connector.kind] + 1)
        x, y = (across, down) if connector.kind != "parameter" else (1 - down, 0.0)  # parameters along the lower edge
        child(made, "ssd:ConnectorGeometry", x=number(round(x, 4)), y=number(round(y, 4)))


def _bindings(parent: etree._Element, bindings: tuple[Binding, ...]) -> None:
    if not bindings:
        return
    group = child(parent, "ssd:ParameterBindings")
    for binding in bindings:
        made = child(group, "ssd:ParameterBinding", source=binding.source)
        if binding.prefix:
            made.set("prefix", binding.prefix)
        if binding.mapping:
            child(made, "ssd:ParameterMapping", source=binding.mapping)


def _component(parent: etree._Element, component: Component) -> None:
    made = child(
        parent,
        "ssd:Component",
        name=component.name,
        source=component.source,
        type="application/x-fmu-sharedlibrary",
        implementation="CoSimulation",
    )
    _connectors(made, component.connectors)
    if component.place:
        child(made, "ssd:ElementGeometry", **_corners(component.place))
    _bindings(made, component.bindings)


def _connection(parent: etree._Element, connection: Connection) -> None:
    ends = {
        "startElement": connection.start_element,
        "startConnector": connection.start_connector,
        "endElement": connection.end_element,
        "endConnector": connection.end_connector,
    }
    made = child(parent, "ssd:Connection", **{k: v for k, v in ends.items() if v}, **_suppressed(connection.scaling))
    _transformation(made, connection.scaling)


def _suppressed(scaling: Scaling) -> dict[str, str]:
    return {"suppressUnitConversion": "true"} if scaling.suppress_units else {}


def _transformation(parent: etree._Element, scaling: Scaling) -> None:
    if (scaling.factor, scaling.offset) != (1, 0):
        child(parent, "ssc:LinearTransformation", factor=number(scaling.factor), offset=number(scaling.offset))


def _canvas(parent: etree._Element, components: tuple[Component, ...]) -> None:
    """The diagram's extent: everything in it, with a margin."""
    places = [c.place for c in components if c.place]
    if places:
        x1, y1, x2, y2 = zip(*places, strict=True)
        extent = (min(x1) - MARGIN, min(y1) - MARGIN, max(x2) + MARGIN, max(y2) + MARGIN)
        child(parent, "ssd:SystemGeometry", **_corners(extent))


def _corners(place: tuple[float, float, float, float]) -> dict[str, str]:
    return dict(zip(("x1", "y1", "x2", "y2"), map(number, place), strict=True))


def _experiment(root: etree._Element, system: System) -> None:
    """Start and stop as the standard has them; for the step it has no place, so it stands where libcosim looks for it."""
    stop = {} if system.stop is None else {"stopTime": number(system.stop)}
    made = child(root, "ssd:DefaultExperiment", startTime=number(system.start), **stop)
    if system.step is not None:
        note = child(child(made, "ssd:Annotations"), "ssc:Annotation", type="com.opensimulationplatform")
        child(child(note, "osp:Algorithm"), "osp:FixedStepAlgorithm", baseStepSize=number(system.step))
