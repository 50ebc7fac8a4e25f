"""What a page has sent: one JSON object, with texts by their names."""

from collections.abc import Mapping
from typing import Any

from starlette.requests import Request

from trialid.errors import PipelineError


async def sent_object(request: Request) -> dict[str, Any] | None:
    """What was sent, where it is one object."""
    try:
        asked = await request.json()
    except (ValueError, RecursionError):  # a thousand brackets, one in another
        return None
    return asked if isinstance(asked, dict) else None


def text_in(asked: Mapping[str, Any], key: str) -> str:
    """A text of what was sent.

    Raises
    ------
    PipelineError
        There is none of that name.
    """
    found = asked.get(key)
    if not isinstance(found, str):
        raise PipelineError(f"{key}: expected text")
    return found
