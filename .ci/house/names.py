"""Rules about names: a newcomer guesses by them."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from typing import Final

from house.sources import Breach, House

FREE: Final = ("__init__.py", "__main__.py")
"""Names that every package may have."""

PREDICATES: Final = frozenset(("is", "are", "was", "were", "has", "have", "can", "may", "to"))
"""`is_known` asks, and says so."""

_PARTICIPLE: Final = re.compile(r"(?:ed|ing)$")


def module_names(house: House) -> Iterator[Breach]:
    """Find two modules of the package with one name, whichever folders they lie in."""
    named = defaultdict(list)
    for source in house.package:
        named[source.name].append(source.path)
    for name, paths in named.items():
        for path in paths[1:] if name not in FREE else ():
            yield Breach(
                path=path,
                what=f"{paths[0]} has the same name",
                todo="name it by what it alone holds",
                key=name,
            )


def function_names(house: House) -> Iterator[Breach]:
    """Find public functions named by a participle or a preposition."""
    for source in house.package:
        if any(source.path.startswith(each) for each in house.listed("names", "free_folders")):
            continue
        for node in source.tree.body:
            if isinstance(node, ast.FunctionDef) and _private_word(house, node.name):
                yield Breach(
                    path=source.path,
                    line=node.lineno,
                    what=f"{node.name}() is named by a participle or a preposition",
                    todo="name it by a verb or by the noun it gives; an exception goes into "
                    ".ci/house_words.toml",
                    key=source.path,
                )


def _private_word(house: House, name: str) -> bool:
    """Whether only its author knows what a name gives."""
    words = name.split("_")
    if not words[0] or words[0] in PREDICATES:
        return False
    if name in house.listed("names", "prepositions"):
        return True
    last = words[-1]
    if last in house.listed("names", "participles"):
        return True
    return bool(_PARTICIPLE.search(last)) and last not in house.listed("names", "nouns_and_verbs")
