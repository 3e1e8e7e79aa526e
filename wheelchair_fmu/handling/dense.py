"""CasADi functions whose results are arrays: written into NumPy's memory, without the copies of `DM.full`."""

from __future__ import annotations

from typing import Any

import casadi as cs
import numpy as np


class DenseFunction:
    """A function of dense vectors (n,) whose results are dense arrays (n, m)."""

    def __init__(self, name: str, arguments: list[cs.SX], results: list[cs.SX]):
        self._function = cs.Function(name, arguments, [cs.densify(result) for result in results])
        self._shapes = [self._function.size_out(i) for i in range(self._function.n_out())]

    def __call__(self, *arguments: np.ndarray) -> list[np.ndarray]:
        buffer: Any
        buffer, evaluate = self._function.buffer()  # of this call alone: threads may share the function
        given = [np.ascontiguousarray(argument, float) for argument in arguments]
        results = [np.zeros(shape, order="F") for shape in self._shapes]  # CasADi's are by columns
        for place, argument in enumerate(given):
            buffer.set_arg(place, argument.data)
        for place, result in enumerate(results):
            if result.size:
                buffer.set_res(place, result.T.data)
        evaluate()
        return results
