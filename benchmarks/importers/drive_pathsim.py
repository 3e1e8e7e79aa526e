"""PathSim:  python drive_pathsim.py FMU CoSimulation INPUTS RESULTS

Prints as drive_fmpy.py.
"""

import json
import sys
import warnings
from importlib.metadata import version

from pathsim import Connection, Simulation
from pathsim.blocks import CoSimulationFMU, Source
from samples import read

STEP = 0.01
fmu, _, inputs, results = sys.argv[1:]
rows, names = read(inputs, results)
with warnings.catch_warnings(action="ignore", category=DeprecationWarning):  # it moves to a package that wants a newer FMPy
    chair = CoSimulationFMU(fmu, dt=STEP)


def held(name: str) -> Source:
    return Source(lambda t: rows[min(int(t / STEP + 0.5), len(rows) - 1)][name])


sources = {name: held(name) for name in rows[0] if name != "time"}
sources.setdefault("floor.rolling_factor", Source(lambda t: 1.0))  # PathSim starts inputs at 0, whatever their start value
connections = [Connection(source, chair[name]) for name, source in sources.items()]
simulation = Simulation([chair, *sources.values()], connections, dt=STEP, log=False)
simulation.run(STEP * (len(rows) - 2), adaptive=False)  # the FMU steps at the beginning of each step, so it is one ahead
end = {name: float(chair.outputs[name]) for name in names}
print(json.dumps({"tool": "PathSim", "version": version("pathsim"), "end": end}))
