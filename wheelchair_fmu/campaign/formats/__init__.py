"""The formats that recordings come in: one record in one file each, discovered; users may add their own.

A user's format is a file with a record `FORMAT` in the folder `formats` of the user's own configuration of wheelchair-fmu, or
an entry point of the group `wheelchair_fmu.formats`. Code that lies in a campaign is never run.
"""

from ._defined import read_head
from ._opening import format_of, open_recording
from ._record import Format, Option, Read
from ._registry import bundled, formats, known_options, user_folder
from .smartwheel import read_smartwheel

__all__ = [
    "Format",
    "Option",
    "Read",
    "bundled",
    "format_of",
    "formats",
    "known_options",
    "open_recording",
    "read_head",
    "read_smartwheel",
    "user_folder",
]
