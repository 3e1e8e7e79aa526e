"""A user's own laws, channels, manoeuvres and formats: files in the folder of their configuration of wheelchair-fmu, one each.

They are programs, and are run as soon as they are needed. In a checkout they may as well lie beside the bundled ones.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import platformdirs

VARIABLE = "WHEELCHAIR_CONFIG"  # names another folder, such as one that goes with a project
OF_MODELS = ("laws/tyre", "laws/caster", "channels")  # what equations are made of
MANOEUVRES = "manoeuvres"
FORMATS = "formats"


def folder(kind: str) -> Path:
    """Where a user's own files of this kind lie; it need not be there."""
    return Path(os.environ.get(VARIABLE) or platformdirs.user_config_dir("wheelchair-fmu")) / kind


def places(kind: str) -> list[str]:
    """The same for a package's `__path__`: nothing where there is no such folder."""
    return [str(folder(kind))] if folder(kind).is_dir() else []


def files(*kinds: str) -> dict[str, Path]:
    """A user's own files of these kinds, by kind and name, as in "laws/tyre/brush.py"."""
    found = (file for kind in kinds for place in places(kind) for file in sorted(Path(place).glob("*.py")))
    return {file.relative_to(folder("")).as_posix(): file for file in found if not file.name.startswith("_")}


def digest(*kinds: str) -> str:
    """SHA-256 over a user's own files of these kinds; "" where there are none."""
    texts = [f"\0{name}\0".encode() + file.read_bytes().replace(b"\r\n", b"\n") for name, file in files(*kinds).items()]
    return hashlib.sha256(b"".join(texts)).hexdigest() if texts else ""
