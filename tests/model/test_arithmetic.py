"""Typed expressions: whatever the text, it is refused in a sentence or means what arithmetic says, and no text is run."""

from __future__ import annotations

import ast
import math
import operator
from inspect import signature

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from wheelchair_fmu.engine.cache import effect_key
from wheelchair_fmu.errors import UsageError
from wheelchair_fmu.model.arithmetic import DEEPEST, LONGEST, MOST_NODES
from wheelchair_fmu.model.dimensions import unit_of_q
from wheelchair_fmu.model.effects import defined
from wheelchair_fmu.model.expression import canonical, effect_file, law
from wheelchair_fmu.quantities import M_S, N

ESCAPE = '-q * u # " + str(__import__("pathlib").Path("escaped").write_text("")) + " end'


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (ESCAPE, "'#' at place 8 is not allowed"),
        ("-q * u + len('a')", '"\'" at place 14'),
        ("q * u \\", r"'\\\\' at place 7"),
        ("q *\nu", r"'\\n' at place 4"),
        ("q * u\0", r"'\\x00' at place 6"),
        ("ｑ * u", "'ｑ' at place 1"),
        ("q.real", "q.real has a point in it"),
        ("q * __import__", "'__import__' is no name of a quantity"),
        ("(lambda q)", "is no expression"),
        ("q if u else v", "IfExp is not allowed"),
        ("[q]", "List is not allowed"),
        ("q, u", "has a comma where none belongs"),
        ("sin(*u)", "Starred is not allowed"),
        ("sin(x=u)", "'=' at place 6"),
        ("open(u)", "no function 'open'"),
        ("(q * u)(3)", "no function 'q \\* u'"),
        ("sin * q", "sin is a function; write sin"),
        ("sin(u, v)", "sin takes 1 value, not 2"),
        ("grip(u, v)", "grip takes 3 values, not 2"),
        ("vertcat()", "vertcat takes 1 to 16 values, not 0"),
        ("q * True", "'True' is no number"),
        ("q * 1e999", "'inf' is no number"),
        ("q * 3 [Ym^9.km^9.km]", "not made of|unknown|no number"),
        ("q * " + "9" * 1000, "is no number to count with"),
        ("q * 9**9**9", "an exponent is one number between"),
        ("q ** 1000", "an exponent is one number between"),
        ("q * u ** vertcat(1, 2)", "an exponent is one number between"),
        ("q * (1e200 * 1e200)", "is no finite number"),
        ("q * (-8) ** 0.5", "is no finite number"),
        ("q * (1 / 0)", "is no finite number"),
        ("F_t[99] * q", "a component is asked for by its number"),
        ("F_t[q] * q", "a component is asked for by its number"),
        ("(1 + 2)[0] * q", "a plain number has no components"),
        ("q * 007", "leading zeros"),
        ("q * 1j", "'1' at place 5"),
        ("-" * (LONGEST - 1) + "q", "goes on more than"),
        ("(" * 500 + "q" + ")" * 500, "too many nested parentheses|goes on more than"),
        ("+".join(["q"] * (DEEPEST + 1)), "goes on more than"),
        ("sum1(vertcat(" + ",".join(["vertcat(" + ",".join(["q*u"] * 16) + ")"] * 16) + "))", f"more than {MOST_NODES}"),
        ("q" + "+q" * 20_000, "is too long"),
        ("", "is no expression"),
    ],
)
def test_what_is_no_arithmetic_is_refused_in_one_sentence(text, why):
    with pytest.raises(UsageError, match=why) as refused:
        law(text)
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 500


@pytest.mark.parametrize("text", ["q * 0 / 0", "q / 0", "q * u * sqrt(-1 - u * u)", "q * 1e200 * 1e200"])
def test_what_has_no_finite_value_has_no_unit(text):
    with pytest.raises(UsageError, match="has no finite value"):
        unit_of_q(text, "F_x")


@pytest.mark.parametrize(
    ("text", "values", "expected"),
    [
        ("-q * u", {"q": 2, "u": 3}, -6.0),
        ("q * u ** 2 / 4", {"q": 2.0, "u": 3.0}, 4.5),
        ("-q ** 2", {"q": 3.0}, -9.0),
        ("2 ** 3 ** 2 * q", {"q": 1.0}, 512.0),
        ("q / u", {"q": 1.0, "u": 0.0}, math.inf),
        ("q ** u", {"q": 4.0, "u": 0.5}, 2.0),
        ("fmax(0, fmin(u, 1.5)) * q", {"q": 2.0, "u": 9.0}, 3.0),
        ("max(0, min(abs(u), 1.5)) * q", {"q": 2.0, "u": -9.0}, 3.0),
        ("F_t[1] * q", {"q": 2.0, "F_t": (5.0, 7.0)}, 14.0),
        ("  q * .5e1", {"q": 2.0}, 10.0),
        ("q * 36 [km/h] + 10 [m/s]", {"q": 2.0}, 30.0),
    ],
)
def test_the_value_is_that_of_the_arithmetic(text, values, expected):
    assert law(text)(**values) == pytest.approx(expected)


def test_a_law_reads_what_it_names_in_the_order_of_its_text():
    assert list(signature(law("sin(delta) * q + q * u")).parameters) == ["delta", "q", "u"]
    assert law("u - q")(5.0, 3.0) == 2.0
    with pytest.raises(TypeError):
        law("u - q")(5.0)


def effect_of(text: str, file: str = "my_drag.py"):
    source = effect_file("my_drag", "a drag", "F_x", N, text, size=1, lower=0, upper=2)
    return defined(((file, source.encode()),))["my_drag"]


def test_kernels_are_known_by_the_expression_however_it_is_spaced():
    assert effect_key(effect_of("-q*u")) == effect_key(effect_of("-q  * (u)", "elsewhere/my_drag.py"))
    assert effect_key(effect_of("-q*u")) != effect_key(effect_of("-q*v"))
    assert effect_key(effect_of("-q*u/3[km/h]")) != effect_key(effect_of("-q*u/3[m/s]"))
    assert effect_key(effect_of("-q*u/3.6[km/h]")) == effect_key(effect_of("-q*u/1[m/s]"))


@given(st.text(st.characters(exclude_categories=("Cc", "Cs", "Cn", "Co", "Cf", "Zl", "Zp", "Zs")), max_size=60))
@example('"""')
@example('\\"; import os #')
@example("{id} {0} %s")
def test_words_in_an_effect_file_stay_words(words):
    source = effect_file("my_drag", words, "F_x", M_S, "-q * tanh(u / 3 [km/h])", size=1, lower=0, upper=2, source=words)
    calls = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call)]
    assert len(calls) == 6  # Unit, DisplayUnit, Parameter, Effect, adds, law
    effect = defined((("my_drag.py", source.encode()),))["my_drag"]
    assert (effect.title, effect.parameters[0].source) == (words, words)
    assert effect.contributions[0].law(q=1.0, u=3 / 3.6) == pytest.approx(-math.tanh(1))


def test_an_effect_file_takes_no_expression_that_a_law_does_not(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError):
        effect_of(ESCAPE)
    with pytest.raises(UsageError, match="cannot be printed"):
        effect_file("my_drag", "two\nlines", "F_x", N, "-q * u", size=1, lower=0, upper=2)
    assert not list(tmp_path.iterdir())


def test_effect_files_of_earlier_versions_still_define_their_effect():
    text = (
        '"""a drag:  F_x += -q * u"""\n\nfrom wheelchair_fmu.model.expression import law\n'
        "from wheelchair_fmu.model.stage import Effect, adds\nfrom wheelchair_fmu.quantities import Parameter, Unit\n\n"
        "UNIT = Unit(name='N.s/m', kg=1, m=0, s=-1, rad=0, display=(), quantity='LinearDamping')\n"
        'Q = Parameter("q", UNIT, "size of: a drag", off=0.0, smallest_interesting=0.5, lower=0.0, upper=50.0,\n'
        '              source="own")\n\nEFFECT = Effect(\n    "old",\n    "a drag",\n    parameters=(Q,),\n'
        '    contributions=(adds("F_x", law("-q * u")),),\n)\n'
    )
    assert defined((("old.py", text.encode()),))["old"].contributions[0].law(q=2.0, u=3.0) == -6.0


# -- any text -----------------------------------------------------------------------------------------------

NAMES = {"q": 1.75, "u": -0.625, "v": 0.375}
OPERATORS = {"+": operator.add, "-": operator.sub, "*": operator.mul}


def term(inner: st.SearchStrategy[tuple[str, float]]) -> st.SearchStrategy[tuple[str, float]]:
    """An expression with its value, both made side by side."""

    def paired(op: str, a: tuple[str, float], b: tuple[str, float]) -> tuple[str, float]:
        return f"({a[0]}) {op} ({b[0]})", OPERATORS[op](a[1], b[1])

    called = st.sampled_from(["sin", "cos", "tanh", "atan"])
    return st.one_of(
        st.builds(paired, st.sampled_from(list(OPERATORS)), inner, inner),
        st.builds(lambda f, a: (f"{f}({a[0]})", getattr(math, f)(a[1])), called, inner),
        st.builds(lambda a: (f"-({a[0]})", -a[1]), inner),
        st.builds(lambda a, n: (f"({a[0]}) ** {n}", a[1] ** n), inner, st.integers(1, 3)),
    )


LEAVES = st.one_of(
    st.sampled_from([(n, v) for n, v in NAMES.items()]),
    st.floats(0, 10).map(lambda x: (repr(x), x)),
    st.integers(0, 10).map(lambda i: (str(i), float(i))),
)


@given(st.recursive(LEAVES, term, max_leaves=12))
def test_any_arithmetic_has_the_value_that_it_has_elsewhere(pair):
    text, expected = pair
    if not math.isfinite(expected) or abs(expected) > 1e12:
        return
    found = law(text)
    values = {name: NAMES[name] for name in signature(found).parameters}
    assert found(**values) == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert law(canonical(text))(**values) == pytest.approx(expected, rel=1e-9, abs=1e-9)


PIECES = [
    "q",
    "u",
    "sin",
    "(",
    ")",
    "[",
    "]",
    "**",
    "*",
    "/",
    "-",
    "+",
    "9",
    "1e9",
    ".",
    ",",
    "#",
    '"',
    "'",
    "\\",
    "\n",
    "lambda ",
    ":",
    "=",
    "__class__",
    " if ",
    "km/h",
    "{",
    "}",
    "@",
    "\0",
    "é",
]


@given(st.one_of(st.text(max_size=80), st.lists(st.sampled_from(PIECES), max_size=25).map("".join)))
def test_any_text_is_refused_or_is_a_law_that_reads_the_same_when_written_again(text):
    try:
        found = law(text)
    except UsageError as error:
        assert "Traceback" not in str(error)
        return
    again = law(canonical(text))
    assert (again.expression, again.arguments) == (found.expression, found.arguments)
