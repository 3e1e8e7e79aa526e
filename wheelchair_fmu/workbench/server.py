"""The workbench's addresses. JSON in and out; every refusal is {"error": one sentence}."""

from __future__ import annotations

import math
import re
from collections.abc import Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.middleware import Middleware
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, JSONResponse, RedirectResponse, Response
from starlette.routing import Route

from ..contracts.own import checked
from ..errors import UsageError, WheelchairError, unknown
from ..fmu.build import build
from ..fmu.parameter_set import from_variant, text
from ..loop.subject import known_parameters
from ..loop.workshop import CALIBRATED
from ..model.dimensions import targets, unit_of_q, vocabulary
from ..model.effects import bundled
from ..model.expression import effect_file
from ..model.variant import Variant
from ..model.wheelchair import assemble
from ..report.page import ASSETS, asset
from .jobs import Job, Jobs, printed_json
from .session import Session, channel_list, write

HEADER = "x-workbench"  # only a page of ours can send it: other sites would have to ask first
EFFECT = re.compile(r"[a-z][a-z0-9_]*")
EARLIER = 12  # pieces of work that are listed
KNOWN = ("chair.", "tyre.C_", "resistance.", "wheel.")  # what a user may know of a chair
POLICY = ("default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
          "frame-ancestors 'self'")  # fmt: skip
TYPES = {".js": "text/javascript", ".css": "text/css", ".html": "text/html"}

Answer = Callable[[Request, Session], Awaitable[Response]]


class Workbench:
    """The application over a folder of sessions; `campaign` is what each new session starts with."""

    def __init__(self, root: Path, campaign: Path | None = None):
        self.root, self.campaign, self.jobs = root, campaign, Jobs()
        chair = Variant()
        self.bounds = known_parameters()
        self.parameters = [{"name": p.name, "unit": p.unit.name, "meaning": p.meaning, "default": p.default,
                            "uncertainty": p.uncertainty, "calibrated": p.name in CALIBRATED}
                           for p in chair.parameters() if p.name.startswith(KNOWN)]  # fmt: skip
        model = assemble()
        self.words = {
            "targets": [{"name": n, "unit": q.unit.name, "meaning": q.meaning} for n, q in targets(model).items()],
            "readable": [{"name": n, "unit": q.unit.name, "meaning": q.meaning} for n, q in vocabulary(model).items()],
        }

    def app(self) -> Starlette:
        at = "/s/{id}"
        routes = [
            Route("/", self.fresh),
            Route("/page/{name:path}", self.page_asset),
            Route(at, self.shown(self.page)),
            Route(f"{at}/state", self.shown(self.state)),
            Route(f"{at}/job", self.shown(self.job)),
            Route(f"{at}/files", self.shown(self.take_files), methods=["POST"]),
            Route(f"{at}/files/{{name:path}}", self.shown(self.drop_file), methods=["DELETE"]),
            Route(f"{at}/campaign", self.shown(self.set_campaign), methods=["PUT"]),
            Route(f"{at}/jobs", self.shown(self.start_job), methods=["POST"]),
            Route(f"{at}/jobs", self.shown(self.cancel_job), methods=["DELETE"]),
            Route(f"{at}/history", self.shown(self.go), methods=["POST"]),
            Route(f"{at}/expression", self.shown(self.check_expression), methods=["POST"]),
            Route(f"{at}/effects", self.shown(self.write_effect), methods=["POST"]),
            Route(f"{at}/report", self.shown(self.report)),
            Route(f"{at}/export/{{name}}", self.shown(self.export)),
        ]
        guard = Middleware(TrustedHostMiddleware, allowed_hosts=["127.0.0.1", "localhost", "testserver"])

        @asynccontextmanager
        async def life(app: Starlette) -> Any:
            yield
            self.jobs.cancel_all()

        return Starlette(routes=routes, middleware=[guard], lifespan=life)

    def shown(self, answer: Answer) -> Callable[[Request], Awaitable[Response]]:
        """An address of one session: errors a user can cause become one sentence."""

        async def respond(request: Request) -> Response:
            if request.method != "GET" and HEADER not in request.headers:
                return JSONResponse({"error": "only the workbench's own page may ask for this"}, 403)
            try:
                session = Session(self.root, request.path_params["id"])
                if not session.there:
                    return JSONResponse({"error": "no such session; open the workbench's first page"}, 404)
                session.touch()
                return await answer(request, session)
            except WheelchairError as error:
                return JSONResponse({"error": str(error)}, 400)

        return respond

    # -- pages ----------------------------------------------------------------------------------------------

    async def fresh(self, request: Request) -> Response:
        session = await run_in_threadpool(Session.begin, self.root, self.campaign)
        return RedirectResponse(f"/s/{session.id}")

    async def page(self, request: Request, session: Session) -> Response:
        return HTMLResponse(asset("workbench.html"), headers={"cache-control": "no-store", "content-security-policy": POLICY})

    async def page_asset(self, request: Request) -> Response:
        name = request.path_params["name"]
        if Path(name).suffix not in TYPES or ".." in name or not ASSETS.joinpath(name).is_file():
            return Response(status_code=404)
        return Response(asset(name), media_type=TYPES[Path(name).suffix], headers={"cache-control": "no-cache"})

    async def report(self, request: Request, session: Session) -> Response:
        file = session.folder / "report.html"
        return FileResponse(file, headers={"cache-control": "no-store"}) if file.exists() else Response(status_code=404)

    # -- what there is --------------------------------------------------------------------------------------

    async def state(self, request: Request, session: Session) -> Response:
        return JSONResponse(await run_in_threadpool(self.told, session))

    async def job(self, request: Request, session: Session) -> Response:
        return JSONResponse(self.jobs.told(session.id))

    def told(self, session: Session) -> dict[str, Any]:
        report = session.folder / "report.html"
        own = session.own_effects()
        return {
            "campaign": session.content(),
            "files": session.files(),
            "headers": session.headers(),
            "faults": session.faults(self.bounds),
            "channels": channel_list(),
            "noise": session.noise(),
            "parameters": self.parameters,
            "history": session.history(),
            "variant": session.variant_file.read_text(encoding="utf-8"),
            "effects": [{"id": e.id, "title": e.title, "own": e.id in own} for e in session.catalogue().values()],
            "words": self.words,
            "report": report.stat().st_mtime_ns if report.exists() else None,
            "job": self.jobs.told(session.id),
            "earlier": [{"id": s.id, "name": s.name} for s in Session.latest(self.root, EARLIER) if s.id != session.id],
        }

    # -- measurements ---------------------------------------------------------------------------------------

    async def take_files(self, request: Request, session: Session) -> Response:
        async with request.form(max_files=1000) as form:
            for field in form.getlist("files"):
                if isinstance(field, str):
                    raise UsageError("the field 'files' holds no file")
                session.put(field.filename or "", await field.read())
        await run_in_threadpool(session.draft)
        return await self.state(request, session)

    async def drop_file(self, request: Request, session: Session) -> Response:
        name = request.path_params["name"]
        if name not in session.files():
            raise unknown("file", name, session.files())
        (session.campaign / name).unlink()
        content = session.content()
        if content and isinstance(content.get("run"), list):
            session.write_content({**content, "run": [r for r in content["run"] if r.get("file") != name]})
        return await self.state(request, session)

    async def set_campaign(self, request: Request, session: Session) -> Response:
        session.edit(await _object(request))
        return await self.state(request, session)

    # -- work -----------------------------------------------------------------------------------------------

    async def start_job(self, request: Request, session: Session) -> Response:
        asked = await _object(request)
        makers = {"calibrate": self._calibrate, "diagnose": self._diagnose, "add": self._add}
        if asked.get("kind") not in makers:
            raise unknown("kind of work", str(asked.get("kind")), makers)
        job = await run_in_threadpool(makers[asked["kind"]], session, asked)
        self.jobs.start(session.id, job, session.folder)
        return await self.state(request, session)

    def _with(self, session: Session) -> list[str]:
        """The variant at hand and the effects of one's own, as options."""
        own = ["--effects", "effects"] if session.own_effects() else []
        return ["--variant", session.variant_file.relative_to(session.folder).as_posix(), *own]

    def _calibrate(self, session: Session, asked: dict[str, Any]) -> Job:
        names = [n for n in str(asked.get("names") or ",".join(CALIBRATED)).split(",") if n]

        def after(outputs: list[str]) -> None:
            values = printed_json(outputs[0])["values"]
            chair = session.variant()
            found = {**chair.values, **session.known(), **{n: values[n] for n in names}}
            session.keep(replace(chair, values=found), "calibrated")

        words = ["compare", "campaign", "--calibrate", ",".join(names), "--json", *self._with(session)]
        return Job("calibrate", [words], after)

    def _diagnose(self, session: Session, asked: dict[str, Any]) -> Job:
        chair = self._with(session)
        diagnose = ["diagnose", "campaign", "--json", "diagnosis.json", "--progress", *chair]
        report = ["report", "campaign", "--diagnosis", "diagnosis.json", "-o", "report.html", "--progress", *chair]
        return Job("diagnose", [diagnose, report], lambda outputs: None)

    def _add(self, session: Session, asked: dict[str, Any]) -> Job:
        effect = str(asked.get("effect"))
        if effect not in session.catalogue():
            raise unknown("effect", effect, session.catalogue())
        target = session.folder / "better.toml"

        def after(outputs: list[str]) -> None:
            session.keep(target, f"+ {effect}", printed_json(outputs[0])["ladder"])

        words = ["add", effect, "campaign", "-o", "better.toml", "--json", "--progress", *self._with(session)]
        return Job("add", [words], after)

    async def cancel_job(self, request: Request, session: Session) -> Response:
        self.jobs.cancel(session.id)
        return await self.state(request, session)

    async def go(self, request: Request, session: Session) -> Response:
        by = (await _object(request)).get("by")
        if by not in (-1, 1):
            raise UsageError(f"by = {by!r}; give -1 to undo, 1 to redo")
        session.go(by)
        return await self.state(request, session)

    # -- effects --------------------------------------------------------------------------------------------

    async def check_expression(self, request: Request, session: Session) -> Response:
        asked = await _object(request)
        try:
            unit = await run_in_threadpool(unit_of_q, str(asked.get("expression", "")), str(asked.get("to", "")))
        except UsageError as error:
            return JSONResponse({"unit": None, "why": str(error)})  # an answer, not a failure: somebody is still typing
        return JSONResponse({"unit": unit.name})

    async def write_effect(self, request: Request, session: Session) -> Response:
        asked = await _object(request)
        id, title = str(asked.get("id", "")), " ".join(str(asked.get("title", "")).split())
        if not EFFECT.fullmatch(id):
            raise UsageError(f"{id!r} is no name for an effect; use small letters, digits and underscores, like my_drag")
        if id in bundled():
            raise UsageError(f"there is an effect {id!r} already; choose another name")
        if not title or not title.isprintable() or set(title) & set("\"\\{}"):
            raise UsageError("say in a few plain words what the effect is")
        size, lower, upper = (_number(asked, key) for key in ("size", "lower", "upper"))
        if not lower <= 0 < size < upper:
            raise UsageError(f"the sizes must go lower ≤ 0 < of interest < upper, not {lower:g}, {size:g}, {upper:g}")
        expression, to = str(asked.get("expression", "")), str(asked.get("to", ""))
        unit = await run_in_threadpool(unit_of_q, expression, to)
        source = effect_file(id, title, to, unit, expression, size=size, lower=lower, upper=upper, source="own").encode()
        await run_in_threadpool(checked, ((f"{id}.py", source),))
        write(session.effects / f"{id}.py", source)
        return await self.state(request, session)

    # -- taking things away ---------------------------------------------------------------------------------

    async def export(self, request: Request, session: Session) -> Response:
        name = request.path_params["name"]
        if name == "variant.toml":
            return _download(session.variant_file, name)
        if name == "report.html" and (session.folder / name).exists():
            return _download(session.folder / name, name)
        if name == "parameters.ssv":
            content = text(from_variant(session.variant(), session.name))
            return Response(content, media_type="application/xml", headers=_attached(name))
        if name == "Wheelchair.fmu":
            return await run_in_threadpool(self._fmu, session, name)
        return JSONResponse({"error": f"there is no {name} yet"}, 404)

    def _fmu(self, session: Session, name: str) -> Response:
        with TemporaryDirectory() as folder:
            content = build(session.variant(), Path(folder) / name).read_bytes()
        return Response(content, media_type="application/octet-stream", headers=_attached(name))


def _download(file: Path, name: str) -> Response:
    return FileResponse(file, headers={**_attached(name), "cache-control": "no-store"})


def _attached(name: str) -> dict[str, str]:
    return {"content-disposition": f'attachment; filename="{name}"'}


async def _object(request: Request) -> dict[str, Any]:
    """The JSON object of a request. Raises UsageError for anything else."""
    try:
        content = await request.json()
    except ValueError:
        raise UsageError("the request holds no JSON") from None
    if not isinstance(content, dict):
        raise UsageError("the request holds no JSON object")
    return content


def _number(asked: dict[str, Any], key: str) -> float:
    value = asked.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise UsageError(f"{key} = {value!r} is not a number")
    return float(value)
