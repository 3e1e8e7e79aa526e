"""Long recordings in pieces, each a run of its own with its own start: all of them, or a choice spread over all runs.

A model that runs open-loop for an hour tells less at its end than at its beginning, and a search that keeps derivatives of
every sample cannot keep those of millions. A piece starts where its first samples say; where no tracking tells its heading,
that is the yaw rate summed up from the run's start.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from .condensed import condensed
from .records import Campaign, Run
from .series import began

LARGE = 36_000  # samples of a campaign, above which a search works on a choice of windows
WINDOW = 10.0  # s
NEAR = 2.0  # s by which the start of a window may move to where the chair hardly turns
CALM = 0.5  # s over which that is judged
PUSHED = 0.1  # m/s by which hands, or a body that swings, change a chair's speed within a tenth of a second
LEAST_SAMPLES = 10  # of a piece
PIECE = "@"  # stands between the name of a run and when a piece of it begins
STARTS = "start."  # parameters that say where a run starts
HEADING = "start.psi"

Cell = tuple[Run, int, int]  # samples from … to (not included) of a run


def windows(campaign: Campaign, most: int = LARGE) -> Campaign:
    """The campaign as a search looks at it: `condensed`, and where it still has more than so many samples, a choice of windows
    from it, which says so in `thinned`.

    Runs are cut into cells of WINDOW seconds. Of each run's cells (of each role's, where there are more runs than windows) the
    same share is drawn: one at random from each of equally many neighbours, the same draw each time. A window keeps its run's
    role and settings.
    """
    if campaign.thinned:
        return campaign
    campaign = condensed(campaign)
    samples = sum(len(run.time) for run in campaign.runs)
    if samples <= most:
        return campaign
    rng = np.random.default_rng(0)
    chosen = [
        cell
        for role in (campaign.fit, campaign.holdout)
        for cell in _drawn([_cells(run, WINDOW) for run in role], most / samples, rng)
    ]
    runs = tuple(_own(_cut(run, _calmest(run, start, stop), stop)) for run, start, stop in chosen)
    share = sum(len(run.time) for run in runs) / samples
    said = (
        f"{samples} samples are too many to search at once: {len(runs)} windows of about {WINDOW:g} s, spread over all "
        f"runs, were used, {100 * share:.2g} % of the samples; `wheelchair compare` looks at all"
    )
    return replace(campaign, runs=runs, thinned=said)


def pieces(run: Run, seconds: float) -> list[Run]:
    """The whole run in pieces of about so many seconds that share its samples; itself where it is shorter than two."""
    return [_cut(*cell) for cell in _cells(run, seconds)]


def covered(run: Run, late: float, doubt: float = 0.0) -> Run:
    """The run where its pushes are known, once they are read `late` seconds later than recorded: less that much of its
    beginning, or of its end, and less what a clock that is off by `doubt` seconds more, either way, leaves unknown."""
    return between(run, run.time[0] + max(late + doubt, 0.0), run.time[-1] + min(late - doubt, 0.0))


def between(run: Run, first: float, last: float) -> Run:
    """The run from `first` to `last` (s), as far as it goes; whole where that would leave next to nothing."""
    return replace(part(run, first, last), name=run.name)


def part(run: Run, first: float, last: float) -> Run:
    """The same as one of several, with a name that says where it begins."""
    start, stop = np.searchsorted(run.time, [first - 1e-9, last + 1e-9])
    return _cut(run, int(start), int(stop)) if stop - start >= LEAST_SAMPLES else run


def _cells(run: Run, seconds: float) -> list[Cell]:
    count = max(1, int((run.time[-1] - run.time[0]) / seconds))
    edges = np.searchsorted(run.time, np.linspace(run.time[0], run.time[-1], count + 1)[1:-1])
    ends = pairwise((0, *map(int, edges), len(run.time)))
    return [(run, start, stop) for start, stop in ends if stop - start >= LEAST_SAMPLES]  # a gap in the record may leave fewer


def _drawn(cells: Sequence[Sequence[Cell]], share: float, rng: np.random.Generator) -> Iterator[Cell]:
    """Of each run's cells this share, one at least; of all of them together where that would be too many."""
    together = [cell for run in cells for cell in run]
    count = max(1, int(share * len(together)))
    groups = cells if len(cells) <= count else [together]
    for group in groups:
        some = 1 + int((count - len(groups)) * len(group) / len(together))
        for first, end in pairwise(len(group) * i // some for i in range(some + 1)):
            yield group[int(rng.integers(first, end))]


def _cut(run: Run, start: int, stop: int) -> Run:
    """Samples `start` to `stop` (not included) as a run of its own."""
    if (start, stop) == (0, len(run.time)):
        return run
    part, heading = slice(start, stop), _heading(run, start)
    inputs, channels = ({name: v[part] for name, v in series.items()} for series in (run.inputs, run.channels))
    known = {name: value for name, value in run.set.items() if not start or not name.startswith(STARTS)}
    known |= {} if heading is None else {HEADING: heading}
    baselines = tuple(replace(b, shapes=b.shapes[part]) for b in run.baselines)
    return replace(
        run,
        name=f"{run.name}{PIECE}{run.time[start]:.6g}s",
        u0=_speed(run.time[part], channels) if start else run.u0,
        u0_sd=PUSHED if start else run.u0_sd,
        set=known,
        time=run.time[part],
        inputs=inputs,
        channels=channels,
        baselines=baselines,
        way=None if start else run.way,
    )


def _own(run: Run) -> Run:
    """The same with its samples copied, so that the recording it was cut from can be forgotten."""
    inputs, channels = ({name: v.copy() for name, v in series.items()} for series in (run.inputs, run.channels))
    baselines = tuple(replace(b, shapes=b.shapes.copy()) for b in run.baselines)
    return replace(run, time=run.time.copy(), inputs=inputs, channels=channels, baselines=baselines)


def _calmest(run: Run, start: int, stop: int) -> int:
    """Up to NEAR seconds after `start`, where the yaw rate is smallest: where a piece starts is known best there."""
    time, rate = run.time[start:stop], run.channels.get("yaw_rate")
    if rate is None or time[-1] - time[0] < 2 * NEAR:
        return start
    width = max(1, int(CALM / float(np.median(np.diff(time)))))
    until = int(np.searchsorted(time, time[0] + NEAR))
    turning = np.abs(rate[start : start + until + width])
    good = np.isfinite(turning)
    if not good.any():
        return start
    turning = np.interp(np.arange(len(turning)), np.flatnonzero(good), turning[good])
    return start + int(np.argmin(np.convolve(turning, np.ones(width), "valid")[:until]))


def _heading(run: Run, at: int) -> float | None:
    """Heading at a sample: that of the run's start, and what the yaw rate adds to it; None where a channel tells it, or
    nothing does."""
    rate = run.channels.get("yaw_rate")
    if "yaw" in run.channels:
        return None
    if rate is None:
        return run.set.get(HEADING)
    good = np.isfinite(rate)
    time, rate = run.time[good], rate[good]
    before = time <= run.time[at]
    return run.set.get(HEADING, 0.0) + float(np.trapezoid(rate[before], time[before]))


def _speed(time: np.ndarray, channels: dict[str, np.ndarray]) -> float | None:
    """Speed at a piece's first samples, as for a run whose file states none."""
    speeds = [channels[name] for name in ("u", "wheel_speed_l", "wheel_speed_r") if name in channels]
    firsts = [began(time, s) for s in (speeds[:1] if "u" in channels else speeds)]
    known = [f for f in firsts if f is not None]
    return float(np.mean(known)) if known and len(known) == len(firsts) else None
