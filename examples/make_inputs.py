"""Write the input files for `fmpy simulate --input-file`:  python examples/make_inputs.py [FOLDER]

The chair starts at 1 m/s, as it does without inputs. All inputs are in each file, or fmpy asks for the missing ones.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from wheelchair_fmu.cli.files import write_table
from wheelchair_fmu.model.chassis import INPUTS

TIME = np.arange(501) * 0.02  # s
HOLD = 5.5  # N at each wheel, about what holds 1 m/s on a smooth floor
STROKE = np.maximum(0.0, np.sin(2 * np.pi * TIME))  # half a second on the rim, half a second off
PUSHES = {  # left and right, N
    "push": (25 * STROKE, 25 * STROKE),
    "turn": (HOLD + 10 + 0 * TIME, HOLD - 10 + 0 * TIME),
    "slalom": (HOLD + 10 * np.cos(np.pi * TIME / 2), HOLD - 10 * np.cos(np.pi * TIME / 2)),
}


def main(folder: Path) -> None:
    for name, (left, right) in PUSHES.items():
        columns = {"time": TIME} | {i.name: np.full_like(TIME, i.start) for i in INPUTS}
        write_table(folder / f"{name}.csv", columns | {"push.F_rl": left, "push.F_rr": right})


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
