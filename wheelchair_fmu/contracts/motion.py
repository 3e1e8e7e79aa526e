"""What an effect must do to the equations of motion, asked of the whole model: nothing when it is off, something when it is on,
oppose what it says it opposes, and go with the mirror as its parameters say."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..quantities import Quantity
from .places import Place, Settler, anywhere, evaluate, mirrored, mirrored_place
from .subject import Breach, Subject

SPEEDS = (1.0, 0.0, -0.7)
PASSIVE_SPEEDS = np.linspace(-1, 1, 21)
NOTHING = 1e-12  # of a force times a velocity, beside their sizes
SAME = 1e-11  # of two numbers that are equal but for rounding
Far = tuple[float, Quantity, float, float]  # how far off, beside what is allowed; where, what is there and what should be


def neutral(subject: Subject) -> list[Breach]:
    """With its parameters at zero the chair moves as without the effect."""
    rng = np.random.default_rng(11)
    worst: list[Far] = []
    model = subject.model
    settled = Settler(model)
    for speed in SPEEDS:
        there = anywhere(subject.bare, subject.values(0.0)[: len(subject.bare.parameters)], rng, speed)
        before = evaluate(subject.bare, there, subject.bare.f, subject.bare.y)
        x = np.concatenate([there.x, np.zeros(model.x.numel() - len(there.x))])
        p = np.concatenate([there.p, subject.values(0.0)[len(there.p) :]])
        after = evaluate(model, settled(Place(x, there.w, p))[0], model.f, model.y)
        for records, is_, should in zip((subject.bare.states, subject.bare.outputs), after, before, strict=True):
            worst += _furthest(records, is_[: len(should)], should)
    if not worst:
        return []
    return [
        subject.breach(
            "neutral when off",
            f"with its parameters at 0 {_words(*max(worst, key=lambda far: far[0]))}",
            "write each term so that it is 0, and each factor 1, where the parameters are 0",
        )
    ]


def present(subject: Subject) -> list[Breach]:
    """At its smallest interesting size something changes: the equations, the mass or a reading."""
    if any(effect.delays_record for effect in subject.effects) or not subject.effects:
        return []  # it shifts the record, not the chair
    model, rng = subject.model, np.random.default_rng(12)
    for speed in (*SPEEDS, *SPEEDS, *SPEEDS):
        place = anywhere(model, subject.values(1.0), rng, speed, spread=0)
        off = Place(place.x, place.w, subject.values(0.0))
        on, without = (evaluate(model, at, model.f, model.mass, model.y) for at in (place, off))
        if any(not np.array_equal(a, b) for a, b in zip(on, without, strict=True)):
            return []
    sizes = ", ".join(f"{p.name} = {p.smallest_interesting:g} {p.unit.name}" for e in subject.effects for p in e.parameters)
    return [
        subject.breach(
            "does something",
            f"with {sizes} nothing changes, at rest, forward, backward and in turns",
            "let a law read the parameter",
        )
    ]


def passive(subject: Subject) -> list[Breach]:
    """What it says opposes a velocity takes power from it, whatever its size."""
    return [
        breach
        for effect in subject.effects
        for c in effect.contributions
        if c.opposes
        for breach in _opposes(subject, c.to, c.opposes)
    ]


def _opposes(subject: Subject, to: str, velocity: str) -> Iterator[Breach]:
    model, rng = subject.model, np.random.default_rng(13)
    if velocity not in model.quantities:
        yield subject.breach("passive", f"opposes={velocity!r} is no quantity of this model", 'name a velocity, such as "u"')
        return
    for size in (1.0, -1.0):
        for speed in PASSIVE_SPEEDS:
            place = anywhere(model, subject.values(size), rng, float(speed), spread=0)
            force, rate = evaluate(model, place, model.quantities[to], model.quantities[velocity])
            (without,) = evaluate(model, Place(place.x, place.w, subject.values(0.0)), model.quantities[to])
            power = (force - without) * rate
            i = int(np.argmax(power))
            if power[i] > NOTHING:
                at = f"{velocity} = {np.ravel(rate)[i if np.size(rate) > 1 else 0]:.3g} {_unit_of(subject, velocity)}"
                adds = f"{(force - without)[i]:.3g} {model.records[to].unit.name}"
                negative = " with its parameters negative" if size < 0 else ""
                fact = f"its term in {to} says that it opposes {velocity}, but adds {adds} at {at}{negative}"
                yield subject.breach("passive", fact, "turn the sign in the law, set lower=0.0, or leave out opposes=")
                return


def _unit_of(subject: Subject, symbol: str) -> str:
    records = (*subject.model.states, *subject.model.records.values())
    return next((q.unit.name for q in records if q.symbol == symbol), "")


def mirror(subject: Subject) -> list[Breach]:
    """A mirrored chair in a mirrored motion has mirrored forces, to rounding, where parameters are mirrored as they say."""
    model, rng = subject.model, np.random.default_rng(1)
    for speed in SPEEDS:
        place = anywhere(model, subject.values(1.0), rng, speed)
        try:
            image = mirrored_place(model, place)
        except ValueError as error:
            return [subject.breach("mirror", str(error), 'name the partner\'s symbol behind the sign, as in mirror="-tau_l"')]
        for what, records in ((model.f, model.states), (model.y, model.outputs)):
            (here,), (there,) = (evaluate(model, at, what) for at in (place, image))
            for found in _furthest(records, there, mirrored(records, here), SAME):
                own = ", ".join(f'{p.name} "{p.mirror}"' for e in subject.effects for p in e.parameters)
                return [
                    subject.breach(
                        "mirror",
                        f"in a mirror along the chair, with mirror= of {own}, {_words(*found)}",
                        'what turns left into right has mirror="-", the same on both sides "+", a left and a right parameter '
                        "each other's symbol behind the sign; or leave mirror= out",
                    )
                ]
    return []


def _furthest(records: Sequence[Quantity], is_: np.ndarray, should: np.ndarray, same: float = NOTHING) -> list[Far]:
    """The number that is furthest from what it should be, where one is further than rounding accounts for."""
    off = abs(is_ - should) / (same + same * abs(should))
    off = np.where(np.isnan(off), np.inf, off)
    i = int(np.argmax(off))
    if off[i] <= 1:
        return []
    return [(float(off[i]), [r for r in records for _ in r.names][i], float(is_[i]), float(should[i]))]


def _words(_: float, record: Quantity, is_: float, should: float) -> str:
    what = f"{record.name}" if record.name.count(".") else f"the equation of {record.name}"
    unit = f" {record.unit.name}" if record.name.count(".") else ""
    return f"{what} is {is_:.6g}{unit} and should be {should:.6g}{unit}"
