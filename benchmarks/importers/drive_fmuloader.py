"""fmuloader, FMI 2.0 and 3.0:  python drive_fmuloader.py FMU CoSimulation INPUTS RESULTS

Prints as drive_fmpy.py.
"""

import json
import sys
from importlib.metadata import version

import fmpy
from fmuloader.fmi2 import Fmi2Slave, Fmi2Type
from fmuloader.fmi3 import Fmi3Slave
from samples import read

fmu, _, inputs, results = sys.argv[1:]
rows, names = read(inputs, results)
description = fmpy.read_model_description(fmu)
variables = {v.name: v for v in description.modelVariables}
identifier = description.coSimulation.modelIdentifier
if description.fmiVersion == "2.0":
    slave = Fmi2Slave(fmu, model_identifier=identifier)
    slave.instantiate("chair", Fmi2Type.CO_SIMULATION, guid=description.guid)
    slave.setup_experiment(start_time=0.0)
    put, real, boolean = slave.set_real, slave.get_real, slave.get_boolean
else:
    slave = Fmi3Slave(fmu, model_identifier=identifier)
    slave.instantiate_co_simulation("chair", instantiation_token=description.guid)
    put, real, boolean = slave.set_float64, slave.get_float64, slave.get_boolean
slave.enter_initialization_mode()
slave.exit_initialization_mode()
for row in rows[:-1]:
    pushed = [name for name in row if name != "time"]
    put([variables[name].valueReference for name in pushed], [row[name] for name in pushed])
    slave.do_step(row["time"], 0.01)
end = {n: float((boolean if variables[n].type == "Boolean" else real)([variables[n].valueReference])[0]) for n in names}
print(json.dumps({"tool": "fmuloader", "version": version("fmuloader"), "end": end}))
