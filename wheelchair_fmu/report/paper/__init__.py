"""What a paper's supplement needs of a diagnosis.

::

    Campaign, Variant, diagnosis ── case ──┬── methods: measurements, inferring, outcome ── markup
                                           ├── tables, left_out, fingerprints
                                           └── replay ── figures
                                                      all of them ── folder
"""
