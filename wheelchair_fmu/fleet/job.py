"""The work: each campaign is a chunk of one row, diagnosed with the same question."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import pyarrow as pa
import pyarrow.parquet as pq

from .. import __version__, inference
from ..campaign import fingerprint, read, windows
from ..engine.cache import sources
from ..errors import Failure, FileError, WheelchairError
from ..inference.decision.verdict import diagnose
from ..inference.subject import applied, known_parameters
from ..model.generic import library
from ..model.recipe import Recipe
from ..model.variant import Variant
from .rows import KEY, of_diagnosis, schema

FILE = "campaign.toml"
INFERENCE = Path(inference.__file__).parent


@dataclass(frozen=True)
class Fleet:
    """Campaigns and what is asked of all alike: `settings` (names and values as written) of a chair, the default one if
    none is given. The campaigns' paths are absolute; whoever does the work reads them there."""

    places: tuple[Path, ...]
    settings: tuple[tuple[str, str], ...] = ()
    recipe: Recipe = Recipe()
    what: ClassVar[str] = "campaigns, question or version"

    @property
    def by_threads(self) -> bool:
        return False  # a search is Python for the most part

    @cached_property
    def keys(self) -> tuple[str, ...]:
        """For each campaign what decides its row: the files' content, the question, and this program."""
        asked = (__version__, sources(), _inference(), repr(self.settings), repr(self.recipe))
        return tuple(_hash(*asked, str(place), fingerprint(place)) for place in self.places)

    @cached_property
    def fingerprint(self) -> str:
        """Two fleets with the same one have the same result."""
        return _hash(*self.keys)

    def known(self, out: Path) -> dict[int, pa.Table]:
        """Chunks that `out`, the result of a fleet with other campaigns, has already."""
        if not out.is_file() or pq.read_schema(out).names != self.schema().names:
            return {}
        table = pq.read_table(out)
        there = {key: i for i, key in enumerate(table.column(KEY).to_pylist())}
        return {n: table.slice(there[key], 1) for n, key in enumerate(self.keys) if key in there}

    @property
    def chunks(self) -> int:
        return len(self.places)

    @property
    def total(self) -> int:
        return len(self.places)

    def rows(self, chunk: int) -> int:
        return 1

    def chair(self) -> Variant:
        """The variant that every campaign is held against.

        Raises UsageError where a setting is wrong.
        """
        return self.recipe.variant().with_values(dict(self.settings))

    def schema(self) -> pa.Schema:
        return schema(self.chair(), {"wheelchair-fmu": __version__, "fingerprint": self.fingerprint})

    def table(self, chunk: int) -> pa.Table:
        return pa.Table.from_pylist([self._row(self.places[chunk]) | {KEY: self.keys[chunk]}], schema=self.schema())

    def _row(self, place: Path) -> dict[str, Any]:
        if not place.exists():
            raise Failure(
                f"{place}: not there for the process that was to diagnose it; the workers of a cluster must see "
                "the campaigns' folders under the same names"
            )
        about = {"folder": str(place), "campaign": place.name}
        try:
            start = self.recipe.variant()
            measured = windows(read(place, known_parameters(start.catalogue, start.choice)))
            about["campaign"] = measured.name
            variant, measured, fixed = applied(dict(self.settings), start, measured)
            return {**about, **of_diagnosis(diagnose(measured, variant, library(), fixed=fixed))}
        except FileError as error:
            return {**about, "error": _first(error, place)}
        except WheelchairError as error:
            return {**about, "error": str(error)}


def _inference() -> str:
    """What decides a diagnosis beside the equations."""
    return _hash(*(f.read_text(encoding="utf-8") for f in sorted(INFERENCE.rglob("*.py"))))


def _hash(*words: str) -> str:
    return hashlib.sha256("\n".join(words).encode()).hexdigest()


def _first(error: FileError, place: Path) -> str:
    more = len(error.faults) - 1
    return f"{error.faults[0]}" + (f" (and {more} more; see wheelchair check {place})" if more else "")


def folders(given: Iterable[Path]) -> tuple[Path, ...]:
    """The campaigns meant by these folders: each itself, or else the folders in it that are campaigns, by name.

    Raises Failure where a folder neither is one nor has any.
    """
    found: list[Path] = []
    for folder in given:
        inside = [folder] if (folder / FILE).is_file() else sorted(file.parent for file in folder.glob(f"*/{FILE}"))
        if not inside:
            raise Failure(f"{folder}: no {FILE} in it or in a folder in it; give a campaign, or a folder of campaigns")
        found += inside
    return tuple(dict.fromkeys(place.resolve() for place in found))
