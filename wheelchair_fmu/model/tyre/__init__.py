"""Tyre laws, of which a model has one: linear, Dugoff, the Magic Formula, and whatever files of laws stand beside these or in
the folder `laws/tyre` of a user's configuration.

A file has the record `LAW`, and its law's name. The first three keep their numbers, which FMUs and tools know.
"""

from ...configuration import places
from ..lawful import laws, names

__path__ += places("laws/tyre")

NAMES = names(__path__, first=("linear", "dugoff", "magic_formula"), but=("common",))  # before any is read: `common` needs them
LAWS = laws(__name__, NAMES)
