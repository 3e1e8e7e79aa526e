"""What somebody waits for who diagnoses a campaign that the project does not bring: a process from its start to its end.

The open campaigns are those of the measurements, where these lie beside the project; the others are simulated here, by the
equations of `independent`: with two effects at once, and with casters that swing at walking pace. What is compiled is
compiled already, by a first call that is not counted.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from .command_cost import command
from .independent.campaigns import make
from .independent.hidden import usual
from .labs import MEASUREMENTS
from .rows import Row, timed

TARGET, HARDER = 10.0, 20.0  # s
SEED, SIZE = 5, 3.0  # of the campaigns that are simulated, and in sizes of interest how large effects are
TWO = ("rolling_resistance_asymmetry", "gyro_bias")
CASTERS, SWINGING = "pivot_torque", '[laws]\ncaster = "slipping"\n'  # what is hidden beside casters that swing, by their law


def rows() -> Iterator[Row]:
    opens = sorted(MEASUREMENTS.glob("open-*"))
    if not opens:
        print(f"no open campaigns in {MEASUREMENTS}: they are no part of the project", file=sys.stderr)
    for folder in opens:
        yield _row(folder.name, TARGET, folder)
    with TemporaryDirectory() as place:
        hidden = {effect: usual(effect, SIZE) for effect in TWO}
        yield _row(f"two effects, {' and '.join(TWO)}", HARDER, make(Path(place) / "two", hidden, seed=SEED))
        variant = Path(place) / "chair.toml"
        variant.write_text(SWINGING, encoding="utf-8")
        hidden = {CASTERS: usual(CASTERS, SIZE)}
        slow = make(Path(place) / "slow", hidden, manoeuvres="slow", seed=SEED, chair={"patch_load": 1.0})
        yield _row(f"casters at walking pace, {CASTERS}", HARDER, slow, "--variant", variant)


def _row(what: str, target: float, *words: str | Path) -> Row:
    seconds = [ms / 1e3 for ms in timed(lambda: command(*words), 1)]
    return Row(f"the command diagnose: {what}", "s", seconds, target)
