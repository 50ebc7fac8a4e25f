"""The rule about dependencies: what is imported is declared, and the other way round."""

import ast
import re
import sys
import tomllib
from collections.abc import Iterable, Iterator
from typing import Final

from house.sources import Breach, House, Source

PROJECT: Final = "pyproject.toml"
DEVELOPMENT: Final = {"test", "studies", "checks"}
"""Extras for whoever works on the package: nothing that is shipped imports them."""
_NAME: Final = re.compile(r"[\w.-]+")


def dependencies(house: House) -> Iterator[Breach]:
    """Find undeclared imports of the package and of the tests, and declarations without a use."""
    project = tomllib.loads(house.text(PROJECT) or "[project]")["project"]
    extras = project.get("optional-dependencies", {})
    runtime = _names(project.get("dependencies", []))
    for group in extras.keys() - DEVELOPMENT:
        runtime |= _names(extras[group])
    shipped = _imported(house, house.package)
    others = [each for each in house.python if not each.path.startswith("trialid/")]
    yield from _undeclared(shipped, runtime, "dependencies")
    everything = runtime | {n for group in DEVELOPMENT for n in _names(extras.get(group, []))}
    yield from _undeclared(_imported(house, others), everything, "the extras for tests")
    used = shipped.keys() | _loaded(house) | set(house.listed("dependencies", "used_otherwise"))
    unused = runtime - used
    for name in sorted(unused - {project.get("name")}):
        yield Breach(
            path=PROJECT,
            what=f"{name} is declared and imported by nothing that is shipped",
            todo="drop it, or move it to an extra; a use without an import is stated in "
            ".ci/house_words.toml",
            key=f"unused {name}",
        )


def _undeclared(
    found: dict[str, tuple[str, int]], declared: set[str], where: str
) -> Iterator[Breach]:
    for name in sorted(found.keys() - declared):
        path, line = found[name]
        yield Breach(
            path=path,
            line=line,
            what=f"{name} is imported and not declared",
            todo=f"add it to {where} of {PROJECT}",
            key=f"undeclared {name}",
        )


def _names(declared: Iterable[str]) -> set[str]:
    """Names of distributions, without versions and extras."""
    found = (_NAME.match(each) for each in declared)
    return {_plain(match[0]) for match in found if match}


def _plain(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def _imported(house: House, sources: list[Source]) -> dict[str, tuple[str, int]]:
    """Distributions that are imported, each with the first place."""
    own = {each.name.removesuffix(".py") for each in house.python}
    own |= {part for each in house.python for part in each.folder.split("/")}
    found: dict[str, tuple[str, int]] = {}
    for source in sources:
        for module, line in _modules(source):
            top = module.partition(".")[0]
            if top not in own and top not in sys.stdlib_module_names:
                found.setdefault(_distribution(house, top), (source.path, line))
    return found


def _distribution(house: House, module: str) -> str:
    """What to install for a module; a part of another package is that package."""
    name = _plain(house.listed("dependencies", "distributions").get(module, module))
    return str(house.listed("dependencies", "parts").get(name, name))


def _loaded(house: House) -> set[str]:
    """Distributions of modules that are named to a function that imports them when needed."""
    calls = (node for each in house.package for node in each.nodes if isinstance(node, ast.Call))
    firsts = (call.args[0] for call in calls if call.args)
    names = (each.value for each in firsts if isinstance(each, ast.Constant))
    return {_distribution(house, name) for name in names if isinstance(name, str)}


def _modules(source: Source) -> Iterator[tuple[str, int]]:
    """Every module a file imports, with the line."""
    for node in source.nodes:
        if isinstance(node, ast.Import):
            yield from ((each.name, node.lineno) for each in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module, node.lineno
