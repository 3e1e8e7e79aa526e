"""Terms that no effect in the catalogue has: generic forces and errors, to ask whether anything is left over.

Each is an effect like any other, a coefficient times a function of the motion that respects units and
the mirror and is finite at standstill. `words` says it to a person.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as cs

from ..quantities import M_S, M_S2, N_M, ONE, RAD_S, N, Parameter, Quantity, Unit
from .smooth import direction, grip, magnitude
from .stage import Effect, adds, scales

# name -> (words, function, mirror of the function); scaled so that a coefficient is a force at about 1 m/s and 1 rad/s
ODD: dict[str, tuple[str, Callable[..., Any]]] = {
    "yaw": ("proportional to the yaw rate", lambda psi_dot: psi_dot),
    "yaw_dry": ("constant against the turn", lambda psi_dot: grip(psi_dot, psi_dot * psi_dot, 0.01)),
    "yaw_yaw": ("growing with the square of the yaw rate", lambda psi_dot: psi_dot * magnitude(psi_dot, 0.01)),
    "yaw_speed": ("proportional to yaw rate times speed", lambda psi_dot, u: psi_dot * u),
    "side": ("proportional to the sideways speed", lambda v: v),
    "side_dry": ("constant against sideways motion", lambda v: direction(v, 0.01)),
    "caster": ("proportional to the casters' angle", lambda v_yf, v_xf: cs.sum1(v_yf / magnitude(v_xf, 0.05)) / 2),
    "heading_sin": ("with the sine of the heading", lambda psi: cs.sin(psi)),
    "push_difference": ("proportional to the difference of the pushes", lambda F_t: (F_t[0] - F_t[1]) / 20),
}
ONE_SIDED: dict[str, tuple[str, Callable[..., Any]]] = {
    "constant": ("to one side while it rolls", lambda u: direction(u, 0.02)),
    "speed": ("to one side, proportional to speed", lambda u: u),
    "speed_speed": ("to one side, with the square of the speed", lambda u: u * magnitude(u, 0.01)),
    "push": ("to one side, proportional to the push", lambda F_t: cs.sum1(F_t) / 40),
    "heading_cos": ("with the cosine of the heading", lambda psi: cs.cos(psi)),
    "only_right": ("in right turns only", lambda psi_dot: cs.fmax(psi_dot, 0)),
    "only_left": ("in left turns only", lambda psi_dot: cs.fmin(psi_dot, 0)),
}
EVEN: dict[str, tuple[str, Callable[..., Any]]] = {
    "speed": ("proportional to speed", lambda u: u),
    "speed_speed": ("with the square of the speed", lambda u: u * magnitude(u, 0.01)),
    "constant": ("constant against the motion", lambda u, drag_eps: grip(u, u * u, drag_eps)),
    "turning": ("growing with the square of the yaw rate", lambda psi_dot, u: psi_dot * psi_dot * direction(u, 0.02)),
    "turning_right": ("in right turns only", lambda psi_dot, u: cs.fmax(psi_dot, 0) * direction(u, 0.02)),
    "turning_left": ("in left turns only", lambda psi_dot, u: cs.fmin(psi_dot, 0) * direction(u, 0.02)),
    "push": ("proportional to the push", lambda F_t: cs.sum1(F_t) / 40),
    "push_small": ("of small pushes only", lambda F_t: cs.sum1(direction(F_t, 3.0))),
    "heading_cos": ("with the cosine of the heading", lambda psi: cs.cos(psi)),
    "heading_sin": ("with the sine of the heading", lambda psi: cs.sin(psi)),
}
CASTER: dict[str, tuple[str, Callable[..., Any]]] = {
    "spring": ("that pulls the casters straight", lambda delta: -cs.sin(delta)),
    "spring_dry": ("that pulls the casters straight, the same at any angle", lambda delta: -direction(cs.sin(delta), 0.02)),
    "one_sided": ("that turns both casters to one side", lambda delta: 1 + 0 * delta),
}
SIZES = {N: 0.5, N_M: 0.2, M_S: 0.01, RAD_S: 0.005, M_S2: 0.05, ONE: 0.02}


def _effect(name: str, to: str, unit: Unit, words: str, basis: Callable[..., Any], symbol: str = "q") -> Effect:
    coefficient = Parameter(symbol, unit, words, off=0.0, smallest_interesting=SIZES[unit], lower=-100.0 * SIZES[unit] - 50,
                            upper=100.0 * SIZES[unit] + 50, source="generic")  # fmt: skip
    return Effect(name, words, parameters=(coefficient,), contributions=(adds(to, _times(basis)),))


def _times(basis: Callable[..., Any]) -> Callable[..., Any]:
    """q · basis(...), as a law whose arguments are q and the basis' own."""
    from inspect import Parameter as Argument
    from inspect import signature

    def law(q, *values):
        return q * basis(*values)

    own = [Argument("q", Argument.POSITIONAL_OR_KEYWORD), *signature(basis).parameters.values()]
    law.__signature__ = signature(basis).replace(parameters=own)  # type: ignore[attr-defined]
    return law


def _family(to: str, unit: Unit, noun: str, *bases: dict[str, tuple[str, Callable[..., Any]]]) -> dict[str, Effect]:
    found = {}
    for base in bases:
        for key, (words, function) in base.items():
            name = f"generic_{to}_{key}" + ("_sided" if base is ONE_SIDED else "")
            found[name] = _effect(name, to, unit, f"{noun} {words}", function)
    return found


def _readings() -> dict[str, Effect]:
    found = {}
    for to, unit, noun in (("read_yaw_rate", RAD_S, "yaw rate reading"), ("read_a_x", M_S2, "forward acceleration reading"),
                           ("read_a_y", M_S2, "sideways acceleration reading")):  # fmt: skip
        found[f"generic_{to}_offset"] = _effect(f"generic_{to}_offset", to, unit, f"an offset of the {noun}",
                                                lambda psi_dot: 1 + 0 * psi_dot)  # fmt: skip
        scale = Parameter("q", ONE, f"scale error of the {noun}", off=0.0, smallest_interesting=0.02, lower=-0.9, upper=5.0,
                          source="generic")  # fmt: skip
        name = f"generic_{to}_scale"
        found[name] = Effect(name, f"a scale error of the {noun}", (scale,), (scales(to, lambda q: 1 + q),))
    return found


def library() -> dict[str, Effect]:
    """The generic terms by id."""
    return {
        **_family("F_x", N, "a force along the chair", EVEN),
        **_family("F_y", N, "a sideways force", ODD, ONE_SIDED),
        **_family("M_z", N_M, "a turning moment", ODD, ONE_SIDED),
        **_family("M_w", N_M, "a torque on each caster", CASTER),
        **_readings(),
    }


__all__ = ["Quantity", "library"]
