"""Effects of a user's own: whatever is wrong with their files is one sentence for each, all together."""

from __future__ import annotations

import pytest

from wheelchair_fmu.cli.effects import KINDS, template
from wheelchair_fmu.contracts import CONTRACTS, Subject
from wheelchair_fmu.contracts.own import catalogue, checked, load
from wheelchair_fmu.contracts.record import record
from wheelchair_fmu.errors import EffectError, ModelError
from wheelchair_fmu.model.effects import bundled, defined
from wheelchair_fmu.model.generic import terms

GOOD = template("force", "mine")
UNREAD = "cannot be read as an effect:"
BAD = {  # file -> (text, how its line begins)
    "syntax.py": ("x = 1\nEFFECT = (\n", f"syntax.py line 2: {UNREAD} SyntaxError: '(' was never closed; mend"),
    "raises.py": ("\n\nraise ValueError('two\\nlines')\n", f"raises.py line 3: {UNREAD} ValueError: two lines;"),
    "imports.py": ("import nonsense\n", f"imports.py line 1: {UNREAD} ModuleNotFoundError: No module named"),
    "ends.py": ("import sys\nsys.exit(0)\n", "ends.py line 2: it ends the program instead of defining an effect; leave out"),
    "quits.py": ("raise BaseException\n", f"quits.py line 1: {UNREAD} BaseException; mend this line"),
    "binary.py": (b"\x00\xff\xfe", f"binary.py: {UNREAD}"),
    "none.py": ("", 'none.py: there is no record EFFECT in it; write EFFECT = Effect("none", ...)'),
    "number.py": ("EFFECT = 1\n", 'number.py: EFFECT is of type int; write EFFECT = Effect("number", ...)'),
    "arguments.py": (
        "from wheelchair_fmu.model.stage import Effect\nEFFECT = Effect('arguments')\n",
        f"arguments.py line 2: {UNREAD} TypeError: Effect.__init__() missing 2 required",
    ),
    "twin.py": (GOOD, "twin.py: its effect is called 'mine', which is that of mine.py; call it 'twin' like its file"),
    "other.py": (template("force", "else"), "other.py: its effect is called 'else'; call it 'other' like its file"),
    "gyro_bias.py": (template("force", "gyro_bias"), "gyro_bias.py: there is a bundled effect 'gyro_bias' already; give"),
    "My Drag.py": (template("force", "My Drag"), "My Drag.py: 'My Drag' is no name for an effect; use small letters"),
    "unit.py": (template("force", "unit").replace("N_S_M", "N"), "effect unit, units: its term in F_x comes out in W where N"),
}


def test_every_fault_of_every_file_is_named_at_once(tmp_path):
    (tmp_path / "mine.py").write_text(GOOD, encoding="utf-8")
    for name, (text, _) in BAD.items():
        (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(EffectError) as caught:
        load(tmp_path)
    told = str(caught.value).splitlines()
    assert len(told) == len(BAD)
    for name, (_, line) in BAD.items():
        assert any(line in t for t in told), (name, told)


def test_what_is_good_joins_the_catalogue(tmp_path):
    (tmp_path / "mine.py").write_text(GOOD, encoding="utf-8")
    (tmp_path / "_notes.py").write_text("this is no Python")
    assert set(catalogue(tmp_path)) == {*bundled(), "mine"}


@pytest.mark.parametrize("kind", KINDS)
def test_what_one_begins_with_keeps_every_contract(kind):
    assert list(checked((("mine.py", template(kind, "mine").encode()),))) == ["mine"]


def test_the_terms_that_a_diagnosis_may_propose_keep_every_contract():
    """All in one model, which takes a tenth of the time."""
    files = tuple((f"proposed_{i}.py", term.file(f"proposed_{i}").encode()) for i, term in enumerate(terms().values()))
    proposed = defined(files)
    assert len(proposed) == len(terms())
    assert [breach for effect in proposed.values() for breach in record(effect)] == []
    subject = Subject.of(proposed.values())
    assert [breach for contract in CONTRACTS for breach in contract(subject)] == []


def test_a_folder_without_effects_is_no_answer(tmp_path):
    with pytest.raises(ModelError, match="no effect file in it; `wheelchair effects new ID -o"):
        catalogue(tmp_path)


def test_an_interrupt_is_none_of_a_file_s_faults():
    with pytest.raises(KeyboardInterrupt):
        checked((("mine.py", b"raise KeyboardInterrupt\n"),))
