"""Systems of FMUs by the SSP standard: a chair with the person who pushes it and the floor under it.

::

    ssp/systems/slalom.toml ── build ──> Slalom.ssp ── read, check ──> Archive ── run ──> Trace
"""
