"""Text that is Markdown, as pandoc reads it, and becomes LaTeX: code, citations, mathematics, and paragraphs with a heading.

Whatever comes from files goes through `code`, `plain` or `symbols`; all else in a text is ours, and has no other markup.
"""

from __future__ import annotations

import re

from ..latex import GREEK, escaped

SPECIAL = re.compile(r"([\\`*_\[\]<>#|$~^@])")
SYMBOL = re.compile(r"(?<!\w)([A-Za-zλψ])_([A-Za-zλφ]+)(?!\w)")
TOKENS = re.compile(r"\\(?P<letter>.)|`(?P<code>[^`]*)`|\[(?P<cited>@[^\]]*)\]|\$(?P<math>[^$]*)\$|\*\*(?P<bold>[^*]*)\*\*")
KEY = re.compile(r"@(\w+)")


def code(name: str) -> str:
    """A name as it stands in a file."""
    return "`" + "".join(c if c.isprintable() and c != "`" else " " for c in name) + "`"


def plain(text: str) -> str:
    """Other people's words, of which none is markup."""
    return SPECIAL.sub(r"\\\1", " ".join("".join(c if c.isprintable() else " " for c in text).split()))


def symbols(text: str) -> str:
    """The same, with C_λ and the like as mathematics."""
    out, at = [], 0
    for found in SYMBOL.finditer(text):
        out += [plain_part(text[at : found.start()]), f"${_greek(found[1])}_{{{_greek(found[2])}}}$"]
        at = found.end()
    return "".join([*out, plain_part(text[at:])])


def meaning(text: str) -> str:
    """What a record says a value is, without what it adds after a semicolon."""
    return symbols(text.partition(";")[0])


def plain_part(text: str) -> str:
    """As `plain`, of a part of a text, whose blanks at its ends count."""
    return SPECIAL.sub(r"\\\1", "".join(c if c.isprintable() else " " for c in text))


def _greek(letters: str) -> str:
    return "".join(rf"\{GREEK[c]} " if c in GREEK else c for c in letters).strip()


def cite(*keys: str) -> str:
    """Works of references.bib."""
    return "[" + "; ".join(f"@{key}" for key in keys) + "]"


def cited(text: str) -> list[str]:
    """The works that a text cites, each once, in alphabetical order."""
    return sorted({key for found in TOKENS.finditer(text) if found["cited"] for key in KEY.findall(found["cited"])})


def latex(text: str) -> str:
    """The text for LaTeX: what was bold at the beginning of a paragraph is its heading."""
    return "\n\n".join(_paragraph(p) for p in text.split("\n\n"))


def _paragraph(text: str) -> str:
    out, at = [], 0
    for found in TOKENS.finditer(text):
        out += [escaped(text[at : found.start()]), _token(found)]
        at = found.end()
    return "".join([*out, escaped(text[at:])])


def _token(found: re.Match[str]) -> str:
    if found["letter"] is not None:
        return escaped(found["letter"])
    if found["code"] is not None:
        return rf"\texttt{{{escaped(found['code'])}}}"
    if found["cited"] is not None:
        return rf"\cite{{{','.join(KEY.findall(found['cited']))}}}"
    if found["math"] is not None:
        return f"${found['math']}$"
    return rf"\paragraph{{{escaped(found['bold'])}}}"
