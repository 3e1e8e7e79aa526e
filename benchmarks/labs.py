"""Lab folders from raw files to the verdict, beside what was hidden: `python -m benchmarks.labs [LAB ...] [--drawn SEED ...]
[--casters] [--worn]`.

A number after `--drawn` is a lab that benchmarks/independent/labs.py draws. Each is imported as docs/lab.md does it, with the
lines of its protocol that no file holds, and diagnosed. Printed is what is said, and how far off: clocks and baselines in
standard errors; held-out errors beside those of simulations that know all but the floor, with the body as it moved or by
a law of it; forces that nobody recorded beside the floor's; the share of held-out samples in bands of 95 %; intervals that miss
what was hidden. All figures of a lab, and its diagnosis, are kept in `--out`.
"""

from __future__ import annotations

import argparse
import json
import re
import tempfile
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from typer.testing import CliRunner

from wheelchair_fmu.campaign import read
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.inference.decision.final import final
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.explain.ranking import as_json
from wheelchair_fmu.model.generic import library

from .bands import inside
from .independent.labs import SLIGHT, TURNS_HARD, write

MEASUREMENTS = Path(__file__).resolve().parents[2] / "shared" / "measurements"
OPTIONS = ("--mass", "--radius", "--track", "--wheelbase", "--cm-ahead", "--caster-track")
GIVEN = {  # by the protocols; and where the sensor sits
    "lab-00": (117, 0.306, 0.565, 0.44, 0.10, 0.43),
    "lab-01": (95, 0.307, 0.55, 0.405, 0.12, 0.42),
    "lab-02": (82, 0.306, 0.57, 0.41, 0.16, 0.45),
}
CASTERS = {"--caster-trail": 0.05, "--wheel-inertia": 0.12}  # which all protocols have, and all chairs that are drawn
AT = {"lab-01": "[0.09, 0.04]", "lab-02": "[-0.22, 0.0]"}
GRAVITY = 9.81
OF_THE_BODY = re.compile(r"^\[rider\]\n(?:.+\n)*|, sternum = [^}]*(?= \})", re.MULTILINE)  # lines and words of a campaign
LOADS = ("longitudinal_load_transfer", "lateral_load_transfer")  # by the height of the CM
BODY, BODY_MOVES = "trunk_motion", "rider.force"
# what a simulation may know of the rider's body, by its name in the answers, where all but the floor is known
BODIES = {"true_rider": "with the body's motion known", "law_only_rider": "by a law of it"}


@dataclass(frozen=True)
class Lab:
    """A lab's raw files, what is hidden in them, and of its protocol the sizes of the chair and where its sensor sits."""

    raw: Path
    answer: Mapping[str, Any]
    sizes: Mapping[str, float]  # by option of `wheelchair import`
    at: str = ""


def recorded(measurements: Path, name: str) -> Lab:
    """One of the lab folders among the measurements."""
    answers = json.loads((measurements / "lab-answers.json").read_text(encoding="utf-8"))
    return Lab(measurements / name, answers[name], dict(zip(OPTIONS, GIVEN[name], strict=True)), AT.get(name, ""))


def drawn(out: Path, seed: int, worn: bool = False) -> Lab:
    """One whose raw files are written into a folder."""
    answer = write(out, seed, worn)
    return Lab(out, answer, {f"--{name}": size for name, size in answer["given"].items()})


def imported(lab: Lab, out: Path, filmed: bool = True) -> Path:
    """The campaign of a lab's raw files, with what stands in its protocol; without markers of the rider's body, if it is not to
    be `filmed`."""
    sizes = [word for size in lab.sizes.items() for word in size]
    runs = lab.answer["runs"].items()
    kept = [word for run, told in runs if told["role"] == "holdout" for word in ("--holdout", run)]
    done = CliRunner().invoke(app, [str(word) for word in ("import", lab.raw, "-o", out, *sizes, *kept)])
    if done.exit_code:
        raise RuntimeError(f"{lab.raw.name}: wheelchair import ended with {done.exit_code}: {done.output}")
    told = out / "campaign.toml"
    text = told.read_text(encoding="utf-8")
    if lab.at:
        text = text.replace("# at = [0.0, 0.0]", f"at = {lab.at} #", 1)
    if not filmed:
        text = OF_THE_BODY.sub("", text)
    told.write_text(text, encoding="utf-8")
    return out


def truths(hidden: Mapping[str, Any], spinning: bool = False) -> dict[str, float]:
    """By parameter, what was hidden. Of wheels that are not `spinning` in the model the spin counts as mass and yaw inertia.
    Half of what one rear wheel drags more is in the model's drag of both."""
    spin = 0.0 if spinning else 2 * hidden["wheel_inertia_each_kgm2"] / hidden["wheel_radius"] ** 2
    found = {f"chair.{name}": hidden[name] for name in ("a", "b", "t_r")}
    found |= {f"resistance.{name}": hidden[name] for name in ("f_r", "f_f")}
    found |= {"tyre.C_lambda": hidden["C_lambda"], "chair.m": hidden["m"] + spin}
    found |= {"chair.I_z": hidden["I_z"] + spin * hidden["t_r"] ** 2 / 4}
    found |= {"effect.caster_trail.c": hidden["caster_trail"], "effect.caster_friction.M": hidden["caster_friction"]}
    found |= {f"effect.{effect}.h": hidden["h_cm"] for effect in LOADS if hidden.get("h_cm")}
    lopsided = hidden.get("extra_drag_left_N", 0.0)
    found["resistance.f_r"] += lopsided / (GRAVITY * hidden["m"] * hidden["a"] / (hidden["a"] + hidden["b"]))
    found["effect.rolling_resistance_asymmetry.D"] = lopsided or hidden.get("chair", {}).get("drag_difference", 0.0)
    return found | {"effect.pivot_torque.M": hidden["turn_slip"]["M_p"]}


def off(d: Mapping[str, Any], folder: Path, runs: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """Each clock and baseline, and how many standard errors it is off."""
    content = tomllib.loads((folder / "campaign.toml").read_text(encoding="utf-8"))
    files = {run["name"]: {device: Path(file).name for device, file in run["files"].items()} for run in content["run"]}
    for run, devices in d["sync"].items():
        first = next(iter(files[run]))
        for device, told in devices.items():
            true = runs[run]["files"]
            apart = true[files[run][device]]["offset_s"] - true[files[run][first]]["offset_s"]
            yield f"clock {run} {device}", (told["offset"] - apart) / told["se"]
    for run, rims in d["baseline"].items():
        for push, told in rims.items():
            side = "left" if push.endswith("l") else "right"
            yield f"baseline {run} {push}", (told["offset"] - runs[run]["baseline_Nm"][side]) / told["se"]


def missed(parameters: list[Mapping[str, Any]], true: Mapping[str, float]) -> Iterator[str]:
    """Intervals of 95 % that do not hold what was hidden."""
    for p in parameters:
        if p["interval"] and p["name"] in true and not p["interval"][0] <= true[p["name"]] <= p["interval"][1]:
            low, high = p["interval"]
            yield f"{p['name']} {low:.4g} to {high:.4g}, hidden {true[p['name']]:.4g}"


def row(answer: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """What was said of a lab, and how far off it is."""
    d = diagnose(campaign := read(folder), generic=library())
    filmed = all(BODY_MOVES in run.inputs for run in campaign.runs)
    told, hidden = as_json(d), answer["hidden"]
    parameters = final(d, {p.name: p for e in library().values() for p in e.owned})["parameters"]
    floors, last = answer["floor_of_the_held_out_runs"], told["physical"]
    counts = inside(d)
    within, there_are = (sum(one) for one in zip(*counts.values(), strict=True))
    z, true = dict(off(told, folder, answer["runs"])), truths(hidden, "effect.wheel_inertia.m" in campaign.known)
    floor = GRAVITY * hidden["floor_slope_rms"] * hidden["m"]
    known = {p["name"] for p in parameters if p["interval"]} & true.keys()
    return {
        "verdict": told["verdict"],
        "named": [*dict.fromkeys((*told["effects"], *(e for tie in told["ties"] for e in tie)))],
        "hidden": answer["verdict"],
        "unfair": unfair(told, answer, filmed, campaign.known["wheel.R"]),
        "heldout": {"calibrated": told["ladder"][1]["heldout"], "last": told["ladder"][-1]["heldout"]},
        "hub_speed": {run: _speed(last, run) for run in floors},
        "yaw_rate": {run: last["yaw_rate"]["runs"][run] for run in floors if "yaw_rate" in last},
        "reachable": {run: {body: floor_[body] for body in BODIES} for run, floor_ in floors.items()},
        "clocks": {k: v for k, v in z.items() if k.startswith("clock")},
        "baselines": {k: v for k, v in z.items() if k.startswith("baseline")},
        "force": (told["disturbance"]["force"], floor),
        "moment": (told["disturbance"]["moment"], floor * hidden["b"]),
        "body": told["disturbance"]["body"],
        "inside": {"all": within / there_are, **{c: a / b for c, (a, b) in counts.items()}},
        "intervals": len(known),
        "missed": list(missed(parameters, true)),
        "parameters": parameters,
        "seconds": told["seconds"],
        "diagnosis": told,
    }


def unfair(told: Mapping[str, Any], answer: Mapping[str, Any], filmed: bool, radius: float) -> str:
    """What is wrong with the names of a diagnosis: one that nothing hidden bears, or none of what is missing; else nothing.

    Casters trail and stick in every lab, a CM that is somewhere above the floor loads wheels, and a patch that is turned has
    several laws. A body whose motion was recorded is in the model as it moved, and is not missing. Wheels of another radius (m)
    than was given have an error of it.
    """
    hidden = answer["verdict"]
    named = {*told["effects"], *(e for tie in told["ties"] for e in tie)}
    true = {*hidden["missing"], *hidden.get("also", ())} - ({BODY} if filmed else set())
    true |= {*TURNS_HARD} if answer["hidden"]["turn_slip"]["M_p"] else set()
    slight = {*hidden.get("small", ()), *SLIGHT, *(LOADS if answer["hidden"].get("h_cm") else ())}
    slight |= {"wheel_radius_error"} if radius != answer["hidden"]["wheel_radius"] else set()
    false = named - true - slight
    if false:
        return f"{', '.join(sorted(false))} named, which is not there"
    return "" if not true or named & true else f"none of {', '.join(sorted(true))} named"


def _speed(last: Mapping[str, Any], run: str) -> float:
    """RMS error of both wheels' speeds in m/s."""
    return float(np.sqrt(np.mean([last[f"wheel_speed_{side}"]["runs"][run] ** 2 for side in "lr"])))


def lines(found: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """A line for each figure: what it is, and how it came out."""
    hidden, held = found["hidden"], found["heldout"]
    yield "said", f"{found['verdict']}: {', '.join(found['named']) or 'nothing'}"
    yield "hidden", ", ".join([*hidden["missing"], *(f"({e})" for e in hidden.get("small", ()))])
    yield "its names", found["unfair"] or "fair"
    yield "held out, whitened", f"{held['calibrated']:.2f} calibrated, {held['last']:.2f} in the end"
    for run, best in found["reachable"].items():
        yield f"{run} wheels", _beside(found["hub_speed"][run], "m/s", [best[body]["hub_speed_rms"] for body in BODIES])
        if run in found["yaw_rate"]:
            floors = [best[body]["yaw_rate_rms_deg_s"] for body in BODIES]
            yield f"{run} yaw rate", _beside(found["yaw_rate"][run], "°/s", floors)
    for what in ("clocks", "baselines"):
        z = np.abs([*found[what].values()])
        worst = max(found[what], key=lambda name: abs(found[what][name]))
        yield what, f"{(z < 2).mean():.0%} of {len(z)} within two standard errors, {worst} off by {z.max():.1f}"
    for what, unit in (("force", "N"), ("moment", "N m")):
        told, floor = found[what]
        yield f"unrecorded {what}", f"{told:.2f} {unit}, the floor's {floor:.2f}: {told / floor:.2f}"
    yield "unrecorded swing", f"{found['body']:.2f} N s"
    channels = ", ".join(f"{c} {share:.0%}" for c, share in found["inside"].items() if c != "all")
    yield "in bands of 95 %", f"{found['inside']['all']:.1%}: {channels}"
    yield "intervals of 95 %", f"{len(found['missed'])} of {found['intervals']} miss: {'; '.join(found['missed']) or 'none'}"


def _beside(error: float, unit: str, floors: Iterable[float]) -> str:
    """An error, and how many times what can be reached it is."""
    ways = (f"{error / floor:.2f} of {floor:.3g} {body}" for floor, body in zip(floors, BODIES.values(), strict=True))
    return f"{error:.3g} {unit}, {', '.join(ways)}"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.labs", description=__doc__)
    parser.add_argument("labs", nargs="*", help="of these; all of the measurements, where none are named or drawn")
    parser.add_argument(
        "--drawn", type=int, nargs="+", default=[], metavar="SEED", help="labs that are drawn, one for each seed"
    )
    parser.add_argument("--measurements", type=Path, default=MEASUREMENTS, help="the folder with the labs and their answers")
    parser.add_argument("--unfilmed", action="store_true", help="leave out markers of the rider's body")
    parser.add_argument("--casters", action="store_true", help="give the casters' trail and the wheels' inertia as well")
    parser.add_argument("--worn", action="store_true", help="draw labs whose casters hold, of a heavy rider who was filmed")
    parser.add_argument("--out", type=Path, default=Path("out/labs"), help="what was found is kept here")
    chosen = parser.parse_args()
    if chosen.worn and not chosen.drawn:
        parser.error("--worn says what labs are drawn; name their seeds by --drawn SEED ...")
    chosen.out.mkdir(parents=True, exist_ok=True)
    more = CASTERS if chosen.casters else {}
    for name in chosen.labs or ([] if chosen.drawn else GIVEN):
        told(name, lambda _, name=name: recorded(chosen.measurements, name), chosen.out, not chosen.unfilmed, more)
    for seed in chosen.drawn:
        told(f"drawn-{seed}", lambda raw, seed=seed: drawn(raw, seed, chosen.worn), chosen.out, not chosen.unfilmed, more)


def told(name: str, lab: Callable[[Path], Lab], out: Path, filmed: bool, more: Mapping[str, float]) -> None:
    """Import and diagnose one lab, with `more` of its sizes, keep its figures and print them; `lab` may write its raw files
    into a folder."""
    with tempfile.TemporaryDirectory() as place:
        one = lab(Path(place) / "raw")
        one = replace(one, sizes={**one.sizes, **more})
        found = row(one.answer, imported(one, Path(place) / name, filmed))
    (out / f"{name}.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    table = Table(title=f"{name}, {found['seconds']:.0f} s", show_header=False)
    for line in lines(found):
        table.add_row(*line)
    Console(width=150).print(table)


if __name__ == "__main__":
    main()
