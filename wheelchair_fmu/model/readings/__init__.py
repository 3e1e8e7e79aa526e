"""Channels beside those of `sensors`: instruments that read one number, one file each with the record `READING`.

None is bundled. A user's own lie in the folder `channels` of their configuration, or here in a checkout.
"""

from __future__ import annotations

from ...configuration import places
from ..lawful import names, records
from ..sensors import Reading

__path__ += places("channels")

READINGS: tuple[Reading, ...] = tuple(records(__name__, names(__path__), "READING", Reading, 'Reading("{}", ...)').values())
