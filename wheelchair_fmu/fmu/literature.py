"""The sources that variables name, from references.bib, as a list with links."""

from __future__ import annotations

import re
from html import escape

from ..resources import REFERENCES

ALSO = {"Doria": "Doria2016", "Pacejka": "Pacejka2012"}  # as sources call them for short


def entries() -> dict[str, dict[str, str]]:
    """The fields of each work by its key."""
    text = REFERENCES.read_text(encoding="utf-8")
    found = re.findall(r"^@\w+\{(\w+),\n(.*?)^\}", text, flags=re.MULTILINE | re.DOTALL)
    return {
        key: {
            name: " ".join(value.replace("{", "").replace("}", "").split())
            for name, value in re.findall(r"^\s*(\w+)\s*=\s*\{(.*?)\},?$", body, flags=re.MULTILINE | re.DOTALL)
        }
        for key, body in found
    }


def keys_in(sources: list[str], known: dict[str, dict[str, str]]) -> list[str]:
    """The works that these sources name, in alphabetical order."""
    words = {word for source in sources for word in re.findall(r"\w+", source)}
    return sorted({ALSO.get(word, word) for word in words} & known.keys())


def linked(source: str, known: dict[str, dict[str, str]]) -> str:
    """A source as HTML, with links from the works that it names to the list."""

    def link(match: re.Match[str]) -> str:
        key = ALSO.get(match[0], match[0])
        return f'<a href="#{key}">{match[0]}</a>' if key in known else match[0]

    return re.sub(r"\w+", link, escape(source, quote=False))


def listed(keys: list[str], known: dict[str, dict[str, str]]) -> str:
    """The list that the links lead to."""
    return "\n".join(_item(key, known[key]) for key in keys)


def _item(key: str, work: dict[str, str]) -> str:
    place = work.get("journal") or work.get("booktitle") or work.get("publisher") or work.get("institution", "")
    numbers = ", ".join(work[name].replace("--", "–") for name in ("volume", "pages") if name in work)
    address = f"https://doi.org/{work['doi']}" if "doi" in work else work.get("url", "")
    text = f"{work.get('author', '')} ({work.get('year', '')}): {work.get('title', '')}. {place} {numbers}".strip()
    link = f' <a href="{escape(address)}">{escape(address)}</a>' if address else ""
    return f'<li id="{key}"><b>{key}</b> {escape(text)}{link}</li>'
