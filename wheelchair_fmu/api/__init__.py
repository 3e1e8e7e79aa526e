"""The library as a researcher scripts it: `import wheelchair_fmu as wc` has these names, and they are kept (see CHANGELOG.md).

::

    read ──> Campaign ── compare ──> Comparison
                 └────── diagnose ──> Diagnosis ── add ──> Variant ──> simulate, linearize, build
    Tyre.fit ── variant ──────────────────────────────────────┘

Everything is in SI units and the axes of SAE J670: x forward, y to the right, z down, yaw positive to the right.
"""
