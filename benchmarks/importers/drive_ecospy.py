"""Ecos, the C++ master of NTNU:  python drive_ecospy.py FMU CoSimulation INPUTS RESULTS

Prints as drive_fmpy.py.
"""

import json
import sys
from importlib.metadata import version

import tbb_first  # noqa: F401  before ecospy, which is linked to it
from ecospy import EcosSimulation, EcosSimulationStructure
from samples import read

fmu, _, inputs, results = sys.argv[1:]
rows, names = read(inputs, results)
structure = EcosSimulationStructure()
structure.add_model("chair", fmu)
with EcosSimulation(structure=structure, step_size=0.01) as simulation:
    simulation.init()
    for row in rows[:-1]:
        for name, value in row.items():
            if name != "time":
                simulation.set_real(f"chair::{name}", value)
        simulation.step(1)
    end = {name: simulation.get_real(f"chair::{name}") for name in names}
print(json.dumps({"tool": "Ecos", "version": version("ecospy"), "end": end}))
