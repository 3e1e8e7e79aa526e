"""Where the `wheelchair` command begins: before anything is loaded that takes long enough to be interrupted."""

from __future__ import annotations

import os
import sys


def main() -> None:
    """Run the command line and exit with its code."""
    try:
        from .main import main as run  # half a second, in which Ctrl-C may come

        run()
    except KeyboardInterrupt:
        from ..errors import INTERRUPTED

        print(INTERRUPTED, file=sys.stderr)
        sys.stderr.flush()
        os._exit(130)  # what is half loaded has nothing to put away
