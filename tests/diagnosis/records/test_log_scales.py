"""A log may read too much in all trials alike: no residual shows it, and ranges count with it."""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.accuracy.likely import Rows, Standing, stand
from trialid.accuracy.ranges import LOG_SCALES
from trialid.diagnosis.may_be_off import may_be_off
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.search.augment import augment
from trialid.diagnosis.trust import accuracy_of
from trialid.identification.check.log_scales import BETTER, OFF, log_scales, with_a_scale
from trialid.identification.fit import Fit, identify
from trialid.identification.output_error import residual_at, stretches
from trialid.report.words.doubt import widest
from trialid.result.fit_rows import ParameterRow
from trialid.trial_rows import Stretch

TRUTH = s175q.MODEL.value("Ndelta")
MODEL = replace(s175q.MODEL, ship=replace(s175q.MODEL.ship, uncertainty={"default": 0.0}))
"""Of which nothing else is in doubt."""


def fitted(signal="", by=1.0) -> Fit:
    """Zig-zags of 20, 10 and 5 deg; in all of them a log reads what is true times a factor."""
    rng, made = np.random.default_rng(37), []
    for angle in (20, 10, 5):
        trial = s175q.zigzag(angle)
        trial = s175q.with_noise(trial, *(0.3 * x for x in s175q.white(rng, trial.samples)))
        scaled = {n: x * by if n == signal else x for n, x in trial.signals.items()}
        made.append(replace(trial, use="fit", signals=scaled))
    settings = replace(s175q.SETTINGS, free=("Yv", "Yr", "Nv", "Nr", "Ydelta", "Ndelta", "Kdelta"))
    return identify(made, MODEL, settings)


def ranges(fit: Fit) -> dict[str, tuple[float, float]]:
    augmented = augment(fit, {})
    parts, _ = split(fit, augmented, {})
    return {r.name: r.likely for r in accuracy_of(fit, parts, may_be_off(augmented)).physical}


@pytest.fixture(scope="module")
def as_it_is() -> Fit:
    return fitted()


def test_no_error_tells_of_a_rudder_that_reads_too_much(as_it_is: Fit) -> None:
    fit = fitted("delta", 1.05)
    assert fit.eps_rmsn == pytest.approx(as_it_is.eps_rmsn, rel=0.02)
    assert 0.94 < fit.estimates["Ndelta"] / as_it_is.estimates["Ndelta"] < 0.96


@pytest.mark.parametrize(("signal", "by"), [("delta", 1.03), ("delta", 0.97)])
def test_the_range_of_what_it_moves_holds_the_truth(signal, by) -> None:
    low, high = ranges(fitted(signal, by))["Ndelta"]
    assert low < TRUTH < high


def test_without_it_the_range_does_not(monkeypatch) -> None:
    monkeypatch.setattr("trialid.identification.check.log_scales.OFF", 0.0)
    monkeypatch.setattr("trialid.identification.check.log_scales.BETTER", 0.0)
    low, high = ranges(fitted("delta", 1.03))["Ndelta"]
    assert not low < TRUTH < high


def names_of(fit: Fit, part: Stretch) -> str:
    return fit.problem.outputs[part.output]


@pytest.mark.parametrize("signal", ["delta", "r", "phi"])
def test_slopes_against_logs_that_are_scaled_both_ways(as_it_is: Fit, signal: str) -> None:
    """And none in the parameters: what is left of a residual at the same ones."""
    columns, off = log_scales(as_it_is)
    place = with_a_scale(as_it_is.problem, 0).index(signal)
    ends = []
    for by in (0.999, 1.001):
        trials = tuple(
            replace(t, signals={**t.signals, signal: by * t.signals[signal]})
            for t in as_it_is.problem.trials
        )
        problem = replace(as_it_is.problem, trials=trials)
        ends.append(residual_at(problem, as_it_is.theta))
    both = (ends[1] - ends[0]) / 0.002
    if signal in as_it_is.problem.outputs:  # by what the model says: its noise is none of its scale
        mine = [p.rows for p in stretches(as_it_is.problem) if names_of(as_it_is, p) == signal]
        for rows in mine:
            both[rows] -= as_it_is.residual[rows]
    assert columns[:, place] == pytest.approx(both, rel=1e-2, abs=1e-2 * np.abs(both).max())
    assert off[place] == OFF  # no heading is logged beside the rate


def test_a_speed_log_and_a_rate_beside_its_heading_are_better_known() -> None:
    trial = s175q.zigzag(20)
    heading = np.cumsum(trial.signals["r"]) * trial.period
    more = {"u": 7.33 - 40.0 * np.abs(trial.signals["r"]), "psi": heading}
    whole = {n: np.ones(trial.samples, dtype=bool) for n in more}
    trial = replace(trial, signals=trial.signals | more, valid=trial.valid | whole)
    settings = replace(s175q.SETTINGS, free=("Nv", "Nr", "Ndelta"), outputs=("u", "r", "psi"))
    states = (*MODEL.states, "psi")
    fit = identify([trial], replace(MODEL, states=states), settings)
    names, off = with_a_scale(fit.problem, 0), log_scales(fit)[1]
    assert dict(zip(names, off, strict=True)) == {"delta": OFF, "n": OFF, "u": BETTER, "r": BETTER}


TAKEN_UP, SEEN = np.eye(6)[:2]
"""What the parameter reaches, and what it does not."""


def standing(*scales, left: float, level: float) -> Standing:
    """Of a parameter beside scales of these traces, each uncertain by 0.03."""
    rows = Rows(
        residual=left * SEEN,
        psi=TAKEN_UP[:, None],
        priors=np.zeros((1, 2)),
        held=np.zeros((6, 0)),
        deviations=np.zeros(0),
        S=np.column_stack(scales),
        level=level,
        scales=np.full(len(scales), 0.03),
    )
    return stand(rows, [])


@pytest.mark.parametrize(
    ("seen", "left", "level", "off"),
    [
        (0.0, 0.0, 1e-6, 0.03),  # nothing is seen of it
        (0.5, 0.0, 1e-6, 2e-6),  # it would be seen, and is not
        (0.5, 0.0, 1.0, 0.03),  # it would be, but for the noise
        (0.5, 5.0, 1e-6, 0.03),  # what is left may be of it, of something else or of both
        (0.5, 0.015, 1e-6, 0.03 / np.sqrt(2.0)),
    ],
)
def test_ranges_are_as_wide_as_a_scale_may_be_off(seen, left, level, off) -> None:
    found = standing(0.8 * TAKEN_UP + seen * SEEN, left=left, level=level).average()
    assert found.shifts == pytest.approx(0.0)
    assert np.sqrt(found.variances) == pytest.approx(0.8 * off, rel=1e-3)
    assert found.widest == (LOG_SCALES,)


@pytest.mark.parametrize("seen", [0.0, 1.0])
def test_what_each_alone_would_show_both_together_hide(seen: float) -> None:
    """Of e1 + e2 and e1 - e2, as of both thrusters, the sum is not seen: off by both of them."""
    both = (TAKEN_UP + seen * SEEN, TAKEN_UP - seen * SEEN)
    found = standing(*both, left=0.0, level=1e-6)
    off = 0.03 * np.sqrt(2.0)
    assert np.sqrt(found.average().variances) == pytest.approx(off, rel=1e-3)
    moves = found.draw(4000, np.random.default_rng(2)).moves
    assert np.std(moves) == pytest.approx(off, rel=0.05)


def test_the_report_says_what_widens_a_range_so() -> None:
    row = ParameterRow(name="Nr", value=-2.0, likely=(-3.0, -1.5), widened_by=LOG_SCALES)
    told = "as logs may read a little too much or too little in all trials alike."
    assert widest([row]) == f"Least known: Nr, {told}"
