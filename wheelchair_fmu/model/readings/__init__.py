"""Channels beside those of `sensors`: instruments that read one number, one file each with the record `READING`.

None is bundled. A user's own lie in the folder `channels` of their configuration, or here in a checkout.
"""

from __future__ import annotations

from collections.abc import MutableSequence
from pathlib import Path

from ...configuration import places
from ...errors import ModelError
from ..lawful import names, records
from ..sensors import Reading

__path__ += places("channels")

# What a campaign has already, by these names: channels, recorded inputs, and what channels are made from.
TAKEN = frozenset(
    (
        *("time", "x", "y", "yaw", "u", "v", "yaw_rate", "a_x", "a_y", "wheel_speed", "wheel_speed_l", "wheel_speed_r"),
        *("wheel_angle_l", "wheel_angle_r", "F_rl", "F_rr", "M_rl", "M_rr", "brake_rl", "brake_rr"),
    )
)


def own(folders: MutableSequence[str]) -> tuple[str, ...]:
    """The files of channels in these folders. Raises ModelError for a name that a channel or an input of a campaign has."""
    if taken := [f"{place}/{name}.py" for place in folders for name in sorted(TAKEN) if Path(place, f"{name}.py").is_file()]:
        what = "is the name of a channel or an input that there is already"
        raise ModelError(
            "\n".join(f"{file}: {Path(file).stem!r} {what}; give the file and its record another name" for file in taken)
        )
    return names(folders)


READINGS: tuple[Reading, ...] = tuple(records(__name__, own(__path__), "READING", Reading, 'Reading("{}", ...)').values())
