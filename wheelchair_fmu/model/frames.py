"""Axes and signs, as in the paper (SAE J670).

::

                 x_m  forward (u)
                  ^
          fl      |      fr          yaw ψ, yaw rate ψ' and moments M_z are positive
          o-------|-------o          clockwise seen from above: z points down.
          |   t_f | a     |
          |      CM-------|--> y_m   right (v)
          |       | b     |
        =====-----|-----=====        rear wheels: no steering, lateral slip λ
          rl     t_r      rr         casters: free to swivel, angle δ

A force (F_x, F_y) at the point (x, y) turns the chair by M_z = x F_y − y F_x. More push on the left
wheel than on the right turns the chair to the right, ψ' > 0.
"""

from __future__ import annotations

from typing import Any

import casadi as cs


def to_room(forward: Any, right: Any, psi: Any) -> tuple[Any, Any]:
    """Components of a body-fixed vector along the room's x and y."""
    c, s = cs.cos(psi), cs.sin(psi)
    return forward * c - right * s, forward * s + right * c


def to_chair(x: Any, y: Any, psi: Any) -> tuple[Any, Any]:
    """Components of a vector given in room axes along x_m (forward) and y_m (right)."""
    c, s = cs.cos(psi), cs.sin(psi)
    return x * c + y * s, y * c - x * s


def moment(x: Any, y: Any, force_x: Any, force_y: Any) -> Any:
    """M_z about the origin of forces at (x, y), summed over the wheels of an axle."""
    return cs.sum1(x * force_y - y * force_x)


def velocity_at(x: Any, y: Any, u: Any, v: Any, psi_dot: Any) -> tuple[Any, Any]:
    """Velocity, along x_m and y_m, of the body-fixed point (x, y)."""
    return u - y * psi_dot, v + x * psi_dot
