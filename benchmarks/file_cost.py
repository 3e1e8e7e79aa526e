"""Files in: a campaign read with all its checks, a rig's recordings identified."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from wheelchair_fmu.campaign import read
from wheelchair_fmu.tyres import identify
from wheelchair_fmu.tyres import read as read_rig

from .rows import Row, timed

EXAMPLES = Path(__file__).parent.parent / "examples"
READ, IDENTIFIED = 0.3, 5.0  # s


def rows() -> Iterator[Row]:
    sample, disc = EXAMPLES / "sample-campaign", EXAMPLES / "rotating-disc.csv"
    runs = read(sample).runs
    reading = [ms / 1e3 for ms in timed(lambda: read(sample), 5)]
    yield Row(f"reading a campaign of {len(runs)} runs", "s", reading, READ, note=f"{sum(len(r.time) for r in runs)} samples")
    identifying = [ms / 1e3 for ms in timed(lambda: identify(read_rig(disc).sweeps), 3)]
    yield Row("identifying a rig's tyres", "s", identifying, IDENTIFIED, note=disc.name)
