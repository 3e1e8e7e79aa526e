"""modelDescription.xml of FMI 3.0; buildDescription.xml and terminalsAndIcons.xml, which FMI 2.0.4 has from there."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from . import dependencies
from .describe import (
    about,
    choice_attributes,
    experiment,
    items,
    jumping,
    log_categories,
    measure,
    number_attributes,
    quantities,
    to_bytes,
    type_name,
    units,
)
from .variables import Interface, Variable

VERSION = "3.0"
COMMON = {
    "canGetAndSetFMUState": "true",
    "canSerializeFMUState": "true",
    "providesDirectionalDerivatives": "true",
    "providesAdjointDerivatives": "true",
}
INTERFACES = {
    "ModelExchange": {**COMMON, "needsCompletedIntegratorStep": "true"},
    # No fixedInternalStepSize: steps adapt, the grid is only their upper bound.
    "CoSimulation": {
        **COMMON,
        "canHandleVariableCommunicationStepSize": "true",
        "maxOutputDerivativeOrder": "1",
        "providesIntermediateUpdate": "true",
        "canReturnEarlyAfterIntermediateUpdate": "true",
    },
}
# Where other parts of a simulator plug in: the variables of each terminal by their name in it, and where it is drawn.
TERMINALS = {
    "pushrim_left": (
        "the left hand: force on the rim or torque on the axle, brake, and how fast the wheel turns",
        {"F": "push.F_rl", "M": "push.M_rl", "brake": "brake.rl", "speed": "sensor.wheel_speed_l"},
        (-110, 40),
        "pushrim",
    ),
    "pushrim_right": (
        "the right hand: force on the rim or torque on the axle, brake, and how fast the wheel turns",
        {"F": "push.F_rr", "M": "push.M_rr", "brake": "brake.rr", "speed": "sensor.wheel_speed_r"},
        (-110, -60),
        "pushrim",
    ),
    "floor": (
        "the floor under the chair, and where the chair is on it",
        {
            "slope_x": "floor.slope_x",
            "slope_y": "floor.slope_y",
            "rolling_factor": "floor.rolling_factor",
            "x": "chair.x",
            "y": "chair.y",
        },
        (-10, -110),
        "floor",
    ),
}
SIZE = 20  # of a terminal, where the chair's icon goes from -100 to 100


def description(face: Interface, name: str, token: str) -> bytes:
    words = {"fmiVersion": VERSION, "modelName": name, "instantiationToken": token, **about(face)}
    root = ET.Element("fmiModelDescription", words)
    root.extend(ET.Element(kind, {"modelIdentifier": name, **abilities}) for kind, abilities in INTERFACES.items())
    root.extend([units(face), _types(face), log_categories(), experiment(), _variables(face), _structure(face)])
    return to_bytes(root)


def _types(face: Interface) -> ET.Element:
    element = ET.Element("TypeDefinitions")
    for unit in quantities(face):
        ET.SubElement(element, "Float64Type", {"name": unit.quantity, **measure(unit)})
    for v in face.variables:
        if v.choices:
            items(ET.SubElement(element, "EnumerationType", name=type_name(v)), v)  # FMPy 0.3.20 knows no description
    return element


def _variables(face: Interface) -> ET.Element:
    element = ET.Element("ModelVariables")
    reinit = jumping(face)
    element.extend(_variable(v, v.reference in reinit) for v in face.variables)
    return element


def _variable(v: Variable, reinit: bool) -> ET.Element:
    words = {
        "name": v.name,
        "valueReference": str(v.reference),
        "description": v.description,
        "causality": v.causality,
        "variability": v.variability,
    }
    if v.initial:
        words["initial"] = v.initial
    if v.kind in ("input", "output"):
        words["intermediateUpdate"] = "true"
    if v.choices:
        return ET.Element("Enumeration", words | choice_attributes(v))
    if v.type == "Boolean":
        return ET.Element("Boolean", words)
    if v.state is not None:
        words["derivative"] = str(v.state)
    if reinit:
        words["reinit"] = "true"
    return ET.Element("Float64", words | number_attributes(v))


def _structure(face: Interface) -> ET.Element:
    element = ET.Element("ModelStructure")
    continuous, initial = dependencies.continuous(face), dependencies.initial(face)
    outputs, derivatives = face.of("output"), face.of("derivative")
    groups = (
        ("Output", outputs, continuous),
        ("ContinuousStateDerivative", derivatives, continuous),
        ("InitialUnknown", (*outputs, *derivatives), initial),
        ("EventIndicator", face.of("indicator"), continuous),
    )
    for title, unknowns, known in groups:
        for v in unknowns:
            on = known[v.name]
            ET.SubElement(
                element,
                title,
                valueReference=str(v.reference),
                dependencies=" ".join(str(d.reference) for d, _ in on),
                dependenciesKind=" ".join(kind for _, kind in on),
            )
    return element


def build_description(name: str, version: str, unit: str) -> bytes:
    """How to compile the sources, of FMI 2.0 or 3.0: the C file `unit` against the FMI headers."""
    root = ET.Element("fmiBuildDescription", fmiVersion=VERSION)
    configuration = ET.SubElement(
        root, "BuildConfiguration", modelIdentifier=name, description=f"C11, beside the headers of FMI {version}.0"
    )
    files = ET.SubElement(configuration, "SourceFileSet", language="C11")
    ET.SubElement(files, "SourceFile", name=unit)
    ET.SubElement(
        files,
        "PreprocessorDefinition",
        name=f"FMI{version}_FUNCTION_PREFIX",
        value=f"{name}_",
        description=f"for linking; a shared library is compiled with FMI{version}_OVERRIDE_FUNCTION_PREFIX beside it",
    )
    ET.SubElement(configuration, "Library", name="m", external="true", description="the system's mathematics")
    return to_bytes(root)


def _terminals(face: Interface) -> dict[str, tuple[str, dict[str, str], tuple[int, int], str]]:
    """Those of which this model has all variables."""
    return {name: terminal for name, terminal in TERMINALS.items() if all(v in face.by_name for v in terminal[1].values())}


def terminal_icons(face: Interface) -> list[str]:
    return sorted({icon for _, _, _, icon in _terminals(face).values()})


def terminals(face: Interface) -> bytes:
    root = ET.Element("fmiTerminalsAndIcons", fmiVersion=VERSION)
    picture = ET.SubElement(root, "GraphicalRepresentation")
    box = {"x1": "-100", "y1": "-100", "x2": "100", "y2": "100"}
    ET.SubElement(picture, "CoordinateSystem", box, suggestedScalingFactorTo_mm="0.1")
    ET.SubElement(picture, "Icon", box)
    found = _terminals(face)
    group = ET.SubElement(root, "Terminals") if found else root
    for name, (meaning, members, (x, y), icon) in found.items():
        terminal = ET.SubElement(group, "Terminal", name=name, matchingRule="bus", description=meaning)
        for member, variable in members.items():
            ET.SubElement(
                terminal,
                "TerminalMemberVariable",
                variableName=face.by_name[variable].name,
                memberName=member,
                variableKind="signal",
            )
        ET.SubElement(
            terminal,
            "TerminalGraphicalRepresentation",
            x1=str(x),
            y1=str(y),
            x2=str(x + SIZE),
            y2=str(y + SIZE),
            defaultConnectionColor="30 90 160",
            iconBaseName=icon,
        )
    return to_bytes(root)
