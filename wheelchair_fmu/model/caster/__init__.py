"""Caster laws, of which a model has one: ideal, swivelling without side slip, slipping, and whatever laws stand beside these.

A file has the record `LAW`, and its law's name.
"""

from ..lawful import laws, names

LAWS = laws(__name__, names(__path__, first=("ideal", "swivelling", "slipping", "paper")))
