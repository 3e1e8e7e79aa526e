"""All cores at once: what takes time is C's work, which other threads need not wait for."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from multiprocessing import parent_process
from os import cpu_count
from threading import local
from typing import TypeVar

Thing = TypeVar("Thing")
Result = TypeVar("Result")


def each(do: Callable[[Thing], Result], things: Iterable[Thing]) -> list[Result]:
    """`do` of each thing, on all cores. In what is done so already, one after the other; and one alone may use all cores."""
    things = list(things)
    if len(things) == 1 or getattr(_this, "works", False):
        return [do(thing) for thing in things]
    return list(_pool().map(do, things))


_this = local()  # thread


@cache
def _pool() -> ThreadPoolExecutor:
    """All cores, or one where this is one of several processes that share them."""
    return ThreadPoolExecutor(1 if parent_process() else cpu_count(), initializer=_works)


def _works() -> None:
    _this.works = True
