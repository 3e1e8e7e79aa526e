"""Inertia that an effect shares with the chair, against the equations of motion that it stands for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.model.effects.chair import I_Z, MASS, SMOOTH
from wheelchair_fmu.contracts.places import Place, anywhere, evaluate
from wheelchair_fmu.engine.kernel import rate
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.errors import ModelError
from wheelchair_fmu.model.stage import Effect, Row
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import assemble
from wheelchair_fmu.quantities import KG, KG_M2, M_S, N_M, RAD_S, M, Parameter, State, Unit

LOAD, STIFFNESS, STRETCHED = 20.0, 2000.0, 0.01
SPRING = Effect(
    "sprung_load",
    "a load on the frame, held by a spring",
    (Parameter("load", KG, "mass of it", off=0.0, smallest_interesting=1.0, lower=0.0, upper=60.0, source="a scale"),),
    rows=(
        Row(State("place", M, "how far it has moved forward"), lambda: 1.0, lambda speed: speed, lambda s0: s0),
        Row(State("speed", M_S, "how fast"), lambda load: load, lambda k, place: -k * place, coupled={"u": lambda load: load}),
    ),
    constants=(
        Parameter("k", Unit("N/m", kg=1, s=-2), "stiffness", default=STIFFNESS, lower=1.0, upper=1e6, source="chosen"),
        Parameter("s0", M, "place at the start", lower=-1.0, upper=1.0, source="chosen"),
    ),
)


def driven(values: dict, push: float) -> dict[str, np.ndarray]:
    """Every result over two seconds under a constant push [N], and the time."""
    chair = Variant(catalogue={SPRING.id: SPRING}).with_values({**SMOOTH, "effect.sprung_load.load": LOAD, **values})
    simulator, t = Simulator(chair), np.linspace(0, 2, 401)
    inputs = {"push.F_rl": np.full(401, push / 2), "push.F_rr": np.full(401, push / 2)}
    trajectory = simulator.run(t, simulator.inputs(401, inputs), tolerance=1e-10)
    return {"t": t, **{o.name: trajectory[o.name] for o in simulator.model.outputs}}


def test_a_load_on_a_spring_swings_against_the_frame():
    """m u' + l w' = F and l (u' + w') = −k s: about its new place the load swings as two masses on a spring do."""
    run, push, frame = driven({"start.u": 1.0}, 30.0), 30.0, MASS - LOAD
    omega = np.sqrt(STIFFNESS * (1 / LOAD + 1 / frame))
    place = -push / (frame * omega**2) * (1 - np.cos(omega * run["t"]))
    sliding = -push / (frame * omega) * np.sin(omega * run["t"])
    np.testing.assert_allclose(run["effect.sprung_load.place"], place, atol=1e-7)
    np.testing.assert_allclose(run["chair.u"], 1 + (push * run["t"] - LOAD * sliding) / MASS, atol=1e-7)
    np.testing.assert_allclose(run["sensor.a_x"], (push + STIFFNESS * place) / frame, atol=1e-4)


def test_a_held_speed_takes_the_push_that_holds_the_load():
    held = {"speed.mode": "prescribed", "speed.u": 1.0, "effect.sprung_load.s0": STRETCHED}
    run = driven(held, 0.0)
    place = STRETCHED * np.cos(np.sqrt(STIFFNESS / LOAD) * run["t"])
    np.testing.assert_allclose(run["effect.sprung_load.place"], place, atol=1e-7)
    np.testing.assert_allclose(run["push.total_needed"], -STIFFNESS * place, atol=1e-4)
    np.testing.assert_array_equal(run["chair.u"], 1.0)


SHARES = np.array([[3.0, 1.0, -0.2], [-1.0, 4.0, 0.3]])  # of the inertia j, with u, v [kg m] and ψ' [kg m²], by body
DAMPING, MOMENT = 3.0, 4.0


def leaning(name: str, shares: np.ndarray) -> Effect:
    """A body that leans with some inertia, of which it shares so much with u, v and ψ'."""
    size = Parameter("j", KG_M2, "inertia", off=0.0, smallest_interesting=1.0, lower=0.0, upper=9.0, source="chosen")
    moment = Parameter("moment", N_M, "on it", default=MOMENT, source="chosen")
    swing = Row(
        State("swing", RAD_S, "how fast"),
        lambda j: j,
        lambda moment, swing, j: moment - DAMPING * j * swing,
        coupled={speed: times(share) for speed, share in zip(("u", "v", "psi_dot"), shares, strict=True)},
    )
    return Effect(name, "a body that leans", (size,), (), (swing,), (moment,))


def times(share: float):
    return lambda j: share * j


def moments(effects: list[Effect], size: float, seed: int) -> tuple:
    """A model with these effects at this size, and one without: each in the same random motion."""
    model, bare = assemble(effects=effects), assemble()
    p = np.array([size if q.name.endswith(".j") else q.default for q in model.parameters])
    place = anywhere(model, p, np.random.default_rng(seed), spread=0)
    without = Place(place.x[: bare.x.numel()], place.w, place.p[: bare.p.numel()])
    return model, place, bare, without


def test_all_rates_together_are_those_of_the_whole_mass_matrix():
    model, place, bare, without = moments([leaning("pitch", SHARES[0]), leaning("roll", SHARES[1])], 1.0, 1)
    (forces,), (rates,) = evaluate(bare, without, bare.f), evaluate(model, place, rate(model))
    whole = np.block([[np.diag([MASS, MASS, I_Z]), SHARES.T], [SHARES, np.eye(2)]])
    right = [*forces[3:6], *(MOMENT - DAMPING * place.x[6:])]
    np.testing.assert_allclose(rates[3:], np.linalg.solve(whole, right), rtol=1e-12)


def test_a_body_without_inertia_leaves_the_chair_as_it_is():
    model, place, bare, without = moments([leaning("pitch", SHARES[0])], 0.0, 2)
    (here,), (there,) = evaluate(model, place, rate(model)), evaluate(bare, without, rate(bare))
    np.testing.assert_array_equal(here[:6], there)


def test_what_the_chair_cannot_share_inertia_with_is_named():
    swing = replace(leaning("pitch", SHARES[0]).rows[0], coupled={"x": times(1.0)})
    with pytest.raises(ModelError, match="swing is coupled with 'x'; write one number that moves with 'psi_dot', 'u', 'v'"):
        assemble(effects=[replace(leaning("pitch", SHARES[0]), rows=(swing,))])
