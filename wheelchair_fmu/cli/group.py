"""How every command ends: 0 done, 1 the data or model fails what was asked, 2 bad usage, 130 interrupted."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Annotated, Any

import typer
from rich.text import Text
from typer.core import TyperGroup

from ..errors import INTERRUPTED as SAID
from ..errors import Note, WheelchairError
from ..writing import FULL
from .terminal import console, printable

Progress = Annotated[bool, typer.Option("--progress", help="Say each step on a line of its own on stderr.")]
INTERRUPTED = 130  # 128 + SIGINT, as shells have it
TRACEBACK = "WHEELCHAIR_TRACEBACK"  # set to anything, what nobody expected is shown with where it happened

__all__ = ["INTERRUPTED", "Group", "Progress", "console", "working"]


@contextmanager
def working(words: str, *, lines: bool = False) -> Iterator[Callable[[str], None]]:
    """What is being done, on stderr: a line that changes, or with `lines` one line for each step, for another program."""
    if lines:
        say = partial(print, file=sys.stderr, flush=True)
        say(words)
        yield lambda text: say(printable(text))
    else:
        with console(stderr=True).status(Text(words)) as status:
            yield lambda text: status.update(Text(printable(text)))


class Group(TyperGroup):
    """Turns whatever ends a command into one message and an exit code."""

    def invoke(self, ctx: Any) -> Any:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("default", Note)
                warnings.showwarning = partial(_noted, warnings.showwarning)
                return super().invoke(ctx)
        except (typer.Exit, typer.Abort):
            raise
        except BrokenPipeError:  # who reads our output has seen enough
            _drop_output()
            raise typer.Exit(1) from None
        except SystemExit as error:
            if isinstance(error.__context__, BrokenPipeError):  # as rich says it
                _drop_output()
                raise typer.Exit(1) from None
            message = f"code that was run ended the command (exit code {error.code}); look for exit() in your effect files"
            code = 1
        except (Exception, KeyboardInterrupt) as error:
            if hasattr(error, "show"):  # of the parser of options, which says it itself
                raise
            if os.environ.get(TRACEBACK):
                raise
            message, code = ending(error)
        console(stderr=True).print(message)
        raise typer.Exit(code) from None


def _noted(usual: Callable[..., None], message: Warning | str, category: type[Warning], *place: Any) -> None:
    """A note of ours in a line, other warnings as Python shows them."""
    if issubclass(category, Note):
        console(stderr=True).print(f"note: {message}")
    else:
        usual(message, category, *place)


def ending(error: BaseException) -> tuple[str, int]:
    """One sentence and the exit code for what ended a command."""
    match error:
        case WheelchairError():
            return str(error), error.exit_code
        case KeyboardInterrupt():
            return SAID, INTERRUPTED
        case MemoryError():
            return "there is not enough memory for this; give it less at a time, or more memory", 1
        case RecursionError():
            return "something in a file is nested too deeply to be read; make it flatter", 1
        case OSError():
            return _file_message(error), 1
    what = " ".join(f"{type(error).__name__}: {error}".split())
    return (
        f"an error that nobody expected ({what}); please report it with the command, its files and what it says with "
        f"{TRACEBACK}=1 in the environment"
    ), 1


def _file_message(error: OSError) -> str:
    reason = (error.strerror or str(error)).lower()
    place = "" if error.filename is None else f"{error.filename}: "
    if error.errno in FULL:
        return f"{place}{reason}; make room, or write to another disk"
    if error.filename is None:
        return f"{reason}; check the disk and the rights"
    return f"{place}{reason}; give another place, or the rights to use this one"


def _drop_output() -> None:
    """Nothing more goes to stdout, not even what is still to be flushed when the interpreter ends."""
    sink = os.open(os.devnull, os.O_WRONLY)
    os.dup2(sink, sys.stdout.fileno())
    os.close(sink)
