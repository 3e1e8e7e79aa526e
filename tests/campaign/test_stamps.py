"""Rows that a logger sent twice or not quite in turn, and clocks that were set back."""

import numpy as np
import pytest

from wheelchair_fmu.campaign.stamps import stamps

TIME = np.arange(8) / 100
READ = np.sin(np.arange(8.0))


def of(order, time=TIME):
    return stamps(time[order], [READ[order]])


def test_rows_in_turn_stay_as_they_are():
    found = of(np.arange(8))
    assert found.rows.tolist() == [*range(8)] and not found.copies.size and not found.overtaken.size


def test_a_row_that_says_the_same_again_is_left_out():
    found = of(np.array([0, 1, 1, 1, 2, 3, 4, 5, 6, 7]))
    assert found.copies.tolist() == [2, 3] and found.rows.tolist() == [0, 1, 4, 5, 6, 7, 8, 9]


def test_two_rows_of_one_time_that_say_different_things_stay():
    time = TIME.copy()
    time[3] = time[2]
    assert not of(np.arange(8), time).copies.size


def test_a_gap_is_the_same_as_a_gap():
    read = np.full(3, np.nan)
    assert stamps(np.array([0.0, 0.1, 0.1]), [read, np.arange(3.0) // 2]).copies.size == 0
    assert stamps(np.array([0.0, 0.1, 0.1]), [read, np.ones(3)]).copies.tolist() == [2]


def test_a_row_that_was_overtaken_is_read_in_turn():
    time = TIME.copy()
    time[4] = time[3] - 0.004  # stamped after row 2, and written after row 3
    found = of(np.arange(8), time)
    assert found.rows.tolist() == [0, 1, 2, 4, 3, 5, 6, 7] and found.overtaken.tolist() == [4]
    assert found.by == pytest.approx(0.004)


def test_neighbours_that_changed_places_are_read_in_turn():
    order = np.array([0, 1, 2, 4, 3, 5, 6, 7])
    assert TIME[order][of(order).rows].tolist() == TIME.tolist()


def test_a_clock_that_was_set_back_is_left_to_be_judged():
    time = np.concatenate((TIME[:4], TIME[1:5]))
    found = stamps(time, [READ])
    assert found.rows.tolist() == [*range(8)] and not found.overtaken.size


def test_rows_without_a_time_are_nobody_s_neighbour():
    time = TIME.copy()
    time[3] = np.nan
    assert of(np.arange(8), time).rows.tolist() == [0, 1, 2, 4, 5, 6, 7]


def test_no_rows_at_all():
    assert stamps(np.empty(0), []).rows.size == 0
