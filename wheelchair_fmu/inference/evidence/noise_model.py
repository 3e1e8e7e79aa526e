"""The noise of channels and of recorded pushes, and the forces that nobody recorded, as numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_banded

from ...campaign import BY_NAME, Run
from ...campaign.channels import BY_FMU_NAME, MOMENTUM, PUSHES
from ...campaign.rims import ARM
from ...campaign.series import estimate
from ...engine.innovations import Disturbance, Noise
from ...engine.tangent import EXTERNAL

RIDER = BY_NAME[MOMENTUM].fmu
FORCES, TORQUES = tuple(PUSHES), tuple(PUSHES.values())  # records of pushes, which carry noise
HANDS, TURNS = (tuple(BY_NAME[n].fmu for n in names) for names in (FORCES, TORQUES))
SCATTER = 1.15  # ratio of two estimates of the same noise
FORGOTTEN = 1.0  # s over which a force that nobody recorded is forgotten, or m, as long as nothing tells it
# s, of the third order by which the momentum of a rider's body swings: with each stroke, about once a second, and back, and
# smoothly, as muscles pull; of second order it would tremble, and a slow force would seem likelier than a body
SWUNG = (1 / 15, 1 / 10, 3 / 20)
# s, of the second order by which the record of such a momentum is wrong: of what swings at 2 to 3 Hz a smoothing spline leaves
# half, of the camera's noise and of the body's motion
HASTY = (3 / 50, 3 / 40)
PATCH = 0.05  # m over which a bump is forgotten that a wheel rolls over: as long as a tyre's contact patch
# of the processes of `disturbance`, a force, a moment, the moment and the force of bumps, a floor's force, the moment of its
# slope to the side, those of the body, and those of what a record of its motion has wrong: which is which,
MOMENT, FLOOR, ACROSS, SWINGS = 1, 4, 5, slice(6, 6 + len(SWUNG))
RECORDED = slice(SWINGS.stop, SWINGS.stop + len(HASTY))
FORCED = RECORDED.stop  # how many there are,
# which are the body's, which has a floor in it, which are of a record,
BODYS, PLACES, RECORDS = (np.isin(np.arange(FORCED), np.r_[which]) for which in (SWINGS, slice(1, SWINGS.start), RECORDED))
ALONG = (0, 3, FLOOR, *range(SWINGS.start, FORCED))  # and those that push along the heading
AHEAD, ASIDE = "a_x", "a_y"  # accelerometers,
GRAVITY = {AHEAD: FLOOR, ASIDE: ACROSS}  # and what moves a chair and is nothing that they feel
DIES_OUT = 0.6  # s in which a body's swing of 1.3 Hz and a fifth of the critical damping falls by e
GRID = 0.01  # s, of the pushes as they swing a body


@dataclass(frozen=True)
class NoiseModel:
    """Noise of each channel, and of the recorded pushes: standard deviation (SI) and AR(1) coefficient; and the forces that
    nobody recorded."""

    sd: Mapping[str, float]
    ar: Mapping[str, float] = field(default_factory=dict)  # AR(1) coefficient from sample to sample
    force: float = 0.0  # N, standard deviation of what pushes the chair along its heading for long and nobody recorded,
    moment: float = 0.0  # N m, of what turns it, beside a floor,
    floor: float = 0.0  # N, of what an uneven floor pulls along the heading, and to the side at the CM,
    lever: float = 0.0  # m, of the CM before the axle, where that turns the chair,
    body: float = 0.0  # N s, of the momentum that a rider's body has against the chair, beside what was recorded of it,
    bumps: float = 0.0  # N, of what bumps push along the heading,
    tremor: float = 0.0  # N m, and of what they turn the chair with
    lasting: float = FORGOTTEN  # m over which the moment is forgotten, and the floor's force, as the chair rolls
    mass: float = 0.0  # kg, of the chair that these forces were found for; 0: of any
    stroke: float = 0.0  # N, RMS push of the runs that they were found for; 0: of any
    by_run: Mapping[str, Mapping[str, float]] = field(default_factory=dict)  # times `sd` that a channel's noise is in a run
    # times what readings show by themselves, where that tells runs apart
    shown: Mapping[str, float] = field(default_factory=dict)

    def of(self, channel: str, run: Run) -> float:
        """Standard deviation of the noise in what a run has of a channel; in one that is new, what its readings show where that
        tells runs apart, or else as in the others together."""
        times = self.by_run.get(run.name, {}).get(channel)
        if times is None and channel in self.shown and (shows := estimate([run.channels[channel]])):
            return self.shown[channel] * shows
        others = [known[channel] ** 2 for known in self.by_run.values() if channel in known]
        if times is None:
            times = float(np.sqrt(np.mean(others))) if others else 1.0
        return self.sd.get(channel, 0.0) * times * run.noise_share(channel)

    def swinging(self, run: Run) -> np.ndarray:
        """Times the usual (n,) that a rider's body swings at each moment of a run: who pushes moves, who rolls sits still."""
        return self.swung(effort(run))

    def swung(self, efforts: np.ndarray) -> np.ndarray:
        """The same (n,) from a run's `effort`, where that is known already."""
        return efforts / self.stroke if self.stroke else np.ones(len(efforts))

    def along(self, mass: float) -> float:
        """How many times as large forces along the heading are on a chair of this mass (kg) as on the one that they were found
        for. What they do to a chair is known, and not how large they are: one of another mass needs others for the same, or a
        heavier chair would be likelier for its quieter ride."""
        return mass / self.mass if self.mass else 1.0

    def turning(self, times: float) -> NoiseModel:
        """The same of a chair that is so many times as hard to turn, which forces turn as they do this one."""
        return replace(self, moment=times * self.moment, tremor=times * self.tremor, lever=times * self.lever)

    @property
    def wrong(self) -> float:
        """Standard deviation (N s) of what is wrong in a record of the momentum of the rider's body."""
        return self.sd.get(MOMENTUM, 0.0)

    @property
    def disturbed(self) -> bool:
        """Do forces act that nobody recorded?"""
        return max(self.force, self.moment, self.floor, self.body, self.bumps, self.tremor) > 0

    def differs(self, other: NoiseModel) -> bool:
        """Is some channel's noise of another size or noise_model, by more than estimates of either scatter?"""
        sizes = (other.sd[c] / sd for c, sd in self.sd.items() if sd > 0)
        colours = (abs(self.ar.get(c, 0.0) - other.ar.get(c, 0.0)) for c in {*self.ar, *other.ar})
        return (
            any(not 1 / SCATTER < ratio < SCATTER for ratio in sizes)
            or any(c > 1 - 1 / SCATTER for c in colours)
            or self._otherwise_disturbed(other)
            or any(not 1 / SCATTER < ratio < SCATTER for ratio in self._run_by_run(other))
        )

    def _run_by_run(self, other: NoiseModel) -> Iterator[float]:
        """Ratios of what both have by run."""
        for run, times in self.by_run.items():
            yield from (other.by_run.get(run, {}).get(channel, 1.0) / size for channel, size in times.items())

    def _otherwise_disturbed(self, other: NoiseModel) -> bool:
        """Do forces act of another size, by more than estimates of it scatter and by more than can be felt?"""
        pairs = (
            (self.force, other.force, 0.5),
            (self.moment, other.moment, 0.1),
            (self.floor, other.floor, 0.5),
            (self.body, other.body, 0.5),
            (self.bumps, other.bumps, 0.5),
            (self.tremor, other.tremor, 0.1),
        )
        return any(abs(a - b) > max((SCATTER - 1) * max(a, b), felt) for a, b, felt in pairs)


def noise_of(
    noise_model: NoiseModel, run: Run, channels: Sequence[str], pushes: Sequence[str], start: np.ndarray = np.empty((0, 0))
) -> Noise:
    """The noise of a run's recorded pushes and of its readings, and the covariance of its start."""
    usual = float(np.median(np.diff(run.time)))
    step = np.array([run.steps.get(n, usual) for n in pushes])
    sd, ar = {**noise_model.sd, MOMENTUM: 0.0}, noise_model.ar  # what is wrong in that is a process of `disturbance`
    known = [BY_FMU_NAME[n].name if n in BY_FMU_NAME else n for n in pushes]  # what acts from outside is nobody's record
    push_sd, push_ar = np.array([(sd.get(n, 0.0), ar.get(n, 0.0)) for n in known]).T
    reading_sd, reading_ar = np.array([(noise_model.of(c, run), ar.get(c, 0.0)) for c in channels]).T
    return Noise(push_sd, push_ar, reading_sd, reading_ar, start, step)


def disturbance(
    noise_model: NoiseModel,
    inputs: Sequence[str],
    t_r: float = 1.0,
    along: float = 1.0,
    swinging: np.ndarray | float = 1.0,
    speed: np.ndarray | float = 1.0,
    readings: Sequence[str] = (),
) -> Disturbance:
    """A force along the heading, a moment, the moment and the force of bumps, the force and the moment of an uneven floor, the
    processes by which a rider's body pushes, and those by which it pushes beside its record, as changes of these inputs: of
    those from outside where they are among them, which no rider's body answers, or else of both hands', on wheels `t_r` apart;
    and of these `readings`.

    `along` is how many times as large as in `noise_model` that is which acts along the heading, `swinging` times how much the
    body swings, `speed` (m/s) how fast the chair rolls, at each moment (n,) or throughout.

    A body pushes by −p', with p its momentum against the chair: a sum of processes of first order that one noise drives, and a
    force without a mean. A floor's slopes have one over the way of a run: the spectrum of heights of what is rolled on falls
    with the square of the wave number (ISO 8608), so that slopes have all long waves alike. Those along the way and to the
    side, which turn a chair, are forgotten together. A floor is as it is in each place: who rolls slowly stays longer on a
    slope, and gains or loses the more by it. What a slope does to a chair is gravity, which no accelerometer feels. Bumps are
    shorter than a chair, and push one wheel and not the other, so that they turn it as well.
    """
    body, wrong, recorded = _swing(noise_model.body, SWUNG), _swing(noise_model.wrong, HASTY), RIDER in inputs
    as_push, common = np.zeros((len(inputs), FORCED)), np.eye(FORCED)
    common[SWINGS, SWINGS], common[RECORDED, RECORDED] = body.together, wrong.together
    shares = {EXTERNAL[0]: (1.0, 0.0), EXTERNAL[1]: (0.0, 1.0)}
    if not shares.keys() <= set(inputs):
        shares = {hand: (0.5, side / t_r) for hand, side in zip(HANDS, (1, -1), strict=True)}
    for name, (ahead, turning) in shares.items():
        pushed, back = along * ahead, np.concatenate((np.sign(body.rates), recorded * np.sign(wrong.rates)))
        as_push[inputs.index(name)] = [pushed, turning, turning, pushed, pushed, turning, *(-pushed * back)]
    return Disturbance(*strong_and_lasting(noise_model, swinging, speed), as_push, common, _as_reading(noise_model, readings))


def _as_reading(noise_model: NoiseModel, readings: Sequence[str]) -> np.ndarray:
    """What a unit of each process adds to these readings (nz, d) besides what it does to the chair: less the gravity that is
    among what moves it, F/m along the heading and M/(m b) to the side, of a chair whose mass and lever are known."""
    out = np.zeros((len(readings), FORCED))
    inertia = {FLOOR: noise_model.mass, ACROSS: noise_model.mass * noise_model.lever}
    for i, name in enumerate(readings):
        process = GRAVITY.get(name)
        if process is not None and inertia[process]:
            out[i, process] = -1 / inertia[process]
    return out


def strong_and_lasting(
    noise_model: NoiseModel, swinging: np.ndarray | float = 1.0, speed: np.ndarray | float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Standard deviations of the processes of `disturbance`, and the times (s) over which each is forgotten, (d,) or (n, d)."""
    swings = np.concatenate((_swing(noise_model.body, SWUNG).rates, _swing(noise_model.wrong, HASTY).rates))
    place, floor = noise_model.lasting, (noise_model.floor, noise_model.floor * noise_model.lever)
    lasting = np.array([FORGOTTEN, place, PATCH, PATCH, place, place, *SWUNG, *HASTY])  # s, or m
    sd = np.array([noise_model.force, noise_model.moment, noise_model.tremor, noise_model.bumps, *floor, *np.abs(swings)])
    seconds = np.where(PLACES, np.multiply.outer(1 / np.asarray(speed), lasting), lasting)
    return np.where(BODYS, np.multiply.outer(swinging, sd), sd), seconds


class _Swing(NamedTuple):
    """Processes of first order that one noise drives, whose sum is the rate of another: what one standard deviation of each
    adds to that rate (k,), and their correlation (k, k)."""

    rates: np.ndarray
    together: np.ndarray


def _swing(momentum: float, lasting: Sequence[float]) -> _Swing:
    """Those whose sum is the rate of a momentum of this standard deviation (N s), which white noise drives through
    1 / ∏ (1 + T s); no two times T may be the same."""
    T = np.array(lasting)
    apart = np.subtract.outer(T, T) + np.eye(len(T))
    together = 2 * np.sqrt(np.outer(T, T)) / np.add.outer(T, T)
    shares = T ** (len(T) - 1.5) / np.prod(apart, axis=1)  # partial fractions, in standard deviations of each process
    return _Swing(-momentum * shares / T / np.sqrt(shares @ together @ shares), together)


def stroke(*runs: Run) -> float:
    """RMS (N) of what both hands together push in these runs, by the time that they last."""
    last = [float(np.ptp(run.time)) for run in runs]
    return float(np.sqrt(np.average([np.mean(_both(run) ** 2) for run in runs], weights=last))) if sum(last) else 0.0


def effort(run: Run) -> np.ndarray:
    """RMS push (n,) in N of both hands about each moment, by weights that die out before and after it as a swing's square."""
    grid = np.arange(run.time[0], run.time[-1] + GRID, GRID)
    squares = np.interp(grid, run.time, _both(run) ** 2)
    keeps = np.exp(-2 * GRID / DIES_OUT)
    recursion = [np.ones(len(grid)), np.full(len(grid), -keeps)]  # y(i) − keeps y(i−1)
    after, before = ((1 - keeps) * solve_banded((1, 0), recursion, squares[::way])[::way] for way in (1, -1))
    return np.sqrt(np.interp(run.time, grid, (after + before) / 2))


def _both(run: Run) -> np.ndarray:
    """What both hands together push (n,), in N."""
    forces = [run.inputs[n] for n in HANDS if n in run.inputs]
    torques = [run.inputs[n] / ARM for n in TURNS if n in run.inputs]
    return np.sum([np.zeros(len(run.time)), *forces, *torques], axis=0)


def pushes_of(run: Run, led: bool = False) -> tuple[str, ...]:
    """FMU names of the inputs that a filter has noise for: forces, and torques and the momentum of the rider's body where they
    were recorded; where a run is `led`, or that record may be wrong, those from outside too."""
    names = FORCES if not any(BY_NAME[n].fmu in run.inputs for n in TORQUES) else (*FORCES, *TORQUES)
    body = (RIDER,) if RIDER in run.inputs else ()
    return (*(BY_NAME[n].fmu for n in names), *body, *(EXTERNAL if led or body else ()))
