"""The workbench's addresses. JSON in and out; every refusal is {"error": one sentence}.

Reading changes nothing but when a session was last looked at; `guard` says who may ask.
"""

from __future__ import annotations

import re
from collections.abc import Awaitable, Callable, Iterator, Mapping, Sequence
from contextlib import asynccontextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, Response
from starlette.routing import Route

from ..campaign.importing import SIZES
from ..errors import UsageError, WheelchairError, unknown
from ..fmu.build import build
from ..fmu.parameter_set import from_variant, text
from ..inference.estimation.problem import AT_BOUND
from ..inference.models.factory import CALIBRATED
from ..inference.subject import known_parameters
from ..model.arithmetic import shown as cut
from ..model.choice import KINDS, Choice, names
from ..model.dimensions import orders, targets, unit_of_q, vocabulary
from ..model.effects import bundled
from ..model.expression import effect_file
from ..model.generic import library
from ..model.stage import Effect
from ..model.variant import Variant
from ..model.wheelchair import assemble
from ..quantities import Quantity
from ..report import preview
from ..report.page import ASSETS, asset
from ..report.words import law_told, value_text
from . import faults
from .bodies import Json, json_object, json_texts, number
from .guard import Guard
from .intake import MOST_BYTES, NoRecording, safe_path
from .jobs import Job, Jobs, printed_json
from .locks import Locks
from .outcome import outcome
from .session import Session, channel_list

EFFECT = re.compile(r"[a-z][a-z0-9_]{0,59}")
LONGEST_TITLE = 200
FORBIDDEN = '"\\{}'  # in a title, which goes into a file
EARLIER = 12  # pieces of work that are listed
NAMED = 4  # files that are named of those left out
KNOWN = ("chair.", "tyre.C_", "tyre.mu", "resistance.", "wheel.")  # what a user may know of a chair
POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "frame-ancestors 'self'"
)
TYPES = {".js": "text/javascript", ".css": "text/css", ".html": "text/html"}

Answer = Callable[[Request, Session], Awaitable[Response]]


class Workbench:
    """The application over a folder of sessions, for whoever knows `token`; `campaign` is what each new session starts with."""

    def __init__(self, root: Path, token: str, campaign: Path | None = None, most_upload: int = MOST_BYTES):
        self.root, self.campaign, self.jobs, self.locks = root, campaign, Jobs(), Locks()
        self.guard = Middleware(Guard, token=token, most_upload=most_upload)
        self.most_upload = most_upload
        assets = Path(str(ASSETS))
        self.assets = {p.relative_to(assets).as_posix() for p in assets.rglob("*") if p.suffix in TYPES}
        chair = Variant()
        self.bounds = known_parameters()
        self.parameters = [
            {
                "name": p.name,
                "unit": p.unit.name,
                "meaning": p.meaning,
                "default": p.default,
                "uncertainty": p.uncertainty,
                "calibrated": p.name in CALIBRATED,
            }
            for p in chair.parameters()
            if p.name.startswith(KNOWN)
        ]
        model = assemble()
        known = orders(model)
        self.words = {
            "targets": [_word(n, q, known) for n, q in targets(model).items()],
            "terms": {e.id: e.title for e in library().values()},
            "readable": [_word(n, q, known) for n, q in vocabulary(model).items()],
        }

    def app(self) -> Starlette:
        at = "/s/{id}"
        routes = [
            Route("/", self.start),
            Route("/sessions", self.begin, methods=["POST"]),
            Route("/page/{name:path}", self.page_asset),
            Route(at, self.shown(self.page)),
            Route(f"{at}/state", self.shown(self.state)),
            Route(f"{at}/job", self.shown(self.job)),
            Route(f"{at}/sample", self.shown(self.take_sample), methods=["POST"]),
            Route(f"{at}/files", self.shown(self.take_files), methods=["POST"]),
            Route(f"{at}/files/{{name:path}}", self.shown(self.drop_file), methods=["DELETE"]),
            Route(f"{at}/campaign", self.shown(self.set_campaign), methods=["PUT"]),
            Route(f"{at}/jobs", self.shown(self.start_job), methods=["POST"]),
            Route(f"{at}/jobs", self.shown(self.cancel_job), methods=["DELETE"]),
            Route(f"{at}/history", self.shown(self.go), methods=["POST"]),
            Route(f"{at}/laws", self.shown(self.choose_law), methods=["POST"]),
            Route(f"{at}/expression", self.shown(self.check_expression), methods=["POST"]),
            Route(f"{at}/effects", self.shown(self.write_effect), methods=["POST"]),
            Route(f"{at}/report", self.shown(self.report)),
            Route(f"{at}/preview", self.shown(self.preview)),
            Route(f"{at}/export/{{name}}", self.shown(self.export)),
        ]

        @asynccontextmanager
        async def life(app: Starlette) -> Any:
            yield
            self.jobs.cancel_all()

        return Starlette(routes=routes, middleware=[self.guard], lifespan=life, exception_handlers={HTTPException: _refused})

    def shown(self, answer: Answer) -> Callable[[Request], Awaitable[Response]]:
        """An address of one session: errors a user can cause become one sentence."""

        async def respond(request: Request) -> Response:
            try:
                session = Session(self.root, request.path_params["id"])
                if not session.there:
                    return Json({"error": "no such session; open the workbench's first page"}, 404)
                session.touch()
                return await answer(request, session)
            except WheelchairError as error:
                return Json({"error": str(error)}, 400)
            except OSError as error:
                what = error.strerror or type(error).__name__
                return Json(
                    {"error": f"the workbench's folder cannot be read or written ({what}); see that it is there and has room"},
                    507,
                )

        return respond

    async def change(self, session: Session, act: Callable[[], object] = lambda: None) -> Response:
        """Do something with a session that nobody else changes meanwhile, and tell how it is then, and what the act says to
        that, if it says anything."""

        def alone() -> dict[str, Any]:
            with self.locks.held(session):
                said = act()
                return {**self.told(session), "remark": said if isinstance(said, str) else ""}

        return Json(await run_in_threadpool(alone))

    # -- pages ----------------------------------------------------------------------------------------------

    async def start(self, request: Request) -> Response:
        """The page without a session; its script begins one, because opening an address must change nothing."""
        return self._page()

    async def begin(self, request: Request) -> Response:
        try:
            session = await run_in_threadpool(Session.begin, self.root, self.campaign)
        except WheelchairError as error:
            return Json({"error": str(error)}, 400)
        return Json({"id": session.id})

    async def page(self, request: Request, session: Session) -> Response:
        return self._page()

    def _page(self) -> Response:
        return HTMLResponse(asset("workbench.html"), headers={"cache-control": "no-store", "content-security-policy": POLICY})

    async def page_asset(self, request: Request) -> Response:
        name = request.path_params["name"]
        if name not in self.assets:
            raise HTTPException(404)
        return Response(asset(name), media_type=TYPES[Path(name).suffix], headers={"cache-control": "no-cache"})

    async def report(self, request: Request, session: Session) -> Response:
        file = session.folder / "report.html"
        if not file.exists():
            raise HTTPException(404)
        return FileResponse(file, headers={"cache-control": "no-store"})

    async def preview(self, request: Request, session: Session) -> Response:
        """Every signal of every run on one page, with all faults."""

        def drawn() -> str:
            seen = session.seen(self.bounds)
            pictures = preview.figures(preview.seen(seen.runs))
            told = map(faults.told, seen.faults)
            return preview.page(session.name, pictures, [(f["severity"], f["where"], f["what"]) for f in told])

        policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'"
        return HTMLResponse(
            await run_in_threadpool(drawn), headers={"cache-control": "no-store", "content-security-policy": policy}
        )

    # -- what there is --------------------------------------------------------------------------------------

    async def state(self, request: Request, session: Session) -> Response:
        return await self.change(session)

    async def job(self, request: Request, session: Session) -> Response:
        return Json(self.jobs.told(session.id))

    def told(self, session: Session) -> dict[str, Any]:
        report = session.folder / "report.html"
        own, catalogue, columns = session.own_effects(), session.catalogue(), session.columns()
        found, noise = session.judged(known_parameters({**bundled(), **own}) if own else self.bounds)
        return {
            "campaign": session.content(),
            "files": session.files(),
            "headers": {header: column["files"] for header, column in columns.items()},
            "times": [header for header, column in columns.items() if column["time"]],
            "signals": {header: column["signals"] for header, column in columns.items()},
            "faults": found,
            "channels": channel_list(),
            "noise": noise,
            "parameters": self.parameters,
            "laws": session.laws(),
            "every_law": _every_law(),
            "history": session.history(),
            "variant": session.variant_text(),
            "effects": [{"id": e.id, "title": e.title, "own": e.id in own} for e in catalogue.values()],
            "outcome": outcome(session, catalogue),
            "words": self.words,
            "most_upload": self.most_upload,
            "report": report.stat().st_mtime_ns if report.exists() else None,
            "job": self.jobs.told(session.id),
            "earlier": [
                {"id": s.id, "name": s.label, "at": s.looked_at}
                for s in Session.latest(self.root, EARLIER)
                if s.id != session.id
            ],
        }

    # -- measurements ---------------------------------------------------------------------------------------

    async def take_files(self, request: Request, session: Session) -> Response:
        async with request.form(max_files=1000) as form:
            files = [field for field in form.getlist("files") if isinstance(field, UploadFile)]
            if not files:
                raise UsageError("the field 'files' holds no file")
            name, paths = form.get("name"), _paths(form.get("paths"), files)
            named = list(zip(paths, files, strict=True))
            return await self.change(session, lambda: self._take_in(session, named, name if isinstance(name, str) else ""))

    def _take_in(self, session: Session, files: list[tuple[str, UploadFile]], name: str) -> str:
        """Takes in the recordings among these files, by their paths, and says which are none: a lab's folder holds notes and
        pictures, too."""
        taken, other = list[tuple[str, UploadFile]](), dict[str, NoRecording]()
        for path, file in files:
            try:
                safe_path(path)
                taken.append((path, file))
            except NoRecording as error:
                other[path] = error
        if not taken:
            raise UsageError("; ".join(str(error) for error in list(other.values())[:NAMED]))
        for path, file in taken:
            session.put(path, file.file, self.most_upload)
        session.draft(name)
        names = list(other)
        more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
        return f"Left out, as no recording: {', '.join(names[:NAMED])}{more}." if names else ""

    async def take_sample(self, request: Request, session: Session) -> Response:
        return await self.change(session, session.try_sample)

    async def drop_file(self, request: Request, session: Session) -> Response:
        return await self.change(session, partial(session.drop, request.path_params["name"]))

    async def set_campaign(self, request: Request, session: Session) -> Response:
        return await self.change(
            session, partial(session.edit, await json_object(request), request.query_params.get("said", ""))
        )

    # -- work -----------------------------------------------------------------------------------------------

    async def start_job(self, request: Request, session: Session) -> Response:
        asked = await json_object(request)
        makers = {
            "import": self._import,
            "calibrate": self._calibrate,
            "diagnose": self._diagnose,
            "try": self._try,
            "add": self._add,
        }
        kind = str(asked.get("kind"))
        if kind not in makers:
            raise unknown("kind of work", kind[:40], makers)
        return await self.change(session, lambda: self.jobs.start(session.id, makers[kind](session, asked), session.folder))

    def _with(self, session: Session) -> list[str]:
        """The variant at hand and the effects of one's own, as options."""
        session.trust_variant()
        own = ["--effects", "effects"] if session.own_effects() else []
        return ["--variant", session.variant_file.relative_to(session.folder).as_posix(), *own]

    def _calibrate(self, session: Session, asked: dict[str, Any]) -> Job:
        names = [n for n in str(asked.get("names") or ",".join(CALIBRATED)).split(",") if n]
        if strange := next((n for n in names if n not in self.bounds), None):
            raise unknown("parameter", strange[:40], self.bounds)

        def after(outputs: list[str]) -> None:
            told = printed_json(outputs[0])
            chair, values = session.variant(), told["values"]
            found = {**chair.values, **session.known(), **{n: values[n] for n in names}}
            with self.locks.held(session):
                ladder = [{"step": "calibrated", "fit": told["rms"]["fit"], "heldout": told["rms"]["holdout"]}]
                session.keep(replace(chair, values=found), "calibrated", ladder)
            job.result = {"ladder": ladder}

        words = ["compare", "campaign", "--calibrate", ",".join(names), "--json", "--progress", *self._with(session)]
        job = Job("calibrate", [words], after)
        return job

    def _import(self, session: Session, asked: dict[str, Any]) -> Job:
        """Find out which file is which run and device, and what its columns are; the campaign.toml that was there can be had
        back."""
        sizes = [(f"--{name.replace('_', '-')}", number(asked, name)) for name in SIZES if asked.get(name) is not None]

        def after(outputs: list[str]) -> None:
            with self.locks.held(session):
                session.read_anew(name, printed_json(outputs[0])["unsure"])

        name = session.name
        session.note_campaign()
        words = ["import", "campaign", "-o", "campaign", "--yes", "--force", "--json", "--progress"]
        return Job("import", [[*words, *(word for name, size in sizes for word in (name, f"{size:g}"))]], after)

    def _diagnose(self, session: Session, asked: dict[str, Any]) -> Job:
        chair = self._with(session)
        of = session.at_hand()
        diagnose = ["diagnose", "campaign", "--json", "diagnosis.json", "--progress", *chair]
        report = ["report", "campaign", "--diagnosis", "diagnosis.json", "-o", "report.html", "--progress", *chair]
        return Job("diagnose", [diagnose, report], lambda outputs: session.note_diagnosed(of))

    def _effect(self, session: Session, asked: dict[str, Any]) -> str:
        effect = str(asked.get("effect"))
        if effect not in session.catalogue():
            raise unknown("effect", effect[:40], session.catalogue())
        return effect

    def _try(self, session: Session, asked: dict[str, Any]) -> Job:
        """What an effect would do; nothing is kept."""
        effect = self._effect(session, asked)

        def after(outputs: list[str]) -> None:
            job.result = _added(effect, outputs[0], session)

        words = ["add", effect, "campaign", "-o", "tried.toml", "--json", "--progress", *self._with(session)]
        job = Job("try", [words], after)
        return job

    def _add(self, session: Session, asked: dict[str, Any]) -> Job:
        effect = self._effect(session, asked)
        target = session.folder / "better.toml"

        def after(outputs: list[str]) -> None:
            found = _added(effect, outputs[0], session)
            with self.locks.held(session):
                session.keep(target, f"+ {effect}", found["ladder"])
            job.result = found

        words = ["add", effect, "campaign", "-o", "better.toml", "--json", "--progress", *self._with(session)]
        job = Job("add", [words], after)
        return job

    async def cancel_job(self, request: Request, session: Session) -> Response:
        return await self.change(session, partial(self.jobs.cancel, session.id))

    async def go(self, request: Request, session: Session) -> Response:
        by = (await json_object(request)).get("by")
        if type(by) is not int or by not in (-1, 1):
            raise UsageError(f"by = {cut(str(by))}; give -1 to undo, 1 to redo")
        return await self.change(session, partial(session.go, by))

    async def choose_law(self, request: Request, session: Session) -> Response:
        asked = await json_object(request)

        def chosen() -> None:
            self.jobs.refuse_busy(session.id)
            session.choose(str(asked.get("of", "")), str(asked.get("name", "")))

        return await self.change(session, chosen)

    # -- effects --------------------------------------------------------------------------------------------

    async def check_expression(self, request: Request, session: Session) -> Response:
        asked = await json_object(request)
        try:
            unit = await run_in_threadpool(unit_of_q, str(asked.get("expression", "")), str(asked.get("to", "")))
        except UsageError as error:
            return Json({"unit": None, "why": str(error)})  # an answer, not a failure: somebody is still typing
        return Json({"unit": unit.name})

    async def write_effect(self, request: Request, session: Session) -> Response:
        asked = await json_object(request)
        id, title = str(asked.get("id", "")), " ".join(str(asked.get("title", "")).split())
        if not EFFECT.fullmatch(id):
            raise UsageError(
                f"{cut(id)} is no name for an effect; use small letters, digits and underscores, a letter first, like my_drag"
            )
        if id in bundled():
            raise UsageError(f"there is an effect {id!r} already; choose another name")
        if any(step["label"] == f"+ {id}" for step in session.history()["steps"]):
            raise UsageError(
                f"a model of this work has your effect {id!r} already, which stays what it is; choose another name"
            )
        if not title.isprintable() or set(title) & set(FORBIDDEN) or not 0 < len(title) <= LONGEST_TITLE:
            banned = " ".join(FORBIDDEN)
            raise UsageError(
                f"say in a few plain words what the effect is: at most {LONGEST_TITLE} letters, none of them {banned}"
            )
        size, lower, upper = (number(asked, key) for key in ("size", "lower", "upper"))
        if not lower <= 0 < size < upper:
            raise UsageError(
                "“least q” must be at most 0, “q matters from” above 0, and “greatest q” above that; "
                f"they are {lower:g}, {size:g} and {upper:g}"
            )
        expression, to = str(asked.get("expression", "")), str(asked.get("to", ""))
        unit = await run_in_threadpool(unit_of_q, expression, to)
        source = effect_file(id, title, to, unit, expression, size=size, lower=lower, upper=upper, source="own")
        return await self.change(session, partial(session.write_effect, id, source))

    # -- taking things away ---------------------------------------------------------------------------------

    async def export(self, request: Request, session: Session) -> Response:
        name = request.path_params["name"]
        if name == "variant.toml":
            return _download(session.variant_file, name)
        if name == "report.html" and (session.folder / name).exists():
            return _download(session.folder / name, name)
        if name == "parameters.ssv":
            content = await run_in_threadpool(lambda: text(from_variant(session.variant(), session.name)))
            return Response(content, media_type="application/xml", headers=_attached(name))
        if name == "Wheelchair.fmu":
            return await run_in_threadpool(self._fmu, session, name)
        return Json({"error": f"there is no {cut(name)} yet"}, 404)

    def _fmu(self, session: Session, name: str) -> Response:
        with TemporaryDirectory() as folder:
            content = build(session.variant(), Path(folder) / name).read_bytes()
        return Response(content, media_type="application/octet-stream", headers=_attached(name))


def _paths(told: object, files: Sequence[UploadFile]) -> list[str]:
    """The paths of files as the field `paths` has them, a JSON list, or as they are called in the form, which has no quotes."""
    paths = json_texts(told, "paths") if isinstance(told, str) else [file.filename or "" for file in files]
    if len(paths) != len(files):
        raise UsageError(f"the field 'paths' names {len(paths)} files, and {len(files)} came with it")
    return paths


def _word(name: str, quantity: Quantity, known: Mapping[str, int]) -> dict[str, Any]:
    """What an expression may name or act on, and when it becomes known."""
    return {"name": name, "unit": quantity.unit.name, "meaning": quantity.meaning, "order": known[name]}


def _every_law() -> list[dict[str, str]]:
    """The laws to choose from, by what each is for, with what it says."""
    return [law_told(kind, name) for kind, some in names(Choice()).items() if kind in KINDS for name in some]


def _added(effect: str, printed: str, session: Session) -> dict[str, Any]:
    """What `wheelchair add` found, as far as the page tells it."""
    told = printed_json(printed)
    bounds = list(_at_bounds(session.catalogue()[effect], told["values"]))
    return {"effect": effect, "ladder": told["ladder"], "estimates": told["estimates"], "bounds": bounds}


def _at_bounds(effect: Effect, values: Mapping[str, float]) -> Iterator[str]:
    """A sentence for each size that stands at a bound, where its error says nothing of how sure it is."""
    for p in effect.owned:
        if p.name not in values or not p.smallest_interesting:
            continue
        value, near, short = values[p.name], AT_BOUND * p.smallest_interesting, p.name.rpartition(".")[2]
        if value <= p.lower + near:
            least = value_text(p.lower, None, p.unit)
            yield f"{short} stands at the least that is allowed, {least}: the effect is not there, or acts the other way."
        elif value >= p.upper - near:
            yield f"{short} stands at the greatest that is allowed, {value_text(p.upper, None, p.unit)}: it may be larger."


def _download(file: Path, name: str) -> Response:
    return FileResponse(file, headers={**_attached(name), "cache-control": "no-store"})


def _attached(name: str) -> dict[str, str]:
    return {"content-disposition": f'attachment; filename="{name}"'}


async def _refused(request: Request, error: Exception) -> Response:
    """What the framework refuses, as a sentence."""
    status = error.status_code if isinstance(error, HTTPException) else 500
    told = {
        404: "there is nothing at this address; open the workbench's first page",
        405: f"{request.method} is not what this address answers",
    }
    return Json({"error": told.get(status) or str(getattr(error, "detail", error))}, status)
