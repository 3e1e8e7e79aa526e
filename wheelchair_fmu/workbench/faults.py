"""Faults for the page: with what it needs to say them where they are mended, and cures in words of its forms.

A fault's own cure is for whoever writes campaign.toml. In the page nobody does, so a cure that names a place in that file
names the form instead.
"""

from __future__ import annotations

import re
from typing import Any

from ..campaign.channels import CHANNEL_NAMES
from ..faults import Fault, short
from ..report.words import channel_words

COLUMNS, RUNS, NOISE = "Columns and their units", "Runs", "Noise of the sensors"  # forms, as the page heads them
GUESS = "guess"  # severity of what was assumed, and may be right
NOTHING = "nothing is to be done"  # the cure of a note
CURES: tuple[tuple[str, str], ...] = (
    (r"add a column 'F_r[lr] .*", f"choose its column under “{COLUMNS}”, or say under “{RUNS}” that nobody pushed"),
    (r"remove it and write constant = .*", f"say under “{RUNS}” that nobody pushed, or give the values"),
    (r"add columns such as .*", f"choose under “{COLUMNS}” what at least one column is"),
    (r"correct the header, or name it .*", f"say what it is under “{COLUMNS}”"),
    (r"correct the header in this file", "correct it in the file, and drop the file here again"),
    (r"correct the header in this file if .*", "where it is wrong, correct it in the file, and drop the file here again"),
    (r"name them in \[columns\] if .*", f"where they measure something, say under “{COLUMNS}” what"),
    (r"remove one, or choose one by its whole header .*", f"make one of them “not used” under “{COLUMNS}”"),
    (r"write \[columns\] .* with its unit", f"write its unit beside it under “{COLUMNS}”"),
    (r"write the header as .*", f"where it is another, write it beside the column under “{COLUMNS}”"),
    (r"write \[columns\] .*radius = .*", f"write the radius beside it under “{COLUMNS}”"),
    (r"correct one of them, or settle it by unit = .*", f"write the right one beside it under “{COLUMNS}”"),
    (r"name it 'time \[s\]', .*", f"choose under “{COLUMNS}” which column is the time"),
    (r"write what the sensors' data sheets say in \[noise\]", f"where you know better, say so under “{NOISE}”"),
    (r"write \[noise\] .*, or remove the channel", f"write it under “{NOISE}”, or make its column “not used”"),
    (r"record some seconds without hands .*", "record some seconds without hands on the rims"),
    (r"write \[rider\] m = .*", "give the mass of the rider alone above, and read the files again"),
    (r"write u0 .*", f"write the speed at the start under “{RUNS}”"),
    (r"correct u0, or .*", f"correct the speed at the start under “{RUNS}”, or the unit of the speeds"),
    (
        r'give role = "holdout" .*',
        f"make one “held out” under “{RUNS}”, so that an effect can be proven on data it has not seen",
    ),
    (r"give role = .*", f"give that role under “{RUNS}” to one in which the chair moves"),
    (r"add manoeuvre = .*", f"say under “{RUNS}” what the chair did, as in coast-down or slalom"),
    (r"write columns\..*", f"choose its column under “{COLUMNS}”"),
    (r"write axes = .*--axes", f"choose the axes under “{RUNS}”"),
    (r"fill it in, or cut the run by from and to", "fill it in, or leave out the rows in which it is missing"),
    (r"write sensor\..*\.at = .*", "give two numbers in metres, as 0.09, 0.04: forward, and to the right"),
    (r"give two numbers, \[x, y\] in m", "give two numbers in metres, as 0.09, 0.04: forward, and to the right"),
    (r"export it as CSV, or name its format", f"export it as CSV and drop that, and take this one out under “{RUNS}”"),
    (r"export it again, or leave it out", f"export it again and drop it here, or take it out under “{RUNS}”"),
)  # (what a cure is in full, what the page says in its place)
SIDES = {"l": "left", "r": "right"}
PUSHES = {f"F_r{s}": f"the push on the {side} wheel" for s, side in SIDES.items()}
PUSHES |= {f"M_r{s}": f"the torque on the {side} axle" for s, side in SIDES.items()}
CODES = {**{name: channel_words(name) for name in CHANNEL_NAMES if "_" in name}, **PUSHES, "u0": "speed at the start"}
CODE = re.compile(rf"\b({'|'.join(CODES)})\b")
QUOTED = re.compile(r"('[^']*')")  # what stands in a file is said as it stands there


def told(fault: Fault) -> dict[str, Any]:
    """{"text": the fault in one sentence; "what": the same without its place; "where": that place; "severity"; "column" and
    "file", where it is of one; "at": the key of campaign.toml that it is of}."""
    cure = next((words for pattern, words in CURES if re.fullmatch(pattern, fault.cure)), fault.cure)
    fact = re.sub(r"^no push force (F_r[lr])$", lambda m: f"{PUSHES[m[1]]} is missing", short(fault.fact))
    fact = re.sub(r"^\[sensor\] (\w+)(?:\.at)? = .*?(?= is (?:no point|more than))", r"where \1 is read", fact)
    fact = _in_words(fact.replace(", which [columns] renames", ""))
    what = fact if cure == NOTHING else f"{fact}; {cure}"
    line = "" if fault.line is None or (fault.in_run and fault.line == 1) else f" line {fault.line}"
    column = f" column {short(fault.column)}" if fault.column is not None else ""
    where = f"{fault.file}{line}{column}" if fault.in_run or line else ""
    return {
        "text": f"{where}: {what}" if where else what,
        "what": what,
        "where": where,
        "severity": fault.severity,
        "column": fault.column,
        "file": fault.file if fault.in_run else None,
        "at": fault.place,
    }


def _in_words(fact: str) -> str:
    """What campaign.toml calls a channel, in words."""
    return "".join(part if part.startswith("'") else CODE.sub(lambda m: CODES[m[1]], part) for part in QUOTED.split(fact))


def to_look_at(what: str, device: str, column: str, file: str, at: str) -> dict[str, Any]:
    """As `told`, of something that was only guessed: it may be right, and somebody has to look."""
    what = what.removeprefix(f"{device}: ")
    fact, _, cure = what.partition("; ")
    said = next((f"{fact}; {words}" for pattern, words in CURES if re.fullmatch(pattern, cure)), what)
    where = f"{device} column {column}" if column and device else column or device
    of = {"column": column or None, "file": file or None, "at": at}
    return {"text": f"{where}: {said}" if where else said, "what": said, "where": where, "severity": GUESS, **of}
