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


def parallel_map(
    do: Callable[[Thing], Result], things: Iterable[Thing], size: Callable[[Thing], float] = lambda thing: 0.0
) -> list[Result]:
    """`do` of each thing, on all cores, the largest first, so that no core waits long for the last. In what is done so
    already, one after the other; and one alone may use all cores."""
    things = list(things)
    if len(things) == 1 or getattr(_this, "works", False):
        return [do(thing) for thing in things]
    order = sorted(range(len(things)), key=lambda i: -size(things[i]))
    begun = {i: _pool().submit(do, things[i]) for i in order}
    try:
        return [begun[i].result() for i in range(len(things))]
    finally:  # after a fault, or Ctrl-C, nobody waits for the rest
        for waiting in begun.values():
            waiting.cancel()


_this = local()  # thread


@cache
def _pool() -> ThreadPoolExecutor:
    """All cores, or one where this is one of several processes that share them."""
    return ThreadPoolExecutor(1 if parent_process() else cpu_count(), initializer=_works)


def _works() -> None:
    _this.works = True
