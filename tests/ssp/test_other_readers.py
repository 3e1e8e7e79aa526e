"""What importers need that read less of an archive than its parameter sets: start values, fed connectors, names, a page."""

from __future__ import annotations

import re
import zipfile

import pytest
from fmpy.ssp.simulation import simulate_ssp
from lxml import etree

from tests.fmu.chair import Unpacked, chair
from wheelchair_fmu.fmu.parameter_set import qualified
from wheelchair_fmu.studies.ssp.building import BOUND, build
from wheelchair_fmu.studies.ssp.reading import opened
from wheelchair_fmu.studies.ssp.running import run

MAIN, INTERFACE = "SystemStructure.ssd", "Interface.ssd"


@pytest.fixture(scope="module")
def uphill(workshop):
    """A system in which chair, person and floor all have values that are not the FMUs' defaults."""
    return build("ramp", workshop / "uphill.ssp")


def test_an_fmu_starts_with_what_is_bound_in_words_and_in_c(uphill):
    """Both in the modelDescription.xml that importers show, and in what the library holds before anything is set."""
    with opened(uphill) as archive:
        plain = archive.system(MAIN)
        for component in plain.components:
            bound = archive.parameter_set(component.bindings[0].source)
            fmu = archive.fmu(component.source)
            values = {name: setting.value for name, setting in bound.settings.items()}
            assert bound.name == BOUND and values and all(float(fmu.variables[n].start) == v for n, v in values.items())
            with chair(Unpacked.of(archive.folder / component.source, archive.folder / component.name)) as c:
                assert c.get(*values) == list(values.values())
        assert float(archive.fmu("resources/Wheelchair.fmu").variables["start.u"].start) == 0.0
        assert float(archive.fmu("resources/Floor.fmu").variables["ramp.slope"].start) == -0.05


@pytest.mark.parametrize("system", ["slalom", "uphill"])
def test_fmpy_which_reads_no_parameter_sets_runs_the_same_system(system, request):
    path, step, stop = request.getfixturevalue(system), 0.01, 4.0
    ours = run(path, step=step, stop=stop)
    theirs = simulate_ssp(str(path), stop_time=stop - step / 2, step_size=step)
    assert len(theirs) == round(stop / step) and ours["Chair.chair.x"][-1] > 1.0
    for name in ("Chair.chair.x", "Chair.chair.y", "Chair.chair.psi", "Chair.chair.u", "Chair.slip.rl"):
        assert theirs[name][-1] == pytest.approx(ours[name][-1], abs=1e-9), name


@pytest.mark.parametrize("description", [MAIN, INTERFACE])
def test_every_input_that_is_listed_is_fed(description, slalom):
    """FMPy sets a listed input that nothing feeds to zero: a chair on a floor without rolling resistance."""
    with opened(slalom) as archive:
        system = archive.system(description)
    fed = {(c.end_element, c.end_connector) for c in system.connections} | {
        (c.start_element, c.start_connector) for c in system.connections if not c.end_element
    }
    listed = {(c.name, k.name) for c in system.components for k in c.connectors if k.kind == "input"}
    assert listed and listed <= fed
    assert ("Chair", "brake.rl") in listed or description == MAIN


def test_the_descriptions_in_an_archive_have_names_of_their_own(slalom):
    """OMSimulator takes them as variants by name."""
    with zipfile.ZipFile(slalom) as archive:
        roots = [etree.fromstring(archive.read(name)) for name in (MAIN, INTERFACE)]
    assert [r.get("name") for r in roots] == ["slalom", "slalom-interface"]
    assert [r.find(qualified("ssd:System")).get("name") for r in roots] == ["slalom", "slalom-interface"]


def test_the_page_says_what_is_connected_and_with_which_values(slalom):
    with zipfile.ZipFile(slalom) as archive:
        names, page = archive.namelist(), archive.read("documentation/index.html").decode()
    root = etree.HTML(page)
    assert "$" not in page and all(f"documentation/{link}" in names for link in root.xpath("//a/@href"))
    with opened(slalom) as archive:
        plain, bound = archive.system(MAIN), archive.parameter_set("resources/Pusher.ssv")
    rows = [["".join(cell.itertext()) for cell in row] for row in root.iter("tr")]
    for c in plain.connections:
        assert any(row[:1] + row[2:4] == [c.start_connector, c.start_element, c.end_element] for row in rows), c
    for name, setting in bound.settings.items():
        assert any(row[0] == f"Pusher.{name}" and float(row[1]) == setting.value for row in rows), name
    assert ["Pusher.pusher.mode", "follow"] in [row[:2] for row in rows]
    drawn = re.findall(r"[\w.]+", " ".join(root.xpath("//svg//text/text()")))
    assert {c.start_connector for c in plain.connections} <= set(drawn)


def test_what_the_page_says_of_fmpy_runs(slalom, tmp_path, monkeypatch):
    """With the stop time shortened, so that it takes a second."""
    with zipfile.ZipFile(slalom) as archive:
        code = "".join(etree.HTML(archive.read("documentation/index.html")).xpath("//pre//text()"))
    lines = code.split("# FMPy", 1)[1].split("\n", 1)[1].split("\n\n", 1)[0]
    (tmp_path / "Slalom.ssp").write_bytes(slalom.read_bytes())
    monkeypatch.chdir(tmp_path)
    known: dict = {}
    exec(lines.replace("stop_time=30", "stop_time=1"), known)
    assert len(known["result"]) in (200, 201) and known["result"]["Chair.chair.x"][-1] > 0.1
