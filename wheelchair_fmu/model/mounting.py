"""Instruments that read one channel at a point of their own."""

from __future__ import annotations

from ..quantities import M, Parameter

FARTHEST = 1.2  # m from the centre of mass, of anything on a chair: as long as a chair is in all


def apart(instrument: str, channel: str, where: str) -> tuple[Parameter, ...]:
    """Constants of an effect, how far the point at which a channel is read lies before and to the right of `where` the rest of
    an instrument sits."""
    ways = (("ahead", "before", "+"), ("right", "to the right of", "-"))
    return tuple(
        Parameter(
            f"{channel}_{way}",
            M,
            f"how far {words} {where} the point lies at which {channel} is read",
            default=0.0,
            lower=-2 * FARTHEST,
            upper=2 * FARTHEST,
            mirror=mirror,
            symbol=f"{instrument}_{channel}_{way}",
            source="rigid-body kinematics",
        )
        for way, words, mirror in ways
    )
