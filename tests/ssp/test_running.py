"""Systems run: the same as libcosim, as a loop by hand, as each chair alone, and round the cones."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from tests.fmu.chair import chair
from wheelchair_fmu.errors import UsageError
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies.ssp import writing
from wheelchair_fmu.studies.ssp.building import build
from wheelchair_fmu.studies.ssp.checking import check
from wheelchair_fmu.studies.ssp.reading import opened
from wheelchair_fmu.studies.ssp.records import Binding, Connection
from wheelchair_fmu.studies.ssp.running import run

POSE = ("Chair.chair.x", "Chair.chair.y", "Chair.chair.psi")

# libcosim ends its process now and then when it unloads, so it gets one of its own.
LIBCOSIM = """
import sys
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver
log_output_level(CosimLogLevel.FATAL)
path, step, stop, *references = sys.argv[1:]
execution = CosimExecution.from_ssp_file(ssp_path=path, **({"step_size": int(step)} if int(step) else {}))
observer = CosimObserver.create_last_value()
execution.add_observer(observer)
assert execution.simulate_until(int(stop))
for word in references:
    name, numbers = word.split(":")
    index = execution.slave_index_from_instance_name(name)
    print(*(v.hex() for v in observer.last_real_values(index, [int(n) for n in numbers.split(",")])))
"""


@pytest.fixture(scope="module")
def rolled(slalom):
    return run(slalom)


def libcosim(path, stop: float, step: float | None) -> np.ndarray:
    """The last value of every Real output, in the order of the trace's columns."""
    with opened(path) as archive:
        components = {c.name: archive.fmu(c.source) for c in archive.system("SystemStructure.ssd").components}
        wanted = {
            name: [v.valueReference for v in fmu.variables.values() if v.causality == "output" and v.type == "Real"]
            for name, fmu in components.items()
        }
    words = [f"{name}:{','.join(map(str, numbers))}" for name, numbers in wanted.items()]
    nanoseconds = [str(round(1e9 * t)) for t in (step or 0, stop)]
    done = subprocess.run([sys.executable, "-c", LIBCOSIM, str(path), *nanoseconds, *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    lines = [line for line in done.stdout.splitlines() if line.startswith(("0x", "-0x"))]
    return np.array([float.fromhex(word) for line in lines for word in line.split()])


TOLD = ("Chair.load.lifted", "Chair.push.beyond_friction")  # true or false: libcosim's observer reads real numbers


@pytest.mark.parametrize(
    ("name", "step", "sets"),
    [
        ("slalom", 0.01, ()),
        pytest.param("slalom", None, ("deflated-tyres", "carpet"), marks=pytest.mark.nightly),
        ("ramp", 0.02, ("low-cost-tyre",)),
    ],
)
def test_libcosim_gives_the_same(name, step, sets, tmp_path):
    pytest.importorskip("libcosimpy", reason="pip install wheelchair-fmu[ssp]")
    path = build(name, tmp_path / "system.ssp", parameters=sets)
    trace = run(path, step=step, stop=6.0)
    ours = np.array([c[-1] for name, c in trace.columns.items() if name not in TOLD])
    theirs = libcosim(path, 6.0, step)
    assert ours.shape == theirs.shape and trace["Chair.chair.x"][-1] > 2
    assert np.max(np.abs(ours - theirs)) < 1e-9


def test_the_chair_goes_round_every_cone(rolled):
    x, y = rolled["Chair.chair.x"], rolled["Chair.chair.y"]
    psi, p = rolled["Chair.chair.psi"], rolled.parameters
    for i in range(int(p["Pusher.course.cones"])):
        cone = 3.0 + 3.0 * i
        assert (np.interp(cone, x, y) > 0) == (i % 2 == 0)
        ahead = (cone - x) * np.cos(psi) - y * np.sin(psi)  # where the cone is, seen from the chair
        aside = np.abs(-(cone - x) * np.sin(psi) - y * np.cos(psi))
        passing = (ahead > -p["Chair.chair.b"] - p["Chair.wheel.R"]) & (ahead < p["Chair.chair.a"] + 0.2)
        assert np.min(aside[passing]) > p["Chair.chair.t_r"] / 2 + 0.12  # the radius of a cone
    assert np.max(np.abs(rolled["Pusher.path.deviation"])) < 0.1
    assert rolled.warnings == ()
    assert x[-1] == pytest.approx(20.0, abs=0.2) and abs(rolled["Chair.chair.u"][-1]) < 1e-3


def test_the_interface_with_its_mapping_gives_the_same(slalom, rolled):
    other = run(slalom, description="Interface")
    for name in rolled.columns:
        assert other[name] == pytest.approx(rolled[name], abs=1e-9), name


def test_a_handle_turns_its_parameter_in_everyday_units(altered):
    path = altered({"resources/handles.ssv": ('value="3.24" unit="km/h"', 'value="2.52" unit="km/h"')})
    assert run(path, stop=0.1, description="Interface").parameters["Pusher.follow.speed"] == pytest.approx(0.7, rel=1e-12)
    assert run(path, stop=0.1).parameters["Pusher.follow.speed"] == 0.9


def test_a_mapping_scales_and_a_prefix_goes_before(altered):
    scaled = (
        'source="person.strongest_push" target="strongest_push"/>',
        'source="person.strongest_push" target="strongest_push"><ssc:LinearTransformation factor="0.5" offset="3"/>'
        "</ssm:MappingEntry>",
    )
    path = altered({"resources/handles.ssm": scaled})
    assert check(path) == []
    assert run(path, stop=0.1, description="Interface").parameters["Pusher.stroke.force"] == 43.0
    body = b"""<?xml version="1.0"?><ssv:ParameterSet xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues"
        version="1.0" name="p"><ssv:Parameters><ssv:Parameter name="m"><ssv:Real value="95"/></ssv:Parameter></ssv:Parameters>
        </ssv:ParameterSet>"""
    path = altered(
        {
            "SystemStructure.ssd": ('source="resources/Chair.ssv"/>', 'source="resources/p.ssv" prefix="chair."/>'),
            "resources/p.ssv": body,
        }
    )
    assert run(path, stop=0.1).parameters["Chair.chair.m"] == 95.0


def test_values_inside_the_description_are_bound_too(altered):
    inline = """<ssd:ParameterBinding><ssd:ParameterValues><ssv:ParameterSet version="1.0" name="i"><ssv:Parameters>
        <ssv:Parameter name="chair.m"><ssv:Real value="70"/></ssv:Parameter></ssv:Parameters></ssv:ParameterSet>
        </ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>"""
    path = altered({"SystemStructure.ssd": ("</ssd:ParameterBindings>", inline)})
    assert check(path) == []
    trace = run(path, stop=0.1)
    assert trace.parameters["Chair.chair.m"] == 70.0  # the later binding
    assert trace.parameters["Chair.start.u"] == 0.0  # the earlier one


def test_sets_in_the_archive_go_on_top(slalom, rolled):
    trace = run(slalom, parameters=("deflated-tyres", "carpet"), stop=8.0)
    assert trace.parameters["Chair.tyre.pressure"] == 2.0 and trace.parameters["Floor.carpet.rolling_factor"] == pytest.approx(
        1.983, abs=1e-3
    )
    there = np.searchsorted(rolled.time, 8.0)
    assert trace["Chair.chair.x"][-1] < rolled["Chair.chair.x"][there] - 0.05


def test_it_is_what_a_loop_by_hand_gives(slalom, wheelchair, rolled):
    """The chair alone, under the pushes and the floor that the run recorded, one step late as Jacobi has them."""
    inputs = {f"{who}.{name}": name for who, name in (("Pusher", "push.F_rl"), ("Pusher", "push.F_rr"))}
    values = {name: rolled.parameters[f"Chair.{name}"] for name in ("start.u", "tyre.C_lambda")}
    with chair(wheelchair) as c:
        c.start(values)
        for i in range(1000):
            c.set({name: rolled[path][i] for path, name in inputs.items()})
            c.fmu.doStep(rolled.time[i], rolled.time[i + 1] - rolled.time[i])
        assert c.get("chair.x", "chair.y", "chair.psi") == [rolled[name][1000] for name in POSE]


@pytest.fixture
def two_chairs(altered, slalom):
    """One pusher, who watches the first chair, pushes both; the second is heavier."""
    with opened(slalom) as archive:
        plain = archive.system("SystemStructure.ssd")
    first = plain.component("Chair")
    heavy = replace(first, name="Heavy", bindings=(*first.bindings, Binding("resources/heavy.ssv")))
    pushed = [Connection("Pusher", name, "Heavy", name) for name in ("push.F_rl", "push.F_rr")]
    both = replace(plain, components=(*plain.components, heavy), connections=(*plain.connections, *pushed))
    weight = b"""<ssv:ParameterSet xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues" version="1.0"
        name="heavy"><ssv:Parameters><ssv:Parameter name="chair.m"><ssv:Real value="110"/></ssv:Parameter></ssv:Parameters>
        </ssv:ParameterSet>"""
    path = altered({"SystemStructure.ssd": writing.description(both), "resources/heavy.ssv": weight})
    assert check(path) == []
    return path


@pytest.mark.nightly
def test_over_any_communication_step_the_error_is_of_first_order(two_chairs):
    """Hands and chair hear of one another one step late: a chair is off by no more than the way it does in one.

    Over a carpet's edge, round a cone, with two chairs in the process, and steps that divide neither the time nor one another.
    """
    finest = 0.0005
    fine = run(two_chairs, step=finest, stop=6.0, parameters=("carpet",))
    steps = (0.001, 0.002, 0.003, 0.005, 0.007, 0.01, 0.0137, 0.02)
    rates: dict[str, list[float]] = {"Chair": [], "Heavy": []}
    for step in steps:
        trace = run(two_chairs, step=step, stop=6.0, parameters=("carpet",))
        assert trace.time[-1] == 6.0
        for name, found in rates.items():
            off = [np.abs(np.interp(trace.time, fine.time, fine[c]) - trace[c]) for c in (f"{name}.chair.x", f"{name}.chair.y")]
            found.append(float(np.max(off)) / (step - finest))
    assert np.max(fine["Floor.floor.rolling_factor"]) > 1.05 and fine["Chair.chair.x"][-1] > 3
    for name, found in rates.items():
        assert np.max(found) < fine.parameters["Pusher.follow.speed"], name  # [m/s], the speed the person wants
        assert np.min(found) > 0.75 * np.max(found), name  # as the step falls, so does the error


def test_the_last_step_is_shorter_where_time_is_no_multiple(slalom):
    trace = run(slalom, step=0.03, stop=0.1)
    assert trace.time == pytest.approx([0.0, 0.03, 0.06, 0.09, 0.1])
    assert run(slalom, step=0.02, stop=0.1).time[-1] == pytest.approx(0.1) and len(run(slalom, step=0.02, stop=0.1).time) == 6


def test_two_chairs_in_one_process_are_each_as_alone(two_chairs, slalom):
    trace, alone = run(two_chairs, stop=5.0, step=0.01), run(slalom, stop=5.0, step=0.01)
    for name in alone.columns:
        assert np.array_equal(trace[name], alone[name]), name
    assert trace["Heavy.chair.x"][-1] < trace["Chair.chair.x"][-1] - 0.5
    with opened(slalom) as archive:
        first = archive.system("SystemStructure.ssd").component("Chair")
        import fmpy

        from tests.fmu.chair import Unpacked

        folder = archive.folder / "alone"
        fmpy.extract(str(archive.folder / first.source), str(folder))
        unpacked = Unpacked(archive.folder / first.source, folder, archive.fmu(first.source).description)
        with chair(unpacked) as c:
            c.start({"chair.m": 110.0, "start.u": 0.0})
            for i in range(500):
                c.set({n: trace[f"Pusher.{n}"][i] for n in ("push.F_rl", "push.F_rr")})
                c.fmu.doStep(trace.time[i], trace.time[i + 1] - trace.time[i])
            assert c.get("chair.x", "chair.y")[0] == trace["Heavy.chair.x"][-1]


def test_a_recording_is_replayed_into_the_chair(tmp_path):
    from tests.ssp.conftest import RECORDING

    path = build("strokes", tmp_path / "replay.ssp", recording=RECORDING)
    trace = run(path, stop=1.5)
    assert np.max(trace["Pusher.push.F_rl"]) == pytest.approx(30.0, abs=1e-6)
    assert trace["Chair.chair.psi"][-1] > 0.01  # the left hand was stronger: to the right


@pytest.mark.nightly
def test_a_variant_is_the_chair_with_its_laws_and_values(tmp_path):
    variant = Variant().with_values({"tyre.law": "magic_formula", "chair.m": 100.0, "effect.relaxation_length.sigma": 0.1})
    path = build("strokes", tmp_path / "variant.ssp", variant=variant)
    trace = run(path, stop=0.1)
    told = ("tyre.law", "chair.m", "effect.relaxation_length.sigma", "tyre.C_lambda", "start.u")
    assert [trace.parameters[f"Chair.{name}"] for name in told] == [3, 100, 0.1, 5038, 0]
    with opened(path) as archive:
        starts = archive.fmu("resources/Wheelchair.fmu").variables
    assert [float(starts[name].start) for name in told] == [3, 100, 0.1, 5038, 0]  # for importers that read no sets


def over(name, folder):
    """A system run to the end of its course."""
    trace = run(build(name, folder / f"{name}.ssp"))
    assert trace["Chair.chair.x"][-1] == pytest.approx(trace.parameters["Pusher.course.end"], abs=0.3)
    return trace


def test_a_slope_across_acts_on_the_chair(tmp_path):
    cross = over("cross-slope", tmp_path)
    assert 0.02 < np.max(cross["Chair.chair.y"]) < 0.3  # it drifts down the slope, and is held


@pytest.mark.nightly
def test_a_ramp_and_a_carpet_act_on_the_chair(tmp_path):
    ramp, carpet = (over(name, tmp_path) for name in ("ramp", "carpet"))
    assert np.min(ramp["Floor.floor.slope_x"]) == pytest.approx(-0.05, abs=1e-9)
    assert np.max(ramp["Pusher.push.F_rl"][ramp.time > 3]) > 60  # uphill, well above the level
    assert np.max(carpet["Floor.floor.rolling_factor"]) == pytest.approx(1.983, abs=1e-3)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"step": 0.0}, "--step 0 s is impossible"),
        ({"step": float("nan")}, "--step nan s is impossible"),
        ({"stop": -1.0}, "--time -1 s is not after the start"),
        ({"step": 1e-9}, "give a longer one"),
        ({"description": "Nowhere"}, "no description in"),
        ({"parameters": ("fited",)}, "did you mean 'fitted'"),
    ],
)
def test_an_impossible_request_is_refused(options, told, slalom):
    with pytest.raises(UsageError, match=told):
        run(slalom, **options)
