"""One recording written as different loggers write it. Each writer gets a path and a frame with headers `name [unit]`."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pandas as pd

START = datetime(2026, 11, 23, 14, 5, 7, 125000)


def names(frame: pd.DataFrame) -> list[str]:
    return [header.split(" [")[0] for header in frame.columns]


def units(frame: pd.DataFrame) -> list[str]:
    return [header.split("[")[1][:-1] for header in frame.columns]


def cells(frame: pd.DataFrame) -> list[list[str]]:
    return [[f"{value:.10g}" for value in row] for row in frame.to_numpy()]


def german(path: Path, frame: pd.DataFrame) -> None:
    """cp1252, semicolons, decimal commas, a preamble, a row of units."""
    head = ["Prüfling: Rollstuhl Ä;;", "Messrate;100", "", ";".join(names(frame)), ";".join(units(frame))]
    rows = [";".join(row).replace(".", ",") for row in cells(frame)]
    path.write_bytes("\r\n".join([*head, *rows, ""]).encode("cp1252"))


def utf16(path: Path, frame: pd.DataFrame) -> None:
    """UTF-16 with tabs, as Excel exports Unicode text, and units in parentheses."""
    head = "\t".join(f"{name} ({unit})" for name, unit in zip(names(frame), units(frame), strict=True))
    path.write_bytes("\r\n".join([head, *("\t".join(row) for row in cells(frame))]).encode("utf-16"))


def iso(path: Path, frame: pd.DataFrame) -> None:
    """Stamps of ISO 8601 with a zone."""
    stamps = [(START + timedelta(seconds=t)).isoformat(timespec="microseconds") + "+01:00" for t in frame.iloc[:, 0]]
    head = ",".join(["timestamp", *frame.columns[1:]])
    path.write_text("\n".join([head, *(",".join([s, *row[1:]]) for s, row in zip(stamps, cells(frame), strict=True))]))


def local(path: Path, frame: pd.DataFrame) -> None:
    """Local stamps, date and time of day in columns of their own, and a remark in a column of text."""
    moments = [START + timedelta(seconds=t) for t in frame.iloc[:, 0]]
    head = ";".join(["Datum", "Uhrzeit", *frame.columns[1:], "Bemerkung"])
    numbers = [";".join(row[1:]).replace(".", ",") for row in cells(frame)]
    rows = [
        f"{m:%d.%m.%Y};{m:%H:%M:%S,%f};{row};{'gut' if i % 2 else ''}"
        for i, (m, row) in enumerate(zip(moments, numbers, strict=True))
    ]
    path.write_bytes("\n".join([head, *rows]).encode("utf-8-sig"))


def midnight(path: Path, frame: pd.DataFrame) -> None:
    """Milliseconds since midnight, which the recording crosses."""
    ms = (frame.iloc[:, 0] * 1e3 + 86.4e6 - 5e3) % 86.4e6
    head = ",".join(["time since midnight [ms]", *frame.columns[1:]])
    rows = [",".join([f"{t:.3f}", *row[1:]]) for t, row in zip(ms, cells(frame), strict=True)]
    path.write_text("\n".join([head, *rows]))


def parquet(path: Path, frame: pd.DataFrame) -> None:
    """Timestamps, and units in the metadata of the fields."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    moments = pd.Timestamp(START) + pd.to_timedelta((frame.iloc[:, 0] * 1e9).round().astype("int64"), unit="ns")
    arrays = [pa.array(moments), *(pa.array(frame.iloc[:, i]) for i in range(1, frame.shape[1]))]
    fields = [pa.field("timestamp", arrays[0].type)]
    for name, unit in list(zip(names(frame), units(frame), strict=True))[1:]:
        fields.append(pa.field(name, pa.float64(), metadata={"unit": unit}))
    pq.write_table(pa.Table.from_arrays(arrays, schema=pa.schema(fields)), path)


def sheet(path: Path, frame: pd.DataFrame, engine: str) -> None:
    """A title, a header, a row of units; a second sheet with remarks."""
    top = [["Messung 7"] + [None] * (frame.shape[1] - 1), names(frame), units(frame)]
    grid = pd.DataFrame([*top, *frame.to_numpy().tolist()])
    with pd.ExcelWriter(path, engine=engine) as book:
        grid.to_excel(book, sheet_name="Messung", header=False, index=False)
        pd.DataFrame([["Wer", "Anna"], ["Wo", "Halle"]]).to_excel(book, sheet_name="Info", header=False, index=False)


def xlsx(path: Path, frame: pd.DataFrame) -> None:
    sheet(path, frame, "openpyxl")


def ods(path: Path, frame: pd.DataFrame) -> None:
    sheet(path, frame, "odf")


def mat_5(path: Path, frame: pd.DataFrame) -> None:
    """A structure with time, data, names and units."""
    import scipy.io

    rec = {
        "time": frame.iloc[:, [0]].to_numpy(),
        "data": frame.iloc[:, 1:].to_numpy(),
        "names": np.array(names(frame)[1:], dtype=object),
        "units": np.array(units(frame)[1:], dtype=object),
    }
    scipy.io.savemat(path, {"rec": rec})


def mat_73(path: Path, frame: pd.DataFrame) -> None:
    """HDF5 as MATLAB writes it, a vector for each channel in a structure."""
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        group = file.create_group("rec")
        group.attrs["MATLAB_class"] = np.bytes_("struct")
        for name, unit, (_, series) in zip(names(frame), units(frame), frame.items(), strict=True):
            ending = {"s": "_s", "m/s": "_mps", "m/s2": "_mps2", "rad/s": "_radps", "N": "_N"}[unit]
            group.create_dataset(name + ending, data=series.to_numpy()[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512, b" "))


def mf4(path: Path, frame: pd.DataFrame) -> None:
    from asammdf import MDF, Signal

    time = frame.iloc[:, 0].to_numpy()
    with MDF() as mdf:
        mdf.append(
            [
                Signal(frame.iloc[:, i].to_numpy(), time, name=names(frame)[i], unit=units(frame)[i])
                for i in range(1, frame.shape[1])
            ]
        )
        mdf.save(path, overwrite=True)


WRITERS = {
    "german.csv": german,
    "utf16.txt": utf16,
    "iso.csv": iso,
    "local.csv": local,
    "midnight.csv": midnight,
    "a.parquet": parquet,
    "a.xlsx": xlsx,
    "a.ods": ods,
    "v5.mat": mat_5,
    "v73.mat": mat_73,
    "a.mf4": mf4,
}


def trc(path: Path, rate: float, markers: dict[str, np.ndarray]) -> None:
    """Markers (n, 3) in mm by name, NaN where hidden."""
    n = len(next(iter(markers.values())))
    lines = [
        "PathFileType\t4\t(X/Y/Z)\trun.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
        f"{rate:g}\t{rate:g}\t{n}\t{len(markers)}\tmm\t{rate:g}\t1\t{n}",
        "Frame#\tTime\t" + "\t\t\t".join(markers) + "\t\t",
        "\t\t" + "\t".join(f"{axis}{k + 1}" for k in range(len(markers)) for axis in "XYZ"),
    ]
    for i in range(n):
        values = np.concatenate([marker[i] for marker in markers.values()])
        lines.append("\t".join([str(i + 1), f"{i / rate:.4f}", *("" if np.isnan(v) else f"{v:.3f}" for v in values)]))
    path.write_text("\n".join(lines) + "\n")


def vicon(path: Path, rate: float, markers: dict[str, np.ndarray]) -> None:
    """The same as Vicon Nexus writes it, with empty lines and another section behind."""
    lines = [
        "Trajectories",
        f"{rate:g}",
        ",,P1:" + ",,,P1:".join(markers) + ",,",
        "Frame,Sub Frame," + ",".join("XYZ" * len(markers)),
        ",," + ",".join(["mm"] * 3 * len(markers)),
    ]
    for i in range(len(next(iter(markers.values())))):
        values = np.concatenate([marker[i] for marker in markers.values()])
        lines.append(",".join([str(i + 1), "0", *("" if np.isnan(v) else f"{v:.3f}" for v in values)]))
    path.write_text("\n".join([*lines, "", "Devices", "1000", ",,Plate", "Frame,Sub Frame,Fx", ",,N", "1,0,3.5"]) + "\n")


def c3d(path: Path, rate: float, markers: dict[str, np.ndarray]) -> None:
    import ezc3d

    file = ezc3d.c3d()
    points = np.stack([marker.T for marker in markers.values()], axis=1)
    file["parameters"]["POINT"]["RATE"]["value"] = [rate]
    file["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    file["parameters"]["POINT"]["LABELS"]["value"] = list(markers)
    file["data"]["points"] = np.concatenate([points, np.ones((1, *points.shape[1:]))])
    file.write(str(path))


def optipush(path: Path, torque: np.ndarray, angle: np.ndarray) -> None:
    head = [
        "%  Name/ID : S01 ",
        "%  Wheel Size :24 in/540mm",
        "% Comment : ",
        "%%%%%",
        "%Time(s) \tPush Start \tPush End \tFx \tFy \tFz \tTx \tTy \tTz \tAngle ",
    ]
    rows = [
        f"{i / 200:.3f}\t0\t0\t1.5\t-0.5\t0.1\t0.0\t0.1\t{m:.5f}\t{a:.4f}"
        for i, (m, a) in enumerate(zip(torque, angle, strict=True))
    ]
    path.write_text("\n".join([*head, *rows]) + "\n")


def smartwheel(path: Path, moment: np.ndarray, angle: np.ndarray) -> None:
    rows = [
        f"{i},{i},0,{a:.2f}," + "0," * 14 + f"0.1,0.2,0.3,0.4,0.5,{m:.4f},"
        for i, (m, a) in enumerate(zip(moment, angle, strict=True), 1)
    ]
    path.write_text("\n".join(rows) + "\n")
