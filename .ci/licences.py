"""Licences of what a release holds and needs, and what it holds as components of its SBOM:  PYTHON .ci/licences.py SBOM TEXTS

It runs in the environment into which the wheel was installed. SBOM is CycloneDX's list of that environment, to which the
scripts of the report page are added; TEXTS is written: the licence of each component, in its own words.
"""

from __future__ import annotations

import json
import re
import sys
from importlib.metadata import Distribution, distributions
from pathlib import Path

import wheelchair_fmu

OURS = {"wheelchair-fmu", "pip", "setuptools", "wheel"}  # and what every environment has
VENDOR = Path(wheelchair_fmu.__file__).parent / "report" / "page" / "vendor"
SOURCES = {"jspdf": "jsPDF", "svg2pdf": "svg2pdf.js", "uplot": "uPlot"}  # names on npm, as in package URLs in lower case
RULE = "=" * 100


def vendored() -> dict[str, str]:
    """The scripts that the report page brings along, by name, and their versions, which their files are named by."""
    found = {}
    for file in sorted(VENDOR.glob("*.js")):
        name, version = re.match(r"(\w+)-(\d+(?:\.\d+)*)\.", file.name).groups()
        found[name] = version
    return found


def components() -> list[dict[str, object]]:
    """The same for CycloneDX; all are under the MIT licence."""
    return [
        {
            "type": "library",
            "bom-ref": f"vendored-{name}",
            "name": SOURCES[name],
            "version": version,
            "purl": f"pkg:npm/{SOURCES[name].lower()}@{version}",
            "scope": "required",
            "description": "in the page of wheelchair report, as a file of the wheel",
            "licenses": [{"license": {"id": "MIT"}}],
        }
        for name, version in vendored().items()
    ]


def add(sbom: Path, version: str) -> None:
    content = json.loads(sbom.read_text("utf-8"))
    content["metadata"]["component"]["version"] = version
    known = [c for c in content.get("components", []) if not str(c.get("bom-ref", "")).startswith("vendored-")]
    content["components"] = [*known, *components()]
    sbom.write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", "utf-8")


def said(one: Distribution) -> str:
    """What a package says its licence is."""
    about = one.metadata
    known = [c.rpartition(" :: ")[2] for c in about.get_all("Classifier", []) if c.startswith("License :: ")]
    classified = [c for c in known if c != "OSI Approved"]  # which says of no licence that it is this one
    words = about.get("License-Expression") or ", ".join(classified) or about.get("License", "").partition("\n")[0]
    return words or "not stated by the package"


def texts(one: Distribution) -> list[str]:
    """The licence files that a package brings, in the order of their names."""
    named = [f for f in one.files or () if re.search(r"(^|/)(licen[cs]es?|copying|notice)[^/]*(/|$)", str(f), re.IGNORECASE)]
    inside = [f for f in sorted(named, key=str) if f.suffix not in (".py", ".pyc", ".json") and f.locate().is_file()]
    return [f"--- {f}\n\n{f.locate().read_text('utf-8', 'replace').strip()}" for f in inside]


def page() -> str:
    """All licences as one text."""
    parts = [
        "Licences of what comes with wheelchair-fmu, then of the Python packages that it needs, as they were installed when\n"
        "this release was tried. The packages are no part of the release, but for what ziglang links into libraries for other\n"
        "systems: parts of its own C library, of mingw-w64 and of LLVM's runtime, whose licences are under its name.\n"
    ]
    for name, version in vendored().items():
        text = (VENDOR / f"{name}-LICENSE.txt").read_text("utf-8").strip()
        parts.append(f"{RULE}\n{SOURCES[name]} {version}, in the wheel\n{RULE}\n\n{text}\n")
    others = {one.name.lower(): one for one in distributions() if one.name.lower() not in OURS}
    for name in sorted(others):
        one = others[name]
        own = "\n\n".join(texts(one)) or "(it brings no file with its licence)"
        parts.append(f"{RULE}\n{one.name} {one.version}: {said(one)}\n{RULE}\n\n{own}\n")
    return "\n".join(parts)


if __name__ == "__main__":
    add(Path(sys.argv[1]), wheelchair_fmu.__version__)
    Path(sys.argv[2]).write_text(page(), "utf-8")
