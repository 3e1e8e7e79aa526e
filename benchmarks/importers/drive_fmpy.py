"""FMPy, Co-Simulation and Model Exchange:  python drive_fmpy.py FMU INTERFACE INPUTS RESULTS

Prints what it got at the last time of RESULTS, as JSON: {"tool", "version", "end": {name: value}}.
"""

import json
import sys

import fmpy
import numpy as np

fmu, interface, inputs, results = sys.argv[1:]
given, expected = (np.genfromtxt(path, delimiter=",", names=True, deletechars="") for path in (inputs, results))
if interface == "ModelExchange":  # between two samples FMPy's CVode takes them as linear; each is made a step
    given = np.repeat(given, 2)[:-1]
    given["time"][1::2] = given["time"][2::2]
outputs = [name for name in expected.dtype.names if name != "time"]
run = fmpy.simulate_fmu(
    fmu,
    fmi_type=interface,
    stop_time=expected["time"][-1],
    output_interval=0.01,
    input=given,
    output=outputs,
    relative_tolerance=1e-9 if interface == "ModelExchange" else None,
)
print(json.dumps({"tool": "FMPy", "version": fmpy.__version__, "end": {name: float(run[name][-1]) for name in outputs}}))
