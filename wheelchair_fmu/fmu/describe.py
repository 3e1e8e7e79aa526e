"""modelDescription.xml of FMI 2.0."""

from __future__ import annotations

import re
from collections.abc import Mapping
from math import isfinite
from xml.etree import ElementTree as ET

from .. import __version__
from ..quantities import Unit
from . import dependencies, package
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


# Per interface, what each flavour can do; every word of it is tested.
OWN_MEMORY = {"canNotUseMemoryManagementFunctions": "true"}
NATIVE = {
    "ModelExchange": {
        **OWN_MEMORY,
        "canGetAndSetFMUstate": "true",
        "canSerializeFMUstate": "true",
        "providesDirectionalDerivative": "true",
    },
    "CoSimulation": {
        "canHandleVariableCommunicationStepSize": "true",
        "canInterpolateInputs": "true",
        "maxOutputDerivativeOrder": "1",
        **OWN_MEMORY,
        "canGetAndSetFMUstate": "true",
        "canSerializeFMUstate": "true",
        "providesDirectionalDerivative": "true",
    },
}
PYTHON = {
    "CoSimulation": {
        "needsExecutionTool": "true",
        "canHandleVariableCommunicationStepSize": "true",
        **OWN_MEMORY,
        "canGetAndSetFMUstate": "true",
        "canSerializeFMUstate": "true",
    }
}


def description(face: Interface, name: str, token: str, abilities: Mapping[str, dict[str, str]], sources: list[str]) -> bytes:
    """The XML text. `abilities` are the flavour's; `sources` the C files to compile, where the archive carries some."""
    words = {"fmiVersion": "2.0", "modelName": name, "guid": token, **about(face)}
    words["numberOfEventIndicators"] = str(len(face.of("indicator")))
    root = ET.Element("fmiModelDescription", words)
    root.extend(_interface(kind, name, able, sources) for kind, able in abilities.items())
    root.extend([units(face), types(face), log_categories(), experiment(), variables(face), structure(face)])
    return to_bytes(root)


def about(face: Interface) -> dict[str, str]:
    """What both versions say of the model as a whole."""
    words = {
        "description": face.title,
        "author": AUTHOR,
        "version": __version__,
        "license": "MIT",
        "generationTool": f"wheelchair-fmu {__version__}",
        "variableNamingConvention": "structured",
    }
    if moment := package.moment():
        words["generationDateAndTime"] = moment.strftime("%Y-%m-%dT%H:%M:%SZ")
    return words


def to_bytes(root: ET.Element) -> bytes:
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def _interface(kind: str, name: str, abilities: dict[str, str], sources: list[str]) -> ET.Element:
    element = ET.Element(kind, {"modelIdentifier": name, **abilities})
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
    """TyreLaw for tyre.law: a type may not be called like a variable. A number's type is its quantity."""
    return "".join(part.capitalize() for part in re.split("[._]", v.name)) if v.choices else v.unit.quantity


def quantities(face: Interface) -> list[Unit]:
    """The units that measure a quantity with a name, each once."""
    return sorted({v.unit for v in face.variables if v.type == "Real" and v.unit.quantity}, key=lambda u: u.quantity)


def measure(unit: Unit) -> dict[str, str]:
    """The attributes that say what a number measures, in which unit and how people read it."""
    words = {"quantity": unit.quantity, "unit": unit.name, "displayUnit": SHOWN_IN.get(unit.name, "")}
    return {key: word for key, word in words.items() if word}


def types(face: Interface) -> ET.Element:
    element = ET.Element("TypeDefinitions")  # never empty: time is a quantity
    for unit in quantities(face):
        ET.SubElement(ET.SubElement(element, "SimpleType", name=unit.quantity), "Real", measure(unit))
    for v in face.variables:
        if v.choices:
            simple = ET.SubElement(element, "SimpleType", name=type_name(v), description=v.description)
            items(ET.SubElement(simple, "Enumeration"), v)
    return element


def items(enumeration: ET.Element, v: Variable) -> None:
    for value, choice in enumerate(v.choices, 1):
        ET.SubElement(enumeration, "Item", name=choice, value=str(value))


def log_categories() -> ET.Element:
    element = ET.Element("LogCategories")
    for name, meaning in LOG_CATEGORIES.items():
        ET.SubElement(element, "Category", name=name, description=meaning)
    return element


def experiment() -> ET.Element:
    return ET.Element(
        "DefaultExperiment", startTime="0", stopTime=number(STOP), tolerance=number(TOLERANCE), stepSize=number(STEP)
    )


def variables(face: Interface) -> ET.Element:
    element = ET.Element("ModelVariables")
    reinit = jumping(face)
    for v in face.variables:
        element.append(variable(v, v.reference in reinit))
    return element


def variable(v: Variable, reinit: bool) -> ET.Element:
    element = ET.Element(
        "ScalarVariable",
        name=v.name,
        valueReference=str(v.reference),
        description=v.description,
        causality=v.causality,
        variability=v.variability,
    )
    if v.initial and v.kind != "input":
        element.set("initial", v.initial)
    if v.type == "Real":
        real = ET.SubElement(element, "Real", number_attributes(v))
        if v.state is not None:
            real.set("derivative", str(v.state + 1))
        if reinit:
            real.set("reinit", "true")
    elif v.choices:
        ET.SubElement(element, "Enumeration", choice_attributes(v))
    else:
        ET.SubElement(element, "Boolean")
    return element


def number_attributes(v: Variable) -> dict[str, str]:
    """What both versions say of a number."""
    words = {"declaredType": v.unit.quantity} if v.unit.quantity else {}
    words |= measure(v.unit)
    words |= {key: number(value) for key, value in (("min", v.lower), ("max", v.upper)) if isfinite(value)}
    if v.kind != "time":
        words["nominal"] = number(v.nominal)
    if v.start is not None:
        words["start"] = number(v.start)
    return words


def choice_attributes(v: Variable) -> dict[str, str]:
    return {"declaredType": type_name(v), "min": number(v.lower), "max": number(v.upper), "start": number(v.start or v.lower)}


def jumping(face: Interface) -> set[int]:
    """References of the states that an event may set."""
    return {face.states[j.state].reference for j in face.jumps if j.state in face.states}


def structure(face: Interface) -> ET.Element:
    element = ET.Element("ModelStructure")
    continuous, initial = dependencies.continuous(face), dependencies.initial(face)
    outputs, derivatives = face.of("output"), face.of("derivative")
    groups = (
        ("Outputs", outputs, continuous),
        ("Derivatives", derivatives, continuous),
        ("InitialUnknowns", (*outputs, *derivatives), initial),
    )
    for title, unknowns, known in groups:
        if not unknowns:
            continue
        group = ET.SubElement(element, title)
        for v in unknowns:
            on = known[v.name]
            ET.SubElement(
                group,
                "Unknown",
                index=str(v.reference + 1),
                dependencies=" ".join(str(d.reference + 1) for d, _ in on),
                dependenciesKind=" ".join(kind for _, kind in on),
            )
    return element


def number(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return repr(int(value)) if value == int(value) and abs(value) < 1e15 else repr(float(value))
