"""What the loop is asked about: the catalogue, the chair, and a campaign in which given values stand."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from ..campaign import Campaign
from ..contracts.own import catalogue, variant_in
from ..errors import unknown
from ..model.choice import Choice, names
from ..model.effects import bundled
from ..model.former import current
from ..model.stage import Effect
from ..model.variant import Variant


def known_parameters(
    catalogue: Mapping[str, Effect] | None = None, choice: Choice = Choice()
) -> dict[str, tuple[float, float]]:
    """Bounds, in SI units, of every parameter that a campaign may name, with these effects (the bundled ones unless given) and
    the laws that a choice brings along."""
    known = bundled() if catalogue is None else catalogue
    laws = (Variant(replace(choice, caster=law), catalogue=known).with_effects(known) for law in names(choice)["caster"])
    return {p.name: (p.lower, p.upper) for law in laws for p in law.parameters()}


def chair(variant: Path | None, effects: Path | None) -> Variant:
    """The variant in a file, or the default chair, with that catalogue. Raises as `variant_in`."""
    known = catalogue(effects)
    return variant_in(variant, known) if variant else Variant(catalogue=known)


def narrowed(variant: Variant, among: Iterable[str]) -> Variant:
    """The variant with a catalogue of these effects and those that it has. Raises UsageError for an unknown id."""
    chosen = tuple(among)
    for effect in chosen:
        if effect not in variant.catalogue:
            raise unknown("effect", effect, variant.catalogue)
    kept = {*chosen, *variant.effects}
    return replace(variant, catalogue={e: record for e, record in variant.catalogue.items() if e in kept})


def applied(
    values: Mapping[str, float | str], variant: Variant, measured: Campaign
) -> tuple[Variant, Campaign, tuple[str, ...]]:
    """The chair and the campaign with these values, which go before the campaign file's own; and their names.

    Raises UsageError as `Variant.with_values` does.
    """
    values = current(values, variant.values)
    variant = variant.with_values(values)
    known = {n: variant.values[n] for n in values if n in variant.values and not n.startswith("effect.")}
    return variant, replace(measured, known={**measured.known, **known}), tuple(values)
