"""Put the version of the commit at hand, by its tag, into the sources in a folder:  python .ci/version.py FOLDER

A tag v1.2.3 is version 1.2.3, of which CHANGELOG.md must have a section. A commit without a tag is no release: it gets the
number of commits that led to it, as in 1.2.3.dev456, where 1.2.3 is what wheelchair_fmu/__init__.py says, or what follows the
last tag where that would not be above it: after v1.2.3 it is 1.2.4.dev456.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from packaging.version import InvalidVersion, Version

PLACES = {"wheelchair_fmu/__init__.py": r'(?m)^__version__ = "(.*)"$', "CITATION.cff": r"(?m)^version: (.*)$"}


def version(checkout: Path, written: str) -> str:
    """Of the commit at hand, where `written` is what its sources say. Raises SystemExit for a tag that has no section."""
    tags = _tags(checkout, "--points-at")
    if not tags:
        return development(written, _git(checkout, "rev-list", "--count", "HEAD"), _tags(checkout, "--merged"))
    if len(tags) > 1:
        raise SystemExit(f"this commit has the tags {', '.join(tags)}; a release has one")
    found = tags[0].removeprefix("v")
    if not re.search(rf"(?m)^## \[{re.escape(found)}\] - \d{{4}}-\d\d-\d\d$", (checkout / "CHANGELOG.md").read_text("utf-8")):
        raise SystemExit(f"CHANGELOG.md: no section of {found}; rename Unreleased to [{found}] - and its date, and tag that")
    return found


def development(written: str, count: str, tags: list[str]) -> str:
    """Of a commit without a tag that so many commits led to, some of them with these tags: above each of them."""
    last = max(filter(None, map(_parsed, tags)), default=None)
    found = f"{written}.dev{count}"
    return found if last is None or Version(found) > last else f"{_following(last)}.dev{count}"


def _following(last: Version) -> str:
    """The least version that a release after this one may have."""
    *front, final = last.release
    if last.pre:
        kind, number = last.pre
        return f"{'.'.join(map(str, last.release))}{kind}{number + 1}"
    return ".".join(map(str, (*front, final + 1)))


def _parsed(tag: str) -> Version | None:
    try:
        return Version(tag)
    except InvalidVersion:
        return None


def _tags(checkout: Path, which: str) -> list[str]:
    """Tags of versions, at the commit at hand or at those that led to it."""
    return [tag for tag in _git(checkout, "tag", which, "HEAD").split() if re.fullmatch(r"v\d+(\.\d+)*\S*", tag)]


def main(folder: Path, checkout: Path = Path()) -> str:
    texts = {place: (folder / place).read_text("utf-8") for place in PLACES}
    at = {place: re.search(pattern, texts[place]) for place, pattern in PLACES.items()}
    found = version(checkout, at["wheelchair_fmu/__init__.py"][1])
    for place, text in texts.items():
        start, end = at[place].span(1)
        (folder / place).write_text(text[:start] + found + text[end:], "utf-8")
    return found


def _git(checkout: Path, *words: str) -> str:
    return subprocess.run(["git", *words], cwd=checkout, check=True, capture_output=True, text=True).stdout.strip()


if __name__ == "__main__":
    print(main(Path(sys.argv[1])))
