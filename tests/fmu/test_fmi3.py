"""What FMI 3.0 has beyond FMI 2.0: each flag that the description states, and each function that it does not."""

from __future__ import annotations

import ctypes
import io
import platform
import re
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import numpy as np
import pytest
from fmpy import fmi3
from lxml import etree

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.fmu import native as native_flavour
from wheelchair_fmu.fmu import related

from .chair import ERROR, Unpacked, chair, pushed
from .test_protocol import refused

SCHEMAS = Path(fmpy.__file__).parent / "schema" / "fmi3"


@pytest.mark.parametrize("archive", ["native", "native3"])
def test_the_reference_results_are_what_fmpy_gets(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    files = zipfile.ZipFile(unpacked.path)
    inputs, expected = (_table(files.read(f"{related.FOLDER}/{name}.csv")) for name in ("reference_in", "reference"))
    outputs = [n for n in expected.dtype.names if n != "time"]
    with chair(unpacked) as c:
        c.start()
        for i in range(len(expected) - 1):
            c.set({n: inputs[n][i] for n in inputs.dtype.names if n != "time"})
            c.step(0.01)
            assert c.get(*outputs) == pytest.approx([expected[n][i + 1] for n in outputs], rel=1e-8, abs=1e-8)


def _table(text: bytes) -> np.ndarray:
    return np.genfromtxt(io.BytesIO(text), delimiter=",", names=True, deletechars="")


def test_both_versions_step_alike(native, native3):
    ends = []
    for unpacked in (native, native3):
        with chair(unpacked) as c:
            c.start({"tyre.law": 2, "effect.lateral_load_transfer.h": 0.5})
            for i in range(150):
                c.set(pushed(i))
                c.step(0.01)
            ends.append(c.outputs())
    assert ends[0] == ends[1]


def test_both_versions_describe_the_same_variables(native, native3):
    def known(unpacked: Unpacked) -> list:
        same = {"Real": "Float64"}
        return [
            (
                v.name,
                v.valueReference,
                same.get(v.type, v.type),
                v.causality,
                v.variability,
                v.start,
                v.min,
                v.max,
                v.nominal,
                v.unit,
                v.displayUnit,
                v.quantity,
                v.declaredType and v.declaredType.name,
                v.reinit,
                v.derivative and v.derivative.name,
            )
            for v in unpacked.description.modelVariables
        ]

    def depends(unknowns) -> list:
        return [(u.variable.name, [d.name for d in u.dependencies], u.dependenciesKind) for u in unknowns]

    assert known(native) == known(native3)
    for part in ("outputs", "derivatives", "initialUnknowns"):
        assert depends(getattr(native.description, part)) == depends(getattr(native3.description, part)), part


@pytest.mark.parametrize(
    ("name", "schema"),
    [
        ("modelDescription.xml", "fmi3ModelDescription.xsd"),
        ("terminalsAndIcons/terminalsAndIcons.xml", "fmi3TerminalsAndIcons.xsd"),
        ("sources/buildDescription.xml", "fmi3BuildDescription.xsd"),
    ],
)
def test_files_obey_their_schemas(name, schema, native, native3):
    """FMI 2.0.4 has the last two from FMI 3.0, schemas and all."""
    for archive in (native, native3) if "/" in name else (native3,):
        parsed = etree.parse(str(archive.folder / name))
        etree.XMLSchema(etree.parse(str(SCHEMAS / schema))).assertValid(parsed)


@pytest.mark.parametrize("archive", ["native", "native3"])
def test_what_is_beside_fmi_is_in_a_manifest(archive, request):
    """By the layered standard fmi-ls-ref; the set is read back and gives the values that the build starts from."""
    unpacked: Unpacked = request.getfixturevalue(archive)
    folder = unpacked.folder / related.FOLDER
    root = ElementTree.parse(folder / "fmi-ls-manifest.xml").getroot()
    assert root.tag == "fmiReferences" and root.get(f"{{{related.NAMESPACE}}}fmi-ls-name") == folder.name
    roles = {r.get("source"): r.get("role") for r in root.iter("Related")}
    assert roles == {"start.ssv": "parameter", "reference_in.csv": "testcase", "reference.csv": "result"}
    assert {f.name for f in folder.iterdir()} == {*roles, "fmi-ls-manifest.xml"}
    starts = {v.name: v.start for v in unpacked.description.modelVariables if v.causality == "parameter"}
    given = ElementTree.parse(folder / "start.ssv").getroot()
    values = {p.get("name"): p[0].get("value") for p in given.iter() if p.tag.endswith("}Parameter")}
    assert values.keys() == starts.keys() and values["tyre.law"] == "linear"
    assert all(float(values[n]) == float(s) for n, s in starts.items() if n not in ("tyre.law", "speed.mode"))


@pytest.mark.parametrize("archive", ["native", "native3"])
def test_terminals_name_variables_and_icons(archive, request):
    native3: Unpacked = request.getfixturevalue(archive)
    root = ElementTree.parse(native3.folder / "terminalsAndIcons" / "terminalsAndIcons.xml").getroot()
    names = {v.name for v in native3.description.modelVariables}
    assert [t.get("name") for t in root.iter("Terminal")] == ["pushrim_left", "pushrim_right", "floor"]
    assert {m.get("variableName") for m in root.iter("TerminalMemberVariable")} <= names
    for picture in root.iter("TerminalGraphicalRepresentation"):
        assert (native3.folder / "terminalsAndIcons" / f"{picture.get('iconBaseName')}.png").is_file()
    for name in ("icon", "floor", "pushrim"):
        assert (native3.folder / "terminalsAndIcons" / f"{name}.png").is_file()
        assert ElementTree.parse(native3.folder / "terminalsAndIcons" / f"{name}.svg").getroot().tag.endswith("svg")


def test_types_have_quantities_and_parameters_their_variability(native3):
    variables = {v.name: v for v in native3.description.modelVariables}
    assert {v.variability for v in variables.values() if v.causality == "parameter"} == {"fixed", "tunable"}
    assert not [v for v in variables.values() if v.causality == "structuralParameter"]  # nothing has a size to choose
    force = variables["push.F_rl"]
    assert (force.declaredType.name, force.quantity, force.unit) == ("Force", "Force", "N")
    assert (variables["chair.psi"].quantity, variables["chair.psi"].displayUnit) == ("Angle", "deg")
    assert (variables["der(chair.u)"].quantity, variables["der(chair.u)"].unit) == ("Acceleration", "m/s2")


@pytest.mark.parametrize("archive", ["native", "native3"])
def test_its_sources_compile_as_the_build_description_says(archive, request, tmp_path):
    """By a compiler without any options, to a library that gives the same bits."""
    unpacked: Unpacked = request.getfixturevalue(archive)
    root = ElementTree.parse(unpacked.folder / "sources" / "buildDescription.xml").getroot()
    files = root.find("BuildConfiguration/SourceFileSet")
    assert files.get("compilerOptions") is None  # which compiler they would be for is not known
    words = [f"-D{d.get('name')}={d.get('value')}" for d in files.iter("PreprocessorDefinition")]
    words += [f"-DFMI{unpacked.description.fmiVersion[0]}_OVERRIDE_FUNCTION_PREFIX", f"-I{native_flavour.headers()}"]
    units = [str(unpacked.folder / "sources" / f.get("name")) for f in files.iter("SourceFile")]
    other = tmp_path / unpacked.library.relative_to(unpacked.folder)
    other.parent.mkdir(parents=True)
    done = subprocess.run(
        [*compiler.command(), "-fPIC", "-shared", *words, *units, "-o", str(other), "-lm"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    with chair(unpacked) as c, chair(Unpacked(unpacked.path, tmp_path, unpacked.description)) as o:
        assert c.start(pushed(0)).step(0.01, 50).outputs() == o.start(pushed(0)).step(0.01, 50).outputs()


@pytest.mark.skipif(platform.machine().lower() not in ("x86_64", "amd64"), reason="asks an x86-64 compiler for -mfma")
def test_its_sources_keep_a_compiler_from_fusing_multiplications(few3, tmp_path):
    """A processor that can round a·b + c once gets the same digits as one that cannot."""
    unit, text = few3.folder / "sources" / "all.c", {}
    for name in ("all.c", "fused.c"):
        source = unit.with_name(name)
        if name == "fused.c":
            source.write_text(re.sub("#pragma (GCC opt|STDC).*", "", unit.read_text(encoding="utf-8")), encoding="utf-8")
        done = subprocess.run(
            [
                *compiler.command(),
                "-O1",
                "-fexpensive-optimizations",  # among which is the fusing, without the time that the rest of -O2 takes
                "-mfma",
                "-S",
                f"-I{native_flavour.headers()}",
                str(source),
                "-o",
                str(tmp_path / "text.s"),
            ],
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        text[name] = (tmp_path / "text.s").read_text(encoding="utf-8")
    assert text["fused.c"].count("vfmadd") > 100 > 10 * text["all.c"].count("vfmadd")


# ---- derivatives


def test_directional_and_adjoint_derivatives_are_of_one_matrix(everything3):
    rng = np.random.default_rng(3)
    with chair(everything3) as c:
        c.start({"start.psi_dot": 0.3, "push.F_rl": 20.0, "effect.lateral_load_transfer.h": 0.4}).step(0.01, 30)
        reference = everything3.reference
        unknowns = [reference(n) for n in (*everything3.names("output", "Float64"), *everything3.derivatives)]
        tunable = [n for n in everything3.names("parameter", "Float64") if c.types[n].variability == "tunable"]
        states = [c.types[n].derivative.name for n in everything3.derivatives]
        knowns = [reference(n) for n in (*everything3.names("input", "Float64"), *tunable, *states)]
        matrix = np.array([c.fmu.getDirectionalDerivative(unknowns, [k], [1.0]) for k in knowns]).T
        for _ in range(3):
            forward, back = rng.normal(size=len(knowns)), rng.normal(size=len(unknowns))
            there = c.fmu.getDirectionalDerivative(unknowns, knowns, forward)
            np.testing.assert_allclose(there, matrix @ forward, rtol=1e-9, atol=1e-9 * np.abs(matrix).max())
            here = c.fmu.getAdjointDerivative(unknowns, knowns, back, len(knowns))
            np.testing.assert_allclose(here, matrix.T @ back, rtol=1e-9, atol=1e-9 * np.abs(matrix).max())


def test_derivatives_by_states_are_those_of_the_equations(native3):
    """Chair's x' = u cos ψ − v sin ψ, and an output that is a state."""
    with chair(native3) as c:
        c.start({"start.psi": 0.5, "start.v": 0.02})
        r = native3.reference
        dx, du = c.fmu.getDirectionalDerivative([r("der(chair.x)"), r("chair.u")], [r("chair.u")], [1.0])
        assert (dx, du) == (pytest.approx(np.cos(0.5), rel=1e-12), 1.0)


def test_output_derivatives_are_the_slopes_of_the_outputs(native3, native):
    names = ["chair.x", "chair.u", "chair.psi_dot", "slip.rl", "sensor.a_y"]
    for unpacked in (native, native3):
        with chair(unpacked) as c:
            c.start({"push.F_rl": 25.0, "push.F_rr": 18.0, "effect.lateral_load_transfer.h": 0.5}).step(0.01, 20)
            references = [unpacked.reference(n) for n in names]
            if unpacked is native:
                slopes = c.fmu.getRealOutputDerivatives(references, [1] * len(names))
            else:
                slopes = c.fmu.getOutputDerivatives(references, [1] * len(names))
            before = np.array(c.get(*names))
            ahead = np.array(c.step(1e-5).get(*names))
            assert slopes == pytest.approx((ahead - before) / 1e-5, rel=2e-3, abs=1e-4)


def test_output_derivatives_of_other_things_are_refused(native3):
    with chair(native3) as c:
        c.start().step(0.01)
        refused(ERROR, c.fmu.getOutputDerivatives, [native3.reference("chair.x")], [2])
        refused(ERROR, c.fmu.getOutputDerivatives, [native3.reference("push.F_rl")], [1])
        assert c.sentences[0].startswith("fmi3GetOutputDerivatives: chair.x, order 2: only outputs have a derivative")


# ---- intermediate update, early return


def test_intermediate_updates_come_every_millisecond_and_change_nothing(native3):
    seen = []

    def update(environment, time, set_requested, get_allowed, finished, may_return, early, until):
        assert set_requested and get_allowed and finished and not may_return
        seen.append((time, told.get("chair.u")[0]))

    with chair(native3, update=update) as told, chair(native3) as plain:
        for c in (told, plain):
            c.start({"push.F_rl": 20.0, "push.F_rr": 15.0})
        for h in (0.01, 0.0037, 0.0203):
            assert told.fmu.doStep(told.time, h) == (False, False, False, told.time + h)
            told.time += h
            plain.step(h)
        assert told.outputs() == pytest.approx(plain.outputs(), rel=1e-12, abs=1e-13)
    times = [t for t, _ in seen]
    assert times == pytest.approx([k * 1e-3 for k in range(1, 34) if k != 10], abs=1e-12)
    assert np.all(np.diff([u for _, u in seen]) > 0)


def test_inputs_set_in_an_intermediate_update_act_from_there(native3):
    """A push of 50 N from 5 ms on, within one step of 10 ms."""

    def update(environment, time, *rest):
        if abs(time - 0.005) < 1e-9:
            inside.set({"push.F_rl": 50.0, "push.F_rr": 50.0})

    with chair(native3, update=update) as inside, chair(native3) as two:
        inside.start().step(0.01)
        two.start().step(0.005)
        two.set({"push.F_rl": 50.0, "push.F_rr": 50.0})
        two.step(0.005)
        assert inside.outputs() == pytest.approx(two.outputs(), rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("wanted", [0.0063, 0.006, 0.001])
def test_a_step_returns_early_where_it_is_asked_to(wanted, native3):
    def update(environment, time, set_requested, get_allowed, finished, may_return, early, until):
        assert may_return
        early[0], until[0] = True, wanted

    with chair(native3, update=update, early=True) as c, chair(native3) as plain:
        c.start()
        assert c.fmu.doStep(0.0, 0.02) == (False, False, True, pytest.approx(wanted, abs=1e-15))
        assert c.get("time")[0] == pytest.approx(wanted, abs=1e-15)
        assert c.outputs() == pytest.approx(plain.start().step(wanted).outputs(), rel=1e-12, abs=1e-13)
        c.time = c.get("time")[0]
        refused(2, c.fmu.doStep, 0.02, 0.01)  # it is not there


def test_only_reading_and_inputs_are_allowed_in_an_intermediate_update(native3):
    def update(environment, time, *rest):
        for call, words in ((c.set, ({"chair.m": 70.0},)), (c.save, ()), (c.fmu.doStep, (time, 0.001)), (c.fmu.reset, ())):
            refused(ERROR, call, *words)

    with chair(native3, update=update) as c:
        c.start().step(0.0015)
        assert "chair.m is a parameter, and parameters change at events" in c.sentences[0]
        assert all('"intermediate update"' in s for s in c.sentences[1:]) and len(c.sentences) == 4


# ---- what is not there


def test_every_function_without_a_use_says_so(native3):
    number, text = ctypes.c_size_t(), (ctypes.c_char_p * 1)()
    one = (ctypes.c_uint32 * 1)(1)
    with chair(native3) as c:
        c.start()
        f, i = c.fmu, c.fmu.component
        sizes = (ctypes.c_size_t * 1)(1)
        calls = [
            *(
                (getattr(f, f"fmi3{verb}{t}"), one, 1, getattr(fmi3, f"fmi3{t}")(), 1)
                for verb in ("Get", "Set")
                for t in ("Float32", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "UInt64")
            ),
            (f.fmi3GetString, one, 1, text, 1),
            (f.fmi3SetString, one, 1, text, 1),
            (f.fmi3GetBinary, one, 1, sizes, (ctypes.POINTER(ctypes.c_uint8) * 1)(), 1),
            (f.fmi3GetClock, one, 1, (ctypes.c_bool * 1)()),
            (f.fmi3SetClock, one, 1, (ctypes.c_bool * 1)()),
            (f.fmi3GetShiftDecimal, one, 1, (ctypes.c_double * 1)()),
            (f.fmi3SetIntervalDecimal, one, 1, (ctypes.c_double * 1)()),
            (f.fmi3EnterConfigurationMode,),
            (f.fmi3ExitConfigurationMode,),
            (f.fmi3EnterStepMode,),
            (f.fmi3EvaluateDiscreteStates,),
            (f.fmi3ActivateModelPartition, 1, 0.0),
            (f.fmi3GetNumberOfVariableDependencies, 1, ctypes.byref(number)),
            (f.fmi3EnterEventMode,),
            (f.fmi3EnterContinuousTimeMode,),
            (f.fmi3SetTime, 1.0),
            (f.fmi3GetNumberOfContinuousStates, ctypes.byref(number)),
        ]
        for call, *words in calls:
            refused(ERROR, call, i, *words)
        assert len(c.sentences) == len(calls)
        assert all(re.match(r"fmi3\w+(:| is not allowed)", s) for s in c.sentences)
        assert c.step(0.01).get("chair.u")[0] < 1


def test_wrong_sizes_are_refused(native3):
    r = native3.reference
    with chair(native3) as c:
        c.start()
        f = c.fmu
        one, two = (ctypes.c_uint32 * 1)(r("chair.u")), (ctypes.c_double * 2)()
        refused(ERROR, f.fmi3GetFloat64, f.component, one, 1, two, 2)
        refused(ERROR, f.fmi3SetFloat64, f.component, one, 1, two, 2)
        refused(ERROR, f.fmi3GetDirectionalDerivative, f.component, one, 1, one, 1, two, 2, two, 1)
        refused(ERROR, f.fmi3GetAdjointDerivative, f.component, one, 1, one, 1, two, 1, two, 2)
        refused(ERROR, f.fmi3GetOutputDerivatives, f.component, one, 1, (ctypes.c_int32 * 1)(1), two, 2)
        assert c.sentences[0] == "fmi3GetFloat64: 1 value references have 1 values, not 2, as no variable is an array"
        assert len(c.sentences) == 5


def test_instances_that_cannot_be_are_refused_with_a_reason(native3):
    said = []
    d = native3.description
    fmu = fmi3.FMU3Slave(guid=d.guid, unzipDirectory=str(native3.folder), instanceName="x", modelIdentifier="Wheelchair")
    log = fmi3.fmi3LogMessageCallback(lambda environment, status, category, text: said.append(text.decode()))
    token, none = d.guid.encode(), fmi3.fmi3IntermediateUpdateCallback()

    def cosimulation(name: bytes, token: bytes, event_mode: bool):
        return fmu.fmi3InstantiateCoSimulation(
            name, token, None, False, False, event_mode, False, (ctypes.c_uint32 * 0)(), 0, None, log, none
        )

    assert not cosimulation(b"", token, False)
    assert not cosimulation(b"x", b"{other}", False)
    assert not cosimulation(b"x", token, True)
    callbacks = (fmi3.fmi3ClockUpdateCallback(), fmi3.fmi3LockPreemptionCallback(), fmi3.fmi3UnlockPreemptionCallback())
    assert not fmu.fmi3InstantiateScheduledExecution(b"x", token, None, False, False, None, log, *callbacks)
    assert [s.split(": ")[1].split(";")[0] for s in said] == [
        "the instance has no name",
        "the token (guid) is not this library's",
        "Co-Simulation has no event mode here (hasEventMode is false)",
        "this FMU is for Co-Simulation and Model Exchange",
    ]
