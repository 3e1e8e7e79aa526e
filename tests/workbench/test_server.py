"""The workbench's addresses: what it takes in, what it refuses, and that nothing is lost."""

from __future__ import annotations

import json
import re
import time
from io import BytesIO
from math import radians, tanh
from os import utime
from pathlib import Path
from shutil import rmtree

import numpy as np
import pytest

from tests.campaign import lab
from tests.kit import SAMPLE_DIAGNOSIS, with_settings
from wheelchair_fmu.campaign.importing import BOUNDS
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.report.page import asset
from wheelchair_fmu.workbench.jobs import printed_json

TestClient = pytest.importorskip("starlette.testclient", reason="the workbench's libraries are not installed").TestClient
from wheelchair_fmu.workbench.guard import HEADER, TOKEN_HEADER  # noqa: E402
from wheelchair_fmu.workbench.server import Workbench, _at_bounds  # noqa: E402
from wheelchair_fmu.workbench.session import Session, prune  # noqa: E402

SAMPLE = Path(__file__).parents[2] / "examples" / "sample-campaign"


@pytest.fixture(scope="module")
def bench(tmp_path_factory) -> Workbench:
    return Workbench(tmp_path_factory.mktemp("work"), "s3cret")


@pytest.fixture
def client(bench):
    with TestClient(bench.app(), "http://127.0.0.1:8765", headers={HEADER: "1", TOKEN_HEADER: "s3cret"}) as client:
        client.base = begun(client)
        yield client


def begun(client) -> str:
    return f"/s/{client.post('/sessions').json()['id']}"


def upload(client, *files: tuple[str, bytes]):
    return client.post(f"{client.base}/files", files=[("files", (name, content)) for name, content in files])


def recordings() -> list[tuple[str, bytes]]:
    return [(f.name, f.read_bytes()) for f in sorted((SAMPLE / "runs").glob("*.csv"))]


def test_recordings_alone_become_a_campaign(client):
    state = upload(client, *recordings()).json()
    assert not [f for f in state["faults"] if f["severity"] == "error"]
    roles = {r["file"]: r["role"] for r in state["campaign"]["run"]}
    assert roles["holdout-slalom.csv"] == "holdout"
    assert roles["slalom-slow.csv"] == "fit"
    assert client.get(f"{client.base}/state").json()["campaign"] == state["campaign"], "a reload loses nothing"


def test_a_name_with_quotes_is_kept(client):
    """A form's part has no quotes in its name, so names come beside the files."""
    name, content = '"quoted" run.csv', recordings()[0][1]
    sent = {"files": [("files", ("%22quoted%22 run.csv", content))]}
    state = client.post(f"{client.base}/files", **sent, data={"paths": json.dumps([name])}).json()
    assert [r["file"] for r in state["campaign"]["run"]] == [name]
    for paths, why in (('["a", "b"]', "names 2 files, and 1 came"), ("[1]", "holds no list of names"), ("[", "holds no JSON")):
        told = client.post(f"{client.base}/files", **sent, data={"paths": paths})
        assert told.status_code == 400 and why in told.json()["error"]


def test_a_campaign_folder_is_taken_as_it_is(client):
    toml = (SAMPLE / "campaign.toml").read_bytes()
    state = upload(client, ("campaign.toml", toml), *((f"runs/{n}", c) for n, c in recordings())).json()
    assert state["campaign"]["campaign"]["name"] == "sample-chair"
    assert len(state["campaign"]["run"]) == 10
    assert state["faults"] == []


def test_a_loggers_own_columns_are_mapped(client):
    head, _, body = (SAMPLE / "runs" / "slalom-slow.csv").read_text().partition("\n")
    assert head.startswith("time [s],F_rl [N]")
    renamed = "Time,left hand,right hand,left,right,Gyro Z [deg/s],Acc X [g],Acc Y [g]"
    state = upload(client, ("log.csv", f"{renamed}\n{body}".encode())).json()
    assert any(f["severity"] == "error" for f in state["faults"])
    content = state["campaign"]
    assert content["columns"]["yaw_rate"] == {"column": "Gyro Z [deg/s]"}, "guessed"
    content["columns"] |= {
        "time": {"column": "Time", "unit": "s"},
        "F_rl": {"column": "left hand", "unit": "N"},
        "F_rr": {"column": "right hand", "unit": "lbf"},
        "wheel_speed_l": {"column": "left", "unit": "m/s"},
    }
    state = client.put(f"{client.base}/campaign", json=content).json()
    assert not [f for f in state["faults"] if f["severity"] == "error" and "holdout" not in f["text"]], state["faults"]


def test_bad_files_show_their_faults_and_nothing_breaks(client):
    state = upload(client, ("broken.csv", b"time [s],F_rl [N],F_rr [N],yaw_rate [furlong]\n0,1,2,x\n0,1,2,3\n")).json()
    text = "\n".join(f["text"] for f in state["faults"])
    assert "'furlong'" in text
    assert "line 2" in text and "'x' is not a number" in text
    assert upload(client, ("campaign.toml", b"[campaign\nname=")).json()["faults"][0]["text"].startswith("campaign.toml line 1")
    assert upload(client, ("virus.exe", b"MZ")).json()["error"].startswith("virus.exe: .exe is no recording")
    assert "is a program, and the workbench runs none" in upload(client, ("drag.py", b"print(1)")).json()["error"]


@pytest.mark.parametrize("name", ["../../evil.csv", "/etc/evil.csv", ".hidden.csv", "a/../../evil.csv"])
def test_files_stay_in_their_folder(client, bench, name):
    assert "is no name for a file" in upload(client, (name, b"time [s]\n0\n")).json()["error"]
    assert not list(bench.root.parent.rglob("evil.csv"))


def test_an_empty_start_has_no_faults_of_a_file_that_nobody_wrote(client):
    state = client.get(f"{client.base}/state").json()
    assert state["faults"] == [] and state["files"] == [] and state["outcome"] is None


def test_what_is_too_small_to_matter_is_not_offered_to_be_put_in(client, bench):
    session = Session(bench.root, client.base.rpartition("/")[2])
    told = json.loads(SAMPLE_DIAGNOSIS.read_text(encoding="utf-8"))
    upload(client, *recordings())
    offered = []
    for verdict in ("missing", "small"):
        (session.folder / "diagnosis.json").write_text(json.dumps({**told, "verdict": verdict}), encoding="utf-8")
        offered.append(client.get(f"{client.base}/state").json()["outcome"]["effects"])
    assert offered == [told["effects"], []]


def test_the_outcome_is_of_the_last_diagnosis_and_says_whether_that_is_of_now(client, bench):
    session = Session(bench.root, client.base.rpartition("/")[2])
    upload(client, *recordings())
    known = json.loads(SAMPLE_DIAGNOSIS.read_text(encoding="utf-8"))
    told = json.dumps({**known, "notes": ["yaw_rate has the other sign than the model's, and is left out"]})
    for broken in ("{", "[]", "{}", told.replace('"effects"', '"others"')):
        (session.folder / "diagnosis.json").write_text(broken)
        assert client.get(f"{client.base}/state").json()["outcome"] is None
    (session.folder / "diagnosis.json").write_text(told)
    outcome = client.get(f"{client.base}/state").json()["outcome"]
    assert outcome["sentence"] == "Missing from the model: one rear wheel that rolls harder than the other."
    assert outcome["effects"] == outcome["order"][:1] == ["rolling_resistance_asymmetry"] and not outcome["fresh"]
    assert outcome["notes"] == ["the yaw rate has the other sign than the model's, and is left out"] and not outcome["forces"]
    assert len(outcome["cards"]) == 3 and "wheelchair add" not in str(outcome["cards"])
    session.note_diagnosed(session.at_hand())
    state = client.get(f"{client.base}/state").json()
    assert state["outcome"]["fresh"]
    changed = client.put(f"{client.base}/campaign", json={**state["campaign"], "noise": {"yaw_rate": "0.5 deg/s"}}).json()
    assert not changed["outcome"]["fresh"]


def test_the_sample_is_taken_in_once_and_gives_no_answer_away(client):
    state = client.post(f"{client.base}/sample").json()
    assert len(state["files"]) == 10 and state["faults"] == [] and state["outcome"] is None
    assert state["campaign"]["campaign"]["name"] == "sample-chair"
    assert "recordings here already" in client.post(f"{client.base}/sample").json()["error"]
    assert len(state["signals"]["yaw_rate [rad/s]"][state["files"][0]]) > 100 and state["times"] == ["time [s]"]
    seen = client.get(f"{client.base}/preview")
    assert seen.status_code == 200 and "<svg" in seen.text and "Nothing odd was found" in seen.text
    assert "default-src 'none'" in seen.headers["content-security-policy"]


def test_files_of_a_lab_are_read_together_and_that_can_be_undone(client, tmp_path):
    rng = np.random.default_rng(1)
    for i, ride in enumerate(lab.rides(1), 1):
        lab.rim(tmp_path / f"run{i:02d}_SWL.csv", ride, 0.7, "l", rng)
        lab.rim(tmp_path / f"run{i:02d}_SWR.csv", ride, 0.2, "r", rng, mirrored=True)
    files = [(f.name, f.read_bytes()) for f in sorted(tmp_path.iterdir())]
    before = upload(client, *files).json()["campaign"]
    assert client.post(f"{client.base}/jobs", json={"kind": "import", "mass": "heavy"}).status_code == 400
    sizes = {"mass": 90, "radius": lab.RADIUS, "track": 0.56, "wheelbase": 0.44, "cm_ahead": 0.1, "caster_track": 0.43}
    sizes |= {"caster_trail": 0.05, "wheel_inertia": 0.12}
    client.post(f"{client.base}/jobs", json={"kind": "import", **sizes})
    wait_for(lambda: client.get(f"{client.base}/job").json()["state"] != "running")
    state = client.get(f"{client.base}/state").json()
    assert state["job"]["state"] == "done", state["job"]["lines"]
    assert state["campaign"]["chair"] == {"m": 90, "a": 0.34, "b": 0.1, "t_r": 0.56, "t_f": 0.43}
    assert state["campaign"]["effect"]["caster_trail"] == {"c": 0.05} and "wheel_inertia" in state["campaign"]["effect"]
    assert {len(run["files"]) for run in state["campaign"]["run"]} == {2}
    assert not [f for f in state["faults"] if f["severity"] == "error"]
    assert len(state["history"]["steps"]) == 2 and state["history"]["steps"][1]["label"] == "files read anew"
    assert client.post(f"{client.base}/history", json={"by": -1}).json()["campaign"] == before
    again = client.post(f"{client.base}/history", json={"by": 1}).json()["campaign"]
    assert again == state["campaign"]
    moments = next(own for header, own in state["signals"].items() if header.startswith("Mz"))
    assert len(moments) == 2 and moments["run01_SWL.csv"] != moments["run01_SWR.csv"], "each device's own"
    gone = client.delete(f"{client.base}/files/{files[0][0]}").json()
    assert gone["campaign"]["run"] == again["run"][1:], "a run that lacks a file goes"
    assert gone["remark"] == f"{files[0][0]} was taken out; undo brings it back." and files[0][0] not in gone["files"]
    back = client.post(f"{client.base}/history", json={"by": -1}).json()
    assert back["campaign"] == again and files[0][0] in back["files"] and not back["remark"]
    assert files[0][0] not in client.post(f"{client.base}/history", json={"by": 1}).json()["files"]


def test_notes_and_pictures_in_a_folder_of_recordings_are_left_out_and_named(client):
    state = upload(client, ("README.md", b"# notes"), *recordings(), ("zz.pdf", b"%PDF")).json()
    assert len(state["files"]) == len(recordings()) and state["remark"] == "Left out, as no recording: README.md, zz.pdf."
    assert len(state["campaign"]["run"]) == len(recordings())


def test_a_size_at_its_bound_is_said_to_be_there():
    effect = bundled()["aerodynamic_drag"]
    (size,) = (p for p in effect.owned if p.smallest_interesting)
    assert list(_at_bounds(effect, {size.name: size.smallest_interesting})) == []
    (least,) = _at_bounds(effect, {size.name: size.lower})
    assert "the least that is allowed" in least and "acts the other way" in least
    (most,) = _at_bounds(effect, {size.name: size.upper})
    assert "the greatest that is allowed" in most


def test_two_tabs_do_not_disturb_each_other(client):
    other = begun(client)
    upload(client, *recordings())
    assert client.get(f"{other}/state").json()["files"] == []


def test_only_the_page_itself_may_change_anything(client, bench):
    with TestClient(bench.app(), "http://127.0.0.1:8765") as stranger:
        assert stranger.post(f"{client.base}/jobs", json={"kind": "diagnose"}).status_code == 403
        assert stranger.get(f"{client.base}/state", headers={"host": "evil.example"}).status_code == 400
    assert client.get("/s/000000000000/state").status_code == 404
    assert client.get("/page/../content.py").status_code == 404
    assert client.get("/page/%2e%2e/content.py").status_code == 404


def test_an_expression_is_judged_as_it_is_typed(client):
    def judged(expression, to="F_x"):
        return client.post(f"{client.base}/expression", json={"expression": expression, "to": to}).json()

    assert judged("-q * u") == {"unit": "N.s/m"}
    assert judged("-q * tanh(u / 3 [km/h])") == {"unit": "N"}
    assert "units do not fit" in judged("q * (u + m)")["why"]
    assert "is no expression" in judged("q *")["why"]
    assert "has a point in it" in judged("q * u.__class__")["why"]


def test_an_effect_of_ones_own_joins_the_catalogue(client):
    effect = {
        "id": "rubbing_brake",
        "title": "a brake that rubs",
        "to": "F_x",
        "expression": "-q * u",
        "size": 0.5,
        "lower": 0.0,
        "upper": 50.0,
    }
    state = client.post(f"{client.base}/effects", json=effect).json()
    assert {"id": "rubbing_brake", "title": "a brake that rubs", "own": True} in state["effects"] and not state["remark"]
    again = client.post(f"{client.base}/effects", json={**effect, "title": "a worn brake"}).json()
    assert again["remark"] == "This replaces your effect rubbing_brake, “a brake that rubs”."
    for change, why in (
        ({"id": "x y"}, "is no name for an effect"),
        ({"id": "toe_misalignment"}, "already"),
        ({"title": 'a"""b'}, 'plain words what the effect is: at most 200 letters, none of them " \\ { }'),
        ({"size": -1}, "“q matters from” above 0"),
        ({"size": "much"}, "not a number"),
        ({"expression": "q * foo"}, "'foo'"),
        ({"expression": "-q * u / sqrt(u * u)"}, "effect other, finite at standstill:"),
    ):
        answer = client.post(f"{client.base}/effects", json={**effect, "id": "other", **change})
        assert answer.status_code == 400
        assert why in answer.json()["error"]


def test_a_campaign_may_give_a_size_to_an_effect_of_ones_own(client, bench):
    session = Session(bench.root, client.base.rpartition("/")[2])
    rmtree(session.campaign, ignore_errors=True)
    with_settings(SAMPLE, session.campaign, {"coast-down": '{ "effect.rubbing.q" = 2.0 }'})
    assert any("effect.rubbing.q" in fault["text"] for fault in bench.told(session)["faults"])
    effect = {"id": "rubbing", "title": "it rubs", "to": "F_x", "expression": "-q * u", "size": 0.5, "lower": 0.0, "upper": 9.0}
    assert client.post(f"{client.base}/effects", json=effect).json()["faults"] == []


def test_an_effect_keeps_its_numbers_units(client, bench):
    effect = {
        "id": "stiction",
        "title": "a brake that sticks",
        "to": "F_x",
        "expression": "-q * tanh(u / 3 [km/h])",
        "size": 0.5,
        "lower": 0.0,
        "upper": 50.0,
    }
    assert client.post(f"{client.base}/effects", json=effect).status_code == 200
    own = Session(bench.root, client.base.rpartition("/")[2]).own_effects()["stiction"]
    assert own.parameters[0].unit.name == "N"
    assert own.contributions[0].law(q=2.0, u=3 / 3.6) == pytest.approx(-2 * tanh(1))


def test_undo_and_redo(client):
    assert client.post(f"{client.base}/history", json={"by": -1}).json()["error"] == "there is nothing to undo"
    assert client.post(f"{client.base}/history", json={"by": 5}).status_code == 400


def test_a_campaign_is_edited_undone_and_done_again(client):
    content = upload(client, *recordings()).json()["campaign"]
    assert client.get(f"{client.base}/state").json()["noise"]["yaw_rate"] > 0, "estimated"
    edited = {**content, "noise": {"yaw_rate": "0.5 deg/s"}, "prior": {"chair": {"m": 2.0}}}
    state = client.put(f"{client.base}/campaign", json=edited).json()
    assert state["noise"]["yaw_rate"] == pytest.approx(radians(0.5))
    assert state["history"]["steps"][-1]["label"] == "noise.yaw_rate = 0.5 deg/s, and 1 more"
    assert client.put(f"{client.base}/campaign", json=edited).json()["history"] == state["history"], "nothing was changed"
    upload(client, ("later.csv", recordings()[0][1]))
    undone = client.post(f"{client.base}/history", json={"by": -1}).json()["campaign"]
    assert "noise" not in undone
    assert {r["file"] for r in undone["run"]} == {"later.csv", *(r["file"] for r in content["run"])}, "recordings stay"
    redone = client.post(f"{client.base}/history", json={"by": 1}).json()
    assert redone["campaign"]["noise"] == edited["noise"]
    assert redone["campaign"]["prior"] == edited["prior"]
    bad = client.put(f"{client.base}/campaign", json={**content, "noise": {"yaw_rate": "0.5 kg"}}).json()
    assert any("'kg' measures a mass" in f["text"] for f in bad["faults"])


def test_another_law_is_a_step_that_can_be_undone(client, bench):
    at = begun(client)
    state = client.get(f"{at}/state").json()
    assert state["laws"] == {"tyre": "linear", "caster": "ideal", "wheel": "rolling"}
    assert {"tyre dugoff", "wheel spinning"} < {f"{law['of']} {law['name']}" for law in state["every_law"]}
    assert all(law["says"] for law in state["every_law"])
    session = Session(bench.root, at.rpartition("/")[2])
    session.keep(session.variant().with_values({"chair.m": 90.0, "tyre.law": "magic_formula"}), "calibrated")
    state = client.post(f"{at}/laws", json={"of": "caster", "name": "slipping"}).json()
    assert state["laws"] == {"tyre": "magic_formula", "caster": "slipping", "wheel": "rolling"}
    assert state["history"]["steps"][-1]["label"] == "caster law slipping" and 'caster = "slipping"' in state["variant"]
    session.keep(session.variant().with_values({"caster.M": 0.2}), "calibrated")
    state = client.post(f"{at}/laws", json={"of": "caster", "name": "ideal"}).json()
    assert state["laws"]["caster"] == "ideal" and session.variant().values == {"chair.m": 90.0}
    assert client.post(f"{at}/history", json={"by": -1}).json()["laws"]["caster"] == "slipping"
    steps = len(session.history()["steps"])
    assert len(client.post(f"{at}/laws", json={"of": "caster", "name": "slipping"}).json()["history"]["steps"]) == steps


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"of": "caster", "name": "idle"}, "did you mean 'ideal'"),
        ({"of": "equations", "name": "paper"}, "no kind of law 'equations'"),
        ({}, "no kind of law ''"),
        ({"of": "caster", "name": "ideal"}, "is in this model and needs the caster law swivelling"),
    ],
)
def test_a_law_that_cannot_be_is_refused(client, bench, asked, said):
    at = begun(client)
    session = Session(bench.root, at.rpartition("/")[2])
    session.keep(session.variant().with_effects(["caster_friction"]), "+ caster_friction")
    answer = client.post(f"{at}/laws", json=asked)
    assert answer.status_code == 400 and said in answer.json()["error"]
    assert session.laws()["caster"] == "swivelling"


def test_laws_are_told_where_no_variant_can_be_read(client, bench):
    session = Session(bench.root, begun(client).rpartition("/")[2])
    session.variant_file.write_text("[laws\n")
    assert session.laws()["tyre"] == "linear"


def test_comments_and_layout_outlast_the_forms(client, bench):
    file = Session(bench.root, client.base.rpartition("/")[2]).campaign / "campaign.toml"
    text = "# as weighed in spring\n" + (SAMPLE / "campaign.toml").read_text()
    state = upload(client, ("campaign.toml", text.encode()), *((f"runs/{n}", c) for n, c in recordings())).json()
    assert file.read_text() == text
    state["campaign"]["chair"]["m"] = 82
    client.put(f"{client.base}/campaign", json=state["campaign"])
    edited = text.replace("m = 80.0", "m = 82")
    assert file.read_text() == edited
    assert client.delete(f"{client.base}/files/runs/slalom-slow.csv").status_code == 200
    head, _, rest = edited.partition('[[run]]\nfile = "runs/slalom-slow.csv"')
    assert file.read_text() == head + rest[rest.index("[[run]]") :]
    client.post(f"{client.base}/history", json={"by": -1})
    assert file.read_text() == edited, "what was taken out is back"
    client.post(f"{client.base}/history", json={"by": -1})
    assert file.read_text().startswith("# as weighed in spring") and "m = 80.0" in file.read_text()
    late = upload(client, ("late.csv", recordings()[0][1])).json()
    assert late["campaign"]["run"][-1]["file"] == "late.csv" and "# from the test rig" in file.read_text()


def test_old_work_goes_and_what_is_in_use_stays(client, bench, tmp_path):
    sessions = {name: Session.begin(tmp_path / "work") for name in ("recent", "old", "empty", "new")}
    for name in ("recent", "old"):
        sessions[name].put(f"{name}.csv", BytesIO(recordings()[0][1]))
        sessions[name].draft()
    (tmp_path / "work" / "notes").mkdir()
    now = time.time()
    for name, days in (("recent", 80), ("old", 100), ("empty", 2)):
        utime(sessions[name].folder, (now - days * 86400,) * 2)
    assert prune(tmp_path / "work") == ["campaign"]
    assert {name for name, s in sessions.items() if s.there} == {"recent", "new"}
    assert (tmp_path / "work" / "notes").exists(), "what is not ours"
    here = Session(bench.root, client.base.rpartition("/")[2])
    utime(here.folder, (now - 100 * 86400,) * 2)
    client.get(f"{client.base}/state")
    prune(bench.root)
    assert here.there, "somebody is looking at it"


def test_long_work_can_be_cancelled(client):
    upload(client, *recordings())
    assert client.post(f"{client.base}/jobs", json={"kind": "diagnose"}).json()["job"]["state"] == "running"
    assert "still running" in client.post(f"{client.base}/jobs", json={"kind": "calibrate"}).json()["error"]
    wait_for(lambda: client.get(f"{client.base}/job").json()["lines"])
    state = client.delete(f"{client.base}/jobs").json()
    assert state["job"]["state"] == "cancelled"
    assert state["report"] is None
    assert len(state["history"]["steps"]) == 1
    assert client.post(f"{client.base}/jobs", json={"kind": "bake"}).status_code == 400


def wait_for(ready, seconds: float = 120) -> None:
    end = time.monotonic() + seconds
    while not ready():
        assert time.monotonic() < end
        time.sleep(0.1)


def test_json_after_other_lines():
    assert printed_json('out/a.png\n{"a": 1}\n') == {"a": 1}


def test_what_an_import_only_guessed_is_to_be_looked_at_until_it_is_changed(client):
    rolling = b"time,u,yaw_rate\n" + b"".join(b"%.2f,%.4f,%.4f\n" % (i / 50, 1 + i / 400, 0.1 * (i % 50)) for i in range(400))
    upload(client, ("a-coast.csv", rolling), ("b-coast.csv", rolling.replace(b"1.0", b"1.1")))

    def read_anew(**more) -> dict:
        assert client.post(f"{client.base}/jobs", json={"kind": "import", "mass": 90, **more}).status_code == 200
        wait_for(lambda: client.get(f"{client.base}/job").json()["state"] != "running")
        state = client.get(f"{client.base}/state").json()
        assert state["job"]["state"] == "done" and state["job"]["steps"] >= 4, state["job"]["lines"]
        return state

    state = read_anew()
    guesses = [f for f in state["faults"] if f["severity"] == "guess"]
    assert {f["column"] for f in guesses if f["column"]} == {"u", "yaw_rate"}
    assert all(f["what"].endswith("check it") for f in guesses if f["column"]), guesses
    assert all(f["file"] in state["files"] for f in guesses if f["column"])
    assert [f["at"] for f in guesses if not f["column"]][:1] == ["campaign.axes"]
    content = state["campaign"]
    content["columns"]["yaw_rate"]["unit"] = "deg/s"
    content |= {"noise": {"u": 0.02}, "chair": {**content["chair"], "I_z": 3.3}}
    content["run"][0]["manoeuvre"] = "down the ramp"
    state = client.put(f"{client.base}/campaign", json=content).json()
    assert "yaw_rate" not in {f["column"] for f in state["faults"] if f["severity"] == "guess"}, "somebody has looked at it"
    again = client.post(f"{client.base}/history", json={"by": -1}).json()
    assert "yaw_rate" in {f["column"] for f in again["faults"] if f["severity"] == "guess"}
    client.post(f"{client.base}/history", json={"by": 1})
    anew = read_anew(track=0.6)["campaign"]
    assert anew["noise"] == {"u": 0.02} and anew["chair"] == {"m": 90, "t_r": 0.6, "I_z": 3.3}, "written by hand"
    assert anew["run"][0]["manoeuvre"] == "down the ramp" and anew["columns"]["yaw_rate"]["unit"] == "rad/s"


def test_a_wrong_value_is_told_with_its_place(client):
    content = upload(client, *recordings()).json()["campaign"]
    content |= {"chair": {"m": "heavy"}, "noise": {"yaw_rate": -1}, "prior": {"chair": {"I_z": 0}}}
    faults = client.put(f"{client.base}/campaign", json=content).json()["faults"]
    assert {f["at"] for f in faults if f["severity"] == "error"} == {"chair.m", "noise.yaw_rate", "prior.chair.I_z"}


def test_the_page_asks_for_sizes_within_the_bounds_of_import():
    fields = re.findall(r'<input name="(\w+)"[^>]* data-least="([^"]+)" data-most="([^"]+)"', asset("workbench.html"))
    assert {name: (float(least), float(most)) for name, least, most in fields} == BOUNDS
