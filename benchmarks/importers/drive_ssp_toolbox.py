"""A system in FMU Manipulation Toolbox:  python drive_ssp_toolbox.py SSP STOP STEP NAME…

It makes one FMU of the system (a container), which FMPy runs. Prints as drive_ssp_fmpy.py.
"""

import json
import shutil
import sys
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

import fmpy
from fmu_manipulation_toolbox.assembly import Assembly

ssp, stop, step, *names = sys.argv[1:]
SSD = "{http://ssp-standard.org/SSP1/SystemStructureDescription}"
with TemporaryDirectory() as folder:
    shutil.copy(ssp, Path(folder) / "system.ssp")
    Assembly("system.ssp", default_step_size=float(step), fmu_directory=Path(folder)).make_fmu(fmi_version=2)
    made = next(Path(folder).glob("*.fmu"))
    fmpy.extract(ssp, str(Path(folder) / "unpacked"))
    root = ElementTree.parse(Path(folder) / "unpacked" / "SystemStructure.ssd")
    files = {c.get("name"): Path(c.get("source")).stem.lower() for c in root.iter(f"{SSD}Component")}  # it names them by file
    inside = {name: f"{files[name.partition('.')[0]]}.{name.partition('.')[2]}" for name in names}
    run = fmpy.simulate_fmu(str(made), stop_time=float(stop), output_interval=float(step), output=list(inside.values()))
print(
    json.dumps(
        {
            "tool": "FMU Manipulation Toolbox",
            "version": version("fmu-manipulation-toolbox"),
            "end": {name: float(run[own][-1]) for name, own in inside.items()},
        }
    )
)
