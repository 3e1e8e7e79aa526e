"""Ecos is linked to TBB and does not bring it; PyPI's `tbb` lays it where the loader does not look."""

import sys
from ctypes import CDLL, RTLD_GLOBAL
from pathlib import Path

for library in sorted(Path(sys.prefix, "lib").glob("libtbb.so.12")):
    CDLL(str(library), RTLD_GLOBAL)
