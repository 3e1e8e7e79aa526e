"""Parameter sets of the SSP standard (.ssv): values for an FMU's parameters, by name, with units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from xml.etree import ElementTree as ET

from .. import __version__
from ..model.variant import Variant
from ..quantities import Parameter
from .describe import PASCALS, number, to_bytes

NAMESPACE = "http://ssp-standard.org/SSP1/SystemStructure"


@dataclass(frozen=True)
class ParameterSet:
    """Values by parameter name, SI units or the name of a choice, and the records that say what they are."""

    name: str
    values: Mapping[str, float | str]
    records: Mapping[str, Parameter]
    description: str = ""


def from_variant(variant: Variant, name: str = "variant", description: str = "") -> ParameterSet:
    """A variant's values. Of its laws only the tyre's is a parameter; it is set where it is not the default."""
    values: dict[str, float | str] = dict(variant.values)
    if variant.choice.tyre != "linear":
        values["tyre.law"] = variant.choice.tyre
    return ParameterSet(name, values, {p.name: p for p in variant.parameters()}, description)


def text(parameters: ParameterSet) -> bytes:
    """The .ssv file of a set, for SSP 1.0."""
    root = ET.Element("ssv:ParameterSet", {
        "xmlns:ssv": f"{NAMESPACE}ParameterValues", "xmlns:ssc": f"{NAMESPACE}Common", "version": "1.0",
        "name": parameters.name, "generationTool": f"wheelchair-fmu {__version__}"})  # fmt: skip
    if parameters.description:
        root.set("description", parameters.description)
    table = ET.SubElement(root, "ssv:Parameters")
    units = {}
    for name, value in parameters.values.items():
        entry, record = ET.SubElement(table, "ssv:Parameter", name=name), parameters.records[name]
        if record.choices:
            ET.SubElement(entry, "ssv:Enumeration", value=value if isinstance(value, str) else record.choices[int(value) - 1])
        else:
            ET.SubElement(entry, "ssv:Real", value=number(float(value)), unit=record.unit.name)
            units[record.unit.name] = record.unit
    defined = ET.SubElement(root, "ssv:Units")
    for unit in sorted(units.values(), key=lambda u: u.name):
        exponents = {k: str(e) for k in ("kg", "m", "s", "rad") if (e := getattr(unit, k))}
        if unit.name in PASCALS:
            exponents = {"kg": "1", "m": "-1", "s": "-2", "factor": number(PASCALS[unit.name])}
        ET.SubElement(ET.SubElement(defined, "ssc:Unit", name=unit.name), "ssc:BaseUnit", exponents)
    return to_bytes(root)
