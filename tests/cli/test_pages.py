"""The pages that show commands: each command does what is shown below it."""

from __future__ import annotations

import pytest

from tests.pages import ROOT, agrees, shown_commands, told_by

FOR_READERS = (  # commands about what only a reader has, or that wait for a person
    "recordings/",
    "wheelchair sync",
    "my-fleet/",
    "theirs.toml",
    "wheelchair workbench",
)
PAGES = (
    "../README.md",
    "first-steps.md",
    "commands.md",
    "handling.md",
    "tyres.md",
    "supplement.md",
    "sweep.md",
    "ssp.md",
    "verdicts.md",
)
NOT_HERE = {  # other commands that cannot be tried, and why
    "tyres.md": ("sed '1s", "bicycle.csv"),  # data of others
    "sweep.md": ("dask ", "PLAN.toml"),  # a cluster, a plan of the reader's
    "ssp.md": ("broken.ssp",),  # a system that the reader has damaged
    "verdicts.md": ("benchmarks.diagnosis", "benchmarks.improve"),  # take hours
}


def tried(page: str) -> list[tuple[str, str]]:
    left = (*FOR_READERS, *NOT_HERE.get(page, ()))
    return [(command, shown) for command, shown in shown_commands(page) if not any(word in command for word in left)]


def test_what_a_page_shows_is_held_to_the_order_and_the_last_digit():
    told = "radius   3.3019 m\npush needed   10.7330 N\n"
    assert agrees("radius 3.302 m\n...\npush ...\n", told) == []
    assert agrees("push needed 10.7330 N\nradius 3.3019 m", told) == ["radius 3.3019 m"]
    assert agrees("radius 3.45 m", told) and agrees("radius 3.3019 km", told) and agrees("radius -3.3019 m", told)


@pytest.mark.nightly
@pytest.mark.parametrize("page", PAGES)
def test_a_page_does_what_it_shows(page, tmp_path, monkeypatch):
    follow(page, tmp_path, monkeypatch)


def follow(page: str, folder, monkeypatch) -> None:
    monkeypatch.chdir(folder)
    (folder / "examples").symlink_to(ROOT / "examples")
    commands = tried(page)
    assert commands
    wrong = []
    for command, shown in commands:
        told = told_by(command, folder)
        wrong += [f"$ {command}\n  shown: {line}\n" for line in agrees(shown, told)]
    assert not wrong, "".join(wrong)
