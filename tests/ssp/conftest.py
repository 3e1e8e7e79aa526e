"""Archives, each built once for all tests."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest

from tests.fmu.chair import Unpacked
from tests.kit import shared
from wheelchair_fmu.fmu.companions import Recording, build_floor, build_pusher
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies.archives import fmu_of
from wheelchair_fmu.studies.ssp.building import build

RECORDING = Recording(np.array([5.0, 5.1, 5.5, 6.0]), np.array([0.0, 30.0, 10.0, 0.0]), np.array([0.0, 20.0, -5.0, 0.0]))


@pytest.fixture(scope="session")
def workshop(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("ssp")


@pytest.fixture(scope="session")
def slalom(tmp_path_factory) -> Path:
    return shared(tmp_path_factory, "slalom", lambda folder: build("slalom", folder / "slalom.ssp")) / "slalom.ssp"


@pytest.fixture(scope="session")
def pusher(workshop) -> Unpacked:
    return Unpacked.of(build_pusher(workshop / "Pusher.fmu", {}), workshop / "pusher")


@pytest.fixture(scope="session")
def replaying(workshop) -> Unpacked:
    path = build_pusher(workshop / "Replay.fmu", {"pusher.mode": "replay"}, RECORDING)
    return Unpacked.of(path, workshop / "replaying")


@pytest.fixture(scope="session")
def floor(workshop) -> Unpacked:
    return Unpacked.of(build_floor(workshop / "Floor.fmu", {}), workshop / "floor")


@pytest.fixture(scope="session")
def wheelchair(workshop) -> Unpacked:
    return Unpacked.of(fmu_of(Variant()), workshop / "wheelchair")


@pytest.fixture
def altered(slalom, tmp_path):
    """The slalom with some files changed: `altered({"SystemStructure.ssd": (old, new)})`; None removes a file."""

    def make(changes: dict[str, tuple[str, str] | bytes | None]) -> Path:
        target = tmp_path / "altered.ssp"
        with zipfile.ZipFile(slalom) as good, zipfile.ZipFile(target, "w") as made:
            for name in good.namelist():
                content, change = good.read(name), changes.get(name, b"")
                if isinstance(change, tuple):
                    old, new = (text.encode() for text in change)
                    assert old in content, f"{name} holds no {change[0]}"
                    content = content.replace(old, new, 1)
                if change is not None:
                    made.writestr(name, change if isinstance(change, bytes) and change else content)
            for name in changes.keys() - set(good.namelist()):
                made.writestr(name, changes[name])
        return target

    return make
