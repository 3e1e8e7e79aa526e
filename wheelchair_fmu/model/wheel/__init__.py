"""Wheel laws, of which a model has one: rear wheels that roll until a brake locks them, wheels whose spin is a state, and
whatever laws stand beside these or in the folder `laws/wheel` of a user's configuration.

A file has the record `LAW`, and its law's name. The last of its stages comes after what resists rolling, and gives the force of
each wheel along its plane; the others come before the tyre law, and say what friction leaves of the side force.
"""

from ...configuration import places
from ..lawful import laws, names

__path__ += places("laws/wheel")

LAWS = laws(__name__, names(__path__, first=("rolling", "spinning", "paper")))
