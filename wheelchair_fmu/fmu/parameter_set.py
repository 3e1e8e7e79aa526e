"""Parameter sets of the SSP standard (.ssv): values for an FMU's parameters, by name, with units.

::

    from_variant(read_variant("better.toml"))  →  ParameterSet  →  text(...)  →  better.ssv
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from lxml import etree

from .. import __version__
from ..model.variant import Variant
from ..model.wheelchair import base_parameters
from ..quantities import Parameter, Unit
from .describe import PASCALS, number

NAMESPACE = {
    kind: f"http://ssp-standard.org/SSP1/SystemStructure{word}"
    for kind, word in {"ssc": "Common", "ssd": "Description", "ssv": "ParameterValues", "ssm": "ParameterMapping"}.items()
}
NAMESPACE["osp"] = "http://opensimulationplatform.com/SSP/OSPAnnotations"  # libcosim's own
TOOL = f"wheelchair-fmu {__version__}"
TABLE_1 = "Doria, Table 1"


@dataclass(frozen=True)
class SspUnit:
    """A unit as SSP and FMI define one: `SI value = factor · value + offset`, and exponents of the SI base units."""

    name: str
    exponents: Mapping[str, int] = field(default_factory=dict)
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Setting:
    """The value of one parameter: a number, a truth value, or the name of a choice; `unit` is "" where none is given."""

    value: float | bool | str
    unit: str = ""
    line: int = field(default=0, compare=False)  # in the file it was read from
    integer: bool = False


@dataclass(frozen=True)
class ParameterSet:
    """Settings by parameter name, and the units they are in."""

    name: str
    settings: Mapping[str, Setting]
    units: tuple[SspUnit, ...] = ()
    description: str = ""

    def over(self, other: ParameterSet) -> ParameterSet:
        """The same on top of another set, whose settings hold where this one has none."""
        units = {u.name: u for u in (*other.units, *self.units)}
        return ParameterSet(self.name, {**other.settings, **self.settings}, tuple(units.values()), self.description)


def from_values(
    name: str, values: Mapping[str, float | str], records: Iterable[Parameter], description: str = ""
) -> ParameterSet:
    """A set of checked values in SI units; the number of a choice becomes its name."""
    by_name = {p.name: p for p in records}
    settings, units = {}, {}
    for parameter, value in values.items():
        record = by_name[parameter]
        if record.choices:
            settings[parameter] = Setting(value if isinstance(value, str) else record.choices[int(value) - 1])
        else:
            settings[parameter] = Setting(float(value), record.unit.name)
            units[record.unit.name] = ssp_unit(record.unit)
    return ParameterSet(name, settings, tuple(units.values()), description)


def from_variant(variant: Variant, name: str = "variant", description: str = "") -> ParameterSet:
    """A variant's values, SI units. Of its laws only the tyre's is a parameter; it is set where it is not the default."""
    values: dict[str, float | str] = dict(variant.values)
    if variant.choice.tyre != "linear":
        values["tyre.law"] = variant.choice.tyre
    return from_values(name, values, variant.parameters(), description)


def reference() -> ParameterSet:
    """Table 1 of the paper."""
    known = [p for p in base_parameters() if p.source.startswith(TABLE_1) and not p.choices]
    return from_values("reference", {p.name: p.default for p in known}, known, "Table 1 of Doria et al.: tyre A at 4 bar")


def ssp_unit(unit: Unit) -> SspUnit:
    """A unit of `quantities`."""
    if unit.name in PASCALS:
        return SspUnit(unit.name, {"kg": 1, "m": -1, "s": -2}, PASCALS[unit.name])
    return SspUnit(unit.name, {k: e for k in ("kg", "m", "s", "rad") if (e := getattr(unit, k))})


def text(parameters: ParameterSet, version: str = "1.0") -> bytes:
    """The .ssv file of a set, for SSP 1.0 or 2.0."""
    root = element("ssv:ParameterSet", version=version, name=parameters.name, generationTool=TOOL)
    if parameters.description:
        root.set("description", parameters.description)
    table = child(root, "ssv:Parameters")
    for name, setting in parameters.settings.items():
        _value(child(table, "ssv:Parameter", name=name), setting)
    if parameters.units:
        add_units(child(root, "ssv:Units"), parameters.units)
    return to_bytes(root)


def _value(parent: etree._Element, setting: Setting) -> None:
    if isinstance(setting.value, str):
        child(parent, "ssv:Enumeration", value=setting.value)
    elif isinstance(setting.value, bool):
        child(parent, "ssv:Boolean", value=str(setting.value).lower())
    elif setting.integer:
        child(parent, "ssv:Integer", value=str(int(setting.value)))
    else:
        child(parent, "ssv:Real", value=number(setting.value), **({"unit": setting.unit} if setting.unit else {}))


# ---- XML, as all files of an SSP have it ----


def element(tag: str, **attributes: str) -> etree._Element:
    """A root. Some readers know the elements by the standard's usual prefixes only, so these are declared as they are."""
    kind = tag.partition(":")[0]
    declared = {k: NAMESPACE[k] for k in {"ssd": ("ssd", "ssc", "ssv", "ssm", "osp")}.get(kind, (kind, "ssc"))}
    return etree.Element(qualified(tag), dict(attributes), nsmap=declared)


def child(parent: etree._Element, tag: str, **attributes: str) -> etree._Element:
    return etree.SubElement(parent, qualified(tag), dict(attributes))


def qualified(tag: str) -> str:
    kind, _, name = tag.partition(":")
    return f"{{{NAMESPACE[kind]}}}{name}"


def add_units(parent: etree._Element, units: Iterable[SspUnit]) -> None:
    for unit in sorted(units, key=lambda u: u.name):
        attributes = {k: str(e) for k, e in unit.exponents.items()}
        attributes |= {k: number(v) for k, v, off in (("factor", unit.factor, 1), ("offset", unit.offset, 0)) if v != off}
        child(child(parent, "ssc:Unit", name=unit.name), "ssc:BaseUnit", **attributes)


def to_bytes(root: etree._Element) -> bytes:
    etree.indent(root)
    return etree.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"
