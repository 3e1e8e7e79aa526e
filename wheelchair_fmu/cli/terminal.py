"""What may reach a terminal: text, never a command to it.

Names of files, runs and columns are other people's. A control character in one could move the cursor, rename the window or
hide a line; a :word: or a [word] in one would become a picture or a colour.
"""

from __future__ import annotations

import re
import sys
from typing import Any

from rich.console import Console
from rich.text import Text

PIPED = 132  # columns where no terminal says how many there are
# C0 without tab and newline, DEL and C1; and what turns the direction of writing
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")


def printable(text: object) -> str:
    """The text with control characters as they are written in Python: \\x1b for escape."""
    return _CONTROL.sub(lambda found: ascii(found[0])[1:-1], str(text))


def printable_json(text: str) -> str:
    """The same of JSON, as JSON has it."""
    return _CONTROL.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


class Terminal(Console):
    """A console that prints strings as they are, but for control characters."""

    def render_str(self, text: str, **how: Any) -> Text:
        return super().render_str(printable(text), **how)


def console(*, stderr: bool = False) -> Console:
    """Made anew each time, so that it writes to where stdout or stderr point now."""
    file = sys.stderr if stderr else sys.stdout
    # Where FORCE_COLOR is set, as in notebooks, rich would draw its progress into a pipe again and again.
    width, force = (None, None) if file.isatty() else (PIPED, False)
    return Terminal(
        stderr=stderr, highlight=False, soft_wrap=True, markup=False, emoji=False, width=width, force_terminal=force
    )


def announce(text: object) -> None:
    """A line to stdout for other programs to read, such as the name of a file that was written."""
    print(printable(text))
