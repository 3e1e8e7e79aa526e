"""FMUs of a variant."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..fmu.build import NAMES, build_each
from .variants import Variant, chair_of


def build(
    variant: Variant | str | Path | None = None,
    output: str | Path | None = None,
    *,
    effects: str | Sequence[str] = "default",
    equations: str | None = None,
    flavour: str = "native",
    fmi: str | None = None,
    platforms: str = "host",
) -> tuple[Path, ...]:
    """Build the FMU of a variant, for FMI 2.0 at `output` and for FMI 3.0 beside it, and return the paths.

    `variant` is a Variant, a TOML file, or None for the paper's chair; `output` is dist/Wheelchair.fmu unless given. `effects`
    are built in beside the variant's own, so that an importer can switch them on: "default" (all that need no state of their
    own), "all", "none", ids, or a folder of your own. `equations` are "extended" or "paper"; `flavour` is "native" or "python";
    `fmi` is "2", "3" or "both" (the default; the Python flavour is "2" only); `platforms` are "host", "all" or names with
    commas.

    Raises UsageError for an unknown word, and BuildError where it cannot be compiled, written, or is not valid.

    >>> [path.name for path in wc.build(output="chair.fmu", effects="none")]
    ['chair.fmu', 'chair.fmi3.fmu']
    """
    chair, chosen = chair_of(variant, {}, effects, equations)
    first = Path(output) if output is not None else Path("dist") / f"{NAMES.get(flavour, 'Wheelchair')}.fmu"
    return tuple(build_each(_targets(fmi, flavour, first), chair, effects=chosen, flavour=flavour, platforms=platforms))


def _targets(version: str | None, flavour: str, first: Path) -> dict[str, Path]:
    """Where to write which version of FMI."""
    version = version or ("2" if flavour == "python" else "both")
    if version == "both":
        return {"2": first, "3": first.with_name(f"{first.stem}.fmi3.fmu")}
    return {version: first}
