"""What is in an archive, and that two builds are the same."""

from __future__ import annotations

import re
import subprocess
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

import pytest
from fmpy.fmi1 import FMICallException

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.errors import BuildError
from wheelchair_fmu.fmu import dependencies
from wheelchair_fmu.fmu import native as native_flavour
from wheelchair_fmu.fmu.build import build, with_chosen_effects
from wheelchair_fmu.fmu.describe import units
from wheelchair_fmu.fmu.validate import problems
from wheelchair_fmu.fmu.variables import interface
from wheelchair_fmu.model.stage import Effect
from wheelchair_fmu.model.variant import Variant, variant_text
from wheelchair_fmu.quantities import ONE, Parameter

from .chair import FEW, Unpacked, chair

ROOT = Path(__file__).parents[2]
EVERYTHING = [pytest.param(name, marks=pytest.mark.nightly) for name in ("everything", "everything3")]


@pytest.mark.parametrize("flavour", ["native", "native3", "in_python", *EVERYTHING])
def test_fmpy_finds_no_fault(flavour, request):
    assert problems(request.getfixturevalue(flavour).path) == []


@pytest.mark.parametrize(
    ("flavour", "options"),
    [
        pytest.param("native", {}, marks=pytest.mark.nightly),
        pytest.param("native3", {"fmi": "3"}, marks=pytest.mark.nightly),
        ("few", {"effects": FEW}),
        ("few3", {"effects": FEW, "fmi": "3"}),
        ("in_python", {"flavour": "python"}),
    ],
)
def test_two_builds_are_the_same_bytes(flavour, options, request, tmp_path):
    first = request.getfixturevalue(flavour).path
    again = build(target=tmp_path / "again.fmu", **options)
    assert first.read_bytes() == again.read_bytes()


def test_its_date_is_the_one_it_is_given(few3, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    dated = build(target=tmp_path / "dated.fmu", effects=FEW, fmi="3")
    with zipfile.ZipFile(dated) as z:
        assert {entry.date_time for entry in z.infolist()} == {(2023, 11, 14, 22, 13, 20)}
        description = z.read("modelDescription.xml").decode()
    assert 'generationDateAndTime="2023-11-14T22:13:20Z"' in description
    undated = (few3.folder / "modelDescription.xml").read_text(encoding="utf-8")
    assert description.replace(' generationDateAndTime="2023-11-14T22:13:20Z"', "") == undated  # the token, too
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    with pytest.raises(BuildError, match="SOURCE_DATE_EPOCH = 'yesterday' is no number of seconds"):
        build(target=tmp_path / "never.fmu", fmi="3")


def test_exports_nothing_but_fmi_and_needs_nothing_but_libc(native):
    exported = _lines("nm", "-D", "--defined-only", str(native.library))
    assert len(exported) > 100
    assert [line for line in exported if not re.fullmatch(r"\S+ T fmi[23]\w+", line)] == []
    needed = re.findall(r"\(NEEDED\).*\[(.+)]", "\n".join(_lines("readelf", "-d", str(native.library))))
    assert set(needed) <= {"libc.so.6", "libm.so.6"}
    asked = _lines("nm", "-D", "--undefined-only", str(native.library))
    asked = {line.split()[-1].split("@")[0] for line in asked}
    assert {name for name in asked if "alloc" in name} <= {"calloc"}  # the importer's, or this one; never malloc or realloc
    assert not {name for name in asked if re.search("lock|thread|sem_|errno", name)}


@pytest.mark.parametrize(
    "archive",
    [
        "few",
        "few3",
        pytest.param("everything", marks=pytest.mark.nightly),
        pytest.param("everything3", marks=pytest.mark.nightly),
    ],
)
def test_compiles_without_a_warning_and_shows_fmi_only(archive, request, tmp_path):
    unpacked: Unpacked = request.getfixturevalue(archive)
    unit, version = unpacked.folder / "sources" / "all.c", unpacked.description.fmiVersion[0]
    _compile(
        "-std=c11",
        "-O1",
        "-Wall",
        "-Wextra",
        "-Wpedantic",
        "-Werror",
        "-fPIC",
        "-c",
        str(unit),
        "-o",
        str(tmp_path / "object.o"),
    )
    exported = _lines("nm", "--extern-only", "--defined-only", str(tmp_path / "object.o"))
    assert len(exported) > 40 and all(re.fullmatch(rf"\S+ T fmi{version}\w+", line) for line in exported)


def test_two_source_fmus_can_be_linked_into_one_program(few3, native3, tmp_path):
    objects, words, expected = [], ["50"], []
    for prefix, archive, push in (("First_", few3, 10.0), ("Second_", native3, 30.0)):
        objects.append(str(tmp_path / f"{prefix}.o"))
        _compile("-c", f"-DFMI3_FUNCTION_PREFIX={prefix}", str(archive.folder / "sources" / "all.c"), "-o", objects[-1])
        words += [archive.description.guid, *(str(archive.reference(n)) for n in ("push.F_rl", "chair.psi"))]
        with chair(archive) as c:
            expected.append(c.start({"push.F_rl": push}).step(0.01, 50).get("chair.psi")[0])
    _compile(str(Path(__file__).with_name("linked.c")), *objects, "-o", str(tmp_path / "linked"), "-lm")
    assert [float.fromhex(word) for word in _lines(str(tmp_path / "linked"), *words)[0].split()] == expected


def test_lists_its_sources_and_carries_documentation(native):
    names = set(zipfile.ZipFile(native.path).namelist())
    description = ElementTree.fromstring((native.folder / "modelDescription.xml").read_bytes())
    listed = {f"sources/{file.get('name')}" for file in description.iter("File")}
    assert listed and listed <= names
    assert {"documentation/index.html", "documentation/licenses/license.txt", "model.png"} <= names
    page = (native.folder / "documentation" / "index.html").read_text(encoding="utf-8")
    assert "x_m  forward" in page and "push.total_needed" in page and "$" not in page


@pytest.mark.parametrize("archive", ["native", "native3", "everything", "in_python"])
def test_the_page_keeps_its_promises(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    page = (unpacked.folder / "documentation" / "index.html").read_text(encoding="utf-8")
    places = set(re.findall(r'id="(\w+)"', page))
    links = re.findall(r'href="([^"]+)"', page)
    assert {link[1:] for link in links if link.startswith("#")} <= places  # every source named is in the list
    for link in links:
        if not link.startswith(("#", "https://")):
            assert (unpacked.folder / "documentation" / link).is_file(), link
    other = {"2.0": "fmi3", "3.0": "fmi2"}[unpacked.description.fmiVersion]
    assert other not in page and f"FMI {unpacked.description.fmiVersion}" in page
    assert "10000000" not in page  # of REACH, which bounds nothing
    shown = set(re.findall(r"<tr><td>([^<]+)</td>", page))
    assert shown == {v.name for v in unpacked.description.modelVariables if v.causality in ("input", "output", "parameter")}


def test_a_host_without_casadi_is_told_so(in_python, tmp_path):
    assert "casadi" in (in_python.folder / "documentation" / "externalDependencies.txt").read_text(encoding="utf-8")
    (tmp_path / "casadi.py").write_text("raise ModuleNotFoundError(\"No module named 'casadi'\", name='casadi')")
    code = "import sys, fmpy; fmpy.simulate_fmu(sys.argv[1], stop_time=0.01, debug_logging=True)"
    done = subprocess.run(
        [sys.executable, "-c", code, str(in_python.path)],
        capture_output=True,
        text=True,
        env=_environment(PYTHONPATH=str(tmp_path)),
    )
    sentence = "this FMU needs the package casadi, which the Python of this host cannot import"
    assert done.returncode and sentence in done.stderr and "pip install casadi numpy" in done.stderr
    assert sentence in done.stdout  # FMPy's log, as the FMU gave it


def test_every_variable_is_described(native):
    for v in native.description.modelVariables:
        assert v.description, v.name
        if v.type == "Real":
            assert v.unit, v.name
        if v.causality in ("parameter", "input"):
            assert v.start is not None, v.name


def test_units_have_the_right_dimensions_and_display_units():
    found = {u.get("name"): u for u in units(interface(Variant()))}
    assert dict(found["N.m"].find("BaseUnit").items()) == {"kg": "1", "m": "2", "s": "-2"}
    assert dict(found["bar"].find("BaseUnit").items()) == {"kg": "1", "m": "-1", "s": "-2", "factor": "100000"}
    assert float(found["m/s"].find("DisplayUnit").get("factor")) == 3.6
    assert float(found["rad"].find("DisplayUnit").get("factor")) == pytest.approx(57.29577951308232, rel=1e-15)


def test_dependencies():
    plain = interface(Variant())
    on = {name: {v.name: kind for v, kind in known} for name, known in dependencies.continuous(plain).items()}
    assert on["chair.x"] == {"chair.x": "constant"} and set(on["load.rl"]) == {"floor.slope_x", "floor.slope_y", "rider.s"}
    assert on["sensor.u"] == {"chair.u": "constant", "rider.momentum": "tunable"}
    assert {o for o, known in on.items() if "rider.force" in known} == {"sensor.a_x"}
    assert on["sensor.a_x"]["push.F_rl"] == "tunable" and on["sensor.a_x"]["brake.rl"] == "dependent"
    assert "push.F_rl" not in on["push.total_needed"]  # it cancels
    assert on["der(chair.psi)"] == {"chair.psi_dot": "constant"}
    assert on["der(chair.x)"] == {"chair.psi": "dependent", "chair.u": "dependent", "chair.v": "dependent"}
    assert {"chair.u", "chair.v", "chair.psi_dot", "push.F_rl", "brake.rl"} <= on["der(chair.psi_dot)"].keys()
    start = {name: {v.name for v, _ in known} for name, known in dependencies.initial(plain).items()}
    assert start["chair.u"] == {"start.u", "speed.u", "speed.mode"}
    assert {"tyre.law", "tyre.C_lambda", "start.psi_dot"} <= start["force.F_srl"]
    assert {"tyre.law", "chair.I_z", "push.F_rl", "start.v"} <= start["der(chair.psi_dot)"]
    assert "tyre.law" not in start["load.rl"]


def test_dependencies_go_through_algebraic_states():
    """Load transfer reads an acceleration that is only known at the end of the line."""
    transfer = interface(Variant().with_effects(["lateral_load_transfer"]))
    on = {name: {v.name for v, _ in known} for name, known in dependencies.continuous(transfer).items()}
    assert {"floor.slope_x", "floor.slope_y", "chair.v"} <= on["load.rl"] and "push.F_rl" not in on["load.rl"]
    assert "floor.slope_y" in on["load.lifted.margin"]
    start = {name: {v.name for v, _ in known} for name, known in dependencies.initial(transfer).items()}
    assert {"tyre.law", "tyre.C_lambda", "start.psi_dot", "floor.slope_y"} <= start["load.rl"]


def test_dependencies_are_what_the_values_say(everything):
    """Moving an input moves no output that does not depend on it."""
    depends = {u.variable.name: {d.name for d in u.dependencies} for u in everything.description.outputs}
    outputs = everything.names("output")
    with chair(everything) as c:
        c.start({"effect.lateral_load_transfer.h": 0.5, "effect.relaxation_length.sigma": 0.1, "start.psi_dot": 0.3})
        c.step(0.01, 20)
        c.set({"push.F_rl": 10.0, "brake.rr": 0.1})
        before = c.outputs()
        for name in everything.names("input"):
            old = c.get(name)[0]
            c.set({name: 0.2})
            moved = {o for o, a, b in zip(outputs, before, c.outputs(), strict=True) if abs(a - b) > 1e-9}
            assert moved <= {o for o in outputs if name in depends[o]}, name
            c.set({name: old})


def test_effects_on_request():
    catalogue = Variant().catalogue
    stateless = {e.id for e in catalogue.values() if e.stateless}
    assert set(with_chosen_effects(Variant()).effects) == stateless
    assert set(with_chosen_effects(Variant(), "all").effects) == {e.id for e in catalogue.values() if not e.delays_record}
    assert with_chosen_effects(Variant(), "all").choice.caster == "swivelling"
    assert with_chosen_effects(Variant(), "none").effects == ()
    assert with_chosen_effects(Variant(), "gyro_scale, wheel_inertia").effects == ("gyro_scale", "wheel_inertia")


def test_an_effect_that_needs_a_tyre_law_leaves_no_other(tmp_path):
    effect = Effect("bent", "an effect of one law", (Parameter("k", ONE, "size", off=0.0),), needs={"tyre": "dugoff"})
    variant = Variant(catalogue={"bent": effect}).with_effects(["bent"])
    bent = Unpacked.of(build(variant, tmp_path / "bent.fmu", effects="none"), tmp_path / "bent")
    with chair(bent) as c:
        with pytest.raises(FMICallException):
            c.set({"tyre.law": 1})
        assert c.sentences == ["tyre.law = 1 is none of its choices 2 (dugoff); the old value 2 (dugoff) stays"]
        assert c.start().step(0.01).get("chair.u")[0] < 1


def test_a_variant_gives_start_values(tmp_path):
    variant = Variant().with_values({"chair.m": 91.5, "tyre.law": "dugoff", "effect.relaxation_length.sigma": 0.12})
    file = tmp_path / "better.toml"
    file.write_text(variant_text(variant), encoding="utf-8")
    done = _build(["--variant", str(file), "--effects", "none", "-o", str(tmp_path / "better.fmu")])
    assert done.returncode == 0, done.stderr
    better = Unpacked.of(tmp_path / "better.fmu", tmp_path / "better")
    starts = {v.name: v.start for v in better.description.modelVariables}
    assert float(starts["chair.m"]) == 91.5 and int(starts["tyre.law"]) == 2
    assert float(starts["effect.relaxation_length.sigma"]) == 0.12 and "effect.gyro_scale.k" not in starts
    with chair(better) as c:
        c.start()
        assert c.get("chair.m", "tyre.law", "effect.relaxation_length.sigma") == [91.5, 2, 0.12]


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        (["--effects", "relaxation"], 2, "no effect 'relaxation'; did you mean 'relaxation_length'"),
        (["--effects", "my/effects"], 1, "my/effects: no such folder; `wheelchair effects new ID` starts one"),
        (["--effects", "push_force_delay"], 2, "shifts recorded pushes in time and is no part of an FMU"),
        (["--platforms", "x86_64-window"], 2, "no platform 'x86_64-window'; did you mean 'x86_64-windows'?"),
        (["--fmi", "4"], 2, "no version of FMI '4'"),
        (["--flavour", "python", "--fmi", "3"], 2, "pythonfmu makes FMI 2.0 only"),
        (["--flavour", "pyton"], 2, "no flavour 'pyton'; did you mean 'python'?"),
        (["--equations", "papr"], 2, "did you mean 'paper'?"),
        (["--variant", "nowhere.toml"], 1, "nowhere.toml: no such file"),
    ],
)
def test_bad_arguments_get_one_line(words, code, says, tmp_path):
    done = _build([*words, "-o", str(tmp_path / "x.fmu")])
    assert done.returncode == code
    assert says in done.stderr and done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_an_option_that_there_is_not(tmp_path):
    done = _build(["--variants", "x"])
    assert done.returncode == 2 and "No such option: --variants" in done.stderr and "Traceback" not in done.stderr


def test_nothing_half_written_where_it_cannot_be(tmp_path):
    (tmp_path / "dist").write_text("a file, not a folder")
    done = _build(["--effects", "none", "-o", str(tmp_path / "dist" / "x.fmu")])
    assert done.returncode == 1 and "cannot be written" in done.stderr and "Traceback" not in done.stderr


@pytest.mark.skipif(not find_spec("ziglang"), reason="ziglang is not installed: `pip install ziglang`")
@pytest.mark.parametrize(("archive", "effects"), [("few", FEW), pytest.param("native", "default", marks=pytest.mark.nightly)])
def test_builds_with_zig_instead_of_a_system_compiler(archive, effects, request, tmp_path):
    unpacked: Unpacked = request.getfixturevalue(archive)
    code = (
        "import sys; from pathlib import Path; from wheelchair_fmu.fmu.build import build; "
        "build(target=Path(sys.argv[1]), effects=sys.argv[2])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "zig.fmu"), effects],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=_environment(CC=f"{sys.executable} -m ziglang cc"),
    )
    assert done.returncode == 0, done.stderr
    with chair(Unpacked.of(tmp_path / "zig.fmu", tmp_path / "zig")) as by_zig, chair(unpacked) as by_cc:
        results = [c.start({"push.F_rl": 20.0}).step(0.01, 100).outputs() for c in (by_zig, by_cc)]
    assert results[0] == pytest.approx(results[1], rel=1e-12, abs=1e-12)


def _compile(*words: str) -> None:
    done = subprocess.run([*compiler.command(), f"-I{native_flavour.headers()}", *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def _lines(*words: str) -> list[str]:
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()


def _environment(**more: str) -> dict[str, str]:
    import os

    return {**os.environ, "PYTHONPATH": str(ROOT), **more}


def _build(words: list[str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, str(ROOT / "build_fmu.py"), *words], capture_output=True, text=True, env=_environment()
    )
