"""What a campaign says about a model: whitened residuals and sensitivities, run by run.

Everything the loop decides is decided on these: innovations r (N,), in units of their own uncertainty,
and S (N, k), what each parameter would add to them. The unknown start of each run is part of the
uncertainty (see `innovations`); where the simulation is best started is found on the way.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...campaign import BY_NAME, CHANNELS, Campaign, Run, pace
from ...campaign.channels import BODY_NAMES
from ...engine.evaluation import Constant, Evaluation, Evaluator, Recording, Values
from ...engine.innovations import Disturbance
from ...engine.sensitivities import Sensitivities
from ...engine.tangent import EXTERNAL
from ...errors import SimulationError
from ...model.variant import Variant
from ...quantities import Parameter
from ..parallel import parallel_map
from .evidence import Begin, Evidence, RunEvidence, begins_of, followed
from .flipping import may_swing_round
from .initial_state import CASTERS, prior_start, start_sd, starts_of, uncertain
from .local import BaselineError, ClockError, Local, Marginal, felt, locals_of, rate_of, read
from .noise_model import ALONG, FORCED, MOMENT, RIDER, NoiseModel, disturbance, noise_of, pushes_of

TOLERANCE = 1e-4  # of the simulation; its error is some hundredths of the best sensor's noise
BODY = frozenset(BY_NAME[name].fmu for name in BODY_NAMES)  # of the rider, which no logger of pushes records
LONG = 30_000  # rows: five minutes at 100 Hz, some megabytes
LED, HELD = 1, 0  # how a run that is led goes on from its path: to where forces lead it, or not at all
MASS, YAW_INERTIA, AHEAD_OF_AXLE = "chair.m", "chair.I_z", "chair.b"
INERT = (MASS, YAW_INERTIA, AHEAD_OF_AXLE)  # what resists forces and moments


def driven(campaign: Campaign) -> frozenset[str]:
    """The inputs that some run records, by FMU name."""
    return frozenset(name for run in campaign.runs for name in run.inputs)


class Likelihood:
    """A campaign on the likelihood: simulates its runs with any parameter values and whitens what is left.

    `variant` has every effect that may be asked for, besides those that the campaign gives a size; effects at zero change
    nothing. `noise_model` is the noise. Sensor offsets
    that the campaign names as nuisances are parameters too, `offset.<channel>`; `records` has all by name. `columns` are
    the parameters that sensitivities may be asked by, all if not given; the start is among them in any case. One that does not
    derive is compiled without, and only runs evidence `again`. One that `leads` has runs that begin
    where the chair rolls, each led along the forces that nobody recorded, and going on so from the path that it is on (`goes`).
    """

    def __init__(
        self,
        campaign: Campaign,
        variant: Variant,
        noise_model: NoiseModel | None = None,
        columns: Sequence[str] | None = None,
        derives: bool = True,
        leads: bool = False,
    ):
        self.campaign, self.variant = campaign, variant.with_effects(campaign.effects)
        self.start_names = starts_of(p.name for p in self.variant.parameters())
        wanted = None if columns is None else (*columns, *self.start_names)
        self.sensitivities = Sensitivities(self.variant, wanted if derives else (), driven(campaign).union(EXTERNAL))
        self.noise_model = noise_model or NoiseModel(campaign.noise)
        self.leads, self.goes = leads, LED
        self.begins: Mapping[str, Begin] = {r.name: Begin(self.expected_start(r)) for r in campaign.runs}
        self.offsets = offsets_of(campaign)
        offsets = (Parameter(name, BY_NAME[c].unit, f"offset of {c}") for name, c in self.offsets.items())
        self.records: dict[str, Parameter] = {p.name: p for p in (*self.variant.parameters(), *offsets)}
        self._inputs = [i.name for i in self.sensitivities.model.inputs]
        self._yawing = [s.name for s in self.sensitivities.model.states].index("psi_dot")
        self._recordings: dict[tuple[str, bool], tuple[Run, NoiseModel, Recording]] = {}
        self._swinging: dict[str, tuple[Run, bool]] = {}
        self._evaluator = Evaluator(self.sensitivities, TOLERANCE)
        self._delays = {f"effect.{e.id}.{p.name}" for e in variant.catalogue.values() if e.delays_record for p in e.parameters}

    def _uncertain(self, run: Run) -> dict[str, float]:
        return uncertain(run, self.start_names)

    def expected_start(self, run: Run) -> dict[str, float]:
        """Where a run is expected to start before its readings are asked, by the start's parameters."""
        return prior_start(run, self.known(run), self.start_names, self.leads)

    def known(self, run: Run) -> dict[str, float]:
        """What the campaign file says of this run's chair."""
        return {**self.campaign.known, **run.set}

    def chair(self, values: Mapping[str, float]) -> dict[str, float]:
        """Values (SI) of the chair, as these have them or the campaign says."""
        given = {p.name: p.default for p in self.variant.parameters()}
        return {**given, **self.variant.values, **self.campaign.known, **values}

    def evidence(
        self, runs: Iterable[Run], values: Mapping[str, float], by: Sequence[str] = (), *, tune_start: int = 0
    ) -> Evidence:
        """Evidence of these runs at parameter `values` (SI), with sensitivities `by` some of them.

        `tune_start`: how often at most to move the simulated start to where the readings want it. Whoever wants to go on from
        there asks what is `continued`.
        """

        def one(run: Run) -> RunEvidence:
            try:
                return self._tuned(run, values, tuple(by), tune_start)
            except SimulationError as error:
                raise SimulationError(f"run {run.name}: {error}") from error

        return Evidence(tuple(parallel_map(one, runs, lambda run: len(run.time))), tuple(by))

    def resimulated(self, evidence: Evidence, values: Mapping[str, float], *, whole: bool = True) -> Evidence:
        """The same runs at other `values`, at a tenth of the cost: starts, filters and sensitivities are kept. Without `whole`
        only innovations are of these values, which takes half as long where errors of the pushes lead a run."""

        def one(e: RunEvidence) -> RunEvidence:
            assert isinstance(e.whitener, Marginal)  # evidence in brief is never run again
            there = replace(e, measured=self._measured(e.run, values)) if self.offsets else e
            if e.path is None:
                there = self._simulated_again(there, values, e.start, whole)
            else:  # where other values leave another rest, other forces make up for it
                there = self._driven_again(there, values, e.path)
                there = self._driven_again(there, values, followed(there))
            return replace(there, r=e.whitener((there.measured - there.foretold)[:, :, None], e.offset)[:, :, 0])

        return Evidence(tuple(parallel_map(one, evidence.runs, lambda e: len(e.run.time))), evidence.by)

    def whole(self, evidence: Evidence, values: Mapping[str, float]) -> Evidence:
        """What was `resimulated` without at these `values`, whole."""

        def one(e: RunEvidence) -> RunEvidence:
            if e.pushed is None:
                return e
            results, predicted = self._simulated(e.run, values, e.start)
            return replace(e, results=results, predicted=predicted)

        return Evidence(tuple(parallel_map(one, evidence.runs, lambda e: len(e.run.time))), evidence.by)

    def _driven_again(self, e: RunEvidence, values: Mapping[str, float], path: np.ndarray) -> RunEvidence:
        """A run at other `values` along a `path`, by the filter that it has."""
        assert isinstance(e.whitener, Marginal)
        results, driven = self._simulated(e.run, values, e.start, path)
        unknown = self._unknown(e.run, values)
        added = e.whitener.whitener.response(unknown.pushed(path)) + unknown.felt(path)
        return replace(e, results=results, driven=driven, path=path, added=added)

    def restarted(self, evidence: Evidence, values: Mapping[str, float]) -> Evidence:
        """The same model at its `values`, with every run started where the readings want it, to first order. Innovations allow
        for a start that is off; errors, of a simulation that knows no reading, do not."""
        if self.leads:
            return evidence  # forces make up for a start that is off, until a model is settled

        def one(e: RunEvidence) -> RunEvidence:
            try:
                return self._simulated_again(e, values, self._better_start(e))
            except SimulationError:
                return e  # where it cannot start there, it is judged from where it can

        return Evidence(tuple(parallel_map(one, evidence.runs, lambda e: len(e.run.time))), evidence.by)

    def _simulated_again(
        self, e: RunEvidence, values: Mapping[str, float], start: Mapping[str, float], whole: bool = True
    ) -> RunEvidence:
        """A run at other `values` or from another `start`, by the filter that it has."""
        there = replace(e, start=start) if start is not e.start else e
        if whole or e.pushed is None:
            results, predicted = self._simulated(e.run, values, start)
            there = replace(there, results=results, predicted=predicted)
        if e.pushed is None:
            return there
        return replace(there, driven=self._simulated(e.run, values, start, pushed=e.pushed)[1])

    def readings(
        self, run: Run, values: Mapping[str, float], start: Mapping[str, float]
    ) -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
        """The channels of a run, what was measured (n, nz), less the sensors' offsets, and what is simulated (n, nz)."""
        return self._channels(run), self._measured(run, values), self._simulated(run, values, start)[1]

    def _simulated(
        self,
        run: Run,
        values: Mapping[str, float],
        start: Mapping[str, float],
        path: np.ndarray | None = None,
        pushed: np.ndarray | None = None,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Results (n, ny) and readings (n, nz) of a run, without derivatives, with forces of `path` (n, nd) acting, or with
        pushes larger than their record by `pushed` (n, nq)."""
        given, w = self._given(run, values, start)
        felt: np.ndarray | float = 0.0
        if path is not None:
            unknown = self._unknown(run, values)
            w, felt = self._pushed(run, w, unknown.pushed(path)), unknown.felt(path)
        if pushed is not None:
            w = self._pushed(run, w, pushed)
        results = self.sensitivities.simulator.run(run.time, w, given, tolerance=TOLERANCE).results
        predicted = results.take([self.sensitivities.rows[i] for i in self._which(run)], axis=1)
        return results, read(run, self._channels(run), predicted, start) + felt

    def _tuned(self, run: Run, values: Mapping[str, float], by: tuple[str, ...], rounds: int) -> RunEvidence:
        """A run, started where its readings want it; one that is led, also where forces which nobody recorded lead it."""
        begins, names = self.begins[run.name], tuple(self._uncertain(run))
        known = {n: v for n, v in begins.start.items() if n in self.start_names or n not in CASTERS}
        start = {**self.expected_start(run), **known}
        at = np.array([start.get(n, 0.0) for n in names])

        def tuned(found: Evaluation) -> dict[str, float]:
            return dict(zip(names, found.start.tolist(), strict=True))

        if self.leads:
            path = begins.path if self.noise_model.disturbed else None
            found = self._evaluated(run, values, (), at, path, self.goes if self.noise_model.disturbed else HELD)
            if rounds:
                path = found.path if self.noise_model.disturbed else np.zeros((len(run.time), FORCED))
                begins = Begin({**start, **tuned(found)}, path)
            found = self._evaluated(run, values, by, found.start, found.path, 0) if by else found
        else:
            pushed = self._errors_of_pushes(run)
            found = self._evaluated(run, values, by, at, None, rounds, pushed, rounds > 0 and self._flips(run))
            if found.pushed is not None and found.pushed is not pushed:
                begins = replace(begins, path=found.pushed)
            if not np.array_equal(found.start, at):
                begins = replace(begins, start=tuned(found))
        begins = replace(begins, kinks=found.whitener.kinks)
        return replace(self._told(run, values, by, found, {**start, **tuned(found)}), begins=begins)

    @property
    def may_flip(self) -> bool:
        """May casters swing round in some run?"""
        return any(map(self._flips, self.campaign.runs))

    def _flips(self, run: Run) -> bool:
        """May they in this one, which no other forces lead? While a chair backs up, they stand as pencils on their
        tips: noise of the pushes decides when they swing, and so where the chair goes. Slopes about any other path than its own
        say little of it, so all is linearised about the likeliest errors of the pushes, which are kept for the next values."""
        if self.leads or not all(name in self.start_names for name in CASTERS):
            return False
        known = self._swinging.get(run.name)
        if known is None or known[0] is not run:
            known = self._swinging[run.name] = run, may_swing_round(run, self._set(run, {}))
        return known[1]

    def _errors_of_pushes(self, run: Run) -> np.ndarray | None:
        """As they were found, (n, nq), for a model whose casters may flip."""
        found = self.begins[run.name].path
        return found if found is not None and len(found) == len(run.time) and self._flips(run) else None

    def _evaluated(
        self,
        run: Run,
        values: Mapping[str, float],
        by: tuple[str, ...],
        start: np.ndarray,
        path: np.ndarray | None,
        rounds: int,
        pushed: np.ndarray | None = None,
        follows: bool = False,
    ) -> Evaluation:
        given, chair = self._set(run, values), self.chair(values)
        offsets = [values.get(f"offset.{c}", 0.0) for c in self._channels(run)]
        delay = sum(given.get(d, 0.0) for d in self._delays)
        p = self.variant.vector({n: v for n, v in given.items() if n not in self.start_names})
        at = Values(p, np.array(offsets), delay, self.noise_model.along(chair[MASS]), chair[MASS])
        columns = [n for n in by if n not in self._delays and n not in self.offsets]
        silent, recording = self.begins[run.name].kinks, self._recording(run)
        if silent is not None and silent.shape != recording.readings.shape:
            silent = None
        return self._evaluator.evaluate(recording, at, columns, start, path, rounds, pushed, follows, silent)

    def _recording(self, run: Run) -> Recording:
        """What the evaluation needs of a run: made once for each noise, but for a long one, whose memory counts."""
        if len(run.time) > LONG:
            return self._recorded(run)
        key = run.name, self.leads
        known = self._recordings.get(key)
        if known is None or known[0] is not run or known[1] is not self.noise_model:
            known = self._recordings[key] = run, self.noise_model, self._recorded(run)
        return known[2]

    def _recorded(self, run: Run) -> Recording:
        channels, pushes = self._channels(run), self._pushes(run)
        prior, sd = self.expected_start(run), start_sd(run, self.start_names)
        constants = [constant(c, channels, self._inputs, len(run.time)) for c in locals_of(run)]
        return Recording(
            run.time,
            self.inputs(run),
            np.array([n not in BODY for n in self._inputs]),
            np.stack([run.channels[c] for c in channels], axis=1),
            self._which(run),
            np.array([BY_NAME[c].drifts for c in channels]),
            [self._inputs.index(n) for n in pushes],
            noise_of(self.noise_model, run, channels, pushes),
            self._of_any_chair(run) if self.noise_model.disturbed or RIDER in run.inputs else None,
            self.leads,
            self.start_names,
            np.array([prior[n] for n in self.start_names]),
            np.array([sd[n] for n in self.start_names]),
            np.array([n in run.set for n in self.start_names]),
            constants,
        )

    def _pushes(self, run: Run) -> tuple[str, ...]:
        return pushes_of(run, self.leads)

    def _of_any_chair(self, run: Run) -> Disturbance:
        """The forces on a chair of the mass that they were found for, and what is wrong in the record of its rider's body."""
        swinging, readings = self.noise_model.swinging(run), self._channels(run)
        return disturbance(self.noise_model, self._pushes(run), swinging=swinging, speed=pace(run), readings=readings)

    def _told(
        self, run: Run, values: Mapping[str, float], by: tuple[str, ...], found: Evaluation, start: Mapping[str, float]
    ) -> RunEvidence:
        """What was found of a run, with slopes by parameters through its filter."""
        channels, constants = self._channels(run), locals_of(run)
        led, m = bool(found.path.any()), len(self.start_names)
        signals = np.zeros((*found.r.shape, 1 + len(by)))
        self._fill_columns(signals[:, :, 1:], run, found, self.inputs(self.on_time(run, values, start)), by)
        if led:
            signals[:, :, 1:] += self._as_before(run, found, values, by)
        sd = np.array([c.sd for c in constants])
        whitener = Marginal(found.whitener, found.by_start[:, :, m:] * sd)
        off = np.concatenate((found.offset, -np.array([start.get(c.name, 0.0) for c in constants]) / sd))
        S = whitener(signals, np.zeros(len(off)), in_place=True)[:, :, 1:].copy() if by else signals[:, :, 1:]
        return RunEvidence(
            run,
            channels,
            found.r,
            S,
            found.slopes,
            start,
            found.results,
            found.predicted,
            found.measured,
            whitener,
            off,
            found.path if led else None,
            *((found.added, found.driven, found.pushed) if led or found.pushed is not None else ()),
        )

    def _unknown(self, run: Run, values: Mapping[str, float]) -> Disturbance:
        """The forces on a chair of these values."""
        along, readings = self.noise_model.along(self.chair(values)[MASS]), self._channels(run)
        return disturbance(self.noise_model, self._pushes(run), along=along, readings=readings)

    def _pushed(self, run: Run, w: np.ndarray, pushed: np.ndarray) -> np.ndarray:
        """Inputs (n, nw) with pushes larger than their record by `pushed`."""
        out = w.copy()
        out[:, [self._inputs.index(n) for n in self._pushes(run)]] += pushed
        return out

    def _better_start(self, e: RunEvidence) -> dict[str, float]:
        """The start, and what else is uncertain of the run, given all readings: prior mean + P₀ S₀ᵀ r, to first order."""
        good = np.isfinite(e.r)
        prior, sd = self.expected_start(e.run), e.uncertain
        step = np.array(list(sd.values())) ** 2 * (e.start_S[good].T @ e.r[good])
        return {n: prior.get(n, 0.0) + float(np.clip(s, -3 * sd[n], 3 * sd[n])) for n, s in zip(sd, step, strict=True)}

    def _as_before(self, run: Run, found: Evaluation, values: Mapping[str, float], by: tuple[str, ...]) -> np.ndarray:
        """What has to be added to slopes (n, nz, k) along a path, so that they are those of the chair without it. The path is
        made of the very errors that slopes are held against: with its forces in the slope by its mass, or its moments in that
        by its inertia, a chair would be found too light. A force along the heading does to a heavier chair what a lesser one
        does to a lighter; a moment turns it against its inertia about the rear axle, I_z + m b², and against a CM that is ahead
        of that axle and is turned about with it, m b u."""
        out, asked = np.zeros((*found.r.shape, len(by))), [name for name in INERT if name in by]
        if not asked:
            return out
        chair, unknown = self.chair(values), self._unknown(run, values)
        m, b, as_push = chair[MASS], chair[AHEAD_OF_AXLE], unknown.as_push
        r = found.whitener.states(unknown.pushed(found.path))[:, self._yawing]
        bends, u = np.gradient(r, run.time), found.results[:, self.sensitivities.results.index("chair.u")]
        resists = {MASS: b * (b * bends + u * r), YAW_INERTIA: bends, AHEAD_OF_AXLE: m * (2 * b * bends + u * r)}
        for name in asked:
            less = np.outer(resists[name], as_push[:, MOMENT])
            less += found.path[:, ALONG] @ as_push[:, ALONG].T / m if name == MASS else 0.0
            out[:, :, by.index(name)] = found.whitener.response(less)
        return out

    def _measured(self, run: Run, values: Mapping[str, float]) -> np.ndarray:
        """What was measured (n, nz), less the sensors' offsets."""
        return np.stack([run.channels[c] - values.get(f"offset.{c}", 0.0) for c in self._channels(run)], axis=1)

    def _channels(self, run: Run) -> tuple[str, ...]:
        return tuple(c.name for c in CHANNELS if c.name in run.channels)

    def _which(self, run: Run) -> list[int]:
        return [self.sensitivities.sensors.index(c.fmu) for c in CHANNELS if c.name in run.channels]

    def _set(self, run: Run, values: Mapping[str, float]) -> dict[str, float]:
        """Parameters by name; what the run itself sets stands."""
        return {**self.variant.values, **self.known(run), **values, **run.set}

    def _vector(self, run: Run, values: Mapping[str, float], start: Mapping[str, float]) -> np.ndarray:
        return self.variant.vector({**self._set(run, values), **{n: start.get(n, 0.0) for n in self.start_names}})

    def _given(self, run: Run, values: Mapping[str, float], start: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        """Parameters (np,) and inputs (n, nw) of a run."""
        return self._vector(run, values, start), self.inputs(self.on_time(run, values, start))

    def on_time(self, run: Run, values: Mapping[str, float], start: Mapping[str, float]) -> Run:
        """The run with its pushes as and when the chair felt them: a record that is early is read that much later, and what
        `start` has of clocks and baselines is taken out."""
        given = self._set(run, values)
        delay = sum(given.get(d, 0.0) for d in self._delays)
        inputs = felt(run, start)
        late = [n for n in inputs if n not in BODY] if delay else []
        inputs = {**inputs, **{n: np.interp(run.time - delay, run.time, inputs[n]) for n in late}}
        return replace(run, inputs=inputs, set={n: v for n, v in run.set.items() if n not in self._delays})

    def inputs(self, run: Run) -> np.ndarray:
        """Recorded inputs (n, nw)."""
        names = self._inputs
        w = np.tile([i.start for i in self.sensitivities.model.inputs], (len(run.time), 1))
        for name, values in run.inputs.items():
            w[:, names.index(name)] = values
        return w

    def _fill_columns(self, out: np.ndarray, run: Run, found: Evaluation, w: np.ndarray, by: Sequence[str]) -> None:
        """Unwhitened sensitivities into zeros (n, nz, len(by)). `w` (n, nw) are the inputs as the chair felt them."""
        columns = [n for n in by if n not in self._delays and n not in self.offsets]
        free = [j for j, name in enumerate(by) if name not in run.set]
        derived = [j for j in free if by[j] in columns]
        at = [columns.index(by[j]) for j in derived]
        out[:, :, derived] = found.by_parameter[:, np.array(self._which(run))[:, None], at]
        for j in free:
            if by[j] in self.offsets:
                out[:, :, j] = [c == self.offsets[by[j]] for c in self._channels(run)]
            elif by[j] in self._delays:  # every push changes by −F' per second of it
                pushes = self._pushes(run)
                pushed = w[:, [self._inputs.index(n) for n in pushes]]
                by_hands = np.where([n in BODY for n in pushes], 0.0, rate_of(run.time, pushed))
                out[:, :, j] = found.whitener.response(-by_hands)

    def with_noise_model(self, noise_model: NoiseModel) -> Likelihood:
        """The same likelihood with other noise; runs begin where they did."""
        return self._with(noise_model=noise_model)

    def turning(self, before: Mapping[str, float], values: Mapping[str, float]) -> Likelihood:
        """The same likelihood with forces that turn a chair of these `values` as those here turn one of the values `before`:
        against its inertia about the rear axle. Those along the heading do so anyway."""
        was, now = (_about_the_axle(self.chair(one)) for one in (before, values))
        return self if now == was else self.with_noise_model(self.noise_model.turning(now / was))

    def begun(self, begins: Mapping[str, Begin]) -> Likelihood:
        """The same likelihood with these runs, by name, beginning there."""
        return self._with(begins={**self.begins, **begins})

    def continued(self, *found: Evidence) -> Likelihood:
        """The same likelihood with runs that begin where evidence has found that they do."""
        return self.begun(begins_of(*found))

    def beside(self, found: Evidence, goes: int = LED) -> Likelihood:
        """The same likelihood with runs that go on so from the paths on which evidence has them; which readings are not asked
        stays as it was."""
        begins = {e.run.name: replace(self.begins[e.run.name], start=e.start, path=e.path) for e in found.runs}
        return self.begun(begins)._with(goes=goes)

    def led(self, campaign: Campaign) -> Likelihood:
        """The same model and noise on other runs of the chair, each from where its first samples say, and linearised about the
        path on which forces that nobody recorded lead it, once its start is tuned."""
        other = self._with(campaign=campaign, leads=True)
        return other.begun({r.name: Begin(other.expected_start(r)) for r in campaign.runs})

    def only(self, runs: Iterable[Run]) -> Likelihood:
        """The same on some runs of its campaign, with a memory of its own: what it makes of them is forgotten with it."""
        return self._with(campaign=replace(self.campaign, runs=tuple(runs)), _recordings={}, _swinging={})

    def _with(self, **changed: object) -> Likelihood:
        """The same but for these attributes: what was compiled and recorded is shared, unless it is among them."""
        other = object.__new__(Likelihood)
        other.__dict__ = {**self.__dict__, **changed}
        return other


def _about_the_axle(chair: Mapping[str, float]) -> float:
    """A chair's yaw inertia (kg m²) about its rear axle."""
    return chair[YAW_INERTIA] + chair[MASS] * chair[AHEAD_OF_AXLE] ** 2


def constant(local: Local, channels: Sequence[str], inputs: Sequence[str], n: int) -> Constant:
    """What is uncertain of one run only, as the evaluation has it."""
    if isinstance(local, BaselineError):
        shape = local.baseline.independent[:, local.column]
        own = np.array([name == local.baseline.input for name in inputs])
        return Constant("baseline", local.sd, own, np.zeros(len(channels), bool), shape)
    assert isinstance(local, ClockError)
    stamped = (
        np.array([name in some for name in all_])
        for all_, some in ((inputs, local.clock.inputs), (channels, local.clock.channels))
    )
    return Constant("clock", local.sd, *stamped)


def offsets_of(campaign: Campaign) -> dict[str, str]:
    """Names of the sensor offsets that a campaign has for nuisances, and the channels they are added to."""
    measured = {c for r in campaign.runs for c in r.channels}
    return {f"offset.{c}": c for c in campaign.nuisance if c in measured}
