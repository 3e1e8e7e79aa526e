"""The chair with any effects of the catalogue, compiled once and fitted when asked for."""
