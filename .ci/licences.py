"""Licences and components of a release:  PYTHON .ci/licences.py SBOM TEXTS WHEEL INSTALLED...

It runs in the environment into which the wheel was installed. SBOM is CycloneDX's list of that environment, to which are added
the scripts of the report page, what is inside them, what ziglang links into libraries, and digests: of WHEEL, of scripts, and
of packages as pip found them, which wrote INSTALLED with `--report`. TEXTS is written: the licence of each component, in its
own words.
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
import tomllib
from collections.abc import Iterable, Mapping
from importlib.metadata import Distribution, distribution, distributions
from pathlib import Path
from typing import Any

import wheelchair_fmu

OURS = {"wheelchair-fmu", "pip", "setuptools", "wheel"}  # and what every environment has
VENDOR = Path(wheelchair_fmu.__file__).parent / "report" / "page" / "vendor"
SOURCES = {"jspdf": "jsPDF", "svg2pdf": "svg2pdf.js", "uplot": "uPlot"}  # names on npm, as in package URLs in lower case
RULE = "=" * 100
INSIDE = tomllib.loads(Path(__file__).with_name("inside.toml").read_text("utf-8"))
ZIG = "ziglang"


def vendored() -> dict[str, str]:
    """The scripts that the report page brings along, by name, and their versions, which their files are named by."""
    found = {}
    for file in sorted(VENDOR.glob("*.js")):
        name, version = re.match(r"(\w+)-(\d+(?:\.\d+)*)\.", file.name).groups()
        found[name] = version
    return found


def script(short: str) -> Path:
    """The file of a vendored script."""
    return next(VENDOR.glob(f"{short}-*.js"))


def components() -> list[dict[str, Any]]:
    """The same for CycloneDX, with what is inside; all are under the MIT licence."""
    return [
        {
            "type": "library",
            "bom-ref": f"vendored-{name}",
            "name": SOURCES[name],
            "version": version,
            "purl": f"pkg:npm/{SOURCES[name].lower()}@{version}",
            "scope": "required",
            "description": "in the page of wheelchair report, as a file of the wheel",
            "hashes": digest(script(name)),
            "licenses": [{"license": {"id": "MIT"}}],
            "components": [_inside(one, f"vendored-{name}") for one in INSIDE["script"] if one["of"] == name],
        }
        for name, version in vendored().items()
    ]


def _inside(one: Mapping[str, str], of: str) -> dict[str, Any]:
    """A record of inside.toml as a component."""
    known = {"type": "library", "bom-ref": f"{of}/{one['name']}", "name": one["name"], "scope": "required"}
    if version := one.get("version"):
        known["version"] = version
    if npm := one.get("npm"):
        known["purl"] = f"pkg:npm/{npm}{f'@{version}' if version else ''}"
    by = "as its package on npm says" if one.get("by") == "npm" else "as its own words say"
    return {**known, "description": one.get("where") or f"inside the script; licence {by}", "licenses": [_licence(one)]}


def _licence(one: Mapping[str, str]) -> dict[str, Any]:
    if "expression" in one:
        return {"expression": one["expression"]}
    return {"license": {"id": one["id"]} if "id" in one else {"name": one["licence"]}}


def compiler() -> dict[str, Any]:
    """Ziglang, of whose runtime there are parts in each library that it has made."""
    version = distribution(ZIG).version
    return {
        "type": "application",
        "bom-ref": ZIG,
        "name": ZIG,
        "version": version,
        "purl": f"pkg:pypi/{ZIG}@{version}",
        "scope": "required",
        "description": "made the compiled models, the FMUs and the report's WebAssembly, which have parts of its runtime",
        "licenses": [{"license": {"id": distribution(ZIG).metadata["License-Expression"]}}],
        "components": [_inside(one, ZIG) for one in INSIDE["runtime"]],
    }


def digest(file: Path) -> list[dict[str, str]]:
    return [{"alg": "SHA-256", "content": hashlib.sha256(file.read_bytes()).hexdigest()}]


def digests(reports: Iterable[Path]) -> dict[str, list[dict[str, str]]]:
    """Of packages' archives, by name, from what pip says that it installed."""
    found = {}
    for file in reports:
        for one in json.loads(file.read_text("utf-8"))["install"]:
            if sha := one["download_info"].get("archive_info", {}).get("hashes", {}).get("sha256"):
                found[_plain(one["metadata"]["name"])] = [{"alg": "SHA-256", "content": sha}]
    return found


def _plain(name: str) -> str:
    """A package's name as others may spell it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def add(sbom: Path, version: str, wheel: Path, reports: Iterable[Path]) -> None:
    content = json.loads(sbom.read_text("utf-8"))
    root, known = content["metadata"]["component"], digests(reports)
    root |= {"version": version, "hashes": digest(wheel)}
    ours = [*components(), compiler()]
    refs = {one["bom-ref"] for one in ours}
    kept = [c for c in content.get("components", []) if c["bom-ref"] not in refs and _plain(c["name"]) not in OURS]
    content["components"] = [{**c, **_hashed(c, known)} for c in (*kept, *ours)]
    _relate(content, root.get("bom-ref"), sorted(refs))
    sbom.write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", "utf-8")


def _hashed(component: Mapping[str, Any], known: Mapping[str, list[dict[str, str]]]) -> dict[str, Any]:
    found = known.get(_plain(component["name"])) if component.get("purl", "").startswith("pkg:pypi/") else None
    return {"hashes": found} if found else {}


def _relate(content: dict[str, Any], root: str | None, refs: list[str]) -> None:
    """Let the released package depend on what was added, and nothing on what was left out."""
    listed = {root, *(c["bom-ref"] for c in content["components"])}
    relations = {r["ref"]: r.get("dependsOn", []) for r in content.get("dependencies", []) if r["ref"] in listed}
    relations |= {ref: [] for ref in refs}
    if root:
        relations[root] = [*relations.get(root, []), *refs]
    content["dependencies"] = [
        {"ref": ref, **({"dependsOn": among} if (among := sorted(listed.intersection(others))) else {})}
        for ref, others in sorted(relations.items())
    ]


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


def _told(one: Mapping[str, str], short: str) -> str:
    """What a script says of something inside it: the comment that it is known by, or which licence its package has."""
    title = f"{RULE}\n{one['name']}, inside {SOURCES[short]}\n{RULE}\n\n"
    comments = re.findall(r"/\*.*?\*/", script(short).read_text("utf-8"), re.DOTALL)
    own = next((comment for comment in comments if one["said"] in comment), None)
    licence = one.get("expression") or one.get("id") or one["licence"]
    by = " on npm" if one.get("by") == "npm" else ""
    return f"{title}{licence}{by}\n{f'{chr(10)}{own}{chr(10)}' if own else ''}"


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
        parts += [_told(one, name) for one in INSIDE["script"] if one["of"] == name]
    others = {one.name.lower(): one for one in distributions() if one.name.lower() not in OURS}
    for name in sorted(others):
        one = others[name]
        own = "\n\n".join(texts(one)) or "(it brings no file with its licence)"
        parts.append(f"{RULE}\n{one.name} {one.version}: {said(one)}\n{RULE}\n\n{own}\n")
    return "\n".join(parts)


if __name__ == "__main__":
    sbom, told, wheel, *reports = map(Path, sys.argv[1:])
    add(sbom, wheelchair_fmu.__version__, wheel, reports)
    told.write_text(page(), "utf-8")
