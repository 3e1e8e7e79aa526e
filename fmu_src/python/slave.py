"""The wheelchair as a Python FMU: the same variables, checks and steps as the native one, open to editing.

The equations lie beside this file, in the folder `wheelchair_package`; change them there. Values of
variables that the changed model has and interface.json does not are the model's defaults.
"""

from __future__ import annotations

import hashlib
import importlib.util
import json
import sys
from importlib import import_module
from math import inf, isfinite
from pathlib import Path
from types import SimpleNamespace
from typing import Any

try:
    import casadi  # noqa: F401 - the model's own files need it
    import numpy as np
    from pythonfmu import Boolean, Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Integer, Real
    from pythonfmu.enums import Fmi2Status
except ImportError as error:
    # By the log, and for hosts that show none on the console.
    reason = (
        f"this FMU needs the package {error.name}, which the Python of this host cannot import ({error}); pip install "
        "casadi numpy, as documentation/externalDependencies.txt says"
    )
    print(reason, file=sys.stderr, flush=True)
    raise ImportError(reason) from error

PACKAGE = "wheelchair_package"
KIND = {"Real": Real, "Enumeration": Integer, "Boolean": Boolean}
CAUSALITY = {
    "time": Fmi2Causality.local,
    "parameter": Fmi2Causality.parameter,
    "input": Fmi2Causality.input,
    "output": Fmi2Causality.output,
}
PHASES = ("instantiated", "initializing", "stepping")
INITIAL = {"parameter": Fmi2Initial.exact, "output": Fmi2Initial.calculated}
TIMES = ("tolerance", "start_time", "stop_time", "time", "elapsed", "lost")
KEPT = ("phase", *TIMES, "restart", "stale", "values")


def load(resources: Path) -> SimpleNamespace:
    """The package in an unpacked FMU, under a name that its content decides.

    Python keeps modules by name, and pythonfmu this script too: without a name of its own, an edited copy of
    this FMU would get the equations of the copy loaded first.
    """
    folder = Path(resources) / PACKAGE
    files = sorted(f for f in folder.rglob("*") if f.suffix in (".py", ".json"))
    content = b"\0".join(part for f in files for part in (f.relative_to(folder).as_posix().encode(), f.read_bytes()))
    name = f"{PACKAGE}_{hashlib.sha256(content).hexdigest()[:16]}"
    if name not in sys.modules:
        start = folder / "__init__.py"
        spec = importlib.util.spec_from_file_location(name, start, submodule_search_locations=[str(folder)])
        package = importlib.util.module_from_spec(spec)
        sys.modules[name] = package
        spec.loader.exec_module(package)
        package.interface = json.loads((folder / "interface.json").read_text(encoding="utf-8"))
        package.effects = import_module(f"{name}.model.effects").bundled()
    package = sys.modules[name]
    wheelchair, stepping = import_module(f"{name}.model.wheelchair"), import_module(f"{name}.stepping")
    return SimpleNamespace(
        interface=package.interface,
        effects=package.effects,
        Choice=wheelchair.Choice,
        assemble=wheelchair.assemble,
        Stepper=stepping.Stepper,
        CannotGoOn=stepping.CannotGoOn,
    )


class WheelchairPython(Fmi2Slave):
    """Time, states, and the values of all variables by name. `KEPT` and the states x are what a saved state holds."""

    def __init__(self, **kwargs: Any):
        super().__init__(**kwargs)
        self.lib = load(self.resources)
        self.interface = self.lib.interface
        self.log_categories = self.interface["log_categories"]
        self.table = self.interface["variables"]
        self.phase, self.tolerance = "instantiated", self.interface["tolerance"]
        self.start_time = self.time = self.elapsed = self.lost = 0.0
        self.stop_time: float | None = None
        self.restart, self.stale = True, False  # x follows from start values; a jump has moved algebraic rows
        self.values = {v["name"]: v["start"] for v in self.table if v["start"] is not None}
        self.x = self.y = None
        self.warned: set[int | str] = set()  # watches, and idle inputs
        self.clamped: set[str] = set()  # inputs of which it has been said that they are out of bounds
        self.law = 0  # of the model in use; 0: none yet
        for v in self.table:
            self._register(v)

    def _register(self, v: dict[str, Any]) -> None:
        self.register_variable(
            KIND[v["type"]](
                v["name"],
                causality=CAUSALITY[v["kind"]],
                variability=Fmi2Variability[v["variability"]],
                initial=INITIAL.get(v["kind"]),
                getter=lambda: self._value(v),
                setter=lambda value: self._assign(v, value),
            ),
            nested=False,
        )

    # ---- values

    def _value(self, v: dict[str, Any]) -> float:
        if v["kind"] == "time":
            return self.time
        if v["kind"] != "output":
            return self.values[v["name"]]
        if self.y is None and self._settle():
            self.y = self.stepper.output(self.x, self.p, self.w)
        return float("nan") if self.y is None else self.y[self.place[v["name"]]]

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        self._set(vrs, values, "Real")

    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        self._set(vrs, values, "Enumeration")

    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        self._set(vrs, values, "Boolean")

    def _set(self, vrs: list[int], values: list[Any], kind: str) -> None:
        """All or none; what is wrong is told, never raised, because pythonfmu ends the simulation on any exception."""
        for vr, value in zip(vrs, values, strict=True):
            if not (0 <= vr < len(self.table) and self.table[vr]["type"] == kind):
                return self._say(
                    Fmi2Status.error, f"no variable of type {kind} has value reference {vr}; modelDescription.xml lists them"
                )
            if fault := self._fault(self.table[vr], value):
                return self._say(Fmi2Status.discard, fault)
        for vr, value in zip(vrs, values, strict=True):
            v = self.table[vr]
            self._assign(v, self._within(v, value) if v["kind"] == "input" else value)

    def _within(self, v: dict[str, Any], value: float) -> float:
        """The value that an input takes: itself, or the bound that it is beyond; said once where that is more than rounding."""
        lower, upper = (v[end] if v[end] is not None else sign * inf for end, sign in (("min", -1), ("max", 1)))
        if lower <= value <= upper:
            return value
        bound, which, side = (lower, "minimum", "below") if value < lower else (upper, "maximum", "above")
        range_ = upper - lower
        rounding = abs(value - bound) <= 1e-9 * (range_ if isfinite(range_) else 1 + abs(bound))
        if not rounding and v["name"] not in self.clamped:
            self.clamped.add(v["name"])
            self._say(
                Fmi2Status.warning,
                f"t = {self.time:.9g} s: {v['name']} = {_shown(v, value)} is {side} its {which} of "
                f"{_shown(v, bound)}; the {which} is used instead, now and whenever this input is "
                "out of bounds",
            )
        return bound

    def _fault(self, v: dict[str, Any], value: float) -> str:
        """Why this variable may not take this value now, or nothing."""
        name = v["name"]
        if v["kind"] in ("output", "time"):
            what = "an output" if v["kind"] == "output" else "the time"
            return f"{name} is {what} and cannot be set; set inputs and parameters"
        stays = f"the old value {_shown(v, self.values[name])} stays"
        if v["variability"] == "fixed" and self.phase == "stepping":
            return f"{name} is fixed and the simulation has started; {stays}, set it before fmi2ExitInitializationMode"
        lower, upper = v["min"], v["max"]
        if not isfinite(value):
            return f"{name} = {value} is not a finite number; {stays}"
        if v["kind"] == "input":
            return ""  # its bounds clamp it
        if v["choices"] and not lower <= value <= upper:
            listed = ", ".join(f"{i} ({c})" for i, c in enumerate(v["choices"], 1) if lower <= i <= upper)
            return f"{name} = {value} is none of its choices {listed}; {stays}"
        if lower is not None and value < lower:
            return f"{name} = {_shown(v, value)} is below its minimum of {_shown(v, lower)}; {stays}"
        if upper is not None and value > upper:
            return f"{name} = {_shown(v, value)} is above its maximum of {_shown(v, upper)}; {stays}"
        return ""

    def _assign(self, v: dict[str, Any], value: float) -> None:
        name = v["name"]
        if self.values[name] == value:
            return
        self.values[name], self.y = value, None
        if self.phase != "stepping":
            self.restart = True
            return
        self.stale = True
        self._gather()
        for jump in self.interface["jumps"]:
            if self.x is not None and name == jump["parameter"] and self.values[jump["mode"]] == jump["when"]:
                self.x[jump["state"]] = value

    def _say(self, status: Fmi2Status, text: str) -> None:
        self.log(text, status)

    # ---- model

    def _gather(self) -> None:
        """Parameters and inputs in the order of the model, which is assembled for the chosen tyre law."""
        law = int(self.values["tyre.law"])
        if law != self.law:
            choice = self.lib.Choice(**{**self.interface["choice"], "tyre": self.interface["laws"][law - 1]})
            self.model = self.lib.assemble(choice, [self.lib.effects[e] for e in self.interface["effects"]])
            self.stepper, self.law = self.lib.Stepper(self.model), law
            self.place = {o.name: i for i, o in enumerate(self.model.outputs)}
        self.p = np.array([self.values.get(p.name, p.default) for p in self.model.parameters], float)
        self.w = np.array([self.values.get(w.name, w.start) for w in self.model.inputs], float)

    def _settle(self) -> bool:
        """Bring the states up to date with start values and jumps; False, with a sentence, where that fails."""
        if not (self.restart or self.stale):
            return True
        try:
            self._gather()
            x = self.stepper.start(self.p, self.w) if self.restart else self.stepper.project(self.x, self.p, self.w)
        except self.lib.CannotGoOn as error:
            self._say(Fmi2Status.error, f"at t = {self.time:.9g} s {error}; change the inputs, parameters or start values")
            return False
        self.x, self.y, self.restart, self.stale = x, None, False, False
        return True

    # ---- time

    def setup_experiment(self, start_time: float, stop_time: float | None = None, tolerance: float | None = None) -> None:
        self.start_time = self.time = start_time
        self.stop_time = stop_time
        if tolerance:
            self.tolerance = min(max(tolerance, 1e-12), 1e-3)

    def enter_initialization_mode(self) -> None:
        self.phase = "initializing"

    def exit_initialization_mode(self) -> None:
        self._settle()
        self.phase = "stepping"

    def do_step(self, current_time: float, step_size: float) -> bool:
        if fault := self._step_fault(current_time, step_size):
            self._say(Fmi2Status.discard, fault)
            return False
        if not self._settle():
            return False
        added = step_size - self.lost
        elapsed = self.elapsed + added
        try:
            x = self.stepper.advance(self.x, self.p, self.w, self.elapsed, elapsed, self.tolerance, self.interface["grid"])
        except self.lib.CannotGoOn as error:
            self._say(
                Fmi2Status.error,
                f"between t = {self.time:.9g} s and {self.time + step_size:.9g} s {error}; the chair stays at the first",
            )
            return False
        self.x, self.y = x, self.stepper.output(x, self.p, self.w)
        self.lost = (elapsed - self.elapsed) - added
        self.elapsed, self.time = elapsed, current_time + step_size
        self._watch()
        return True

    def _step_fault(self, point: float, h: float) -> str:
        slack = 1e-9 * (1 + abs(self.time))
        if not (isfinite(h) and h > 0):
            return f"a step of {h:g} s is not a positive finite time; the chair stays at t = {self.time:.9g} s"
        if not abs(point - self.time) <= slack:
            return (
                f"the step starts at {point:g} s but the chair is at t = {self.time:.9g} s; start it there or restore a state"
            )
        if self.stop_time is not None and point + h > self.stop_time + slack:
            return (
                f"the step ends at {point + h:.9g} s, after the stop time {self.stop_time:.9g} s; give a later "
                "stop time or none"
            )
        return ""

    def _watch(self) -> None:
        """Say, once, where the model has left the range in which it holds, or an input does nothing."""
        self._tell_idle()
        for i, watch in enumerate(self.interface["watches"]):
            guard = watch["guard"]
            if i in self.warned or (guard and not abs(self.y[self.place[guard]]) > watch["guard_limit"]):
                continue
            limit = watch["limits"][self.law - 1]
            beyond = [name for name in watch["variables"] if abs(self.y[self.place[name]]) > limit]
            if beyond:
                self.warned.add(i)
                self._say(
                    Fmi2Status.warning,
                    f"t = {self.time:.9g} s: {beyond[0]} = {self.y[self.place[beyond[0]]]:.10g} "
                    f"is beyond {limit:g}: {watch['meaning']}",
                )

    def _tell_idle(self) -> None:
        """Say, once, that an input is given and moves nothing."""
        for idle in self.interface["idles"]:
            name, of = idle["input"], idle["parameter"]
            if name in self.warned or self.values[name] == 0 or self.values[of] != 0:
                continue
            self.warned.add(name)
            given, none = (_shown(v, self.values[n]) for n in (name, of) for v in self.table if v["name"] == n)
            self._say(
                Fmi2Status.warning,
                f"t = {self.time:.9g} s: {name} = {given} moves nothing while {of} is {none}; set {of} as well",
            )

    # ---- saved states: pythonfmu would save no more than the registered variables

    def _get_fmu_state(self) -> dict[str, Any]:
        kept = {name: getattr(self, name) for name in KEPT}
        kept["values"] = dict(self.values)
        return {"token": self.interface["token"], **kept, "x": None if self.x is None else self.x.tolist()}

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        if not isinstance(state, dict) or state.get("token") != self.interface["token"] or not {*KEPT, "x"} <= set(state):
            return self._say(Fmi2Status.error, "the state was not saved by this FMU; the present one stays")
        if not self._possible(state):
            return self._say(Fmi2Status.error, "the state holds values that this FMU never has; the present one stays")
        for name in KEPT:
            setattr(self, name, state[name])
        self.values = dict(state["values"])
        self.x, self.y = None if state["x"] is None else np.array(state["x"], float), None
        self._gather()

    def _possible(self, state: dict[str, Any]) -> bool:
        """Could a run have left this state?"""
        settable = {v["name"]: v for v in self.table if v["start"] is not None}
        values, x, times = state["values"], state["x"], [state[name] for name in TIMES if state[name] is not None]
        if not isinstance(values, dict) or values.keys() != settable.keys() or state["phase"] not in PHASES:
            return False
        return (
            all(_lawful(v, values[name]) for name, v in settable.items())
            and all(map(_number, times))
            and (x is None or (isinstance(x, list) and all(map(_number, x))))
        )

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> dict[str, Any]:
        try:
            return json.loads(state.decode("utf-8"))
        except ValueError:
            return {}  # refused, with a sentence, when it is set


def _number(value: Any) -> bool:
    return isinstance(value, (int, float)) and isfinite(value)


def _lawful(v: dict[str, Any], value: Any) -> bool:
    """Can this variable have this value?"""
    above = _number(value) and (v["min"] is None or v["min"] <= value)
    return above and (v["max"] is None or value <= v["max"]) and (not v["choices"] or value == int(value))


def _shown(v: dict[str, Any], value: float) -> str:
    if v["choices"]:
        return f"{int(value)} ({v['choices'][int(value) - 1]})"
    return f"{value:.10g}" + ("" if v["unit"] == "1" else f" {v['unit']}")
