"""Terms that no effect in the catalogue has: generic forces and errors, to ask whether anything is left over.

Each is an effect like any other, a coefficient times a function of the motion that respects units and
the mirror and is finite at standstill. `words` says it to a person.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..quantities import M_S2, N_M, ONE, RAD_S, N, Parameter, Unit
from .expression import effect_file, law
from .stage import Effect, adds, scales

U, V, R = "u / 1 [m/s]", "v / 1 [m/s]", "psi_dot / 1 [rad/s]"
LEFT_OR_RIGHT = "sum1(v_yf / magnitude(v_xf, 0.05 [m/s])) / 2"  # the casters' angle, roughly
# name -> (words, expression, where its size is told); scaled so that the coefficient is a force at about 1 m/s and 1 rad/s
FAST, TURNING, STEEP, SIDEWAYS = "at 1 m/s", "at 57 °/s", "where it is largest", "at 1 m/s sideways"
PUSHED, UNEVEN = "where both hands push with 40 N together", "where one hand pushes with 20 N more"
ODD = {
    "yaw": ("proportional to the yaw rate", R, TURNING),
    "yaw_dry": ("constant against the turn", "grip(psi_dot, psi_dot * psi_dot, 0.01 [rad/s])", ""),
    "yaw_yaw": ("growing with the square of the yaw rate", f"{R} * magnitude({R}, 0.01)", TURNING),
    "yaw_speed": ("proportional to yaw rate times speed", f"{R} * {U}", f"{FAST} and 57 °/s"),
    "side": ("proportional to the sideways speed", V, SIDEWAYS),
    "side_dry": ("constant against sideways motion", "direction(v, 0.01 [m/s])", ""),
    "caster": ("proportional to the casters' angle", LEFT_OR_RIGHT, "with the casters at 45°"),
    "heading_sin": ("with the sine of the heading", "sin(psi)", STEEP),
    "push_difference": ("proportional to the difference of the pushes", "(F_t[0] - F_t[1]) / 20 [N]", UNEVEN),
}
ONE_SIDED = {
    "constant": ("to one side while it rolls", "direction(u, 0.02 [m/s])", ""),
    "speed": ("to one side, proportional to speed", U, FAST),
    "speed_speed": ("to one side, with the square of the speed", f"{U} * magnitude({U}, 0.01)", FAST),
    "push": ("to one side, proportional to the push", "sum1(F_t) / 40 [N]", PUSHED),
    "heading_cos": ("with the cosine of the heading", "cos(psi)", STEEP),
    "only_right": ("in right turns only", f"fmax({R}, 0)", TURNING),
    "only_left": ("in left turns only", f"fmin({R}, 0)", TURNING),
}
EVEN = {
    "speed": ("proportional to speed", U, FAST),
    "speed_speed": ("with the square of the speed", f"{U} * magnitude({U}, 0.01)", FAST),
    "constant": ("constant against the motion", "grip(u, u * u, drag_eps)", ""),
    "turning": ("growing with the square of the yaw rate", f"{R} * {R} * direction(u, 0.02 [m/s])", TURNING),
    "turning_right": ("in right turns only", f"fmax({R}, 0) * direction(u, 0.02 [m/s])", TURNING),
    "turning_left": ("in left turns only", f"fmin({R}, 0) * direction(u, 0.02 [m/s])", TURNING),
    "push": ("proportional to the push", "sum1(F_t) / 40 [N]", PUSHED),
    "push_small": ("of small pushes only", "sum1(direction(F_t, 3 [N]))", "for each hand that pushes"),
    "heading_cos": ("with the cosine of the heading", "cos(psi)", STEEP),
    "heading_sin": ("with the sine of the heading", "sin(psi)", STEEP),
}
CASTER = {
    "spring": ("that pulls the casters straight", "-sin(delta)", "with the casters at 90°"),
    "spring_dry": ("that pulls the casters straight, the same at any angle", "-direction(sin(delta), 0.02)", ""),
    "one_sided": ("that turns both casters to one side", "1 + 0 * delta", ""),
}
WHEEL = {
    "speed": ("proportional to speed", f"magnitude({U}, 0.01)", FAST),
    "right": ("in right turns", "(1 + direction(psi_dot, 0.02 [rad/s])) / 2", ""),
    "left": ("in left turns", "(1 - direction(psi_dot, 0.02 [rad/s])) / 2", ""),
}
READINGS = {
    "read_yaw_rate": (RAD_S, "yaw rate reading"),
    "read_a_x": (M_S2, "forward acceleration reading"),
    "read_a_y": (M_S2, "sideways acceleration reading"),
}
SIZES = {N: 0.5, N_M: 0.2, RAD_S: 0.005, M_S2: 0.05, ONE: 0.02}


@dataclass(frozen=True)
class Term:
    """One generic term: q times an expression, added to a quantity, or a scale error of it. It is something, which goes with
    what is going on somehow; its size is told `at` some motion, as runs may not have driven as far."""

    id: str
    noun: str
    how: str
    at: str
    to: str
    unit: Unit
    expression: str
    factor: bool = False

    @property
    def words(self) -> str:
        return f"{self.noun} {self.how}".rstrip()

    @property
    def bounds(self) -> tuple[float, float]:
        return (-0.9, 5.0) if self.factor else (-50 - 100 * SIZES[self.unit], 50 + 100 * SIZES[self.unit])

    def effect(self) -> Effect:
        lower, upper = self.bounds
        q = Parameter(
            "q",
            self.unit,
            self.words,
            off=0.0,
            smallest_interesting=SIZES[self.unit],
            lower=lower,
            upper=upper,
            source="generic",
        )
        return Effect(self.id, self.words, (q,), ((scales if self.factor else adds)(self.to, law(self.expression)),))

    def file(self, id: str) -> str:
        """An effect file under another id, for a user to edit and add."""
        lower, upper = self.bounds
        return effect_file(
            id,
            self.words,
            self.to,
            self.unit,
            self.expression,
            size=SIZES[self.unit],
            lower=lower,
            upper=upper,
            factor=self.factor,
        )


def terms() -> dict[str, Term]:
    """The generic terms by id."""
    found = [
        *_family("F_x", N, "a force along the chair", EVEN),
        *_family("F_y", N, "a sideways force", ODD),
        *_family("F_y", N, "a sideways force", ONE_SIDED, "_sided"),
        *_family("M_z", N_M, "a turning moment", ODD),
        *_family("M_z", N_M, "a turning moment", ONE_SIDED, "_sided"),
        *_family("M_w", N_M, "a torque on each caster", CASTER),
        *_family("D_r", N, "a drag of the left rear wheel", _of_wheel("vertcat({}, 0 * u)"), "_l"),
        *_family("D_r", N, "a drag of the right rear wheel", _of_wheel("vertcat(0 * u, {})"), "_r"),
    ]
    for to, (unit, noun) in READINGS.items():
        found.append(Term(f"generic_{to}_offset", f"an offset of the {noun}", "", "", to, unit, "q + 0 * psi_dot"))
        found.append(Term(f"generic_{to}_scale", f"a scale error of the {noun}", "", "", to, ONE, "1 + q", factor=True))
    return {term.id: term for term in found}


def _family(to: str, unit: Unit, noun: str, bases: Mapping[str, tuple[str, str, str]], suffix: str = "") -> list[Term]:
    return [
        Term(f"generic_{to}_{key}{suffix}", noun, how, at, to, unit, f"q * ({expression})")
        for key, (how, expression, at) in bases.items()
    ]


def _of_wheel(which: str) -> dict[str, tuple[str, str, str]]:
    return {key: (how, which.format(expression), at) for key, (how, expression, at) in WHEEL.items()}


def told_at(name: str) -> str:
    """At which motion a term's size is told, ready to stand behind it; empty where it is the same at any."""
    term = terms().get(name)
    return f" {term.at}" if term and term.at else ""


def library() -> dict[str, Effect]:
    """The generic terms as effects, by id."""
    return {name: term.effect() for name, term in terms().items()}


# what a missing force may depend on -> (words, unit, expression, knots between which it goes straight)
VARIABLES = {
    "speed": ("speed", "m/s", "u", (-0.5, 0.0, 0.3, 0.6, 1.0, 1.4, 1.8, 2.4)),
    "yaw_rate": ("yaw rate", "rad/s", "psi_dot", (-2.0, -1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0, 2.0)),
    "heading": ("heading", "rad", "atan2(sin(psi), cos(psi))", (-3.1416, -2.0944, -1.0472, 0.0, 1.0472, 2.0944, 3.1416)),
    "push": ("push of both hands", "N", "sum1(F_t)", (-60.0, -20.0, -5.0, 5.0, 20.0, 40.0, 80.0, 140.0)),
    "caster": ("mean caster angle", "rad", LEFT_OR_RIGHT, (-0.8, -0.4, -0.2, -0.05, 0.05, 0.2, 0.4, 0.8)),
}


def profiles(term: Term) -> dict[str, Effect]:
    """A term's quantity as any function of one variable, by variable: an effect with one parameter per knot."""
    shape = "+ 0 * delta" if term.to == "M_w" else ""  # one for each caster
    found = {}
    for name, (words, _, x, knots) in VARIABLES.items():
        id = f"profile_{term.to}_{name}"
        parameters = tuple(
            Parameter(
                f"q{i}",
                term.unit,
                f"{words} {knot:g}",
                off=0.0,
                smallest_interesting=SIZES[term.unit],
                lower=-1e3,
                upper=1e3,
                source="generic",
            )
            for i, knot in enumerate(knots)
        )
        expression = " + ".join(f"q{i} * {_hat(x, knots, i)}" for i in range(len(knots)))
        found[id] = Effect(id, f"any function of {words}", parameters, (adds(term.to, law(expression + shape)),))
    return found


def _hat(x: str, knots: tuple[float, ...], i: int) -> str:
    """1 at knot i, 0 at its neighbours, straight between, level outside the outermost."""
    sides = []
    if i > 0:
        sides.append(f"({x} - ({knots[i - 1]})) / {knots[i] - knots[i - 1]!r}")
    if i + 1 < len(knots):
        sides.append(f"(({knots[i + 1]}) - {x}) / {knots[i + 1] - knots[i]!r}")
    both = f"fmin({sides[0]}, {sides[1]})" if len(sides) > 1 else f"fmin(1, {sides[0]})"
    return f"fmax(0, {both})"
