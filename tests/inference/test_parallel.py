"""Work on all cores."""

from __future__ import annotations

from threading import Event, get_ident

import pytest

from wheelchair_fmu.inference import parallel
from wheelchair_fmu.inference.parallel import meanwhile, parallel_map


def test_results_stand_in_the_order_of_things():
    assert parallel_map(lambda n: n * n, range(20)) == [n * n for n in range(20)]


def test_the_largest_are_begun_first_and_results_stand_in_order():
    begun = []

    def do(n: int) -> int:
        begun.append(n)
        return -n

    assert parallel_map(do, range(40), size=lambda n: n % 10) == [-n for n in range(40)]
    assert set(begun[:2]) <= {9, 19, 29, 39}
    assert set(begun[-2:]) <= {0, 10, 20, 30}


def test_work_within_work_stays_where_it_is():
    outer = parallel_map(lambda n: (get_ident(), set(parallel_map(lambda m: get_ident(), range(n)))), range(2, 8))
    assert all(inner == {here} for here, inner in outer)


def test_one_alone_leaves_the_cores_to_what_is_in_it():
    [(here, inner)] = parallel_map(lambda n: (get_ident(), parallel_map(lambda m: get_ident(), range(4))), [0])
    assert here == get_ident()
    assert here not in inner


def test_a_fault_in_one_thing_is_told():
    with pytest.raises(ZeroDivisionError):
        parallel_map(lambda n: 1 / n, [1, 0, 2])


def test_of_several_faults_the_first_in_the_order_of_things_is_told():
    def do(n: int) -> int:
        if n > 2:
            raise ValueError(n)
        return n

    for _ in range(20):
        with pytest.raises(ValueError, match=r"^3$"):
            parallel_map(do, range(12), size=lambda n: n)
    assert parallel_map(do, []) == []


def test_what_is_made_meanwhile_is_made_by_another_thread_whatever_failed_before(monkeypatch):
    monkeypatch.setattr(parallel, "_cores", lambda: 2)
    made, by = Event(), list[int]()

    def fails() -> None:
        raise ZeroDivisionError

    def makes() -> None:
        by.append(get_ident())
        made.set()

    meanwhile(fails)
    meanwhile(makes)
    assert made.wait(10) and by != [get_ident()]
    monkeypatch.setattr(parallel, "_cores", lambda: 1)
    meanwhile(makes)  # on one core it would only delay what is waited for
    assert len(by) == 1
