"""Order of calls, bad values, saved states, derivatives, logs: what an importer may do to an instance."""

from __future__ import annotations

import ctypes
import json
import struct
import subprocess
import sys
from math import inf, nan
from pathlib import Path

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from .chair import DISCARD, ERROR, Chair, Unpacked, chair, pushed
from .exchange import exchange

ROOT = Path(__file__).parents[2]
OUTPUTS = ("chair.x", "chair.y", "chair.psi", "chair.u", "chair.v", "chair.psi_dot")


def refused(status: int, call, *words, **options) -> None:
    with pytest.raises(FMICallException) as caught:
        call(*words, **options)
    assert caught.value.status == status


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"push.F_rl": nan}, "push.F_rl = nan is not a finite number; the old value 12 N stays"),
        ({"push.F_rl": inf}, "push.F_rl = inf is not a finite number; the old value 12 N stays"),
        ({"push.F_rr": 3.0, "push.F_rl": -inf}, "push.F_rl = -inf is not a finite number; the old value 12 N stays"),
        ({"chair.m": -1.0}, "chair.m = -1 kg is below its minimum of 1 kg; the old value 80 kg stays"),
        (
            {"tyre.law": 7},
            "tyre.law = 7 is none of its choices 1 (linear), 2 (dugoff), 3 (magic_formula); the old value 1 (linear) stays",
        ),
    ],
)
def test_a_bad_value_is_refused_in_one_sentence(values, sentence, native, in_python):
    with chair(native) as c, chair(in_python, logging=True) as p:
        c.set({"push.F_rl": 12.0})
        before = c.get("push.F_rl", "push.F_rr", "chair.m", "tyre.law")
        refused(DISCARD, c.set, values)
        assert c.said == [(DISCARD, "logStatusDiscard", sentence)]
        assert c.get("push.F_rl", "push.F_rr", "chair.m", "tyre.law") == before
        c.start()
        assert c.step(0.01).get("chair.x")[0] > 0.009

        p.set({"push.F_rl": 12.0})
        p.set(values)  # pythonfmu has no way to refuse, only to keep and to tell
        assert p.get("push.F_rl", "push.F_rr", "chair.m", "tyre.law") == before
        assert p.sentences[-1].replace("1e+09", "1000000000") == sentence
        assert p.start().step(0.01).get("chair.x")[0] > 0.009


def test_bad_values_are_refused_while_stepping_too(native):
    with chair(native) as c, chair(native) as untouched:
        for one in (c, untouched):
            one.start({"push.F_rl": 12.0}).step(0.01, 10)
        for name in native.names("input") + native.names("parameter"):
            for value in (nan, inf, -inf, 1e300):
                status = ERROR if c.types[name].variability == "fixed" else DISCARD
                if value == 1e300 and (c.types[name].max is None or c.types[name].causality == "input"):
                    continue
                refused(status, c.set, {name: value})
        assert c.step(0.01, 10).outputs() == untouched.step(0.01, 10).outputs()


GRIPS = {"chair.m": 900.0, "tyre.mu": 3.0}  # a chair that no push spins the wheels of


@pytest.mark.parametrize("archive", ["native", "native3", "in_python"])
def test_an_input_beyond_a_bound_is_clamped_with_one_warning(archive, request):
    with chair(request.getfixturevalue(archive), logging=True) as c:
        c.start({**GRIPS, "push.F_rl": 2500.0, "push.F_rr": 2000.0}).step(0.01)
        for i in range(3):
            c.set({"push.F_rl": 3000.0 + i, "brake.rl": -0.25})
            assert c.get("push.F_rl", "brake.rl") == [2000.0, 0.0]
            c.step(0.01)
        assert [(s, k) for s, k, _ in c.said if s] == 2 * [(1, "logStatusWarning")]
        assert c.sentences == [
            "t = 0 s: push.F_rl = 2500 N is above its maximum of 2000 N; the maximum is used instead, now and whenever this "
            "input is out of bounds",
            "t = 0.01 s: brake.rl = -0.25 is below its minimum of 0; the minimum is used instead, now and whenever this input "
            "is out of bounds",
        ]
        with chair(request.getfixturevalue(archive), name="other") as other:  # which was given the bounds themselves
            other.start({**GRIPS, "push.F_rl": 2000.0, "push.F_rr": 2000.0}).step(0.01, 4)
            assert c.outputs() == other.outputs() and other.sentences == []
        c.fmu.reset()
        c.set({"brake.rl": -1.0})
        assert len(c.sentences) == 3  # a new life


@pytest.mark.parametrize("archive", ["native", "native3", "in_python"])
@pytest.mark.parametrize("off", [-1e-14, -1e-12, -1e-10])
def test_rounding_beyond_a_bound_is_not_worth_a_word(archive, off, request):
    with chair(request.getfixturevalue(archive), logging=True) as c:
        c.start().step(0.01)
        c.set({"brake.rl": off, "brake.rr": 1 - off})
        assert c.get("brake.rl", "brake.rr") == [0.0, 1.0]
        assert c.step(0.01).sentences == []


def test_an_input_whose_derivative_leads_beyond_a_bound_stops_there(native):
    """As where a master interpolates inputs."""
    with chair(native) as c:
        c.start({"brake.rl": 0.5, "push.F_rl": 10.0})
        brake, push = (c.types[n].valueReference for n in ("brake.rl", "push.F_rl"))
        c.fmu.setRealInputDerivatives([brake, push], [1, 1], [-100.0, 100.0])
        assert c.step(0.01).get("brake.rl", "push.F_rl") == [0.0, 11.0]
        assert c.sentences == [
            "t = 0 s: brake.rl = -0.5 is below its minimum of 0; the minimum is used instead, now and "
            "whenever this input is out of bounds"
        ]


@pytest.mark.parametrize("archive", ["native", "native3"])
def test_inputs_are_clamped_in_model_exchange_too(archive, request):
    with exchange(request.getfixturevalue(archive)) as e:
        e.enter()
        for value in (-0.5, -0.7, -1e-13):
            e.set({"brake.rl": value})
            assert e.get("brake.rl") == [0.0] and np.isfinite(e.rates()).all()
        refused(DISCARD, e.set, {"brake.rl": nan})
        assert [k for _, k, _ in e.said] == ["logStatusWarning", "logStatusDiscard"]


def test_bad_steps_are_refused(native):
    with chair(native) as c:
        c.start(stopTime=1.0).step(0.01)
        for h in (0.0, -0.01, nan, inf):
            refused(DISCARD, c.fmu.doStep, c.time, h)
        assert c.sentences[0] == "fmi2DoStep: a step of 0 s is not a positive finite time; the simulation stays at t = 0.01 s"
        refused(DISCARD, c.fmu.doStep, 0.5, 0.01)
        assert "the step starts at 0.5 s but the simulation is at t = 0.01 s" in c.sentences[-1]
        refused(ERROR, c.fmu.doStep, c.time, 1.0)
        assert "after the stop time 1 s" in c.sentences[-1]
        assert len(c.sentences) == 6
        assert c.step(0.01).get("chair.u")[0] < 1


def test_bad_steps_are_refused_in_python_too(in_python):
    with chair(in_python, logging=True) as c:
        c.start().step(0.01)
        for h in (0.0, -0.01, nan, inf):
            refused(DISCARD, c.fmu.doStep, c.time, h)
        refused(DISCARD, c.fmu.doStep, 0.5, 0.01)
        assert len(c.sentences) == 5 and "the step starts at 0.5 s" in c.sentences[-1]
        c.set({"tyre.law": 2})
        assert "tyre.law is fixed and the simulation has started" in c.sentences[-1]
        assert c.get("tyre.law") == [1] and c.step(0.01).get("chair.u")[0] < 1


def test_unknown_and_misused_variables(native):
    with chair(native) as c:
        refused(ERROR, c.fmu.getReal, [9999])
        refused(ERROR, c.fmu.setInteger, [c.types["chair.m"].valueReference], [1])
        refused(ERROR, c.set, {"chair.x": 1.0})
        refused(ERROR, c.fmu.getString, [0])
        assert c.sentences == [
            "fmi2GetReal: no real number has value reference 9999; modelDescription.xml lists the variables",
            "fmi2SetInteger: no enumeration has value reference 1; modelDescription.xml lists the variables",
            "fmi2SetReal: chair.x is an output and cannot be set; set inputs and parameters",
            "fmi2GetString: this FMU has no variables of type String; modelDescription.xml lists all",
        ]


def test_calls_in_the_wrong_order_name_the_legal_ones(native):
    with chair(native) as c:
        refused(ERROR, c.fmu.doStep, 0.0, 0.01)
        refused(ERROR, c.fmu.exitInitializationMode)
        c.start()
        refused(ERROR, c.fmu.enterInitializationMode)
        refused(ERROR, c.set, {"tyre.law": 2})
        c.fmu.terminate()
        refused(ERROR, c.fmu.doStep, 0.0, 0.01)
        assert c.sentences[0] == (
            'fmi2DoStep is not allowed while the FMU is "instantiated"; call it after fmi2ExitInitializationMode'
        )
        assert "tyre.law is fixed and the simulation has started; the old value 1 (linear) stays" in c.sentences[3]
        assert '"terminated"' in c.sentences[4]
        assert c.get("chair.u")[0] == 1.0  # still readable
        c.fmu.reset()
        c.start().step(0.01)


def test_another_guid_is_refused(native):
    wrong = native.description
    good, wrong.guid = wrong.guid, "{other}"
    try:
        with pytest.raises(Exception, match="instantiate"):
            Chair(native)
    finally:
        wrong.guid = good


def test_log_categories_are_honoured(native):
    with chair(native, logging=True) as c:
        c.start()
        assert [(s, k) for s, k, _ in c.said] == [(0, "logModel")]
        c.fmu.setDebugLogging(False, ["logStatusDiscard"])
        refused(DISCARD, c.set, {"chair.m": -1.0})
        refused(ERROR, c.fmu.getReal, [9999])
        assert [k for _, k, _ in c.said] == ["logModel", "logStatusError"]
        c.fmu.setDebugLogging(True, ["logStatusDiscard"])
        refused(DISCARD, c.set, {"chair.m": -1.0})
        assert c.said[-1][1] == "logStatusDiscard"
        refused(ERROR, c.fmu.setDebugLogging, True, ["100 %"])
        assert 'no log category "100 %%"' in c.sentences[-1]  # the logger takes a format


def test_leaving_the_range_warns_once(native):
    with chair(native) as c:
        c.start({"effect.lateral_load_transfer.h": 1.0, "start.psi_dot": 3.0, "start.u": 2.0})
        c.step(0.01, 10)
        lifted = [t for s, k, t in c.said if "load.lifted is true" in t]
        slipping = [t for s, k, t in c.said if "the tyre law is not meant for so much slip" in t]
        assert len(lifted) == 1 and len(slipping) == 1 and len(c.said) == 2
        assert {k for _, k, _ in c.said} == {"logStatusWarning"}


def test_a_push_that_would_spin_a_wheel_warns_once(native):
    """The wheel rolls on all the same; who wants it to spin is told which law it is that has it."""
    with chair(native) as c:
        c.start({"tyre.mu": 0.3, "push.F_rr": 80.0})
        c.step(0.01, 3)
        (said,) = c.sentences
        assert "push.beyond_friction is true: a rear wheel is pushed beyond friction" in said
        assert said.endswith(
            'push or turn less, or choose the law of wheels that spin, wheel = "spinning" in the [laws] of a variant'
        )


@pytest.mark.parametrize("archive", ["native", "native3", "in_python"])
def test_a_body_that_moves_without_a_mass_is_told_once(archive, request):
    with chair(request.getfixturevalue(archive), logging=True) as c:
        c.start({"rider.s": 0.05}).step(0.01, 3)
        assert c.sentences == ["t = 0.01 s: rider.s = 0.05 m moves nothing while rider.m is 0 kg; set rider.m as well"]
    with chair(request.getfixturevalue(archive), logging=True) as c:
        c.start({"rider.s": 0.05, "rider.m": 40.0}).step(0.01, 3)
        assert c.sentences == []


def test_a_gentle_ride_warns_of_nothing(native, in_python):
    for unpacked in (native, in_python):
        with chair(unpacked, logging=False) as c:
            c.start()
            for i in range(200):
                c.set(pushed(i))
                c.step(0.01)
            assert c.sentences == []


# ---- saved states

# Ends without the interpreter's own shutdown, which pythonfmu's library has been seen not to survive.
CONTINUE = """
import os
import sys
from pathlib import Path
from tests.fmu.chair import Unpacked, chair, pushed
import fmpy
unpacked = Unpacked(Path(sys.argv[1]), Path(sys.argv[2]), fmpy.read_model_description(sys.argv[1]))
with chair(unpacked) as c:
    c.revive(Path(sys.argv[3]).read_bytes())
    c.time = float(sys.argv[4])
    for i in range(137, 260):
        c.set(pushed(i))
        c.step(0.01)
    print(*(v.hex() for v in c.outputs()), flush=True)
os._exit(0)
"""


@pytest.mark.parametrize("archive", ["everything", "everything3", "in_python"])
def test_a_saved_state_goes_on_in_another_process_bit_for_bit(archive, request, tmp_path):
    unpacked: Unpacked = request.getfixturevalue(archive)
    with chair(unpacked) as c:
        c.start({"effect.lateral_load_transfer.h": 0.5, "tyre.law": 3})
        for i in range(137):
            c.set(pushed(i))
            c.step(0.01)
        c.set({"chair.m": 85.0})  # a jump not yet settled is part of the state
        state, now = c.save(), c.time
        (tmp_path / "state").write_bytes(c.serialized())
        ends = []
        for _ in range(2):
            for i in range(137, 260):
                c.set(pushed(i))
                c.step(0.01)
            ends.append([v.hex() for v in c.outputs()])
            c.restore(state)
            c.time = now
        c.drop(state)
    assert ends[0] == ends[1]
    done = subprocess.run(
        [sys.executable, "-c", CONTINUE, str(unpacked.path), str(unpacked.folder), str(tmp_path / "state"), repr(now)],
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ends[0]


def test_foreign_and_damaged_states_are_refused(native, everything):
    with chair(native) as c, chair(everything) as other:
        c.start().step(0.01)
        other.start()
        good = c.fmu.serializeFMUstate(c.fmu.getFMUstate())
        damaged = bytearray(good)
        damaged[200] ^= 1
        for bytes_, says in (
            (good[:-8], f"a state of this FMU has {len(good)} bytes, not {len(good) - 8}"),
            (bytes(len(good)), "no saved state of this kind of FMU"),
            (other.fmu.serializeFMUstate(other.fmu.getFMUstate()), "saved by another build"),
            (bytes(damaged), "has been altered"),
            (b"wcstate2" + good[16:], "has the layout of another version of this FMU"),
            (good[:8] + b"wcstate9" + good[16:], "has the layout of another version of this FMU"),
        ):
            refused(ERROR, c.fmu.deSerializeFMUstate, bytes_)
            assert says in c.sentences[-1]
        assert c.get("chair.u")[0] < 1


def test_a_state_begins_with_zeros(native):
    """Where an importer takes a state for the place of its address, it finds that there is none."""
    with chair(native) as c:
        assert c.start().step(0.01).serialized()[:8] == bytes(8)


def _forged(state: bytes, at: int, form: str, value: float) -> bytes:
    """The state with another value in it, and the checksum to go with that."""
    changed = bytearray(state)
    struct.pack_into(form, changed, at, value)
    total = 14695981039346656037
    for byte in changed[64:]:
        total = (total ^ byte) * 1099511628211 % 2**64
    struct.pack_into("<Q", changed, 56, total)
    return bytes(changed)


def _where_they_differ(one: bytes, other: bytes) -> int:
    """The first byte, behind the checksum, of the word in which two states differ."""
    return next(i for i in range(64, len(one)) if one[i] != other[i]) // 4 * 4


@pytest.mark.parametrize("archive", ["native", "native3"])
def test_a_state_forged_with_a_right_checksum_is_refused(archive, request):
    """Where it holds what no run could have left: laws that there are not, bounds that are passed, phases of no meaning."""
    unpacked: Unpacked = request.getfixturevalue(archive)
    with chair(unpacked) as c:
        fresh = c.serialized()
        c.set({"tyre.law": 2})
        law = _where_they_differ(fresh, c.serialized()) // 8 * 8
        c.set({"tyre.law": 1, "push.F_rl": 3.0})
        push = _where_they_differ(fresh, c.serialized()) // 8 * 8
        c.set({"push.F_rl": 0.0})
        c.start()
        good = c.serialized()
        phase = len(good) - 20  # the fifth word from the end
        assert struct.unpack_from("<d", good, law) == (1.0,) and struct.unpack_from("<i", good, phase) == (4,)
        give = c.fmu.deSerializeFMUstate if archive == "native" else c.fmu.deserializeFMUState
        for at, form, value in (
            *((law, "<d", v) for v in (0.0, 2.5, 4.0, 1e6, -1e300, nan)),
            *((push, "<d", v) for v in (nan, inf, 2000.1)),
            *((phase, "<i", v) for v in (0, 3, 16, 2**30)),
            (64, "<d", 0.0),
        ):
            refused(ERROR, give, _forged(good, at, form, value))
            assert "the state holds values that this FMU never has" in c.sentences[-1]
        c.revive(_forged(good, law, "<d", 3.0))
        assert c.get("tyre.law") == [3] and c.step(0.01).get("chair.u")[0] < 1


def test_a_forged_state_is_refused_in_python_too(in_python):
    with chair(in_python, logging=True) as c:
        good = json.loads(c.start().step(0.01).serialized())
        for change in (
            {"values": {**good["values"], "tyre.law": 9}},
            {"values": {**good["values"], "chair.m": nan}},
            {"values": {}},
            {"phase": "flying"},
            {"x": "none"},
            {"x": [nan]},
            {"elapsed": "late"},
        ):
            c.revive(json.dumps({**good, **change}).encode())
            assert "the state holds values that this FMU never has; the present one stays" in c.sentences[-1], change
        assert len(c.sentences) == 7
        c.revive(json.dumps(good).encode())
        assert c.step(0.01).get("tyre.law") == [1] and len(c.sentences) == 7


def test_reset_gives_the_same_bytes_two_thousand_times(native, host):
    assert host(native, "reset", 2000, 0.001) == [0]


@pytest.mark.parametrize("archive", ["native", "in_python"])
def test_reset_forgets_everything(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    with chair(unpacked) as c, chair(unpacked, name="fresh") as fresh:
        c.start({"chair.m": 90.0, "push.F_rl": 50.0, "tyre.law": 2}, time=3.0).step(0.01, 20)
        c.fmu.reset()
        parameters = [n for n in unpacked.names("parameter")]
        assert c.get(*parameters, "tyre.law", "push.F_rl") == fresh.get(*parameters, "tyre.law", "push.F_rl")
        assert c.start().step(0.01, 20).outputs() == fresh.start().step(0.01, 20).outputs()


@pytest.mark.parametrize("archive", ["native", "in_python"])
def test_two_instances_do_not_meet(archive, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    with chair(unpacked, name="a") as a, chair(unpacked, name="b") as b:
        a.start({"push.F_rl": 30.0})
        b.start({"push.F_rr": 30.0, "tyre.law": 3})
        for _ in range(50):
            a.step(0.01)
            b.step(0.01)
        together = a.outputs(), b.outputs()
    for outputs, values in zip(together, ({"push.F_rl": 30.0}, {"push.F_rr": 30.0, "tyre.law": 3}), strict=True):
        with chair(unpacked) as alone:
            assert alone.start(values).step(0.01, 50).outputs() == outputs


def test_python_copies_keep_their_own_equations(in_python, tmp_path):
    """An edited copy, loaded beside the original, uses the edited equations."""
    import shutil

    edited = tmp_path / "edited"
    shutil.copytree(in_python.folder, edited)
    chassis = next((edited / "resources").glob("wheelchair_python_*/model/chassis.py"))
    text = chassis.read_text(encoding="utf-8")
    assert "return m, m, I_z" in text
    chassis.write_text(text.replace("return m, m, I_z", "return 2 * m, m, I_z"), encoding="utf-8")
    with chair(in_python) as first, chair(Unpacked(in_python.path, edited, in_python.description)) as second:
        slowing = [1 - c.start().step(0.1, 3).get("chair.u")[0] for c in (first, second)]
    assert slowing[0] == pytest.approx(2 * slowing[1], rel=1e-2)


# ---- derivatives


@pytest.mark.parametrize("archive", ["native", "everything"])
@pytest.mark.parametrize("law", [1, 2, 3])
def test_directional_derivatives_are_those_of_the_values(archive, law, request):
    unpacked: Unpacked = request.getfixturevalue(archive)
    outputs = unpacked.names("output")
    with chair(unpacked) as c:
        c.start({"tyre.law": law, "start.psi_dot": 0.4, "effect.lateral_load_transfer.h": 0.4, "push.F_rl": 20.0})
        c.step(0.01, 30)
        known = unpacked.names("input") + [n for n in unpacked.names("parameter") if c.types[n].variability == "tunable"]
        _compare_derivatives(c, outputs + unpacked.derivatives, known)


def test_directional_derivatives_while_initializing_go_through_the_start(native):
    with chair(native) as c:
        c.fmu.setupExperiment()
        c.fmu.enterInitializationMode()
        c.set({"start.psi_dot": 0.2, "start.v": 0.05, "effect.lateral_load_transfer.h": 0.3})
        unknown = native.names("output") + native.derivatives
        _compare_derivatives(c, unknown, native.names("input") + native.names("parameter"))


def _compare_derivatives(c: Chair, outputs: list[str], known: list[str]) -> None:
    """Central differences, at every known that can go both ways."""
    rows = [c.types[n].valueReference for n in outputs]
    for name in known:
        value, size = c.get(name)[0], float(c.types[name].nominal) * 1e-4
        if c.types[name].min is not None and value - size < float(c.types[name].min):
            continue
        exact = np.array(c.fmu.getDirectionalDerivative(rows, [c.types[name].valueReference], [1.0]))
        state, ends = c.fmu.getFMUstate(), []
        for sign in (1, -1):
            c.set({name: value + sign * size})
            ends.append(np.array(c.get(*outputs)))
            c.fmu.setFMUstate(state)
        c.fmu.freeFMUstate(state)
        difference = (ends[0] - ends[1]) / (2 * size)
        scale = 1 + np.abs(difference)
        assert np.max(np.abs(exact - difference) / scale) < 2e-4, (name, outputs[int(np.argmax(np.abs(exact - difference)))])


def test_directional_derivatives_of_nonsense_are_refused(native):
    reference = native.reference
    with chair(native) as c:
        c.start()
        for unknown, known in (("chair.m", "push.F_rl"), ("chair.x", "slip.rl"), ("chair.x", "start.u")):
            refused(ERROR, c.fmu.getDirectionalDerivative, [reference(unknown)], [reference(known)], [1.0])
        assert "start.u cannot change now" in c.sentences[-1]


# ---- without Python


def test_a_host_in_c_gets_the_same(native, host):
    with chair(native) as c:
        c.start()
        for i in range(500):
            beat = np.sin(2 * 3.141592653589793 * i * 0.01)
            push = 60 * beat if beat > 0 else 0.0
            c.set({"push.F_rl": push + 1, "push.F_rr": push - 1})
            c.time = i * 0.01
            c.step(0.01)
        assert host(native, "final", 500, 0.01) == pytest.approx(c.get("chair.x", "chair.u", "chair.psi"), rel=1e-12)


def test_a_million_steps_need_no_memory(native, host):
    grown, asked = host(native, "memory", 1_000_000, 0.001)
    assert asked == 0
    assert grown < 512  # KiB, of stdio and stack


@pytest.mark.parametrize("archive", ["native", "everything"])
def test_coming_to_rest_meets_no_denormal_numbers(archive, host, request):
    """They make arithmetic many times slower. Of a minute with turns, stops and reversals, a step may underflow on the way."""
    assert host(request.getfixturevalue(archive), "underflow", 60_000, 0.001)[0] <= 5


def test_free_of_nothing_is_safe(native):
    library = ctypes.CDLL(str(native.library))
    library.fmi2FreeInstance.argtypes = [ctypes.c_void_p]
    library.fmi2FreeInstance(None)
    assert library.fmi2DoStep(None, ctypes.c_double(0), ctypes.c_double(1), 1) == ERROR
