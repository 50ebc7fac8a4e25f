"""Keep the house rules: one line for each thing that breaks one, with what to do.

`python .ci/house_rules.py` checks; `--count` prints the totals; `--ratchet` writes what is left of
what was so before the rules came into `.ci/house_rules.toml`, which may only become less.
"""

import argparse
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

from house import RULES, Breach, House
from house import ratchet as kept
from house.sources import house_at

Found = Mapping[str, list[Breach]]
LEAST_SHOWN: Final = 8
"""Things that could be lowered that are told one by one."""


def main(arguments: list[str] | None = None) -> int:
    """Check, count or write; 1 where a rule is broken."""
    asked = _asked(arguments)
    house = house_at(asked.root)
    found = {name: list(rule(house)) for name, rule in RULES.items()}
    if asked.count:
        return _count(found, house)
    return (_ratchet if asked.ratchet else _check)(found, house)


def _asked(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--root", type=Path, default=Path(__file__).parent.parent)
    parser.add_argument("--count", action="store_true", help="print a table of totals")
    parser.add_argument("--ratchet", action="store_true", help="rewrite what is allowed")
    return parser.parse_args(arguments)


def _check(found: Found, house: House) -> int:
    """Say what is more than allowed, with every place of it, and what could be lowered."""
    now, allowed = kept.count(found), kept.read(house.root)
    grown = list(kept.grown(now, allowed))
    for rule, key, before, _ in grown:
        for breach in found[rule]:
            if breach.key == key:
                _say(f"{breach} [{rule}, {before} allowed]")
    lowered = kept.lowered(now, allowed)
    for line in lowered[:LEAST_SHOWN]:
        _say(f"could be lowered: {line}")
    if lowered:
        _say(f"{len(lowered)} could be lowered: python .ci/house_rules.py --ratchet")
    _say(f"house rules: {len(grown)} broken" if grown else "house rules: kept")
    return 1 if grown else 0


def _ratchet(found: Found, house: House) -> int:
    """Write what is found as what is allowed, unless a total would grow."""
    now, allowed = kept.count(found), kept.read(house.root)
    raised = list(kept.raised(now, allowed)) if allowed else []
    for line in raised:
        _say(f"not written, it may only become less: {line}")
    if not raised:
        kept.write(house.root, now)
        _say(f"written: .ci/{kept.FILE}")
    return 1 if raised else 0


COLUMNS: Final[Mapping[str, Callable[[Breach], bool]]] = {
    "trialid": lambda breach: breach.path.startswith("trialid"),
    "tests": lambda breach: breach.path.startswith("tests"),
    "all": lambda breach: True,
}


def _count(found: Found, house: House) -> int:
    """Print how many places break each rule, and the total that the ratchet allows."""
    allowed = kept.read(house.root)
    _say(f"{'rule':24}" + "".join(f"{name:>9}" for name in (*COLUMNS, "amount", "allowed")))
    for rule, breaches in found.items():
        places = [sum(map(belongs, breaches)) for belongs in COLUMNS.values()]
        amounts = [sum(each.amount for each in breaches), kept.total(allowed, rule)]
        _say(f"{rule:24}" + "".join(f"{number:9}" for number in (*places, *amounts)))
    return 0


def _say(line: str) -> None:
    sys.stdout.write(line + "\n")


if __name__ == "__main__":
    sys.exit(main())
