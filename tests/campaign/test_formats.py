"""Formats that are read by libraries, and SMARTWheel files."""

from __future__ import annotations

import sys
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.campaign import check, read, read_smartwheel
from wheelchair_fmu.errors import CampaignError, UsageError

from .small import RUNS, SI, motion


def test_missing_libraries_say_what_to_install(campaign, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setitem(sys.modules, "asammdf", None)
    runs = RUNS.replace("a.csv", "a.parquet").replace("b.csv", "b.mf4")
    assert [str(f) for f in check(campaign(runs=runs, files={"a.parquet": b"", "b.mf4": b""}))] == [
        "run a.parquet: .parquet files need the library pyarrow, which is not installed; "
        "pip install pyarrow, or export the file as CSV",
        "run b.mf4: .mf4 files need the library asammdf, which is not installed; "
        "pip install asammdf, or export the file as CSV",
    ]


def test_parquet(campaign):
    pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    folder = campaign(runs=RUNS.replace("a.csv", "a.parquet"))
    pd.DataFrame(motion(), columns=list(SI)).to_parquet(folder / "a.parquet")
    np.testing.assert_allclose(read(folder).runs[0].channels["a_y"], motion()[:, 6])


class _Mdf:
    """As much of asammdf.MDF as is used."""

    def __init__(self, path: str):
        if path.endswith("bad.mf4"):
            raise RuntimeError("not a valid\nMDF file")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    def to_dataframe(self, use_interpolation):
        data = motion()
        return pd.DataFrame(data[:, 1:], columns=[h.split()[0] for h in SI[1:]], index=data[:, 0])

    def get(self, name):
        return SimpleNamespace(unit=next(h for h in SI if h.startswith(name)).split("[")[1][:-1])


def test_mdf_by_asammdf(campaign, monkeypatch):
    monkeypatch.setitem(sys.modules, "asammdf", SimpleNamespace(MDF=_Mdf))
    folder = campaign(runs=RUNS.replace("a.csv", "a.mf4"), files={"a.mf4": b""})
    assert check(folder) == []
    np.testing.assert_allclose(read(folder).runs[0].channels["a_y"], motion()[:, 6])
    folder = campaign(runs=RUNS.replace("a.csv", "bad.mf4"), files={"bad.mf4": b"MDF"})
    assert [str(f) for f in check(folder)] == [
        "run bad.mf4: asammdf cannot read the file: not a valid MDF file; export it again"
    ]


def smartwheel(path, moment):
    data = np.zeros((len(moment), 25))
    data[:, 23] = moment
    np.savetxt(path, data, delimiter=",", fmt="%.5f")
    return path


def test_smartwheel_sides_and_rate(tmp_path):
    path = smartwheel(tmp_path / "wheel.txt", np.linspace(0, 6, 241))
    left, right = read_smartwheel(path, "l", 0.3), read_smartwheel(path, "r", 0.3)
    assert list(left) == ["time [s]", "M_rl [N.m]", "F_rl [N]"]
    assert left["time [s]"].iloc[-1] == 1.0
    assert left["F_rl [N]"].iloc[-1] == pytest.approx(20.0)
    np.testing.assert_allclose(right["M_rr [N.m]"], -left["M_rl [N.m]"])


def test_smartwheel_refusals(tmp_path):
    path = tmp_path / "no.txt"
    path.write_text("a,b\n1,2\n")
    with pytest.raises(UsageError, match="a SMARTWheel has no side 'left'; use 'l' or 'r'"):
        read_smartwheel(path, "left", 0.3)
    with pytest.raises(UsageError, match=r"radius 0\.0 m is not positive; give the radius of the wheel in m"):
        read_smartwheel(path, "l", 0.0)
    with pytest.raises(CampaignError, match=r"run no\.txt: not a SMARTWheel file"):
        read_smartwheel(path, "l", 0.3)


def test_smartwheel_in_a_campaign(campaign):
    wheel = 'format = "smartwheel"\nside = "l"\nradius = 0.3\nconstant = { F_rr = 0.0, u = 1.0 }\n'
    runs = RUNS.replace("a.csv", "a.txt").replace("u0 = 1.0\n", "u0 = 1.0\n" + wheel, 1)
    folder = campaign(runs=runs)
    smartwheel(folder / "a.txt", np.linspace(0, 6, 241))
    errors = [str(f) for f in check(folder) if f.severity == "error"]
    assert errors == [
        "campaign.toml line 6: the noise of u is not given and cannot be estimated from its samples; "
        "write [noise] u = ... , or remove the channel"
    ]
    text = (folder / "campaign.toml").read_text().replace("[noise]\n", "[noise]\nu = 0.01\n")
    (folder / "campaign.toml").write_text(text)
    assert read(folder).runs[0].inputs["push.F_rl"][-1] == pytest.approx(20.0)
    (folder / "campaign.toml").write_text(text.replace('side = "l"', 'side = "left"'))
    assert [str(f) for f in check(folder)][:1] == [
        "run a.txt: a SMARTWheel has no side 'left'; use 'l' or 'r', as side and radius of the run"
    ]
