"""The table of floors: what its source says itself of ramps, and where a floor is chosen by its name."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app
from wheelchair_fmu.errors import Failure, UsageError
from wheelchair_fmu.studies.ssp import sources
from wheelchair_fmu.surroundings import surfaces
from wheelchair_fmu.surroundings.surfaces import SURFACES, Surface


def test_a_floor_as_hard_as_a_ramp_adds_that_ramp_s_grade():
    for grade, work in surfaces.RAMPS.items():
        assert Surface("a ramp", "", work=work).adds == pytest.approx(grade, abs=2e-4)


def test_chipped_brush_is_a_ramp_of_3_7_percent_as_the_source_says():
    assert SURFACES["wood-chips"].adds == pytest.approx(0.037, abs=5e-4)


def test_the_firmest_carpet_of_one_source_is_about_the_carpet_of_the_other():
    assert SURFACES["carpet-1"].adds == pytest.approx(SURFACES["carpet"].adds, rel=0.15)


def test_no_floor_is_easier_than_a_hard_one_and_pads_make_them_harder():
    factors = {name: each.factor() for name, each in SURFACES.items()}
    assert min(factors.values()) == factors["hard"] == 1
    for bare, padded in (("carpet-1", "carpet-1-pad-1"), ("carpet-2-pad-1", "carpet-2-pad-4"), ("carpet-3", "carpet-3-pad-3")):
        assert factors[bare] < factors[padded]


def test_grass_is_harder_than_carpet_as_who_measured_both_says():
    assert SURFACES["carpet"].adds < SURFACES["grass"].adds < SURFACES["long-grass"].adds


def test_a_chair_that_rolls_hard_itself_feels_a_floor_less():
    """What a floor adds is added, whatever the chair has already."""
    light, heavy = (SURFACES["soil"].factor(f) for f in (0.01, 0.03))
    assert (light - 1) * 0.01 == pytest.approx((heavy - 1) * 0.03)
    with pytest.raises(UsageError, match=r"coefficient of 0 on a hard floor .* give one above 0"):
        SURFACES["soil"].factor(0.0)


def test_every_source_is_in_the_references(request):
    references = (request.config.rootpath / "references.bib").read_text(encoding="utf-8")
    assert all(f"{{{each.source}," in references for each in SURFACES.values())


def test_a_system_s_floor_is_chosen_by_name(tmp_path):
    file = tmp_path / "yard.toml"
    text = 'title = "a yard"\nstop = 5.0\nstep = 0.005\n[Floor]\n"carpet.rolling_factor" = "{}"\n'
    file.write_text(text.format("soil"))
    assert sources.system(str(file)).values["Floor"]["carpet.rolling_factor"] == SURFACES["soil"].factor()
    file.write_text(text.format("soli"))
    with pytest.raises(Failure, match=r"yard.toml \[Floor\]: no surface 'soli'; did you mean 'soil'"):
        sources.system(str(file))


def test_a_set_s_floor_too_and_the_bundled_one_is_carpet(tmp_path):
    file = tmp_path / "lawn.toml"
    file.write_text('title = "t"\nfor = "Floor"\n[values]\n"carpet.rolling_factor" = "wood-fibre"\n')
    for name, expected in ((str(file), "wood-fibre"), ("carpet", "carpet")):
        component, given = sources.parameter_set(name)
        assert component == "Floor"
        assert float(given.settings["carpet.rolling_factor"].value) == pytest.approx(SURFACES[expected].factor(), rel=1e-9)


def test_the_command_asks_for_a_mass_that_a_chair_can_have():
    refused = CliRunner().invoke(app, ["surfaces", "--mass", "-3"])
    assert refused.exit_code == 2 and "a mass of -3 kg is no chair's; give one above 0" in refused.output


def test_the_command_prints_it():
    shown = CliRunner().invoke(app, ["surfaces", "--coefficient", "0.02", "--mass", "100", "--json"])
    told = {row["surface"]: row for row in json.loads(shown.stdout)["surfaces"]}
    assert told["hard"]["force"] == pytest.approx(0.02 * 100 * 9.81)
    assert told["carpet"]["factor"] == pytest.approx(1.59)
    table = CliRunner().invoke(app, ["surfaces"]).stdout
    assert "wood-fibre" in table and "Axelson1999" in table and "1.32 at 2 bar" in table


def test_the_page_has_the_table_as_it_is(request):
    page = (request.config.rootpath / "docs" / "physics.md").read_text(encoding="utf-8")
    for name, each in SURFACES.items():
        assert f"| `{name}` | {each.adds:.4f} | {each.factor():.2f} | {each.what} | {each.source} |" in page
    exponent = {f"{(bar / 4) ** -0.4:.2f}" for bar in (1, 2, 3)}
    assert all(f"{value}" in page for value in exponent)
