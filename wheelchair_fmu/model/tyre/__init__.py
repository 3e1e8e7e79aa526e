"""Tyre laws, of which a model has one: linear, Dugoff, the Magic Formula, and whatever files of laws stand beside these.

A file has the record `LAW`, and its law's name. The first three keep their numbers, which FMUs and tools know.
"""

from ..lawful import laws, names

NAMES = names(__path__, first=("linear", "dugoff", "magic_formula"), but=("common",))  # before any is read: `common` needs them
LAWS = laws(__name__, NAMES)
