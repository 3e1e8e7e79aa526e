"""Compile what a first diagnosis asks for, for every system that releases are built for, into the package that is built next.

`.ci/release` runs it with ziglang; what it makes is no part of the repository.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from rich.progress import track

from wheelchair_fmu.campaign import read
from wheelchair_fmu.engine import cache, shipped
from wheelchair_fmu.fmu.platforms import chosen
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.model.generic import library as terms
from wheelchair_fmu.resources import EXAMPLES

HELPERS = ("innovations",)  # which every diagnosis loads besides


def asked(campaigns: list[Path]) -> list[cache.Wanted]:
    """The models that diagnoses load."""
    wanted: dict[str, cache.Wanted] = {}
    load = cache.library

    def library(*words, **options):
        one = cache.Wanted.of(*words, **options)
        wanted[one.words] = one
        return load(*words, **options)

    cache.library = library
    for campaign in campaigns:
        diagnose(read(campaign), generic=terms())
    cache.library = load
    return list(wanted.values())


def main(campaigns: list[str]) -> None:
    shutil.rmtree(shipped.FOLDER, ignore_errors=True)
    wanted = asked([EXAMPLES / "sample-campaign", *map(Path, campaigns)])
    for system in track(chosen("all"), "kernels", transient=True):
        for one in wanted:
            cache.ship(one, system.name, system.suffix, system.command())
        for name in HELPERS:
            cache.ship_helper(name, system.name, system.suffix, system.command())
    made = [f for f in shipped.FOLDER.rglob("*") if f.is_file()]
    print(f"{len(made)} kernels, {sum(f.stat().st_size for f in made) / 1e6:.1f} MB")


if __name__ == "__main__":
    main(sys.argv[1:])
