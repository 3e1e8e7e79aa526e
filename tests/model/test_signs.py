"""What records say of signs is what a chair does, in the manoeuvre that they name; and every effect is drawn."""

from __future__ import annotations

from functools import cache
from xml.etree import ElementTree

import casadi as cs
import numpy as np
import pytest

from wheelchair_fmu.engine.kernel import kernel
from wheelchair_fmu.handling.manoeuvres import INTERVAL, manoeuvre
from wheelchair_fmu.model.catalogue_page import drawings
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.sketch_svg import HIGH, WIDE
from wheelchair_fmu.model.variant import Variant

CLAIMS = [(e.id, p.name) for e in bundled().values() for p in e.parameters]
PLAIN = 1e-7  # of a result's mean, in its SI unit: far above rounding


class Chair:
    """A chair with one effect, driven by steps that CasADi evaluates, so that nothing is compiled."""

    def __init__(self, effect: str):
        self.effect = bundled()[effect]
        self.variant = Variant().with_effects([effect])
        self.model = self.variant.model()
        self.functions = kernel(self.model).functions
        self.advance = cs.Function("advance", *self._one())
        self.run = cache(self._run)

    def _one(self):
        x, w0, w1, p = (cs.SX.sym(name, n) for name, n in (("x", self.model.x.numel()), *self._sizes()))
        step = self.functions["step"](x, w0, w1, INTERVAL, p)[0]
        return [x, w0, w1, p], [step]

    def _sizes(self):
        return ("w0", self.model.w.numel()), ("w1", self.model.w.numel()), ("p", self.model.p.numel())

    def _run(self, name: str, result: str, seconds: float, parameter: str, size: float) -> float:
        """The mean of a result in the first seconds of a manoeuvre, with the parameter at this size."""
        driven = manoeuvre(name)
        late = size if self.effect.delays_record else 0.0
        sizes = {} if self.effect.delays_record else {parameter: size}
        p = self.variant.with_values({**driven.values, **sizes}).vector()
        n = int(seconds / INTERVAL) + 1
        w = np.tile([i.start for i in self.model.inputs], (n, 1))
        for i, record in enumerate(self.model.inputs):
            if record.name in driven.inputs:
                w[:, i] = np.interp(driven.time[:n] - late, driven.time, driven.inputs[record.name])
        x = self.functions["start"](p, w[0])
        for _ in range(5):  # algebraic states into their places
            x = self.functions["project"](x, w[0], p)
        many = cs.repmat(p, 1, n)
        xs = cs.horzcat(x, self.advance.mapaccum("run", n - 1)(x, w[:-1].T, w[1:].T, many[:, 1:]))
        readings = self.functions["output"].map(n)(xs, w.T, many)
        place = [o.name for o in self.model.outputs].index(result)
        return float(np.mean(readings.full()[place]))


chair = cache(Chair)


@pytest.mark.parametrize(("effect", "name"), CLAIMS)
def test_a_value_above_zero_does_what_its_record_says(effect, name):
    record = bundled()[effect]
    parameter, sign = next(
        (p.owned_by(effect), s) for p, s in zip(record.parameters, record.signs, strict=True) if p.name == name
    )

    def change(size: float) -> float:
        """What it adds to the result, as far as it goes the way that the record says."""
        mean = chair(effect).run
        with_it, without = (mean(sign.manoeuvre, sign.result, sign.seconds, parameter.name, s) for s in (size, 0.0))
        return (with_it - without) * (1 if sign.more else -1)

    assert change(parameter.delta) > PLAIN
    if parameter.lower < 0:
        assert (1 if sign.either else -1) * change(-parameter.delta) > PLAIN
    else:
        assert not sign.either


def test_every_effect_is_drawn_inside_its_picture():
    for file, text in drawings().items():
        picture = ElementTree.fromstring(text)
        width, marks = float(picture.get("width")), list(picture.iter())
        assert len(marks) > 12, file
        assert width == WIDE * len(bundled()[file.removesuffix(".svg")].sketches)
        for word in (m for m in marks if m.tag.endswith("text")):
            assert 0 < float(word.get("x")) < WIDE and 0 < float(word.get("y")) < HIGH, (file, word.text)
