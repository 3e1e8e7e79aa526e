"""A variant of the chair: its laws, effects and values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from html import escape
from pathlib import Path

import pandas as pd

from ..contracts.own import catalogue, catalogue_of, names_folder, text_of, variant_in
from ..fmu.build import with_chosen_effects
from ..model import variant as records
from ..model.variant import LAWS, effects_in
from ..writing import written

Values = Mapping[str, float | str]


class Variant:
    """Which laws and effects a chair has, and with which values; what is not said is as in Table 1 of the paper.

    `values` are FMI parameters by name, SI units, of which `effect.<id>.<parameter>` switches that effect on; `effects` are ids
    of more effects. `own_effects` is a folder of effect files of your own, which are programs and run with your rights.

    Raises UsageError for an unknown name, or a value out of bounds, and EffectError for effect files with faults.

    >>> heavy = wc.Variant({"chair.m": 110, "effect.relaxation_length.sigma": 0.2})
    >>> heavy.effects, heavy.values["chair.m"]
    (('relaxation_length',), 110.0)
    """

    def __init__(
        self, values: Values | None = None, effects: Iterable[str] = (), *, own_effects: str | Path | None = None
    ) -> None:
        known = catalogue(None if own_effects is None else Path(own_effects))
        self._set(records.Variant(catalogue=known).with_effects(effects).with_values(values or {}))

    def _set(self, record: records.Variant, staircase: pd.DataFrame | None = None) -> None:
        self._record, self._staircase = record, staircase

    @classmethod
    def read(cls, path: str | Path, *, own_effects: str | Path | None = None, trust: bool = False) -> Variant:
        """The variant in a TOML file, as `Variant.save` and `wheelchair add` write it.

        Effects of somebody's own in the file are programs and run with your rights: those that were not written on this machine
        need `wheelchair trust FILE` once, or `trust`.

        Raises Failure or UsageError that name the file and the fault, and EffectError for effects in it with faults.

        >>> path = wc.Variant({"chair.m": 110}).save("heavy.toml")
        >>> wc.Variant.read(path).values
        {'chair.m': 110.0}
        """
        return of_record(plain(path, own_effects, trust=trust))

    @property
    def effects(self) -> tuple[str, ...]:
        """Ids of the effects that are on.

        >>> wc.Variant(effects=["scrub_torque"]).effects
        ('scrub_torque',)
        """
        return self._record.effects

    @property
    def values(self) -> dict[str, float]:
        """Values that differ from the defaults, by FMI name, SI units.

        >>> wc.Variant({"chair.m": 110}).values
        {'chair.m': 110.0}
        """
        return dict(self._record.values)

    @property
    def laws(self) -> dict[str, str]:
        """The laws of tyre, casters and rear wheels, and the equations.

        >>> wc.Variant({"tyre.law": "dugoff"}).laws
        {'tyre': 'dugoff', 'caster': 'ideal', 'wheel': 'rolling', 'equations': 'extended'}
        """
        return {kind: getattr(self._record.choice, kind) for kind in LAWS}

    @property
    def standard_errors(self) -> dict[str, float]:
        """Standard errors of the values that were fitted, by name, SI units; empty where none was.

        >>> wc.Variant().standard_errors
        {}
        """
        return dict(self._record.notes.get("standard_errors", {}))

    @property
    def staircase(self) -> pd.DataFrame | None:
        """The errors on the way here, as in `Diagnosis.staircase`, of a variant that `add` has fitted; else None.

        >>> wc.Variant().staircase is None
        True
        """
        return self._staircase

    def with_values(self, values: Values) -> Variant:
        """The same chair with other values; a value of an effect that is off switches it on. Raises as the constructor does.

        >>> wc.Variant().with_values({"chair.m": 90, "tyre.law": "magic_formula"}).values
        {'chair.m': 90.0}
        """
        return of_record(self._record.with_values(values))

    def with_effects(self, effects: Iterable[str]) -> Variant:
        """The same chair with more effects. Raises UsageError for an unknown id.

        >>> wc.Variant().with_effects(["scrub_torque"]).effects
        ('scrub_torque',)
        """
        return of_record(self._record.with_effects(effects))

    def save(self, path: str | Path) -> Path:
        """Write it as TOML, which every command and `Variant.read` take, and return the path.

        The programs of effects of your own that are on go along.

        >>> wc.Variant({"chair.m": 110}).save("heavy.toml").name
        'heavy.toml'
        """
        with written(Path(path)) as beside:
            beside.write_text(text_of(self._record), encoding="utf-8")
        return Path(path)

    def __repr__(self) -> str:
        return f"Variant(effects={list(self.effects)}, values={self.values})"

    def _repr_html_(self) -> str:
        errors = self.standard_errors
        units = {p.name: p.unit.name for p in self._record.parameters()}
        rows = [(n, v, errors.get(n), units.get(n, "")) for n, v in self.values.items()]
        table = pd.DataFrame(rows, columns=["parameter", "value", "standard error", "unit"])
        effects = ", ".join(self.effects) or "none"
        return f"<p>effects: {escape(effects)}</p>{table.to_html(index=False, na_rep='')}"


def of_record(record: records.Variant, staircase: pd.DataFrame | None = None) -> Variant:
    """The public face of a record of the model."""
    face = Variant.__new__(Variant)
    face._set(record, staircase)
    return face


def plain(
    variant: Variant | str | Path | None, own_effects: str | Path | None = None, *, trust: bool = False
) -> records.Variant:
    """The record behind a variant, in a file, or of the default chair; with a folder of more effects it may have those too."""
    if isinstance(variant, Variant):
        record = variant._record
        return (
            record if own_effects is None else replace(record, catalogue={**record.catalogue, **catalogue(Path(own_effects))})
        )
    known = catalogue(None if own_effects is None else Path(own_effects))
    return records.Variant(catalogue=known) if variant is None else variant_in(Path(variant), known, trust=trust)


def chair_of(
    variant: Variant | str | Path | None, values: Values, effects: str | Sequence[str], equations: str | None
) -> tuple[records.Variant, str | Sequence[str]]:
    """The chair asked for with the effects that `values` name, which are checked on the way, and what `effects` chooses beside:
    a folder joins its effects to the catalogue, anything else chooses from it."""
    own, chosen = None, effects
    if isinstance(effects, str) and names_folder(effects):
        own, chosen = effects, catalogue_of(effects)[1]
    start = plain(variant, own)
    if equations:
        start = replace(start, choice=replace(start.choice, equations=equations))
    return with_chosen_effects(start, effects_in(values)).with_values(values), chosen
