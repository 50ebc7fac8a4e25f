"""Pipelines, designs, ship files, templates and histories with a hand's slips in them."""

import pytest
from changed_texts import home, kinds, tried

KINDS = ("pipeline", "design", "ship file", "template", "history")


def check(tmp_path, name, count, seed):
    folder = home(tmp_path)
    kind = next(k for k in kinds(folder) if k.name == name)
    row = tried(kind, folder, count, seed)
    assert row.offending == ()
    assert row.read + row.refused == count
    assert row.read > 0
    assert name == "history" or row.refused > row.read


@pytest.mark.parametrize("name", KINDS)
def test_some_changed_texts(tmp_path, name):
    check(tmp_path, name, 100, 11)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("name", KINDS)
def test_many_changed_texts(tmp_path, name):
    check(tmp_path, name, 4000, 12)
