"""Rear wheels that roll: their hub's speed is their rim's, until a brake that is stronger than friction stops them at once."""

from __future__ import annotations

import casadi as cs

from ...quantities import M_S, ONE, REAR, N
from ..resistance import LIGHTEST
from ..smooth import speed
from ..stage import Alternative, define, stage

ROUNDED = 1e-12  # keeps what friction along a wheel leaves of its side force above zero, where rounding could take it below
FRICTION = (
    define("locked", ONE, "0 where a rear wheel rolls, 1 where it slides along its plane", "+swap", REAR),
    define("braking", N, "friction that each rear wheel uses along its plane, μN where it slides", "+swap", REAR),
    define("side", ONE, "share of its side force that this leaves a rear wheel", "+swap", REAR),
)
SLIDING = define("sliding", M_S, "speed over which each rear wheel's dry friction acts", "+swap", REAR)
ALONG = (
    define("F_w", N, "force of each rear wheel along its plane", "+swap", REAR),
    define("rim", M_S, "speed of each rear wheel's rim about its axle, ωR", "+swap", REAR),
    define("creeping", N, "traction for which a wheel that is said to roll turns faster", "+swap", REAR),
)


@stage(*FRICTION)
def brakes(brake_rl, brake_rr, F_max, mu, N_r):
    """The friction circle: braking and side force together reach μN at most.

    With F the brake's force over μN, a wheel uses β = F / (1 + F⁸)^⅛ of μN and keeps √(1 − β²) of its side force. Beyond F = 1
    it locks: then it has no side force, and its friction is against the way that its patch slides. Between the two it is some
    of each, as F⁸ says, so that no force jumps; a light hand on the brake is passed on whole.
    """
    limit = mu * cs.fmax(N_r, LIGHTEST)
    F = F_max * cs.vertcat(brake_rl, brake_rr) / limit
    F2 = F * F
    rolling = 1 / (1 + F2 * F2 * F2 * F2)
    fourth = cs.sqrt(cs.sqrt(rolling))
    left = cs.sqrt(1 - F2 * (fourth - ROUNDED))  # √(1 − β²)
    return 1 - rolling, limit * F * cs.sqrt(fourth), rolling * left


@stage(SLIDING)
def patches(v_xw, v_yw, locked, drag_eps, v_onset):
    """A wheel that rolls resists along its plane, one that is locked whichever way it slides, and that at once."""
    return speed(v_xw * v_xw + locked * v_yw * v_yw, drag_eps + (1 - locked) * v_onset)


@stage(*ALONG)
def rear_longitudinal(F_t, D_w, d_r, locked, braking, sliding, v_xw):
    """Traction less what opposes the hub's motion, forward or backward."""
    F_w = F_t - (((1 - locked) * D_w + braking) / sliding + d_r) * v_xw
    return F_w, (1 - locked) * v_xw, F_t - (1 - locked) * braking * v_xw / sliding


LAW = Alternative("rolling", (brakes, patches, rear_longitudinal))
