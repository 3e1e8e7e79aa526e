"""Every public name has a docstring, whose examples do what they show, and types."""

from __future__ import annotations

import doctest
import inspect
import shutil
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

import wheelchair_fmu as wc

from .conftest import SAMPLE

NAMES = [n for n in wc.__all__ if not n.startswith("_")]
EXAMPLES = Path(__file__).parents[2] / "examples"


def members(name: str) -> Iterator[tuple[str, Any]]:
    """A public name, and what is public of it, if it is a class."""
    thing = getattr(wc, name)
    yield name, thing
    if inspect.isclass(thing) and not issubclass(thing, Exception):
        for own, value in vars(thing).items():
            if not own.startswith("_"):
                yield f"{name}.{own}", value


def function(thing: Any) -> Any:
    return thing.fget if isinstance(thing, property) else getattr(thing, "__func__", thing)


@pytest.mark.parametrize("name", NAMES)
def test_every_public_name_says_what_it_is_and_of_what_type(name):
    for place, thing in members(name):
        assert inspect.getdoc(thing), place
        fault = inspect.isclass(thing) and issubclass(thing, Exception)
        assert fault or ">>>" in inspect.getdoc(thing), f"{place} has no example"
        if inspect.isfunction(plain := function(thing)):
            hints = inspect.signature(plain)
            untyped = [p for p, of in hints.parameters.items() if p not in ("self", "cls") and of.annotation is of.empty]
            assert not untyped and hints.return_annotation is not hints.empty, place


def test_type_checkers_see_the_names_that_there_are():
    stub = Path(inspect.getfile(wc)).with_suffix(".pyi").read_text(encoding="utf-8")
    said = {line.split()[-1]: line.split()[1].removeprefix(".") for line in stub.splitlines() if line.startswith("from")}
    assert said == wc._FROM


def test_an_unknown_name_is_an_attribute_error_and_the_light_ones_load_no_model():
    with pytest.raises(AttributeError, match="has no attribute 'diagnos'"):
        _ = wc.diagnos
    assert set(NAMES) <= set(dir(wc))


@pytest.mark.parametrize("module", sorted({place for place in wc._FROM.values() if place.startswith("api.")}))
def test_examples_do_what_they_show(module, campaign, found, tmp_path, monkeypatch):
    """In a folder with the sample campaign and rig data; `found` is diagnosed once for all examples."""
    monkeypatch.chdir(tmp_path)
    if module != "api.samples":
        shutil.copytree(SAMPLE, "my-campaign")
    (tmp_path / "rig").mkdir()
    shutil.copy(EXAMPLES / "rotating-disc.csv", "rig")
    known = {"wc": wc, "campaign": campaign, "found": found}
    if module == "api.comparisons":
        known["compared"] = campaign.compare()
    if module == "api.tyres":
        known["tyre"] = wc.Tyre.fit("rig/rotating-disc.csv")
    if module in ("api.diagnoses", "api.campaigns"):  # whose examples ask again for what made `found`
        monkeypatch.setattr("wheelchair_fmu.api.diagnoses.searched", lambda *_: (found._found, found._told))
    done = doctest.testmod(import_module(f"wheelchair_fmu.{module}"), extraglobs=known, raise_on_error=False)
    assert done.attempted and not done.failed
