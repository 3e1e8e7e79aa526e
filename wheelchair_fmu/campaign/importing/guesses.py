"""What a column measures, from its header: one record for each quantity, with the words that loggers use for it.

Headers are compared in small letters without accents, their words parted by single spaces: `GyroZ`, `gyr_z` and `Gyr Z [deg/s]`
are all `gyr z` or `gyro z`. Sides and axes are words of their own and are taken out first.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass, replace

from ...units import same_dimension, split, suffixed
from ..channels import BY_NAME, SOURCES, TIME

OWN = {channel.name.lower(): channel.name for channel in (TIME, *BY_NAME.values(), *SOURCES)}
LEFT = frozenset(["l", "left", "links", "linkes", "linker", "linke", "lh", "gauche", "g", "rl", "li", "lks", "izquierda"])
RIGHT = frozenset(
    ["r", "right", "rechts", "rechtes", "rechter", "rechte", "rh", "droite", "droit", "d", "rr", "re", "rts", "derecha"]
)
DIRECTIONS = {
    **dict.fromkeys(["langs", "laengs", "longitudinal", "forward", "fwd", "vorwarts", "avant", "along", "surge"], "x"),
    **dict.fromkeys(["quer", "lateral", "seitlich", "lateral", "side", "transversal", "sway"], "y"),
    **dict.fromkeys(["vertical", "vertikal", "hoch", "up", "heave"], "z"),
}  # by the chair, not by the sensor
UNITS = ("s", "m", "m/s", "m/s2", "rad", "rad/s", "N", "N.m")  # of what loggers measure
LONG = 3  # letters of a word in which a side may be the last letter


@dataclass(frozen=True)
class Quantity:
    """`name` of what is measured, the SI units it may have, and a pattern of the words for it, in which a line may end. Of what
    is `axial` the header names the axis of its sensor."""

    name: str
    units: tuple[str, ...]
    words: str
    axial: bool = False

    def names(self, text: str) -> bool:
        """Is this what the words call it?"""
        return bool(re.fullmatch(re.sub(r"\n *", "", self.words), text))


QUANTITIES = (
    Quantity(
        "time",
        ("s",),
        r"""(elapsed |relative |sample |abs(olute)? )?
        (time|zeit|t|temps|tiempo|timestamp|zeitstempel|messzeit)( stamp)?""",
    ),
    Quantity("counter", ("1",), r"(counter|frame|sample|index|nr|packet ?counter|zaehler|record)( nr| number| no)?"),
    Quantity(
        "yaw_rate",
        ("rad/s",),
        r"""yaw ?(rate|speed|vel(ocity)?)|gier ?(rate|geschwindigkeit)|vitesse de lacet|
        psi ?(dot|p)""",
    ),
    Quantity("yaw", ("rad",), r"yaw( angle)?|heading|gierwinkel|kurs(winkel)?|angle de lacet|lacet|cap|psi"),
    Quantity(
        "gyro",
        ("rad/s",),
        r"""gyr(o(scope|skop)?)?( data)?|g|omega|w|ang(ular)? ?(vel(ocity)?|rate|speed)|rate|
        dreh ?rate|winkel ?geschwindigkeit|vitesse angulaire|rot(ation)? ?rate""",
        axial=True,
    ),
    Quantity(
        "acc",
        ("m/s2",),
        r"""(lin(ear)? ?)?acc?(el(eration|erometer|erometre)?)?( data)?|a|beschl(eunigung)?|
        fahr ?beschleunigung|acceleration lineaire""",
        axial=True,
    ),
    Quantity(
        "torque",
        ("N.m",),
        r"""(m|t|moment|torque|couple|dreh ?moment)( z)?|(moment|torque|couple|dreh ?moment) ?(m|t)|
        (antriebs|rad|greifreifen|propulsion|wheel|axle|pushrim|rim) ?(dreh ?)?(moment|torque)|
        couple( de)? propulsion|moment (propulsif|moteur)|(push )?torque|hand ?rim ?(moment|torque)""",
    ),
    Quantity(
        "force",
        ("N",),
        r"""(push|tangential|propulsive|propulsion|drive|pushrim|hand) ?force|
        ((force|kraft) )?f ?(tan|tang|t|push)?|force|push|kraft|(antriebs|schub|tangential|umfangs) ?kraft|
        force( de)?( poussee| tangentielle| propulsion)?""",
    ),
    Quantity(
        "wheel_angle",
        ("rad",),
        r"""(wheel |rear wheel |rad ?|rim )?
        (angle|winkel|position angulaire|encoder|rotation|phi|theta)|angle( de)?( la)? roue|rad ?winkel|dreh ?winkel""",
    ),
    Quantity(
        "speed",
        ("m/s", "rad/s"),
        r"""(wheel |rear wheel |rad ?|rim |ground |encoder )?
        (speed|velocity|vel|v|geschw(indigkeit)?|vitesse|tempo|dreh ?zahl|rpm|omega|w|n)|wheel( rate)?|roue|
        rad ?(geschwindigkeit|drehzahl)|vitesse( de)?( la)? roue|fahr ?geschwindigkeit""",
    ),
    Quantity("x", ("m",), r"(pos(ition)? ?)?x( pos(ition)?)?"),
    Quantity("y", ("m",), r"(pos(ition)? ?)?y( pos(ition)?)?"),
)
PUSHED = ("torque", "force")
BESIDE = ("x", "y")  # axes of a rim across its axle: what it measures there pushes nobody


@dataclass(frozen=True)
class Guess:
    """What a header says: a quantity's name (or a channel's own), the axis of the sensor and the side, where it names them."""

    quantity: str
    axis: str = ""
    side: str = ""
    own: bool = False


def words(text: str) -> list[str]:
    """A header's words in small letters without accents; capitals within a word part it, as in GyroZ."""
    latin = text.replace("ß", "ss").replace("ψ", "psi").replace("ω", "omega")
    plain = unicodedata.normalize("NFKD", latin).encode("ascii", "ignore").decode()
    plain = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", plain)
    plain = re.sub(r"(?<=[a-z]{3})(?=[XYZ]\b)", " ", plain)
    return [word for word in re.split(r"[^a-z0-9]+", plain.lower()) if word]


def side_of(text: str) -> str:
    """The side that a name tells: l, r, or nothing."""
    found = {"l" if word in LEFT else "r" for word in words(text) if word in LEFT | RIGHT}
    return found.pop() if len(found) == 1 else ""


def sides(devices: list[str]) -> dict[str, str]:
    """The side of each device that its name tells by a word, or by a last letter in which it differs from another: swl, swr."""
    found = {name: side_of(name) for name in devices}
    for name in devices:
        pair = {"l": "r", "r": "l"}.get(name[-1:], "")
        if not found[name] and pair and len(name) >= LONG and f"{name[:-1]}{pair}" in devices:
            found[name] = name[-1]
    return found


def guess(header: str, unit: str | None) -> Guess | None:
    """What a column is by its header; None where nothing is known by such a name."""
    whole = split(header)[0]
    spelt = re.sub(r"\.(?=\s|$)", "", whole)  # Acc. X is no field X of a structure Acc
    path, _, bare = spelt.rpartition(".")  # of a structure's fields, or a group's columns, the last
    own = OWN.get(whole.lower()) or OWN.get("_".join(words(bare)), "")
    if own and own != "time" and (not path or _is_of(own, unit)):
        return Guess(own, own=True)
    for text in dict.fromkeys((bare, suffixed(bare)[0])):
        if found := _read(words(text), unit):
            return replace(found, side=found.side or side_of(path))
    return None


def _is_of(own: str, unit: str | None) -> bool:
    """May a channel be in this unit, where it is one that is known?"""
    known = [u for u in UNITS if unit and same_dimension(unit, u)]
    return not known or own not in BY_NAME or same_dimension(BY_NAME[own].unit.name, known[0])


def _read(parts: list[str], unit: str | None) -> Guess | None:
    for axial in (True, False):
        rest, side, axis = _without(parts, axial)
        text = " ".join(rest)
        for one in QUANTITIES:
            if (one.axial or one.name in PUSHED) != axial and axis:
                continue
            if one.names(text) and _fits(one, unit, axis, text):
                return Guess(one.name, axis, side)
    return None


def _without(parts: list[str], axial: bool) -> tuple[list[str], str, str]:
    """The words without side and axis, and these."""
    rest, side, axis = [], "", ""
    for word in parts:
        if word in LEFT | RIGHT and len(parts) > 1 and not side:
            side = "l" if word in LEFT else "r"
        elif axial and not axis and word in DIRECTIONS:
            axis = DIRECTIONS[word]
        elif axial and not axis and (found := re.fullmatch(r"([a-z]*?)([xyz])", word)) and (len(parts) > 1 or found[1]):
            axis = found[2]
            rest += [found[1]] if found[1] else []
        else:
            rest.append(word)
    return rest, side, axis


def _fits(quantity: Quantity, unit: str | None, axis: str, text: str) -> bool:
    """Is the unit of the right dimension, where there is one that is one; and is an axis there, where there must be?"""
    if quantity.axial and not axis and not (quantity.name == "acc" and unit):
        return False
    if quantity.name in PUSHED and axis in BESIDE:
        return False
    if quantity.name == "force" and axis:
        return False  # of three forces on a rim none is tangential all the way round
    if quantity.name == "speed" and not unit and text in ("wheel", "roue"):
        return False
    known = [u for u in UNITS if unit and same_dimension(unit, u)]
    return not known or any(u in quantity.units for u in known) or quantity.units == ("1",)
