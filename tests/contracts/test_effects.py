"""What every effect in the catalogue must satisfy, from its record alone; and that one which does not is found out."""

from __future__ import annotations

import re
from dataclasses import replace

import casadi as cs
import numpy as np
import pytest

from tests.kit import anywhere, variant_with
from wheelchair_fmu.contracts import Subject, breaches, mirror
from wheelchair_fmu.contracts.places import evaluate
from wheelchair_fmu.errors import ModelError
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.expression import law
from wheelchair_fmu.model.signs import Shows
from wheelchair_fmu.model.smooth import magnitude
from wheelchair_fmu.model.stage import Contribution, Effect, Row, adds, scales
from wheelchair_fmu.model.wheelchair import assemble
from wheelchair_fmu.quantities import KG, M_S, N_S_M, N, Parameter, State, Unit

EFFECTS = bundled()


@pytest.fixture(params=list(EFFECTS))
def effect(request) -> Effect:
    return EFFECTS[request.param]


def test_it_keeps_every_contract(effect):
    assert breaches(effect) == []
    assert re.fullmatch(r"[a-z][a-z_]*", effect.id)
    assert effect.title[0].islower()


def test_what_every_model_keeps_an_effect_keeps_whether_it_claims_it_or_not(effect):
    assert mirror(Subject.of([effect])) == []


def an(law, *, to="F_x", unit=N_S_M, kind=adds, mirror="", **more) -> Effect:
    """An effect whose only term is this law of q."""
    usual = {"off": 0.0, "smallest_interesting": 0.5, "lower": 0.0, "upper": 9.0, "source": "chosen"}
    q = Parameter("q", unit, "its size", mirror=mirror, **(usual | more))
    return Effect("mine", "what I think", (q,), (law if isinstance(law, Contribution) else kind(to, law),))


SLOWER = Shows("coast-down", "chair.u", more=False)
LAGGED = State("lagged", N, "a push that lags", nominal=10.0)
SLIDING = State("sliding", M_S, "how fast a load slides against the frame")


def a_load(mass=lambda load: load, rate=lambda sliding, k: -k * sliding, coupled=lambda load: load, upper=20.0) -> Effect:
    """A load of some mass that slides on the frame, forward, with friction."""
    load = Parameter("load", KG, "mass", off=0.0, smallest_interesting=1.0, lower=0.0, upper=upper, source="chosen")
    friction = Parameter("k", N_S_M, "friction", default=5.0, lower=0.1, upper=100.0, source="chosen")
    return Effect("mine", "a load that slides", (load,), (), (Row(SLIDING, mass, rate, coupled={"u": coupled}),), (friction,))


def test_inertia_that_is_shared_with_the_chair_keeps_every_contract():
    assert breaches(a_load()) == []


@pytest.mark.parametrize(
    ("effect", "contract", "fact", "cure"),
    [
        (
            an(lambda q, u: -q * u, unit=N),
            "units",
            "its term in F_x comes out in W where N belongs",
            "give q the unit N.s/m instead of N",
        ),
        (an(law("-q * u"), unit=N), "units", "comes out in W where N belongs", "give q the unit N.s/m"),
        (an(lambda q, u: -q * magnitude(u, 0.01)), "units", "adds unlike quantities, or a plain number", "constants=("),
        (an(law("-q * magnitude(u, 0.01)")), "units", "adds unlike quantities", "0.1 [m/s]"),
        (an(lambda q, u: 1 + q * u, to="F_t", kind=scales), "units", "its factor of F_t has no unit, but 1 belongs", ""),
        (
            replace(an(lambda lagged: -lagged), rows=(Row(LAGGED, lambda q: q, lambda u: u),)),
            "units",
            "rate / mass of lagged comes out in m/kg where kg.m/s3 belongs",
            "change the law, or the units of q",
        ),
        (
            a_load(coupled=lambda load, b: load * b),
            "units",
            "what couples sliding with u comes out in kg.m where kg belongs",
            "give load the unit N.s2/m2 instead of kg",
        ),
        (
            a_load(lambda: 1.0, lambda sliding, k, load: -k * sliding / load),
            "units",
            "the rate of sliding, coupled as it is, comes out in m/s2 where N belongs",
            "change the law",
        ),
        (a_load(upper=100.0), "inertia", "with load = 100 what resists a change of u is -20", "narrow the bounds"),
        (a_load(coupled="load"), "record", "coupled of a row is {'u': 'load'}", 'coupled={"u": law}'),
        (an(lambda q, u: q * u, kind=scales), "neutral when off", "should be", "each factor 1"),
        (an(lambda q, u: 0 * q * u), "does something", "with q = 0.5 N.s/m nothing changes", "let a law read"),
        (
            an(lambda q, u: -q * cs.sqrt(u) * cs.sqrt(u)),
            "finite at standstill",
            "the slope of the equation of u by u is nan",
            "magnitude(u, v_eps)",
        ),
        (an(lambda q, u, v_eps: q * v_eps * v_eps / u), "finite at standstill", "is nan", "away from zero"),
        (
            an(lambda q, u: -q * cs.sign(u), unit=N),
            "exact derivative",
            "at rest its term in F_x changes by -5e+07 N per m/s of u, but its derivative says 0",
            "nothing that jumps",
        ),
        (an(adds("F_x", lambda q, u: q * u, opposes="u")), "passive", "opposes u, but adds", "turn the sign"),
        (
            an(adds("F_x", lambda q, u: -q * u, opposes="u"), lower=-1.0),
            "passive",
            "with its parameters negative",
            "set lower=0.0",
        ),
        (an(adds("F_x", lambda q, u: -q * u, opposes="w")), "passive", "opposes='w' is no quantity", ""),
        (an(lambda q: q, to="F_y", unit=N, mirror="+"), "mirror", 'along the chair, with mirror= of q "+"', 'mirror="-"'),
        (an(lambda q: q, to="F_y", unit=N, mirror="-p"), "mirror", "no partner p", "symbol behind the sign"),
        (an(lambda q, u: -q * u, off=1.0), "record", "q is off at 1.0", "write off=0.0"),
        (an(lambda q, u: -q * u, smallest_interesting=None), "record", "smallest_interesting of q is None", "N.s/m"),
        (an(lambda q, u: -q * u, upper=float("inf")), "record", "0 to inf", "finite"),
        (an(lambda q, u: -q * u, upper=0.2), "record", "0.5 N.s/m is of interest", "lower ≤ 0"),
        (an(lambda q, u: -q * u, source=""), "record", "q has no source", "in quotes"),
        (an(lambda q, u: -q * u, unit="N"), "record", "the unit of q is 'N'", "wheelchair_fmu.quantities"),
        (an(lambda q, u: -q * u, unit=Unit("N", kg="1")), "record", "the unit of q is Unit(name='N', kg='1'", "import a Unit"),
        (an(lambda q, v_xr: -q * v_xr), "equations", "gives F_x a term of shape (2, 1)", "give one number"),
        (an("-q * u"), "record", "the law of its term in F_x is a str", "function"),
        (replace(an(lambda q: q), parameters=Parameter("q", N)), "record", "parameters is a Parameter", "with the comma"),
        (replace(an(lambda q, u: -q * u), signs=("left",)), "record", "signs is a tuple of str", "signs=(Shows(...),)"),
        (replace(an(lambda q, u: -q * u), signs=(SLOWER,) * 2), "record", "signs has 2 for 1 parameters", "one for each"),
        (replace(an(lambda q: q), title=3), "record", "its title is 3", "few words"),
        (replace(an(lambda q: q), needs={"caster": "square"}), "record", "needs is {'caster': 'square'}", "swivelling"),
        (replace(an(lambda q: q), through="caster_trail"), "record", "through is 'caster_trail'", "with the comma"),
        (an(lambda q, nonsense: q * nonsense), "equations", "reads 'nonsense', which is no quantity", "effects quantities"),
        (an(lambda q, u: -q * u, to="F_z"), "equations", "'F_z'", "did you mean"),
        (an(lambda q, u: -q * u if u > 0 else 0), "equations", "RuntimeError: Cannot compute the truth value", "without if"),
    ],
)
def test_what_breaks_a_contract_is_named_with_its_cure(effect, contract, fact, cure):
    found = breaches(effect)
    told = [str(b) for b in found if b.contract == contract]
    assert told, [str(b) for b in found]
    assert fact in told[0]
    assert cure in told[0]
    assert "\n" not in told[0]


def test_everything_that_is_broken_is_named_at_once():
    found = breaches(an(lambda q, u: 1 + q * cs.sign(u), unit=N, mirror="-"))
    assert [b.contract for b in found] == ["units", "neutral when off", "exact derivative", "mirror"]


def test_no_claim_of_a_mirror_is_fine():
    assert breaches(an(lambda q: q, to="F_y", unit=N)) == []


def test_order_does_not_matter():
    ids = list(EFFECTS)
    one, two = variant_with(*ids), variant_with(*ids[::-1])
    place = anywhere(one, np.random.default_rng(14))
    models = one.model(), two.model()
    np.testing.assert_array_equal(evaluate(models[0], place, models[0].f)[0], evaluate(models[1], place, models[1].f)[0])


def test_misfits_are_refused():
    good = EFFECTS["rolling_resistance_speed"]
    with pytest.raises(ModelError, match="needs the caster law 'swivelling'"):
        assemble(effects=[EFFECTS["caster_friction"]])
    with pytest.raises(ModelError, match="reads 'F_x', which is only known further down the line"):
        assemble(effects=[Effect("early", "early", good.parameters, (adds("N_r", lambda F_x: F_x),))])
    with pytest.raises(ModelError, match="reads 'nonsense', which is no quantity of this model"):
        assemble(effects=[Effect("odd", "odd", good.parameters, (adds("F_x", lambda nonsense: nonsense),))])
    with pytest.raises(Exception, match="no quantity for effect lost to act on 'F_z'"):
        assemble(effects=[Effect("lost", "lost", good.parameters, (adds("F_z", lambda u, k: -k * u),))])
    with pytest.raises(ModelError, match="gives F_x a term of shape"):
        assemble(effects=[Effect("wide", "wide", good.parameters, (adds("F_x", lambda v_xr, k: -k * v_xr),))])
