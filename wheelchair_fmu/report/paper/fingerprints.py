"""What a supplement was made from: every file of data, the code, the catalogue and the libraries, to the letter."""

from __future__ import annotations

import hashlib
import platform
from importlib.metadata import version
from typing import Any

from ... import __version__
from ...campaign.reading import data_files
from ...engine.cache import effect_key
from ...provenance import code_fingerprint
from .case import Case

LIBRARIES = ("numpy", "scipy", "casadi", "pandas", "matplotlib")


def fingerprints(case: Case) -> dict[str, Any]:
    """The content of fingerprints.json. Raises OSError where a file of the campaign cannot be read any more."""
    return {
        "campaign": {
            "name": case.campaign.name,
            "fingerprint": case.campaign.fingerprint,
            "sha256": data_files(case.campaign.path),
        },
        "diagnosis": dict(case.told["made_by"]),
        "supplement": {"version": __version__, "code": code_fingerprint()},
        "python": platform.python_version(),
        "libraries": {name: version(name) for name in LIBRARIES},
        "laws": dict(case.final["laws"]),
        "catalogue": {
            name: hashlib.sha256(effect_key(effect).encode()).hexdigest()
            for name, effect in sorted(case.chair.catalogue.items())
        },
    }
