"""Build an FMU of a variant."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

from ..errors import UsageError, unknown
from ..model.variant import Variant
from . import native, package, validate
from .variables import Interface, interface

Archive = Callable[[Interface], dict[str, bytes]]


def _python(face: Interface) -> dict[str, bytes]:
    from . import python_flavour  # needs pythonfmu, which the native flavour does not

    return python_flavour.archive(face)


FLAVOURS: dict[str, Archive] = {"native": native.archive, "python": _python}
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
) -> Path:
    """Build the FMU of a variant and return its path.

    Raises UsageError for an unknown effect or flavour, ModelError for a model that cannot be assembled, and
    BuildError where it cannot be compiled, written, or is not valid.
    """
    if flavour not in FLAVOURS:
        raise unknown("flavour", flavour, FLAVOURS)
    chosen = with_chosen_effects(variant or Variant(), effects)
    if equations:
        chosen = replace(chosen, choice=replace(chosen.choice, equations=equations))
    return package.write(Path(target), FLAVOURS[flavour](interface(chosen)), validate.problems)
