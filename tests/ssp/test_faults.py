"""Every fault of an .ssp is told with file, line, element and cure; all at once, and none as a traceback."""

from __future__ import annotations

import io
import re
import zipfile

import pytest

from wheelchair_fmu.errors import Failure, FormerName, SystemStructureError
from wheelchair_fmu.studies.ssp import unpacking
from wheelchair_fmu.studies.ssp.checking import check
from wheelchair_fmu.studies.ssp.running import run

MAIN, CHAIR, HANDLES = "SystemStructure.ssd", "resources/Chair.ssv", "resources/handles.ssm"
FAULTS = [
    (MAIN, "</ssd:System>", "", r"SystemStructure.ssd line \d+: not well-formed XML: "),
    (MAIN, "SSP1/SystemStructureDesc", "SSP9/SystemStructureDesc", "the root is .*; write ssd:SystemStructureDescription"),
    (MAIN, 'version="1.0"', 'version="3.0"', "version '3.0' is unknown; give 1.0 or 2.0"),
    (MAIN, 'kind="input"', 'kind="entrance"', r"line \d+: not as the schema of SSP 1.0 wants it: .*kind.*; put elements in"),
    (
        MAIN,
        "resources/Floor.fmu",
        "resources/Flor.fmu",
        r"line \d+, Component Floor: source 'resources/Flor.fmu' is not in the "
        "archive; did you mean 'resources/Floor.fmu'",
    ),
    (MAIN, "resources/Floor.fmu", "../Floor.fmu", r"Component Floor: source '../Floor.fmu' is not in the archive"),
    (MAIN, "resources/Floor.fmu", "resources/Floor.ssv", r"resources/Floor.ssv: not an FMU: .*; give a file that"),
    (MAIN, 'name="Pusher"', 'name="Chair"', "Component Chair: the name stands here twice; give each its own"),
    (
        MAIN,
        '"push.F_rl" kind="input"',
        '"push.F_l" kind="input"',
        "Connector Chair.push.F_l: the FMU has no such variable; did you mean 'push.F_rl'",
    ),
    (MAIN, '"push.F_rl" kind="input"', '"push.F_rl" kind="output"', "it is of kind output, but the FMU has it as input;"),
    (MAIN, '<ssc:Real unit="N"/>', "<ssc:Integer/>", "F_rl: it is of type Integer, but the FMU has it as Real; write"),
    (MAIN, '<ssc:Real unit="N"/>', '<ssc:Real unit="m"/>', "Connector Chair.push.F_rl: it is in m, but the FMU has it in N"),
    (MAIN, '<ssc:Real unit="N"/>', '<ssc:Real unit="kN"/>', "Connector push.F_rl: unit 'kN' is not defined in Units"),
    (
        MAIN,
        'startElement="Pusher" startConnector="push.F_rl"',
        'startElement="Pushr" startConnector="push.F_rl"',
        r"connection Pushr.push.F_rl → Chair.push.F_rl: there is no element 'Pushr'; did you mean 'Pusher'",
    ),
    (
        MAIN,
        'startElement="Pusher" startConnector="push.F_rl"',
        'startElement="Pusher" startConnector="push.F_rk"',
        "Pusher has no connector 'push.F_rk'; did you mean .*'push.F_rl'",
    ),
    (
        MAIN,
        'startElement="Pusher" startConnector="push.F_rl"',
        'startElement="Pusher" startConnector="chair.x"',
        "it leads from kind input to kind input; lead from an output to an input",
    ),
    (
        MAIN,
        'endElement="Chair" endConnector="push.F_rl"',
        'endElement="Chair" endConnector="push.F_rr"',
        "another connection ends there too; leave one of them out",
    ),
    (
        MAIN,
        'endElement="Chair" endConnector="push.F_rl"',
        'endElement="Chair" endConnector="floor.slope_x"',
        "it leads from N to rad, which is another dimension; connect what measures the same",
    ),
    (MAIN, 'stopTime="30"', 'stopTime="-1"', "DefaultExperiment: stopTime -1 s is not after startTime 0 s; give"),
    (MAIN, 'baseStepSize="0.005"', 'baseStepSize="0"', "baseStepSize 0 s is not above 0; give a step such as 0.01"),
    (MAIN, 'implementation="CoSimulation"', 'implementation="ModelExchange"', "Chair: ModelExchange is asked for; ask for"),
    (MAIN, "application/x-fmu-sharedlibrary", "application/x-ssp-definition", "Component Chair: type .* is no FMU; give"),
    (MAIN, "<ssd:Elements>", '<ssd:Elements><ssd:System name="inner"/>', "System inner: only components are run here; put the"),
    (MAIN, "resources/Chair.ssv", "resources/chair.ssv", "Chair: 'resources/chair.ssv' is not in the archive; did"),
    (CHAIR, 'name="chair.m"', 'name="chair.mass"', r"line \d+, Parameter chair.mass: Chair has no such variable; did"),
    (CHAIR, 'name="chair.m"', 'name="chair.x"', "Parameter chair.x: Chair has it as output, which nobody sets; leave it out"),
    (CHAIR, 'name="chair.m"', 'name="chair.a"', "Parameter chair.a: the name stands here twice; leave one of them out"),
    (CHAIR, 'value="80"', 'value="-80"', "chair.m: -80 is outside the bounds 1 to 1000 kg of Chair; give a value"),
    (CHAIR, 'value="80"', 'value="heavy"', "Parameter chair.m: value = 'heavy' is not a finite number; write a number"),
    (CHAIR, 'value="80" unit="kg"', 'value="80" unit="m"', "unit 'm' has another dimension than 'kg'; give it in kg"),
    (CHAIR, 'value="80" unit="kg"', 'value="80" unit="stone"', "unit 'stone' is not defined in Units"),
    (CHAIR, '<ssv:Real value="80" unit="kg"/>', '<ssv:Boolean value="true"/>', "a Boolean, but the FMU has a Real; give"),
    (CHAIR, '<ssv:Real value="80" unit="kg"/>', '<ssv:String value="x"/>', "a value of type String is not read here"),
    (
        CHAIR,
        '"chair.m">\n      <ssv:Real value="80" unit="kg"/>',
        '"tyre.law"><ssv:Enumeration value="magic"/>',
        "Parameter tyre.law: 'magic' is no choice; choose linear or dugoff or magic_formula",
    ),
    (
        HANDLES,
        'source="chair.mass"',
        'source="chair.mas"',
        "MappingEntry chair.mas: resources/handles.ssv has no such parameter; did you mean 'chair.mass'",
    ),
    (HANDLES, 'target="mass"', 'target="weight"', "Parameter weight: Interface.ssd has no such parameter"),
    (
        HANDLES,
        'target="mass"/>',
        'target="mass"><ssc:BooleanMappingTransformation><ssc:MapEntry source="true" target="true"/>'
        "</ssc:BooleanMappingTransformation></ssm:MappingEntry>",
        "BooleanMappingTransformation is not read here; use a Linear",
    ),
]


@pytest.mark.parametrize(("file", "old", "new", "told"), FAULTS)
def test_a_fault_is_told_with_its_place_and_cure(file, old, new, told, altered):
    faults = [str(fault) for fault in check(altered({file: (old, new)}))]
    assert any(re.search(told, fault) for fault in faults), "\n".join(faults)
    assert all(re.match(r"\S+(?: line \d+)?(?:, [^:]+)?: .+; .+", fault) for fault in faults), "\n".join(faults)


def test_all_faults_are_told_together_and_stop_a_run(altered):
    path = altered({MAIN: ("resources/Floor.fmu", "resources/Flor.fmu"), CHAIR: ('value="80"', 'value="-80"'), HANDLES: None})
    assert len(check(path)) == 3
    with pytest.raises(SystemStructureError) as refused:
        run(path)
    assert "Flor.fmu" in str(refused.value) and "-80 is outside" in str(refused.value)


def test_without_a_main_description_nothing_is_found(altered):
    assert "there is no SystemStructure.ssd; give" in str(check(altered({MAIN: None}))[0])


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 cut off", b"<ssd/>"])
def test_what_is_no_archive_is_refused(content, tmp_path):
    (tmp_path / "x.ssp").write_bytes(content)
    with pytest.raises(Failure, match=r"x.ssp: not a zip archive that can be read"):
        check(tmp_path / "x.ssp")


def test_no_file_is_written_outside_the_archive(slalom, tmp_path):
    path = tmp_path / "bad.ssp"
    path.write_bytes(slalom.read_bytes())
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("../escaped.txt", "x")
    assert any("the name leads out of the archive" in str(f) for f in check(path))


@pytest.mark.parametrize("declared", ['<!ENTITY who SYSTEM "file:///etc/hostname">', '<!ENTITY who "somebody">', ""])
@pytest.mark.parametrize("file", [MAIN, CHAIR, HANDLES])
def test_entities_are_refused_in_one_sentence(file, declared, altered):
    begin = "encoding='UTF-8'?>\n"
    faults = check(altered({file: (begin, f"{begin}<!DOCTYPE any [{declared}]>\n")}))
    assert [f"{f.file}: {f.fact}" for f in faults if f.file == file] == [
        f"{file}: it begins with a document type declaration (DTD), and entities are not read here"
    ]


def test_an_entity_in_use_is_refused_not_read(altered):
    begin = "encoding='UTF-8'?>\n"
    path = altered({CHAIR: ('name="chair.m">', 'name="chair.m">&who;')})
    changed = path.with_name("entity.ssp")
    with zipfile.ZipFile(path) as good, zipfile.ZipFile(changed, "w") as made:
        for name in good.namelist():
            text = good.read(name)
            made.writestr(
                name,
                text.replace(begin.encode(), f'{begin}<!DOCTYPE s [<!ENTITY who "<x/>">]>'.encode()) if name == CHAIR else text,
            )
    assert ["document type declaration" in f.fact for f in check(changed)] == [True]


def test_processing_instructions_and_comments_are_passed_over(altered):
    assert check(altered({CHAIR: ('name="chair.m">', 'name="chair.m"><?any word?><!-- word -->')})) == []


@pytest.mark.parametrize(("limit", "value"), [("MOST_BYTES", 1000), ("MOST_FILES", 3)])
def test_an_archive_that_unpacks_to_too_much_is_refused(limit, value, slalom, monkeypatch):
    monkeypatch.setattr(unpacking, limit, value)
    with pytest.raises(Failure, match=r"slalom.ssp: \d+ files of \d+ MB in all, unpacked, are more than .*; pack less"):
        check(slalom)


def test_an_fmu_that_unpacks_to_too_much_is_refused(altered, slalom, monkeypatch):
    """A gigabyte of zeros is a megabyte in an archive."""
    with zipfile.ZipFile(slalom) as good:
        floor = good.read("resources/Floor.fmu")
    large = io.BytesIO(floor)
    with zipfile.ZipFile(large, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("resources/zeros", bytes(50_000_000))
    monkeypatch.setattr(unpacking, "MOST_BYTES", 40_000_000)
    faults = check(altered({"resources/Floor.fmu": large.getvalue()}))
    assert [f.file for f in faults] == ["resources/Floor.fmu"] and "of 50 MB in all" in faults[0].fact


def test_a_name_that_no_disk_takes_is_no_traceback(slalom, tmp_path):
    path = tmp_path / "bad.ssp"
    path.write_bytes(slalom.read_bytes())
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("x" * 300, "x")
    with pytest.raises(Failure, match=r"bad.ssp: not a zip archive that can be read"):
        check(path)


OLD = '"chair.m">\n      <ssv:Real value="80" unit="kg"/>\n    </ssv:Parameter>'
CAMBER = "effect.camber_misalignment"


def parameters(**angles: float) -> str:
    """The mass and these angles, in place of the mass alone."""
    more = (f'<ssv:Parameter name="{CAMBER}.{n}"><ssv:Real value="{v}"/></ssv:Parameter>' for n, v in angles.items())
    return OLD + "".join(more)


def test_former_names_in_a_parameter_set_are_read(altered):
    path = altered({CHAIR: (OLD, parameters(phi_r=0.02, phi_l=0.01))})
    with pytest.warns(FormerName, match=rf"{CAMBER}.sum = 0.03 rad and {CAMBER}.difference = 0.01 rad") as told:
        trace = run(path, stop=0.1)
    assert len({str(w.message) for w in told}) == 1
    assert trace.parameters[f"Chair.{CAMBER}.sum"] == pytest.approx(0.03)


@pytest.mark.parametrize(
    ("angles", "told"),
    [
        ({"phi_r": 0.02, "sum": 0.01}, "is the former name of a part of .*and both are given; give"),
        ({"phi_r": 0.7}, rf"Parameter {CAMBER}.sum: 0.7 is outside the bounds -0.6 to 0.6 rad of Chair"),
    ],
)
@pytest.mark.filterwarnings("ignore::wheelchair_fmu.errors.FormerName")
def test_faults_of_former_names(angles, told, altered):
    faults = [str(fault) for fault in check(altered({CHAIR: (OLD, parameters(**angles))}))]
    assert any(re.search(told, fault) for fault in faults), "\n".join(faults)
