"""What fmpy has to say of an archive."""

from __future__ import annotations

from pathlib import Path


def problems(path: Path) -> list[str]:
    """Every fault that fmpy finds, in its words; none in a good archive."""
    from fmpy.validation import validate_fmu

    return list(validate_fmu(str(path)))
