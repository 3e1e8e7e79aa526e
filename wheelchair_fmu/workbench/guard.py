"""Who may ask the workbench for anything, and how much may be sent.

It listens on this machine only, but so do other people's programs, and every website that is open in a browser here. So each
request has to show the token that is in the printed address: as a cookie, which the address without it is exchanged for, or as
a header. What changes something must come from a page of the workbench itself.
"""

from __future__ import annotations

import hmac
from typing import Any

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

HEADER = "x-workbench"  # only a page of ours can send it: other sites would have to ask first
TOKEN_HEADER = "x-workbench-token"
HOSTS = ("127.0.0.1", "localhost")
OUR_OWN = ("same-origin", "none")  # what browsers say of requests by our page, and of addresses that somebody typed
READING = ("GET", "HEAD")
MOST_JSON = 1_000_000  # bytes of a request that is no upload
HEADERS = {
    b"referrer-policy": b"same-origin",
    b"x-content-type-options": b"nosniff",
    b"x-frame-options": b"SAMEORIGIN",
    b"cross-origin-resource-policy": b"same-origin",
}


class Guard:
    """Around the application: passes on what may be asked, with its body counted while it is read."""

    def __init__(self, app: ASGIApp, token: str, most_upload: int):
        self.app, self.token, self.most_upload = app, token, most_upload

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            return await self.app(scope, receive, send)
        if scope["type"] != "http":
            return await send({"type": "websocket.close", "code": 1008})
        request = Request(scope)
        answer = self._entry(request) or self._refusal(request)
        await (answer or self._counting)(scope, receive, _with_headers(send))

    def _entry(self, request: Request) -> Response | None:
        """The printed address gives the cookie, and goes on to the same address without the token."""
        given = request.query_params.get("token", "")
        if request.url.path != "/" or request.method != "GET" or not _is_ours(request) or not self._is_token(given):
            return None
        answer = RedirectResponse("/", 303)
        answer.set_cookie(_cookie(request), self.token, httponly=True, samesite="strict")
        return answer

    def _is_token(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), self.token.encode())

    def _refusal(self, request: Request) -> Response | None:
        if not _is_ours(request):
            return _said(request, 400, "the workbench answers at 127.0.0.1 and localhost only")
        given = request.headers.get(TOKEN_HEADER) or request.cookies.get(_cookie(request), "")
        if not self._is_token(given):
            return _said(request, 403, "open the workbench by the address that it printed when it started, with its token")
        if not _from_our_page(request):
            return _said(request, 403, "only the workbench's own page may ask for this")
        length = request.headers.get("content-length", "0")
        if length.isdecimal() and len(length) < 20 and int(length) > self._most(request):
            return _said(request, 413, self._too_much(request))
        return None

    def _most(self, request: Request) -> int:
        return self.most_upload if request.method == "POST" and request.url.path.endswith("/files") else MOST_JSON

    def _too_much(self, request: Request) -> str:
        if self._most(request) == MOST_JSON:
            return f"a request of more than {MOST_JSON / 1e6:g} MB is too much for the workbench"
        return (
            f"recordings of more than {self.most_upload / 1e6:g} MB at once are too much for the workbench; add fewer at a "
            "time, raise --upload-limit, or use `wheelchair diagnose`"
        )

    async def _counting(self, scope: Scope, receive: Receive, send: Send) -> None:
        request, read = Request(scope), 0

        async def counted() -> Message:
            nonlocal read
            message = await receive()
            read += len(message.get("body", b""))
            if read > self._most(request):
                raise HTTPException(413, self._too_much(request))
            return message

        await self.app(scope, counted, send)


def _is_ours(request: Request) -> bool:
    name, _, port = request.headers.get("host", "").partition(":")
    return name in HOSTS and (not port or (port.isascii() and port.isdecimal()))


def _cookie(request: Request) -> str:
    """Cookies do not tell ports apart, but two workbenches on one machine must."""
    return f"workbench-{request.headers.get('host', '').partition(':')[2] or 80}"


def _from_our_page(request: Request) -> bool:
    site, origin = request.headers.get("sec-fetch-site"), request.headers.get("origin")
    if request.method in READING:
        followed = request.headers.get("sec-fetch-mode") == "navigate" and request.headers.get("sec-fetch-dest") == "document"
        return site in (None, *OUR_OWN) or followed
    own = f"{request.url.scheme}://{request.headers['host']}"
    return HEADER in request.headers and origin in (None, own) and site in (None, *OUR_OWN)


def _said(request: Request, status: int, sentence: str) -> Response:
    if "text/html" in request.headers.get("accept", ""):
        return PlainTextResponse(sentence, status)
    return JSONResponse({"error": sentence}, status)


def _with_headers(send: Send) -> Send:
    async def sent(message: Message) -> None:
        if message["type"] == "http.response.start":
            there: list[Any] = list(message.get("headers", ()))
            names = {name.lower() for name, _ in there}
            message = {**message, "headers": [*there, *((n, v) for n, v in HEADERS.items() if n not in names)]}
        await send(message)

    return sent
