"""The scripts of the report and the workbench: modules that find each other, joined or served."""

import posixpath
import re
from collections.abc import Iterator
from importlib import resources

from trialid.report.script import MODULES, join_modules, script
from trialid.workbench.server import ASSETS

IMPORT = re.compile(r'^import (?:\{ (?P<names>[^}]+) \}|\* as \w+) from "(?P<path>[^"]+)";$')
NAMED = re.compile(r"^(?P<given>export )?(?:async )?(?:function|const|let) (?P<name>\w+)")
SERVED = {name: place for name, place in ASSETS.items() if re.search(r"(?<!uplot)\.js$", name)}


def text(package: str, path: str) -> str:
    return resources.files(package).joinpath(path).read_text(encoding="utf-8")


def names(module: str) -> list[tuple[str, bool]]:
    """What a module names at its top, and whether it gives it to others."""
    found = (NAMED.match(line) for line in module.splitlines())
    return [(match["name"], bool(match["given"])) for match in found if match]


def imports(name: str, module: str) -> Iterator[tuple[str, set[str]]]:
    """Each module that one imports from, as it is addressed, and the names taken."""
    for line in module.splitlines():
        if line.startswith("import"):
            match = IMPORT.match(line)
            assert match, f"{name}: an import stands on one line of the form import {{ a }} from"
            path = posixpath.normpath(posixpath.join(posixpath.dirname(name), match["path"]))
            yield path, set((match["names"] or "").split(", ")) - {""}


def test_every_name_of_the_report_occurs_once_in_one_scope() -> None:
    all_names = [name for each in MODULES for name, _ in names(text("trialid.report", each))]
    assert len(all_names) > 40
    assert sorted(all_names) == sorted(set(all_names))


def test_the_report_joins_each_module_after_those_it_imports_from() -> None:
    for place, name in enumerate(MODULES):
        for path, _ in imports(name, text("trialid.report", name)):
            assert path in MODULES[:place], f"{name} imports from {path}"
    assert not re.search(r"^(import|export)\b", script(), re.MULTILINE)


def test_every_script_of_the_report_is_joined() -> None:
    root = resources.files("trialid.report")
    own = {each.name for each in root.iterdir() if each.name.endswith(".js")}
    own |= {f"plots/{each.name}" for each in root.joinpath("plots").iterdir()}
    assert own == set(MODULES)


def test_what_a_served_module_imports_is_served_and_given() -> None:
    given = {name: {n for n, out in names(text(*place)) if out} for name, place in SERVED.items()}
    assert {"workbench.js", "plots.js", "plots/chart.js"} <= given.keys()
    for name, place in SERVED.items():
        for path, taken in imports(name, text(*place)):
            assert taken <= given[path], f"{name} takes {taken - given[path]} from {path}"


def test_what_is_said_between_the_modules_only_is_dropped() -> None:
    module = 'import { a } from "./a.js";\nexport async function b() {\n  a("export c");\n}\n'
    assert join_modules([module]) == 'async function b() {\n  a("export c");\n}\n'
