"""modelDescription.xml of FMI 2.0."""

from __future__ import annotations

import re
from math import isfinite
from xml.etree import ElementTree as ET

from .. import __version__
from ..quantities import Unit
from . import dependencies
from .variables import STEP, STOP, TOLERANCE, Interface, Variable

AUTHOR = "the wheelchair-fmu authors"
SHOWN_IN = {"rad": "deg", "rad/s": "deg/s", "m/s": "km/h"}  # what people read instead of the SI unit
PASCALS = {"bar": 1e5}  # the one unit here that is not coherent
LOG_CATEGORIES = {
    "logStatusWarning": "the model has left the range in which it holds; said once",
    "logStatusDiscard": "a value or step was refused; the old one stays",
    "logStatusError": "a call was wrong, or the equations cannot go on",
    "logModel": "what the model was set up with",
}


NATIVE = {"canHandleVariableCommunicationStepSize": "true", "canInterpolateInputs": "true",
          "maxOutputDerivativeOrder": "0", "canGetAndSetFMUstate": "true", "canSerializeFMUstate": "true",
          "providesDirectionalDerivative": "true"}  # fmt: skip
PYTHON = {"needsExecutionTool": "true", "canHandleVariableCommunicationStepSize": "true",
          "canNotUseMemoryManagementFunctions": "true", "canGetAndSetFMUstate": "true",
          "canSerializeFMUstate": "true"}  # fmt: skip


def description(face: Interface, name: str, token: str, abilities: dict[str, str], sources: list[str]) -> bytes:
    """The XML text. `abilities` are the flavour's; `sources` the C files to compile, where the archive carries some."""
    root = ET.Element("fmiModelDescription", fmiVersion="2.0", modelName=name, guid=token, description=face.title,
                      author=AUTHOR, version=__version__, license="MIT", generationTool=f"wheelchair-fmu {__version__}",
                      variableNamingConvention="structured", numberOfEventIndicators="0")  # fmt: skip
    root.append(co_simulation(name, abilities, sources))
    chosen = [types(face)] if any(v.choices for v in face.variables) else []  # the schema knows no empty list of types
    root.extend([units(face), *chosen, log_categories(), experiment(), variables(face), structure(face)])
    return to_bytes(root)


def to_bytes(root: ET.Element) -> bytes:
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def co_simulation(name: str, abilities: dict[str, str], sources: list[str]) -> ET.Element:
    element = ET.Element("CoSimulation", modelIdentifier=name, **abilities)
    if sources:
        files = ET.SubElement(element, "SourceFiles")
        for source in sources:
            ET.SubElement(files, "File", name=source)
    return element


def units(face: Interface) -> ET.Element:
    """Every unit in use, with its exponents and other units of the same dimension."""
    element = ET.Element("UnitDefinitions")
    for unit in sorted({v.unit for v in face.variables if v.type == "Real"}, key=lambda u: u.name):
        element.append(_unit(unit))
    return element


def _unit(unit: Unit) -> ET.Element:
    element = ET.Element("Unit", name=unit.name)
    exponents = {k: str(getattr(unit, k)) for k in ("kg", "m", "s", "rad") if getattr(unit, k)}
    if unit.name in PASCALS:
        exponents = {"kg": "1", "m": "-1", "s": "-2", "factor": number(PASCALS[unit.name])}
    ET.SubElement(element, "BaseUnit", exponents)
    for display in unit.display:
        ET.SubElement(element, "DisplayUnit", name=display.name, factor=number(display.factor))
    return element


def type_name(v: Variable) -> str:
    """TyreLaw for tyre.law: a type may not be called like a variable."""
    return "".join(part.capitalize() for part in re.split("[._]", v.name))


def types(face: Interface) -> ET.Element:
    element = ET.Element("TypeDefinitions")
    for v in face.variables:
        if v.choices:
            simple = ET.SubElement(element, "SimpleType", name=type_name(v), description=v.description)
            enumeration = ET.SubElement(simple, "Enumeration")
            for value, choice in enumerate(v.choices, 1):
                ET.SubElement(enumeration, "Item", name=choice, value=str(value))
    return element


def log_categories() -> ET.Element:
    element = ET.Element("LogCategories")
    for name, meaning in LOG_CATEGORIES.items():
        ET.SubElement(element, "Category", name=name, description=meaning)
    return element


def experiment() -> ET.Element:
    return ET.Element("DefaultExperiment", startTime="0", stopTime=number(STOP), tolerance=number(TOLERANCE),
                      stepSize=number(STEP))  # fmt: skip


def variables(face: Interface) -> ET.Element:
    element = ET.Element("ModelVariables")
    for v in face.variables:
        element.append(variable(v))
    return element


def variable(v: Variable) -> ET.Element:
    causality = "independent" if v.kind == "time" else v.kind
    element = ET.Element("ScalarVariable", name=v.name, valueReference=str(v.reference), description=v.description,
                         causality=causality, variability=v.variability)  # fmt: skip
    if v.kind in ("parameter", "output"):
        element.set("initial", "exact" if v.kind == "parameter" else "calculated")
    element.append({"Real": _real, "Enumeration": _enumeration, "Boolean": _boolean}[v.type](v))
    return element


def _real(v: Variable) -> ET.Element:
    element = ET.Element("Real", unit=v.unit.name)
    if v.unit.name in SHOWN_IN:
        element.set("displayUnit", SHOWN_IN[v.unit.name])
    for key, value in (("min", v.lower), ("max", v.upper)):
        if isfinite(value):
            element.set(key, number(value))
    if v.kind != "time":
        element.set("nominal", number(v.nominal))
    if v.start is not None:
        element.set("start", number(v.start))
    return element


def _enumeration(v: Variable) -> ET.Element:
    return ET.Element("Enumeration", declaredType=type_name(v), min=number(v.lower), max=number(v.upper),
                      start=number(v.start or v.lower))  # fmt: skip


def _boolean(v: Variable) -> ET.Element:
    return ET.Element("Boolean")


def structure(face: Interface) -> ET.Element:
    element = ET.Element("ModelStructure")
    for title, known in (("Outputs", dependencies.outputs(face)), ("InitialUnknowns", dependencies.initial(face))):
        group = ET.SubElement(element, title)
        for v in face.of("output"):
            on = known[v.name]
            ET.SubElement(group, "Unknown", index=str(v.reference + 1),
                          dependencies=" ".join(str(d.reference + 1) for d, _ in on),
                          dependenciesKind=" ".join(kind for _, kind in on))  # fmt: skip
    return element


def number(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return repr(int(value)) if value == int(value) and abs(value) < 1e15 else repr(float(value))
