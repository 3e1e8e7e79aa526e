"""The page of every signal, before anything is known of some."""

from __future__ import annotations

import numpy as np

from wheelchair_fmu.campaign import CHANNELS
from wheelchair_fmu.report.preview import ABREAST, LEGEND, NOTHING, Run, Signal, _called, figures, page


def test_what_is_wrong_alike_in_many_places_is_said_once():
    faults = [
        ("error", "run a.csv line 1", "no push force F_rl; add a column 'F_rl [N]'"),
        ("error", "run b.csv line 1", "no push force F_rl; add a column 'F_rl [N]'"),
        ("warning", "run a: 1.csv", "no u0; write u0 = ..."),
        ("warning", "run b.csv", "<no> role; give one"),
    ]
    html = page("campaign", [], faults)
    assert html.count("no push force") == 1 and "in 2 places" in html and "run a.csv line 1; run b.csv line 1" in html
    assert "warning: run a: 1.csv: no u0; write u0 = ..." in html
    assert "warning: run b.csv: &lt;no&gt; role; give one" in html


def test_a_page_without_signals_says_what_comes_first():
    html = page("campaign", [], [])
    assert NOTHING in html and LEGEND not in html


def test_a_channel_has_one_scale_in_all_pictures():
    time = np.linspace(0, 1, 50)
    runs = [
        Run(f"run {i}", "fit", {"u": Signal("u", "m/s", "", time, (i + 1) * np.sin(time), np.empty(0))})
        for i in range(ABREAST + 2)
    ]
    scales = {figure.axes[0].get_ylim() for figure in figures(runs)}
    assert len(scales) == 1
    low, high = scales.pop()
    assert low < 0 and high > (ABREAST + 2) * np.sin(1)


def test_no_two_channels_have_one_name():
    assert len({_called(c.name) for c in CHANNELS}) == len(CHANNELS)
