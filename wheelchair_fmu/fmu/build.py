"""Build an FMU of a variant."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from ..errors import UsageError, unknown
from ..model.variant import Variant
from . import native, package, reference, validate
from .platforms import chosen
from .variables import Interface, interface

VERSIONS = ("2", "3")  # of FMI


def _native(face: Interface, versions: Sequence[str], platforms: str) -> dict[str, dict[str, bytes]]:
    return native.archives(face, versions, chosen(platforms), reference.files(face))


def _python(face: Interface, versions: Sequence[str], platforms: str) -> dict[str, dict[str, bytes]]:
    from . import python_flavour  # needs pythonfmu, which the native flavour does not

    if "3" in versions:
        raise UsageError("pythonfmu makes FMI 2.0 only; give --fmi 2, or --flavour native")
    if platforms != "host":
        raise UsageError("pythonfmu brings its own libraries; leave out --platforms, or give --flavour native")
    return {"2": python_flavour.archive(face)}


FLAVOURS = {"native": _native, "python": _python}
NAMES = {"native": "Wheelchair", "python": "WheelchairPython"}


def with_chosen_effects(variant: Variant, effects: str | Iterable[str] = "default") -> Variant:
    """The variant with more effects: "default" (all that need no state), "all", "none", or their ids.

    Effects that the variant has already stay. Raises UsageError for an unknown id, or one that acts on records only.
    """
    if effects == "all":
        effects = tuple(e.id for e in variant.catalogue.values() if not e.delays_record)
    elif effects == "default":
        effects = tuple(e.id for e in variant.catalogue.values() if e.stateless)
    elif effects == "none":
        effects = ()
    else:
        words = effects.split(",") if isinstance(effects, str) else effects
        effects = tuple(word.strip() for word in words if word.strip())
    grown = variant.with_effects(effects)
    for effect in effects:
        if variant.catalogue[effect].delays_record:
            raise UsageError(f"effect {effect!r} shifts recorded pushes in time and is no part of an FMU; leave it out")
    return grown


def build(
    variant: Variant | None = None,
    target: Path = Path("dist/Wheelchair.fmu"),
    *,
    effects: str | Iterable[str] = "default",
    equations: str | None = None,
    flavour: str = "native",
    fmi: str = "2",
    platforms: str = "host",
) -> Path:
    """Build the FMU of a variant, for one version of FMI, and return its path. Raises as `build_each`."""
    return build_each({fmi: Path(target)}, variant, effects=effects, equations=equations, flavour=flavour, platforms=platforms)[
        0
    ]


def build_each(
    targets: Mapping[str, Path],
    variant: Variant | None = None,
    *,
    effects: str | Iterable[str] = "default",
    equations: str | None = None,
    flavour: str = "native",
    platforms: str = "host",
) -> list[Path]:
    """Build the FMU of a variant for each version of FMI in `targets`, and return the paths.

    `platforms` are "host", "all" or names with commas, see `platforms.PLATFORMS`.

    Raises UsageError for an unknown effect, flavour, version or platform, ModelError for a model that cannot be assembled,
    and BuildError where it cannot be compiled, written, or is not valid.
    """
    if flavour not in FLAVOURS:
        raise unknown("flavour", flavour, FLAVOURS)
    for version in targets:
        if version not in VERSIONS:
            raise unknown("version of FMI", version, VERSIONS)
    package.moment()  # before a compiler is at work
    grown = with_chosen_effects(variant or Variant(), effects)
    if equations:
        grown = replace(grown, choice=replace(grown.choice, equations=equations))
    archives = FLAVOURS[flavour](interface(grown), tuple(targets), platforms)
    return [package.write(path, archives[version], validate.problems) for version, path in targets.items()]
