"""Tyre property files (.tir): `[SECTION]`, `KEY = value $ comment`; read as MF 5.2, written as MF 5.2.

Reading evaluates the tyre at three loads about its nominal one, so that it goes the same way as measurements do.

In a file's ISO axes (y left, z up) α = λ, γ = φ, F_y = −F_s and M_z = −M.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from .. import __version__
from ..errors import Failure
from ..faults import WARNING, Fault, not_utf8
from ..model.chassis import DEFAULTS
from ..model.tyre.common import RATED
from .identify import ConditionFit, Identified
from .magic_formula import FORCE, TORQUE
from .mf52 import ALIGNING, NEEDED, Mf52
from .records import CAMBER, SLIP
from .rows import USUAL_SPEED, Rows

PA = 1e5  # in a bar
LOADS = np.array([0.75, 1.0, 1.5])  # of the nominal load
SLIPS = np.radians([0.25, 0.5, 0.75, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5])
LEANS = np.radians(np.arange(1, 11))
UNITS = {"LENGTH": ("meter", "m"), "FORCE": ("newton", "n"), "ANGLE": ("radians", "radian", "rad")}
FITTED = (5.0, 6.0)  # FITTYP of MF 5.2 and what it reads unchanged
FORMATS = ("PAC2002", "MF_05", "MF05")
RADIUS = DEFAULTS["wheel.R"]
SIGNED = ("PKY1", "PDY1")
PRESSURES = ("INFLPRES", "INFLATION_PRESSURE", "NOMPRES")  # whichever is there first
_ENTRY = re.compile(r"\s*([A-Za-z]\w*)\s*=\s*('[^']*'|[^\s$!]+)")
_SKIP = ("$", "!", "#")


def read_tir(path: Path, raw: bytes) -> tuple[Rows | None, list[Fault]]:
    """The tyre's curves as rows in the paper's axes, and all faults of the file."""
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return None, [not_utf8(path.name, raw, error)]
    words, lines, faults = _entries(path.name, text)
    numbers, met = _numbers(path.name, words, lines)
    faults += [*met, *_unsupported(path.name, words, numbers, lines)]
    for key in NEEDED:
        if key not in numbers and key not in words:
            faults.append(Fault(path.name, None, None, f"no {key}", "an MF 5.2 file has it; add it"))
        elif (key in SIGNED and numbers.get(key) == 0) or (key not in SIGNED and numbers.get(key, 1.0) <= 0):
            what = "is zero" if key in SIGNED else "is not positive"
            faults.append(Fault(path.name, lines[key], key, f"{numbers[key]:g} {what}", "correct it"))
    given = next((key for key in PRESSURES if key in words), None)
    if given is None:
        fact = f"no inflation pressure given, {RATED:g} bar assumed"
        faults.append(Fault(path.name, None, PRESSURES[0], fact, f"add {PRESSURES[0]}, in Pa", WARNING))
    elif numbers.get(given, 1.0) <= 0:
        faults.append(Fault(path.name, lines[given], given, f"{numbers[given]:g} is not positive", "give it in Pa"))
    if any(f.severity != WARNING for f in faults):
        return None, faults
    return _curves(path, numbers, numbers[given] / PA if given else RATED), faults


def _entries(file: str, text: str) -> tuple[dict[str, str], dict[str, int], list[Fault]]:
    words: dict[str, str] = {}
    lines: dict[str, int] = {}
    faults = []
    table = False
    for i, line in enumerate(text.splitlines(), start=1):
        bare = line.strip()
        if bare.startswith(("[", "{")):
            table = bare.startswith("{")  # the head of a table, which ends with its section
        elif bare and not bare.startswith(_SKIP) and not table:
            found = _ENTRY.match(line)
            if found is None:
                faults.append(Fault(file, i, None, f"{bare[:40]!r} is no entry", "write KEY = value, or $ before a comment"))
            elif found[1].upper() in words:
                faults.append(Fault(file, i, found[1], f"given already in line {lines[found[1].upper()]}", "keep one"))
            else:
                words[found[1].upper()], lines[found[1].upper()] = found[2].strip("'").strip(), i
    return words, lines, faults


def _numbers(file: str, words: Mapping[str, str], lines: Mapping[str, int]) -> tuple[dict[str, float], list[Fault]]:
    """The coefficients; a word where a number must be is a fault."""
    numbers, faults = {}, []
    for key, word in words.items():
        try:
            numbers[key] = float(word.replace("D", "E").replace("d", "e"))
            if not np.isfinite(numbers[key]):
                faults.append(Fault(file, lines[key], key, f"{word} is not finite", "write a number"))
        except ValueError:
            if key in (*NEEDED, *PRESSURES) or (re.fullmatch(r"[PQ][A-Z]{2}\d+|L[A-Z]{2,4}", key) and key != "LENGTH"):
                faults.append(Fault(file, lines[key], key, f"{word!r} is not a number", "write a number"))
    return numbers, faults


def _unsupported(file: str, words: Mapping[str, str], numbers: Mapping[str, float], lines: Mapping[str, int]) -> list[Fault]:
    faults = []
    for key, known in UNITS.items():
        if key in words and words[key].lower() not in known:
            faults.append(Fault(file, lines[key], key, f"unit {words[key]!r} is not read", f"convert the file to {known[0]}"))
    named = words.get("PROPERTY_FILE_FORMAT", "").upper()
    fitted = numbers.get("FITTYP")
    if fitted not in (None, *FITTED) or (fitted is None and named and named not in FORMATS):
        key = "FITTYP" if fitted is not None else "PROPERTY_FILE_FORMAT"
        faults.append(Fault(file, lines[key], key, f"{words[key]} is not MF 5.2", "export it as PAC2002 or FITTYP = 6"))
    return faults


def _curves(path: Path, numbers: Mapping[str, float], pressure: float) -> Rows:
    tyre, nominal = Mf52(numbers), numbers["FNOMIN"]
    loads = np.unique(np.clip(LOADS * nominal, numbers.get("FZMIN", 0.0), numbers.get("FZMAX", np.inf)))
    slips, leans = (a[a <= numbers.get(most, np.inf) + 1e-9] for a, most in ((SLIPS, "ALPMAX"), (LEANS, "CAMMAX")))
    angles = [(a, 0.0) for s in slips for a in (-s, s)] + [(0.0, g) for s in leans for g in (-s, s)]
    alpha, gamma, Fz = np.array([(a, g, N) for N in loads for a, g in angles]).T
    Fy, Mz = tyre.forces(alpha, gamma, Fz)
    sign = -1.0 if numbers["PKY1"] < 0 else 1.0  # ISO's axes, or y to the right already
    n = len(alpha)
    columns = {
        "pressure": np.full(n, pressure),
        "load": Fz,
        "disc_speed": np.full(n, numbers.get("LONGVL", USUAL_SPEED)),
        "slip_angle": alpha,
        "camber_angle": gamma,
        "lateral_force": sign * Fy,
    }
    if all(key in numbers for key in ALIGNING):
        columns["yaw_torque"] = sign * Mz
    return Rows(path.name, [path.stem] * n, columns, np.zeros(n, int))


def tir_text(found: Identified, fit: ConditionFit) -> str:
    """The .tir file of one condition. Raises Failure where the data do not support a Magic Formula for the force."""
    force = fit.magic(SLIP, FORCE)
    if force is None:
        raise Failure(
            f"{fit.condition}: the data do not support the Magic Formula, which a .tir file is made of; "
            "export TOML with --law linear"
        )
    c, laws = fit.condition, found.across[fit.condition.tyre].laws
    by_load = {name: law.exponents["load"].value for name, law in laws.items() if "load" in law.exponents}
    m = float(np.clip(by_load.get("C_lambda", 0.0), -0.98, 0.98))
    bend = np.sqrt((1 - m) / (1 + m))  # d ln K / d ln F_z = m at the nominal load
    lateral = {
        "PCY1": force.C.value,
        "PDY1": force.D.value / c.load,
        "PEY1": force.E.value,
        "PKY1": -force.K.value / c.load / np.sin(2 * np.arctan(bend)),
        "PKY2": 1 / bend,
    }
    camber, twist = fit.K(CAMBER, FORCE), fit.K(CAMBER, TORQUE)
    if camber is not None:
        lateral["PVY3"] = -camber.value / c.load
    aligning = _trail(fit)
    if aligning and "C_m_lambda" in by_load:
        aligning["QDZ2"] = aligning["QDZ1"] * _rise(by_load["C_m_lambda"], bend)
    if aligning and twist is not None:
        # The trail turns the camber force into a torque, too; what is left is the residual torque.
        arm = aligning["QDZ1"] * RADIUS * (0.0 if camber is None else camber.value)
        aligning["QDZ8"] = -(twist.value + arm) / (c.load * RADIUS)
    return _text(fit, lateral, aligning)


def _rise(exponent: float, bend: float) -> float:
    """How the trail's coefficient grows with dfz, so that C_mλ follows the load to the `exponent` over LOADS."""
    d = LOADS - 1
    stiffness = np.sin(2 * np.arctan(bend * LOADS)) / np.sin(2 * np.arctan(bend))
    return float(d @ (LOADS ** (exponent - 1) / stiffness - 1) / (d @ d))  # the trail itself is in proportion to the load


def _trail(fit: ConditionFit) -> dict[str, float]:
    """The trail t(α) = −M / F_s as MF 5.2 has it, by least squares over the torque; {} without a torque."""
    force, torque = fit.magic(SLIP, FORCE), fit.magic(SLIP, TORQUE)
    if force is None or torque is None:
        return {}
    x = np.linspace(0.002, float(fit.fits[SLIP, FORCE].curve.angle[-1]), 80)
    F, M = force(x), torque(x)
    start = -torque.K.value / force.K.value

    def law(z: np.ndarray) -> Mf52:
        return Mf52(
            {"FNOMIN": 1.0, "UNLOADED_RADIUS": 1.0, "QBZ1": np.exp(z[0]), "QCZ1": z[1], "QDZ1": z[2] * start, "QEZ1": z[3]}
        )

    def left(z: np.ndarray) -> np.ndarray:
        return (law(z).trail(x, 0 * x, np.ones_like(x)) * F + M) / np.abs(M).max()

    found = min(
        (
            least_squares(left, [np.log(B), C, 1.0, E], bounds=([0, 0.5, 0.2, -20], [6, 2.5, 3, 1]))
            for B in (5.0, 15.0)
            for C in (1.0, 1.5)
            for E in (-2.0, 0.0)
        ),
        key=lambda each: float(each.cost),
    )
    c = law(found.x)
    return {"QBZ1": c["QBZ1"], "QCZ1": c["QCZ1"], "QDZ1": c["QDZ1"] / RADIUS, "QEZ1": c["QEZ1"]}


def _text(fit: ConditionFit, lateral: Mapping[str, float], aligning: Mapping[str, float]) -> str:
    c = fit.condition
    slip = float(fit.fits[SLIP, FORCE].curve.angle[-1])
    lean = fit.fits.get((CAMBER, FORCE))
    reach = 0.0 if lean is None else float(lean.curve.angle[-1])
    sections: dict[str, Mapping[str, float | str]] = {
        "MDI_HEADER": {"FILE_TYPE": "tir", "FILE_VERSION": 3.0, "FILE_FORMAT": "ASCII"},
        "UNITS": {"LENGTH": "meter", "FORCE": "newton", "ANGLE": "radians", "MASS": "kg", "TIME": "second"},
        "MODEL": {"PROPERTY_FILE_FORMAT": "PAC2002", "FITTYP": 6, "USE_MODE": 2, "LONGVL": c.speed},
        "DIMENSION": {"UNLOADED_RADIUS": RADIUS},
        "OPERATING_CONDITIONS": {"INFLPRES": c.pressure * PA},
        "VERTICAL": {"FNOMIN": c.load},
        "SLIP_ANGLE_RANGE": {"ALPMIN": -slip, "ALPMAX": slip},
        "INCLINATION_ANGLE_RANGE": {"CAMMIN": -reach, "CAMMAX": reach},
        "LATERAL_COEFFICIENTS": lateral,
        "ALIGNING_COEFFICIENTS": aligning,
    }
    out = [f"$ {c}, by wheelchair-fmu {__version__}: MF 5.2, lateral force and torque only, ISO W-axes"]
    for section, entries in sections.items():
        out += [f"[{section}]", *(f"{key:<22}= {_word(value)}" for key, value in entries.items())]
    return "\n".join(out) + "\n"


def _word(value: float | str) -> str:
    return f"'{value}'" if isinstance(value, str) else f"{value:.12g}"
