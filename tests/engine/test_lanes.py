"""Functions of several numbers at once: as exact as they say, and each lane as if it were alone."""

from __future__ import annotations

import ctypes

import casadi as cs
import numpy as np
import pytest

from wheelchair_fmu.engine import cache, compiler
from wheelchair_fmu.engine.inverses import dividing_once
from wheelchair_fmu.engine.lanes import OPERATIONS, in_two, lanes_source
from wheelchair_fmu.engine.source import CSRC
from wheelchair_fmu.errors import BuildError

ONE, TWO = ("sin", "cos", "exp", "log", "sqrt", "fabs", "sign", "atan"), ("atan2", "fmax", "fmin", "copysign")
DOORS = "".join(
    f"void of_{name}(long n, const double *a, const double *b, double *y) {{\n"
    "    for (long i = 0; i < n; i += WC_LANES) {\n"
    "        lanes u, v;\n"
    "        memcpy(&u, a + i, sizeof u);\n"
    "        memcpy(&v, b + i, sizeof v);\n"
    f"        u = lanes_{name}(u{', v' if name in TWO else ''});\n"
    "        memcpy(y + i, &u, sizeof u);\n"
    "    }\n"
    "}\n"
    for name in (*ONE, *TWO)
)


@pytest.fixture(scope="module", params=list(cache.VECTORS))
def functions(request, tmp_path_factory):
    """Each function of lanes.h as one of arrays, by name; vectors of so many numbers."""
    if request.param > cache.width():
        pytest.skip("this processor's vectors are shorter")
    folder = tmp_path_factory.mktemp("lanes")
    (folder / "doors.c").write_text(f'#include "lanes.h"\n#include <string.h>\n{DOORS}')
    flags = [f"-I{CSRC}", "-fvisibility=default", f"-DWC_LANES={request.param}", *cache.VECTORS[request.param]]
    library = ctypes.CDLL(str(compiler.compile_shared([folder / "doors.c"], folder / f"doors{compiler.SUFFIX}", flags)))

    def of(name):
        def call(a, b=0.0):
            a, b = (np.ascontiguousarray(v, float) for v in np.broadcast_arrays(a, b))
            padded = [np.concatenate([v, np.full(-len(v) % 8, 0.5)]) for v in (a, b)]
            y = np.empty(len(padded[0]))
            getattr(library, f"of_{name}")(ctypes.c_long(len(y)), *(ctypes.c_void_p(v.ctypes.data) for v in (*padded, y)))
            return y[: len(a)]

        return call

    return {name: of(name) for name in (*ONE, *TWO)}


def units_off(found, exact):
    """Greatest error in units of the last place of what is exact, given in more digits."""
    return float(np.max(np.abs(found - exact) / np.spacing(np.abs(exact.astype(float)))))


def spread(rng, low, high, n=200_000):
    """Numbers of both signs, evenly in their logarithm."""
    return rng.choice([-1.0, 1.0], n) * np.exp(rng.uniform(np.log(low), np.log(high), n))


@pytest.mark.skipif(np.finfo(np.longdouble).eps > 2e-19, reason="long double has no more digits here than double")
def test_functions_are_as_exact_as_their_file_says(functions):
    rng = np.random.default_rng(3)
    angles = np.concatenate([spread(rng, 1e-300, 7e5), np.arange(1, 4000) * np.pi / 2, [0.0, -0.0]])
    long = np.longdouble
    assert units_off(functions["sin"](angles), np.sin(long(angles))) < 1.0
    assert units_off(functions["cos"](angles), np.cos(long(angles))) < 1.0
    powers = np.concatenate([spread(rng, 1e-20, 700), [0.0]])
    assert units_off(functions["exp"](powers), np.exp(long(powers))) < 1.5
    positive = np.concatenate([np.abs(spread(rng, 1e-300, 1e300)), rng.uniform(0.5, 2, 200_000), 1 + spread(rng, 1e-15, 1e-3)])
    assert units_off(functions["log"](positive), np.log(long(positive))) < 1.5
    y, x = spread(rng, 1e-12, 1e12), spread(rng, 1e-12, 1e12)
    near = x * (1 + spread(rng, 1e-12, 0.5))
    for of in (y, near):
        assert units_off(functions["atan2"](of, x), np.arctan2(long(of), long(x))) < 2.5
    assert units_off(functions["atan"](y), np.arctan(long(y))) < 2.5


def test_what_is_far_out_is_as_the_c_library_has_it(functions):
    odd = np.array([0.0, -0.0, np.inf, -np.inf, np.nan, 1e300, -1e300, 5e-324, 1e6, -1e6, 800.0, -800.0, -1.0, 1.0])
    with np.errstate(all="ignore"):
        for name, of in {"sin": np.sin, "cos": np.cos, "exp": np.exp, "log": np.log, "sqrt": np.sqrt}.items():
            np.testing.assert_allclose(functions[name](odd), of(odd), rtol=1e-15, atol=0)
        assert np.array_equal(np.signbit(functions["sin"](odd[:2])), [False, True])
        y, x = (v.ravel() for v in np.meshgrid(odd, odd))
        np.testing.assert_allclose(functions["atan2"](y, x), np.arctan2(y, x), rtol=4e-16, atol=0)
        known = ~np.isnan(y)
        assert np.array_equal(np.signbit(functions["atan2"](y, x)[known & ~np.isnan(x)]), np.signbit(y[known & ~np.isnan(x)]))


def test_roots_sizes_and_signs_are_those_of_single_numbers(functions):
    rng = np.random.default_rng(4)
    a, b = spread(rng, 1e-200, 1e200, 1000), spread(rng, 1e-200, 1e200, 1000)
    for name, of in {"sqrt": np.sqrt, "fabs": np.abs, "sign": np.sign}.items():
        given = np.abs(a) if name == "sqrt" else np.append(a, 0.0)
        assert np.array_equal(functions[name](given), of(given))
    for name, two in {"fmax": np.maximum, "fmin": np.minimum, "copysign": np.copysign}.items():
        assert np.array_equal(functions[name](a, b), two(a, b))


def test_a_lane_does_not_depend_on_its_neighbours(functions):
    rng = np.random.default_rng(5)
    for name in (*ONE, *TWO):
        a, b = np.abs(spread(rng, 1e-3, 1e3, 64)), spread(rng, 1e-3, 1e3, 64)
        beside = np.where(rng.random(64) < 0.5, 1e300, a)  # where the C library is asked
        kept = beside == a
        assert np.array_equal(functions[name](a, b)[kept], functions[name](beside, b)[kept])


def of_each_operation(a, b):
    """An expression for every operation that the model's language may bring."""
    small = b / 4
    return [
        *(f(a) for f in (cs.sqrt, cs.fabs, cs.sign, cs.sin, cs.cos, cs.tan, cs.exp, cs.log, cs.sinh, cs.cosh, cs.tanh)),
        *(f(small) for f in (cs.asin, cs.acos, cs.atan, cs.asinh, cs.atanh, cs.erf, cs.floor, cs.ceil)),
        *(f(a, b) for f in (cs.fmax, cs.fmin, cs.atan2, cs.copysign, cs.power, cs.fmod)),
        *(a < b, a <= b, cs.eq(a, b), cs.ne(a, b), cs.logic_not(a < b), cs.logic_and(a < 1, b < 1), cs.logic_or(a < 1, b < 1)),
        *(a + b, a - b, a * b, a / b, -a, a * a, 2 * a, 1 / a, a**3.5, cs.acosh(a + 1), cs.if_else(a < b, a, b)),
    ]


def test_every_operation_of_a_model_has_its_form(tmp_path):
    a, b = cs.SX.sym("a"), cs.SX.sym("b")
    f = cs.Function("f", [cs.vertcat(a, b)], [cs.vertcat(*of_each_operation(a, b))])
    once = dividing_once(f, "f")
    used = {once.instruction_id(k) for k in range(once.n_instructions())} - {cs.OP_INPUT, cs.OP_OUTPUT, cs.OP_CONST}
    assert used <= set(OPERATIONS) and len(used) > 30
    given = np.random.default_rng(6).uniform(0.1, 3, (2, cache.width()))
    found = called(lanes_source({"f": f}), "lanes_f(arg, res);", given, f.numel_out(0), tmp_path)
    for e in range(cache.width()):
        np.testing.assert_allclose(found[:, e], f(given[:, e]).full().ravel(), rtol=4e-15, atol=1e-300)


def called(text, call, given, results, folder):
    """What `call` of the C `text` makes of two numbers in each lane, given as two arguments of one, or one of two."""
    width = cache.width()
    door = (
        "void door(const double *given, double *found) {\n"
        f"    lanes a[2], y[{results}];\n"
        "    const lanes *arg[] = {a, a + 1};\n    lanes *res[] = {y};\n"
        f"    memcpy(a, given, sizeof a);\n    {call}\n    memcpy(found, y, sizeof y);\n}}\n"
    )
    (folder / "f.c").write_text(text + "#include <string.h>\n" + door)
    flags = [f"-I{CSRC}", "-fvisibility=default", f"-DWC_LANES={width}", *cache.VECTORS[width]]
    library = ctypes.CDLL(str(compiler.compile_shared([folder / "f.c"], folder / f"f{compiler.SUFFIX}", flags)))
    found = np.empty((results, width))
    library.door(ctypes.c_void_p(given.ctypes.data), ctypes.c_void_p(found.ctypes.data))
    return found


@pytest.mark.parametrize("resting", [(), (0,), (1,), (0, 1)])
def test_what_rests_is_worked_out_once_and_gives_the_same(resting, tmp_path):
    a, b = cs.SX.sym("a"), cs.SX.sym("b")
    f = cs.Function("f", [a, b], [cs.vertcat(*of_each_operation(a, b), 2.5)])
    given = np.random.default_rng(6).uniform(0.1, 3, (2, cache.width()))
    whole, place = called(lanes_source({"f": f}), "lanes_f(arg, res);", given, f.numel_out(0), tmp_path), tmp_path / "in-two"
    place.mkdir()
    text, call = in_two(f, "g", resting), "lanes kept[1 + lanes_g_kept]; lanes_g_once(arg, kept); lanes_g(arg, res, kept);"
    assert np.array_equal(called(text, call, given, f.numel_out(0), place), whole)
    assert ("lanes_g_kept = 0;" in text) == (not resting)
    again = text.rpartition("void lanes_g(")[2]
    assert ("lanes_sin(" in again) == (0 not in resting)


def test_an_operation_without_a_form_is_told():
    a = cs.SX.sym("a", 2)
    f = cs.Function("f", [a], [cs.log1p(a[0])])
    with pytest.raises(BuildError, match="has no form over lanes; simulate this model chair by chair"):
        lanes_source({"f": f})
