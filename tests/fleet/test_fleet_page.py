"""The report of a fleet: what stands in its tables, and scales that one bad ship does not rule."""

import re
from dataclasses import replace

import numpy as np
from records_of_ships import rows_of

from trialid.fleet.batch import Batch
from trialid.fleet.changes import changes, remarks
from trialid.report.pages.fleet_page import fleet_page
from trialid.report.pictures.voyage_picture import voyage_picture


def rows_under(page: str, section: str) -> list[list[str]]:
    """The rows of a section's table, cell by cell."""
    part = re.search(rf'<section id="{section}".*?</section>', page, re.DOTALL)
    rows = re.findall(r"<tr>(.*?)</tr>", part[0] if part else "", re.DOTALL)
    return [re.findall(r">([^<]*)</t[hd]>", row) for row in rows][1:]


def test_effects_that_no_run_names_have_no_row() -> None:
    runs, fitted = rows_of(np.ones(8), range(0, 240, 30))
    own = {"verdict": "missing", "effect": "Kr", "family": "Kr, Kv, lag_r, scale_r"}
    named = [replace(row, **own) for row in runs[:3]]
    other = [replace(row, **{**own, "effect": "Kv", "family": "Kv, Kr"}) for row in runs[3:4]]
    page = fleet_page("fleet", [*named, *other, *runs[4:]], fitted, (), ())
    assert rows_under(page, "missing") == [["Kr", "3", "1", "4"], ["Kv", "1", "1", "4"]]


def test_one_run_a_ship_is_drawn_with_what_dots_and_lines_are() -> None:
    """`Drawn as above` stood where nothing was above."""
    runs, fitted = rows_of(np.ones(2), (0, 30))
    ships = {run.run: f"ship-{place}" for place, run in enumerate(runs)}
    runs = [replace(row, ship=ships[row.run]) for row in runs]
    page = fleet_page("f", runs, [replace(row, ship=ships[row.run]) for row in fitted], (), ())
    assert "Parameters over voyages" not in page
    assert "A dot is an estimate, its line the likely range" in page
    assert ">ship-0</span><span" in page


def test_what_varies_and_what_is_to_be_known_stand_in_tables_and_on_the_terminal(tmp_path) -> None:
    runs, fitted = rows_of(np.where(np.arange(16) % 2, 0.72, 0.9))
    found, known = tuple(changes(runs, fitted)), remarks(runs)
    page = fleet_page("fleet", runs, fitted, found, known)
    assert [row[2] for row in rows_under(page, "changes")] == ["varies"]
    assert rows_under(page, "remarks") == [["ann", known[0].words]]
    assert "no changes found" in page
    own = {"runs": tuple(runs), "fitted": tuple(fitted), "changes": found, "remarks": known}
    told = Batch(name="fleet", folder=tmp_path, anew=0, **own).sentence
    assert "changes found: 0; parameters that vary as neither a step nor a drift: 1" in told
    assert told.endswith(f"\nann: {known[0].words}")


def test_one_bad_ship_does_not_flatten_the_others() -> None:
    """Eight ships, one a hundred times off: hers are at the border, the others fill the picture."""
    x = np.repeat(np.linspace(0.5, 0.9, 8), 2)
    x[6:8] = 70.0
    _, fitted = rows_of(x)
    picture = voyage_picture("GM", fitted, [row.voyage for row in fitted], ())
    heights = np.array([each.y for each in picture.whiskers])
    others = np.delete(heights, [6, 7])
    assert np.ptp(others) > 30.0
    assert all(heights[6:8] == heights.min())
    assert picture.whiskers[6].words.startswith("ann 6: 70.0 m")


def test_a_step_that_few_voyages_show_is_drawn_whole() -> None:
    _, fitted = rows_of(np.where(np.arange(16) < 14, 0.8, 0.6))
    picture = voyage_picture("GM", fitted, [row.voyage for row in fitted], ())
    assert float(picture.bottom) < 0.6
    assert float(picture.top) > 0.8
