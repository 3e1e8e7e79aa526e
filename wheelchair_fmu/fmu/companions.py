"""The pusher and the floor as FMUs, from the same toolchain as the chair.

They come to fmu_src's protocol code through the same seam, `model.h`; only a recording that is replayed is C by hand.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..engine.kernel import kernel
from ..engine.source import c_source
from ..errors import UsageError
from ..model.variant import Variant, number
from ..model.wheelchair import Model
from ..quantities import S
from ..resources import SYSTEMS
from ..surroundings import floor, pusher
from . import native, package, validate
from .variables import Idle, Interface, Jump, Variable, Watch, input_variable, output_variable, parameter_variable

PAGES = SYSTEMS / "pages"
REPLAY = SYSTEMS / "replay.c"
WIDTH = 6  # numbers to a line of generated C


@dataclass(frozen=True, eq=False)
class Recording:
    """Forces [N] on the left and right wheel at times [s], (n,) each, linear in between; zero before and after."""

    time: np.ndarray
    F_rl: np.ndarray
    F_rr: np.ndarray

    def __post_init__(self) -> None:
        columns = np.array([self.time, self.F_rl, self.F_rr], float)
        if len(self.time) < 2 or not np.isfinite(columns).all() or not (np.diff(self.time) > 0).all():
            raise UsageError("a recording needs two samples or more, without gaps, and time that rises from sample to sample")

    def c_text(self) -> str:
        columns = {"t": self.time - self.time[0], "F_rl": self.F_rl, "F_rr": self.F_rr}
        tables = (f"static const double record_{name}[] = {{\n{_lines(column)}}};\n" for name, column in columns.items())
        return f"#define RECORDED {len(self.time)}\n" + "".join(tables)


@dataclass(frozen=True)
class Companion(Interface):
    """What goes with a chair, seen through FMI."""

    recording: Recording | None = None

    @property
    def model(self) -> Model:
        return next(iter(self.models.values()))

    @property
    def jumps(self) -> tuple[Jump, ...]:
        return ()

    @property
    def watches(self) -> tuple[Watch, ...]:
        return ()

    @property
    def idles(self) -> tuple[Idle, ...]:
        return ()

    def c_source(self, law: str) -> str:
        """As the chair's; a recording takes the place of what the generated replay gives."""
        if law != "replay" or self.recording is None:
            return super().c_source(law)
        names = [o.name for o in self.model.outputs]
        places = {"CLOCK": pusher.CLOCK, "F_RL": names.index("push.F_rl"), "F_RR": names.index("push.F_rr")}
        sizes = ", ".join(str(s.numel()) for s in (self.model.x, self.model.w, self.model.p, self.model.y))
        defines = "".join(f"#define {name} {text}\n" for name, text in {**places, "SIZES": sizes}.items())
        unrecorded = c_source(kernel(self.models[law]), "unrecorded")
        return unrecorded + defines + self.recording.c_text() + REPLAY.read_text(encoding="utf-8")


def build_pusher(target: Path, values: Mapping[str, float | str], recording: Recording | None = None) -> Path:
    """Build the pusher's FMU, whose start values are the defaults but for `values`.

    Raises UsageError for an unknown name or an impossible value, and BuildError where it cannot be built.
    """
    modes = [mode for mode in pusher.MODES if mode != "replay" or recording]
    if values.get("pusher.mode") == "replay" and not recording:
        raise UsageError("pusher.mode = replay needs a recording; give one with --replay FILE.csv")
    models = {mode: pusher.pusher(mode) for mode in modes}
    return _build(target, "Pusher", "a person who pushes a wheelchair in strokes", models, values, "pusher.mode", recording)


def build_floor(target: Path, values: Mapping[str, float | str]) -> Path:
    """Build the floor's FMU, whose start values are the defaults but for `values`. Raises as `build_pusher`."""
    return _build(target, "Floor", "a floor with a ramp, a cross slope and a carpet", {"floor": floor.floor()}, values)


COMPANIONS = {"Pusher": build_pusher, "Floor": build_floor}


def _build(
    target: Path,
    name: str,
    title: str,
    models: Mapping[str, Model],
    values: Mapping[str, float | str],
    chooser: str = "",
    recording: Recording | None = None,
) -> Path:
    table = _table(next(iter(models.values())), values)
    if chooser:
        table = [replace(v, upper=len(models)) if v.name == chooser else v for v in table]
    pages = PAGES / name.lower()
    face = Companion(Variant(), models, tuple(table), name, title, pages, chooser, recording)
    return package.write(Path(target), native.archive(face), validate.problems)


def _table(model: Model, values: Mapping[str, float | str]) -> list[Variable]:
    records = {p.name: p for p in model.parameters}
    starts = {**{p.name: p.default for p in model.parameters}, **{n: number(records, n, v) for n, v in values.items()}}
    table = [Variable(0, "time", "simulation time", S, "time")]
    for i, p in enumerate(model.parameters):
        table.append(parameter_variable(len(table), i, p, starts[p.name], p.fixed))
    for i, w in enumerate(model.inputs):
        table.append(input_variable(len(table), i, w))
    for i, o in enumerate(model.outputs):
        table.append(output_variable(len(table), i, o))
    return table


def _lines(column: np.ndarray) -> str:
    words = [repr(float(value)) for value in column]
    return "".join("    " + ", ".join(words[i : i + WIDTH]) + ",\n" for i in range(0, len(words), WIDTH))
