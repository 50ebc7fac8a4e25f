"""The guide: every topic has its page, what is taken from the code is fresh, and it can be read."""

import re
import tomllib
from pathlib import Path
from typing import Any

import generate_guide
import pytest
from click.testing import CliRunner, Result
from generate_guide import claims

from trialid.cli import guide_command
from trialid.cli.main import commands
from trialid.errors import TrialidError
from trialid.guide import TOPICS, page
from trialid.names.quantities import MASS_PARAMETERS, SIGNALS
from trialid.pipeline_file.design_file import DesignFile
from trialid.pipeline_file.form import Pipeline
from trialid.report.tables import run_tables
from trialid.result import schema
from trialid.ship import particulars

ROOT = Path(__file__).parent.parent
README = ROOT / "README.md"
WIDEST = 100
MOST = 250
"""Lines of the README."""

NEW_LAYOUT = (ROOT / "trialid" / "names").is_dir()
"""Pages name modules by the rooms they are moving to."""


def shown(*arguments: str) -> Result:
    return CliRunner().invoke(commands, ["guide", *arguments], prog_name="trialid")


def source(topic: str) -> str:
    return (generate_guide.PAGES / f"{topic}.md").read_text(encoding="utf-8")


# --- pages --------------------------------------------------------------------------------------


def test_every_topic_has_a_page_and_every_page_is_a_topic() -> None:
    assert {path.stem for path in generate_guide.PAGES.glob("*.md")} == set(TOPICS)


@pytest.mark.parametrize("topic", TOPICS)
def test_what_comes_from_the_code_is_fresh(topic: str) -> None:
    text = source(topic)
    stale = f"trialid/guide/{topic}.md is stale; run: {generate_guide.COMMAND}"
    assert generate_guide.filled(text) == text, stale


def test_a_stale_page_is_found() -> None:
    text = source("pipeline_file")
    assert generate_guide.filled(text.replace("Time between samples", "Time")) == text


def test_every_generated_part_has_its_place() -> None:
    named = re.findall(r"<!-- generated: (.*?) -->", "".join(map(source, TOPICS)))
    assert sorted(named) == sorted(generate_guide.PARTS)


@pytest.mark.parametrize("path", [README, *generate_guide.pages()], ids=lambda path: path.stem)
def test_lines_are_short(path: Path) -> None:
    lines = path.read_text(encoding="utf-8").splitlines()
    assert [(i, line) for i, line in enumerate(lines, 1) if len(line) > WIDEST] == []


def test_the_readme_is_short() -> None:
    assert len(README.read_text(encoding="utf-8").splitlines()) <= MOST


def test_the_readme_points_to_every_page() -> None:
    text = README.read_text(encoding="utf-8")
    assert [topic for topic in TOPICS if f"](trialid/guide/{topic}.md)" not in text] == []


@pytest.mark.parametrize("topic", TOPICS)
def test_what_a_page_points_to_is_there(topic: str) -> None:
    """Other pages by their name, files of the project by their path from its top."""
    text = source(topic)
    pages = re.findall(r"\]\(([^)\s]+)\)", text)
    assert [link for link in pages if link.removesuffix(".md") not in TOPICS] == []
    paths = re.findall(r"`((?:trialid|tests|pipelines|sample_data|\.ci)/[\w./*-]*)", text)
    moving = [path for path in paths if path.startswith("trialid/")] if not NEW_LAYOUT else []
    own = [path for path in paths if "*" not in path and "write_turnlog" not in path]
    assert [path for path in own if path not in moving and not (ROOT / path).exists()] == []


# --- what they have to say ----------------------------------------------------------------------


def sections(section: type, seen: set[type]) -> set[type]:
    """A form and all the tables it is made of."""
    seen.add(section)
    for inner, _ in generate_guide._tables(section, "x"):
        if inner not in seen:
            sections(inner, seen)
    return seen


@pytest.mark.parametrize(
    "key",
    [
        (section, name)
        for section in sorted(
            sections(Pipeline, set()) | sections(DesignFile, set()), key=lambda each: each.__name__
        )
        for name in section.model_fields
    ],
    ids=lambda key: f"{key[0].__name__}.{key[1]}",
)
def test_every_key_of_a_file_says_what_it_means(key: tuple[type, str]) -> None:
    """As a sentence under the field, where the form declares it."""
    section, name = key
    said = section.model_fields[name].description or ""
    assert len(said) > 7, f"write a line under {section.__name__}.{name} that says what it means"
    assert said.endswith((".", ";")), said


def test_every_key_of_a_ship_file_says_what_it_means() -> None:
    assert set(particulars.KEYS) == {*particulars.REQUIRED, *particulars.OPTIONAL}
    assert tuple(particulars.MASS_KEYS) == MASS_PARAMETERS


def test_keys_stand_in_the_pages() -> None:
    for topic, forms in (("pipeline_file", Pipeline), ("design", DesignFile)):
        shared = {"ModelSection", "IdentifySection", "Prior"} if forms is DesignFile else set()
        for section in sections(forms, set()):
            if section.__name__ not in shared:
                for name, field in section.model_fields.items():
                    assert f"\n- `{field.alias or name}`: " in source(topic), name
    assert [name for name in SIGNALS if f"\n- `{name}` [" not in source("nomenclature")] == []


def test_every_column_is_explained() -> None:
    """Headings of the report's tables stand in the page of columns, without their units."""
    parameters = run_tables._parameters(schema.Result()).headings
    missing = run_tables._missing(schema.Result()).headings
    error = run_tables._split(schema.Result()).headings
    text = source("accuracy")
    for heading in {*parameters, *missing, *error} - {"parameter", "rank", "effect", "output"}:
        plain = re.sub(r" \[%\]| (from|to)$", "", heading)
        assert f"`{plain}`" in text, heading


CLAIMED = tomllib.loads(claims.CLAIMS.read_text(encoding="utf-8"))["claim"]


@pytest.mark.parametrize("row", CLAIMED, ids=lambda row: row["claim"][:40])
def test_no_claim_outlives_what_it_comes_from(row: dict[str, Any]) -> None:
    """Of a page of results nothing is typed but words; of a test, the lines that hold it stand."""
    assert set(row) <= {"claim", "figure", "cases", "from", "held"}
    sources = [(ROOT / path).read_text(encoding="utf-8") for path in row["from"]]
    if claims.of_results(row):
        assert claims.commit(ROOT / row["from"][0])
        typed = claims.QUOTED.sub("", f"{row['figure']}{row.get('cases', '')}")
        assert not re.search(r"\d", typed), f"quoted from {row['from'][0]}, not typed: {typed}"
    else:
        assert row["held"]
        assert [line for line in row["held"] if not any(line in text for text in sources)] == []


PAGE_OF_RESULTS = """\
Made at `0123abc`: words that
go on.

* right, of all >= 95%: 96.1% (1407 of 1464) ok

| | x |
| - | - |
| b | 1 |

| | who | likely, half | half |
| :- | -: | -: | -: |
| b | 40, 360 | **9.5 %** | 2 |
| | 39, 8 | 11.2 % of c | 3 |
"""


def test_what_a_page_of_results_says_is_quoted_and_what_is_lost_refused(tmp_path: Path) -> None:
    page = tmp_path / "a.md"
    page.write_text(PAGE_OF_RESULTS)

    def quoted(figure: str) -> str:
        return claims.figure({"from": [str(page)], "figure": figure})

    assert quoted("{b|likely, half} left") == "9.5 % left"
    assert quoted("{39, 8|half}") == "3"
    assert quoted("{*|likely, half}; {+|who}") == "9.5 % to 11.2 %; 79"
    assert quoted("{right, of all|}; {words that go on|=}") == (
        "96.1% (1407 of 1464); words that go on"
    )
    assert claims.commit(page) == "0123abc"
    for lost in ("{c|half}", "{b|quarter}", "{*|quarter}", "{wrong|}", "{words that end|=}"):
        with pytest.raises(KeyError, match="has no"):
            quoted(lost)
    page.write_text("of no commit")
    with pytest.raises(KeyError, match="carries no commit"):
        claims.commit(page)


def test_what_the_page_of_tracks_says_of_wind_and_current_stands_on_its_page_of_results() -> None:
    path = claims.RESULTS / "wind_and_current.md"
    tests = ("full turn", "20/20", "10/10", "unread")
    found = [
        claims.figure(
            {"from": [str(path)], "figure": f"{{{t}|told apart}} {{{t}|held, where told}}"}
        )
        for t in tests
    ]
    told, right = zip(*(re.findall(r"([\d.]+)%", cells) for cells in found), strict=True)
    text = " ".join(source("track").split())
    assert (
        f"{told[0]} full turns, {told[1]} zig-zags of 20/20 and {told[2]} of 10/10 told, "
        f"right in {right[0]}, {right[1]} and {right[2]} %"
    ) in text
    assert f"{told[3]} full turns told, right in {right[3]} %" in text


# --- as they are shown --------------------------------------------------------------------------


def test_without_a_topic_each_is_listed_on_a_line() -> None:
    told = shown()
    assert told.exit_code == 0
    for topic, line in TOPICS.items():
        assert re.search(rf"^  {topic} +{re.escape(line)}$", told.output, re.MULTILINE)
    assert max(map(len, told.output.splitlines())) <= 80


@pytest.mark.parametrize("topic", TOPICS)
def test_into_a_pipe_a_page_goes_as_it_is(topic: str) -> None:
    told = shown(topic)
    assert told.exit_code == 0
    assert told.output == page(topic)
    assert "\x1b" not in told.output
    assert "<!--" not in told.output


@pytest.mark.parametrize("topic", TOPICS)
def test_a_terminal_of_eighty_columns_shows_all_of_a_page(
    topic: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("TERM", "dumb")
    text = re.sub(r"\x1b\[[0-9;]*m", "", guide_command._set(page(topic)))
    assert max(map(len, text.splitlines())) <= 80
    words = re.findall(r"[A-Za-z]{9,}", re.sub(r"\]\(\w+\.md\)", "]", page(topic)))
    joined = re.sub(r"\s+", "", text)
    assert [word for word in words if word not in joined] == []


@pytest.mark.parametrize(
    ("topic", "nearest"), [("pipline_file", "pipeline_file"), ("verdict", "verdicts")]
)
def test_a_wrong_topic_is_one_line_with_the_nearest(topic: str, nearest: str) -> None:
    told = shown(topic)
    assert told.exit_code == 2
    assert told.stderr.count("\n") == 1
    assert f"'{nearest}'" in told.stderr
    assert told.stdout == ""


def test_no_topic_leads_out_of_the_guide() -> None:
    for topic in ("../cli", "/etc/passwd", "generate", ""):
        with pytest.raises(TrialidError):
            page(topic)


def test_a_topic_may_be_written_in_other_ways() -> None:
    assert page("pipeline-file") == page("Pipeline file") == page("pipeline_file.md")


def test_every_page_is_its_own_topics() -> None:
    for topic in TOPICS:
        words = page(topic).splitlines()[0]
        assert words == next(s for s in source(topic).splitlines() if s.startswith("# ")), topic
    assert len({page(topic) for topic in TOPICS}) == len(TOPICS)
