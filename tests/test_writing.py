"""Files are whole or not there."""

from __future__ import annotations

import pytest

from wheelchair_fmu.writing import written


def test_what_fails_half_way_leaves_what_was_there(tmp_path):
    path = tmp_path / "result.json"
    path.write_text("before")
    with pytest.raises(ZeroDivisionError), written(path) as beside:
        beside.write_text("half")
        _ = 1 / 0
    assert path.read_text() == "before"
    assert [p.name for p in tmp_path.iterdir()] == ["result.json"]


def test_an_error_names_the_file_that_was_asked_for(tmp_path):
    folder = tmp_path / "folder.json"
    folder.mkdir()
    with pytest.raises(IsADirectoryError) as met, written(folder) as beside:
        beside.write_text("all")
    assert met.value.filename == str(folder)
    assert list(tmp_path.iterdir()) == [folder]
    with pytest.raises(OSError) as met, written(tmp_path / "no" / "x.json") as beside:
        beside.parent.rmdir()
        beside.write_text("all")
    assert met.value.filename == str(tmp_path / "no" / "x.json")
