"""No effect without an independent truth: each is named by a test beside this file, marked `effect("its_id")`."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pkgutil import iter_modules

from tests.model import effects as here
from wheelchair_fmu.model.effects import bundled


def marked() -> Iterator[str]:
    """The effects that the tests beside this file are marked with."""
    for module in iter_modules(here.__path__, f"{here.__name__}."):
        for test in vars(import_module(module.name)).values():
            marks = getattr(test, "pytestmark", ()) if callable(test) else ()
            yield from (id_ for mark in marks if mark.name == "effect" for id_ in mark.args)


def test_every_effect_has_a_truth_of_its_own():
    assert sorted(set(bundled()) - set(marked())) == [], "write a test of these effects' physics, marked with their ids"


def test_marks_name_effects():
    assert sorted(set(marked()) - set(bundled())) == []
