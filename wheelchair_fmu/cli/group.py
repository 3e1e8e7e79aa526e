"""How every command ends: 0 done, 1 the data or model fails what was asked, 2 bad usage, 130 interrupted."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Annotated, Any

import typer
from rich.console import Console
from typer.core import TyperGroup

from ..errors import INTERRUPTED as SAID
from ..errors import WheelchairError

Progress = Annotated[bool, typer.Option("--progress", help="Say each step on a line of its own on stderr.")]
PIPED = 132  # columns where no terminal says how many there are
INTERRUPTED = 130  # 128 + SIGINT, as shells have it


def console(*, stderr: bool = False) -> Console:
    """Made anew each time, so that it writes to where stdout or stderr point now."""
    file = sys.stderr if stderr else sys.stdout
    width = None if file.isatty() else PIPED
    return Console(stderr=stderr, highlight=False, soft_wrap=True, markup=False, width=width)


@contextmanager
def working(words: str, *, lines: bool = False) -> Iterator[Callable[[str], None]]:
    """What is being done, on stderr: a line that changes, or with `lines` one line for each step, for another program."""
    if lines:
        say = partial(print, file=sys.stderr, flush=True)
        say(words)
        yield say
    else:
        with console(stderr=True).status(words) as status:
            yield status.update


class Group(TyperGroup):
    """Turns errors that a user can cause and cure into one message and an exit code."""

    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
        except WheelchairError as error:
            console(stderr=True).print(str(error))
            raise typer.Exit(error.exit_code) from None
        except OSError as error:  # a file that cannot be read or written; everything else is a bug
            console(stderr=True).print(_file_message(error))
            raise typer.Exit(1) from None
        except KeyboardInterrupt:
            console(stderr=True).print(SAID)
            raise typer.Exit(INTERRUPTED) from None


def _file_message(error: OSError) -> str:
    reason = (error.strerror or str(error)).lower()
    if error.filename is None:
        return f"{reason}; check the disk and the rights"
    return f"{error.filename}: {reason}; give another place, or the rights to use this one"
