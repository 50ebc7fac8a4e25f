"""A truth that is of another class than the model, and what the loop makes of it.

The logs are of the whole S-175; the model has second-order terms, most of them held at the values
of another ship file. No model within reach is right: the error has to fall to the noise all the
same, and what cannot be believed has to be said.
"""

import shutil

import cubic_truth
import numpy as np
import pytest
from cubic_truth import ROOT, SHIPS

from trialid import pipeline_file
from trialid.report.pages.page import page
from trialid.report.words import doubt
from trialid.ship.particulars import read_ship
from trialid.workflow import grow

MODULI = """"sway_drag_vav", "sway_drag_var", "yaw_drag_vav", "yaw_drag_var", "yaw_drag_rar",
  "roll_drag_vav", "roll_drag_var","""
CASES = {
    "white": (cubic_truth.white, 0, {}),
    "waves": (cubic_truth.waves, 0, {}),
    "bare": (  # fewer known terms, and a heading to fit
        cubic_truth.waves, 1,
        {
            MODULI: '"sway_drag_vav", "yaw_drag_rar",',
            '"r", "phi"]\neffects': '"r", "phi", "psi"]\neffects',
            'outputs = ["r", "phi"]': 'outputs = ["r", "phi", "psi"]',
        },
    ),
}  # fmt: skip
OF_THE_WRONG_CLASS = {
    *("Yvav", "Yvar", "Nvav", "Nvar", "Nrar", "Kvav", "Kvar"),
    *("Nvvv", "Kvvv", "Kvvr", "Kvrr", "Krrr"),
}
"""What the truth has otherwise or with other values: only a fit's own numbers stand for them."""


TURN = {"white": 3, "waves": 1, "bare": 0}
"""All that is asked of a case at one turn: the loop takes half a minute to three."""


@pytest.fixture(
    scope="module",
    params=[pytest.param(name, marks=pytest.mark.study(turn=TURN[name])) for name in CASES],
)
def done(request, tmp_path_factory):
    """The stages of the loop, its history printed."""
    coloured, seed, changes = CASES[request.param]
    folder = tmp_path_factory.mktemp("cubic")
    text = (ROOT / "tests" / "cubic_truth.toml").read_text(encoding="utf-8")
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    (folder / "cubic.toml").write_text(text, encoding="utf-8")
    shutil.copy(SHIPS / "s175q.toml", folder)
    cubic_truth.write_logs(folder, coloured, seed)
    made = []
    print(f"\n{request.param}")
    for stage in grow.stages(pipeline_file.load(folder / "cubic.toml"), lambda words, share: None):
        made.append(stage)
        _tell(stage)
    return made


def _tell(stage):
    result = stage.run.result
    fit, split = result.fit, result.split
    parts = "/".join("-" if p is None else f"{p:.2%}" for p in (split.noise, split.undermodelling))
    print(
        f"{stage.added}, {'kept' if stage.kept else 'not kept'}: {fit.eps_rmsn:.2%}, check "
        f"{fit.eps_rmsn_check:.2%} (sensors {cubic_truth.noise_share(result):.2%}), noise/model "
        f"{parts}; {result.verdict.kind} {result.verdict.effect}"
    )


def beyond_noise(stage):
    """What is left of the error on the check trial when the sensors' noise is taken off."""
    result = stage.run.result
    whole = result.fit.eps_rmsn_check**2 - cubic_truth.noise_share(result) ** 2
    return float(np.sqrt(max(whole, 0.0)))


def test_the_check_error_comes_down_to_the_noise(done):
    """Ours: 11.0 to 9.0, 11.1 to 8.8 and 9.4 to 7.4 %, of which the sensors' 8.6, 8.6 and 7.0 %.

    At most twice the noise is asked for; what lies beyond the noise must fall by half as well,
    for twice the noise is no high fence.
    """
    last = done[-1]
    print(f"beyond the noise: {beyond_noise(done[0]):.2%} to {beyond_noise(last):.2%}")
    assert last.run.result.fit.eps_rmsn_check < 1.2 * cubic_truth.noise_share(last.run.result)
    assert beyond_noise(last) < 0.5 * beyond_noise(done[0])
    assert done[0].run.result.verdict.effect == "rudder_slipstream"
    assert last.run.result.verdict.kind in {"nothing missing", "cannot tell"}


def test_ranges_hold_the_linear_truth(done):
    """GM and Kp, up to ten of their standard errors off, and most of the others.

    Terms of another class have no truth to be held; the linear ones are those of the S-175 on her
    straight course. Several are missing at once here and the ranges know of one: not all is held.
    The report says what is not to be believed.
    """
    last = done[-1].run
    truth = read_ship(SHIPS / "s175q.toml").coefficients
    rows = [r for r in last.result.physical if r.name in truth.keys() - OF_THE_WRONG_CLASS]
    held = {r.name: r.likely[0] <= truth[r.name] <= r.likely[1] for r in rows}
    off = {r.name: round((r.value - truth[r.name]) / r.standard_error, 1) for r in rows}
    print(f"in standard errors: {off}; outside: {[n for n, inside in held.items() if not inside]}")
    assert held["GM"]
    assert held["Kp"]
    assert sum(held.values()) >= 0.75 * len(held)
    assert doubt.doubtful(last.result.physical) in page(last.result, last.series)


def test_what_is_believed_is_right_to_half_its_value(done):
    """Against the S-175 linearised on its straight course, rudder and propeller in it."""
    rows = done[-1].run.result.accuracy.parameters
    truth = read_ship(SHIPS / "s175q.toml").coefficients
    believed = [
        r for r in rows
        if r.kind == "physical" and not doubt.doubtful([r]) and r.name in truth
        and r.name not in OF_THE_WRONG_CLASS
    ]  # fmt: skip
    print({r.name: round(r.value / truth[r.name], 3) for r in believed})
    assert {"GM", "Kdelta"} <= {r.name for r in believed}
    for row in believed:
        assert abs(row.value / truth[row.name] - 1.0) < 0.5, row.name


@pytest.mark.parametrize(
    ("term", "low", "high"),
    [
        (lambda v, r, delta, phi: delta**3, 0.31, 1.0),  # rudder_cubic
        (lambda v, r, delta, phi: v**2 * delta, 0.2, 1.0),  # rudder_in_drift
        (lambda v, r, delta, phi: v * delta**2, 0.0, 0.1),  # drift_with_rudder
        (lambda v, r, delta, phi: delta * phi**2, 0.0, 0.05),  # rudder_heeled
    ],
)
def test_of_the_rudder_of_the_truth_terms_of_third_order_are_left(term, low, high):
    """What counts as her own where effects are hidden in her, `growth/other_base.py`."""
    share = cubic_truth.share_of_rudder(term)
    print(f"{share:.1%}")
    assert low < share < high
