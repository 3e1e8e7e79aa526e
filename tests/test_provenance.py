"""The code's fingerprint changes with any file of code, and with nothing else."""

from __future__ import annotations

from wheelchair_fmu import provenance


def test_code_counts_and_line_ends_do_not(tmp_path, monkeypatch):
    monkeypatch.setattr(provenance, "PACKAGE", tmp_path)
    (tmp_path / "engine").mkdir()
    file = tmp_path / "engine" / "a.c"

    def printed(content: bytes) -> str:
        file.write_bytes(content)
        provenance.code_fingerprint.cache_clear()
        return provenance.code_fingerprint()

    first = printed(b"one\ntwo\n")
    (tmp_path / "notes.txt").write_text("no code")
    assert printed(b"one\r\ntwo\r\n") == first != printed(b"one\nthree\n")
    provenance.code_fingerprint.cache_clear()
