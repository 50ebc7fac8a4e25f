import copy
import shlex
from dataclasses import replace

import click
import pytest
from s175q import MODEL, OUTPUTS, SETTINGS, zigzag

from trialid.cli.main import commands as known_commands
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.search.augment import augment
from trialid.identification.fit import identify
from trialid.names.wording import THIN
from trialid.report.pages.page import FOLLOWS, heading
from trialid.report.words.advice import AS_STATED, OPENS, STATED, advice
from trialid.report.words.doubt import moves, trust
from trialid.result.fit_rows import WeakRow
from trialid.result.json_file import result_of


def advised(result, **changed):
    run = copy.deepcopy(result)
    for key, value in changed.items():
        run[key] = (run.get(key) or {}) | value if isinstance(value, dict) else value
    return advice(result_of(run))


def verdict(kind, effect=None, family=()):
    return {"kind": kind, "effect": effect, "family": list(family), "next_trial": None}


MISSING = verdict("missing", "yaw_drag", ["yaw_drag", "heel_yaw", "sway_drag", "current"])


def test_what_is_missing_is_added_by_commands_that_exist(result):
    commands = [each.command for each in advised(result, verdict=MISSING) if each.command]
    assert commands == [
        "trialid add container_ship.toml yaw_drag",
        "trialid effects yaw_drag",
        "trialid add container_ship.toml heel_yaw",
        "trialid add container_ship.toml sway_drag",
        "trialid run container_ship.toml --auto",
    ]
    for command in commands:
        assert_known(command)


STAYS = "leaves most of the error"


@pytest.mark.parametrize(
    ("noise", "held_out", "stays"),
    [
        (None, 0.17, True),
        (0.16, 0.17, False),
        (None, 0.14, False),
        (None, None, True),
        (0.05, 0.17, True),
    ],
)
def test_where_most_of_the_error_stays_whole_models_are_compared(result, noise, held_out, stays):
    """Before it 0.2, of those held out and of those fitted: half of the square is 0.14."""
    run = copy.deepcopy(result)
    run["split"]["noise"], run["trials"] = noise, run["trials"][:1] * 3
    run["fit"] |= {"eps_rmsn": 0.2, "eps_rmsn_check": held_out and 0.2}
    row = {"effect": "yaw_drag", "eps_rmsn_refitted": 0.17, "eps_rmsn_check": held_out}
    run["missing"] = [run["missing"][0] | row]
    found = [each for each in advised(run, verdict=MISSING) if "structures" in each.command]
    assert len(found) == stays
    for each in found:
        assert STAYS in each.words
        so = (
            "so more than it is missing"
            if noise
            else "so that is noise, or more than it is missing"
        )
        assert so in each.words
        assert_known(each.command)


def test_two_trials_are_too_few_to_compare_whole_models_by(result):
    run = copy.deepcopy(result)
    run["trials"], run["split"]["noise"] = run["trials"][:1] * 2, None
    run["fit"] |= {"eps_rmsn": 0.2, "eps_rmsn_check": None}
    row = {"effect": "yaw_drag", "eps_rmsn_refitted": 0.19, "eps_rmsn_check": None}
    run["missing"] = [run["missing"][0] | row]
    assert not [e for e in advised(run, verdict=MISSING) if "structures" in e.command]


def test_two_that_are_missing_at_once_are_added_by_the_loop(result):
    both = verdict("cannot tell") | {"together": ["sway_drag", "slipstream"]}
    [both_at_once] = [one for one in advised(result, verdict=both) if one.command]
    assert both_at_once.words.startswith("Let it add sway_drag and slipstream at once")
    assert both_at_once.command == "trialid run container_ship.toml --auto"
    assert_known(both_at_once.command)


@pytest.mark.parametrize(("share", "told"), [(0.25, True), (0.05, False)])
def test_what_follows_the_rudder_is_no_noise_where_nothing_is_missing(result, share, told):
    """A page said so of a quarter of the heading's error, below a headline that nothing is."""
    said = "heading psi: a part is coherent with the rudder: the model, not the noise"
    row = {"output": "psi", "finding": "frequency", "share": share, "sentence": said}
    run = copy.deepcopy(result) | {"verdict": verdict("nothing missing"), "where": [row]}
    assert any(said in each.words for each in advice(result_of(run))) is told
    assert (heading(result_of(run)) == FOLLOWS) is told
    assert heading(result_of(run | {"verdict": verdict("cannot tell")})) != FOLLOWS


@pytest.mark.parametrize("use", ["fit", "check"])
def test_a_model_is_for_use_where_a_trial_held_out_has_tested_it(result, use):
    """Thirteen numbers of one zig-zag were for use, and left three times as much on its end."""
    run = copy.deepcopy(result)
    run["where"] = []
    for trial in run["trials"]:
        trial["use"] = use
    first = advised(run, verdict=verdict("nothing missing"))[0].words
    assert first.startswith("Use the model within") == (use == "check")
    assert first.startswith("Hold a trial out before you use the model") == (use == "fit")


def test_where_one_of_several_is_missing_each_may_be_tried(result):
    one_of = verdict("cannot tell", family=["rudder_backlash", "yaw_drag", "sway_drag", "heel"])
    tried = [e.command for e in advised(result, verdict=one_of) if " add " in e.command]
    names = ["rudder_backlash", "yaw_drag", "sway_drag"]
    assert tried == [f"trialid add container_ship.toml {name}" for name in names]
    for command in tried:
        assert_known(command)


def test_what_is_held_is_freed_before_anything_is_added(result):
    held = verdict("cannot tell") | {"held_as_well": ["I_xx", "Yr"]}
    commands = [each.command for each in advised(result, verdict=held) if each.command]
    assert commands[0] == '"I_xx", "Yr"'
    assert not any(" add " in command for command in commands)


@pytest.mark.parametrize(("signals", "ways"), [(["phi", "u"], 1), (["phi", "delta"], 4)])
def test_what_opens_a_way_to_the_noise_of_a_free_roll(result, signals, ways):
    """Nothing drives her: no orders can be given again, and none steady."""
    names = ("repeated manoeuvre", "periods of a periodic test", "quiet stretch", STATED)
    closed = [{"method": name, "available": False, "reason": "none"} for name in names]
    rows = [{"trial": "a", "signal": name, "channel": name} for name in signals]
    run = copy.deepcopy(result) | {"signals": rows, "verdict": verdict("cannot tell")}
    run["split"] |= {"noise": None, "routes": closed}
    [said] = [each.words for each in advice(result_of(run)) if "opens a way" in each.words]
    assert sum(words in said for words in OPENS.values()) == ways
    assert OPENS[STATED] in said


def test_where_a_steady_course_was_too_short_a_longer_one_is_asked_for(result):
    """Of logs that all begin with a minute of steady course a minute of it was asked for."""
    why = "residual in 0-60 s of 'zz2020': too short, the noise is hardly known at all"
    routes = [{"method": "quiet stretch", "available": False, "why": why}]
    run = copy.deepcopy(result) | {"verdict": verdict("cannot tell")}
    run["split"] |= {"noise": None, "routes": routes}
    [said] = [each.words for each in advice(result_of(run)) if "opens a way" in each.words]
    assert "record a longer steady course" in said
    assert "a minute or more" not in said


def test_a_figure_that_is_stated_and_refused_is_not_asked_for_again(result):
    """Of an outsider's decays the same was asked for, whatever he stated."""
    why = (
        "as stated in [diagnose] noise: not typical, noise of 1.77% where 1.29% is the whole error"
    )
    routes = [{"method": STATED, "available": False, "why": why}]
    run = copy.deepcopy(result) | {"verdict": verdict("cannot tell")}
    run["split"] |= {"noise": None, "routes": routes}
    said = [each.words for each in advice(result_of(run))]
    assert not any("opens a way" in words for words in said)
    [told] = [words for words in said if words.startswith("The noise that is stated is not used")]
    assert "noise of 1.77% where 1.29% is the whole error: state what is left of it" in told


def test_what_is_refused_begins_as_it_is_looked_for():
    """The words of the split are what tells a figure that is refused from one that lacks."""
    fit = identify([zigzag(10)], MODEL, replace(SETTINGS, free=("Nr", "Ndelta")))
    _, routes = split(fit, augment(fit, {}), dict.fromkeys(OUTPUTS, 1.0), {})
    [stated] = [route for route in routes if route.method == STATED]
    assert stated.why.startswith(AS_STATED)


def assert_known(command):
    """The words are those that the command line takes."""
    name, verb, *words = shlex.split(command)
    assert name == "trialid"
    known = known_commands.commands[verb]
    known.parse_args(click.Context(known, help_option_names=["-h", "--help"]), words)


def test_a_force_outside_the_catalogue_is_drafted(result):
    commands = [e.command for e in advised(result, verdict=verdict("not in catalogue"))]
    compared, draft = [c for c in commands if c.startswith("trialid")]
    assert compared == "trialid structures container_ship.toml"
    assert draft == "trialid run --draft my_effect.py container_ship.toml"
    assert_known(draft)
    assert 'effects_from = ["my_effect.py"]' in commands


def test_a_force_that_no_equation_shows_is_not_drafted(result):
    force = {"equations": [{"equation": "K", "unit": "N m"}], "sentence": "no force stands out"}
    gap = verdict("not in catalogue")
    for possible, drafts in ((["K"], True), ([], False)):
        shown = advised(result, verdict=gap, missing_force={**force, "possible": possible})
        assert any("--draft" in (e.command or "") for e in shown) is drafts
        assert any("No force can be drafted" in e.words for e in shown) is not drafts


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        ("nothing missing", "A model error of up to 9.79 % would not be seen"),
        ("not in catalogue", "Look where the model fails first: 61.7 % of the squared"),
        ("cannot tell", "The record itself leaves it open"),
    ],
)
def test_every_kind_of_verdict_has_its_advice(result, kind, says):
    words = " ".join(each.words for each in advised(result, verdict=verdict(kind)))
    assert says in words.replace(THIN, " ")
    assert "trialid add" not in " ".join(e.command for e in advised(result, verdict=verdict(kind)))


def test_a_record_that_cannot_part_noise_names_only_closed_routes(result):
    routes = [
        {"method": "repeated manoeuvre", "available": False},
        {"method": "quiet stretch", "available": True},
    ]
    split = {"noise": None, "routes": routes}
    words = " ".join(e.words for e in advised(result, verdict=verdict("cannot tell"), split=split))
    assert "run one manoeuvre twice" in words
    assert "steady course" not in words


def test_a_fit_that_did_not_converge_comes_first(result):
    first = advised(result, fit={"converged": False}, verdict=MISSING)[0]
    assert first.words.startswith("The fit did not converge")


def test_a_run_without_held_out_trials_is_told_to_hold_one_back(result):
    fitted = [trial | {"use": "fit"} for trial in result["trials"]]
    assert any("Hold one back" in e.words for e in advised(result, trials=fitted))
    assert any("Add a second trial" in e.words for e in advised(result, trials=fitted[:1]))
    assert not any("held out" in e.words for e in advised(result))


def test_loose_parameters_are_named_and_nuisances_are_not(result):
    run = copy.deepcopy(result)
    run["accuracy"]["parameters"][-1]["likely"] = [-9.0, 9.0]  # a nuisance has none, whatever
    run["verdict"] = verdict("nothing missing")
    words = " ".join(e.words for e in advice(result_of(run)))
    assert "Not to be believed: Yp; it may be off" in words
    assert "bias" not in words
    assert "To part Kv from Yp" in words


def test_nothing_known_gives_no_advice():
    assert advice(result_of({})) == ()


def test_moves_say_which_go_together_and_which_against():
    words = moves(WeakRow(moves={"a": 0.2, "b": -0.1, "c": 0.3})).replace(THIN, " ")
    assert words == "a by 20 %, b by 10 % and c by 30 % of their size, a, c up while b down, or " \
                    "the reverse"  # fmt: skip
    assert moves(WeakRow()) == moves(WeakRow(moves={"a": 0.1, "b": None})) == ""
    assert moves(WeakRow(moves={"a": 0.1})) == ""


def test_the_table_of_parameters_is_summed_up(result):
    words = trust(result_of(result)).replace(THIN, " ")
    assert words == (
        "Best known is Ndelta, to 2.9 %. Least known: Yp, by "
        "the numbers held fixed (how sure those are: [uncertainty] in the ship file). "
        "With yaw_damping_cubic in the model the ranges are others: add it first."
    )
    assert trust(result_of({})) == ""
