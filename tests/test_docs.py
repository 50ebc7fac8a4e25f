"""What the documents promise is there: commands, paths, versions; and nothing of one machine."""

import fnmatch
import re
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

import trialid
from trialid.cli.main import commands

ROOT = Path(__file__).parent.parent
README = ROOT / "README.md"
GUIDE = ROOT / "trialid" / "guide"
CHANGELOG = ROOT / "CHANGELOG.md"

RUN = "trialid run pipelines/hidden_effect.toml"
LEFT_ALONE = {".git", ".venv", "build", "dist", "runs", "trialid-demo"}
"""Folders that are not of the project; so are those that begin with a dot and end in cache."""

FOREIGN = re.compile(
    rb"(?<![\w.-])/(?:work|root|home|Users)/[\w.]"  # somebody's own folder
    rb"|https?://[\w.-]*(?:pypi|registry|artifactory|nexus|mirror|proxy)[\w.-]*"
    rb"|index[-]url"
)
PUBLIC = re.compile(rb"https://p[y]pi\.org/project/")


def readme() -> str:
    return README.read_text(encoding="utf-8")


def guide() -> str:
    """Every page of the guide, one after another."""
    return "\n".join(path.read_text(encoding="utf-8") for path in sorted(GUIDE.glob("*.md")))


def blocks(language: str, text: str | None = None) -> list[str]:
    """Fenced blocks in one language, of the README if no text is given."""
    text = readme() if text is None else text
    return re.findall(rf"^```{language}\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE)


def files() -> list[Path]:
    """Every file of the project, what tools leave behind apart."""
    return [p for p in sorted(ROOT.rglob("*")) if p.is_file() and not _ignored(p)]


def _ignored(path: Path) -> bool:
    patterns = ("__pycache__", ".*cache*", ".hypothesis", "*.egg-info")
    return any(
        part in LEFT_ALONE or any(fnmatch.fnmatch(part, pattern) for pattern in patterns)
        for part in path.relative_to(ROOT).parts
    )


# --- commands -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", sorted(commands.commands))
def test_every_command_has_help_and_is_in_the_manual(name: str) -> None:
    command = commands.commands[name]
    assert (command.help or "").strip()
    for option in command.params:
        assert getattr(option, "help", None) or option.param_type_name == "argument", option.name
    shown = CliRunner().invoke(commands, [name, "--help"], prog_name="trialid")
    assert shown.exit_code == 0
    assert f"trialid {name}" in readme() + guide()


def test_the_manual_names_no_command_that_is_not_there() -> None:
    """A bare name in a list of plans may be of one that is not there yet."""
    text = readme() + guide()
    code = "\n".join([*blocks("sh", text), *re.findall(r"`(trialid [a-z]+ [^`]*)`", text)])
    named = set(re.findall(r"(?:^|[\s/])trialid ([a-z]+)", code))
    assert named - set(commands.commands) == set()


def test_the_readme_has_the_command_that_runs_the_example() -> None:
    (command,) = [block for block in blocks("sh") if RUN in block]
    assert len(command.strip().replace("\\\n", " ").splitlines()) == 1
    assert "pip install" in command
    pipeline = RUN.rpartition(" ")[2]
    assert (ROOT / pipeline).is_file()


def test_the_readme_has_the_command_that_runs_the_tests() -> None:
    tests = [block for block in blocks("sh") if re.search(r"\bpytest\b", block)]
    assert len(tests) == 1
    assert len(tests[0].strip().replace("\\\n", " ").splitlines()) == 1
    extras = re.findall(r"\.\[(\w+)\]", tests[0])
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert extras
    assert set(extras) <= set(project["optional-dependencies"])


# --- the README's other promises ----------------------------------------------------------------


def linked() -> list[str]:
    """Targets of the README's links and pictures, and every path in code quotes."""
    targets = re.findall(r"\]\(([^)\s]+)\)", readme())
    tops = "|".join(re.escape(path.name) for path in ROOT.iterdir() if not _ignored(path))
    quoted = re.findall(rf"`((?:{tops})(?:/[\w./-]*)?)`", readme())
    return [t.partition("#")[0] for t in (*targets, *quoted) if "://" not in t and t[0] != "#"]


def test_what_the_readme_points_to_is_there() -> None:
    assert [path for path in linked() if not (ROOT / path).exists()] == []


def test_headings_the_readme_links_to_are_there() -> None:
    titles = re.findall(r"^#+ (.*)$", readme(), flags=re.MULTILINE)
    anchors = {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}
    assert set(re.findall(r"\]\(#([^)]+)\)", readme())) <= anchors


def test_the_changelog_tells_of_this_version() -> None:
    titles = re.findall(r"^## (.*)$", CHANGELOG.read_text(encoding="utf-8"), flags=re.MULTILINE)
    version = re.escape(trialid.__version__)
    assert [t for t in titles if re.search(rf"(?<![\d.]){version}(?![\d.])", t)]
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["version"] == trialid.__version__


# --- nothing of one machine ---------------------------------------------------------------------


@pytest.mark.parametrize("line", [
    b"see /wo" + b"rk/shared", b"'/ro" + b"ot/x'", b"/ho" + b"me/me/x",
    b"https://py" + b"pi.inner.example/simple", b"--index" + b"-url x",
])  # fmt: skip
def test_the_search_finds_what_is_of_one_machine(line: bytes) -> None:
    assert FOREIGN.search(line)


def test_no_file_names_a_place_of_one_machine() -> None:
    found = {}
    for path in files():
        content = PUBLIC.sub(b"", path.read_bytes())
        if match := FOREIGN.search(content):
            found[str(path.relative_to(ROOT))] = match[0]
    assert found == {}
