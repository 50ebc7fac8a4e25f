"""What was already so when a rule came: it may become less, never more."""

import json
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Final

from house.sources import Breach

FILE: Final = "house_rules.toml"

HEAD: Final = """\
# What broke a house rule when the rule came, by rule and place; it may only become less.
# Written by `python .ci/house_rules.py --ratchet`, which refuses to raise a total.
"""

Counts = Mapping[str, Mapping[str, int]]
"""Amounts by rule and key."""


def count(breaches: Mapping[str, Iterable[Breach]]) -> Counts:
    """Give the amounts by rule and key; a rule nothing breaks is there with no key."""
    counts: dict[str, dict[str, int]] = {}
    for rule, each in breaches.items():
        found = counts.setdefault(rule, {})
        for breach in each:
            found[breach.key] = found.get(breach.key, 0) + breach.amount
    return counts


def total(counts: Counts, rule: str) -> int:
    """Give the sum of a rule's amounts."""
    return sum(counts.get(rule, {}).values())


def read(root: Path) -> Counts:
    """Give what is allowed; nothing is, where the file is absent."""
    path = root / ".ci" / FILE
    return tomllib.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def write(root: Path, counts: Counts) -> None:
    """Keep amounts as what is allowed from now on."""
    parts = [HEAD]
    for rule, found in sorted(counts.items()):
        rows = [f"{json.dumps(key)} = {amount}\n" for key, amount in sorted(found.items())]
        parts.append(f"[{rule}]\n" + "".join(rows))
    (root / ".ci" / FILE).write_text("\n".join(parts), encoding="utf-8")


def raised(now: Counts, allowed: Counts) -> Iterator[str]:
    """Say which totals would be raised."""
    for rule in now:
        before, after = total(allowed, rule), total(now, rule)
        if after > before:
            yield f"{rule}: {before} allowed, {after} found"


def grown(now: Counts, allowed: Counts) -> Iterator[tuple[str, str, int, int]]:
    """Give rule, key, what is allowed and what was found, where it is more."""
    for rule, found in now.items():
        for key, amount in found.items():
            before = allowed.get(rule, {}).get(key, 0)
            if amount > before:
                yield rule, key, before, amount


def lowered(now: Counts, allowed: Counts) -> list[str]:
    """Say where less is found than is allowed, so that the ratchet can follow."""
    return [
        f"{rule}: {key}: {now.get(rule, {}).get(key, 0)}, {before} allowed"
        for rule, found in allowed.items()
        for key, before in found.items()
        if now.get(rule, {}).get(key, 0) < before
    ]
