"""A manual wheelchair on real tyres, as an FMU, and a loop that finds what its model misses."""

__version__ = "0.1.0"
