"""Whatever is sent to the real server: an answer in a sentence, never a failure of the server."""

from __future__ import annotations

import json
import os
import secrets
from contextlib import closing

import pytest

httpx = pytest.importorskip("httpx", reason="the workbench's libraries are not installed")
from hypothesis import HealthCheck, given, seed, settings  # noqa: E402
from hypothesis import strategies as st  # noqa: E402

from tests.workbench.conftest import started  # noqa: E402

SEED = int(os.environ.get("WHEELCHAIR_SEED") or secrets.randbelow(2**32))
EXAMPLES = int(os.environ.get("WHEELCHAIR_EXAMPLES") or 1500)
PLACES = (
    "",
    "state",
    "job",
    "jobs",
    "files",
    "files/a.csv",
    "campaign",
    "history",
    "expression",
    "effects",
    "report",
    "export/variant.toml",
    "export/parameters.ssv",
    "export/report.html",
    "export/x",
)
KEYS = [
    "campaign",
    "run",
    "columns",
    "noise",
    "prior",
    "chair",
    "nuisance",
    "file",
    "role",
    "u0",
    "name",
    "axes",
    "unit",
    "column",
    "kind",
    "names",
    "by",
    "id",
    "title",
    "to",
    "expression",
    "size",
    "lower",
    "upper",
    "effect",
]
SAID = ["a.csv", "q * u", "F_x", "holdout", "fit", "calibrate", "9**9**9", "0.5 deg/s", "yaw_rate [rad/s]"]
WORDS = st.one_of(st.sampled_from(SAID), st.text(max_size=30))
PLAIN = st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), WORDS)
NAMED = st.one_of(st.sampled_from(KEYS), WORDS)
VALUES = st.recursive(PLAIN, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(NAMED, inner, max_size=5))
TREES = st.dictionaries(st.sampled_from(KEYS), VALUES, max_size=6)
BODIES = st.one_of(TREES.map(lambda tree: json.dumps(tree).encode()), st.binary(max_size=300))
NAMES = st.one_of(st.sampled_from(["campaign.toml", "a.csv", "b.csv.gz", "c.parquet", "d.txt", "e.dat"]), st.text(max_size=20))
TABLES = st.text("0123456789,.;-eE \nnaif", max_size=300).map(lambda rows: f"time [s],yaw_rate [deg/s]\n{rows}".encode())
CONTENTS = st.one_of(st.binary(max_size=400), st.text(max_size=400).map(lambda text: text.encode("utf-8", "replace")), TABLES)
SENT = ["origin", "sec-fetch-site", "content-type", "accept", "range", "cookie", "x-workbench-token", "content-encoding"]
ASCII = st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=30)
HEADERS = st.dictionaries(st.sampled_from(SENT), ASCII, max_size=2)
METHODS = ("GET", "POST", "PUT", "DELETE", "HEAD", "PATCH", "OPTIONS")
THOROUGH = settings(deadline=None, suppress_health_check=list(HealthCheck), database=None)


@pytest.fixture
def asked(tmp_path):
    """Sends a request about one session, and judges the answer."""
    for server in started(tmp_path, "--upload-limit", "1"):
        with closing(server.visitor()) as client:
            session = client.post("/sessions").json()["id"]

            def ask(method: str, path: str, **more) -> None:
                try:
                    request = client.build_request(method, path.format(session=session), **more)  # noqa: B023
                except (httpx.InvalidURL, UnicodeEncodeError):
                    return  # no client can send it
                if request.url.netloc != client.base_url.netloc:
                    return
                try:
                    answer = client.send(request)
                except httpx.LocalProtocolError:
                    return
                assert answer.status_code < 500, (answer.status_code, answer.text[:500])
                assert "Traceback" not in answer.text
                assert client.get(f"/s/{session}/state").status_code == 200, "the session still opens"  # noqa: B023

            yield ask
        assert "Traceback" not in server.said.read_text(), server.said.read_text()[-3000:]


@pytest.mark.nightly
def test_workbench_attacks(asked):
    print(f"seed {SEED}: WHEELCHAIR_SEED={SEED} repeats it; WHEELCHAIR_EXAMPLES asks for another number than {EXAMPLES}")
    asked("POST", "/s/{session}/files", files=[("files", ("a.csv", b"time [s],yaw_rate [rad/s]\n0,1\n1,2\n"))])

    @seed(SEED)
    @settings(THOROUGH, max_examples=EXAMPLES // 3)
    @given(TREES)
    def edited(content):
        asked("PUT", "/s/{session}/campaign", content=json.dumps(content))

    @seed(SEED)
    @settings(THOROUGH, max_examples=EXAMPLES // 3)
    @given(NAMES, CONTENTS)
    def uploaded(name, content):
        asked("POST", "/s/{session}/files", files=[("files", (name, content))])

    @seed(SEED)
    @settings(THOROUGH, max_examples=EXAMPLES)
    @given(st.sampled_from(METHODS), st.sampled_from(PLACES), BODIES, HEADERS)
    def sent(method, place, body, headers):
        asked(method, f"/s/{{session}}/{place}", content=body, headers=headers)

    @seed(SEED)
    @settings(THOROUGH, max_examples=EXAMPLES // 3)
    @given(st.text(max_size=30).filter(lambda path: not {"{", "}"} & set(path)), st.sampled_from(METHODS))
    def looked_for(path, method):
        asked(method, f"/{path}")

    for attack in (edited, uploaded, sent, looked_for):
        attack()
