"""The system's chromium before a workbench that runs as a person starts it."""

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

CHROMIUM = shutil.which("chromium")
ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking"]
LAPTOP = {"width": 1366, "height": 768}
KEPT = os.environ.get("TRIALID_PICTURES")
"""A folder that screenshots are kept in, to be looked at."""


@contextmanager
def started(pipeline: Path, *options: str) -> Iterator[str]:
    """The command as typed in the pipeline's folder; its address."""
    command = [sys.executable, "-m", "trialid", "workbench", pipeline.name, "--port", "0"]
    running = subprocess.Popen(
        [*command, *options], cwd=pipeline.parent, stdout=subprocess.PIPE, text=True
    )
    try:
        assert running.stdout is not None
        found = re.search(r"http://\S+", running.stdout.readline())
        assert found is not None
        yield found[0]
    finally:
        running.kill()
        running.communicate()


@dataclass
class Screen:
    """A page of a workbench, and what went wrong on it."""

    page: Any
    address: str
    pictures: Path
    errors: list[str] = field(default_factory=list)

    def facts(self) -> dict[str, Any]:
        """The numbers behind what is shown."""
        place = self.address.partition("?")[0]
        return json.loads(self.page.request.get(f"{place}api/screen").body())["facts"]  # type: ignore[no-any-return]

    def number(self, percent: str) -> None:
        """Wait until the error number reads so."""
        self.page.locator("#error-number b").filter(has_text=percent).wait_for()

    def settled(self) -> None:
        """Wait until nothing is worked out any more."""
        self.page.locator("#working").wait_for(state="hidden")
        self.page.locator("[data-part] .stale").first.wait_for(state="detached")
        self.page.locator(".panels canvas").first.wait_for()

    def picture(self, name: str) -> None:
        """Keep what is to be seen."""
        place = self.pictures / f"{name}.png"
        self.page.screenshot(path=place)
        if KEPT:
            shutil.copy(place, KEPT)


@contextmanager
def opened(address: str, pictures: Path, **kind: Any) -> Iterator[Screen]:
    """A page of a workbench; it must have made no error when it is left."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        page = browser.new_context(**{"viewport": LAPTOP, **kind}).new_page()
        page.set_default_timeout(90_000)
        screen = Screen(page, address, pictures)
        page.on("pageerror", lambda error: screen.errors.append(str(error)))
        page.on("console", lambda said: _heard(screen, said))
        asked: list[str] = []
        page.on("request", lambda request: asked.append(request.url))
        page.goto(address)
        yield screen
        browser.close()
        assert not screen.errors
        place = address.partition("?")[0]
        assert all(url.startswith((place, "data:")) for url in asked)


def _heard(screen: Screen, said: Any) -> None:
    """A refused edit is an answer, which chromium reports as a failed load."""
    if said.type == "error" and "Failed to load resource" not in said.text:
        screen.errors.append(said.text)
