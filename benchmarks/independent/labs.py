"""Writes lab folders: an afternoon's raw files of several loggers, and what was hidden in them, drawn by a seed.

`python -m benchmarks.independent.labs OUT --seeds 1 2 3` makes OUT/lab-1 and so on, and OUT/answers.json beside them. A chair
and a rider are drawn who differ from the protocol as far as scales and tapes allow; floors are uneven, each logger has a clock
of its own, torque rims have a baseline and a ripple, and the rider's body answers the pushes and moves by itself besides. In
every third lab it was filmed.

`--worn` draws labs of the kind that recordings of a person are: a heavy rider who goes straight and was filmed, no sensor on
the frame, torque rims a newton metre or more off, and casters whose bearings hold with 0.2 to 0.5 N m.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from .chair import Chair, Start, simulate
from .hidden import Truth, hide

FINE = 0.005  # s between samples of the simulation
PULLS_ASIDE = (
    "rolling_resistance_asymmetry",
    "floor_cross_slope",
    "camber_misalignment",
    "cm_lateral_offset",
    "toe_misalignment",
)
TURNS_HARD = ("pivot_torque", "turn_slip", "scrub_torque", "scrub_torque_viscous")
# What may be hidden, its size, and all names that say it fairly.
HIDDEN: tuple[tuple[dict[str, dict[str, float]], tuple[str, ...]], ...] = (
    ({}, ()),
    ({"rolling_resistance_asymmetry": {"D": 1.5}}, PULLS_ASIDE),
    ({"pivot_torque": {"M": 3.0}}, TURNS_HARD),
    ({"cm_lateral_offset": {"y": 0.015}}, PULLS_ASIDE),
    ({"scrub_torque": {"M": 1.0}}, TURNS_HARD),
    ({"camber_misalignment": {"sum": 0.02}}, PULLS_ASIDE),
    ({"aerodynamic_drag": {"k": 1.2}}, ("aerodynamic_drag", "rolling_resistance_speed")),
    ({"floor_cross_slope": {"theta": 0.004}}, PULLS_ASIDE),
)
SLIGHT = ("trunk_motion", "caster_trail", "caster_friction", "caster_inertia")  # that every one of these chairs has
NOISE = {
    "M": 0.12,
    "speed": 0.006,
    "yaw_rate": 0.5,
    "a": 0.06,
    "x": 0.001,
    "yaw": 0.1,
    "s": 0.002,
}  # N m, m/s, °/s, m/s², m, °, m
RATES = {"left": 240.0, "right": 200.0, "frame": 100.0, "markers": 100.0}
WORN = {"left": 240.0, "right": 240.0, "markers": 150.0}
FILMED = 0.6  # of all that was weighed, what moves as the filmed part of the rider's body does
SETTLING = 1.5  # s of a run that its figures leave out


@dataclass(frozen=True)
class Rider:
    """What the hands do in a chair of 80 kg: strokes of so many N each, the first three to get going, and each hand's share."""

    what: str
    first: float
    later: float
    left: float = 1.0
    right: float = 1.0
    seconds: float = 18.0
    until: float = 99.0
    weave: float = 0.0


STRAIGHT = (
    Rider("straight, own pace", 70, 28),
    Rider("straight, slow", 40, 18),
    Rider("straight, fast", 85, 38),
    Rider("four pushes, then hands off", 60, 50, until=5.5),
    Rider("three pushes, then hands off", 50, 50, until=4.5),
    Rider("kept: straight, own pace", 70, 28),
    Rider("kept: straight, fast from the start", 90, 40),
)
RUNS = (
    Rider("straight, own pace", 70, 28),
    Rider("a coast-down", 85, 70, until=6.0),
    Rider("circle to the right", 55, 28, left=1.45, right=0.55),
    Rider("circle to the left", 55, 28, left=0.55, right=1.45),
    Rider("weaving", 65, 28, weave=0.6),
    Rider("kept: a coast-down, slower", 60, 40, until=5.0),
    Rider("kept: a wider circle to the left, then rolling out", 65, 28, left=0.75, right=1.25, until=14.0),
)


@dataclass(frozen=True)
class Lab:
    """A chair with its rider, as they are: lengths in m, masses in kg; `ripple` in N m by side."""

    truth: Truth
    radius: float
    spin: float
    ripple: Mapping[str, float]
    baseline: float
    independent: float
    filmed: bool
    told: Mapping[str, float]
    runs: tuple[Rider, ...]
    rates: Mapping[str, float]


def lab(seed: int, worn: bool = False) -> tuple[Lab, tuple[str, ...], tuple[str, ...]]:
    """What a seed draws, what is hidden in it, and all names that say it fairly."""
    rng = np.random.default_rng([seed, 1])
    effects, fair = ({}, ()) if worn else HIDDEN[seed % len(HIDDEN)]
    m, base, radius, spin = rng.uniform(75, 120), rng.uniform(0.38, 0.45), 0.305, 0.12
    b, strong = rng.uniform(0.08, 0.18), worn or seed % 3 == 0
    chair = Chair(
        m=m,
        I_z=m * rng.uniform(0.05, 0.065),
        a=base - b,
        b=b,
        t_r=rng.uniform(0.53, 0.58),
        t_f=rng.uniform(0.40, 0.46),
        C_lambda=rng.uniform(4300, 5700),
        f_r=rng.uniform(0.008, 0.013),
        f_f=rng.uniform(0.014, 0.020),
        swivel_dry=0.03,
        lean=rng.uniform(0.006, 0.008) if strong else rng.uniform(0.002, 0.004),
        lean_frequency=rng.uniform(1.1, 1.5),
        lean_damping=2 * rng.uniform(0.18, 0.3),
        m_spin=2 * spin / radius**2,
        floor=rng.uniform(0.001, 0.003),
    )
    if worn:
        heavier = rng.uniform(115, 125) / m
        m, chair = m * heavier, replace(chair, m=m * heavier, I_z=chair.I_z * heavier, swivel_dry=rng.uniform(0.2, 0.5))
    told = {
        "mass": round(m + rng.normal(0, 2.5)),
        "radius": round(radius + rng.normal(0, 0.001), 3),
        "track": round(chair.t_r + rng.normal(0, 0.004), 3),
        "wheelbase": round(base + rng.normal(0, 0.004), 3),
        "cm-ahead": round(b + rng.normal(0, 0.01), 2),
        "caster-track": round(chair.t_f + rng.normal(0, 0.008), 2),
    }
    if strong:
        told["person"] = round(FILMED * told["mass"], 1)
    ripple = {"left": rng.uniform(1, 1.5) if worn else rng.uniform(0, 0.6), "right": rng.uniform(0, 0.3)}
    truth = hide(Truth(chair=chair), effects)
    drawn = Lab(
        truth=truth,
        radius=radius,
        spin=spin,
        ripple=ripple,
        baseline=1.0 if worn else 0.3,
        independent=0.35 if strong else 0.2,
        filmed=strong,
        told=told,
        runs=STRAIGHT if worn else RUNS,
        rates=WORN if worn else RATES,
    )
    return drawn, tuple(effects), fair


def pushes(run: Rider, mass: float, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, and what the left and the right hand push (n,), in N: nothing for two seconds, then strokes till `until`."""
    time = np.arange(round(run.seconds / FINE) + 1) * FINE
    left, right = np.zeros_like(time), np.zeros_like(time)
    at, stroke = rng.uniform(2.0, 2.4), 0
    while at < min(run.until, run.seconds - 1.0):
        lasting, size = rng.uniform(0.38, 0.5), mass / 80 * (run.first if stroke < 3 else run.later) * rng.uniform(0.85, 1.15)
        wave = np.where((time >= at) & (time < at + lasting), np.sin(np.pi * np.clip((time - at) / lasting, 0, 1)), 0.0)
        aside = run.weave * np.sin(2 * np.pi * stroke / 6)
        late = round(rng.normal(0, 0.01) / FINE)
        left += size * (run.left + aside) * rng.uniform(0.93, 1.07) * np.roll(wave, late)
        right += size * (run.right - aside) * rng.uniform(0.93, 1.07) * wave
        at, stroke = at + rng.uniform(0.95, 1.2), stroke + 1
    return time, left, right


def urge(time: np.ndarray, hands: np.ndarray, lab: Lab, rng: np.random.Generator) -> np.ndarray:
    """How far forward (m) a rider who pushes leans by themselves: a slow random motion while strokes last, whose square is
    about `independent` times that of what pushes ask for."""
    noise = _slow(_slow(rng.standard_normal(len(time)), 0.12), 0.12)
    busy = _slow(np.minimum(1.0, np.abs(hands) / 10), 0.5)
    asked = lab.truth.chair.lean / 80 * hands
    return lab.independent**0.5 * asked.std() / noise.std() * busy / max(busy.std(), 1e-9) * noise * 0.7


def _slow(values: np.ndarray, seconds: float) -> np.ndarray:
    out, level, keep = np.empty_like(values), 0.0, np.exp(-FINE / seconds)
    for i, value in enumerate(values):
        level = keep * level + (1 - keep) * value
        out[i] = level
    return out


def write(folder: Path, seed: int, worn: bool = False) -> dict[str, Any]:
    """A lab's raw files, and its answer."""
    drawn, effects, fair = lab(seed, worn)
    folder.mkdir(parents=True, exist_ok=True)
    runs, floors = {}, {}
    for number, run in enumerate(drawn.runs, 1):
        name = f"run{number:02d}"
        runs[name], held = _run(folder, name, run, drawn, np.random.default_rng([seed, 2, number]))
        if held:
            floors[name] = held
    return {
        "hidden": _hidden(drawn),
        "given": drawn.told,
        "verdict": {"missing": list(effects), "also": list(fair), "small": list(SLIGHT)},
        "runs": runs,
        "floor_of_the_held_out_runs": floors,
    }


def _hidden(drawn: Lab) -> dict[str, Any]:
    chair = drawn.truth.chair
    known = ("m", "I_z", "a", "b", "t_r", "t_f", "f_r", "f_f", "C_lambda")
    return {
        **{name: getattr(chair, name) for name in known},
        "wheel_radius": drawn.radius,
        "wheel_inertia_each_kgm2": drawn.spin,
        "caster_trail": chair.trail,
        "caster_friction": chair.swivel_dry,
        "floor_slope_rms": chair.floor,
        "turn_slip": {"M_p": chair.pivot},
        "chair": asdict(chair),
        "filmed": drawn.filmed,
    }


def _run(folder: Path, name: str, run: Rider, drawn: Lab, rng: np.random.Generator) -> tuple[dict[str, Any], dict[str, Any]]:
    """Files of one run; its answer, and what a simulation that knows all but the floor leaves of it, where it is kept."""
    time, left, right = pushes(run, drawn.truth.chair.m, rng)
    moved = urge(time, left + right, drawn, rng)
    turned = rng.uniform(-0.5, 0.5, 2)
    place, heading = rng.uniform(0, 60, 2), rng.uniform(-np.pi, np.pi)
    start = Start(x=place[0], y=place[1], yaw=heading, swivel_r=turned[0], swivel_l=turned[1])
    chair = drawn.truth.chair
    true = simulate(chair, left, right, start, urge=moved, interval=FINE, steps=25)
    baseline = {side: drawn.baseline * rng.normal() for side in ("left", "right")}
    devices = dict(_devices(time, left, right, true, drawn, baseline, rng))
    files = {}
    for device, columns in ((d, c) for d, c in devices.items() if d in drawn.rates):
        offset, ppm = rng.uniform(0.0, 1.0), rng.normal(0, 20)
        file = f"{name}_{device}.csv"
        (folder / file).write_text(_logged(time, columns, drawn.rates[device], offset, ppm, rng), encoding="utf-8")
        files[file] = {"offset_s": offset, "ppm": ppm, "rate": drawn.rates[device]}
    role = "holdout" if run.what.startswith("kept") else "fit"
    told = {"what": run.what, "role": role, "files": files, "baseline_Nm": baseline, "caster_start_rad": turned.tolist()}
    if role == "fit":
        return told, {}
    flat = replace(chair, floor=0.0)
    ways = {"true_rider": (flat, moved), "law_only_rider": (flat, None), "no_rider": (replace(flat, lean=0.0), None)}
    known = {
        way: simulate(body, left, right, start, urge=by_itself, interval=FINE, steps=25)
        for way, (body, by_itself) in ways.items()
    }
    return told, {way: _apart(time, out, true) for way, out in known.items()}


def _apart(time: np.ndarray, one: Mapping[str, np.ndarray], other: Mapping[str, np.ndarray]) -> dict[str, float]:
    late = time > SETTLING
    hubs = np.concatenate([(one[c] - other[c])[late] for c in ("wheel_speed_l", "wheel_speed_r")])
    rate = (one["yaw_rate"] - other["yaw_rate"])[late]
    return {
        "hub_speed_rms": float(np.sqrt(np.mean(hubs**2))),
        "yaw_rate_rms_deg_s": float(np.degrees(np.sqrt(np.mean(rate**2)))),
    }


Columns = dict[str, tuple[np.ndarray, float]]  # by header what there truly is, and the sensor's noise


def _devices(
    time: np.ndarray,
    left: np.ndarray,
    right: np.ndarray,
    true: Mapping[str, np.ndarray],
    drawn: Lab,
    baseline: Mapping[str, float],
    rng: np.random.Generator,
) -> Iterator[tuple[str, Columns]]:
    """What each logger would write, were its clock right."""
    for side, push in (("left", left), ("right", right)):
        speed = true[f"wheel_speed_{side[0]}"]
        angle = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * FINE)]) / drawn.radius
        torque = push * drawn.radius + baseline[side] + drawn.ripple[side] * np.sin(angle + rng.uniform(0, 2 * np.pi))
        rim = drawn.told["radius"] / drawn.radius * speed  # a wheel's rate, and the radius that was told
        yield (side, {f"M_r{side[0]} [N.m]": (torque, NOISE["M"]), f"wheel_speed_{side[0]} [m/s]": (rim, NOISE["speed"])})
    yaw_rate = np.degrees(true["yaw_rate"])
    yield (
        "frame",
        {
            "yaw_rate [deg/s]": (yaw_rate, NOISE["yaw_rate"]),
            "a_x [m/s2]": (true["a_x"], NOISE["a"]),
            "a_y [m/s2]": (true["a_y"], NOISE["a"]),
        },
    )
    if drawn.filmed:
        share = drawn.truth.chair.m / drawn.told["person"]
        yield (
            "markers",
            {
                "x [m]": (true["x"], NOISE["x"]),
                "y [m]": (true["y"], NOISE["x"]),
                "yaw [deg]": (np.degrees(true["yaw"]), NOISE["yaw"]),
                "rider.s [m]": (0.9 * share * true["body"], NOISE["s"]),
            },
        )


def _logged(time: np.ndarray, columns: Columns, rate: float, offset: float, ppm: float, rng: np.random.Generator) -> str:
    """The text of a file: true time is offset + (1 + ppm 1e-6) times the file's."""
    there = np.arange(int((time[-1] - offset - 0.01) * rate)) / rate
    at = offset + (1 + 1e-6 * ppm) * there
    values = [there, *(np.interp(at, time, v) + sd * rng.standard_normal(len(at)) for v, sd in columns.values())]
    rows = np.column_stack(values).tolist()
    return "\n".join([",".join(["time [s]", *columns]), *(",".join(f"{v:.6g}" for v in row) for row in rows)]) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.independent.labs", description=__doc__)
    parser.add_argument("out", type=Path, help="folder to write")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1], help="a lab each")
    parser.add_argument("--worn", action="store_true", help="labs of the kind that recordings of a person are")
    chosen = parser.parse_args()
    answers = {f"lab-{seed}": write(chosen.out / f"lab-{seed}", seed, chosen.worn) for seed in chosen.seeds}
    (chosen.out / "answers.json").write_text(json.dumps(answers, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
