"""Where the `wheelchair` command begins: before anything is loaded that takes long enough to be interrupted."""

from __future__ import annotations

import os
import sys


def main(words: list[str] | None = None) -> None:
    """Run the command line, or these words of one, and exit with its code."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # cores are for runs, beside which NumPy's threads would only spin
    try:
        from .main import main as run  # half a second, in which Ctrl-C may come

        run(words)
    except KeyboardInterrupt:
        from ..errors import INTERRUPTED

        print(INTERRUPTED, file=sys.stderr)
        sys.stderr.flush()
        os._exit(130)  # what is half loaded has nothing to put away
