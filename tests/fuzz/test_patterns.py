"""Every regular expression of the package: in time proportional to what it looks at.

A pattern that tries a long text in every way costs minutes for a line of a hundred bytes. Found
are all patterns at the level of modules, with the methods that are called on them, and all that are
written where they are used. Each is given what its own parts accept, again and again, and then
something that it does not.
"""

import ast
import importlib
import pkgutil
import re
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from limits import Hang, time_limit

import trialid

METHODS = ("match", "fullmatch", "search", "findall", "finditer", "split", "sub")
LONG = 6_000
"""Letters; in this many a square is 2e7 steps, a tenth of a second."""
MOST = 0.03
"""Seconds of computing; a pattern that looks at each letter once takes a thousandth."""
OTHERS = "aA0 .,-+/:;'\"$*_\t\n<([é°\u00a0"
ENDS = ("", "!", "\x00", "\n!")


@dataclass(frozen=True)
class Use:
    """A pattern and how it is asked."""

    place: str
    pattern: re.Pattern[str] | re.Pattern[bytes]
    method: str


def _modules() -> Iterator[tuple[str, ast.Module]]:
    root = Path(trialid.__file__).parent
    for info in pkgutil.walk_packages(trialid.__path__, "trialid."):
        place = root / Path(*info.name.split(".")[1:])
        file = place / "__init__.py" if info.ispkg else place.with_suffix(".py")
        text = file.read_text(encoding="utf-8")
        if any(f".{method}(" in text for method in METHODS) or "re.compile" in text:
            yield info.name, ast.parse(text)


def uses() -> tuple[Use, ...]:
    trees = dict(_modules())
    called: dict[str, set[str]] = {}
    inline = []
    for name, tree in trees.items():
        for node in ast.walk(tree):
            if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
                continue
            on = node.func.value
            if not (isinstance(on, ast.Name | ast.Attribute) and node.func.attr in METHODS):
                continue
            owner = on.id if isinstance(on, ast.Name) else on.attr
            if owner == "re":
                text = node.args[0]
                if isinstance(text, ast.Constant):
                    inline.append(
                        Use(f"{name}:{node.lineno}", re.compile(text.value), node.func.attr)
                    )
            else:
                called.setdefault(owner, set()).add(node.func.attr)
    return (*inline, *_at_module_level(trees, called))


def _at_module_level(trees: dict[str, ast.Module], called: dict[str, set[str]]) -> Iterator[Use]:
    seen = set()
    for name in trees:
        for key, value in vars(importlib.import_module(name)).items():
            held = value.values() if isinstance(value, dict) else value
            several = held if isinstance(value, dict | tuple | list) else (value,)
            for i, one in enumerate(several):
                if isinstance(one, re.Pattern) and (key, id(one)) not in seen:
                    seen.add((key, id(one)))
                    for method in sorted(called.get(key, set(METHODS[:4]))):
                        yield Use(f"{name}:{key}[{i}]", one, method)


def beginnings(pattern: re.Pattern[str] | re.Pattern[bytes]) -> set[str]:
    """Texts that the pattern accepts up to some part of it."""
    text = pattern.pattern if isinstance(pattern.pattern, str) else pattern.pattern.decode("latin1")
    tree = re._parser.parse(text, pattern.flags & ~re.UNICODE)  # type: ignore[attr-defined]
    found: set[str] = {""}
    _grow(tree, [""], found)
    return found


def _grow(tree: object, before: list[str], found: set[str]) -> list[str]:
    """What is accepted after `before`, one text for each branch; every stage goes to `found`."""
    for kind, value in tree:  # type: ignore[attr-defined]
        name = str(kind)
        if name == "BRANCH":
            before = [end for one in value[1] for end in _grow(one, before, found)][:12]
        elif name == "SUBPATTERN":
            before = _grow(value[3], before, found)
        elif name in ("MAX_REPEAT", "MIN_REPEAT", "POSSESSIVE_REPEAT"):
            once = _grow(value[2], before, found)
            for _ in range(value[0] - 1):
                once = _grow(value[2], once, found)
            before = (once if value[0] else [*once, *before])[:12]
        elif name == "ATOMIC_GROUP":
            before = _grow(value, before, found)
        else:
            letters = _letters(name, value)
            before = [one + letter for one in before for letter in letters][:12]
        found.update(before)
    return before


SAMPLES = {"DIGIT": "0", "SPACE": " ", "WORD": "a", "NOT_WORD": " ", "NOT_DIGIT": "a",
           "NOT_SPACE": "a"}  # fmt: skip


def _letters(name: str, value: object) -> str:
    """A letter or two that a part accepts; empty where it takes none."""
    if name == "LITERAL":
        return chr(value)  # type: ignore[arg-type]
    if name in ("ANY", "NOT_LITERAL"):
        return "a"
    if name == "IN":
        return "".join(_letters(str(k), v) for k, v in value)[:3] or "a"  # type: ignore[attr-defined]
    if name == "RANGE":
        return chr(value[0])  # type: ignore[index]
    if name == "CATEGORY":
        return SAMPLES[str(value).removeprefix("CATEGORY_")]
    return ""


def texts(pattern: re.Pattern[str] | re.Pattern[bytes]) -> Iterator[str]:
    """Long texts: a beginning, a letter or an accepted text again and again, and an end."""
    begun = sorted(beginnings(pattern), key=lambda one: (len(one), one))[:60]
    tails = {one[-n:] for one in begun for n in (1, 2, 3) if len(one) >= n}
    for head in begun[:: max(len(begun) // 12, 1)]:
        for pump in sorted({*OTHERS, *tails})[:60]:
            for end in ENDS[:2]:
                yield head + pump * (LONG // len(pump)) + end
    for pump in begun:
        for end in ENDS:
            if pump:
                yield pump * (LONG // len(pump)) + end


def seconds(use: Use, text: str | bytes) -> float:
    """Of computing."""
    begin = time.process_time()
    if use.method in ("sub",):
        use.pattern.sub(text[:0], text)  # type: ignore[arg-type]
    else:
        found = getattr(use.pattern, use.method)(text)
        if use.method == "finditer":
            list(found)
    return time.process_time() - begin


def slow(use: Use) -> str | None:
    """The text, shortened, on which it takes too long."""
    for text in texts(use.pattern):
        given = text if isinstance(use.pattern.pattern, str) else text.encode("latin1", "replace")
        try:
            with time_limit(5.0):
                late = all(seconds(use, given) > MOST for _ in range(3))
        except Hang:
            late = True
        if late:
            return f"{use.place}.{use.method}: {given[:20]!r}...{given[-20:]!r}"
    return None


ALL = uses()


def test_they_are_all_found():
    places = {use.place for use in ALL}
    assert len(places) > 60
    assert any("template_guess" in place for place in places)


IN_TURN = [pytest.param(one, marks=pytest.mark.study(turn="each")) for one in ALL]


@pytest.mark.parametrize(
    "use",
    [one if i % 4 == 0 else IN_TURN[i] for i, one in enumerate(ALL)],
    ids=[f"{one.place}.{one.method}" for one in ALL],
)
def test_a_pattern_is_linear(use):
    assert slow(use) is None


@pytest.mark.parametrize(
    "text",
    [
        r"(a+)+b",
        r"a*a*b",
        r"[A-Za-z]{0,5}([/*]?[A-Za-z]+)*",
        r"\d{1,3}([., ]\d{3})+[.,]\d*|\d+[.,]",
    ],
    ids=["doubles", "squares", "the unit of before", "the number of before"],
)
@pytest.mark.study(turn=10)
def test_a_pattern_that_is_not_is_seen(text):
    """The test can fail: in a square of the length, or twice as long for every letter."""
    assert slow(Use("here", re.compile(text), "fullmatch")) or slow(
        Use("here", re.compile(text), "search")
    )
