"""A TOML array of strings as text: a name more or a name less, everything else as it was written.

`without_name` undoes `with_name` byte for byte: a new name goes to the end, in a line of its own
where the array has lines, and a trailing comma stays or stays away.
"""

import re
import tomllib
from collections.abc import Sequence
from typing import Final, NamedTuple

_TOKENS: Final = re.compile(
    r'(?P<name>"""(?:\\.|[^\\])*?"""|\'\'\'.*?\'\'\'|"(?:\\.|[^"\\])*"|\'[^\']*\')|(?P<open>["\'].*)'
    r"|(?P<comment>#[^\r\n]*)|(?P<comma>,)|(?P<space>[ \t\r\n]+)|(?P<other>.)",
    re.DOTALL,
)


class _Token(NamedTuple):
    kind: str
    text: str

    @property
    def breaks(self) -> bool:
        """Whether a new line begins in it."""
        return self.kind == "space" and "\n" in self.text


def with_name(array: str, name: str) -> str:
    r"""The array with a name at its end.

    >>> with_name('["a", "b"]', "c")
    '["a", "b", "c"]'
    >>> with_name('[\n  "a",  # first\n]', "b")
    '[\n  "a",  # first\n  "b",\n]'
    """
    tokens = _tokens(array)
    places = _places(tokens)
    if not places:
        return "".join([*_texts(tokens[:-1]), _quoted(name, '"'), "]"])
    last = places[-1]
    comma = _next(tokens, last, "comma")
    at = (last if comma is None else comma) + 1
    rest = _comment_beside(tokens, at)
    at = at if rest is None else rest + 1
    new = _break(tokens, last) + _quoted(name, tokens[last].text[0])
    head = [*_texts(tokens[: last + 1]), "" if comma else ",", *_texts(tokens[last + 1 : at])]
    return "".join([*head, new, "," if comma else "", *_texts(tokens[at:])])


def without_name(array: str, name: str) -> str:
    r"""The array without a name; a comment goes with it only from a line that is all its own.

    >>> without_name('["a", "b", "c"]', "b")
    '["a", "c"]'
    >>> without_name('[\n  "a",\n  "b",  # new\n]', "b")
    '[\n  "a",\n]'
    """
    tokens = _tokens(array)
    places = _places(tokens)
    at = next(i for i in places if _meaning(tokens[i].text) == name)
    comma = _next(tokens, at, "comma")
    first = at == places[0]
    gone = {at} | ({comma} if comma else set())
    if comma is None and not first:
        gone |= {_before(tokens, at)}
    end = at if comma is None else comma
    only = len(places) == 1 and tokens[end + 1].text == "]"  # as put into an empty array
    alone = tokens[at - 1].breaks and not only and not _shares_line(tokens, end)
    if alone:
        beside = _comment_beside(tokens, end + 1)
        gone |= set(range(end + 1, beside + 1)) if beside else set()
    kept = ["" if i in gone else t.text for i, t in enumerate(tokens)]
    if alone:
        ends = tokens[at - 2].kind == "comment" and not tokens[end + 1].breaks and not beside
        kept[at - 1] = kept[at - 1] if ends else kept[at - 1][: _line_end(kept[at - 1])]
    elif tokens[at - 1].kind == "space" and not tokens[at - 1].breaks and not first:
        kept[at - 1] = ""
    elif comma and tokens[end + 1].kind == "space" and not tokens[end + 1].breaks:
        kept[end + 1] = ""
    return "".join(kept)


def _tokens(array: str) -> list[_Token]:
    return [_Token(str(m.lastgroup), m[0]) for m in _TOKENS.finditer(array)]


def _texts(tokens: Sequence[_Token]) -> list[str]:
    return [t.text for t in tokens]


def _places(tokens: Sequence[_Token]) -> list[int]:
    return [i for i, t in enumerate(tokens) if t.kind == "name"]


def _meaning(text: str) -> str:
    return str(tomllib.loads(f"x = {text}")["x"])


def _quoted(name: str, quote: str) -> str:
    return f"{quote}{name}{quote}"


def _next(tokens: Sequence[_Token], at: int, kind: str) -> int | None:
    """The next token of a kind before another name."""
    for i in range(at + 1, len(tokens)):
        if tokens[i].kind == kind:
            return i
        if tokens[i].kind == "name":
            return None
    return None


def _before(tokens: Sequence[_Token], at: int) -> int:
    """The comma before a name that is not the first."""
    return max(i for i in range(at) if tokens[i].kind == "comma")


def _comment_beside(tokens: Sequence[_Token], at: int) -> int | None:
    """The comment that follows from `at` on the same line."""
    for i in range(at, len(tokens)):
        if tokens[i].kind == "comment":
            return i
        if tokens[i].kind != "space" or tokens[i].breaks:
            return None
    return None


def _shares_line(tokens: Sequence[_Token], end: int) -> bool:
    """Whether another name or the bracket follows on the line."""
    for token in tokens[end + 1 :]:
        if token.breaks:
            return False
        if token.kind in ("name", "other"):
            return token.kind == "name"
    return False


def _break(tokens: Sequence[_Token], last: int) -> str:
    """What parts a new name from the last one: a space, or a line with the same indent."""
    breaks = [i for i, t in enumerate(tokens) if t.breaks]
    if not breaks:
        return " "
    ahead = [i for i in breaks if i < last]
    # the bracket's own line is no measure of how far names are set in
    space = tokens[ahead[-1]].text if ahead else tokens[breaks[0]].text.rstrip(" \t") + "  "
    return space[_line_end(space) :]


def _line_end(space: str) -> int:
    """Where the last line end of some white space begins."""
    at = space.rindex("\n")
    return at - 1 if space[at - 1 : at] == "\r" else at
