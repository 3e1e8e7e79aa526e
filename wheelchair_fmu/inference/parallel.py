"""All cores at once: what takes time is C's work, which other threads need not wait for."""

from __future__ import annotations

from collections import deque
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
    left = deque(sorted(range(len(things)), key=lambda i: -size(things[i])))
    done: dict[int, Result] = {}
    faults: dict[int, BaseException] = {}

    def share() -> None:
        """What one core does, thing after thing: to hand over each by itself would take as long as the smallest of them."""
        while left:
            try:
                i = left.popleft()
            except IndexError:  # another core has just taken the last
                return
            if i > min(faults, default=i):
                continue  # nobody will ask for it
            try:
                done[i] = do(things[i])
            except BaseException as fault:
                faults[i] = fault

    shares = [_pool().submit(share) for _ in range(min(_cores(), len(things)))]
    try:
        for each in shares:
            each.result()
        if faults:
            raise faults[min(faults)]  # the first in the order of things, whichever came first
    finally:
        left.clear()  # after Ctrl-C nobody waits for the rest
        faults.clear()  # each holds on to what was at work when it came
    return [done[i] for i in range(len(things))]


def meanwhile(do: Callable[[], object]) -> None:
    """Have made what will be asked for later, beside other work, where there are cores for it. What goes wrong there is told
    when it is asked for."""
    if _cores() > 1:
        _background().submit(do)


_this = local()  # thread


def _cores() -> int:
    """All, or one where this is one of several processes that share them."""
    return 1 if parent_process() else cpu_count() or 1


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(_cores(), initializer=_works)


@cache
def _background() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(1)


def _works() -> None:
    _this.works = True
