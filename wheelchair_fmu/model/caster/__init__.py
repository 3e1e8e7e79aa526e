"""Caster laws, of which a model has one: ideal, swivelling without side slip, slipping, and whatever laws stand beside these
or in the folder `laws/caster` of a user's configuration.

A file has the record `LAW`, and its law's name.
"""

from ...configuration import places
from ..lawful import laws, names

__path__ += places("laws/caster")

LAWS = laws(__name__, names(__path__, first=("ideal", "swivelling", "slipping", "paper")))
