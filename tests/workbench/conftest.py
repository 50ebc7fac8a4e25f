"""A pipeline at a desk, and a gate before its fits."""

from collections.abc import Iterator
from pathlib import Path

import pytest
import quick
from held import Gate

from trialid.workbench import compute
from trialid.workbench import desk as desk_module


@pytest.fixture
def quick_looks(monkeypatch: pytest.MonkeyPatch) -> None:
    """The desk looks at its files twenty times a second."""
    monkeypatch.setattr(desk_module, "POLL", 0.05)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return quick.write(tmp_path)


@pytest.fixture
def gate(monkeypatch: pytest.MonkeyPatch) -> Iterator[Gate]:
    made = Gate()
    monkeypatch.setattr(compute, "examine", made.examine)
    yield made
    made.open.set()
