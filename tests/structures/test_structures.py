"""Structures compared, from a pipeline file to the choice: known truths, errors, refusals."""

import shutil
from dataclasses import replace

import known_truth
import numpy as np
import pytest
from compared import LISTS, result_in, run, silent

from trialid.errors import NotIdentifiable
from trialid.identification import fit as search
from trialid.pipeline_file import load
from trialid.workflow.read_trials import align_trials
from trialid.workflow.structures import comparison, leave_out
from trialid.workflow.structures.asked_structures import asked_structures
from trialid.workflow.structures.compare_structures import compare_structures

# --- the choice ---------------------------------------------------------------------------------


def test_the_truth_is_chosen_and_stays_chosen_without_any_trial(done) -> None:
    found = result_in(done[0])
    assert (found.best, found.chosen) == ("cross-flow, race", "cross-flow, race")
    assert found.chosen_without == dict.fromkeys(found.trials, "cross-flow, race")
    rows = {row.name: row for row in found.rows}
    assert [row.name for row in found.rows] == ["cross-flow, race", "cross-flow", "linear"]
    assert rows["linear"].behind > 2.0 * rows["linear"].behind_standard_error > 0.0
    assert rows["linear"].eps_rmsn_check > rows["cross-flow, race"].eps_rmsn_check


def test_where_nothing_is_more_than_linear_linear_is_chosen(tmp_path) -> None:
    path = known_truth.write_trials(tmp_path, "linear", 102, trials=4, added=LISTS)
    assert compare_structures(load(path), stability=False).chosen == "linear"


def test_an_error_is_that_of_a_held_out_trial_in_a_run_of_its_own(turning, done) -> None:
    """Fitted from the stated start, not from the fit of all; the norm is that of all trials."""
    pipeline = load(turning)
    trials = align_trials(pipeline, silent)
    [asked] = [s for s in asked_structures(pipeline, trials)[0] if s.name == "cross-flow, race"]
    whole = search.identify(trials, asked.model, asked.settings)
    row = result_in(done[0]).row("cross-flow, race")
    assert row.eps_rmsn == pytest.approx(whole.eps_rmsn, rel=1e-6)
    assert row.eps_rmsn_check == pytest.approx(whole.eps_check, rel=1e-6)
    for out in result_in(done[0]).trials:
        fitted = [t for t in trials if t.use == "fit"]
        left = [replace(t, use="check" if t.name == out else "fit") for t in fitted]
        fit = search.identify(left, asked.model, asked.settings)
        norm = fit.problem.y_rms / whole.problem.y_rms
        each = np.array(list(fit.eps_check_by_output.values())) * norm
        assert row.left_out[out] == pytest.approx(np.sqrt(np.mean(each**2)), rel=1e-4)


def test_effects_that_no_list_names_are_in_every_structure(turning, done) -> None:
    rows = {row.name: row for row in result_in(done[0]).rows}
    own = ("linear_hull", "linear_rudder", "centripetal_added_mass")
    assert rows["linear"].effects == own
    assert rows["cross-flow"].effects == (*own, "cross_flow_drag")
    assert rows["cross-flow"].free == ("Yv", "Nv", "Nr", "Ndelta", "C_D")
    assert rows["linear"].parameters == 4
    assert rows["cross-flow, race"].parameters == 6  # z_slip heels, and heel is not simulated


def test_an_effect_of_the_pipeline_keeps_what_is_free_in_it(turning, tmp_path) -> None:
    """Its held parameters stay held, its priors go where it goes; of new effects all is free."""
    text = turning.read_text(encoding="utf-8")
    text = text.replace('added_mass"]', 'added_mass", "yaw_drag_rar", "yaw_drag_var"]')
    text = text.replace('"Ndelta"]', '"Ndelta", "Nrar"]')
    text = text.replace(
        "[structures]",
        "[identify.priors]\nNrar = { mean = -0.001, std = 0.001 }\n"
        '[structures]\ndrag = ["yaw_drag_rar", "yaw_drag_var", "sway_drag_vav"]',
    )
    copy = shutil.copytree(turning.parent, tmp_path / "own") / turning.name
    copy.write_text(text, encoding="utf-8")
    pipeline = load(copy)
    found, _ = asked_structures(pipeline, align_trials(pipeline, silent))
    free = {s.name: s.settings.free for s in found}
    assert free["drag"] == ("Yv", "Nv", "Nr", "Ndelta", "Nrar", "Yvav")
    assert free["linear"] == ("Yv", "Nv", "Nr", "Ndelta")
    assert {s.name: set(s.settings.priors) for s in found}["drag"] == {"Nrar"}
    assert not any(s.settings.priors for s in found if s.name != "drag")


def test_without_lists_the_usual_ones_and_the_pipelines_own_are_compared(turning, copy) -> None:
    text = turning.read_text(encoding="utf-8").replace(LISTS, "")
    copy.write_text(text, encoding="utf-8")
    pipeline = load(copy)
    found, left_out = asked_structures(pipeline, align_trials(pipeline, silent))
    assert len(found) == 8
    assert set(left_out) == {"with surge"}
    own = text.replace('added_mass"]', 'added_mass", "yaw_drag_rar"]')
    copy.write_text(own, encoding="utf-8")
    more, _ = asked_structures(load(copy), align_trials(pipeline, silent))
    assert [s.name for s in more if s not in found][-1] == "as written"
    assert "yaw_drag_rar" not in {e.name for e in more[0].model.effects}


# --- what cannot be compared --------------------------------------------------------------------


def test_what_the_record_has_no_signal_for_is_left_out_with_its_reason(copy) -> None:
    text = copy.read_text(encoding="utf-8") + 'screw = ["propeller_side_force"]\n'
    copy.write_text(text + 'lost = ["surge_loss"]\n', encoding="utf-8")
    pipeline = load(copy)
    found, left_out = asked_structures(pipeline, align_trials(pipeline, silent))
    assert len(found) == 3
    assert left_out == {
        "screw": "propeller_side_force needs n, which the record does not hold",
        "lost": "surge_loss stands in for a record of u",
    }


RUNAWAY = '''
from trialid.ship.effect import Force, Parameter, effect

@effect(source="nowhere")
def runaway(r, *, N_away=Parameter(5.0, low=1.0, high=10.0, null=None)):
    """N = N_away r: a ship that turns by herself."""
    return Force(N=N_away * r)
'''


def test_a_structure_that_cannot_be_fitted_is_a_row_and_never_chosen(copy) -> None:
    (copy.parent / "mine.py").write_text(RUNAWAY, encoding="utf-8")
    text = copy.read_text(encoding="utf-8") + 'runaway = ["runaway"]\n'
    text = text.replace("[identify]", 'effects_from = ["mine.py"]\n[identify]')
    copy.write_text(text, encoding="utf-8")
    found = compare_structures(load(copy), stability=False)
    row = found.row("runaway")
    assert found.rows[-1] is row
    assert row.why_not is not None
    assert "simulated" in row.why_not
    assert (row.eps_rmsn_left_out, row.behind, row.as_good) == (None, None, False)
    assert found.chosen == "cross-flow, race"


def test_where_no_structure_can_be_fitted_that_is_one_line(copy) -> None:
    for log in copy.parent.glob("*.csv"):
        table = np.loadtxt(log, delimiter=",", skiprows=1)
        table[:, 1] = 0.0
        np.savetxt(log, table, "%.9g", ",", header="t,delta,r,v,u", comments="")
    said = run(copy, "--out", copy.parent / "none")
    assert said.exit_code == 2
    assert "no structure can be fitted: the rudder (delta) moves by only 0.00 deg" in said.stderr
    assert said.stderr.count("\n") == 1


def test_a_fit_that_fails_without_one_trial_takes_the_structure_out(turning, monkeypatch) -> None:
    def failing(trials, model, *given, **named):
        held = [t.name for t in trials if t.use == "check"]
        if held == ["steps-20"] and any(e.name == "rudder_slipstream" for e in model.effects):
            raise NotIdentifiable("nothing excites the ship")
        return search.identify(trials, model, *given, **named)

    monkeypatch.setattr(leave_out, "identify", failing)
    found = compare_structures(load(turning), stability=False)
    assert found.row("cross-flow, race").why_not == "without steps-20: nothing excites the ship"
    assert found.chosen == "cross-flow"
    assert "none that is simpler" in found.sentences[0]


WRONG = {
    '["cross_flow_drag"]': (
        '["cros_flow_drag"]',
        "structures.cross-flow[0]: there is no effect 'cros_flow_drag'; did you mean "
        "'cross_flow_drag'?",
    ),
    "linear = []": ('linear = ["static_list", "static_list"]', "stands there 2 times"),
    "linear = [": ("linear = 3 # [", "structures.linear: must be a list"),
    'linear = []\n"cross-flow" = ["cross_flow_drag"]\n': ("", "write two or more"),
    "[structures]": ("[structure]", "unknown key; did you mean 'structures'?"),
    '["r", "v"]': ('["r", "w"]', "unknown quantity 'w'"),
    'use = "fit"': ('use = "check"', "no trial to fit"),
}


@pytest.mark.parametrize("old", WRONG)
def test_a_wrong_word_is_one_line_and_nothing_is_written(copy, old) -> None:
    new, said = WRONG[old]
    text = copy.read_text(encoding="utf-8")
    assert old in text
    copy.write_text(text.replace(old, new), encoding="utf-8")
    told = run(copy, "--out", copy.parent / "out")
    assert told.exit_code == 2
    assert said in told.stderr
    assert told.stderr.count("\n") == 1
    assert not (copy.parent / "out").exists()


def test_one_trial_cannot_be_left_out(copy) -> None:
    text = copy.read_text(encoding="utf-8").replace('use = "fit"', 'use = "check"')
    copy.write_text(text.replace('use = "check"', 'use = "fit"', 1), encoding="utf-8")
    told = run(copy, "--out", copy.parent / "out")
    assert told.exit_code == 2
    assert "only one is fitted here; fit two or more" in told.stderr
    assert not (copy.parent / "out").exists()


def test_two_trials_are_compared_and_said_to_be_few(copy) -> None:
    text = copy.read_text(encoding="utf-8").replace('use = "fit"', 'use = "check"')
    copy.write_text(text.replace('use = "check"', 'use = "fit"', 2), encoding="utf-8")
    found = compare_structures(load(copy))
    assert found.chosen in {"cross-flow", "cross-flow, race"}
    assert found.chosen_without == {}
    assert "With two trials nobody can tell how stable that is." in found.sentences
    assert any("2 trials are few" in s and "71%" in s for s in found.sentences)


@pytest.mark.study(turn="each")
def test_a_trial_that_the_others_foretell_worse_than_none_is_told(copy, done) -> None:
    """A rudder recorded four times as large: the choice of the rest says nothing about it."""
    other = copy.parent / "steps-10.csv"
    table = np.loadtxt(other, delimiter=",", skiprows=1)
    np.savetxt(other, table * [1, 4, 1, 1, 1], "%.9g", ",", header="t,delta,r,v,u", comments="")
    found = compare_structures(load(copy), stability=False)
    assert found.chosen is not None
    assert found.row(found.chosen).unforetold == ("steps-10",)
    assert "foretells steps-10 worse than no model at all" in found.sentences[1]
    sound = result_in(done[0])
    assert not any(row.unforetold for row in sound.rows)
    assert not any("foretells" in sentence for sentence in sound.sentences)


def test_gaps_of_a_signal_that_one_structure_reads_are_left_out_of_all(copy) -> None:
    """So that every structure is judged by the same samples."""
    text = copy.read_text(encoding="utf-8") + 'screw = ["propeller_side_force"]\n'
    text = text.replace("[align]", 'n = { channel = "n", unit = "rad/s" }\n[align]')
    copy.write_text(text, encoding="utf-8")
    for log in copy.parent.glob("*.csv"):
        head, *rows = log.read_text(encoding="utf-8").splitlines()
        rows = [f"{row},{'' if 200 <= i < 260 else 7.33 + 0.001 * i}" for i, row in enumerate(rows)]
        log.write_text("\n".join([f"{head},n", *rows]) + "\n", encoding="utf-8")
    compared = []
    original = leave_out.fit_whole

    def seen(structure, trials):
        compared.append([int(t.valid["r"].sum()) for t in trials])
        return original(structure, trials)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(comparison, "fit_whole", seen)
        compare_structures(load(copy), stability=False)
    assert compared == [compared[0]] * 4
    assert max(compared[0]) <= 600 - 60
