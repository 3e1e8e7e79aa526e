"""Files that belong to an archive and are no part of FMI, with their manifest: the layered standard fmi-ls-ref.

A set with the values this build starts from, the inputs of the reference run, and what they should give.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from xml.etree import ElementTree as ET

from ..model.variant import Variant
from . import parameter_set
from .describe import to_bytes

NAME = "org.fmi-standard.fmi-ls-ref"
VERSION = "1.0.0-alpha.1"
FOLDER = f"extra/{NAME}"
NAMESPACE = "http://fmi-standard.org/fmi-ls-manifest"
START = "start.ssv"


@dataclass(frozen=True)
class Related:
    """What a file is, in the words of the layered standard."""

    kind: str
    role: str
    meaning: str


RELATED = {
    START: Related("application/x-ssp-parameter-set", "parameter", "the values that this build starts from"),
    "reference_in.csv": Related("text/csv", "testcase", "inputs of the reference run, each row held until the next"),
    "reference.csv": Related("text/csv", "result", "what the reference run gives, computed without FMI"),
}


def files(variant: Variant, results: Mapping[str, bytes]) -> dict[str, bytes]:
    """All by their path in the archive; `results` are the reference run's, by file name."""
    records = variant.parameters()
    values = {p.name: float(value) for p, value in zip(records, variant.vector(), strict=True)}
    start = parameter_set.from_values("start", values, records, RELATED[START].meaning)
    texts = {START: parameter_set.text(start), **results}
    return {f"{FOLDER}/fmi-ls-manifest.xml": _manifest(), **{f"{FOLDER}/{name}": text for name, text in texts.items()}}


def _manifest() -> bytes:
    ET.register_namespace("fmi-ls", NAMESPACE)
    said = {
        "name": NAME,
        "version": VERSION,
        "description": "Layered Standard providing information on related files included in an FMU.",
    }
    root = ET.Element("fmiReferences", {f"{{{NAMESPACE}}}fmi-ls-{key}": value for key, value in said.items()})
    for name, related in RELATED.items():
        ET.SubElement(root, "Related", type=related.kind, source=name, role=related.role, description=related.meaning)
    return to_bytes(root)
