"""Texts as TOML writes them, for files that are made."""

import json
from collections.abc import Sequence


def quote(text: str) -> str:
    r"""A TOML string on one line: what JSON writes, but with no pairs of surrogates, and no DEL.

    >>> print(quote('a "b"\n'), quote("bell\x07"), quote("\x7f"))
    "a \"b\"\n" "bell\u0007" "\u007f"
    """
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def array(entries: Sequence[str]) -> str:
    """A TOML array of strings on one line.

    >>> print(array(["p", "phi"]))
    ["p", "phi"]
    """
    return f"[{', '.join(map(quote, entries))}]"
