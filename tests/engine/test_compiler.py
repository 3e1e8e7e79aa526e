"""How compiled kernels are told apart."""

from __future__ import annotations

import pytest

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.errors import BuildError


def test_flags_of_a_compiler_make_it_another(monkeypatch):
    plain = compiler.version.__wrapped__()
    compiler.command.cache_clear()
    monkeypatch.setenv("CC", " ".join((*compiler.command(), "-O1")))
    compiler.command.cache_clear()
    try:
        assert compiler.version.__wrapped__() != plain
    finally:
        compiler.command.cache_clear()


@pytest.mark.parametrize(("cc", "says"), [("false", "the C compiler failed; set CC to another"),
                                          ("no-such-compiler", "set CC to one that runs")])  # fmt: skip
def test_a_compiler_that_does_not_work_is_an_error_with_a_cure(monkeypatch, cc, says):
    monkeypatch.setenv("CC", cc)
    compiler.command.cache_clear()
    try:
        with pytest.raises(BuildError, match=says):
            compiler.version.__wrapped__()
    finally:
        compiler.command.cache_clear()
