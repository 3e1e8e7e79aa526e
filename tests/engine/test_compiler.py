"""How compiled kernels are told apart."""

from __future__ import annotations

from wheelchair_fmu.engine import compiler


def test_flags_of_a_compiler_make_it_another(monkeypatch):
    plain = compiler.version.__wrapped__()
    compiler.command.cache_clear()
    monkeypatch.setenv("CC", " ".join((*compiler.command(), "-O1")))
    compiler.command.cache_clear()
    try:
        assert compiler.version.__wrapped__() != plain
    finally:
        compiler.command.cache_clear()
