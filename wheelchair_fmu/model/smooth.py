"""The few smooth stand-ins for |x|, sign(x) and saturation, so that the equations need no branch.

All are odd or even exactly, analytic or nearly so, and finite with their derivatives everywhere.
"""

from __future__ import annotations

from typing import Any

import casadi as cs


def magnitude(x: Any, eps: Any) -> Any:
    """√(x² + ε²): |x| away from zero, never below ε."""
    return cs.sqrt(x * x + eps * eps)


def direction(x: Any, eps: Any) -> Any:
    """x / √(x² + ε²): the sign of x, passing smoothly through zero."""
    return x / magnitude(x, eps)


def grip(v: Any, speed_squared: Any, eps: Any) -> Any:
    """v / (|v|⁸ + ε⁸)^⅛, given |v|²: the direction against which dry resistance acts.

    The high power makes resistance reach its full size within a few ε, so a chair held by it on a
    slope creeps at about ε, whereas a tanh would creep at many times that near the limit.
    """
    return v / speed(speed_squared, eps)


def speed(speed_squared: Any, eps: Any) -> Any:
    """(|v|⁸ + ε⁸)^⅛, given |v|²: dry resistance over this is its part of a drag per speed."""
    s4, e4 = speed_squared * speed_squared, eps * eps * eps * eps
    return cs.sqrt(cs.sqrt(cs.sqrt(s4 * s4 + e4 * e4)))


def sine_over(z: Any, shape: Any, bend: Any) -> Any:
    """sin(C atan(w)) / (C z) with w = z − E (z − atan z): the Magic Formula over its own slope, 1 at z = 0.

    Near zero both ends of the fraction vanish; there its series 1 − k z², k = C²/6 + (1 + E)/3, stands
    in, which at |z| < 1e-3 is good to 1e-12.
    """
    near = 1e-3
    z2 = z * z
    series = 1 - (shape * shape / 6 + (1 + bend) / 3) * z2
    safe = cs.if_else(z2 < near * near, near, z)
    w = safe - bend * (safe - cs.atan(safe))
    return cs.if_else(z2 < near * near, series, cs.sin(shape * cs.atan(w)) / (shape * safe))
