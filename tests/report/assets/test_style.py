"""The style sheet: text that can be read, in the light and in the dark."""

import re
from importlib import resources

import pytest

SHEET = resources.files("trialid.report").joinpath("page.css").read_text(encoding="utf-8")
TEXT = ("ink", "soft", "link", "good", "warn", "unsure", "model-ink")
GRAPHICS = ("noise", "model", "predicted", "measured", "residual", "second")


def colours(part):
    return dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", part))


LIGHT = colours(SHEET[: SHEET.index("@media screen and (prefers-color-scheme: dark)")])
DARK = LIGHT | colours(SHEET[SHEET.index("prefers-color-scheme: dark") : SHEET.index("* {")])


def luminance(colour):
    """Relative luminance, WCAG 2.2."""
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one, other):
    low, high = sorted(map(luminance, (one, other)))
    return (high + 0.05) / (low + 0.05)


def test_contrast_is_that_of_the_standard():
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.005)


@pytest.mark.parametrize("scheme", [LIGHT, DARK], ids=["light", "dark"])
@pytest.mark.parametrize("text", TEXT)
@pytest.mark.parametrize("ground", ["paper", "raised", "mark"])
def test_text_stands_out_from_its_ground(scheme, text, ground):
    assert contrast(scheme[text], scheme[ground]) >= 4.5


@pytest.mark.parametrize("scheme", [LIGHT, DARK], ids=["light", "dark"])
@pytest.mark.parametrize("colour", GRAPHICS)
def test_bars_and_lines_stand_out_from_the_paper(scheme, colour):
    assert contrast(scheme[colour], scheme["paper"]) >= 3.0


def test_the_dark_is_another_scheme_and_never_on_paper():
    assert DARK["paper"] != LIGHT["paper"]
    assert "@media screen and (prefers-color-scheme: dark)" in SHEET
    assert SHEET.count("prefers-color-scheme") == 1


def test_text_is_coloured_by_what_was_tested():
    rules = re.findall(r"[{;\s]color: var\(--([\w-]+)\)", SHEET)
    assert set(rules) <= {*TEXT}


def test_motion_is_only_for_those_who_want_it():
    asked = SHEET.index("prefers-reduced-motion: no-preference")
    assert SHEET.index("scroll-behavior") > asked
    assert not re.search(r"\b(animation|transition)\b", SHEET)


def test_focus_is_seen():
    assert ":focus-visible { outline: 2px solid var(--link)" in SHEET
    assert "outline: none" not in SHEET
