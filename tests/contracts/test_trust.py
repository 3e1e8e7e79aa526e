"""Programs in other people's files are run once this user has said so, and are then held to the contracts."""

from __future__ import annotations

import pytest

from wheelchair_fmu.cli.effects import template
from wheelchair_fmu.contracts.own import checked, text_of, untrusted, variant_in
from wheelchair_fmu.contracts.trust import is_trusted, remember
from wheelchair_fmu.errors import EffectError, Failure
from wheelchair_fmu.model.effects import bundled, defined
from wheelchair_fmu.model.variant import Variant, programs_in, variant_text

GOOD = template("force", "mine")
BAD = GOOD.replace("N_S_M", "N")


@pytest.fixture(autouse=True)
def nothing_trusted(tmp_path, monkeypatch):
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))


def chair(source: str) -> Variant:
    return Variant(catalogue={**bundled(), **defined((("mine.py", source),))}).with_effects(["mine"])


def written(folder, source: str):
    """A variant that comes from elsewhere."""
    file = folder / "better.toml"
    file.write_text(variant_text(chair(source)), encoding="utf-8")
    return file


def test_a_variant_from_elsewhere_is_refused_in_one_sentence_until_it_is_trusted(tmp_path):
    file = written(tmp_path, GOOD)
    with pytest.raises(Failure) as told:
        variant_in(file)
    assert str(told.value).startswith(f"{file} carries the effect mine, a program that runs with your rights; read it there")
    assert list(untrusted(file)) == ["effect mine"]
    remember(programs_in(file).values())
    assert variant_in(file).effects == ("mine",) and untrusted(file) == {}


def test_trust_is_in_the_text_and_not_in_the_file(tmp_path):
    remember(programs_in(written(tmp_path, GOOD)).values())
    with pytest.raises(Failure, match="a program that runs with your rights"):
        variant_in(written(tmp_path, f"{GOOD}# another\n"))


def test_who_reads_it_may_say_so_for_this_once(tmp_path):
    file = written(tmp_path, GOOD)
    assert variant_in(file, trust=True).effects == ("mine",)
    assert list(untrusted(file)) == ["effect mine"]


def test_what_was_written_here_has_run_here(tmp_path):
    (tmp_path / "better.toml").write_text(text_of(chair(GOOD)), encoding="utf-8")
    assert variant_in(tmp_path / "better.toml").effects == ("mine",)
    assert is_trusted(chair(GOOD).active()[0].program)


def test_trusted_programs_keep_the_contracts_too(tmp_path):
    with pytest.raises(EffectError, match="effect mine, units: its term in F_x comes out in W where N belongs"):
        variant_in(written(tmp_path, BAD), trust=True)


def test_a_fault_of_the_program_is_told_with_the_variant_s_name(tmp_path):
    file = written(tmp_path, f"{GOOD}\n")
    broken = f"{GOOD}raise ValueError('no')\n"
    digests = [chair(f"{GOOD}\n").active()[0].program.sha256, type(programs_in(file)["effect mine"])("", broken).sha256]
    text = file.read_text(encoding="utf-8").replace(f"{GOOD}\n", broken).replace(*digests)
    file.write_text(text, encoding="utf-8")
    with pytest.raises(EffectError, match=r"better.toml/mine.py line \d+: cannot be read as an effect: ValueError: no"):
        variant_in(file, trust=True)


def test_the_folder_of_effects_needs_no_trust_in_the_file(tmp_path):
    known = {**bundled(), **checked((("mine.py", GOOD),))}
    assert variant_in(written(tmp_path, GOOD), known).effects == ("mine",)
