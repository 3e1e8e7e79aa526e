"""What `make release` is made of: its version, its licences, and the same bytes from the same commit."""

from __future__ import annotations

import hashlib
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from importlib import metadata
from pathlib import Path

import pytest
from packaging.version import Version

ROOT = Path(__file__).parents[1]


def script(name):
    """A module of `.ci`, which is no package."""
    spec = importlib.util.spec_from_file_location(f"ci_{name.replace('/', '_')}", ROOT / ".ci" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def git(place, *words):
    return subprocess.run(["git", *map(str, words)], cwd=place, check=True, capture_output=True, text=True).stdout.strip()


@pytest.fixture
def checkout(tmp_path):
    """Two commits of what has a version."""
    place = tmp_path / "checkout"
    (place / "wheelchair_fmu").mkdir(parents=True)
    (place / "wheelchair_fmu" / "__init__.py").write_text('"""It."""\n\n__version__ = "0.1.0"\n')
    (place / "CITATION.cff").write_text("cff-version: 1.2.0\nversion: 0.1.0\nlicense: MIT\n")
    (place / "CHANGELOG.md").write_text("# Changelog\n\n## [Unreleased]\n\n## [0.2.0] - 2026-11-25\n")
    git(tmp_path, "init", "-q", place)
    for message in ("one", "two"):
        git(place, "add", ".")
        git(place, "-c", "user.name=n", "-c", "user.email=n@n", "commit", "-q", "--allow-empty", "-m", message)
    return place


def test_a_tag_is_the_version_everywhere(checkout):
    git(checkout, "tag", "v0.2.0")
    git(checkout, "tag", "vetted")  # which is no version
    assert script("version").main(checkout, checkout) == "0.2.0"
    assert '\n__version__ = "0.2.0"\n' in (checkout / "wheelchair_fmu" / "__init__.py").read_text()
    assert (checkout / "CITATION.cff").read_text() == "cff-version: 1.2.0\nversion: 0.2.0\nlicense: MIT\n"


def test_a_commit_without_a_tag_has_a_number_of_its_own(checkout):
    assert script("version").main(checkout, checkout) == "0.1.0.dev2"


@pytest.mark.parametrize(
    ("tags", "found"),
    [
        ("v0.0.9", "0.1.0.dev2"),
        ("v0.1.0", "0.1.1.dev2"),
        ("v0.9.0 v0.10.0", "0.10.1.dev2"),
        ("v0.2.0rc1", "0.2.0rc2.dev2"),
        ("v0.1.0rc1", "0.1.0rc2.dev2"),
        ("v0.2.0.post1", "0.2.1.dev2"),
        ("v0.2-no-version", "0.1.0.dev2"),
    ],
)
def test_what_comes_after_a_tag_is_above_it(checkout, tags, found):
    for tag in tags.split():
        git(checkout, "tag", tag, "HEAD~1")
    assert script("version").main(checkout, checkout) == found
    assert all(Version(found) > Version(tag) for tag in tags.split() if "no-version" not in tag)


def test_a_tag_without_its_section_is_refused(checkout):
    git(checkout, "tag", "v0.3.0")
    with pytest.raises(SystemExit, match=r"no section of 0\.3\.0; rename Unreleased to"):
        script("version").main(checkout, checkout)


def test_two_tags_are_refused(checkout):
    git(checkout, "tag", "v0.2.0")
    git(checkout, "tag", "v0.2.1")
    with pytest.raises(SystemExit, match=r"v0\.2\.0, v0\.2\.1; a release has one"):
        script("version").main(checkout, checkout)


@pytest.fixture
def listed(tmp_path):
    """The list of components of a release that needs numpy, and what it is made from."""
    licences, sbom, wheel, installed = (script("licences"), *(tmp_path / n for n in ("sbom.json", "one.whl", "pip.json")))
    pytest.importorskip(licences.ZIG)
    wheel.write_text("a wheel")
    found = {"metadata": {"name": "NumPy"}, "download_info": {"archive_info": {"hashes": {"sha256": "1" * 64}}}}
    elsewhere = {"metadata": {"name": "local"}, "download_info": {"dir_info": {}}}  # what has no archive
    installed.write_text(json.dumps({"install": [found, elsewhere]}))
    packages = [(name, f"{name}==2") for name in ("numpy", "local", "pip")]
    needed = [{"type": "library", "name": n, "version": "2", "bom-ref": ref, "purl": f"pkg:pypi/{n}@2"} for n, ref in packages]
    root = {"type": "application", "name": "wheelchair-fmu", "bom-ref": "root"}
    dependencies = [{"ref": "root", "dependsOn": ["numpy==2"]}, {"ref": "numpy==2", "dependsOn": ["pip==2"]}, {"ref": "pip==2"}]
    content = {"bomFormat": "CycloneDX", "specVersion": "1.6", "metadata": {"component": root}}
    sbom.write_text(json.dumps({**content, "components": needed, "dependencies": dependencies}))
    return licences, sbom, wheel, [installed]


def test_every_script_that_comes_along_is_in_the_list_of_components_with_its_licence(listed):
    licences, sbom, wheel, installed = listed
    licences.add(sbom, "0.2.0", wheel, installed)
    once = sbom.read_text()
    licences.add(sbom, "0.2.0", wheel, installed)
    assert sbom.read_text() == once
    content = {c["bom-ref"]: c for c in json.loads(once)["components"]}
    files = {f.name for f in licences.VENDOR.glob("*.js")}
    added = {ref.removeprefix("vendored-"): c for ref, c in content.items() if ref.startswith("vendored-")}
    assert len(added) == len(files)
    for short, one in added.items():
        (file,) = (licences.VENDOR / f for f in files if f.startswith(f"{short}-{one['version']}."))
        assert one["hashes"] == [{"alg": "SHA-256", "content": hashlib.sha256(file.read_bytes()).hexdigest()}]
        assert one["licenses"] == [{"license": {"id": "MIT"}}]
        assert "free of charge" in (licences.VENDOR / f"{short}-LICENSE.txt").read_text()  # which is that licence's
    inside = {c["name"]: c for c in added["jspdf"]["components"]}
    assert inside["pako"]["purl"] == "pkg:npm/pako@2.1.0"
    assert inside["pako"]["licenses"] == [{"expression": "MIT AND Zlib"}]


def test_the_list_of_components_has_digests_and_what_the_compiler_links_in(listed):
    licences, sbom, wheel, installed = listed
    licences.add(sbom, "0.2.0", wheel, installed)
    content = json.loads(sbom.read_text())
    root, known = content["metadata"]["component"], {c["bom-ref"]: c for c in content["components"]}
    assert root["version"] == "0.2.0"
    assert root["hashes"] == [{"alg": "SHA-256", "content": hashlib.sha256(b"a wheel").hexdigest()}]
    assert known["numpy==2"]["hashes"] == [{"alg": "SHA-256", "content": "1" * 64}]
    assert "hashes" not in known["local==2"]
    assert known["ziglang"]["version"] == metadata.version("ziglang")
    assert {c["name"] for c in known["ziglang"]["components"]} >= {"mingw-w64", "wasi-libc"}
    assert "pip==2" not in known  # neither in the release nor needed by it
    relations = {r["ref"]: r.get("dependsOn", []) for r in content["dependencies"]}
    assert relations["numpy==2"] == [] and set(relations["root"]) == {"numpy==2", "ziglang"} | {
        ref for ref in known if ref.startswith("vendored-")
    }


def test_the_list_of_components_keeps_its_schema(listed):
    pytest.importorskip("cyclonedx", reason="`pip install -e '.[release]'` brings what validates it")
    licences, sbom, wheel, installed = listed
    licences.add(sbom, "0.2.0", wheel, installed)
    script("validate").main(sbom)
    content = json.loads(sbom.read_text())
    content["components"][0]["hashes"][0]["content"] = "no digest"
    sbom.write_text(json.dumps(content))
    with pytest.raises(SystemExit, match="no digest"):
        script("validate").main(sbom)


def test_what_is_inside_others_is_told_by_their_own_words():
    licences = script("licences")
    for one in licences.INSIDE["script"]:
        assert one["said"] in licences.script(one["of"]).read_text("utf-8"), one["name"]
    zig = pytest.importorskip(licences.ZIG)
    for one in licences.INSIDE["runtime"]:
        assert one["said"] in (Path(zig.__file__).parent / one["file"]).read_text("utf-8"), one["name"]


# Words of comments with licences that are the script's own, by its contributors.
OWN = ("jsPDF", "Steven Spungin", "Aras Abbasi", "Owen Leong", "Youssef Beddad", "Eduardo Menezes", "Antti Palola", "uPlot")
BARE = re.compile(r"@license|Licensed under the MIT License\.|http://opensource\.org/licenses/mit-license|[\s*/]")


def test_no_licence_in_a_script_is_left_out():
    licences = script("licences")
    for short in licences.vendored():
        text = licences.script(short).read_text("utf-8")
        told = [one["said"] for one in licences.INSIDE["script"] if one["of"] == short]
        for comment in re.findall(r"/\*[*!].*?\*/", text, re.DOTALL):
            assert not BARE.sub("", comment) or any(words in comment for words in (*told, *OWN)), comment


def test_licences_are_told_in_their_own_words():
    text = script("licences").page()
    inside = ("pako, inside jsPDF", "deanm/omggif")
    for words in (
        *inside,
        "uPlot 1.",
        "Leon Sorokin",
        "yWorks GmbH",
        "\nnumpy 2",
        "NumPy Developers",
        "\npyarrow ",
        "\nCasADi ",
    ):
        assert words.lower() in text.lower(), words


def test_cells_of_notebooks_have_the_same_names_in_every_build(monkeypatch):
    pytest.importorskip("nbclient", reason="`pip install -e '.[site]'` brings what builds the site")
    from nbformat.v4 import nbbase

    monkeypatch.setattr(nbbase, "random_cell_id", nbbase.random_cell_id)  # put back afterwards
    named = []
    for _ in range(2):
        script("sphinx/conf")
        named.append([nbbase.new_code_cell().id, nbbase.new_markdown_cell().id])
    assert named[0] == named[1] and len(set(named[0])) == 2


PARTS = (
    "wheelchair_fmu",
    "fmu_src",
    "ssp",
    "examples",
    "references.bib",
    "pyproject.toml",
    ".gitignore",
    "README.md",
    "LICENSE",
)
KERNEL = "wheelchair_fmu/engine/kernels/x86_64-linux/one.so"


@pytest.mark.nightly
@pytest.mark.parametrize("kind", ["wheel", "sdist"])
def test_two_builds_are_the_same_bytes(kind, tmp_path):
    """From two folders whose files have another age, and another order on the disk. A compiled model is no source."""
    pytest.importorskip("build")
    made = []
    for name, parts, copy in (("a", PARTS, shutil.copyfile), ("elsewhere", PARTS[::-1], shutil.copy2)):
        source, out = tmp_path / name / "source", tmp_path / name / "out"
        source.mkdir(parents=True)
        for part in parts:
            if (ROOT / part).is_dir():
                leave = shutil.ignore_patterns("__pycache__", "kernels")
                shutil.copytree(ROOT / part, source / part, copy_function=copy, ignore=leave)
            else:
                copy(ROOT / part, source / part)
        kernel = source / KERNEL
        kernel.parent.mkdir(parents=True)
        kernel.write_text("compiled")
        words = [sys.executable, "-m", "build", f"--{kind}", "--outdir", str(out), str(source)]
        subprocess.run(words, check=True, capture_output=True, cwd=tmp_path)
        (file,) = out.iterdir()
        made.append(file)
    assert made[0].name == made[1].name and made[0].read_bytes() == made[1].read_bytes()
    assert any(name.endswith(KERNEL) for name in contents(made[0])) == (kind == "wheel")


@pytest.mark.nightly
def test_two_releases_are_the_same_bytes(tmp_path):
    """All that `make release` makes of one commit with one tag, in two folders that share nothing that was compiled."""
    pytest.importorskip("ziglang")
    if not (ROOT / ".git").exists():
        pytest.skip("this is no checkout")
    first, second = tmp_path / "a" / "checkout", tmp_path / "elsewhere" / "checkout-by-another-name"
    git(tmp_path, "clone", "-q", ROOT, first)
    changes = first / "CHANGELOG.md"
    changes.write_text(changes.read_text("utf-8").replace("## [Unreleased]", "## [9.9.9] - 2026-11-25", 1), "utf-8")
    git(first, "-c", "user.name=n", "-c", "user.email=n@n", "commit", "-q", "-a", "-m", "a release")
    git(first, "tag", "v9.9.9")
    git(tmp_path, "clone", "-q", first, second)
    one, other = (released(place) for place in (first, second))
    assert {"SHA256SUMS", "sbom.cdx.json", "licences.txt", "Wheelchair.fmu", "documentation.tar.gz"} < set(one)
    assert sorted(one) == sorted(other)
    assert [words for name in one for words in differences(one[name], other[name])] == []


def released(checkout):
    """The files of a release from a checkout, by name."""
    ours = {"PYTHONPATH", "SOURCE_DATE_EPOCH"}
    own = {"RELEASE_TESTS": "none", "WHEELCHAIR_CACHE": str(checkout / "out" / "cache"), "WHEELCHAIR_CONFIG": os.devnull}
    environment = {**{k: v for k, v in os.environ.items() if k not in ours}, **own}
    words = ["make", "release", f"PYTHON={sys.executable}"]
    done = subprocess.run(words, cwd=checkout, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return {file.name: file for file in (checkout / "dist" / "release").iterdir()}


def differences(one, other):
    """In what two files differ: which members, where they are archives."""
    if one.read_bytes() == other.read_bytes():
        return []
    if not (zipfile.is_zipfile(one) or tarfile.is_tarfile(one)):
        return [one.name]
    a, b = contents(one), contents(other)
    return [one.name, *(f"{one.name}: {name}" for name in sorted(a.keys() | b.keys()) if a.get(name) != b.get(name))]


def contents(archive):
    """Digests of the files in a zip or a tar, by name."""
    if zipfile.is_zipfile(archive):
        with zipfile.ZipFile(archive) as file:
            return {name: hashlib.sha256(file.read(name)).hexdigest() for name in file.namelist()}
    with tarfile.open(archive) as file:
        return {m.name: hashlib.sha256(file.extractfile(m).read()).hexdigest() for m in file.getmembers() if m.isfile()}


def test_where_two_archives_differ_is_said(tmp_path):
    made = []
    for name, text in (("one", "1"), ("other", "2")):
        (tmp_path / name).mkdir()
        made.append(tmp_path / name / "a.zip")
        with zipfile.ZipFile(made[-1], "w") as file:
            file.writestr("same", "")
            file.writestr("number", text)
    assert differences(*made) == ["a.zip", "a.zip: number"] and differences(made[0], made[0]) == []
