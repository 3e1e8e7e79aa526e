"""What is in the archives, and that two builds are the same."""

from __future__ import annotations

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from lxml import etree

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.errors import Failure, UsageError
from wheelchair_fmu.fmu import native, parameter_set
from wheelchair_fmu.fmu.companions import build_floor, build_pusher
from wheelchair_fmu.fmu.parameter_set import NAMESPACE, qualified
from wheelchair_fmu.fmu.validate import problems
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies.ssp import sources
from wheelchair_fmu.studies.ssp.building import build
from wheelchair_fmu.studies.ssp.checking import check
from wheelchair_fmu.studies.ssp.reading import opened

from .conftest import RECORDING

DESCRIPTIONS = ("SystemStructure.ssd", "Interface.ssd")


@pytest.mark.parametrize("name", ["pusher", "replaying", "floor"])
def test_fmpy_finds_no_fault_in_an_fmu(name, request):
    unpacked = request.getfixturevalue(name)
    assert problems(unpacked.path) == []
    for v in unpacked.description.modelVariables:
        assert v.description and (v.unit or v.type != "Real"), v.name
    page = (unpacked.folder / "documentation" / "index.html").read_text(encoding="utf-8")
    assert "$" not in page and unpacked.description.outputs[0].variable.name in page
    assert all((unpacked.folder / file).exists() for file in ("documentation/licenses/license.txt", "model.png"))


def test_two_builds_of_an_fmu_are_the_same_bytes(pusher, replaying, floor, tmp_path):
    assert build_pusher(tmp_path / "p.fmu", {}).read_bytes() == pusher.path.read_bytes()
    assert build_floor(tmp_path / "f.fmu", {}).read_bytes() == floor.path.read_bytes()
    assert build_pusher(tmp_path / "r.fmu", {"pusher.mode": "replay"}, RECORDING).read_bytes() == replaying.path.read_bytes()


@pytest.mark.parametrize("name", ["pusher", "replaying", "floor"])
def test_an_fmu_exports_nothing_but_fmi_and_needs_nothing_but_libc(name, request):
    library = str(request.getfixturevalue(name).library)
    exported = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True, check=True).stdout
    assert exported and all(re.fullmatch(r"\S+ T fmi[23]\w+", line) for line in exported.splitlines())
    needed = subprocess.run(["readelf", "-d", library], capture_output=True, text=True, check=True).stdout
    assert set(re.findall(r"\(NEEDED\).*\[(.+)]", needed)) <= {"libc.so.6", "libm.so.6"}


@pytest.mark.parametrize("name", ["replaying", "floor"])
def test_an_fmu_compiles_without_a_warning(name, request, tmp_path):
    source = request.getfixturevalue(name).folder / "sources" / native.UNIT
    done = subprocess.run(
        [
            *compiler.command(),
            "-std=c11",
            "-O1",
            "-Wall",
            "-Wextra",
            "-Wpedantic",
            "-Werror",
            "-fPIC",
            "-c",
            f"-I{native.headers()}",
            str(source),
            "-o",
            str(tmp_path / "object.o"),
        ],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr


def test_an_archive_holds_fmus_sets_and_a_mapping_and_has_no_fault(slalom):
    names = set(zipfile.ZipFile(slalom).namelist())
    fmus = {f"resources/{n}.fmu" for n in ("Wheelchair", "Pusher", "Floor")}
    sets = {f"resources/{n}.ssv" for n in ("reference", "deflated-tyres", "low-cost-tyre", "carpet", "fitted", "handles")}
    assert names >= {*DESCRIPTIONS, *fmus, *sets, "resources/handles.ssm", "documentation/licenses/license.txt"}
    assert check(slalom) == []


def test_two_builds_of_an_archive_are_the_same_bytes(slalom, tmp_path):
    assert build("slalom", tmp_path / "again.ssp").read_bytes() == slalom.read_bytes()


@pytest.mark.parametrize("version", ["1", "2"])
def test_pyssp_standard_finds_it_valid(version, slalom, tmp_path):
    pytest.importorskip("pyssp_standard", reason="pip install wheelchair-fmu[ssp]")
    from pyssp_standard.ssd import SSD
    from pyssp_standard.ssm import SSM
    from pyssp_standard.ssv import SSV

    path = slalom if version == "1" else build("slalom", tmp_path / "two.ssp", version="2")
    readers = {".ssd": SSD, ".ssv": SSV, ".ssm": SSM}
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path / "x")
    checked = 0
    for file in sorted((tmp_path / "x").rglob("*.ss[dvm]")):
        assert etree.parse(file).getroot().get("version") == sources.VERSIONS[version]
        if version == "1":
            readers[file.suffix](file).__check_compliance__()
        else:
            import xmlschema

            kind = {".ssd": "Description", ".ssv": "ParameterValues", ".ssm": "ParameterMapping"}[file.suffix]
            resources = Path(sys.modules["pyssp_standard"].__file__).parent / "resources" / "ssp2"
            xmlschema.validate(file, xmlschema.XMLSchema10(resources / f"SystemStructure{kind}.xsd"))
        checked += 1
    assert checked == 12
    assert check(path) == []


def test_other_readers_see_the_same_system(slalom):
    pytest.importorskip("pyssp_standard", reason="pip install wheelchair-fmu[ssp]")
    from fmpy.ssp.ssd import read_ssd
    from pyssp_standard.ssp import SSP

    system = read_ssd(str(slalom)).system
    assert [e.name for e in system.elements] == list(sources.COMPONENTS) and len(system.connections) == 14
    with SSP(slalom, mode="r") as archive, archive.system_structure as description:
        assert len(description.connections()) == 14
        assert description.check_connections(connector_not_in_system=True) == []


def test_every_unit_is_defined_and_every_element_is_on_the_canvas(slalom):
    with zipfile.ZipFile(slalom) as archive:
        roots = [etree.fromstring(archive.read(name)) for name in DESCRIPTIONS]
    for root in roots:
        defined = {u.get("name") for u in root.iter(qualified("ssc:Unit"))}
        used = {r.get("unit") for r in root.iter(qualified("ssc:Real"))}
        assert used and used <= defined
        canvas = next(root.iter(qualified("ssd:SystemGeometry")))
        places = list(root.iter(qualified("ssd:ElementGeometry")))
        assert len(places) == 3
        for place in places:
            for k in "xy":
                edges = [float(e.get(f"{k}{i}")) for e, i in ((canvas, 1), (place, 1), (place, 2), (canvas, 2))]
                assert edges == sorted(edges) and len(set(edges)) == 4
        assert root.find(qualified("ssd:DefaultExperiment")).get("stopTime") == "30"


def test_the_interface_has_connectors_of_its_own(slalom):
    with opened(slalom) as archive:
        outer, plain = (archive.system(name) for name in reversed(DESCRIPTIONS))
    assert plain.connectors == () and all(c.start_element and c.end_element for c in plain.connections)
    assert {k.kind for k in outer.connectors} == {"input", "output", "parameter"}
    led = {
        c.end_connector if not c.end_element else c.start_connector
        for c in outer.connections
        if not (c.start_element and c.end_element)
    }
    assert led == {k.name for k in outer.connectors}


def test_a_set_written_is_the_set_read(tmp_path, slalom):
    variant = Variant().with_values({"chair.m": 91.5, "tyre.pressure": 2.5, "tyre.law": "magic_formula"})
    wanted = parameter_set.from_variant(variant, "mine", "a heavier user")
    assert wanted.settings["tyre.law"].value == "magic_formula"
    with opened(slalom) as archive:
        for version in sources.VERSIONS.values():
            (archive.folder / "mine.ssv").write_bytes(parameter_set.text(wanted, version))
            read = archive.parameter_set("mine.ssv")
            assert (read.name, dict(read.settings), read.description) == ("mine", wanted.settings, "a heavier user")
            archive._read.clear()
        assert archive.faults == []
    assert {u.name: u.factor for u in wanted.units}["bar"] == 1e5


def test_the_reference_set_is_table_1():
    settings = parameter_set.reference().settings
    table = {
        "chair.a": 0.25,
        "chair.b": 0.20,
        "chair.t_r": 0.55,
        "chair.t_f": 0.45,
        "chair.m": 80.0,
        "chair.I_z": 3.08,
        "tyre.C_lambda": 5038.0,
        "tyre.C_m_lambda": 45.0,
        "tyre.C_phi": 464.0,
    }
    assert {name: settings[name].value for name in table} == table


@pytest.mark.parametrize("name", sources.parameter_sets())
def test_every_set_belongs_to_a_component(name):
    component, found = sources.parameter_set(name)
    assert component in sources.COMPONENTS and found.settings and found.description


@pytest.mark.parametrize("name", sources.systems())
def test_every_system_is_well_formed(name):
    assert sources.system(name).title


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("stop = 1.0\nstep = 0.1", "no title"),
        ('title = "t"\nstop = -1.0\nstep = 0.1', "stop = -1.0 is no time"),
        ('title = "t"\nstop = 1.0\nstep = 0.1\n[Pushr]', "did you mean 'Pusher'"),
        (
            'title = "t"\nstop = 1.0\nstep = 0.1\n[Pusher]\n"stroke.cadens" = 1.0',
            "[Pusher]: no parameter 'stroke.cadens'; did you",
        ),
        ('title = "t"\nstop = 1.0\nstep = 0.1\n[Floor]\n"ramp.slope" = 2.0', "[Floor]: ramp.slope = 2.0 is outside its bounds"),
        ("title = ", "not a TOML file"),
    ],
)
def test_a_bad_source_is_refused_by_name(text, told, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(text)
    with pytest.raises((Failure, UsageError), match=re.escape(told)):
        sources.system(str(file))


def test_namespaces_are_those_of_the_standard():
    assert NAMESPACE["ssd"] == "http://ssp-standard.org/SSP1/SystemStructureDescription"
