"""docs/campaign.md: every table and key of campaign.toml, every channel and every format, from the records that read them.

`python -m wheelchair_fmu.campaign.reference docs/campaign.md` writes it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from ..model.variant import Variant
from ..quantities import Parameter
from ..writing import written
from .channels import CHANNELS, INPUTS, SOURCES, TIME, Channel
from .formats import bundled
from .schema import COLUMN, PARAMETER_TABLES, TABLES, TableRecord

HEAD = """# campaign.toml

A campaign is a folder with a file `campaign.toml` and the recordings it names. This page lists every table and key that it may
have. It is written by `make docs` from the records that read the file, so it is complete. What is not here is a fault, and
`wheelchair check` names every fault at once.

The smallest campaign:

```toml
[campaign]
axes = "SAE-J670"          # x forward, y right, yaw clockwise from above

[chair]
m = 95.0                   # chair and rider, kg

[[run]]
file = "coast-down.csv"    # columns: time [s], F_rl [N], F_rr [N], wheel_speed_l [m/s], ...
manoeuvre = "coast-down"
role = "fit"
```

A run recorded by two devices, each with its own file, clock and rate:

```toml
[[recording]]
device = "wheels"
columns.F_rl = { column = "Moment left", unit = "N.m" }
columns.F_rr = { column = "Moment right", unit = "N.m" }
radius = 0.306

[[recording]]
device = "imu"
axes = "ISO-8855"
at = [0.11, 0.04]
columns.yaw_rate = "Gyroscope Z"
columns.a_x = "Accelerometer X"

[[run]]
files = { wheels = "run01_wheels.csv", imu = "run01_imu.csv" }
clocks = { imu = { offset = 0.412, sd = 0.002 } }    # written by wheelchair sync
manoeuvre = "slalom"
role = "fit"
```

"""
COLUMN_EXAMPLE = """```toml
[columns]
yaw_rate = "Gyro Z"
F_rl = { column = "Moment left", unit = "N.m", sign = -1 }
```

"""
CHANNEL_WORDS = """## Channels

A column is matched by its whole header first, then without the unit behind it: `yaw_rate [deg/s]` is the channel
`yaw_rate`. Any unit of the right dimension is converted. Cells may be empty: a gap is no reading. `time` and the pushes of both
wheels (F or M, or a constant) are needed; of the rest, whatever was measured. What the rider's body does is an input like a
push, `rider.s` (with `[rider] m`, the mass that moves with it) or `rider.momentum`: each makes what the model needs of the
others, and a run is cut to where the body was seen. Without it, the pushes tell the phase of the strokes, where these have a
rhythm; `stroke.phase` gives it where they do not. A floor that is not hard and level is an input, too: `floor.rolling_factor`,
`floor.slope_x` and `floor.slope_y`, mostly as constants of a run.

"""
FORMAT_WORDS = """## Formats

A file is recognised by its content, then by its ending; `format` in `[[run]]` or `[[recording]]` says it where neither tells.
Units are taken from headers (`yaw_rate [deg/s]`, `Time (s)`, `gyr_dps`), from a row of units or from an attribute, and never
guessed: a column that `[columns]` names and that has none is a fault, and `unit = "..."` cures it. `pip install
"wheelchair-fmu[files]"` brings the libraries of the formats that need one, `[mdf]` that of MDF. In tables of text and of
spreadsheets names that stand there twice get that of the group in the row above: `Left wheel.Torque`, `Right wheel.Torque`.

[A format of your own](your-own-format.md) is a Python file with a record `FORMAT` in the folder `formats` of your configuration
of wheelchair-fmu (a program that runs with your rights), or an entry point of the group `wheelchair_fmu.formats`.

"""
OPTION_WORDS = """### Options of formats

Keys of `[[run]]` or `[[recording]]`, beside `format`.

"""
PARAMETER_WORDS = """## Parameters: [chair], [rider], [tyre], [resistance], [wheel], [caster], [floor], [effect]

What is known of the chair, by the names of the FMU's parameters, in SI units: `[chair] m = 95` is `chair.m`. What is not given
has the default. A run's `set` goes before the campaign's value, and `[prior]` says how well a value is known. Parameters of
effects (`[effect] rolling_resistance_asymmetry.D = 2`) are listed by `wheelchair effects list`.

"""


def page() -> str:
    """The whole page, as Markdown."""
    sections = [
        HEAD,
        *map(_table, TABLES),
        CHANNEL_WORDS,
        _channels((TIME, *INPUTS, *CHANNELS, *SOURCES)),
        FORMAT_WORDS,
        _formats(),
        OPTION_WORDS,
        _options(),
        PARAMETER_WORDS,
        _parameters(p for p in Variant().parameters() if _plain(p)),
    ]
    return "".join(sections)


def _plain(p: Parameter) -> bool:
    return p.name.partition(".")[0] in PARAMETER_TABLES and not p.name.startswith("effect.")


def _table(record: TableRecord) -> str:
    lines = [f"## {record.title}\n\n{record.meaning}\n\n"]
    if record is COLUMN:
        lines.append(COLUMN_EXAMPLE)
    if record.keys:
        rows = [
            (f"`{k.name}`", k.kind + (f", {k.unit}" if k.unit else ""), k.meaning, k.default, _code(k.example), k.fault)
            for k in record.keys
        ]
        lines.append(_rows(("key", "value", "meaning", "default", "example", "a fault it can cause"), rows))
    return "".join(lines)


def _channels(channels: Iterable[Channel]) -> str:
    rows = [
        (f"`{c.name}`", c.unit.name, c.meaning + (f"; or {c.rotary.name} with the wheel's radius" if c.rotary else ""))
        for c in channels
    ]
    return _rows(("channel", "SI unit", "meaning"), rows)


def _formats() -> str:
    rows = [
        (
            f"`{f.id}`",
            f.title,
            " ".join(f.suffixes),
            f.meaning,
            ", ".join(o.key for o in f.options),
            f"`pip install {f.needs}`" if f.needs else "",
        )
        for f in bundled().values()
    ]
    return _rows(("format", "what", "endings", "how it is read", "options", "needs"), rows)


def _options() -> str:
    options = {o.key: o for f in bundled().values() for o in f.options}
    rows = [(f"`{o.key}`", o.kind + (f", {o.unit}" if o.unit else ""), o.meaning, o.default) for o in options.values()]
    return _rows(("key", "value", "meaning", "default"), rows)


def _parameters(parameters: Iterable[Parameter]) -> str:
    rows = [(f"`{p.name}`", p.unit.name, p.meaning, f"{p.default:g}") for p in parameters if not p.choices]
    return _rows(("parameter", "unit", "meaning", "default"), rows)


def _code(text: str) -> str:
    return f"`{text}`" if text else ""


def _rows(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |\n" for row in lines) + "\n"


if __name__ == "__main__":
    with written(Path(sys.argv[1])) as beside:
        beside.write_text(page(), encoding="utf-8")
