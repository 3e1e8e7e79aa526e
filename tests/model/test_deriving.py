"""CasADi lets other threads run while it works, and its expressions are not for several of them."""

from __future__ import annotations

import time
from concurrent.futures import ThreadPoolExecutor

from wheelchair_fmu.model import wheelchair
from wheelchair_fmu.model.variant import Variant


def test_models_are_assembled_one_at_a_time(monkeypatch):
    inside, most, whole = [0], [0], wheelchair._Assembly.model

    def watched(self):
        inside[0] += 1
        most[0] = max(most[0], inside[0])
        time.sleep(0.01)
        try:
            return whole(self)
        finally:
            inside[0] -= 1

    monkeypatch.setattr(wheelchair._Assembly, "model", watched)
    with ThreadPoolExecutor(4) as pool:
        models = list(pool.map(lambda _: Variant().model(), range(8)))
    assert len(models) == 8 and most[0] == 1
