"""Of the methods: the chair and what was known of it, the runs, and the sensors."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...campaign import BY_NAME, DENSE, SPAN, Run
from ...campaign.channels import CHANNEL_NAMES, PUSH_NAMES
from ...quantities import Parameter
from ..words import listed
from .case import EFFECT, OFFSET, Case
from .markup import code, meaning, plain
from .numbers import amount, capital, number, read_out, seconds, several

ROLES = ("fitted", "held out")
LOST = 0.1  # s, less than which nobody misses
FEW = 12  # runs that are named one by one


def chair(case: Case) -> str:
    """What was known of the chair before the campaign, and how well."""
    told = [
        f"The chair of the campaign {code(case.campaign.name)} is described in the axes of SAE J670, with x forward and y to "
        "the right."
    ]
    known = [p for p in case.parameters if p["prior_sd"] is not None and not p["name"].startswith((EFFECT, OFFSET))]
    if known:
        values = "; ".join(f"{meaning(p['meaning'])}, {amount(p['prior'], p['prior_sd'], p['unit'])}" for p in known)
        are = "value was" if len(known) == 1 else "values were"
        told.append(
            f"{capital(number(len(known)))} {are} estimated with normal priors, which are given here as mean ± standard "
            f"deviation: {values}."
        )
        told += _whence([p["name"] for p in known], case)
    return " ".join([*told, *_held(case)])


def _whence(names: list[str], case: Case) -> Iterator[str]:
    """Where means and standard deviations are from."""
    if absent := [code(n) for n in names if n not in {**case.chair.values, **case.campaign.known}]:
        yield f"Nobody gave {listed(absent, 'and')}; the software's default is in {_its(absent)} place."
    stated = [code(n) for n in names if n in case.campaign.priors]
    usual = "the software's, for values that were weighed, taped or looked up"
    if not stated:
        yield f"These standard deviations are {usual}."
    elif len(stated) == len(names):
        yield "These standard deviations were stated for this chair."
    else:
        those = "That" if len(stated) == 1 else "Those"
        verb = "was" if len(stated) == 1 else "were"
        yield f"{those} of {listed(stated, 'and')} {verb} stated for this chair; the others are {usual}."


def _its(some: list[str]) -> str:
    return "its" if len(some) == 1 else "their"


def _held(case: Case) -> Iterator[str]:
    """Values that nobody estimated."""
    records = _records(case)
    estimated = {p["name"] for p in case.parameters}
    given = {n: v for n, v in case.campaign.known.items() if n in records and n not in estimated}
    if given:
        values = "; ".join(f"{meaning(records[n].meaning)}, {amount(v, None, records[n].unit.name)}" for n, v in given.items())
        yield f"These values were given and held: {values}."
    yield "All other parameters had the software's default values."


def _records(case: Case) -> dict[str, Parameter]:
    return {p.name: p for p in case.chair.with_effects(case.campaign.effects).parameters()}


def runs(case: Case) -> str:
    """Which runs there are, fitted and held out, with durations."""
    fitted, held = case.campaign.fit, case.campaign.holdout
    thinned, thing = case.campaign.thinned, "window" if case.campaign.thinned else "run"
    said = [f"{plain(capital(thinned.partition('; `')[0]))}."] if thinned else []
    if any(run.noise_shares for run in case.campaign.runs):
        said.append(f"What was recorded more than {DENSE:g} times a second was taken as means over {1000 * SPAN:g} ms.")
    said.append(f"{_several(fitted, thing)} fitted{_named(fitted)}.")
    if held:
        said.append(f"{_several(held, thing)} held out{_named(held)}.")
        them = "this one" if len(held) == 1 else "these"
        said.append(
            f"No value was fitted to {them}, but an effect had to predict {'it' if len(held) == 1 else 'them'} to be chosen."
        )
    else:
        said.append("No run was held out, so all errors below are those of fitted runs.")
    return " ".join([*said, *_used(case)])


def _used(case: Case) -> Iterator[str]:
    """How much of the runs counts, where that is not all of what was recorded."""
    shares = [(_used_of(case, some), _duration(some)) for some in (case.campaign.fit, case.campaign.holdout) if some]
    if any(whole - used > LOST for used, whole in shares):
        amounts = [
            f"{seconds(used)} of the {seconds(whole)} {what}" for (used, whole), what in zip(shares, ROLES, strict=False)
        ]
        yield f"Of these, {listed(amounts, 'and')} count; what was left out, and why, is in {code('left_out.csv')}."


def _used_of(case: Case, some: tuple[Run, ...]) -> float:
    return sum(last - first for run in some for first, last in case.used(run))


def _several(some: tuple[Run, ...], thing: str) -> str:
    """ "Seven runs of 88.0 s together were"."""
    together, be = ("", "was") if len(some) == 1 else (" together", "were")
    return f"{capital(several(len(some), thing))} of {seconds(_duration(some))}{together} {be}"


def _duration(some: tuple[Run, ...]) -> float:
    return float(sum(run.time[-1] - run.time[0] for run in some))


def _named(some: tuple[Run, ...]) -> str:
    if len(some) > FEW:
        return ""
    return ": " + listed([_one(run) for run in some], "and")


def _one(run: Run) -> str:
    what = "" if run.manoeuvre in ("", run.name) else f"{plain(run.manoeuvre)}, "
    return f"{code(run.name)} ({what}{seconds(run.time[-1] - run.time[0])})"


def sensors(case: Case) -> str:
    """What was measured, how often, and with which noise."""
    measured = [c for c in CHANNEL_NAMES if any(c in run.channels for run in case.campaign.runs)]
    inputs = {name for run in case.campaign.runs for name in run.inputs}
    pushed = [c for c in PUSH_NAMES if case.campaign.noise.get(c) and BY_NAME[c].fmu in inputs]
    channels = _channels(case, measured)
    told = [f"The measured channels, with their rates and the standard deviations of their noise, were {channels}."]
    if pushed:
        told.append("The recorded pushes, which drive the model, were " + _channels(case, pushed) + ".")
    told += _noise(case, [*measured, *pushed])
    told += _unused(case, measured)
    return " ".join(told)


def _unused(case: Case, names: list[str]) -> Iterator[str]:
    """Channels that the diagnosis did not use, where it found that they are not what they are called."""
    used = {c for run in case.final["runs"].values() for c in run["channels"]}
    if lost := [code(c) for c in names if c not in used]:
        yield f"{listed(lost, 'and')} {'was' if len(lost) == 1 else 'were'} left out, for the reason in {code('left_out.csv')}."


def _channels(case: Case, names: list[str]) -> str:
    each = [
        f"the {plain(BY_NAME[c].meaning.partition(',')[0])} ({code(c)}, {_rate(case, c):.3g} Hz, "
        f"{amount(case.campaign.noise[c], None, BY_NAME[c].unit.name)})"
        for c in names
    ]
    return listed(each, "and")


def _rate(case: Case, name: str) -> float:
    """Readings per second [1/s], the median over all runs."""
    return 1 / float(np.median([step for run in case.campaign.runs for step in _steps(run, name)]))


def _steps(run: Run, name: str) -> list[float]:
    """The usual time [s] between a run's readings of a channel, or its samples of an input."""
    fmu = BY_NAME[name].fmu
    known = run.steps.get(fmu if fmu in run.inputs else name)
    if known is not None:
        return [known]
    times = (
        run.time[np.isfinite(run.channels[name])] if name in run.channels else run.time[: len(run.time) * (fmu in run.inputs)]
    )
    return [float(np.median(np.diff(times)))] if len(times) > 1 else []


def _noise(case: Case, names: list[str]) -> Iterator[str]:
    """Where these standard deviations are from, and where the data asked for others."""
    estimated = [c for c in names if c in case.campaign.noise_estimated]
    stated = [c for c in names if c not in estimated]
    if not estimated:
        yield "These standard deviations were stated for the instruments."
    elif not stated:
        yield "These standard deviations were estimated from how the readings change from sample to sample."
    else:
        which = listed([code(c) for c in estimated], "and")
        those, were = ("That", "was") if len(estimated) == 1 else ("Those", "were")
        yield f"{those} of {which} {were} estimated from how the readings change from sample to sample, the others were stated."
    for c, sd in case.told["noise"]["sd"].items():
        before, unit = case.campaign.noise.get(c), BY_NAME[c].unit.name
        if before and abs(sd / before - 1) > 1e-9:
            old, shown = amount(before, None, unit), amount(sd, None, unit)
            yield f"The residuals of {code(c)} contradict {old}; the {shown} that they show was used instead."
    for c, coefficient in case.told["noise"]["ar"].items():
        yield (
            f"The noise of {code(c)} is coloured, and was modelled as a first-order autoregressive process with a coefficient "
            f"of {read_out(coefficient, '1')} from one reading to the next."
        )
