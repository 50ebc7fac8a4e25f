"""Write what the guide's pages take from the code and from the result files.

    python tests/generate_guide.py

A page says where such a part stands by two lines, `<!-- generated: keys of a pipeline -->` and
`<!-- end -->`; what is between them is replaced. `tests/test_guide.py` fails where a page is stale.
"""

import datetime
import re
import sys
import textwrap
import types
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Final, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

sys.path.insert(0, str(Path(__file__).resolve().parent / "ship" / "estimate"))
sys.path.insert(0, str(Path(__file__).resolve().parent / "manual"))

import claims
from guide_of_estimates import ship_estimates
from guide_of_fleets import fleet_columns

from trialid.design.kinds import KINDS
from trialid.guide import TOPICS
from trialid.names.quantities import MASS_PARAMETERS, PARTICULARS, SIGNALS
from trialid.pipeline_file.design_file import DesignFile
from trialid.pipeline_file.fleet_file import FleetFile
from trialid.pipeline_file.form import Pipeline, Written
from trialid.pipeline_file.prior_section import Word
from trialid.pipeline_file.section import Section
from trialid.ship import actuators, particulars
from trialid.ship.prime import ARMS

ROOT: Final = Path(__file__).resolve().parent.parent
PAGES: Final = ROOT / "trialid" / "guide"
WIDTH: Final = 100
COMMAND: Final = "python tests/generate_guide.py"

PART: Final = re.compile(r"(<!-- generated: (.*?) -->\n).*?(<!-- end -->\n)", re.DOTALL)


def main() -> None:
    """Bring every page up to date, and name those that were not."""
    for path in pages():
        text = path.read_text(encoding="utf-8")
        if (new := filled(text)) != text:
            path.write_text(new, encoding="utf-8")
            sys.stdout.write(f"{path.relative_to(ROOT)}\n")


def pages() -> list[Path]:
    """Every page of the guide."""
    return [PAGES / f"{topic}.md" for topic in TOPICS]


def filled(text: str) -> str:
    """A page with its generated parts as they are now."""
    return PART.sub(lambda part: part[1] + "\n" + PARTS[part[2]]() + "\n" + part[3], text)


def item(words: str) -> str:
    """One point of a list, wrapped."""
    return textwrap.fill(
        words, WIDTH, initial_indent="- ", subsequent_indent="  ", break_long_words=False,
        break_on_hyphens=False,
    )  # fmt: skip


def items(rows: Iterable[str]) -> str:
    """A list, one point each."""
    return "\n".join(item(row) for row in rows) + "\n"


# --- keys of a form -----------------------------------------------------------------------------


def form(whole: type[Section], besides: Iterable[str] = ()) -> str:
    """The keys of a file, table by table; of the tables `besides` another page tells."""
    found: dict[type[Section], list[str]] = {}
    for section, heading in _tables(whole, ""):
        if heading.strip("`[]").partition(".")[0] not in besides:
            found.setdefault(section, []).append(heading)
    return "\n".join(
        f"### {' and '.join(headings)}\n\n{_about(section)}{items(_rows(section))}"
        for section, headings in found.items()
    )


def _about(section: type[Section]) -> str:
    """What a table is; the top of a file the page itself tells."""
    text = " ".join((section.__doc__ or "").split())
    return "" if issubclass(section, Written) else f"{textwrap.fill(text, WIDTH)}\n\n"


def _tables(section: type[Section], path: str) -> Iterator[tuple[type[Section], str]]:
    """Every table of a file with its heading there; a file's own before those all files have."""
    if not path:
        yield section, "Top of the file"
    fields = section.model_fields
    for name in sorted(fields, key=lambda name: name not in section.__annotations__):
        key = ".".join(filter(None, (path, fields[name].alias or name)))
        for inner, how in _sections(fields[name].annotation, ""):
            brackets = f"`[[{key}]]`" if how == "many" else f"`[{key}]`"
            yield inner, brackets + (", for each name" if how == "named" else "")
            yield from _tables(inner, key)


def _sections(annotation: Any, how: str) -> Iterator[tuple[type[Section], str]]:
    """The tables a key may hold, and whether it holds one, many, or many by name."""
    origin = get_origin(annotation)
    if isinstance(annotation, type) and origin is None and issubclass(annotation, Section):
        yield annotation, how
    elif origin is Annotated:
        yield from _sections(get_args(annotation)[0], how)
    elif origin is tuple:
        for inner in get_args(annotation):
            yield from _sections(inner, "many")
    elif origin is not None and origin is not Literal:
        named = isinstance(origin, type) and issubclass(origin, Mapping)
        for inner in get_args(annotation):
            yield from _sections(inner, "named" if named else how)


def _rows(section: type[Section]) -> Iterator[str]:
    for name, field in section.model_fields.items():
        said = " ".join((field.description or "").split())
        yield f"`{field.alias or name}`: {_kind_of(field)}{_default(field)}. {said}"


def _default(field: FieldInfo) -> str:
    """What holds where the key is left out."""
    value = field.get_default()
    if field.is_required():
        return "" if "left out:" in (field.description or "") else "; needed"
    if value is None or value in ((), {}) or isinstance(value, Section):
        return ""
    if value is PydanticUndefined:
        raise ValueError(f"no default: {field}")
    return f"; `{_toml(value)}` if left out"


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else f"{value}"


def _kind_of(field: FieldInfo) -> str:
    return _kind(field.annotation, field.metadata)


def _kind(annotation: Any, metadata: Iterable[Any] = ()) -> str:
    """What a key holds, in words."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _kind(inner[0], [*inner[1:], *metadata])
    if origin in (Union, types.UnionType):
        kinds = [_kind(one, metadata) for one in inner if one is not type(None)]
        return _alternatives([*dict.fromkeys(kinds)])
    if origin is Literal:
        return _alternatives([f'`"{one}"`' for one in inner])
    if origin is tuple:
        return _list(inner)
    if isinstance(origin, type) and issubclass(origin, Mapping):
        words = [f'`"{each.text}"`' for each in metadata if isinstance(each, Word)]
        return _alternatives([f"{_kind(inner[1])} for each name", *words])
    return _plain(annotation) + _limits(metadata)


def _alternatives(words: list[str]) -> str:
    return " or ".join(filter(None, (", ".join(words[:-1]), words[-1])))


def _list(inner: tuple[Any, ...]) -> str:
    if inner[-1] is not Ellipsis:
        return f"[{', '.join(map(_kind, inner))}]"
    kind = _kind(inner[0])
    return f"list of {kind}s" if kind.isalpha() else f"list of {kind}"


def _plain(annotation: Any) -> str:
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return "table"
    return {
        str: "text", float: "number", int: "whole number", bool: "true or false", Path: "path",
        datetime.datetime: "date", datetime.date: "date",
    }[annotation]  # fmt: skip


def _limits(metadata: Iterable[Any]) -> str:
    """The range a number may have."""
    words = {"gt": "above", "ge": "from", "lt": "below", "le": "up to"}
    said = [
        f"{words[way]} {getattr(one, way):g}"
        for one in _each(metadata)
        for way in words
        if getattr(one, way, None) is not None
    ]
    return " " + " ".join(said) if said else ""


def _each(metadata: Iterable[Any]) -> Iterator[Any]:
    """Limits, those inside a Field too."""
    for one in metadata:
        yield from one.metadata if isinstance(one, FieldInfo) else (one,)


# --- ship, quantities, manoeuvres, claims -------------------------------------------------------


def ship() -> str:
    """The keys of a ship file."""
    needed = dict.fromkeys(particulars.REQUIRED, "needed. ")
    top = items(f"`{key}`: {needed.get(key, '')}{said}" for key, said in particulars.KEYS.items())
    inside = items(
        f"`{q.name}` [{_unit(q.unit)}]: "
        f"{'needed; ' if q.name in particulars.PARTICULARS else ''}{q.meaning}"
        for q in PARTICULARS.values()
    )
    mass = items(
        f"`{name}`{' (length)' if name in ARMS else ''}: {particulars.MASS_KEYS[name]}"
        for name in MASS_PARAMETERS
    )
    return f"### Top of the file\n\n{top}\n### `[particulars]`\n\n{inside}\n### `[mass]`\n\n{mass}"


def actuator() -> str:
    """The keys of an `[[actuator]]`."""
    return items(f"`{key}`: {said}" for key, said in actuators.KEYS.items())


def _unit(unit: str) -> str:
    return "-" if unit == "1" else unit


def signals() -> str:
    """Every signal: its name in files, its symbol, the unit of reports, its positive direction."""
    return items(_signal(q.name) for q in SIGNALS.values())


def _signal(name: str) -> str:
    q = SIGNALS[name]
    other = f" Logs also call it {', '.join(sorted(q.aliases))}." if q.aliases else ""
    return f"`{q.name}` [{_unit(q.shown)}]: {q.meaning}.{other}"


def manoeuvres() -> str:
    """Every kind of test with its numbers."""
    return items(_manoeuvre(name) for name in KINDS)


def _manoeuvre(name: str) -> str:
    kind = KINDS[name]
    numbers = ", ".join(
        f"`{n}`{' (list)' if v.many else ''} [{_unit(v.unit)}]" for n, v in kind.variables.items()
    )
    return f"`{name}`, {kind.words}: {numbers}"


def claimed() -> str:
    """What is claimed, the figure, on how many cases, and where it comes from."""
    return items(claims.claims())


PARTS: Final[Mapping[str, Callable[[], str]]] = {
    "keys of a pipeline": lambda: form(Pipeline),
    "keys of a design": lambda: form(DesignFile, besides=("model", "identify")),
    "keys of a ship": ship,
    "keys of an actuator": actuator,
    "keys of a fleet": lambda: form(FleetFile),
    "columns of a fleet": lambda: fleet_columns(items),
    "signals": signals,
    "manoeuvres": manoeuvres,
    "claims": claimed,
    "ship estimates": ship_estimates,
}
"""Each generated part by the name it has in a page."""


if __name__ == "__main__":
    main()
