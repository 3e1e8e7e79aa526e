"""CoFMUPy:  python drive_cofmupy.py FMU CoSimulation INPUTS RESULTS [two]

With `two`, as drive_libcosimpy.py. Prints as drive_fmpy.py.
"""

import json
import sys
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory

import pandas as pd
from cofmupy import Coordinator

fmu, _, inputs, results, *coupled = sys.argv[1:]
start = {"floor.rolling_factor": 1.0}  # CoFMUPy starts inputs at 0, whatever their start value
fmus = [{"id": "chair", "path": fmu, "initialization": start}]


def connection(source: dict, target: str, push: str) -> dict:
    return {"source": source, "target": [{"type": "fmu", "id": target, "variable": push}]}


with TemporaryDirectory() as folder:
    if coupled:
        fmus.append({"id": "second", "path": fmu, "initialization": start})
        needed = {"type": "fmu", "id": "chair", "variable": "push.total_needed"}
        connections = [connection(needed, "second", push) for push in ("push.F_rl", "push.F_rr")]
        names, watched, steps = ["chair.u", "chair.x"], "second", 300
    else:
        table = pd.read_csv(inputs).rename(columns={"time": "t"})
        table["t"] -= 1e-6  # CoFMUPy adds up its steps, and rounding would make it read the sample before
        stream = Path(folder) / "inputs.csv"
        table.to_csv(stream, index=False)
        held = {"type": "csv", "path": str(stream), "interpolation": "previous"}
        connections = [connection({**held, "variable": push}, "chair", push) for push in table.columns if push != "t"]
        names, watched, steps = [n for n in pd.read_csv(results).columns if n != "time"], "chair", len(table) - 1
    coordinator = Coordinator()
    coordinator.start(
        {
            "root": "",
            "fmus": fmus,
            "connections": connections,
            "cosim_method": "jacobi",
            "edge_sep": " -> ",
            "iterative": False,
            "data_storages": [],
        }
    )
    for _ in range(steps):
        coordinator.do_step(0.01)
    found = coordinator.get_results()
end = {name: float(found[(watched, name)][-1]) for name in names}
print(json.dumps({"tool": "CoFMUPy", "version": version("cofmupy"), "end": end}))
