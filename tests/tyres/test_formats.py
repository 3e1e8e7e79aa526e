"""CSV, TYDEX 1.3 and .tir, generated and written by hand, and what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.errors import Failure, FileError, UsageError
from wheelchair_fmu.tyres import identify, read
from wheelchair_fmu.tyres.magic_formula import FORCE, TORQUE
from wheelchair_fmu.tyres.mf52 import Mf52
from wheelchair_fmu.tyres.records import CAMBER, SLIP

from .rig import Tyre

ROTATING_DISC = Path(__file__).parents[2] / "examples" / "rotating-disc.csv"
HEADER = ROTATING_DISC.read_text(encoding="utf-8").partition("\n")[0]


def written(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def csv_of(sweep, header=HEADER, scale=(1.0, 1.0, 3.6), separator=","):
    rows = [separator.join(header.split(","))]
    for x, F, M in zip(np.degrees(sweep.angle), sweep.force, sweep.torque, strict=True):
        slip, camber = (x, 0.0) if sweep.kind == SLIP else (0.0, x)
        c = sweep.condition
        numbers = (scale[0] * c.pressure, scale[1] * c.load, scale[2] * c.speed, slip, camber, F, M)
        rows.append(separator.join([c.tyre, sweep.kind, *(f"{v:.10g}" for v in numbers)]))
    return "\n".join(rows) + "\n"


def faults(path, **more):
    with pytest.raises(FileError) as raised:
        read(path, **more)
    return [str(f) for f in raised.value.faults]


# ── CSV ──


def test_the_rotating_disc_file_is_read_whole():
    measured = read(ROTATING_DISC)
    assert len(measured.sweeps) == 16 and measured.warnings == ()
    assert sum(len(s.angle) for s in measured.sweeps) == 368 - 16  # the zero angles belong to no sweep
    first = measured.sweeps[0]
    assert (first.condition.tyre, first.condition.pressure, first.condition.load) == ("A", 4.0, 400.0)
    assert first.condition.speed == pytest.approx(4 / 3.6)
    assert first.angle[0] == pytest.approx(np.radians(-5)) and first.force[0] == -327.56


def test_other_units_and_separators_give_the_same(tmp_path):
    sweep = Tyre().sweep()
    header = HEADER.replace("[bar]", "[kPa]").replace("load [N]", "load [kN]").replace("[km/h]", "[m/s]")
    text = csv_of(sweep, header, (100.0, 1e-3, 1.0), ";").replace(".", ",").replace("N,m", "N.m")
    (read_back,) = read(written(tmp_path / "r.csv", text)).sweeps
    keep = np.abs(sweep.angle) > 0
    assert read_back.condition.pressure == pytest.approx(4) and read_back.condition.load == pytest.approx(400)
    assert np.allclose(read_back.force, sweep.force[keep]) and np.allclose(read_back.angle, sweep.angle[keep])


def test_iso_axes_are_turned(tmp_path):
    sweep = Tyre().sweep()
    other = type(sweep)(sweep.condition, sweep.kind, sweep.angle, -sweep.force, -sweep.torque)
    (turned,) = read(written(tmp_path / "r.csv", csv_of(other)), axes="iso").sweeps
    assert np.allclose(turned.force, sweep.force[np.abs(sweep.angle) > 0])


def test_settings_that_wander_a_little_are_one_condition(tmp_path):
    lines = csv_of(Tyre().sweep()).splitlines()
    rng = np.random.default_rng(0)
    wandering = [line.replace(",400,", f",{400 + rng.uniform(-3, 3):.2f},") for line in lines[1:]]
    assert len(read(written(tmp_path / "r.csv", "\n".join([lines[0], *wandering]))).sweeps) == 1


def test_all_faults_of_a_csv_come_together(tmp_path):
    lines = csv_of(Tyre().sweep()).splitlines()
    lines[3] = lines[3].replace(",400,", ",-400,")
    cells = lines[5].split(",")
    cells[7] = "soft"
    lines[5] = ",".join(cells)
    cells = lines[7].split(",")
    cells[1] = "steering"
    cells[8] = ""
    lines[7] = ",".join(cells)
    found = faults(written(tmp_path / "r.csv", "\n".join(lines)))
    assert found == [
        "r.csv line 6 column 'lateral_force [N]': 'soft' is not a number; write a number, or leave the cell empty for a gap",
        "r.csv line 8 column 'test': 'steering' is no test; write 'side slip' or 'camber'",
        "r.csv line 4 column 'load [N]': -400 N is not plausible; give the vertical load as a positive force, with its unit, "
        "such as [N]",
        "r.csv line 8 column 'yaw_torque [N.m]': the cell is empty; write the value, or remove the row",
    ]


def test_columns_that_are_missing_or_in_wrong_units_come_together(tmp_path):
    text = csv_of(Tyre().sweep()).replace("pressure [bar]", "temperature [degC]").replace("load [N]", "load [kg]")
    found = faults(written(tmp_path / "r.csv", text))
    assert any("no column 'pressure'; add one named 'pressure [bar]'" in f for f in found)
    assert any("column 'load [kg]'" in f and "a mass" in f for f in found)
    assert len(found) == 2


def test_radians_called_degrees_are_noticed(tmp_path):
    text = csv_of(Tyre().sweep()).replace("slip_angle [deg]", "slip_angle [rad]")
    found = faults(written(tmp_path / "r.csv", text))
    assert any("is not plausible; is the unit [deg]?" in f for f in found)


def test_combined_rows_and_strange_columns_are_warned_of(tmp_path):
    text = csv_of(Tyre().sweep()).replace(HEADER, HEADER + ",remark")
    text = "\n".join(line + ",x" if i else line for i, line in enumerate(text.splitlines()))
    text += "\nT,side slip,4,400,4,2,3,100,1,x\n"
    said = [str(w) for w in read(written(tmp_path / "r.csv", text)).warnings]
    assert any("column 'remark': the column is not used" in w for w in said)
    assert any("1 rows have slip and camber at once" in w for w in said)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "the file is empty"),
        (b"a,b\n", "a header but no rows"),
        (b"\xff\xfe1", "a header but no rows"),
        (b"a,b\n1,2\n", "no column 'load'"),
    ],
)
def test_files_that_are_none(content, message, tmp_path):
    (tmp_path / "r.csv").write_bytes(content)
    assert any(message in f for f in faults(tmp_path / "r.csv"))


def test_only_zero_angles(tmp_path):
    head, *rows = csv_of(Tyre().sweep()).splitlines()
    zero = next(r for r in rows if r.split(",")[5] == "0")
    with pytest.raises(Failure, match="no row has a slip or a camber angle other than zero"):
        read(written(tmp_path / "r.csv", f"{head}\n{zero}\n"))


def test_an_unknown_ending_is_refused(tmp_path):
    with pytest.raises(UsageError, match=r"'\.xls'"):
        read(written(tmp_path / "r.xls", "x"))
    with pytest.raises(Failure, match="no such file"):
        read(tmp_path / "none.csv")


# ── TYDEX ──

BY_HAND = """\
**HEADER
RELEASE   Release of TYDEX-Format                   1.3
**CONSTANTS
! a comment
IDENTITY  Identity of the tyre                      HAND
INFLPRES  Inflation pressure              kPa       400
INCLANGL  Inclination angle               deg       0
**MEASURCHANNELS
MEASNUMB  Number of the measurement       -         1         0         0
LONGVEL   Longitudinal velocity           km/h      1         0         0
SLIPANGL  Slip angle                      deg       0.5       0         0
FZW       Vertical force                  N         1         0         0
FYW       Lateral force                   kN        -1        0         0
MZW       Aligning torque                 Nm        0.1       0         0.2
**MEASURDATA
1 4 -4.0 400 0.170 -14
2 4 -2.0 400 0.085 -8
3 4  2.0 400 -0.086 6
4 4  4.0 400 -0.169 12
**END
"""


def tydex_of(sweep):
    """The same measurements as a TYDEX file in ISO's axes."""

    def line(name, meaning, unit, *values):
        return f"{name:<10}{meaning:<32}{unit:<10}" + "".join(f"{v:<10}" for v in values)

    c = sweep.condition
    slip, camber = ("SLIPANGL", "INCLANGL") if sweep.kind == SLIP else ("INCLANGL", "SLIPANGL")
    out = [
        "**HEADER",
        line("RELEASE", "Release", "", "1.3"),
        "**CONSTANTS",
        line("IDENTITY", "Tyre", "", c.tyre),
        line("INFLPRES", "Inflation pressure", "bar", c.pressure),
        line("FZW", "Load", "N", c.load),
        line("LONGVEL", "Speed", "m/s", c.speed),
        line(camber, "held", "deg", 0),
        "**MEASURCHANNELS",
        *(line(n, n, u, 1, 0, 0) for n, u in ((slip, "rad"), ("FYW", "N"), ("MZW", "Nm"))),
        "**MEASURDATA",
    ]
    out += [f"{x:.9g} {-F:.9g} {-M:.9g}" for x, F, M in zip(sweep.angle, sweep.force, sweep.torque, strict=True)]
    return "\n".join([*out, "**END"]) + "\n"


def test_a_tydex_file_written_by_hand(tmp_path):
    (sweep,) = read(written(tmp_path / "hand.tdx", BY_HAND)).sweeps
    assert sweep.condition.tyre == "HAND" and sweep.condition.pressure == pytest.approx(4.0)
    assert sweep.condition.load == 400 and sweep.condition.speed == pytest.approx(4 / 3.6)
    assert np.degrees(sweep.angle) == pytest.approx([-2, -1, 1, 2])
    assert sweep.force == pytest.approx([170, 85, -86, -169])  # twice negative: ISO's axes and the channel's factor
    assert sweep.torque == pytest.approx([1.2, 0.6, -0.8, -1.4])


@pytest.mark.parametrize("kind", [SLIP, CAMBER])
def test_a_generated_tydex_file_gives_the_laws_of_the_sweep(kind, tmp_path):
    sweep = Tyre().sweep(kind)
    again = identify(read(written(tmp_path / "g.tdx", tydex_of(sweep))).sweeps).conditions[0]
    direct = identify([sweep]).conditions[0]
    for channel in (FORCE, TORQUE):
        assert again.K(kind, channel).value == pytest.approx(direct.K(kind, channel).value, rel=1e-6)


def test_all_faults_of_a_tydex_file_come_together(tmp_path):
    text = BY_HAND.replace("kPa ", "qqq ").replace("3 4  2.0 400", "3 4  2.0").replace("0.085", "soft")
    text = text.replace("FZW ", "FZX ").replace("km/h      1   ", "km/h      one ")
    found = faults(written(tmp_path / "hand.tdx", text))
    assert [f.partition(": ")[2].partition(";")[0] for f in found] == [
        "'soft' is not a number",
        "5 numbers, but 6 channels are defined",
        "unit 'qqq' is unknown",
        "no FZW or FZH or FZC among channels and constants",
        "'one       0         0' is no number",
    ]
    assert "line 17" in found[0] and "line 18" in found[1] and "line 6" in found[2] and "line 10" in found[4]
    assert faults(written(tmp_path / "none.tdx", "hello\n")) == [
        "none.tdx: no block **MEASURCHANNELS; is it a TYDEX 1.3 file with measurements?",
        "none.tdx: no block **MEASURDATA; is it a TYDEX 1.3 file with measurements?",
    ]


# ── .tir ──

TIR = """\
$ a tyre written by hand
[UNITS]
LENGTH = 'meter'
FORCE = 'newton'
ANGLE = 'radians'
[MODEL]
PROPERTY_FILE_FORMAT = 'PAC2002'
LONGVL = 1.0    $ speed
[DIMENSION]
UNLOADED_RADIUS = 0.3
[SHAPE]
{radial width}
 1.0 0.0
 1.0 0.4
[VERTICAL]
FNOMIN = 500
[LATERAL_COEFFICIENTS]
PCY1 = 1.4
PDY1 = 1.0 $ mu
PEY1 = -0.5
PKY1 = -14.0
PKY2 = 2.0
PVY3 = -1.2
[ALIGNING_COEFFICIENTS]
QBZ1 = 12
QCZ1 = 1.1
QDZ1 = 0.05
QEZ1 = -1.0
"""


def test_a_tir_file_written_by_hand(tmp_path):
    measured = read(written(tmp_path / "hand.tir", TIR))
    assert "no inflation pressure given, 4 bar assumed" in str(measured.warnings[0])
    found = identify(measured.sweeps)
    fit = next(f for f in found.conditions if f.condition.load == 500)
    # Closed forms: K = PKY1 F_z0 sin(2 atan(1/PKY2)), trail at zero slip QDZ1 R0, camber stiffness PVY3 F_z0.
    K = 14.0 * 500 * np.sin(2 * np.arctan(0.5))
    assert fit.K(SLIP, FORCE).value == pytest.approx(K, rel=2e-3)
    assert fit.K(SLIP, TORQUE).value == pytest.approx(-K * 0.05 * 0.3, rel=2e-2)
    assert fit.K(CAMBER, FORCE).value == pytest.approx(600, rel=1e-6)
    assert {f.condition.load for f in found.conditions} == {375, 500, 750}


@pytest.mark.parametrize(
    ("pressure", "told"),
    [
        ("0", "0 is not positive; give it in Pa"),
        ("hard", "'hard' is not a number; write a number"),
        ("nan", "nan is not finite; write a number"),
    ],
)
def test_a_tir_file_of_a_flat_tyre_is_refused(tmp_path, pressure, told):
    """A pressure of nothing is no pressure that was left out."""
    text = TIR.replace("FNOMIN = 500\n", f"FNOMIN = 500\nINFLPRES = {pressure}\n")
    line = text.split("\n").index(f"INFLPRES = {pressure}") + 1
    assert faults(written(tmp_path / "flat.tir", text)) == [f"flat.tir line {line} column 'INFLPRES': {told}"]


def test_mf52_is_odd_without_shifts_and_its_slope_is_the_stiffness():
    tyre = Mf52(
        {
            "FNOMIN": 500,
            "UNLOADED_RADIUS": 0.3,
            "PCY1": 1.4,
            "PDY1": 1,
            "PKY1": -14,
            "PKY2": 2,
            "PKY3": 0.3,
            "QBZ1": 12,
            "QCZ1": 1.1,
            "QDZ1": 0.05,
        }
    )
    a, g, N = np.linspace(-0.2, 0.2, 41), np.zeros(41), np.full(41, 450.0)
    F, M = tyre.forces(a, g, N)
    assert np.allclose(F, -F[::-1]) and np.allclose(M, -M[::-1])
    h = np.array([1e-6])
    assert tyre.forces(h, 0 * h, 450 + 0 * h)[0] / h == pytest.approx(tyre.stiffness(450 + 0 * h, 0 * h), rel=1e-6)


def test_all_faults_of_a_tir_file_come_together(tmp_path):
    text = TIR.replace("PKY1 = -14.0", "PKY1 = steep").replace("'newton'", "'pound_force'").replace("FNOMIN = 500\n", "")
    text = text.replace("'PAC2002'", "'FTIRE'").replace("PEY1 = -0.5", "what is this").replace("QEZ1 = -1.0", "QDZ1 = 1")
    found = faults(written(tmp_path / "bad.tir", text))
    assert found == [
        "bad.tir line 19: 'what is this' is no entry; write KEY = value, or $ before a comment",
        "bad.tir line 27 column 'QDZ1': given already in line 26; keep one",
        "bad.tir line 20 column 'PKY1': 'steep' is not a number; write a number",
        "bad.tir line 4 column 'FORCE': unit 'pound_force' is not read; convert the file to newton",
        "bad.tir line 7 column 'PROPERTY_FILE_FORMAT': FTIRE is not MF 5.2; export it as PAC2002 or FITTYP = 6",
        "bad.tir: no FNOMIN; an MF 5.2 file has it; add it",
    ]
