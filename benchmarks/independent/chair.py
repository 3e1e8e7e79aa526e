"""An independent wheelchair: planar chair and user, two rear tyres of bristle type, two casters that really swivel.

Axes: x forward, y right, z down; yaw positive clockwise from above; slopes positive where the floor falls towards the axis.
The equations are in chair.c, which is compiled once with the system's C compiler (`CC`, else `cc`) into a cache folder;
classical Runge-Kutta with a fixed step of 0.2 ms. All parameters of the effects are part of the chair and off at zero.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import shlex
import shutil
import subprocess
import tempfile
from dataclasses import astuple, dataclass, fields
from functools import cache
from pathlib import Path

import numpy as np

OUTPUTS = (
    "wheel_speed_l",
    "wheel_speed_r",
    "yaw_rate",
    "a_x",
    "a_y",
    "x",
    "y",
    "yaw",
    "u",
    "v",
    "yaw_acceleration",
    "swivel_r",
    "swivel_l",
    "body",
    "energy",
)
STATES = 21
STEPS_PER_SAMPLE = 50


class Diverged(RuntimeError):
    """The simulation left the finite numbers."""


@dataclass(frozen=True)
class Chair:
    """Every number of the true chair, SI units. What an effect uses is zero when the effect is off."""

    m: float = 80.0
    I_z: float = 3.08
    a: float = 0.25
    b: float = 0.20
    t_r: float = 0.55
    t_f: float = 0.45
    g: float = 9.81
    C_lambda: float = 5038.0
    C_m_lambda: float = 45.0
    C_phi: float = 464.0
    C_m_phi: float = 3.0
    f_r: float = 0.012
    f_f: float = 0.020
    # What the product's model does not know: nothing of this is ever "off".
    inv_mu: float = 1.0
    sigma: float = 0.01
    inv_slip: float = 3.0
    C_caster: float = 2500.0
    sigma_caster: float = 0.01
    trail: float = 0.05
    I_swivel: float = 0.003
    swivel_dry: float = 0.002
    swivel_viscous: float = 0.002
    trunk_lag: float = 0.15
    lean_frequency: float = 1.1
    lean_damping: float = 0.3
    lean_drag: float = 0.5
    pressure: float = 1.0
    turn_length: float = 0.6  # radius of a wheel's path round which its patch, that resists being turned, half slides
    turn_length_f: float = 0.1
    patch_load: float = 0.0  # 1: the floor carries the casters at their patches, 0: under their pivots, as in the paper
    # Effects, off at zero.
    load_exponent: float = 0.0
    camber_r: float = 0.0
    camber_l: float = 0.0
    toe_r: float = 0.0
    toe_l: float = 0.0
    scrub: float = 0.0
    scrub_viscous: float = 0.0
    turn: float = 0.0
    turn_f: float = 0.0
    pivot: float = 0.0
    slip_compliance: float = 0.0
    h_x: float = 0.0
    h_y: float = 0.0
    y_cm: float = 0.0
    trunk: float = 0.0
    lean: float = 0.0
    drag_speed: float = 0.0
    drag_difference: float = 0.0
    aero: float = 0.0
    slope_x: float = 0.0
    slope_y: float = 0.0
    cross_slope: float = 0.0
    m_spin: float = 0.0
    swivel_spring: float = 0.0
    wobble: float = 0.0
    speed_torque: float = 0.0
    sticky: float = 0.0
    slippery: float = 0.0  # how much larger 1/mu is on this floor; where it is not zero, rear wheels may spin
    floor: float = 0.0  # rms slope of an uneven floor, along and across


@dataclass(frozen=True)
class Start:
    """Where and how fast the chair is at the first sample; the casters' angles are against the chair."""

    u: float = 0.0
    v: float = 0.0
    yaw_rate: float = 0.0
    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    swivel_r: float = 0.0
    swivel_l: float = 0.0

    def states(self) -> np.ndarray:
        s = np.zeros(STATES)
        s[:7] = self.x, self.y, self.yaw, self.u, self.v, self.yaw_rate, self.swivel_r
        s[8] = self.swivel_l
        s[17:19] = self.u
        return s


def _header() -> str:
    parameters = ", ".join(f"P_{f.name}" for f in fields(Chair))
    outputs = ", ".join(f"O_{name}" for name in OUTPUTS)
    return f"enum {{ {parameters} }};\nenum {{ {outputs}, OUTPUTS }};\n"


def _compiler() -> list[str]:
    words = shlex.split(os.environ.get("CC", "")) or ["cc"]
    if shutil.which(words[0]) is None:
        raise RuntimeError(f"no C compiler {words[0]!r}: set CC to one")
    return words


def _cache_folder() -> Path:
    user = os.getuid() if hasattr(os, "getuid") else "user"
    folder = Path(tempfile.gettempdir()) / f"independent-chair-{user}"
    folder.mkdir(mode=0o700, exist_ok=True)
    return folder


@cache
def _library() -> ctypes.CDLL:
    source = _header() + Path(__file__).with_name("chair.c").read_text(encoding="utf-8")
    flags = ["-O2", "-std=c99", "-fPIC", "-shared", "-ffp-contract=off"]
    key = hashlib.sha256("\0".join([source, *flags, platform.platform(), platform.machine()]).encode()).hexdigest()[:20]
    path = _cache_folder() / f"chair-{key}.so"
    if not path.exists():
        with tempfile.TemporaryDirectory(dir=path.parent) as work:
            code, built = Path(work) / "chair.c", Path(work) / "chair.so"
            code.write_text(source, encoding="utf-8")
            subprocess.run([*_compiler(), *flags, str(code), "-o", str(built), "-lm"], check=True, capture_output=True)
            os.replace(built, path)
    library = ctypes.CDLL(str(path))
    array = np.ctypeslib.ndpointer(np.float64, flags="C_CONTIGUOUS")
    library.simulate.argtypes = [array, array, ctypes.c_int, array, ctypes.c_double, ctypes.c_int, array]
    library.simulate.restype = None
    return library


def simulate(
    chair: Chair,
    F_rl: np.ndarray,
    F_rr: np.ndarray,
    start: Start = Start(),
    *,
    urge: np.ndarray | None = None,
    interval: float = 0.01,
    steps: int = STEPS_PER_SAMPLE,
) -> dict[str, np.ndarray]:
    """All outputs at the samples of the pushes, which are linear between samples, by as many steps from one to the next as
    the chair asks for, and these at least.

    Where the chair has a `lean`, `urge` is how far forward (m) the rider means to have the CM, whatever the hands push.
    """
    by_itself = np.zeros(len(F_rl)) if urge is None else urge
    push = np.ascontiguousarray(np.column_stack([F_rr, F_rl, by_itself]), dtype=np.float64)
    out = np.empty((len(push), len(OUTPUTS)))
    parameters = np.array(astuple(chair), dtype=np.float64)
    _library().simulate(parameters, start.states(), len(push), push, interval, steps, out)
    if not np.all(np.isfinite(out)):
        raise Diverged("the simulated chair left the finite numbers: spun away by its push, or more steps are needed")
    return {name: out[:, i].copy() for i, name in enumerate(OUTPUTS)}
