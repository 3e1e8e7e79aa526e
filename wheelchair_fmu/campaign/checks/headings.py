"""Checks of all files of a device: a column that one of them lacks, or spells otherwise, a unit that one has otherwise."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from ...faults import NOTE, SHOWN, WARNING, Fault, run_fault
from ...units import UnitError, factor, same_dimension, split
from ..binding import Places, Wanted, wanted
from ..channels import BY_NAME, SOURCES, TIME, Channel
from ..draft import Draft, constants
from ..spelling import alike, nearest

CHANNELS = {channel.name: channel for channel in (TIME, *BY_NAME.values(), *SOURCES)}
Size = tuple[str, float]  # of a unit: the SI unit of its dimension, and how many of that it is


@dataclass(frozen=True)
class Lack:
    """A file without the column that [columns] names for a channel: what it has in its place, None where it has nothing, and
    what that is called in how many other files."""

    draft: Draft
    name: str
    odd: str | None
    header: str
    others: int


def misspelt_column(own: Sequence[Draft]) -> Iterator[Fault]:
    """The cause of what its run lacks then."""
    for lack in _lacks(own):
        if lack.odd is not None:
            fact = f"it is called {lack.header!r} in {_files(lack.others)}, and {lack.name} is not read from it"
            cure = "correct the header in this file"
            if not alike(lack.odd, lack.header):
                fact = f"it stands where {lack.header!r} stands in {_files(lack.others)}, and {lack.name} is not read from it"
                cure = "correct the header in this file if that is what it is"
            yield run_fault(lack.draft.file, fact, cure, 1, lack.odd, WARNING)


def absent_column(own: Sequence[Draft]) -> Iterator[Fault]:
    """Only a warning: another run may have it. That no run has it is an error of the campaign."""
    for lack in _lacks(own):
        if lack.odd is None and lack.name != TIME.name:
            cure = "not measured in this run; give it by constant if it is known"
            fact = f"no column for {lack.name}, which [columns] renames"
            yield run_fault(lack.draft.file, fact, cure, 1, severity=WARNING)


def odd_unit(own: Sequence[Draft]) -> Iterator[Fault]:
    """Where a file says another unit than the others, each is read as it says itself; one of them may be wrong."""
    for name in dict.fromkeys(name for draft in own for name in draft.bindings.found):
        want = wanted(own[0].part.device, name)
        drafts = {draft.file: draft for draft in own if _meant(draft, name, want) and _unit(draft, name) is not None}
        yield from _units(name, want, drafts)


def _lacks(own: Sequence[Draft]) -> Iterator[Lack]:
    for name in dict.fromkeys(name for draft in own for name in draft.bindings.absent):
        called = Counter(header for draft in own if (header := draft.header(name)) is not None)
        usual = max(called, key=lambda header: called[header], default="")
        others = {draft.file: draft.table.headers for draft in own if usual and draft.header(name) == usual}
        for draft in own:
            if name in draft.bindings.absent and not _known(draft, name):
                yield Lack(draft, name, _instead(draft.table.headers, usual, list(others.values())), usual, len(others))


def _instead(headers: Sequence[str], lacking: str, others: Sequence[Sequence[str]]) -> str | None:
    """The header that is the lacking one in another spelling, which no other file has beside it; or where that one alone is
    lacking of what all others have, the only one that they have not. None where there is none, or no other file."""
    if not others:
        return None
    beside = {header for one in others for header in one}
    more = [header for header in headers if header not in beside]
    if (odd := nearest(lacking, more)) is not None or len(more) != 1:
        return odd
    return more[0] if set.intersection(*map(set, others)) - set(headers) == {lacking} else None


def _known(draft: Draft, name: str) -> bool:
    return name in draft.bindings.found or name in draft.values or name in constants(draft.entry)


def _meant(draft: Draft, name: str, want: Wanted) -> bool:
    """Is a channel read from the column that [columns] names for it, where that names one, and not from one beside it?"""
    header = draft.header(name)
    return header is not None and (not want.renamed or bool(Places((header,)).of(want.header)))


def _units(name: str, want: Wanted, drafts: Mapping[str, Draft]) -> Iterator[Fault]:
    sizes = {file: _size(CHANNELS[name], _unit(draft, name)) for file, draft in drafts.items()}
    said = {file: size for file, size in sizes.items() if size is not None}  # of the others binding says that they are none
    asked = split(want.header)[1] if want.renamed and want.unit is None else None
    if asked is not None and said and _size(CHANNELS[name], asked) not in said.values():
        for file in said:
            fact = f"[columns] {name} says [{asked}], the file says [{_unit(drafts[file], name)}]"
            cure = "correct one of them, or settle it by unit = ..."
            yield run_fault(file, fact, cure, 1, drafts[file].header(name))
        return
    usual = _size(CHANNELS[name], want.unit or asked) or _usual(list(said.values()))
    odd = [file for file, size in said.items() if usual is not None and size != usual]
    if want.unit is not None and 2 * len(odd) > len(drafts):
        return  # whoever wrote that unit knows better than the headers
    for file in odd[:SHOWN]:
        others = [_unit(drafts[other], name) for other, size in said.items() if size == usual]
        yield _odd(drafts[file], name, want.unit, others)
    if len(odd) > SHOWN:
        fact = f"{len(odd) - SHOWN} more files have {name} in another unit"
        yield run_fault(odd[SHOWN], fact, "correct their headers where they are wrong", 1, severity=WARNING)


def _odd(draft: Draft, name: str, settled: str | None, others: Sequence[str | None]) -> Fault:
    header, own = draft.header(name), _unit(draft, name)
    if settled is not None:
        fact = f"the file says [{own}], and it is read in {settled}, as [columns] says of {name}"
        return run_fault(draft.file, fact, "nothing is to be done", 1, header, NOTE)
    fact = f"it is in {own} here and in {others[0]} in {_files(len(others))}, and is read as each file says"
    return run_fault(draft.file, fact, "correct the header in this file if its unit is wrong", 1, header, WARNING)


def _usual(sizes: Sequence[Size]) -> Size | None:
    """What more than half of the files have."""
    return next((size for size, n in Counter(sizes).items() if 2 * n > len(sizes)), None)


def _size(channel: Channel, unit: str | None) -> Size | None:
    """How large a unit is, so that N·m and Nm are the same one; None for what is no unit of this channel."""
    for si in (channel.unit, channel.rotary):
        if unit is not None and si is not None and same_dimension(unit, si.name):
            try:
                return si.name, factor(unit, si.name)
            except UnitError:
                return None
    return None


def _unit(draft: Draft, name: str) -> str | None:
    """The unit that a file gives for a channel; None where it gives none, or where its stamps are read in seconds already."""
    binding = draft.bindings.found.get(name)
    if binding is None or binding.index in draft.table.moments:
        return None
    return draft.table.units[binding.index]


def _files(n: int) -> str:
    return f"{n} other files" if n != 1 else "one other file"


HEADING_CHECKS: tuple[Callable[[Sequence[Draft]], Iterator[Fault]], ...] = (misspelt_column, odd_unit, absent_column)
