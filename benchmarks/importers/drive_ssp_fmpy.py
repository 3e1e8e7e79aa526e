"""A system in FMPy:  python drive_ssp_fmpy.py SSP STOP STEP NAME…

Prints the NAMEs, each `Component.variable`, at STOP as JSON: {"tool", "version", "end": {name: value}}.
"""

import json
import sys

import fmpy
from fmpy.ssp.simulation import simulate_ssp

ssp, stop, step, *names = sys.argv[1:]
# A row holds the time before a step and the values after it; half a step less, so that rounding adds no step.
rows = simulate_ssp(ssp, stop_time=float(stop) - float(step) / 2, step_size=float(step))
print(json.dumps({"tool": "FMPy", "version": fmpy.__version__, "end": {name: float(rows[name][-1]) for name in names}}))
