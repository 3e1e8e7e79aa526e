"""Energy never rises without a push: each effect and each law over its whole bounds, and random pairs, whatever the motion."""

from __future__ import annotations

from dataclasses import replace
from functools import wraps
from itertools import combinations

import numpy as np
import pytest

from wheelchair_fmu.contracts import Subject
from wheelchair_fmu.contracts.energy import KINDS, NONE, SAME, Energy
from wheelchair_fmu.contracts.places import Place
from wheelchair_fmu.model.choice import serves
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.stage import Effect, Law, Row, adds
from wheelchair_fmu.model.wheelchair import Choice, assemble
from wheelchair_fmu.quantities import KG, M_S, N_M_S, N_S_M, M, N, Parameter, State, Unit

EFFECTS = bundled()
PAIRS, SEED = 60, 20
CHOICES = [
    Choice("linear", "ideal"),
    Choice("linear", "swivelling"),
    Choice("dugoff", "swivelling"),
    Choice("magic_formula"),
    Choice("linear", "slipping"),
    Choice("dugoff", "swivelling", "spinning"),
    Choice("dugoff", "slipping", "spinning"),
]


@pytest.fixture(scope="module", params=CHOICES, ids=lambda c: f"{c.tyre}-{c.caster}-{c.wheel}")
def chair(request) -> Energy:
    """All effects that these laws allow, in one model: those that are not asked of are off."""
    choice = request.param
    effects = [e for e in EFFECTS.values() if all(serves(choice, kind, law) for kind, law in e.needs.items())]
    return Energy(Subject(tuple(effects), assemble(choice, effects), assemble(choice)))


def told(breaches) -> list[str]:
    return [str(b) for b in breaches]


def test_no_effect_anywhere_in_its_bounds_drives_the_chair(chair):
    rng = np.random.default_rng(SEED)
    assert told(chair.breaches((), rng)) == []
    for effect in chair.subject.effects:
        assert told(chair.breaches([effect], rng)) == [], effect.id


def test_no_two_effects_together_drive_the_chair(chair):
    rng = np.random.default_rng(SEED + 1)
    pairs = list(combinations(chair.subject.effects, 2))
    for i in rng.choice(len(pairs), PAIRS, replace=False):
        assert told(chair.breaches(pairs[i], rng, times=20)) == [], [e.id for e in pairs[i]]


@pytest.mark.parametrize("choice", CHOICES, ids=lambda c: f"{c.tyre}-{c.caster}-{c.wheel}")
def test_no_law_anywhere_in_its_bounds_drives_the_chair(choice):
    """Sine of C times an angle turns its sign where C is more than 2: the Magic Formula's bounds were wider once."""
    bare = assemble(choice)
    assert told(Energy(Subject((), bare, bare), laws=True).breaches((), np.random.default_rng(SEED), times=2000)) == []


@pytest.mark.nightly
def test_nor_does_any_pair_however_long_one_looks(chair):
    rng = np.random.default_rng(SEED + 2)
    for effect in chair.subject.effects:
        assert told(chair.breaches([effect], rng, times=600)) == [], effect.id
    for pair in combinations(chair.subject.effects, 2):
        assert told(chair.breaches(pair, rng, times=40)) == [], [e.id for e in pair]


TYRES = (
    "camber_misalignment",
    "inflation_pressure",
    "load_sensitivity",
    "pneumatic_trail_decay",
    "tyre_saturation",
    "turn_slip",
)


@pytest.mark.parametrize("tyre", ["linear", "dugoff", "magic_formula"])
def test_camber_and_self_aligning_torque_give_less_than_rolling_resistance_takes(tyre):
    """The paper's laws of them oppose no velocity: beside the chair's rolling resistance energy falls even so.

    But for a linear tyre that slides while its wheel hardly rolls, far beyond what that law is for.
    """
    choice = Choice(tyre)
    effects = [EFFECTS[id] for id in TYRES if all(serves(choice, kind, law) for kind, law in EFFECTS[id].needs.items())]
    chair = Energy(Subject(tuple(effects), assemble(choice, effects), assemble(choice)))
    names, whole = [q.name for q in chair.subject.model.parameters], chair.subject.values(0.0)
    kept = [i for i, name in enumerate(names) if name in NONE]
    constants = [names.index(f"effect.{e.id}.{q.name}") for e in effects for q in e.constants]
    rng, still = np.random.default_rng(SEED), np.array([i.start for i in chair.subject.model.inputs])
    for effect in (None, *effects):
        for kind in (kind for kind in KINDS if tyre != "linear" or kind != "sliding"):
            for _ in range(200):
                p = chair._values([effect] if effect else [], rng)
                p[kept], p[constants] = whole[kept], whole[constants]
                power, scale, _ = chair._powers_at(Place(chair._states(KINDS[kind], rng), still, p))
                assert power <= SAME * scale, (kind, effect and effect.id)


def test_and_without_rolling_resistance_they_give_what_is_told():
    """Of both, at small slip on a straight way: C_mλ² ψ'²/(4 C_λ v) a wheel, where λ = C_mλ ψ'/(2 C_λ v)."""
    bare = assemble(Choice())
    chair = Energy(Subject((), bare, bare))
    p = chair.subject.values(0.0)
    of = {q.name: i for i, q in enumerate(bare.parameters)}
    p[[of["resistance.f_r"], of["resistance.f_f"]]] = 0.0
    C, C_m, u, psi_dot = p[of["tyre.C_lambda"]], p[of["tyre.C_m_lambda"]], 2.0, 0.02
    v = p[of["chair.b"]] * psi_dot + C_m * psi_dot / (2 * C)  # of the axle, aside: its force gives less than its torque
    x, still = np.zeros(bare.x.numel()), np.array([i.start for i in bare.inputs])
    x[3:6] = u, v, psi_dot
    power, _, _ = chair._powers_at(Place(x, still, p))
    assert power == pytest.approx(2 * C_m**2 * psi_dot**2 / (4 * C * u), rel=1e-3)


def turned(law: Law) -> Law:
    """The law with the other sign."""

    @wraps(law)
    def other(*values):
        return -law(*values)

    return other


DRIVING = {  # by effect, where its power goes: with the other sign there it would drive
    "aerodynamic_drag": ("F_x",),
    "caster_friction": ("M_w",),
    "caster_inertia": ("M_p",),
    "pivot_torque": ("M_t",),
    "relaxation_length": ("lam_F",),
    "rolling_resistance_asymmetry": ("D_w",),
    "rolling_resistance_speed": ("d_r", "d_f"),
    "scrub_torque": ("M_z",),
    "scrub_torque_viscous": ("M_z",),
    "toe_misalignment": ("v_xw", "v_yw", "F_xr", "F_yr"),
    "trunk_motion": ("v_xf", "v_xr"),
    "turn_slip": ("M_t", "M_p"),
}


@pytest.mark.parametrize(("id", "to"), [(id, to) for id, places in DRIVING.items() for to in places])
def test_a_sign_that_is_wrong_is_found_out(id, to):
    effect = EFFECTS[id]
    wrong = [replace(c, law=turned(c.law)) if c.to == to else c for c in effect.contributions]
    assert wrong != list(effect.contributions)
    mutant = replace(effect, contributions=tuple(wrong))
    swivelling = Choice("linear", "swivelling")  # at an ideal caster a torque of the patch does no work
    chair = Energy(Subject((mutant,), assemble(swivelling, [mutant]), assemble(swivelling)))
    assert chair.breaches([mutant], np.random.default_rng(SEED), times=2000)


def test_only_what_moves_no_power_has_no_such_sign():
    """What reads, weighs, or moves loads or stiffnesses; camber and self-aligning torque take part in no balance of energy."""
    idle = {"N_r", "N_f", "q_F", "q_M", "q_D", "inv_mu", "fall_x", "fall_y", "g_y", "g_z", "mass_u", "inertia", "phi", "M_lam"}
    idle |= {"shift", "recoil", "recoil_rate"}  # what a body does by a clock of its own, and that is its own work
    idle |= {"F_t", "y_r", "y_f", "x_r", "x_f", "c"}  # a push, and levers that force and velocity share
    for id, effect in EFFECTS.items():
        places = {c.to for c in effect.contributions if not c.to.startswith("read_")}
        assert places - idle == set(DRIVING.get(id, ())), id


Q = Parameter("q", N, "its size", off=0.0, smallest_interesting=0.5, lower=-9.0, upper=9.0, source="chosen")


@pytest.mark.parametrize(
    ("effect", "fact"),
    [
        (Effect("motor", "a motor", (Q,), (adds("F_x", lambda q: q),)), "its energy rises by"),
        (Effect("easy", "a wheel that drives", (Q,), (adds("D_w", lambda q: q),)), "D_w is -"),
        (
            Effect("spun", "a spin fed", (replace(Q, unit=N_M_S),), (adds("M_z", lambda q, psi_dot: q * psi_dot),)),
            "its energy rises by",
        ),
    ],
)
def test_what_drives_is_found_out(effect, fact):
    found = told(Energy(Subject.of([effect])).breaches([effect], np.random.default_rng(SEED)))
    assert len(found) == 1 and fact in found[0] and "q = " in found[0]


def lever_of_its_own(M_w, c, lever):
    """What is added to a bearing's moment where its force has the lever 50 mm and the caster swings by another."""
    return M_w * (c / lever - 1)


def test_a_caster_with_two_trails_is_found_out():
    """It made 1.8 J of 26 J once: a force by one lever, a swing by another."""
    friction = EFFECTS["caster_friction"]
    effect = replace(friction, contributions=(*friction.contributions, adds("M_f", lever_of_its_own)))
    chair = Energy(Subject.of([effect]))
    assert any(chair.breaches([effect], np.random.default_rng(seed)) for seed in range(8))


LOAD = Parameter("load", KG, "mass", off=0.0, smallest_interesting=1.0, lower=0.0, upper=20.0, source="chosen")
STIFFNESS = Parameter("k", Unit("N/m", kg=1, s=-2), "of the spring", default=2000.0, lower=0.0, source="chosen")
FRICTION = Parameter("friction", N_S_M, "of the load on the frame", default=5.0, lower=0.0, source="chosen")
PLACE = Row(State("place", M, "how far it has moved", nominal=0.05), lambda: 1.0, lambda sliding: sliding)


def pulled(k, place, friction, sliding):
    return -k * place - friction * sliding


def a_load(rate=pulled, stored=lambda k, place, sliding: k * place * sliding, shared=lambda load: load) -> Effect:
    """A load that slides on the frame on a spring, with friction, and moves with u and ψ'."""
    halves = {"u": shared, "psi_dot": lambda load, t_r: load * t_r / 2}
    sliding = Row(State("sliding", M_S, "how fast"), lambda load: load, rate, coupled=halves)
    return Effect("load", "a load on a spring", (LOAD,), (), (PLACE, sliding), (STIFFNESS, FRICTION), absorbs=stored)


def test_inertia_that_is_shared_with_the_chair_is_in_the_sum():
    """½ wᵀ M w of all speeds together: what a load takes from the frame it has, and its spring gives back what it was given."""
    assert told(Energy(Subject.of([a_load()])).breaches([a_load()], np.random.default_rng(SEED))) == []


@pytest.mark.parametrize(
    "effect",
    [
        a_load(stored=None),  # a spring that nobody wound
        a_load(rate=lambda k, place, friction, sliding: -k * place + friction * sliding),  # friction that drives
        replace(a_load(), contributions=(adds("F_x", lambda k, place: -k * place),)),  # felt twice
    ],
    ids=["wound by nobody", "driven by friction", "felt twice"],
)
def test_a_load_that_drives_is_found_out(effect):
    energy = Energy(Subject.of([effect]))
    assert any("its energy rises" in str(b) for b in energy.breaches([effect], np.random.default_rng(SEED), times=400))
