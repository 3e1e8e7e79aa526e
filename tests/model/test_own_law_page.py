"""docs/your-own-law.md: its two files do what it says."""

from __future__ import annotations

import shutil
import zipfile

import pytest

from tests.pages import attempt, its_test_passes, run, with_example

PAGE = "your-own-law.md"


def test_the_page_s_law_passes_the_page_s_test(tmp_path):
    its_test_passes(PAGE, tmp_path)


@pytest.mark.nightly
def test_the_fmu_has_it(tmp_path):
    its_test_passes(PAGE, tmp_path)
    slalom = ("-m", "wheelchair_fmu", "simulate", "slalom", "--set", "tyre.law=brush")
    assert "out/slalom.csv" in run(tmp_path, *slalom)


@pytest.mark.nightly
def test_the_python_fmu_has_it_where_nobody_else_does(tmp_path):
    with_example(PAGE, tmp_path)
    run(tmp_path, "-m", "wheelchair_fmu", "build", "--flavour", "python", "-o", "own.fmu")
    with zipfile.ZipFile(tmp_path / "own.fmu") as archive:
        assert any(name.endswith("model/tyre/brush.py") for name in archive.namelist())
    shutil.rmtree(tmp_path / "config")
    drive = (
        "from fmpy import simulate_fmu; "
        "print(simulate_fmu('own.fmu', start_values={'tyre.law': 4, 'start.u': 1.0}, stop_time=0.1))"
    )
    assert "nan" not in run(tmp_path, "-c", drive)


def test_every_file_that_is_no_law_is_told_in_a_sentence(tmp_path):
    laws = tmp_path / "config" / "laws" / "tyre"
    laws.mkdir(parents=True)
    (laws / "empty.py").write_text("")
    (laws / "_notes.py").write_text("this is no Python")
    (laws / "broken.py").write_text("\n1 / 0\n")
    done = attempt(tmp_path, "-m", "wheelchair_fmu", "effects", "list")
    told = done.stderr.splitlines()
    assert done.returncode == 1 and len(told) == 2, done.stderr
    assert "broken.py:2: cannot be read: ZeroDivisionError: division by zero; mend this line, or move the file away" in told[0]
    assert 'no Alternative("empty", ...) in it; write LAW = Alternative("empty", ...)' in told[1]
    (laws / "dugoff.py").write_text("")
    done = attempt(tmp_path, "-m", "wheelchair_fmu", "effects", "list")
    assert (
        done.returncode == 1 and "there is a bundled 'dugoff' already; give the file and its record another name" in done.stderr
    )


@pytest.mark.parametrize(
    "line", ["from .shares import share", "from . import shares", "import wheelchair_fmu.model.tyre.shares"]
)
def test_a_law_that_reads_a_file_beside_it_is_refused(tmp_path, line):
    with_example(PAGE, tmp_path)
    laws = tmp_path / "config" / "laws" / "tyre"
    (laws / "shares.py").write_text(
        'from ..stage import Alternative\n\nLAW = Alternative("shares", ())\n\n\ndef share(x):\n    return x\n'
    )
    brush = (laws / "brush.py").read_text(encoding="utf-8")
    (laws / "brush.py").write_text(
        brush.replace("import casadi as cs\n", f"import casadi as cs\n\n{line}\n", 1), encoding="utf-8"
    )
    done = attempt(tmp_path, "-m", "wheelchair_fmu", "laws", "list")
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done.stderr
    assert "brush.py:7: reads shares.py beside it" in done.stderr and "write into brush.py what it needs" in done.stderr
