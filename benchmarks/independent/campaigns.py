"""Writes campaigns: a folder with campaign.toml and runs/*.csv, recorded on the independent chair with something hidden in it.

What the file says of the tyres, the resistances and the yaw inertia is a few per cent off the truth in every campaign, by seed.
What is hidden is never written into the folder: ask `truth`, `signal` or `answer`.
"""

from __future__ import annotations

import argparse
import json
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path

import numpy as np

from .chair import Chair, Start, simulate
from .hidden import EFFECTS, Columns, Truth, hide, usual
from .manoeuvres import SETS, Run, pick

Hidden = Mapping[str, Mapping[str, float]]
Manoeuvres = str | Iterable[str | Run]

INTERVAL = 0.01
REFERENCE_PRESSURE = 4.0
SOFT = 2.0  # bar, that runs at another pressure are told to be at
EXPONENTS = {
    "pressure_F": 1.0,
    "pressure_M": -0.5,
}  # of the pressure in C_lambda and C_m_lambda, as a rig has them of this chair's
CHANNELS = ("wheel_speed_l", "wheel_speed_r", "yaw_rate", "a_x", "a_y")
ROOM_CHANNELS = (*CHANNELS, "x", "y", "yaw")
UNITS = {
    "time": "s",
    "F_rl": "N",
    "F_rr": "N",
    "wheel_speed_l": "m/s",
    "wheel_speed_r": "m/s",
    "yaw_rate": "rad/s",
    "a_x": "m/s2",
    "a_y": "m/s2",
    "x": "m",
    "y": "m",
    "yaw": "rad",
    "u": "m/s",
    "v": "m/s",
}
NOISE = {
    "F_rl": 0.4,
    "F_rr": 0.4,
    "wheel_speed_l": 0.008,
    "wheel_speed_r": 0.008,
    "yaw_rate": 0.006,
    "a_x": 0.05,
    "a_y": 0.05,
    "x": 0.003,
    "y": 0.003,
    "yaw": 0.004,
    "u": 0.008,
    "v": 0.008,
}
AR1 = 0.9
AHEAD = 0.35  # s before the hands push, at which a body starts forward
YIELDS_TO_NO_PUSH = 1e-9  # m of lean, of a body that only does what it means to
CALIBRATION = {"C_lambda": 0.12, "C_m_lambda": 0.08, "f_r": 0.06, "f_f": 0.06, "I_z": 0.05}
"""Half-widths of the uniform relative difference between the true chair and the file."""
MEASURED = {"m": 0.02, "a": 0.04, "b": 0.05, "t_r": 0.015}
"""Standard deviations of the same for what is weighed and taped, where a campaign asks for such errors."""
SECTIONS = {
    "chair": ("a", "b", "t_r", "t_f", "m", "I_z"),
    "tyre": ("C_lambda", "C_m_lambda", "C_phi", "C_m_phi"),
    "resistance": ("f_r", "f_f"),
}
COMMENTS = {"chair": "what the user weighed and measured", "tyre": "from the test rig"}


@dataclass(frozen=True)
class Recorded:
    """One run, without noise: all columns that could be written."""

    run: Run
    columns: Columns


def _rng(seed: int, *what: str) -> np.random.Generator:
    return np.random.default_rng([seed, *(zlib.crc32(w.encode()) for w in what)])


def nominal(chair: Mapping[str, float] | None = None) -> Chair:
    """The chair as the campaign file tells it."""
    known = {f.name for f in fields(Chair)}
    unknown = set(chair or {}) - known
    if unknown:
        raise KeyError(f"no chair parameter {', '.join(sorted(unknown))}; there are {', '.join(sorted(known))}")
    return replace(Chair(), **dict(chair or {}))


def truth(
    hidden: Hidden, *, seed: int = 0, chair: Mapping[str, float] | None = None, calibration: float = 1.0, measured: float = 0.0
) -> Truth:
    """The true chair of a campaign: the file's, a few per cent off (`calibration` scales it; `measured` what was weighed and
    taped), with the effects in it."""
    told, rng = nominal(chair), _rng(seed, "calibration")
    off = {name: getattr(told, name) * (1 + calibration * width * rng.uniform(-1, 1)) for name, width in CALIBRATION.items()}
    rng = _rng(seed, "measured")
    off |= {name: getattr(told, name) * (1 + measured * sd * rng.standard_normal()) for name, sd in MEASURED.items()}
    return hide(Truth(chair=replace(told, **off)), hidden)


def settings(run: Run, told: Chair) -> dict[str, float]:
    """What the campaign file says is different in this run."""
    out: dict[str, float] = {}
    if run.added_mass:
        out["chair.m"] = told.m + run.added_mass
    if run.other_pressure:
        out["tyre.pressure"] = SOFT
    return out


def record(run: Run, true: Truth, *, seed: int = 0, turned: tuple[float, float] = (0.0, 0.0)) -> Recorded:
    """Drive one run on the true chair, its left and right caster `turned` by so much [rad] at the start, and read its
    instruments, without noise."""
    rng = _rng(seed, "run", run.name)
    time = np.arange(round(run.duration / INTERVAL) + 1) * INTERVAL
    F_rl, F_rr = run.draw(time, rng)
    left, right = turned
    start = Start(u=run.u0 + (0.01 * rng.standard_normal() if run.u0 else 0.0), swivel_l=left, swivel_r=right)
    told = SOFT if run.other_pressure else REFERENCE_PRESSURE
    pressure = (told + true.pressure_change) / REFERENCE_PRESSURE
    chair = replace(true.chair, m=true.chair.m + run.added_mass, pressure=pressure)
    tools = true.instruments
    felt = tools.felt(F_rl), tools.felt(F_rr)
    if true.reach:
        chair = replace(chair, lean=chair.lean or YIELDS_TO_NO_PUSH)
    motion = simulate(chair, *felt, start, urge=reaching(time, felt[0] + felt[1], true.reach), interval=INTERVAL)
    return Recorded(run, {"time": time, **tools.forces(time, F_rl, F_rr), **tools.motion(motion, chair.g)})


def reaching(time: np.ndarray, push: np.ndarray, reach: float) -> np.ndarray | None:
    """Where the rider means to be (m), by themselves: forward from AHEAD s before a stroke begins, and back a cycle later. None
    of a rider who sits still."""
    if not reach:
        return None
    pushing = push > 0.02 * push.max()
    begin = time[1:][pushing[1:] & ~pushing[:-1]]
    if len(begin) < 3 or np.ptp(np.diff(begin)) > 0.1:
        return None
    cycle = float(np.mean(np.diff(begin)))
    out = np.zeros(len(time))
    for start in begin - AHEAD:
        since = (time - start) / cycle
        out += np.where((since > 0) & (since < 1), reach * np.sin(np.pi * since) ** 2, 0.0)
    return out


def noisy(recorded: Recorded, names: Sequence[str], kind: str, scale: float, seed: int) -> Columns:
    """The columns a logger writes. White noise, or AR(1) with coefficient 0.9, of the same standard deviation."""
    if kind not in ("white", "ar1"):
        raise ValueError(f"noise is white or ar1, not {kind!r}")
    out = {"time": recorded.columns["time"]}
    for name in names:
        values = recorded.columns[name]
        draws = _rng(seed, "noise", recorded.run.name, name).standard_normal(len(values))
        out[name] = values + scale * NOISE[name] * (_coloured(draws) if kind == "ar1" else draws)
    return out


def _coloured(draws: np.ndarray) -> np.ndarray:
    """AR(1) of unit standard deviation, stationary from the first sample."""
    out, level = np.empty_like(draws), draws[0]
    for i, draw in enumerate(draws):
        level = draw if i == 0 else AR1 * level + np.sqrt(1 - AR1**2) * draw
        out[i] = level
    return out


def signal(
    hidden: Hidden,
    *,
    manoeuvres: Manoeuvres = "everyday",
    channels: Sequence[str] = CHANNELS,
    seed: int = 0,
    noise_scale: float = 1.0,
    chair: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """Peak over all runs of what the effects change in each channel, in standard deviations of its noise.

    A push that was recorded wrongly counts as a change of the force columns, "F_rl" and "F_rr"."""
    with_it, without = (truth(h, seed=seed, chair=chair) for h in (hidden, {}))
    peaks = dict.fromkeys([*channels, "F_rl", "F_rr"], 0.0)
    for run in pick(manoeuvres):
        one, other = record(run, with_it, seed=seed).columns, record(run, without, seed=seed).columns
        for name in peaks:
            peaks[name] = max(peaks[name], float(np.max(np.abs(one[name] - other[name]))) / (noise_scale * NOISE[name]))
    return peaks


def answer(
    hidden: Hidden,
    *,
    manoeuvres: Manoeuvres = "everyday",
    channels: Sequence[str] = CHANNELS,
    seed: int = 0,
    noise_scale: float = 1.0,
    chair: Mapping[str, float] | None = None,
) -> dict[str, object]:
    """What a caller may keep beside (never inside) the campaign: the effects, the true numbers, the effects' size."""
    true = truth(hidden, seed=seed, chair=chair)
    return {
        "hidden": {effect: dict(values) for effect, values in hidden.items()},
        "catalogued": all(EFFECTS[effect].catalogued for effect in hidden),
        "true": {
            **asdict(true.chair),
            **asdict(true.instruments),
            "pressure_change": true.pressure_change,
            "reach": true.reach,
        },
        "signal_to_noise": signal(
            hidden, manoeuvres=manoeuvres, channels=channels, seed=seed, noise_scale=noise_scale, chair=chair
        ),
    }


def _toml(name: str, told: Chair, noise: Mapping[str, float], runs: Sequence[tuple[Run, Mapping[str, float]]]) -> str:
    lines = ["[campaign]", f"name = {json.dumps(name)}", 'axes = "SAE-J670"   # x forward, y right, z down']
    for section, keys in SECTIONS.items():
        comment = f"   # {COMMENTS[section]}" if section in COMMENTS else ""
        lines += ["", f"[{section}]{comment}", *(f"{key} = {float(getattr(told, key))!r}" for key in keys)]
        if section == "tyre" and any(run.other_pressure for run, _ in runs):
            lines += [f"{key} = {value!r}" for key, value in EXPONENTS.items()]
    lines += ["", "[noise]   # one standard deviation of each sensor, in the unit of its column"]
    lines += [f"{channel} = {sigma!r}" for channel, sigma in noise.items()]
    for run, changed in runs:
        lines += ["", "[[run]]", f'file = "runs/{run.name}.csv"', f"manoeuvre = {json.dumps(run.manoeuvre)}"]
        lines += [f'role = "{run.role}"', f"u0 = {run.u0!r}   # m/s at the first sample, about"]
        if changed:
            pairs = ", ".join(f'"{key}" = {float(f"{value:.9g}")!r}' for key, value in changed.items())
            lines.append(f"set = {{{pairs}}}")
    return "\n".join(lines) + "\n"


def _csv(columns: Columns) -> str:
    header = ",".join(f"{name} [{UNITS[name]}]" for name in columns)
    table = np.column_stack(list(columns.values()))
    return "\n".join([header, *(",".join(f"{value:.6g}" for value in row) for row in table.tolist())]) + "\n"


def make(
    folder: Path,
    hidden: Hidden,
    *,
    manoeuvres: Manoeuvres = "everyday",
    noise: str = "white",
    noise_scale: float = 1.0,
    channels: Sequence[str] = CHANNELS,
    seed: int = 0,
    chair: Mapping[str, float] | None = None,
    measured: float = 0.0,
    turned: tuple[float, float] = (0.0, 0.0),
    redraw: int | None = None,
) -> Path:
    """Write a campaign. `chair` changes the chair itself, so both the file and the truth; `seed` fixes all that is random, but
    for the noise of what was read, where `redraw` has a seed for that; `measured` is as of `truth`, `turned` as of `record`."""
    unknown = set(channels) - set(NOISE) - {"F_rl", "F_rr"}
    if unknown:
        raise KeyError(f"no channel {', '.join(sorted(unknown))}; there are {', '.join(NOISE)}")
    folder = Path(folder)
    runs, told = pick(manoeuvres), nominal(chair)
    true = truth(hidden, seed=seed, chair=chair, measured=measured)
    names = ["F_rl", "F_rr", *(c for c in channels if c not in ("F_rl", "F_rr"))]
    (folder / "runs").mkdir(parents=True, exist_ok=True)
    for run in runs:
        columns = noisy(
            record(run, true, seed=seed, turned=turned), names, noise, noise_scale, seed if redraw is None else redraw
        )
        (folder / "runs" / f"{run.name}.csv").write_text(_csv(columns), encoding="utf-8")
    sigmas = {name: float(f"{noise_scale * NOISE[name]:.6g}") for name in names}
    text = _toml(folder.name, told, sigmas, [(run, settings(run, told)) for run in runs])
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    return folder


def _arguments(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.independent.campaigns", description="Write a campaign.")
    parser.add_argument("out", type=Path, help="folder to write")
    parser.add_argument("--effect", action="append", default=[], choices=list(EFFECTS), help="hide this; may be repeated")
    parser.add_argument("--times", type=float, default=1.0, help="size in smallest interesting sizes")
    parser.add_argument("--manoeuvres", default="everyday", help=f"sets or runs, with commas: {', '.join(SETS)}")
    parser.add_argument("--noise", default="white", choices=["white", "ar1"])
    parser.add_argument("--noise-scale", type=float, default=1.0)
    parser.add_argument("--room", action="store_true", help="with x, y and yaw")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--answer", type=Path, help="write what is hidden to this file, outside the folder")
    chosen = parser.parse_args(arguments)
    if chosen.answer and chosen.answer.resolve().is_relative_to(chosen.out.resolve()):
        parser.error("the answer must not lie inside the campaign")
    return chosen


def main(arguments: Sequence[str] | None = None) -> None:
    """Command line: one campaign."""
    chosen = _arguments(arguments)
    hidden = {effect: usual(effect, chosen.times) for effect in chosen.effect}
    channels = ROOM_CHANNELS if chosen.room else CHANNELS
    common = {"manoeuvres": chosen.manoeuvres.split(","), "channels": channels, "seed": chosen.seed}
    path = make(chosen.out, hidden, noise=chosen.noise, noise_scale=chosen.noise_scale, **common)
    if chosen.answer:
        told = answer(hidden, noise_scale=chosen.noise_scale, **common)
        chosen.answer.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
    print(path)


if __name__ == "__main__":
    main()
