"""Hypothesis asks what is true, not how long a busy machine takes to say so. Workers of pytest-xdist take whole files, so that
what a file's tests share is made once."""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy: its threads would spin beside those of the other workers
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

os.environ["WHEELCHAIR_CONFIG"] = os.devnull  # laws, channels and formats of whoever runs the tests stay out of them
settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")
TOGETHER = "tests/api"  # a folder whose files share a diagnosis


@pytest.hookimpl(optionalhook=True)  # of pytest-xdist, where that is installed
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    from xdist.scheduler import LoadFileScheduling

    class Files(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return TOGETHER if nodeid.startswith(f"{TOGETHER}/") else super()._split_scope(nodeid)

    config.option.loadscopereorder = False  # which would leave the files of few and long tests to the end
    return Files(config, log)
