"""docs/your-own-format.md: its two files do what it says."""

from __future__ import annotations

from tests.pages import its_test_passes


def test_the_page_s_format_passes_the_page_s_test(tmp_path):
    its_test_passes("your-own-format.md", tmp_path)
