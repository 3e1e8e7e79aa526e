"""`wheelchair workbench`: the loop in a browser, served on this machine only."""

from __future__ import annotations

import os
import secrets
import socket
import sys
import webbrowser
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import platformdirs
import typer

from ..errors import Failure, UsageError

HOST = "127.0.0.1"


def register(app: typer.Typer) -> None:
    app.command()(workbench)


def workbench(
    campaign: Annotated[Path | None, typer.Argument(metavar="CAMPAIGN", help="A folder to start with; it is copied.")] = None,
    port: Annotated[int, typer.Option(help="Where to listen; 0 takes a free one.")] = 8765,
    folder: Annotated[Path | None, typer.Option(metavar="DIR", help="Where work is kept.")] = None,
    keep: Annotated[float, typer.Option(metavar="DAYS", min=1.0, help="Remove work that nobody looked at for so long.")] = 90.0,
    upload_limit: Annotated[
        float, typer.Option("--upload-limit", metavar="MB", min=1.0, help="Refuse more recordings than that at once.")
    ] = 512.0,
    show: Annotated[bool, typer.Option("--open/--no-open", help="Open a browser.")] = True,
) -> None:
    """Drop recordings in, map their columns, diagnose, add effects and export, in a browser."""
    try:
        import uvicorn

        from ..workbench.intake import close_to_others
        from ..workbench.server import Workbench
        from ..workbench.session import Session, prune
    except ImportError as error:
        raise Failure(
            f"the workbench needs {error.name}, which is not installed; pip install 'wheelchair-fmu[workbench]'"
        ) from None
    if campaign and not campaign.is_dir():
        raise UsageError(f"{campaign}: no such folder; give one with recordings")
    root = folder or Path(platformdirs.user_data_dir("wheelchair-fmu")) / "workbench"
    os.umask(0o077)  # recordings are of people, so whatever this process and its children write is its owner's alone
    root.mkdir(parents=True, exist_ok=True)
    listening = _listen(port)
    for name in prune(root, keep):
        print(f"removed {name}, which nobody has looked at for {keep:g} days", file=sys.stderr)
    close_to_others(root, [session.folder for session in Session.every(root)])
    token = secrets.token_urlsafe(32)
    address = f"http://{HOST}:{listening.getsockname()[1]}/?token={token}"
    print(f"{address} (Ctrl-C ends it; work is kept in {root})", flush=True)
    if show:
        webbrowser.open(address)
    app = Workbench(root.resolve(), token, campaign.resolve() if campaign else None, int(upload_limit * 1e6)).app()
    server = uvicorn.Server(uvicorn.Config(app, log_level="warning", lifespan="on", timeout_graceful_shutdown=2))
    with suppress(KeyboardInterrupt):  # which is how it ends
        server.run(sockets=[listening])


def _listen(port: int) -> socket.socket:
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((HOST, port))
    except (OSError, OverflowError) as error:
        raise UsageError(
            f"port {port} cannot be used ({getattr(error, 'strerror', None) or error}); give another by --port, or 0"
        ) from None
    listening.listen()  # so that whoever opens the address at once waits, and is not refused
    return listening
