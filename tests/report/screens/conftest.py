"""The system's chromium, which opens a text as a page and hears what goes wrong on it."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking"]


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    playwright = pytest.importorskip("playwright.sync_api")
    chromium = shutil.which("chromium")
    if chromium is None:
        pytest.skip("needs chromium")
    with playwright.sync_playwright() as play:
        opened = play.chromium.launch(executable_path=chromium, args=ARGUMENTS)
        yield opened
        opened.close()


@pytest.fixture
def opened(browser: Any, tmp_path: Path) -> Iterator[Any]:
    """Opens a text as a page of a width; no page may ask for anything or make an error."""
    wrong: list[str] = []

    def show(text: str, width: int) -> Any:
        path = tmp_path / "page.html"
        path.write_text(text, encoding="utf-8")
        touch = {"has_touch": True, "is_mobile": True} if width < 500 else {}
        size = {"width": width, "height": 20_000}  # plots are drawn where they are seen
        page = browser.new_context(viewport=size, accept_downloads=True, **touch).new_page()
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda said: said.type == "error" and wrong.append(said.text))
        page.on("request", lambda each: each.url.startswith("http") and wrong.append(each.url))
        page.goto(path.as_uri())
        page.set_default_timeout(10_000)
        page.locator(".panels canvas").first.wait_for()
        return page

    yield show
    for context in browser.contexts:
        context.close()
    assert wrong == []
