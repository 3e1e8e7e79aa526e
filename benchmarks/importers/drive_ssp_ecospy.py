"""A system in Ecos:  python drive_ssp_ecospy.py SSP STOP STEP NAME…

Prints as drive_ssp_fmpy.py. It names no parameter set, so what counts is what the FMUs start with.
"""

import json
import sys
from importlib.metadata import version

import tbb_first  # noqa: F401  before ecospy, which is linked to it
from ecospy import EcosSimulation

ssp, stop, step, *names = sys.argv[1:]
with EcosSimulation(ssp_path=ssp, step_size=float(step)) as simulation:
    simulation.init()
    simulation.step(round(float(stop) / float(step)))  # its step_until ends one step early
    end = {name: simulation.get_real(name.replace(".", "::", 1)) for name in names}
print(json.dumps({"tool": "Ecos", "version": version("ecospy"), "end": end}))
