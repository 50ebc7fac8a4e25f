"""An effect that leaves far less, though its search never arrived, comes before a contradiction."""

from dataclasses import replace

from made_up_fits import NO_ROUTE, fit, refit

from trialid.diagnosis.verdict import decide


def decided(*refits):
    found = decide(fit(0.28, 0.14), [r.candidate for r in refits], refits, NO_ROUTE, None, 0.05)
    return found.kind, found.sentence


def test_a_gear_whose_search_has_not_arrived_is_told():
    """Of a patrol boat a slower second-order gear was told to contradict her trials."""
    denied = refit("second", 0.7, 0.23, check=0.166)
    begun = refit("limited", 0.04, 0.054, check=0.055)
    unfinished = replace(begun, fit=fit(0.054, 0.055, converged=False))
    kind, sentence = decided(denied)
    assert (kind, "the trials contradict each other about it" in sentence) == ("cannot tell", True)
    kind, sentence = decided(denied, unfinished)
    assert kind == "cannot tell"
    assert sentence.startswith("with limited the error falls from 28.00% to 5.40% although its")
