"""What people and pages that mean harm have tried, each over HTTP against the real server."""

from __future__ import annotations

import gzip
import json
import os
import stat
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from math import tanh
from pathlib import Path

import pytest

httpx = pytest.importorskip("httpx", reason="the workbench's libraries are not installed")
from tests.workbench.conftest import Server, started  # noqa: E402
from wheelchair_fmu.contracts.own import load  # noqa: E402

HEAD = "time [s],F_rl [N],F_rr [N],yaw_rate [rad/s]\n"
EFFECT = {"id": "my_drag", "title": "a drag", "to": "F_x", "expression": "-q * u", "size": 0.5, "lower": 0.0, "upper": 50.0}


def recording(i: int = 0) -> bytes:
    return (HEAD + "".join(f"{k / 100},1,{i},0.{k % 7}\n" for k in range(50))).encode()


class Visit:
    """One session of somebody who opened the page."""

    def __init__(self, client: httpx.Client):
        self.client, self.id = client, client.post("/sessions").json()["id"]

    def __getattr__(self, method: str):
        return lambda path, **more: getattr(self.client, method)(f"/s/{self.id}/{path}", **more)

    def upload(self, name: str, content: bytes) -> httpx.Response:
        return self.post("files", files=[("files", (name, content))])


@pytest.fixture(scope="module")
def client(server: Server):
    with closing(server.visitor()) as client:
        yield client


@pytest.fixture
def visit(client, server: Server):
    yield Visit(client)
    assert "Traceback" not in server.said.read_text()


def refused(answer: httpx.Response, status: int, why: str) -> None:
    error = answer.json()["error"]
    assert (answer.status_code, why in error) == (status, True), (answer.status_code, error)
    assert "\n" not in error and "Traceback" not in error and len(error) < 500


# -- who may ask --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", "/"),
        ("GET", "/page/workbench.js"),
        ("POST", "/sessions"),
        ("GET", "/s/{id}"),
        ("GET", "/s/{id}/state"),
        ("GET", "/s/{id}/report"),
        ("GET", "/s/{id}/export/variant.toml"),
        ("PUT", "/s/{id}/campaign"),
        ("POST", "/s/{id}/effects"),
        ("POST", "/s/{id}/files"),
        ("DELETE", "/s/{id}/jobs"),
        ("GET", "/nowhere"),
        ("OPTIONS", "/s/{id}/state"),
    ],
)
@pytest.mark.parametrize("headers", [{}, {"x-workbench-token": "guess"}, {"x-workbench-token": b"\xe9"}])
def test_nobody_is_answered_without_the_token(server, visit, method, path, headers):
    answer = httpx.request(method, server.address + path.format(id=visit.id), headers={"x-workbench": "1", **headers})
    refused(answer, 403, "open the workbench by the address that it printed")


def test_the_token_becomes_a_cookie_that_scripts_and_other_sites_do_not_get(server):
    answer = httpx.get(server.printed)
    assert (answer.status_code, answer.headers["location"]) == (303, "/")
    cookie = answer.headers["set-cookie"].lower()
    assert "httponly" in cookie and "samesite=strict" in cookie
    assert httpx.get(f"{server.address}/?token=guess").status_code == 403
    assert httpx.get(f"{server.address}/?token=", headers={"accept": "text/html"}).text.startswith("open the workbench by")
    with_header = httpx.get(f"{server.address}/", headers={"x-workbench-token": server.token})
    assert with_header.status_code == 200


def test_two_workbenches_have_two_tokens(server, tmp_path):
    for other in started(tmp_path):
        assert other.token != server.token and len(other.token) >= 43
        refused(httpx.get(other.address, headers={"x-workbench-token": server.token}), 403, "open the workbench by")


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "http://evil.example"},
        {"origin": "null"},
        {"origin": "http://127.0.0.1:1"},
        {"origin": "https://{host}"},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
        {"x-workbench": None},
    ],
)
def test_another_sites_page_changes_nothing_even_with_the_cookie(client, visit, headers):
    sent = {k: v.format(host=client.base_url.netloc.decode()) for k, v in headers.items() if v}
    request = client.build_request("POST", f"/s/{visit.id}/effects", json=EFFECT, headers=sent)
    for name in (k for k, v in headers.items() if v is None):
        del request.headers[name]
    refused(client.send(request), 403, "only the workbench's own page")
    assert "my_drag" not in [e["id"] for e in visit.get("state").json()["effects"]]


def test_the_page_itself_may(client, visit):
    own = {"origin": str(client.base_url).rstrip("/"), "sec-fetch-site": "same-origin"}
    assert visit.post("effects", json=EFFECT, headers=own).status_code == 200


def test_another_pages_script_reads_nothing_but_a_link_may_be_followed(visit):
    other = {"sec-fetch-site": "same-site", "sec-fetch-mode": "no-cors", "sec-fetch-dest": "script"}
    refused(visit.get("state", headers=other), 403, "only the workbench's own page")
    link = {"sec-fetch-site": "same-site", "sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}
    assert visit.get("", headers=link, follow_redirects=True).status_code == 200


@pytest.mark.parametrize("host", ["evil.example", "testserver", "127.0.0.1.evil.example", "127.0.0.1:x", "", "[::1]"])
def test_other_names_for_this_machine_are_not_answered(client, host):
    refused(client.get("/", headers={"host": host, "accept": "*/*"}), 400, "127.0.0.1 and localhost only")


def test_opening_an_address_changes_nothing(client, server, visit):
    visit.upload("a.csv", recording())

    def all_files() -> dict[str, bytes]:
        return {str(p): p.read_bytes() for p in server.folder.rglob("*") if p.is_file()}

    before = all_files()
    for path in (
        "/",
        f"/s/{visit.id}",
        f"/s/{visit.id}/state",
        f"/s/{visit.id}/job",
        f"/s/{visit.id}/export/variant.toml",
        f"/s/{visit.id}/export/parameters.ssv",
        "/sessions",
        f"/s/{visit.id}/jobs",
    ):
        client.get(path)
        client.head(path)
    assert all_files() == before


# -- what runs ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "expression",
    [
        '-q * u # " + str(__import__("pathlib").Path("{marker}").write_text("")) + " end',
        '-q * u"))); __import__("pathlib").Path("{marker}").write_text(""); (((law("',
        "-q * u\n__import__('pathlib').Path('{marker}').write_text('')",
        "-q * u * open('{marker}', 'w')",
        "(lambda: q)()",
        "q.__class__.__base__.__subclasses__()",
    ],
)
def test_nothing_typed_is_run(visit, tmp_path, expression):
    typed = expression.replace("{marker}", str(tmp_path / "marker"))
    answer = visit.post("effects", json={**EFFECT, "expression": typed})
    assert answer.status_code == 400
    assert any(why in answer.json()["error"] for why in ("allowed", "is no expression", "no function"))
    why = visit.post("expression", json={"expression": typed, "to": "F_x"}).json()
    assert why["unit"] is None and why["why"]
    assert not list(tmp_path.iterdir())
    state = visit.get("state").json()
    assert "my_drag" not in [e["id"] for e in state["effects"]], "and the session still opens"


@pytest.mark.parametrize("title", ['a"""; import os; """', "a\\", "{q}", "a\x00b", "x" * 300, ""])
def test_words_do_not_leave_their_place_in_an_effect_file(visit, title):
    answer = visit.post("effects", json={**EFFECT, "title": title})
    assert answer.status_code == 400


def test_an_effect_typed_here_works_as_a_file_elsewhere(visit, server):
    typed = {**EFFECT, "title": "a driver's `brake` #1", "expression": "-q*tanh(u/3 [km/h])"}
    assert visit.post("effects", json=typed).status_code == 200
    effect = load(server.folder / visit.id / "effects")["my_drag"]
    assert effect.title == "a driver's `brake` #1"
    assert effect.contributions[0].law(q=2.0, u=3 / 3.6) == pytest.approx(-2 * tanh(1))


@pytest.mark.parametrize("name", ["drag.py", "runs/drag.PY", "chair.fmu", "chair.ssp"])
def test_programs_are_not_taken_in(visit, server, name):
    refused(visit.upload(name, b"open('marker', 'w')"), 400, "is a program, and the workbench runs none")
    assert not list(server.folder.rglob(Path(name).name))


def test_a_session_whose_effect_is_broken_still_opens_and_says_so(visit, server):
    effects = server.folder / visit.id / "effects"
    assert visit.post("effects", json=EFFECT).status_code == 200
    (effects / "bad.py").write_text("EFFECT = 1 / 0")
    (effects / "leaver.py").write_text("raise SystemExit(3)")
    state = visit.get("state").json()
    text = "\n".join(f["text"] for f in state["faults"])
    assert "cannot be read as an effect: ZeroDivisionError" in text and "bad.py" in text and "leaver.py" in text
    assert [e["id"] for e in state["effects"] if e["own"]] == ["my_drag"]


# -- what is too much ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"expression": "q*0/0"}, "has no finite value"),
        ({"expression": "q" + "+q" * 20_000}, "is too long"),
        ({"expression": "(" * 900 + "q" + ")" * 900}, "nested"),
        ({"expression": "-" * 1900 + "q"}, "nested"),
        ({"expression": "q * 9**9**9"}, "an exponent"),
        ({"expression": "q * 3 [9**9**9]"}, "is unknown"),
        ({"id": "a" * 300}, "is no name for an effect"),
        ({"id": "../../evil"}, "is no name for an effect"),
        ({"upper": 1e999}, "is not a number"),
        ({"upper": 10**400}, "is not a number"),
        ({"to": "a" * 10_000}, "no quantity to act on"),
    ],
)
def test_an_effect_that_cannot_be_is_refused_at_once(visit, change, why):
    answer = visit.post("effects", content=json.dumps({**EFFECT, **change}), timeout=10)
    assert answer.status_code == 400 and why in answer.json()["error"]
    assert visit.get("state").status_code == 200


@pytest.mark.parametrize(
    ("body", "status", "why"),
    [
        (b"[" * 100_000, 400, "nested more than 20 deep"),
        (b'{"a":' * 30 + b"1" + b"}" * 30, 400, "nested more than 20 deep"),
        (b'{"a": ' + b"9" * 5000 + b"}", 400, "holds no JSON"),
        (b'{"a": [' + b"1," * 60_000 + b"1]}", 400, "holds more than 50000 values"),
        (b'{"a": "' + b"x" * 1_100_000 + b'"}', 413, "more than 1 MB is too much"),
        (b'{"a": "\\ud800"}', 400, "cannot be printed"),
        (b'{"a\\u0000": 1}', 400, "cannot be printed"),
        (b"\xff\xfe", 400, "holds no JSON"),
        (b"[]", 400, "holds no JSON object"),
        (b"", 400, "holds no JSON"),
        (b'{"a": null}', 400, "campaign.toml cannot hold this"),
    ],
)
def test_json_that_cannot_be_is_refused(visit, body, status, why):
    before = visit.get("state").json()["campaign"]
    refused(visit.put("campaign", content=body), status, why)
    assert visit.get("state").json()["campaign"] == before


def in_pieces(size: int):
    for _ in range(0, size, 1 << 16):
        yield b"0" * (1 << 16)


def test_what_is_sent_is_counted_while_it_is_read(visit, server):
    refused(visit.put("campaign", content=in_pieces(2_000_000)), 413, "more than 1 MB is too much")
    refused(visit.upload("big.csv", b"0" * 4_000_000), 413, "more than 3 MB at once")
    boundary = {"content-type": "multipart/form-data; boundary=x"}
    start = b'--x\r\ncontent-disposition: form-data; name="files"; filename="big.csv"\r\n\r\n'

    def endless():
        yield start
        yield from in_pieces(30_000_000)

    refused(visit.post("files", content=endless(), headers=boundary), 413, "more than 3 MB at once")
    assert visit.get("state").json()["files"] == []


def test_a_bomb_is_not_unpacked(visit):
    bomb = gzip.compress(b"0" * 200_000_000)
    assert len(bomb) < 1_000_000
    refused(visit.upload("bomb.csv.gz", bomb), 400, "unpacks to more than 3 MB")
    assert visit.get("state").json()["files"] == []
    assert visit.upload("broken.csv.gz", b"\x1f\x8b nonsense").json()["faults"]


@pytest.mark.parametrize(
    "name",
    [
        "x" * 300 + ".csv",
        "é" * 100 + ".csv",
        "/".join("abcdefghij") + ".csv",
        "a/../../b.csv",
        "/etc/x.csv",
        ".git/x.csv",
        "..\\..\\x.csv",
        "C:\\x.exe",
        ".csv",
        "",
    ],
)
def test_names_that_no_recording_has_are_refused(visit, server, name):
    answer = visit.upload(name, recording())
    assert answer.status_code == 400 and answer.json()["error"]
    assert visit.get("state").json()["files"] == []
    assert not list(server.folder.parent.glob("*.csv"))


def test_a_file_in_the_place_of_a_folder_is_said(visit):
    assert visit.upload("a.csv", recording()).status_code == 200
    refused(visit.upload("a.csv/b.csv", recording()), 400, "cannot be kept")


@pytest.mark.parametrize(
    "path",
    [
        "/s/" + "a" * 300 + "/state",
        "/s/..%2f..%2fetc/state",
        "/s/%00/state",
        "/page/" + "a" * 5000,
        "/page/%2e%2e/page.py",
        "/page/%00.js",
        "/s/000000000000/state",
        "/s/zz/export/x",
    ],
)
def test_addresses_that_lead_nowhere_say_so(client, path):
    answer = client.get(path)
    assert answer.status_code in (400, 404) and answer.json()["error"]


@pytest.mark.parametrize(
    ("method", "path", "content"),
    [
        ("post", "jobs", {"kind": ["diagnose"]}),
        ("post", "jobs", {"kind": "add", "effect": ["x"]}),
        ("post", "history", {"by": 1.0}),
        ("post", "jobs", {"kind": "calibrate", "names": "--help"}),
        ("post", "history", {"by": [1]}),
        ("post", "history", {"by": True}),
        ("post", "effects", {"id": ["x"]}),
        ("post", "effects", {**EFFECT, "size": True}),
        ("post", "files", {}),
    ],
)
def test_values_of_another_kind_are_refused(visit, method, path, content):
    answer = getattr(visit, method)(path, json=content)
    assert answer.status_code == 400 and answer.json()["error"]


@pytest.mark.parametrize(
    "content",
    [
        {"campaign": "x"},
        {"campaign": ["x"]},
        {"campaign": {"name": ["x"]}},
        {"run": "x"},
        {"run": [1, "x"]},
        {"run": [{"file": [1]}]},
        {"columns": 5},
        {"columns": {"yaw_rate": 5}},
        {"noise": [1]},
        {"chair": "x"},
        {"prior": {"chair": 1}},
        {"nuisance": 3},
        {"run": [{"file": "a.csv", "role": {"x": 1}, "u0": []}]},
        {"columns": {"yaw_rate": {"column": "yaw_rate [rad/s]", "unit": "9**9**9"}}},
    ],
)
def test_a_campaign_of_another_shape_has_faults_and_breaks_nothing(visit, content):
    assert visit.upload("a.csv", recording()).status_code == 200
    assert visit.put("campaign", json=content, timeout=20).status_code == 200
    assert visit.upload("b.csv", recording()).status_code == 200
    assert visit.delete("files/a.csv").status_code == 200
    assert visit.get("state").json()["files"] == ["b.csv"]
    for _ in range(2):  # what was taken out comes back, and then the form as it was
        assert visit.post("history", json={"by": -1}).status_code == 200
        assert visit.get("state").json()["files"] == ["a.csv", "b.csv"]


@pytest.mark.parametrize(
    "text",
    [
        b"a = nan\nb = 1979-05-27T07:32:00Z\nc = 07:32:00\nd = inf\n",
        b"a = " + b"[" * 400 + b"]" * 400,
        b"a = " + b"9" * 5000,
        b"[campaign]\nname = '\x01'",
        b"\xff\xfe\x00",
        b'[campaign]\nname = "\\u0001"',
        b"a." * 500 + b"b = 1",
    ],
)
def test_whatever_a_campaign_file_holds_the_session_opens(visit, text):
    answer = visit.upload("campaign.toml", text)
    assert answer.status_code == 200, answer.text
    assert visit.upload("a.csv", recording()).status_code == 200
    assert visit.get("state").status_code == 200
    assert visit.get("export/parameters.ssv").status_code == 200


@pytest.mark.parametrize(
    "history",
    [
        "",
        "{",
        "[]",
        "[" * 5000,
        '{"at": 7, "steps": []}',
        '{"at": "x", "steps": [1]}',
        '{"at": 0, "steps": [{"label": "x", "file": "../../x", "ladder": 0}]}',
    ],
)
def test_a_session_whose_history_is_broken_opens_with_a_fault(visit, server, history):
    visit.upload("a.csv", recording())
    (server.folder / visit.id / "history.json").write_text(history)
    state = visit.get("state").json()
    assert any("history.json" in f["text"] for f in state["faults"])
    assert [s["label"] for s in state["history"]["steps"]] == ["variant 0"]
    edited = visit.put("campaign", json={**state["campaign"], "noise": {"yaw_rate": "0.5 deg/s"}}).json()
    assert len(edited["history"]["steps"]) == 2 and not any("history.json" in f["text"] for f in edited["faults"])


def test_a_session_without_any_variant_still_opens(visit, server):
    for file in (server.folder / visit.id / "variants").iterdir():
        file.unlink()
    assert visit.get("state").status_code == 200
    refused(visit.get("export/variant.toml"), 400, "has no variants left")
    refused(visit.put("campaign", json={"campaign": {"name": "x"}}), 400, "has no variants left")


# -- others -------------------------------------------------------------------------------------------------


@pytest.mark.skipif(os.name != "posix", reason="rights as POSIX has them")
def test_recordings_are_their_owners_alone(visit, server):
    visit.upload("runs/a.csv", recording())
    visit.post("effects", json=EFFECT)
    for path in (server.folder, server.folder / visit.id, *(server.folder / visit.id).rglob("*")):
        assert stat.S_IMODE(path.stat().st_mode) == (0o700 if path.is_dir() else 0o600), path


@pytest.mark.skipif(os.name != "posix", reason="rights as POSIX has them")
def test_what_earlier_versions_left_open_is_closed(tmp_path):
    old, notes = tmp_path / "work" / "0123456789ab", tmp_path / "work" / "notes"
    for folder in (old / "campaign", notes):
        folder.mkdir(parents=True)
    (notes / "mine.txt").write_text("not the workbench's")
    (old / "history.json").write_text('{"at": -1, "steps": []}')
    (old / "campaign" / "a.csv").write_bytes(recording())
    (old / "campaign" / "link.csv").symlink_to(notes / "mine.txt")
    for path in (old, old / "campaign", notes):
        path.chmod(0o755)
    for path in (notes / "mine.txt", old / "campaign" / "a.csv", old / "history.json"):
        path.chmod(0o644)
    for _ in started(tmp_path):
        modes = {p.name: stat.S_IMODE(p.stat().st_mode) for p in (*old.rglob("*"), old, notes, notes / "mine.txt")}
    others = [modes.pop(name) for name in ("notes", "link.csv", "mine.txt")]
    assert others == [0o755, 0o644, 0o644], "what is not the workbench's stays as it is"
    assert modes == {"0123456789ab": 0o700, "campaign": 0o700, "a.csv": 0o600, "history.json": 0o600}


def test_fifty_at_once_lose_nothing(visit):
    """Recordings, effects and edits of the same campaign.toml, which each knows as it was at the start."""
    known = visit.upload("first.csv", recording()).json()["campaign"]

    def act(i: int) -> int:
        if i < 8:
            return visit.upload(f"run-{i:02}.csv", recording(i)).status_code
        if i < 29:
            return visit.post("effects", json={**EFFECT, "id": f"drag_{i}"}).status_code
        return visit.put("campaign", json={**known, "noise": {"yaw_rate": f"0.{i} deg/s"}}).status_code

    with ThreadPoolExecutor(50) as pool:
        assert set(pool.map(act, range(50))) == {200}
    state = visit.get("state").json()
    assert state["files"] == ["first.csv", *(f"run-{i:02}.csv" for i in range(8))]
    assert sorted(r["file"] for r in state["campaign"]["run"]) == state["files"]
    assert len([e for e in state["effects"] if e["own"]]) == 21
    labels = [step["label"].partition(",")[0] for step in state["history"]["steps"]]
    assert sorted(labels) == sorted(["nominal", *(f"noise.yaw_rate = 0.{i} deg/s" for i in range(29, 50))])
