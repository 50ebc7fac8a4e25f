"""`trialid report`: what is written for one run and for several, and names that are markup."""

import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest
from test_bad_input import PIPELINE, Table, record, trialid_

from trialid.own_files import LIST

ROOT = Path(__file__).parent.parent
HOSTILE = "<script>alert(1)</script>"

__all__ = ["record"]


@pytest.fixture(scope="module")
def runs(record: Table, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two finished runs: `plain`, and `marked` whose log has a channel named as markup."""
    place = tmp_path_factory.mktemp("runs")
    ship = ROOT / "sample_data" / "ships" / "s175q.toml"
    (place / "ship.toml").write_bytes(ship.read_bytes())
    record.to_csv(place / "log.csv", index=False)
    text = PIPELINE.replace('free = ["Nr", "Ndelta"]', 'free = ["Nr", "Ndelta", "Nv"]')
    spoilt = record.rename(columns={"rot[deg/s]": f"{HOSTILE}[deg/s]"})
    spoilt.iloc[300:303, spoilt.columns.get_loc(f"{HOSTILE}[deg/s]")] = 30.0
    spoilt.to_parquet(place / "marked.parquet", index=False)
    (place / "plain.toml").write_text(PIPELINE, encoding="utf-8")
    (place / "marked.toml").write_text(
        text.replace("log.csv", "marked.parquet").replace('"rot"', f'"{HOSTILE}"')
        .replace('"zigzag"', f'"{HOSTILE}"'),
        encoding="utf-8",
    )  # fmt: skip
    for name in ("plain", "marked"):
        outcome = trialid_("run", str(place / f"{name}.toml"), "--quiet", "--out",
                           str(place / name))  # fmt: skip
        assert outcome.exit_code == 0, outcome.stderr
    return place


@pytest.fixture
def place(runs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in ("plain", "marked"):
        shutil.copytree(runs / name, tmp_path / name)
    return tmp_path


def written(*arguments: str) -> str:
    outcome = trialid_("report", *arguments)
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    return outcome.stdout


def test_the_page_is_the_runs_own_byte_for_byte(place: Path) -> None:
    first = (place / "plain" / "report.html").read_bytes()
    (place / "plain" / "report.html").unlink()
    assert written("plain").startswith("Report: plain/report.html\n")
    assert (place / "plain" / "report.html").read_bytes() == first


def test_nothing_but_the_page_tables_and_figures_is_written(place: Path) -> None:
    kept = {p.name: p.read_bytes() for p in (place / "plain").iterdir()}
    written("plain")
    now = {p.name for p in (place / "plain").iterdir()}
    assert now == {*kept, "tables", "figures"}
    same = {name: (place / "plain" / name).read_bytes() for name in kept}
    assert same | {LIST: b""} == kept | {LIST: b""}, "but for the list of our files"
    tables = {p.name for p in (place / "plain" / "tables").iterdir()}
    for name in ("parameters", "history", "validation", "logs", "error"):
        assert {f"{name}.csv", f"{name}.md", f"{name}.tex"} <= tables
    figures = {p.name for p in (place / "plain" / "figures").iterdir()}
    assert {"accuracy.svg", "history.svg", "error.svg", "trial-zigzag-r.svg"} <= figures


def test_it_goes_where_it_is_asked_to(place: Path) -> None:
    before = sorted(p.name for p in (place / "plain").iterdir())
    written("plain", "--out", "paper")
    assert {p.name for p in (place / "paper").iterdir()} == {
        "report.html",
        "tables",
        "figures",
        LIST,
    }
    assert sorted(p.name for p in (place / "plain").iterdir()) == before


def test_somebody_elses_report_is_not_replaced(place: Path) -> None:
    """One of this name was taken for an earlier one of ours."""
    own = place / "paper" / "report.html"
    own.parent.mkdir()
    own.write_text("mine", encoding="utf-8")
    outcome = trialid_("report", "plain", "--out", "paper")
    assert outcome.exit_code == 2
    assert "paper/report.html: is no file of trialid's and is not replaced" in outcome.stderr
    assert own.read_text(encoding="utf-8") == "mine"


def test_two_runs_side_by_side(place: Path) -> None:
    assert written("plain", "marked").startswith("Report: comparison/compare.html\n")
    folder = place / "comparison"
    assert {p.name for p in folder.iterdir()} == {"compare.html", "tables", "plain", "marked", LIST}
    text = (folder / "compare.html").read_text(encoding="utf-8")
    for words in ("plain", "marked", "Parameters by run", "differ", "Ndelta", "free Nv"):
        assert words in text
    head, *rows = (folder / "tables" / "parameters.csv").read_text("utf-8").splitlines()
    own = "{0},+- ({0}),likely from ({0}),likely to ({0})"
    runs = f"{own.format('plain')},{own.format('marked')}"
    assert head == f'parameter,unit,differ,"apart, in joint errors",{runs}'
    assert {row.split(",")[0] for row in rows} == {"Nr", "Ndelta", "Nv"}
    own = (place / "plain" / "report.html").read_bytes()
    assert (folder / "plain" / "report.html").read_bytes() == own


def test_a_hostile_name_in_a_log_is_text_everywhere(place: Path) -> None:
    """A channel is called so, and a trial."""
    written("plain", "marked")
    written("marked")
    pages = list((place / "comparison").rglob("*.html"))
    assert len(pages) == 3
    for page in pages:
        text = page.read_text(encoding="utf-8")
        assert HOSTILE not in text
        if "plain" not in page.parts:
            assert "&lt;script&gt;alert(1)" in text
            assert (
                "<code>&lt;script&gt;alert(1)&lt;/script&gt;</code>" in text or page.name[0] == "c"
            )
    table = (place / "marked" / "tables" / "signals.csv").read_text(encoding="utf-8")
    assert f"{HOSTILE},yaw rate r,{HOSTILE}" in table
    for path in (place / "comparison").rglob("*.svg"):
        assert "<script" not in path.read_text(encoding="utf-8")
        ElementTree.parse(path)
    for path in (place / "comparison").rglob("*.md"):
        assert not re.search(r"(?<!\\)<script", path.read_text(encoding="utf-8"))


def test_a_second_report_is_the_same_bytes(place: Path) -> None:
    written("plain", "marked")
    first = {p: p.read_bytes() for p in (place / "comparison").rglob("*") if p.is_file()}
    written("plain", "marked")
    assert {p: p.read_bytes() for p in (place / "comparison").rglob("*") if p.is_file()} == first


def test_latex_is_balanced(place: Path) -> None:
    """What a table may hold: one tabular, as many cells in each row, braces that close."""
    written("marked")
    for path in (place / "marked" / "tables").glob("*.tex"):
        text = re.sub(r"\\[{}]", "", path.read_text(encoding="utf-8"))
        assert text.count("{") == text.count("}"), path.name
        if path.name == "tables.tex":
            continue
        assert text.count(r"\begin{tabular}") == text.count(r"\end{tabular}") == 1
        rows = [line for line in text.splitlines() if line.endswith(r"\\")]
        cells = {len(re.findall(r"(?<!\\)&", row)) for row in rows}
        assert len(cells) == 1, path.name


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
@pytest.mark.parametrize("what", [("marked",), ("plain", "marked")])
def test_latex_compiles(place: Path, what: tuple[str, ...]) -> None:
    written(*what, "--out", "paper")
    done = subprocess.run(
        ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "tables.tex"],
        cwd=place / "paper" / "tables", capture_output=True, text=True, check=False, timeout=120,
        errors="replace",
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-2000:]
    assert (place / "paper" / "tables" / "tables.pdf").stat().st_size > 1000


@pytest.mark.parametrize(("arguments", "words"), [
    (("nowhere",), ("nowhere/result.json", "cannot be read", "finished `trialid run`")),
    (("plain", "--out", "marked"), ("marked", "folder of another run")),
    (("plain", "marked", "--out", "plain"), ("plain", "one of the runs")),
    (("plain", "--out", "plain/series.csv"), ("is a file",)),
])  # fmt: skip
def test_what_cannot_be_reported_is_one_line(
    place: Path, arguments: tuple[str, ...], words: tuple[str, ...]
) -> None:
    outcome = trialid_("report", *arguments)
    assert (outcome.exit_code, outcome.stdout) == (2, "")
    (line,) = outcome.stderr.splitlines()
    for word in words:
        assert word in line


def test_a_run_without_its_series_is_one_line(place: Path) -> None:
    (place / "plain" / "series.csv").unlink()
    outcome = trialid_("report", "plain")
    assert outcome.exit_code == 2
    assert len(outcome.stderr.splitlines()) == 1
