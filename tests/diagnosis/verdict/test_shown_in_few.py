"""What stands out in few blocks is told before what trials held out deny."""

from dataclasses import replace

import pytest
from made_up_fits import BEFORE, NO_ROUTE, fit, refit

from trialid.diagnosis import objections
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.verdict import decide


@pytest.mark.parametrize(
    ("eps", "check", "told"),
    [(0.07, 0.15, "few"), (0.097, 0.195, "denied"), (0.07, 0.21, "denied")],
)
def test_what_shows_in_few_blocks_is_told_before_what_is_denied(eps, check, told):
    """By far more, of trials held out too: half of the squared error, where that takes a tenth."""
    denied = refit("denied", 0.88, 0.095, check=0.4)
    few = refit("few", 0.8, eps, check=check)
    after = tuple(x * (0.1 if k < 2 else 1.01) for k, x in enumerate(BEFORE))
    few = replace(few, carried=Carried(BEFORE, after))
    found = decide(fit(0.10, 0.20), (), [denied, few], NO_ROUTE, None, 0.05)
    assert found.kind == "cannot tell"
    assert found.effect is None
    assert ("with few the error falls" in found.sentence) is (told == "few")
    assert ("in 2 of" in found.sentence) is (told == "few")
    assert ("denied lowers the squared error" in found.sentence) is (told == "denied")


@pytest.mark.parametrize("flaw", ["no value of a ship", "in no block"])
def test_nobody_is_sent_to_what_no_ship_has_or_no_block_shows(monkeypatch, flaw):
    few = refit("few", 0.8, 0.07, check=0.15)
    shown = [0.1 if k < 2 and flaw != "in no block" else 1.5 for k in range(len(BEFORE))]
    few = replace(
        few, carried=Carried(BEFORE, tuple(x * y for x, y in zip(BEFORE, shown, strict=True)))
    )
    if flaw == "no value of a ship":
        monkeypatch.setattr(
            objections, "NO_SUCH_VALUE", (lambda effect, fit: effect.name == "few",)
        )
    denied = refit("denied", 0.88, 0.095, check=0.4)
    found = decide(fit(0.10, 0.20), (), [denied, few], NO_ROUTE, None, 0.05)
    assert "with few" not in found.sentence
