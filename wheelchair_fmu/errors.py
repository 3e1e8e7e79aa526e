"""Every error this package raises on purpose, and how the kinds relate.

::

    WheelchairError             one sentence: the fact, the value, the cure
    ├── UsageError              the question is wrong (exit code 2): unknown option, id or name
    └── Failure                 the data or the model fails what was asked (exit code 1)
        ├── FileError           faults in files; carries all of them
        │   ├── CampaignError   those of a campaign
        │   ├── EffectError     those of effects of a user's own
        │   └── SystemStructureError  those of an .ssp
        ├── ModelError          a model that cannot be assembled
        ├── SimulationError     a simulation that cannot go on
        └── BuildError          no compiler, a failing compile, an archive that cannot be written
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches

INTERRUPTED = "interrupted; files already there are as they were"


class WheelchairError(Exception):
    """Base of all errors that a user can cause and cure."""

    exit_code = 1


class Note(UserWarning):
    """What a user should know and need not act on."""


class FormerName(Note):
    """A parameter was given by a name that it had before; it is read, and this says as what."""


class UsageError(WheelchairError):
    """The question is wrong: an unknown option, identifier or name."""

    exit_code = 2


class Failure(WheelchairError):
    """The data or the model fails what was asked."""


class FileError(Failure):
    """Faults in files, all of them.

    `faults` is a sequence of objects whose `str` is one line: place, fact, value, cure.
    """

    def __init__(self, faults: Sequence[object]):
        self.faults = tuple(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))


class CampaignError(FileError):
    """Faults in a campaign's files."""


class EffectError(FileError):
    """Faults in effect files, and contracts that their effects break."""


class SystemStructureError(FileError):
    """Faults in an .ssp."""


class ModelError(Failure):
    """A model that cannot be assembled."""


class ShapeError(ModelError):
    """A term of another shape than what it is added to: `given` and `wanted`, as (rows, columns)."""

    def __init__(self, message: str, given: tuple[int, int], wanted: tuple[int, int]):
        super().__init__(message)
        self.given, self.wanted = given, wanted


class SimulationError(Failure):
    """A simulation that cannot go on."""


class BuildError(Failure):
    """Something could not be compiled or packed."""


def unknown(kind: str, name: object, known: Iterable[str]) -> UsageError:
    """The error for a misspelt name (or what stands in its place), with the nearest known names as the cure."""
    known, word = list(known), str(name)
    close = [k for k in known if word and word in k][:3] or get_close_matches(word, known, n=3, cutoff=0.5)
    hint = f"did you mean {' or '.join(repr(c) for c in close)}?" if close else f"known: {', '.join(known)}"
    if kind == "effect":  # which may lie in a folder that was not given
        hint += f"{'' if close else '.'} An effect of your own is found by --effects DIR, its folder"
    return UsageError(f"no {kind} {name!r}; {hint}")
