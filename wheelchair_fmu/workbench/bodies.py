"""JSON that comes in, with limits, and JSON that goes out, of whatever a campaign.toml can hold."""

from __future__ import annotations

import json
import math
from datetime import date, datetime, time
from typing import Any
from unicodedata import category

from starlette.requests import Request
from starlette.responses import JSONResponse

from ..errors import UsageError

DEEPEST = 20  # objects and lists within each other
MOST_VALUES = 50_000


class Json(JSONResponse):
    """JSON of plain data, and of what TOML has besides: times, and numbers that are not finite, as text."""

    def render(self, content: Any) -> bytes:
        return json.dumps(_plain(content), allow_nan=False, separators=(",", ":")).encode()


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    if isinstance(value, date | datetime | time):
        return value.isoformat()
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


async def json_object(request: Request) -> dict[str, Any]:
    """The JSON object of a request. Raises UsageError for anything else, and for what is too deep, too much or no text."""
    body = await request.body()
    try:
        content = json.loads(body)
    except RecursionError:
        raise too_deep("the request") from None
    except ValueError:
        raise UsageError("the request holds no JSON") from None
    if not isinstance(content, dict):
        raise UsageError("the request holds no JSON object")
    refuse_unusual(content, "the request")
    return content


def json_texts(text: str, field: str) -> list[str]:
    """A JSON list of texts in a field of a form. Raises UsageError for anything else."""
    try:
        content = json.loads(text)
    except (RecursionError, ValueError):
        raise UsageError(f"the field {field!r} holds no JSON") from None
    if not isinstance(content, list) or not all(isinstance(item, str) for item in content):
        raise UsageError(f"the field {field!r} holds no list of names")
    refuse_unusual(content, f"the field {field!r}")
    return content


def refuse_unusual(content: Any, what: str) -> None:
    """Raises UsageError for data that is too deep or too much, and for characters that belong in no text.

    Looks at one level after the other, because what is deep must not be walked by recursion.
    """
    level, seen = [content], 0
    for _ in range(DEEPEST):
        seen += len(level)
        if seen > MOST_VALUES:
            raise UsageError(f"{what} holds more than {MOST_VALUES} values; send less")
        texts = [value for value in level if isinstance(value, str)]
        texts += [key for value in level if isinstance(value, dict) for key in value]
        if odd := next((t for t in texts if any(category(c) in ("Cc", "Cs") and c not in "\n\r\t" for c in t)), None):
            raise UsageError(f"{odd[:40]!r} in {what} has characters that cannot be printed; take them out")
        level = [
            inner
            for value in level
            if isinstance(value, dict | list)
            for inner in (value.values() if isinstance(value, dict) else value)
        ]
        if not level:
            return
    raise too_deep(what)


def too_deep(what: str) -> UsageError:
    return UsageError(f"{what} is nested more than {DEEPEST} deep; write it flatter")


def number(asked: dict[str, Any], key: str) -> float:
    """A finite number. Raises UsageError."""
    value = asked.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e300:
        raise UsageError(f"{key} = {str(value)[:40]!r} is not a number")
    return float(value)
