"""FMU Manipulation Toolbox:  python drive_toolbox.py FMU CoSimulation INPUTS RESULTS

It wraps the FMU into one of its own (a container), which FMPy runs. Prints as drive_fmpy.py.
"""

import json
import shutil
import sys
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy
import numpy as np
from fmu_manipulation_toolbox.assembly import Assembly

fmu, _, inputs, results = sys.argv[1:]
given, expected = (np.genfromtxt(path, delimiter=",", names=True, deletechars="") for path in (inputs, results))
outputs = [name for name in expected.dtype.names if name != "time"]
with TemporaryDirectory() as folder:
    shutil.copy(fmu, Path(folder) / "chair.fmu")
    (Path(folder) / "wrapped.json").write_text(json.dumps({"name": "wrapped.fmu", "step_size": 0.01, "fmu": ["chair.fmu"]}))
    Assembly("wrapped.json", fmu_directory=Path(folder)).make_fmu(fmi_version=2)
    made, end = str(Path(folder) / "wrapped.fmu"), expected["time"][-1]
    run = fmpy.simulate_fmu(made, stop_time=end, output_interval=0.01, input=given, output=outputs)
print(
    json.dumps(
        {
            "tool": "FMU Manipulation Toolbox",
            "version": version("fmu-manipulation-toolbox"),
            "end": {name: float(run[name][-1]) for name in outputs},
        }
    )
)
