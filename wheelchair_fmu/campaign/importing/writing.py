"""campaign.toml as a person would write it: with comments that say what told each thing, and what is still to be filled in."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..axes import AXES, SAE
from ..channels import BY_NAME, POSITION
from .choices import NAMED, Choice, Plan
from .guesses import OWN

MANOEUVRES = (
    "coast-down",
    "coastdown",
    "slalom",
    "straight",
    "circle",
    "pivot",
    "spin",
    "turn",
    "sprint",
    "kreis",
    "ausrollen",
)
PUSHES = ("F_rl", "F_rr", "M_rl", "M_rr")
CHAIR_ALONE = 20.0  # kg, about: of a manual chair with instrumented wheels
PLACE = "# at = [0.0, 0.0]  # where it sits, m forward and to the right of the centre of mass: fill in"
WIDE = 90  # characters of a line behind which a comment stands on a line of its own


@dataclass(frozen=True)
class Wanted:
    """What the user says: of the chair (SI units), of axes that no signal tells, and of the runs that are kept for checking;
    and what was found of the runs: whether they start at rest, and the clocks of their devices."""

    name: str
    mass: float | None = None
    person: float | None = None
    radius: float | None = None
    track: float | None = None
    wheelbase: float | None = None
    cm_ahead: float | None = None
    caster_track: float | None = None
    caster_trail: float | None = None
    wheel_inertia: float | None = None
    axes: str = ""
    holdout: Sequence[str] = ()
    at_rest: Mapping[str, bool] = field(default_factory=dict)
    clocks: Mapping[str, Mapping[str, Mapping[str, float]]] | None = None  # by run and device, where they were looked for
    noise: Mapping[str, float] = field(default_factory=dict)  # SI, by channel, as the samples show it

    @property
    def pivots_ahead(self) -> float | None:
        """How far the casters' pivots are ahead of the centre of mass."""
        return None if self.wheelbase is None or self.cm_ahead is None else self.wheelbase - self.cm_ahead

    @property
    def spin(self) -> float | None:
        """The mass, kg, that two wheels' moment of inertia counts as, where the wheels' radius is known as well."""
        return None if self.wheel_inertia is None or self.radius is None else 2 * self.wheel_inertia / self.radius**2


SIZES = {  # of a chair, as they are asked for: what no file tells
    "mass": "mass of chair and rider, kg",
    "person": "mass of the rider alone, kg",
    "radius": "radius of the rear wheels, m",
    "track": "track of the rear wheels, m",
    "wheelbase": "from the rear axle to the casters' pivots, m",
    "cm_ahead": "from the rear axle forward to the centre of mass, m",
    "caster_track": "track of the casters' pivots, m",
    "caster_trail": "trail of the casters, from the pivot back to where the caster stands, m",
    "wheel_inertia": "moment of inertia of one rear wheel with its rim about the axle, kg m2",
}
BOUNDS = {  # in these units: a size beyond is no wheelchair's, but of another unit
    "mass": (10.0, 400.0),
    "person": (5.0, 350.0),
    "radius": (0.05, 1.0),
    "track": (0.1, 2.0),
    "wheelbase": (0.1, 2.0),
    "cm_ahead": (0.001, 2.0),
    "caster_track": (0.1, 2.0),
    "caster_trail": (0.001, 0.3),
    "wheel_inertia": (0.001, 2.0),
}
CHAIR = (
    ("m", "mass", "chair and rider, kg"),
    ("a", "pivots_ahead", "from the centre of mass forward to the casters' pivots, m"),
    ("b", "cm_ahead", "from the centre of mass back to the rear axle, m"),
    ("t_r", "track", "track of the rear wheels on the floor, m"),
    ("t_f", "caster_track", "track of the casters' pivots, m"),
)


def text(plans: Sequence[Plan], runs: Sequence[str], files: Mapping[str, Mapping[str, str]], wanted: Wanted) -> str:
    """The whole file. `files` are by run and device, as campaign.toml is to name them."""
    alone = of_one_device(plans)
    parts = [_head(plans, files, wanted), _chair(wanted), _rider(plans, wanted), _noise(wanted), _nuisance(plans)]
    parts += [_columns(plans[0])] if alone else [_recording(plan, wanted) for plan in plans]
    parts += [_run(run, files[run], wanted, alone) for run in runs]
    return "\n\n".join(part for part in parts if part) + "\n"


def of_one_device(plans: Sequence[Plan]) -> bool:
    """Has the campaign one device, whose columns need no table of their own?"""
    return len(plans) == 1 and not plans[0].markers


def axes_of(plans: Sequence[Plan], wanted: Wanted) -> str:
    """Axes of the campaign: of a device alone those that its signals tell, else what the user says of those that no signal
    tells."""
    told = next((plan.axes for plan in plans if plan.axes), "")
    return (told if len(plans) == 1 else "") or wanted.axes or told or SAE


def open_axes(plans: Sequence[Plan]) -> bool:
    """Are there channels whose axes nothing tells?"""
    turning = ("yaw_rate", "a_y", "y", "v", "yaw")
    return any(plan.find(channel) and not plan.axes and not plan.markers for plan in plans for channel in turning)


def _head(plans: Sequence[Plan], files: Mapping[str, Mapping[str, str]], wanted: Wanted) -> str:
    count = sum(map(len, files.values()))
    why = why_axes(plans, wanted)
    other = next((a for a in AXES if a != axes_of(plans, wanted)), "")
    return "\n".join(
        [
            f"# Written by `wheelchair import` from {count} files. Behind each column stands what told it; "
            "see also preview.html.",
            "",
            "[campaign]",
            f"name = {quoted(wanted.name)}",
            _line(f"axes = {quoted(axes_of(plans, wanted))}", f"{why}; the other ones are {other}" if why else ""),
        ]
    )


def why_axes(plans: Sequence[Plan], wanted: Wanted) -> str:
    """What told the campaign's axes; nothing where there is nothing to tell."""
    told = next((plan for plan in plans if plan.axes), None)
    if told and (len(plans) == 1 or not wanted.axes):
        return f"of {told.name}, {told.why_axes}"
    if wanted.axes:
        return "as you said"
    return "no signal tells: correct it" if open_axes(plans) else ""


def _chair(wanted: Wanted) -> str:
    lines = ["[chair]"]
    for key, name, meaning in CHAIR:
        value = getattr(wanted, name)
        lines.append(_line(f"{key} = {value:g}", meaning) if value is not None else f"# {key} =   # {meaning}: fill in")
    meaning = "radius of the rear wheels with the person in the chair, m"
    radius = f"# R =   # {meaning}: fill in" if wanted.radius is None else _line(f"R = {wanted.radius:g}", meaning)
    return "\n".join([*lines, "", "[wheel]", radius, *_effects(wanted)])


def _effects(wanted: Wanted) -> Iterator[str]:
    """What a protocol knows of the chair that the model has as an effect, so that nobody takes it for what is missing."""
    lines = []
    if wanted.caster_trail is not None:
        lines.append(_line(f"caster_trail.c = {wanted.caster_trail:g}", "from the casters' pivots back to where they stand, m"))
    if wanted.wheel_inertia is not None:
        meaning = f"2 I/R2 of the rear wheels, kg, with I = {wanted.wheel_inertia:g} kg m2 of each"
        lacking = f"# wheel_inertia.m =   # {meaning}: fill in"
        lines.append(lacking if wanted.spin is None else _line(f"wheel_inertia.m = {wanted.spin:.4g}", meaning))
    yield from ("", "[effect]", *lines) if lines else ()


def _rider(plans: Sequence[Plan], wanted: Wanted) -> str:
    """The mass of the person, where markers show how the body moves, or of the part of it whose position was measured."""
    names = [name for plan in plans for name in plan.body.values()]
    part = any(plan.find(POSITION) for plan in plans)
    if not names and not part:
        return ""
    shown = f"the person alone, kg, whose body {', '.join(names)} show"
    meaning = shown if names else f"what moves as {POSITION} says, kg"
    if wanted.person is None and (wanted.mass is None or not names):
        return f"[rider]\n# m =   # {meaning}: fill in"
    assumed = assumed_person(plans, wanted)
    person = wanted.person if wanted.person is not None else max((wanted.mass or 0.0) - CHAIR_ALONE, 1.0)
    return "\n".join(["[rider]", _line(f"m = {person:g}", f"{meaning}: {assumed}" if assumed else meaning)])


def assumed_person(plans: Sequence[Plan], wanted: Wanted) -> str:
    """What the mass of the person was assumed to be, where that was needed and nobody said it."""
    needed = any(plan.body for plan in plans) and wanted.person is None and wanted.mass is not None
    return f"the rider is assumed to be all but {CHAIR_ALONE:g} kg of chair: correct it" if needed else ""


def needs_radius(plans: Sequence[Plan]) -> bool:
    """Does anything become SI only through the wheels' radius?"""
    through = {"F_rl": "N.m", "F_rr": "N.m", "wheel_speed_l": "rad/s", "wheel_speed_r": "rad/s"}
    turned = ("wheel_angle_l", "wheel_angle_r")
    used = [choice for plan in plans for choice in plan.choices if choice.settled and not choice.beside]
    return any(through.get(choice.channel) == choice.si or choice.channel in turned for choice in used)


def _noise(wanted: Wanted) -> str:
    """What the samples show of the sensors' noise, to be put right by who knows better."""
    lines = [f'# {name} = "{sd:.2g} {BY_NAME[name].unit.name}"' for name, sd in sorted(wanted.noise.items())]
    head = "# [noise]  # one standard deviation of each sensor as the samples show it: write what you know better"
    return "\n".join([head, *lines]) if lines else ""


def _nuisance(plans: Sequence[Plan]) -> str:
    """What instruments show by themselves, and nobody zeroed: torques of rims, rates and accelerations of sensors on the frame,
    and the heading of a line between two markers, which somebody stuck on by eye."""
    rims = [name for name in PUSHES if any((c := plan.find(name)) and c.si == "N.m" for plan in plans)]
    sensed = [name for name in ("yaw_rate", "a_x", "a_y") if any(plan.find(name) for plan in plans)]
    names = rims + (["yaw"] if any(plan.markers for plan in plans) else []) + sensed
    meaning = "what sensors show where there is nothing to show is estimated"
    return "\n".join([_line("[nuisance]", meaning), *(f"{name} = true" for name in names)]) if names else ""


def _columns(plan: Plan) -> str:
    lines = [_entry("", choice) for choice in plan.choices] + list(_time("", plan))
    return "\n".join(["[columns]", *lines])


def _recording(plan: Plan, wanted: Wanted) -> str:
    lines = ["[[recording]]", _line(f"device = {quoted(plan.name)}", plan.place)]
    if plan.markers:
        ends = ", ".join(f"{end} = {quoted(name)}" for end, name in {**plan.markers, **plan.body}.items())
        lines.append(_line(f"markers = {{ {ends} }}", plan.why_axes))
        lines.append(
            _line(
                "axes = { " + ", ".join(f"{k} = {quoted(v)}" for k, v in plan.marker_axes.items()) + " }",
                "x along the way, y to the right of it",
            )
        )
    elif plan.place == "on the frame":
        lines += [_line(f"axes = {quoted(plan.axes)}", plan.why_axes)] if plan.axes else []
        lines += [PLACE] if plan.find("a_x") or plan.find("a_y") else []
    lines += list(_time("columns.", plan))
    lines += [_entry("columns.", choice) for choice in plan.choices]
    lines += [_line(f'columns.{channel} = ""', why) for channel, why in plan.empty.items()]
    return "\n".join(lines)


def _time(before: str, plan: Plan) -> Iterator[str]:
    source = plan.source
    if source.time is None:
        return
    table = source.typical.table
    if source.time_by_size:
        entry = f"{before}time = {{ column = {quoted(source.time.header)}, unit = {quoted(source.time_unit)} }}"
        yield _line(entry, "the file gives no unit: by the size of its steps")
    elif table.time != source.time.index and source.time.header != "time":
        yield f"{before}time = {quoted(source.time.header)}"


def _entry(before: str, choice: Choice) -> str:
    if choice.beside and not choice.settled:
        return ""
    unit = choice.unit.replace("?", "")  # of one that nobody can tell, the check says that it lacks its unit
    extra = ([f"unit = {quoted(unit)}"] if unit else []) + (["sign = -1"] if choice.sign < 0 else [])
    value = f"{{ column = {quoted(choice.header)}, {', '.join(extra)} }}" if extra else quoted(choice.header)
    key = before + (quoted(choice.channel) if "." in choice.channel else choice.channel)
    if not choice.beside:
        return _line(f"{key} = {value}", choice.why)
    if OWN.get(choice.header.partition("[")[0].strip().lower()) == choice.channel:  # it would be taken for it by its name
        return _line(f'{key} = ""', f"{choice.beside} measures it too")
    return _line(f"# {key} = {value}", f"{choice.beside} measures it too")


def _run(run: str, files: Mapping[str, str], wanted: Wanted, alone: bool) -> str:
    named = next((word for word in MANOEUVRES if word in run.lower().replace("_", "-")), "")
    listed = ", ".join(f"{device} = {quoted(file)}" for device, file in files.items())
    lines = [
        "[[run]]",
        f"name = {quoted(run)}",
        f"file = {quoted(next(iter(files.values())))}" if alone else f"files = {{ {listed} }}",
        _line(f"manoeuvre = {quoted(named or run)}", "" if named else "say what was done"),
        _line(
            f"role = {quoted('holdout' if run in wanted.holdout else 'fit')}",
            "kept to prove what was learnt" if run in wanted.holdout else "",
        ),
    ]
    lines += _clocks(wanted.clocks.get(run, {}), list(files)[1:]) if wanted.clocks is not None else []
    lines += [_line("u0 = 0.0", "by its signals: the wheels stand still at first")] if wanted.at_rest.get(run) else []
    return "\n".join(lines)


def _clocks(sure: Mapping[str, Mapping[str, float]], devices: Sequence[str]) -> list[str]:
    """The clocks that are sure; and which of the others, all but the first device's, are to be given."""
    lines = [f"clocks = {_inline(sure)}"] if sure else []
    for device in (name for name in devices if name not in sure):
        meaning = f"what to add to its times, s, is not sure: give it in clocks = {{ {device} = ... }}"
        lines.append(f"# {device}: {meaning}")
    return lines


def _inline(value: Mapping[str, Any] | float) -> str:
    """Numbers and tables of them on one line."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_inline(inner)}' for key, inner in value.items())} }}"
    return repr(value)


def _line(entry: str, comment: str) -> str:
    """An entry with its comment, which stands above it where the line would be long."""
    plain = " ".join("".join(c if c.isprintable() else " " for c in comment).split())
    if not plain or plain == NAMED:
        return f"{entry}  # {plain}" if plain and len(entry) < WIDE else entry
    return f"{entry}  # {plain}" if len(entry) + len(plain) < 2 * WIDE - 50 else f"# {plain}\n{entry}"


def quoted(text: str) -> str:
    """A string of TOML."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
