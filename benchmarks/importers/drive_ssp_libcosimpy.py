"""A system in libcosimpy:  python drive_ssp_libcosimpy.py SSP STOP STEP NAME…

Prints as drive_ssp_fmpy.py. The step is what the archive says to libcosim.
"""

import json
import sys
from importlib.metadata import version

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver

ssp, stop, _, *names = sys.argv[1:]
execution = CosimExecution.from_ssp_file(ssp_path=ssp)
observer = CosimObserver.create_last_value()
execution.add_observer(observer=observer)
if not execution.simulate_until(target_time=int(float(stop) * 1e9)):
    sys.exit(f"libcosimpy: {execution.status()}")
end = {}
for name in names:
    component, _, inner = name.partition(".")
    slave = execution.slave_index_from_instance_name(component)
    at = {v.name.decode(): v.reference for v in execution.slave_variables(slave)}
    end[name] = observer.last_real_values(slave, [at[inner]])[0]
print(json.dumps({"tool": "libcosimpy", "version": version("libcosimpy"), "end": end}))
