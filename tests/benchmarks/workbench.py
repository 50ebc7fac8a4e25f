"""How quick the workbench is: on the shipped sample, and on five trials of 100 000 samples.

    python tests/benchmarks/workbench.py [--large] [--only-large] [--out FILE]

Wall seconds as a person waits them, in the system's chromium, and what the server took of a
processor by then, which others on the machine do not change: from the command to the page and to
the first picture, a zoom, an effect added until curves and error number are new and until all is
known again; the memory of server and page. Without chromium nothing is measured.
Exit status 1 where the sample's page is not ready within four seconds of the command, or its
curves are not redrawn within three of a click.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import workbench_trials

ROOT: Final = Path(__file__).resolve().parents[2]
MISSING: Final = "righting_arm_cubic"
ARGUMENTS: Final = ["--no-sandbox", "--disable-gpu", "--disable-background-networking"]
PATIENCE: Final = 600_000  # ms
READY: Final = 4.0
REDRAWN: Final = 3.0
ZOOM: Final = """async () => {
  const panels = document.querySelector(".panels");
  const frame = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
  await frame();
  const began = performance.now();
  panels.dispatchEvent(new KeyboardEvent("keydown", { key: "+", bubbles: true }));
  await frame();
  return performance.now() - began;
}"""
"""Milliseconds from a key to the frame in which all panels are drawn again."""

Row = tuple[str, ...]


def measured(pipeline: Path) -> tuple[list[Row], dict[str, float]]:
    """What a person waits for, in words; the wall seconds by name."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=shutil.which("chromium"), args=ARGUMENTS)
        page = browser.new_page(viewport={"width": 1366, "height": 768})
        page.set_default_timeout(PATIENCE)
        return story(page, pipeline)


def story(page: Any, pipeline: Path) -> tuple[list[Row], dict[str, float]]:
    """The page opened, zoomed, an effect added."""
    seconds: dict[str, tuple[float, float]] = {}
    began, before = time.perf_counter(), 0.0

    def passed(name: str) -> None:
        seconds[name] = (time.perf_counter() - began, processor(process.pid) - before)

    with served(pipeline) as (process, address):
        passed("address")
        page.goto(address)
        passed("page")
        page.locator(".panels canvas").nth(5).wait_for()
        passed("picture")
        page.locator("#error-number b").wait_for()
        passed("fitted")
        settle(page)
        passed("all known")
        first = f"{peak(process.pid):.0f} MB"
        zooms = sorted(float(page.evaluate(ZOOM)) for _ in range(5))
        old = page.locator("#error-number b").inner_text()
        began, before = time.perf_counter(), processor(process.pid)
        page.get_by_role("button", name=f"Add {MISSING}").click()
        page.locator("#error-number b").filter(has_not_text=old).wait_for()
        passed("redrawn")
        settle(page)
        passed("known again")
        new = page.locator("#error-number b").inner_text()
        memory = [first, f"{peak(process.pid):.0f} MB", f"{heap(page):.0f} MB"]
    rows = rows_of(seconds, zooms[2], f"{old} to {new}", memory)
    return rows, {name: wall for name, (wall, _) in seconds.items()}


def rows_of(
    seconds: dict[str, tuple[float, float]], zoom: float, fell: str, memory: list[str]
) -> list[Row]:
    """What was waited for, in words."""

    def row(words: str, name: str) -> Row:
        wall, took = seconds[name]
        return (words, f"{wall:.1f} s", f"{took:.1f} s")

    return [
        row("command to address", "address"),
        row("command to page", "page"),
        row("command to first picture (measured)", "picture"),
        row("command to first fit (predicted, error)", "fitted"),
        row("command to ranking and all else", "all known"),
        ("zoom of all panels, median of 5", f"{zoom:.0f} ms", ""),
        row(f"add {MISSING} to new curves and error ({fell})", "redrawn"),
        row("add to ranking and all else", "known again"),
        ("memory of the server, at most: until all is known", memory[0], ""),
        ("... and after the addition", memory[1], ""),
        ("memory of the page's script", memory[2], ""),
    ]


@contextmanager
def served(pipeline: Path) -> Iterator[tuple["subprocess.Popen[str]", str]]:
    """The command in the pipeline's folder, and its address."""
    command = [sys.executable, "-m", "trialid", "workbench", pipeline.name, "--port", "0"]
    process = subprocess.Popen(command, cwd=pipeline.parent, stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        found = re.search(r"http://\S+", process.stdout.readline())
        assert found is not None, "the workbench gave no address"
        yield process, found[0]
    finally:
        process.kill()
        process.communicate()


def settle(page: Any) -> None:
    """Wait until nothing is worked out any more and nothing shown is of another model."""
    page.locator("#working").wait_for(state="hidden")
    page.locator("[data-part] .stale").first.wait_for(state="detached")


def peak(process: int) -> float:
    """Most memory that a process has held [MB]."""
    status = Path(f"/proc/{process}/status").read_text(encoding="ascii")
    found = re.search(r"VmHWM:\s+(\d+) kB", status)
    return int(found[1]) / 1024 if found else float("nan")


def processor(process: int) -> float:
    """Seconds that a process has had of a processor."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def heap(page: Any) -> float:
    """Memory of a page's own values [MB]."""
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable")
    metrics = session.send("Performance.getMetrics")["metrics"]
    return next(m["value"] for m in metrics if m["name"] == "JSHeapUsedSize") / 1e6


def table(title: str, rows: list[Row]) -> str:
    """A table in Markdown."""
    heads = ["| | waited | processor |", "|---|---:|---:|"]
    lines = [f"## {title}", "", *heads, *(f"| {' | '.join(row)} |" for row in rows)]
    return "\n".join([*lines, ""])


def main() -> int:
    """Measure, print, and judge."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--large", action="store_true", help="five trials of 100 000 samples too")
    parser.add_argument("--only-large", action="store_true", help="these only")
    parser.add_argument("--out", type=Path, help="write the tables to this file too")
    asked = parser.parse_args()
    if shutil.which("chromium") is None:
        print("no chromium: nothing measured")
        return 0
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        for part in ("pipelines", "sample_data"):
            shutil.copytree(ROOT / part, place / part)
        said, seconds = list[str](), {"page": 0.0, "redrawn": 0.0}
        if not asked.only_large:
            rows, seconds = measured(place / "pipelines" / "hidden_effect.toml")
            said.append(table("The shipped sample: four trials of 2399 samples", rows))
        if asked.large or asked.only_large:
            (place / "long").mkdir()
            long, _ = measured(workbench_trials.written(place / "long", 5, 100_000))
            said.append(table("Five trials of 100 000 samples, 10 a second", long))
    text = "# The workbench, as a person waits for it\n\n" + "\n".join(said)
    print(text)
    if asked.out:
        asked.out.write_text(text, encoding="utf-8")
    return int(seconds["page"] > READY or seconds["redrawn"] > REDRAWN)


if __name__ == "__main__":
    sys.exit(main())
