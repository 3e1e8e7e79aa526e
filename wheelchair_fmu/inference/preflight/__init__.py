"""Columns that are not what they are called, and clocks that are wrong: looked at before any physics."""
