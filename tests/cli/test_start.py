"""What the `wheelchair` command sets before anything is loaded."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

ASKS = """
from wheelchair_fmu.cli.start import main
try:
    main(["check", "no-such-campaign"])
except SystemExit:
    import numpy, threadpoolctl
    print("openblas", *{pool["num_threads"] for pool in threadpoolctl.threadpool_info() if pool["internal_api"] == "openblas"})
"""


def threads(**given: str) -> str:
    """How many NumPy would use in a command."""
    plain = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    return subprocess.run([sys.executable, "-c", ASKS], env=plain | given, stdout=subprocess.PIPE, text=True).stdout.split()[-1]


def test_cores_are_for_runs_unless_somebody_says_otherwise():
    if (usual := threads()) == "openblas":
        pytest.skip("this NumPy is without OpenBLAS")
    assert usual == "1"
    assert threads(OPENBLAS_NUM_THREADS="2") == str(min(2, os.cpu_count() or 1))
