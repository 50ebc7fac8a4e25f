"""The whole story in a browser: see the error, read what is missing, add it, see it fall."""

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import browser
import pytest

pytest.importorskip("playwright.sync_api")
pytestmark = pytest.mark.skipif(browser.CHROMIUM is None, reason="needs chromium")

ROOT = Path(__file__).parent.parent.parent
MISSING = "righting_arm_cubic"


@pytest.fixture
def sample(tmp_path: Path) -> Path:
    return copy_of_the_sample(tmp_path)


@pytest.fixture(scope="module")
def untouched(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a workbench that is only looked at."""
    with browser.started(copy_of_the_sample(tmp_path_factory.mktemp("untouched"))) as address:
        yield address


def copy_of_the_sample(folder: Path) -> Path:
    for part in ("pipelines", "sample_data"):
        ignored = shutil.ignore_patterns("runs", "*.history.jsonl")
        shutil.copytree(ROOT / part, folder / part, ignore=ignored)
    return folder / "pipelines" / "hidden_effect.toml"


def run_of(pipeline: Path) -> dict:
    """What the command line makes of a pipeline."""
    command = [sys.executable, "-m", "trialid", "run", pipeline.name, "--json"]
    done = subprocess.run(command, cwd=pipeline.parent, capture_output=True, check=True)
    return json.loads(done.stdout)


@pytest.mark.study(turn=3)
def test_the_whole_story(sample: Path, tmp_path: Path) -> None:
    before = sample.read_bytes()
    with (
        browser.started(sample) as address,
        browser.opened(address, tmp_path) as screen,
    ):
        page = screen.page
        screen.number("5.44")
        screen.settled()
        screen.picture("opened")
        assert page.locator(".trial-tabs [role=tab]").count() == 4
        assert page.locator(".panels canvas").count() >= 6
        assert MISSING in page.locator("[data-part=verdict]").inner_text()
        first = page.locator("[data-part=missing] [data-key]").first
        assert MISSING in page.locator("[data-part=missing]").inner_text()
        assert first.is_visible()

        page.get_by_role("button", name=f"Add {MISSING}").click()
        screen.number("3.84")
        assert MISSING in sample.read_text(encoding="utf-8")
        screen.settled()
        screen.picture("added")
        assert "5.44" in page.locator("[data-part=error]").inner_text()
        assert page.locator("[data-part=history] tr").count() >= 2
        added = screen.facts()
        assert added["eps_rmsn"] < 0.0385
        assert added["undermodelling"] < 0.4 * 0.043

        page.get_by_role("tab", name="Model").click()
        page.get_by_role("button", name=f"Drop {MISSING}").click()
        screen.number("5.44")
        screen.settled()
        assert sample.read_bytes() == before
        screen.picture("dropped")

        page.get_by_role("button", name=re.compile("^Undo")).click()
        screen.number("3.84")
        screen.settled()
        assert screen.facts() == added
        export(page, "grown.toml")
    exported = sample.with_name("grown.toml")
    done = run_of(exported)
    assert done["fit"]["eps_rmsn"] == added["eps_rmsn"]
    assert done["fit"]["eps_rmsn_check"] == added["eps_rmsn_check"]
    assert done["split"]["noise"] == added["noise"]
    assert done["split"]["undermodelling"] == added["undermodelling"]
    assert done["model"]["effects"] == added["effects"]
    report = (sample.parent / "runs" / "hidden_effect" / "report.html").read_text(encoding="utf-8")
    assert MISSING in report


def export(page, name: str) -> None:
    """A copy of the pipeline under a name, and the run's folder."""
    page.locator("#export summary").click()
    page.get_by_label("Copy of the pipeline, beside it").fill(name)
    page.get_by_role("button", name="Save the copy").click()
    page.locator("#exported").filter(has_text=name).wait_for()
    page.get_by_role("button", name="Write the run's folder with its report").click()
    page.locator("#exported").filter(has_text="report.html").wait_for()


@pytest.mark.study(turn=3)
def test_by_keyboard_alone_in_the_dark(sample: Path, tmp_path: Path) -> None:
    with (
        browser.started(sample) as address,
        browser.opened(address, tmp_path, color_scheme="dark") as screen,
    ):
        page = screen.page
        screen.number("5.44")
        screen.settled()
        button = page.get_by_role("button", name=f"Add {MISSING}")
        for _ in range(200):
            page.keyboard.press("Tab")
            if button.evaluate("each => each === document.activeElement"):
                break
        page.keyboard.press("Enter")
        screen.number("3.84")
        screen.settled()
        screen.picture("dark")
        page.keyboard.press("Control+z")
        screen.number("5.44")
        tab = page.locator(".trial-tabs [role=tab]").first
        tab.focus()
        page.keyboard.press("ArrowRight")
        page.keyboard.press("Enter")
        page.locator(".trial-tabs [role=tab][aria-selected=true]").filter(
            has_text="zigzag-20"
        ).wait_for()
        dark = page.evaluate("getComputedStyle(document.body).backgroundColor")
        assert sum(map(int, re.findall(r"\d+", dark)[:3])) < 150


@pytest.mark.study(turn=8)
def test_zooming_moves_all_panels_together(sample: Path, tmp_path: Path) -> None:
    with browser.started(sample) as address, browser.opened(address, tmp_path) as screen:
        page = screen.page
        screen.number("5.44")
        screen.settled()
        page.locator(".panels[data-drawn$=diagnosed]").wait_for()  # no plot is replaced any more
        canvas = page.locator(".panels .u-over").nth(2)
        box = canvas.bounding_box()
        page.mouse.move(box["x"] + 0.25 * box["width"], box["y"] + 20)
        page.mouse.down()
        page.mouse.move(box["x"] + 0.50 * box["width"], box["y"] + 20, steps=5)
        page.mouse.up()
        told = page.locator("output.window").inner_text()
        low, high = map(float, re.findall(r"[\d.]+(?= s)", told))
        assert 250 < low < 350
        assert 550 < high < 650
        screen.picture("zoomed")
        page.get_by_role("button", name=f"Add {MISSING}").click()
        screen.number("3.84")
        screen.settled()
        assert page.locator("output.window").inner_text() == told  # a refit keeps the window


@pytest.mark.study(turn=6)
def test_two_windows_do_not_lose_each_others_edits(sample: Path, tmp_path: Path) -> None:
    with browser.started(sample) as address, browser.opened(address, tmp_path) as screen:
        page, other = screen.page, screen.page.context.new_page()
        screen.number("5.44")
        screen.settled()
        other.goto(address)
        page.get_by_role("button", name=f"Add {MISSING}").click()
        other.locator("#error-number b").filter(has_text="3.84").wait_for()
        other.get_by_role("tab", name="Model").click()
        other.get_by_role("button", name="Drop roll_rate_yaw").click()
        page.locator("#undo", has_text="Undo").and_(
            page.locator("[title*=roll_rate_yaw]")
        ).wait_for()
        screen.settled()
        text = sample.read_text(encoding="utf-8")
        assert MISSING in text
        assert "roll_rate_yaw" not in text


@pytest.mark.study(turn=9)
def test_a_mistake_is_told_where_it_was_made(sample: Path, tmp_path: Path) -> None:
    with browser.started(sample) as address, browser.opened(address, tmp_path) as screen:
        page = screen.page
        screen.number("5.44")
        screen.settled()
        before = sample.read_bytes()
        page.get_by_role("tab", name="Model").click()
        page.get_by_label("Yv, lower bound").fill("0,5")
        page.keyboard.press("Enter")
        page.locator(".complaint").first.wait_for()
        screen.picture("complaint")
        sample.write_bytes(before.replace(b"period = 0.5", b"peroid = 0.5"))
        banner = page.locator("#banner").filter(has_text="did you mean 'period'")
        banner.wait_for()
        screen.picture("banner")
        sample.write_bytes(before)
        page.locator("#banner").wait_for(state="hidden")


@pytest.mark.study(turn=4)
def test_a_refit_is_cancelled(sample: Path, tmp_path: Path) -> None:
    before = sample.read_bytes()
    with browser.started(sample) as address, browser.opened(address, tmp_path) as screen:
        screen.number("5.44")
        screen.settled()
        screen.page.get_by_role("button", name=f"Add {MISSING}").click()
        screen.page.get_by_role("button", name="Cancel").click()
        screen.page.locator("#undo[disabled]").wait_for()
        screen.settled()
        screen.number("5.44")
    assert sample.read_bytes() == before


@pytest.mark.parametrize("width", [800, 1366, 1920])
@pytest.mark.study(turn="each")
def test_it_fits_the_screen(untouched: str, tmp_path: Path, width: int) -> None:
    size = {"width": width, "height": 900}
    with browser.opened(untouched, tmp_path, viewport=size) as screen:
        screen.number("5.44")
        screen.settled()
        screen.picture(f"width-{width}")
        wide = screen.page.evaluate("document.documentElement.scrollWidth")
        assert wide <= width


LEGENDS_OUTSIDE = """() => [...document.querySelectorAll(".panel")].flatMap((panel) => {
  const edge = panel.getBoundingClientRect();
  return [...panel.querySelectorAll(".top b, .u-series")].filter((each) => {
    const box = each.getBoundingClientRect();
    return box.left < edge.left - 1 || box.right > edge.right + 1;
  }).map((each) => each.textContent);
})"""


@pytest.mark.parametrize("width", [390, 1024, 1366])
@pytest.mark.study(turn=1)
def test_title_verdict_and_legends_are_whole(untouched: str, tmp_path: Path, width: int) -> None:
    """On a phone in one column, the verdict before the plots."""
    size = {"width": width, "height": 800}
    with browser.opened(untouched, tmp_path, viewport=size) as screen:
        page = screen.page
        screen.number("5.44")
        screen.settled()
        screen.picture(f"whole-{width}")
        title = page.locator("#bar h1")
        assert title.evaluate("e => e.scrollWidth <= e.clientWidth")
        assert page.evaluate(LEGENDS_OUTSIDE) == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        tops = [
            page.locator(each).first.bounding_box()["y"]
            for each in ("#error-number", ".verdict .sentence", ".panels", ".candidates")
        ]
        if width < 1000:
            assert tops == sorted(tops)
            head = page.locator(".candidate summary .name").first.bounding_box()
            assert head["height"] < 60  # a name is not broken into a column of syllables


@pytest.mark.study(turn=8)
def test_signals_stay_chosen_and_what_is_seen_is_saved(sample: Path, tmp_path: Path) -> None:
    with browser.started(sample) as address, browser.opened(address, tmp_path) as screen:
        page = screen.page
        screen.number("5.44")
        screen.settled()
        panels = page.locator("#trial .panel:visible")
        before = panels.count()
        page.locator("#trial .signals summary").click()
        page.locator('[data-signal="rudder angle"]').uncheck()
        page.locator('[data-signal="residual of r"]').uncheck()
        page.keyboard.press("Escape")
        assert panels.count() == before - 2
        page.get_by_role("button", name=f"Add {MISSING}").click()
        screen.number("3.84")
        screen.settled()
        page.locator(".panels[data-drawn$=diagnosed]").wait_for()
        assert panels.count() == before - 2  # a refit keeps the choice
        assert "model before" in panels.nth(1).inner_text()
        page.get_by_role("tab", name="zigzag-20").click()
        page.locator(".panels canvas").first.wait_for()
        assert panels.count() == before - 2
        with page.expect_download() as download:
            page.get_by_role("button", name="Save picture").click()
        assert download.value.suggested_filename == "zigzag-20.png"
        assert Path(download.value.path()).read_bytes().startswith(b"\x89PNG")
        page.locator("#trial .signals summary").click()
        page.locator('[data-signal="rudder angle"]').check()
        assert panels.count() == before - 1
        assert panels.first.locator("canvas").count() == 1
