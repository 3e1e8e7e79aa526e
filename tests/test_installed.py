"""The wheel, in an environment and a folder that know nothing of the checkout."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest

from wheelchair_fmu import __version__

ROOT = Path(__file__).parents[1]
KEPT = ("coast-down", "random-steps", "holdout-random")  # runs of the sample that show its effect, and are soon diagnosed


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    _ran([sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "-w", str(folder), str(ROOT)], folder)
    (made,) = folder.glob("*.whl")
    return made


@pytest.fixture(scope="module")
def home(wheel, tmp_path_factory) -> Path:
    """A folder with an environment of its own, in which only the wheel is ours; what it needs is that of this environment."""
    folder = tmp_path_factory.mktemp("elsewhere")
    _ran([sys.executable, "-m", "venv", "--without-pip", str(folder / "venv")], folder)
    packages = Path(
        _ran([str(_bin(folder) / "python"), "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], folder)
    )
    with zipfile.ZipFile(wheel) as archive:  # as an installer does with one of Python alone
        archive.extractall(packages)
    # A line of site-packages itself, not of its .pth files, which lead to the checkout.
    (packages / "needed.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    return folder


def _bin(home: Path) -> Path:
    return home / "venv" / ("Scripts" if os.name == "nt" else "bin")


def _ran(words: list[str], folder: Path) -> str:
    bare = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, encoding="utf-8", env=bare)
    assert done.returncode == 0, (words, done.stdout, done.stderr)
    return done.stdout.strip()


def wheelchair(home: Path, *words: str) -> str:
    return _ran([str(_bin(home) / "python"), "-m", "wheelchair_fmu", *words], home)


def test_it_has_all_but_the_tests(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    here = {f"wheelchair_fmu/{f.relative_to(ROOT / 'wheelchair_fmu').as_posix()}" for f in _files(ROOT / "wheelchair_fmu")}
    shared = {
        f"wheelchair_fmu/share/{f.relative_to(ROOT).as_posix()}"
        for folder in ("fmu_src", "ssp", "examples")
        for f in _files(ROOT / folder)
    }
    assert here | shared | {"wheelchair_fmu/share/references.bib"} == {
        n for n in names if not re.match(r"[^/]*\.dist-info/", n)
    }


def _files(folder: Path) -> list[Path]:
    return [f for f in folder.rglob("*") if f.is_file() and "__pycache__" not in f.parts]


def test_it_is_where_it_was_installed(home):
    code = "import wheelchair_fmu as wc; from wheelchair_fmu.resources import ROOT; print(wc.__version__, ROOT)"
    version, place = _ran([str(_bin(home) / "python"), "-c", code], home).split(maxsplit=1)
    assert version == __version__ and Path(place).is_relative_to(home / "venv")


def test_it_builds_fmus_and_systems(home):
    made = wheelchair(home, "build", "-o", "chair.fmu", "--effects", "none")
    assert made.splitlines() == ["chair.fmu", "chair.fmi3.fmu"]
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(home / "chair.fmu")) == []
    assert wheelchair(home, "ssp", "build", "ramp", "-o", "Ramp.ssp") == "Ramp.ssp"


def test_it_diagnoses_its_sample_and_reports(home):
    assert wheelchair(home, "sample", "my-campaign").splitlines()[0] == str(Path("my-campaign") / "campaign.toml")
    file = home / "my-campaign" / "campaign.toml"
    head, *runs = file.read_text(encoding="utf-8").split("[[run]]")
    assert len(runs) == 10 and "no faults" in wheelchair(home, "check", "my-campaign")
    kept = [run for run in runs if any(f'"runs/{name}.csv"' in run for name in KEPT)]
    file.write_text("[[run]]".join([head, *kept]), encoding="utf-8")
    wheelchair(home, "diagnose", "my-campaign", "--json", "diagnosis.json")
    assert "rolling_resistance_asymmetry" in json.loads((home / "diagnosis.json").read_text(encoding="utf-8"))["effects"]
    assert wheelchair(home, "report", "my-campaign", "--diagnosis", "diagnosis.json", "-o", "report.html") == "report.html"
    assert (home / "report.html").stat().st_size > 4e5


def test_nothing_is_written_over(home):
    wheelchair(home, "sample", "rig", "--kind", "tyre")
    again = [str(_bin(home) / "python"), "-m", "wheelchair_fmu", "sample", "rig", "--kind", "tyre"]
    done = subprocess.run(again, cwd=home, capture_output=True, text=True)
    assert done.returncode == 1 and "rotating-disc.csv: is there already; give a new folder" in done.stderr
