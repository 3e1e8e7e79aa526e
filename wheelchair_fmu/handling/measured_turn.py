"""What stiffness does a measured turn need, if only one hub's motion was recorded and nobody weighed the chair?

The sideways balance (21) at the CM, with casters that carry no side force, two rear tyres whose force is proportional to load,
opposite cambers and load that shifts outward, divided by the weight:

    a_y/g = c (n_l λ_l + n_r λ_r) + c_φ φ (n_l − n_r),   n = (1 − b/L)/2 ± (1 − b/L) a_y h/(g t)

Everything but the left hub's velocity and the yaw rate is unknown and drawn from a range, so the stiffness c is an interval.
Axes as in the model: right positive; the turn is to the right, so that the left wheel is outside.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.signal import savgol_filter

G = 9.81
RADIUS = 0.31  # m, of the wheels; with camber the contact lies R sin φ further out than the hub
SMOOTHING = 0.125  # s, of the parabola that accelerations are taken from

# From, to; SI units. The ranges are chosen, those of camber stiffness are Dressel's lower bound and Table 1.
RANGES: Mapping[str, tuple[float, float]] = {
    "half_track": (0.26, 0.34),  # from the centre line to a hub [m]
    "b": (0.04, 0.15),  # from the axle forward to the CM [m]
    "wheelbase": (0.38, 0.50),  # L [m]
    "height": (0.50, 0.70),  # of the CM, h [m]
    "camber": (0.0, 0.35),  # tops inward, φ [rad]: 0 to 20°
    "camber_stiffness": (0.43, 1.16),  # C_φ/N [1/rad]
}


@dataclass(frozen=True, eq=False)
class HubMotion:
    """Left hub: time (n,) [s], forward and rightward velocity u, v (n,) [m/s]; yaw rate (n,) [rad/s], clockwise."""

    time: np.ndarray
    u: np.ndarray
    v: np.ndarray
    psi_dot: np.ndarray

    def slip(self) -> np.ndarray:
        """−atan(v/u) (n,) [rad], as (12)."""
        return -np.arctan2(self.v, self.u)

    def rate(self, of: np.ndarray) -> np.ndarray:
        """Time derivative (n,), by a running parabola."""
        step = float(np.median(np.diff(self.time)))
        samples = 2 * round(SMOOTHING / step / 2) + 1
        return np.asarray(savgol_filter(of, samples, 2, deriv=1, delta=step))


Draws = Mapping[str, np.ndarray]
Wheel = tuple[np.ndarray, np.ndarray]


def draws(count: int, rng: np.random.Generator, zero_error: float, **given: float) -> Draws:
    """The unknowns (count, 1), uniform in their ranges, but for those given; the error of the slip's zero is normal with
    `zero_error` [rad] for standard deviation."""
    found = {name: rng.uniform(*ends, (count, 1)) for name, ends in RANGES.items()}
    found["slip_zero"] = rng.normal(0, zero_error, (count, 1))
    return found | {name: np.full((count, 1), value) for name, value in given.items()}


def balance(motion: HubMotion, unknown: Draws) -> tuple[np.ndarray, np.ndarray]:
    """What the slip has to carry and the slip that carries it, both (draws, n): a share of the weight [1], and Σ n λ [rad]."""
    carried, left, right = parts(motion, unknown)
    return carried, left[0] * left[1] + right[0] * right[1]


def parts(motion: HubMotion, unknown: Draws) -> tuple[np.ndarray, Wheel, Wheel]:
    """What the slip has to carry, (draws, n), and load share n and slip λ [rad] of the left and the right wheel."""
    q = unknown
    spin, turn = motion.psi_dot, motion.rate(motion.psi_dot)
    at_hub = motion.rate(motion.v) + motion.u * spin
    a_y = at_hub - spin**2 * q["half_track"] + turn * q["b"]  # the CM lies to the right of the left hub and before it
    out = RADIUS * np.sin(q["camber"])
    track = 2 * (q["half_track"] + out)
    rear = 1 - q["b"] / q["wheelbase"]
    shift = np.clip(a_y * q["height"] / (G * track), -0.5, 0.5)
    n_l, n_r = rear * (0.5 + shift), rear * (0.5 - shift)
    lam_l = -np.arctan2(motion.v, motion.u + spin * out) + q["slip_zero"]
    lam_r = -np.arctan2(motion.v, motion.u + spin * (out - track)) + q["slip_zero"]
    carried = a_y / G - q["camber_stiffness"] * q["camber"] * (n_l - n_r)
    return carried, (n_l, lam_l), (n_r, lam_r)


def stiffness(motion: HubMotion, unknown: Draws, chosen: np.ndarray) -> np.ndarray:
    """Normalised cornering stiffness c (draws,) [1/rad] by least squares over the `chosen` samples (n,), true or false."""
    carried, by = (part[:, chosen] for part in balance(motion, unknown))
    return (carried * by).sum(axis=1) / (by * by).sum(axis=1)


def scatter(motion: HubMotion, unknown: Draws, chosen: np.ndarray) -> np.ndarray:
    """RMS (draws,) of what one stiffness leaves of the carried force, against its RMS [1]."""
    carried, by = (part[:, chosen] for part in balance(motion, unknown))
    left = carried - stiffness(motion, unknown, chosen)[:, None] * by
    return np.sqrt((left**2).mean(axis=1) / (carried**2).mean(axis=1))


def dugoff(c: float, mu: np.ndarray, lam: np.ndarray) -> np.ndarray:
    """F/N [1] by (2), (4), (5), for a normalised stiffness c [1/rad]."""
    pull = c * np.tan(lam)
    gamma = np.minimum(mu / np.maximum(2 * np.abs(pull), 1e-12), 1.0)
    return np.asarray(pull * gamma * (2 - gamma))


def friction_needed(motion: HubMotion, unknown: Draws, chosen: np.ndarray, c: float) -> np.ndarray:
    """μ (draws,) with which a Dugoff tyre of normalised stiffness c [1/rad] carries the chosen samples' mean; by bisection.

    Infinite where even a linear tyre of that stiffness carries less.
    """
    carried, *wheels = parts(motion, unknown)
    goal = carried[:, chosen].mean(axis=1)

    def carries(mu: np.ndarray) -> np.ndarray:
        return sum(n * dugoff(c, mu[:, None], lam) for n, lam in wheels)[:, chosen].mean(axis=1)

    low, high = np.zeros_like(goal), np.full_like(goal, 10.0)
    beyond = carries(high) < goal
    for _ in range(50):
        middle = 0.5 * (low + high)
        enough = carries(middle) >= goal
        low, high = np.where(enough, low, middle), np.where(enough, middle, high)
    return np.where(beyond, np.inf, high)
