"""libcosimpy, the C++ master of OSP:  python drive_libcosimpy.py FMU CoSimulation INPUTS RESULTS [two]

With `two`, a second chair in the same process is pushed on each side by what the first one would need to keep its speed.
Prints as drive_fmpy.py.
"""

import json
import sys
from importlib.metadata import version

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave
from samples import read

fmu, _, inputs, results, *coupled = sys.argv[1:]
execution = CosimExecution.from_step_size(step_size=1e7)  # 10 ms
chair = execution.add_local_slave(CosimLocalSlave(fmu_path=fmu, instance_name="chair"))
observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
execution.add_observer(observer=observer)
execution.add_manipulator(manipulator=manipulator)
at = {v.name.decode(): v.reference for v in execution.slave_variables(chair)}
if coupled:
    second = execution.add_local_slave(CosimLocalSlave(fmu_path=fmu, instance_name="second"))
    for push in ("push.F_rl", "push.F_rr"):
        execution.connect_real_variables(chair, at["push.total_needed"], second, at[push])
    rows, names, watched = [{}] * 301, ["chair.u", "chair.x"], second
else:
    (rows, names), watched = read(inputs, results), chair
for row in rows[:-1]:
    pushes = {name: value for name, value in row.items() if name != "time"}
    if pushes:
        manipulator.slave_real_values(chair, [at[name] for name in pushes], list(pushes.values()))
    if not execution.step():
        sys.exit("libcosimpy: a step failed")
end = observer.last_real_values(watched, [at[name] for name in names])
print(json.dumps({"tool": "libcosimpy", "version": version("libcosimpy"), "end": dict(zip(names, end, strict=True))}))
