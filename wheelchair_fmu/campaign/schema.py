"""Every table and key of campaign.toml, one record each: what checks allow, and what docs/campaign.md says.

Kinds are `text`, `number`, `yes or no`, `point` ([x, y]), `table`, or several of them with "or" between.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from ..model import chassis, resistance
from ..model.tyre import common
from . import body
from .document import number


@dataclass(frozen=True)
class Key:
    """One key: its kind, unit and default, what it means, an example, and the fault it is most likely to cause."""

    name: str
    kind: str
    meaning: str
    unit: str = ""
    default: str = ""
    example: str = ""
    fault: str = ""


@dataclass(frozen=True)
class TableRecord:
    """One table. In one that is `open`, keys are names of other things: parameters, channels, devices."""

    name: str
    meaning: str
    keys: tuple[Key, ...]
    repeated: bool = False
    open: bool = False

    @property
    def title(self) -> str:
        return f"[[{self.name}]]" if self.repeated else f"[{self.name}]"

    def key(self, name: str) -> Key | None:
        return next((k for k in self.keys if k.name == name), None)


def _usually_known() -> str:
    """How well values are known that a calibration starts from, as their records have it."""
    records = (*chassis.PARAMETERS, *resistance.PARAMETERS, *common.PARAMETERS)
    told = {p.name: f"{p.known_to:g} {p.unit.name}" if p.known_to else f"{p.uncertainty:.3g}" for p in records}
    shares = "chair.m", "chair.I_z", "resistance.f_r", "resistance.f_f", "tyre.C_lambda"
    relative = ", ".join(f"{told[name]} of {name}" for name in shares)
    inertia = next(p for p in records if p.name == "chair.I_z")
    relative += f" ({inertia.among_chairs:g} {inertia.unit.name} of chair.I_z where it is not given)"
    return f"{relative}; {', '.join(f'{told[name]} in {name}' for name in ('chair.a', 'chair.b', 'chair.t_r'))}"


CAMPAIGN = TableRecord(
    "campaign",
    "The campaign as a whole.",
    (
        Key("name", "text", "What reports call it.", default="the folder's name", example='name = "corridor, May"'),
        Key(
            "axes",
            "text",
            "Axes of all recordings that do not say otherwise: SAE-J670 has y to the right and yaw clockwise from above, "
            "ISO-8855 has y to the left and yaw counter-clockwise.",
            default="SAE-J670, with a warning",
            example='axes = "ISO-8855"',
            fault="no axes given, SAE-J670 assumed",
        ),
        Key("description", "text", "For readers; nothing uses it."),
        Key("source", "text", "Where the recordings come from; nothing uses it."),
    ),
)

RUN = TableRecord(
    "run",
    "One recording, or a cut of one. At least one run has the role fit.",
    (
        Key(
            "file",
            "text",
            "The recording, beside campaign.toml, of a run with one device.",
            example='file = "slalom.csv"',
            fault="run 1 (slalom.csv): no such file",
        ),
        Key(
            "files",
            "table",
            "The recordings of a run with several devices, by the device's name in [[recording]].",
            example='files = { imu = "run01_imu.csv", wheels = "run01_wheels.csv" }',
            fault="run 1: no device 'imu'",
        ),
        Key(
            "clocks",
            "table",
            "For each device what to add to its times so that all are alike; or a table with offset, sd (the standard "
            "deviation of what may be left of it, by this device's own clock) and drift (s per s, 40e-6 for 40 parts per "
            "million). The first device of `files` has offset 0, and with an sd its own error counts once for all others. In a "
            "run of one file, `pushes` is its record of pushes, in which a drift changes nothing. `wheelchair sync` writes "
            "them.",
            unit="s",
            default="0",
            example="clocks = { imu = { offset = 0.412, sd = 0.002 } }",
            fault="run 1: clocks has 'imu', of which it has no file",
        ),
        Key("name", "text", "What tables and figures call the run.", default="what its files' names have in common"),
        Key(
            "manoeuvre",
            "text",
            "What was done, in your words.",
            example='manoeuvre = "coast-down"',
            fault="run 1 has no manoeuvre",
        ),
        Key(
            "role",
            "text",
            "fit: to learn from; holdout: kept to prove what was learnt.",
            example='role = "holdout"',
            fault="run 1 has no role",
        ),
        Key(
            "u0",
            "number",
            "Speed at the first sample, about; it is estimated anyway.",
            unit="m/s",
            default="from the first measured speeds",
            example="u0 = 1.2",
            fault="u0 = 5 m/s, but the first measured speeds are 1 m/s",
        ),
        Key(
            "set",
            "table",
            "Parameters that differ from the campaign's in this run, in SI units.",
            example='set = { "chair.m" = 90, "start.psi" = 1.57 }',
            fault="no parameter 'chair.mass'",
        ),
        Key(
            "from",
            "number",
            "Where to cut the run, by its own clock; the sample at `from` is kept.",
            unit="s",
            default="the beginning",
            example="from = 2.5",
            fault="run 1 is cut from 5 to 3 s, which is no time",
        ),
        Key(
            "to",
            "number",
            "Where to cut the run; the sample at `to` is not kept.",
            unit="s",
            default="the end",
            example="to = 14",
        ),
        Key(
            "constant",
            "table",
            "Channels that were not logged but are known: a number in SI units, or text with a unit; of a floor also its name.",
            example='constant = { F_rl = 0, F_rr = 0, "floor.rolling_factor" = "carpet" }',
            fault="constant has no channel 'F_r'",
        ),
        Key(
            "format",
            "text",
            "How the file is read.",
            default="found from its content",
            example='format = "smartwheel"',
            fault="no format 'smartwheels'",
        ),
        Key("side", "text", "Where an instrumented wheel was mounted: l or r.", example='side = "r"'),
        Key("radius", "number", "Radius of the wheel whose file this is.", unit="m", example="radius = 0.31"),
    ),
    repeated=True,
)

RECORDING = TableRecord(
    "recording",
    "One device: how its files are read, in whichever run. What is not listed here is an option of its format.",
    (
        Key(
            "device",
            "text",
            "Its name, which the runs' files go by.",
            example='device = "imu"',
            fault="recording 1 has no device",
        ),
        Key("columns", "table", "As [columns], for this device's files.", example='columns.yaw_rate = "Gyroscope Z"'),
        Key(
            "markers",
            "table",
            "Markers of motion capture at the ends of the rear axle, axle_l and axle_r, from which yaw, and x and y of its "
            f"middle follow; and on the body ({', '.join(body.MARKERS)}), from which rider.s and rider.momentum follow. "
            "The columns of a marker are NAME.x, NAME.y and NAME.z, or NAME_X and so on, in a unit of length.",
            example='markers = { axle_l = "LHUB", axle_r = "RHUB", sternum = "STERNUM" }',
            fault="no column 'LHUB.x' (nor 'LHUB_x') for the marker axle_l",
        ),
        Key(
            "axes",
            "text or table",
            "As [campaign] axes, for this device. For markers, which of the laboratory's axes is the room's x (forward) and y "
            "(right): a letter with a sign.",
            default="the campaign's",
            example='axes = { x = "x", y = "-z" }',
        ),
        Key(
            "radius",
            "number",
            "Radius by which this device's angles, speeds and torques of a wheel become those of the rim of contact.",
            unit="m",
            default="[wheel] R",
            example="radius = 0.306",
        ),
        Key(
            "at",
            "point",
            "Where it sits on the chair: forward and to the right of the centre of mass.",
            unit="m",
            default="the centre of mass",
            example="at = [0.11, 0.04]",
            fault="at = 0.11, which is no point",
        ),
        Key("description", "text", "For readers; nothing uses it."),
    ),
    repeated=True,
)

COLUMN = TableRecord(
    "columns",
    "Names of columns that are not called as their channels. A channel is matched by a whole header first, then without its "
    'unit. Each entry is a header, or a table of these keys; "" leaves a channel out, also one that would be made from '
    "others.",
    (
        Key("column", "text", "The header.", default="the channel's own name", example='yaw_rate = { column = "Gyro Z" }'),
        Key(
            "unit",
            "text",
            "Its unit, where the file gives none, or a wrong one.",
            default="as in the file",
            example='unit = "deg/s"',
            fault="no unit given",
        ),
        Key(
            "radius",
            "number",
            "Of the wheel, where a column is an angular speed or a torque of it.",
            unit="m",
            default="the device's radius, or [wheel] R",
            example="radius = 0.306",
            fault="F_rl is given in N.m, which needs the wheel's radius to become N",
        ),
        Key("sign", "number", "-1 turns the column round.", default="1", example="sign = -1", fault="sign = 2"),
    ),
    open=True,
)

OPEN = (
    TableRecord(
        "noise",
        "One standard deviation of each channel's sensor and of each recorded push: a number in the unit of its column, or "
        "text with a unit. What is not given is estimated from the samples, and said.",
        (),
        open=True,
    ),
    TableRecord(
        "nuisance",
        "Sensor offsets to be estimated beside everything else: true, or the standard deviation about zero. For a push (F_rl, "
        "F_rr, M_rl, M_rr) the baseline of an instrumented wheel, and its ripple once per turn "
        "by the wheel's angle, or where that was not recorded by its speed.",
        (),
        open=True,
    ),
    TableRecord(
        "prior",
        "How well the values above are known: a standard deviation for each parameter by its dotted name. Without one, as "
        f"standard deviations, {_usually_known()}.",
        (),
        open=True,
    ),
    TableRecord(
        "sensor",
        "Where sensors sit: sensor.<channel>.at = [x, y], forward and to the right of the centre of mass, in m. It matters for "
        "a_x and a_y, and for x, y, u and v; those of a group of which nothing is said are where its first one is. The rest is "
        "the same anywhere.",
        (),
        open=True,
    ),
)

TABLES = (CAMPAIGN, RUN, RECORDING, COLUMN, *OPEN)
PARAMETER_TABLES = ("chair", "rider", "tyre", "resistance", "wheel", "caster", "floor", "effect")
OTHER_TABLES = tuple(t.name for t in TABLES)

_KINDS: dict[str, Callable[[Any], bool]] = {
    "text": lambda v: isinstance(v, str),
    "number": lambda v: number(v) is not None,
    "yes or no": lambda v: isinstance(v, bool),
    "table": lambda v: isinstance(v, Mapping),
    "point": lambda v: isinstance(v, list) and len(v) == 2 and all(number(one) is not None for one in v),
}


def fits(value: Any, kind: str) -> bool:
    """Is a value of this kind?"""
    return any(_KINDS[one](value) for one in ([kind] if kind in _KINDS else kind.split(" or ")))
