"""docs/your-own-channel.md: its two files do what it says."""

from __future__ import annotations

import pytest

from tests.pages import attempt, its_test_passes, run
from wheelchair_fmu.campaign.channels import CHANNELS, INPUTS, SOURCES
from wheelchair_fmu.model.readings import READINGS, TAKEN

PAGE = "your-own-channel.md"


def test_the_page_s_channel_passes_the_page_s_test(tmp_path):
    its_test_passes(PAGE, tmp_path)


@pytest.mark.nightly
def test_the_fmu_has_it(tmp_path):
    its_test_passes(PAGE, tmp_path)
    assert "out/slalom.csv" in run(tmp_path, "-m", "wheelchair_fmu", "simulate", "slalom")
    header = (tmp_path / "out" / "slalom.csv").read_text(encoding="utf-8").partition("\n")[0]
    assert "sensor.ground_speed [m/s]" in header


def test_names_of_a_campaign_s_own_channels_and_inputs_are_refused_in_a_sentence(tmp_path):
    channels = tmp_path / "config" / "channels"
    channels.mkdir(parents=True)
    (channels / "F_rl.py").write_text("")
    (channels / "yaw_rate.py").write_text("")
    done = attempt(tmp_path, "-m", "wheelchair_fmu", "check", "my-campaign")
    says = "is the name of a channel or an input that there is already; give the file and its record another name"
    assert done.returncode == 1 and [line.partition(": ")[2] for line in done.stderr.splitlines()] == [
        f"'F_rl' {says}",
        f"'yaw_rate' {says}",
    ]


def test_all_names_of_a_campaign_are_taken():
    own = {reading.name for reading in READINGS}
    names = {channel.name for channel in (*CHANNELS, *INPUTS, *SOURCES)} - own
    assert {name for name in names if "." not in name} | {"time", "wheel_speed"} == TAKEN
