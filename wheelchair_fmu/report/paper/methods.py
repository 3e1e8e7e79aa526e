"""The methods of a paper, with every number filled in: only what is true of this case."""

from __future__ import annotations

from ... import __version__
from ...provenance import code_fingerprint
from . import inferring, measurements, outcome
from .case import Case
from .markup import cite, code, latex

SHORT = 12  # digits of a fingerprint in a text
SECTIONS = (
    ("Chair.", measurements.chair),
    ("Runs.", measurements.runs),
    ("Sensors.", measurements.sensors),
    ("Model.", inferring.model),
    ("Estimation.", inferring.fitting),
    ("Uncertainty.", inferring.errors),
    ("Choice of effects.", inferring.search),
    ("Estimates.", outcome.estimates),
    ("Errors.", outcome.fall),
    ("Verdict.", outcome.verdict),
    ("Unrecorded forces.", outcome.disturbance),
)


def methods(case: Case, remarks: int) -> str:
    """The text in Markdown, as pandoc reads it with references.bib; `remarks` is how many rows left_out.csv has."""
    found = [(heading, section(case)) for heading, section in SECTIONS]
    found.append(("Software and data.", _software(case, remarks)))
    return "\n\n".join(f"**{heading}** {text}" for heading, text in found if text) + "\n"


def markdown(text: str) -> str:
    """methods.md: the text, below what pandoc needs to find its references."""
    return f"---\nbibliography: references.bib\n---\n\n# Methods\n\n{text}"


def tex(text: str) -> str:
    """methods.tex: the text, to be put into a document by \\input."""
    return "% \\input this; its works are in references.bib.\n" + latex(text)


def _software(case: Case, remarks: int) -> str:
    made = case.told["made_by"]
    told = [
        f"The diagnosis was made by wheelchair-fmu {made['version']} {cite('wheelchairfmu')} (code "
        f"{code(made['code'][:SHORT])}) from data with the fingerprint {code(case.campaign.fingerprint[:SHORT])}."
    ]
    if made["code"] != code_fingerprint():
        told.append(f"This supplement was made by version {__version__} (code {code(code_fingerprint()[:SHORT])}).")
    told.append(f"The fingerprints in full, of each file and of the libraries, are in {code('fingerprints.json')}.")
    if remarks:
        told.append(f"What was left out or found odd in the data is in {code('left_out.csv')}.")
    return " ".join(told)
