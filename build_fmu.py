"""Build the wheelchair FMU:  python build_fmu.py [--variant better.toml] [--effects all] [--platforms all]

The same as `wheelchair build`, which an installed package has.
"""

from __future__ import annotations

import sys

from wheelchair_fmu.cli.start import main

if __name__ == "__main__":
    main(["build", *sys.argv[1:]])
