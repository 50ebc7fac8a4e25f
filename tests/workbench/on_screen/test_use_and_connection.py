"""Small things of the page in a browser, before a quick pipeline."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import browser
import pytest
import quick
from browser import Screen
from quick import ADDED, Address

from trialid.workbench.desk import Desk

pytest.importorskip("playwright.sync_api")
pytestmark = pytest.mark.skipif(browser.CHROMIUM is None, reason="needs chromium")

NARROW = {"width": 800, "height": 900}
PATIENCE = 20_000
"""[ms] for what takes a second or two."""
TOKENS = ("the-first-token", "the-second-token")


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Desk]:
    with quick.opened(quick.write(tmp_path / "alone")) as found:
        quick.diagnosed(found)
        yield found


@pytest.fixture
def screen(desk: Desk, tmp_path: Path) -> Iterator[Screen]:
    with quick.serving(desk) as address, browser.opened(where(address), tmp_path) as found:
        found.page.set_default_timeout(PATIENCE)
        found.settled()
        yield found


def where(address: Address, token: str = "") -> str:
    asked = f"?token={token}" if token else ""
    return f"http://127.0.0.1:{address.port}/{asked}"


def used(page: Any) -> Any:
    """The page with the model in use open."""
    page.get_by_role("tab", name="Use it").click()
    return page


def sail(page: Any, orders: str) -> None:
    page.get_by_label("Try a manoeuvre").fill(orders)
    page.keyboard.press("Enter")


def test_gains_of_an_autopilot_are_saved(screen: Screen) -> None:
    page = used(screen.page)
    rudder, save = page.locator("[name=full_rudder]"), "Save ArduPilot's gains"
    rudder.fill("abc")
    page.get_by_role("button", name=save).click()
    told = page.locator("#use .complaint").filter(has_text="expected a number above 0")
    told.wait_for()
    below = told.bounding_box()
    assert below["y"] + below["height"] <= browser.LAPTOP["height"]  # it is seen, not only there
    rudder.fill("35")
    with page.expect_download() as download:
        page.get_by_role("button", name=save).click()
    assert "ATC_STR_RAT_FF," in Path(download.value.path()).read_text(encoding="utf-8")
    assert download.value.suggested_filename.endswith(".param")
    assert told.count() == 0


def test_a_file_of_the_model_is_saved(screen: Screen) -> None:
    page = used(screen.page)
    with page.expect_download() as download:
        page.get_by_role("link", name="ship", exact=True).click()
    assert "uncertainty" in Path(download.value.path()).read_text(encoding="utf-8")


def test_a_file_that_is_refused_is_told_in_its_row(screen: Screen) -> None:
    page = used(screen.page)
    page.route("**/model/pid", lambda route: route.fulfill(status=400, json={"error": "no pid"}))
    page.get_by_role("link", name="pid").click()
    page.locator(".hand-over li", has_text="autopilot").locator(".complaint").wait_for()


@pytest.mark.study(turn="each")
def test_on_a_narrow_screen_the_panel_is_below_its_tab(desk: Desk, tmp_path: Path) -> None:
    with (
        quick.serving(desk) as address,
        browser.opened(where(address), tmp_path, viewport=NARROW) as screen,
    ):
        screen.settled()
        for name, panel in (("Use it", "#use"), ("Model", "#model")):
            tab = screen.page.get_by_role("tab", name=name, exact=True)
            tab.click()
            assert tab.bounding_box()["y"] < screen.page.locator(panel).bounding_box()["y"]


@pytest.mark.study(turn="each")
def test_what_was_sailed_says_when_it_is_of_an_earlier_model(screen: Screen) -> None:
    page = used(screen.page)
    sail(page, "circle 20")
    page.locator("#tried table").wait_for()
    earlier = page.locator("#tried .warn")
    assert earlier.count() == 0
    page.get_by_role("tab", name="What is missing").click()
    page.get_by_role("button", name=f"Add {ADDED}").click()
    earlier.wait_for(state="attached")
    screen.settled()
    used(page)
    assert earlier.count() == 1
    sail(page, "circle 20")
    earlier.wait_for(state="detached")
    page.locator("#tried table").wait_for()
    assert earlier.count() == 0


def test_a_refused_name_is_no_banner_of_another_tab(screen: Screen) -> None:
    page, banner = screen.page, screen.page.locator("#banner")
    page.locator("#another").fill("righting_arm_cubi")
    page.keyboard.press("Enter")
    told = page.locator("#missing .complaint")
    told.wait_for()
    page.get_by_role("tab", name="Model").click()
    assert not banner.is_visible()
    page.get_by_role("tab", name="What is missing").click()
    assert told.is_visible()


@pytest.mark.study(turn="each")
def test_a_server_that_stopped_or_was_started_anew_is_told(desk: Desk, tmp_path: Path) -> None:
    """The old page lives again as soon as the new address is open in the same browser."""
    first, second = TOKENS
    with ExitStack() as later:
        with quick.serving(desk, first) as address:
            opened = browser.opened(where(address, first), tmp_path)
            screen = later.enter_context(opened)
            screen.settled()
        screen.page.set_default_timeout(PATIENCE)
        page, banner = screen.page, screen.page.locator("#banner")
        banner.filter(has_text="No connection to trialid").wait_for()
        page.get_by_role("button", name=f"Add {ADDED}").click()
        page.wait_for_timeout(300)
        assert banner.inner_text().startswith("No connection to trialid")
        assert page.locator(".complaint").count() == 0
        again = later.enter_context(quick.serving(desk, second, address.port))
        banner.filter(has_text="Open the address").wait_for()
        page.context.new_page().goto(where(again, second))
        banner.wait_for(state="hidden")
