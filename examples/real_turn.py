"""What stiffness a recorded fast turn needs of a wheelchair's tyres, and whether the linear law survives it.

    python examples/real_turn.py basket_sprint_frame_pose_120Hz.csv -o out

The recording is Kinetics Toolkit's sprint of a basketball chair (Chénier, Apache-2.0), as a table of the left hub's motion;
see docs/real-turn.md. It is read where it lies.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import pandas as pd

from wheelchair_fmu.cli.files import written
from wheelchair_fmu.handling.measured_turn import HubMotion, draws, dugoff, friction_needed, parts, scatter, stiffness
from wheelchair_fmu.report.measured import carried_figure
from wheelchair_fmu.report.saving import save

COLUMNS = ["t_s", "hubL_speed_mps", "hubL_slip_rad", "yaw_rate_radps"]
RECORDED = (17.40, 17.98)  # s, from the sprint's last samples to where the chair leaves the cameras
STEADY = (17.75, 17.95)  # s
SLIP_ZERO = np.radians(0.8)  # the recording's own figure for its slip
TABLE_1 = 5038.0 / 400.0  # C_λ/N [1/rad] of the paper's tyre A
COUNT, SEED = 20000, 1
BOUNDS = (5, 50, 95)  # percentiles


def read(file: Path) -> HubMotion:
    """The turn, from y left to y right."""
    table = pd.read_csv(file)[COLUMNS].dropna()
    t, speed, slip, yaw_rate = table[table.t_s.between(*RECORDED)].to_numpy().T
    return HubMotion(t, speed * np.cos(slip), -speed * np.sin(slip), -yaw_rate)


def interval(values: np.ndarray, digits: int = 1) -> str:
    low, middle, high = np.percentile(values, BOUNDS)
    return f"{middle:.{digits}f} ({low:.{digits}f} to {high:.{digits}f})"


def report(motion: HubMotion) -> list[str]:
    """The answers, one line each; intervals hold 90 %."""
    slip = np.degrees(motion.slip())
    steady = (motion.time >= STEADY[0]) & (motion.time <= STEADY[1])
    onset, late = (motion.time >= 17.45) & (slip < 2.5), (slip > 4.0) & (motion.time <= 17.95)
    at = lambda **given: draws(COUNT, np.random.default_rng(SEED), SLIP_ZERO, **given)  # noqa: E731
    unknown = at()
    carried, *wheels = parts(motion, unknown)
    lines = [
        f"slip of the left hub, 17.75 to 17.95 s: {slip[steady].mean():.2f}°",
        f"right wheel's slip: {interval(np.degrees(wheels[1][1][:, steady].mean(axis=1)))}°",
        f"lateral acceleration at the hub's speed: {(motion.u * motion.psi_dot)[steady].mean() / 9.81:.2f} g",
        f"of which slip has to carry, of the weight: {interval(carried[:, steady].mean(axis=1), 2)}",
        "normalised stiffness C_λ/N, 17.75 to 17.95 s [1/rad]:",
    ]
    lines += [
        f"    wheels at {angle:2d}° camber: {interval(stiffness(motion, at(camber=np.radians(angle)), steady))}"
        for angle in (0, 10, 20)
    ]
    c = stiffness(motion, unknown, steady)
    ratio = stiffness(motion, unknown, late) / stiffness(motion, unknown, onset)
    mu = friction_needed(motion, unknown, steady, TABLE_1)
    lines += [
        f"    camber unknown: {interval(c)}, per degree {interval(np.radians(c), 3)}",
        f"the paper's tyre A: {TABLE_1:.1f}; it is stiffer than needed in {100 * (c < TABLE_1).mean():.0f} % of the draws",
        f"stiffness beyond 4° against below 2.5°: {interval(ratio, 2)}; below 1 in {100 * (ratio < 1).mean():.0f} %",
        f"one stiffness for the whole turn leaves, of the force: {interval(100 * scatter(motion, unknown, onset | late), 0)} %",
        f"tyre A under the Dugoff law needs μ = {interval(mu, 2)}",
        f"a linear tyre A would slip by {interval(slip[steady].mean() * c / TABLE_1)}° instead",
    ]
    return lines


def draw(motion: HubMotion, file: Path) -> None:
    unknown = draws(COUNT, np.random.default_rng(SEED), SLIP_ZERO)
    carried, (n_l, lam_l), (n_r, lam_r) = parts(motion, unknown)
    shown = (motion.time >= 17.45) & (motion.time <= 17.95)
    slip = np.degrees((n_l * lam_l + n_r * lam_r) / (n_l + n_r))[:, shown][:, ::4]
    force = (carried / (n_l + n_r))[:, shown][:, ::4]
    steady = (motion.time >= STEADY[0]) & (motion.time <= STEADY[1])
    c = float(np.median(stiffness(motion, unknown, steady)))
    mu = np.median(friction_needed(motion, unknown, steady, TABLE_1))
    x = np.linspace(0, 9, 91)
    lam = np.radians(x)
    lines = {
        f"linear, {c:.1f} per rad": (x, c * lam),
        f"linear, tyre A, {TABLE_1:.1f} per rad": (x, TABLE_1 * lam),
        f"Dugoff, tyre A, μ = {mu:.2f}": (x, dugoff(TABLE_1, mu, lam)),
    }
    bounds = (np.percentile(q, BOUNDS, axis=0) for q in (slip, force))
    figure = carried_figure("a basketball chair's fast right turn", *bounds, lines)
    with written(file) as beside:
        save(figure, beside)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", type=Path)
    parser.add_argument("-o", "--output", type=Path, default=Path("out"))
    options = parser.parse_args()
    try:
        motion = read(options.recording)
    except (OSError, KeyError, ValueError) as error:
        parser.exit(1, f"{options.recording}: not that recording: {error}\n")
    print("\n".join(report(motion)))
    draw(motion, options.output / "real-turn.png")
    print(options.output / "real-turn.png")


if __name__ == "__main__":
    main()
