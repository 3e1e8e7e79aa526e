"""What the paper concludes in sections 5, 6 and in its conclusion, each as a measure on runs: our figure, holds or not.

The statements are in our words. A bound stands where the paper gives a number; where it says "slightly" or "very small"
the bound is ours and stands in the measure.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..driving import Result
from .runs import TYRE_B, Runs, Values, camber, scaled

SCALES = (0.5, 1.0, 2.0)
CORNERING, ALIGNING = "tyre.C_lambda", "tyre.C_m_lambda"
LIMITED = 0.10  # "limited", "slight": less than 10 % from half to double, or for 1° of camber
VERY_SMALL = 0.10  # "very small": less than a tenth of what the same change of the cornering stiffness does
ROUNDING = 1e-9


@dataclass(frozen=True)
class Finding:
    """Our figure, in words and units, and whether the statement holds."""

    figure: str
    holds: bool

    def __post_init__(self) -> None:
        object.__setattr__(self, "holds", bool(self.holds))  # numpy's would not go into JSON


@dataclass(frozen=True)
class Statement:
    """A sentence about the chair, where the paper says it, and how to find out."""

    id: str
    where: str
    says: str
    measure: Callable[[Runs], Finding]


def radius(run: Result) -> float:
    """R_c [m] at the end of a steady turn, by (23)."""
    return float(np.hypot(run["chair.u"][-1], run["chair.v"][-1]) / run["chair.psi_dot"][-1])


def slips(run: Result) -> np.ndarray:
    """Slip angles (2, n), left and right, in degrees."""
    return np.degrees([run["slip.rl"], run["slip.rr"]])


def slip_swing(runs: Runs, run: Result) -> np.ndarray:
    """Half of what the slip angles (2,), in degrees, go up and down in the last period."""
    last = slips(run)[:, runs.last_period(run)]
    return 0.5 * np.ptp(last, axis=1)


def slip_mean(runs: Runs, run: Result) -> np.ndarray:
    """Mean slip angles (2,) of the last period, in degrees."""
    return np.asarray(slips(run)[:, runs.last_period(run)][:, :-1].mean(axis=1))


def width(runs: Runs, run: Result) -> float:
    """Half the width [m] of the last period's path, across the line from its start to its end."""
    x, y = _last_path(runs, run)
    along = np.array([x[-1] - x[0], y[-1] - y[0]]) / np.hypot(x[-1] - x[0], y[-1] - y[0])
    return float(0.5 * np.ptp(y * along[0] - x * along[1]))


def advance(runs: Runs, run: Result) -> float:
    """How far [m] the last period brings the chair."""
    x, y = _last_path(runs, run)
    return float(np.hypot(x[-1] - x[0], y[-1] - y[0]))


def tightest(runs: Runs, run: Result) -> float:
    """The least |R_c| [m] of the last period."""
    return float(1 / np.abs(run["chair.curvature"][runs.last_period(run)]).max())


def _last_path(runs: Runs, run: Result) -> tuple[np.ndarray, np.ndarray]:
    last = runs.last_period(run)
    return run["chair.x"][last], run["chair.y"][last]


def _turns(runs: Runs, name: str) -> list[Result]:
    return [runs.turn(scaled(name, scale)) for scale in SCALES]


def _slaloms(runs: Runs, name: str) -> list[Result]:
    return [runs.slalom(scaled(name, scale)) for scale in SCALES]


def _list(values: Sequence[float] | np.ndarray, unit: str, digits: int = 3) -> str:
    return ", ".join(f"{v:.{digits}f}" for v in values) + (f" {unit}" if unit else "")


def _falls(values: Sequence[float]) -> bool:
    return bool(np.all(np.diff(values) < 0))


def _rises(values: Sequence[float]) -> bool:
    return bool(np.all(np.diff(values) > 0))


def _spread(values: Sequence[float] | np.ndarray) -> float:
    """From the first to the last, against the middle one."""
    return abs(values[-1] - values[0]) / abs(values[len(values) // 2])


# Section 5


def only_the_difference(runs: Runs) -> Finding:
    moved = [radius(runs.turn(total_push=push)) / radius(runs.turn()) - 1 for push in (20.0, -20.0)]
    most = max(map(abs, moved))
    return Finding(f"20 N more or less in all moves R by {100 * most:.6f} %", most < ROUNDING)


def total_push(runs: Runs) -> Finding:
    """(20) with u' = 0, from v and ψ' of the run: an independent sum."""
    run = runs.turn()
    values = {"chair.m": 80.0, "g": 9.81, "resistance.f_r": 0.012, "resistance.f_f": 0.020, **runs.setting.values}
    weight, a, b = values["chair.m"] * values["g"], 0.25, 0.20
    drag = weight * (values["resistance.f_r"] * a + values["resistance.f_f"] * b) / (a + b)
    expected = drag - values["chair.m"] * run["chair.v"][-1] * run["chair.psi_dot"][-1]
    needed = run["push.total_needed"][-1]
    off = abs(needed - expected) / max(drag, drag - expected)
    return Finding(f"{needed:.2f} N in the turn, {drag:.2f} N straight on", bool(off < 0.01))


# Section 6.1


def radius_falls_with_cornering(runs: Runs) -> Finding:
    radii = [radius(run) for run in _turns(runs, CORNERING)]
    return Finding(f"R = {_list(radii, 'm')}: {_percent(radii)}", _falls(radii) and _spread(radii) < LIMITED)


def slip_inverse_to_cornering(runs: Runs) -> Finding:
    ends = np.array([slips(run)[:, -1] for run in _turns(runs, CORNERING)])
    products = ends * np.array(SCALES)[:, None] / ends[1]
    off = float(np.abs(products - 1).max())
    return Finding(
        f"λ_rl = {_list(ends[:, 0], '°')}, λ_rr = {_list(ends[:, 1], '°')}: inverse to within {100 * off:.1f} %", off < LIMITED
    )


def slip_below_one_degree(runs: Runs) -> Finding:
    most = [float(np.abs(slips(run)).max()) for run in _everything(runs)]
    below = np.array(most) < 1
    return Finding(f"in {below.sum()} of {len(most)} runs; the most is {max(most):.2f}°", bool(below.mean() > 0.5))


def cornering_widens_the_slalom(runs: Runs) -> Finding:
    widths = [width(runs, run) for run in _slaloms(runs, CORNERING)]
    return Finding(f"half width {_list(widths, 'm', 4)}: {_percent(widths)}", _rises(widths) and _spread(widths) < LIMITED)


def wider_slaloms_lag(runs: Runs, name: str = CORNERING) -> Finding:
    found = sorted((width(runs, run), advance(runs, run)) for run in _slaloms(runs, name))
    forward = [ahead for _, ahead in found]
    return Finding(f"narrowest to widest advance {_list(forward, 'm', 4)} in a period", _falls(forward))


def slip_swing_falls_with_cornering(runs: Runs) -> Finding:
    swings = np.array([slip_swing(runs, run) for run in _slaloms(runs, CORNERING)])
    return Finding(
        f"left {_list(swings[:, 0], '°')}, right {_list(swings[:, 1], '°')}",
        _falls(swings[:, 0].tolist()) and _falls(swings[:, 1].tolist()),
    )


def slalom_slips_are_asymmetric(runs: Runs) -> Finding:
    means = np.array([slip_mean(runs, run) for run in _slaloms(runs, CORNERING)])
    return Finding(
        f"mean left {_list(means[:, 0], '°')}, right {_list(means[:, 1], '°')}",
        bool((means[:, 0] < -ROUNDING).all() and (means[:, 1] > ROUNDING).all()),
    )


def slalom_goes_straight_between(runs: Runs) -> Finding:
    curvature = runs.slalom()["chair.curvature"][runs.last_period(runs.slalom())]
    changes = int((np.diff(np.sign(curvature)) != 0).sum())
    least = 1 / np.abs(curvature).max()
    return Finding(f"1/R passes zero {changes} times a period; the least |R| is {least:.2f} m", changes == 2)


def better_tyre_is_more_precise(runs: Runs) -> Finding:
    """A path is the more precise the less it differs from that of wheels that hardly slip, of a hundred times the stiffness."""
    stiff: Values = {CORNERING: 100 * 5038.0}
    pairs = [[runs.turn({**tyre, **more}) for more in ({}, stiff)] for tyre in ({}, TYRE_B)]
    slip = [float(np.abs(slips(run)[:, -1]).max()) for run, _ in pairs]
    off = [100 * abs(radius(run) / radius(ideal) - 1) for run, ideal in pairs]
    return Finding(
        f"A: {slip[0]:.3f}°, {off[0]:.1f} % off the path of wheels that do not slip; B: {slip[1]:.3f}°, {off[1]:.1f} %",
        slip[0] < slip[1] and off[0] < off[1],
    )


def slalom_radius_falls_with_cornering(runs: Runs) -> Finding:
    radii = [tightest(runs, run) for run in _slaloms(runs, CORNERING)]
    return Finding(f"least |R| = {_list(radii, 'm')}", _falls(radii))


# Section 6.2


def radius_rises_with_aligning(runs: Runs) -> Finding:
    radii = [radius(run) for run in _turns(runs, ALIGNING)]
    return Finding(f"R = {_list(radii, 'm')}: {_percent(radii)}", _rises(radii))


def slip_falls_slightly_with_aligning(runs: Runs) -> Finding:
    ends = np.array([slips(run)[:, -1] for run in _turns(runs, ALIGNING)])
    falls = all(_falls(ends[:, side].tolist()) for side in (0, 1))
    return Finding(f"λ_rl = {_list(ends[:, 0], '°')}, λ_rr = {_list(ends[:, 1], '°')}", falls and _spread(ends[:, 1]) < LIMITED)


def aligning_narrows_the_slalom(runs: Runs) -> Finding:
    widths = [width(runs, run) for run in _slaloms(runs, ALIGNING)]
    return Finding(f"half width {_list(widths, 'm', 4)}: {_percent(widths)}", _falls(widths) and _spread(widths) < LIMITED)


def aligning_lags(runs: Runs) -> Finding:
    return wider_slaloms_lag(runs, ALIGNING)


def aligning_hardly_moves_slips(runs: Runs) -> Finding:
    aligning, cornering = (
        max(_spread([slip_swing(runs, run)[side] for run in _slaloms(runs, name)]) for side in (0, 1))
        for name in (ALIGNING, CORNERING)
    )
    return Finding(
        f"half to double: {100 * aligning:.1f} % of the swing; C_λ: {100 * cornering:.0f} %", aligning < VERY_SMALL * cornering
    )


def slalom_radius_rises_with_aligning(runs: Runs) -> Finding:
    radii = [tightest(runs, run) for run in _slaloms(runs, ALIGNING)]
    return Finding(f"least |R| = {_list(radii, 'm')}", _rises(radii) and _spread(radii) < LIMITED)


# Section 6.3


def opposite_cambers_cancel(runs: Runs) -> Finding:
    straight, leaning = (runs.turn(values, delta_force=0.0) for values in ({}, camber(-1.0, 1.0)))
    aside = float(leaning["chair.y"][-1] - straight["chair.y"][-1])
    return Finding(
        f"±1° straight on: {1000 * aside:.3f} mm aside after 10 m; +1° on both: "
        f"{runs.turn(camber(1.0), delta_force=0.0)['chair.y'][-1]:.2f} m",
        abs(aside) < 1e-6,
    )


def camber_tightens_the_turn(runs: Runs) -> Finding:
    radii = [radius(runs.turn(camber(angle))) for angle in (-1.0, 0.0, 1.0)]
    return Finding(f"−1°, 0°, 1°: R = {_list(radii, 'm')}", _falls(radii))


def camber_is_limited(runs: Runs) -> Finding:
    radii = [radius(runs.turn(camber(angle))) for angle in (-1.0, 0.0, 1.0)]
    return Finding(f"1° moves R by {100 * abs(radii[2] / radii[1] - 1):.1f} %", _spread(radii) / 2 < LIMITED)


def camber_relieves_slip(runs: Runs) -> Finding:
    ends = np.array([slips(runs.turn(camber(angle)))[:, -1] for angle in (-1.0, 0.0, 1.0)])
    return Finding(
        f"−1°, 0°, 1°: λ_rl = {_list(ends[:, 0], '°')}, λ_rr = {_list(ends[:, 1], '°')}",
        _falls(ends[:, 0].tolist()) and _falls(ends[:, 1].tolist()),
    )


def _leaning_slaloms(runs: Runs) -> list[Result]:
    return [runs.slalom(camber(angle)) for angle in (0.0, 0.5, 1.0)]


def camber_makes_the_slalom_drift(runs: Runs) -> Finding:
    ends = [float(run["chair.y"][-1]) for run in _leaning_slaloms(runs)]
    return Finding(f"0°, 0.5°, 1°: y = {_list(ends, 'm', 2)} after three periods", _rises(ends))


def camber_shifts_slips(runs: Runs) -> Finding:
    means = np.array([slip_mean(runs, run) for run in _leaning_slaloms(runs)])
    uneven = np.abs(means).max(axis=1)
    return Finding(
        f"0°, 0.5°, 1°: mean left {_list(means[:, 0], '°')}, right {_list(means[:, 1], '°')}",
        _falls(means[:, 0].tolist()) and _falls(means[:, 1].tolist()) and _rises(uneven.tolist()),
    )


def negative_camber_mirrors_the_slalom(runs: Runs) -> Finding:
    ends = [float(run["chair.y"][-1]) for run in (runs.slalom(camber(1.0)), runs.slalom(camber(-1.0), mirrored=True))]
    return Finding(f"±1°, first push to either side: y = {_list(ends, 'm', 2)}", abs(sum(ends)) < 1e-6 * abs(ends[0]) > 0)


def camber_takes_effort(runs: Runs) -> Finding:
    """The difference of pushes that keeps the chair straight, by two turns between which the yaw rate is all but linear."""
    held = []
    for angle in (0.0, 0.5, 1.0):
        leaning = camber(angle)
        free, pushed = (
            float(runs.turn(leaning, delta_force=force)["chair.psi_dot"][-1])
            for force in (0.0, -0.01 * runs.setting.delta_force)
        )
        held.append(0.01 * runs.setting.delta_force * free / (free - pushed))
    return Finding(f"0°, 0.5°, 1°: each hand {_list(held, 'N', 2)} off the mean to go straight", _rises(held))


def unlike_cambers_drift(runs: Runs) -> Finding:
    angles = (0.0, 0.0), (0.0, 1.0), (1.0, 1.0)
    ends = [float(runs.turn(camber(*pair), delta_force=0.0)["chair.y"][-1]) for pair in angles]
    return Finding(
        f"right 0°, right 1°, both 1°: y = {_list(ends, 'm', 2)} after 10 m straight on", _rises(ends) and ends[1] < 0.1 * 10.0
    )


# Conclusion


def seven_per_cent(runs: Runs) -> Finding:
    spreads = {name: _spread([radius(run) for run in _turns(runs, name)]) for name in (CORNERING, ALIGNING)}
    both = [radius(runs.turn({**scaled(CORNERING, c), **scaled(ALIGNING, 1 / c)})) for c in SCALES]
    text = ", ".join(f"{symbol} {100 * s:.1f} %" for symbol, s in zip(("C_λ", "C_mλ"), spreads.values(), strict=True))
    return Finding(
        f"half to double: {text}; both at once, opposite ways, {100 * _spread(both):.1f} %",
        0.03 < max(spreads.values()) < 0.075,
    )


def stiffness_acts_where_it_is_tight(runs: Runs) -> Finding:
    shares = []
    for name in (CORNERING, ALIGNING):
        soft, middle, stiff = (run["chair.curvature"][runs.last_period(run)] for run in _slaloms(runs, name))
        place = int(np.abs(stiff - soft).argmax())
        shares.append(float(abs(middle[place]) / np.abs(middle).max()))
    return Finding(
        f"where 1/R differs most it has {100 * shares[0]:.0f} % (C_λ), {100 * shares[1]:.0f} % (C_mλ) of its peak",
        min(shares) > 0.7,
    )


def _everything(runs: Runs) -> list[Result]:
    by_stiffness = [[*_turns(runs, name), *_slaloms(runs, name)] for name in (CORNERING, ALIGNING)]
    leaning: list[Values] = [camber(angle) for angle in (-1.0, 1.0)]
    return [*by_stiffness[0], *by_stiffness[1], *map(runs.turn, leaning), *_leaning_slaloms(runs)]


def _percent(values: Sequence[float]) -> str:
    return f"{100 * (values[-1] - values[0]) / values[1]:+.1f} %"


STATEMENTS = (
    Statement("difference", "5", "only the difference of the pushes turns the chair", only_the_difference),
    Statement("total", "5, (20)", "the total push that holds the speed follows from (20)", total_push),
    Statement("radius-cornering", "6.1, Fig. 12", "more C_λ, a slightly smaller radius", radius_falls_with_cornering),
    Statement("slip-cornering", "6.1, Fig. 12", "slip is roughly inverse to C_λ", slip_inverse_to_cornering),
    Statement("slip-1-degree", "6.1, Fig. 12", "slip stays below 1° in most cases", slip_below_one_degree),
    Statement("slalom-cornering", "6.1, Fig. 13", "more C_λ, a slightly wider slalom", cornering_widens_the_slalom),
    Statement("lag-cornering", "6.1, Fig. 13", "the wider slalom lags", wider_slaloms_lag),
    Statement("swing-cornering", "6.1, Fig. 13", "more C_λ, less slip in the slalom", slip_swing_falls_with_cornering),
    Statement("asymmetry", "6.1, Fig. 13", "slalom slips: right mean > 0, left mean < 0", slalom_slips_are_asymmetric),
    Statement("infinite-radius", "6.1, Fig. 14", "the radius goes through ±∞ between turns", slalom_goes_straight_between),
    Statement(
        "slalom-radius-cornering",
        "6.1, Fig. 14",
        "more C_λ, a smaller radius in the slalom",
        slalom_radius_falls_with_cornering,
    ),
    Statement(
        "tyre-quality",
        "6.1",
        "the high quality tyre A slips less than the low cost tyre B, and its path is more precise",
        better_tyre_is_more_precise,
    ),
    Statement("radius-aligning", "6.2, Fig. 15", "more C_mλ, a larger radius", radius_rises_with_aligning),
    Statement("slip-aligning", "6.2, Fig. 15", "more C_mλ, slightly less slip", slip_falls_slightly_with_aligning),
    Statement("slalom-aligning", "6.2, Fig. 16", "more C_mλ, a slightly narrower slalom", aligning_narrows_the_slalom),
    Statement("lag-aligning", "6.2, Fig. 16", "a small lag here too", aligning_lags),
    Statement("swing-aligning", "6.2, Fig. 16", "C_mλ hardly moves the slips of the slalom", aligning_hardly_moves_slips),
    Statement(
        "slalom-radius-aligning",
        "6.2, Fig. 17",
        "more C_mλ, a slightly larger radius in the slalom",
        slalom_radius_rises_with_aligning,
    ),
    Statement("opposite-cambers", "6.3", "equal and opposite cambers give no net force", opposite_cambers_cancel),
    Statement("camber-limited", "6.3, Fig. 18", "moderate camber has a limited influence", camber_is_limited),
    Statement(
        "camber-radius", "6.3, Fig. 18", "positive camber tightens the turn, negative widens it", camber_tightens_the_turn
    ),
    Statement("camber-slip", "6.3, Fig. 18", "positive camber relieves the slip", camber_relieves_slip),
    Statement("camber-drift", "6.3, Fig. 19", "positive camber makes the slalom drift to +y", camber_makes_the_slalom_drift),
    Statement(
        "camber-shift", "6.3, Fig. 19", "more camber shifts the slips and makes them more asymmetric", camber_shifts_slips
    ),
    Statement(
        "camber-mirrored",
        "6.3, Fig. 19",
        "with negative angles the slalom is the mirror image",
        negative_camber_mirrors_the_slalom,
    ),
    Statement("camber-effort", "6.3", "camber takes more effort to go straight", camber_takes_effort),
    Statement("unlike-cambers", "conclusion", "unlike cambers of the wheels may cause a small drift", unlike_cambers_drift),
    Statement("seven-per-cent", "conclusion", "large changes of C_λ or C_mλ move the radius by up to 7 %", seven_per_cent),
    Statement("tight-part", "conclusion", "the stiffnesses act where the slalom is tightest", stiffness_acts_where_it_is_tight),
)
