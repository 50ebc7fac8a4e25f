import copy

import pytest
from rich.console import Console

from trialid.report.pages.page import page
from trialid.report.terminal.summary import summary
from trialid.result.json_file import result_of


def lines(result, width=80, **how):
    console = Console(width=width, color_system=None)
    with console.capture() as capture:
        console.print(summary(result_of(result), **how))
    return capture.get().splitlines()


def crowded(result):
    """A run with far more of everything than a screen holds."""
    run = copy.deepcopy(result)
    run["pipeline"] = "a very long name " * 20
    run["trials"] = [row | {"name": f"trial {k} " * 9} for k, row in enumerate(run["trials"] * 6)]
    run["fit"]["eps_rmsn_by_output"] = dict.fromkeys(("u", "v", "p", "r", "phi", "psi"), 0.1)
    run["missing"] = run["missing"] * 5
    run["where"] = [row | {"sentence": row["sentence"] * 9} for row in run["where"] * 4]
    run["missing"][0]["verdict"] = "not within its physical range, and of the wrong sign " * 3
    run["verdict"]["sentence"] = "There is a great deal to say about this. " * 30
    run["verdict"]["next_trial"]["sentence"] = "And about the next trial. " * 30
    run["split"]["method"] = "a route with a long name " * 20
    run["fit"]["remarks"] = ["Kp ended at its bound -6e-06 " * 9] * 5
    run["before_after"]["effect"] = "an_effect_with_a_long_name_" * 9
    return run


@pytest.mark.parametrize("copies", [0.5, 1.2, 5])
def test_one_screen_whatever_the_run_holds(result, copies):
    run = crowded(result)
    rows = run["accuracy"]["parameters"][:10]
    run["accuracy"]["parameters"] = (rows * 5)[: int(10 * copies)]
    shown = lines(run, file="a folder/with a long name/" * 9)
    assert len(shown) <= 38
    assert max(map(len, shown)) <= 80
    below = lines(run, lines=34)
    assert len(below) <= 34
    assert "There is a great deal" in below[1]
    assert len(lines(run, width=100)) <= 38


def test_a_short_run_is_shown_whole_and_a_long_one_less(result):
    run = copy.deepcopy(result)
    whole = lines(run, lines=60)
    names = [row["name"] for row in run["accuracy"]["parameters"] if row["kind"] == "physical"]
    assert [n for n in names if not any(line.startswith(f"{n} ") for line in whole)] == []
    less = lines(run, lines=34)
    assert len(less) <= 34 < len(whole)
    assert any(line.endswith("more, all better known") for line in less)


def test_of_many_trials_the_worst_are_shown(result):
    run = copy.deepcopy(result)
    [first, *_] = run["trials"]
    errors = [0.1, 0.2, 0.3, None, 0.25, 0.15, 0.12, 0.11, 0.05, 0.9]
    run["trials"] = [
        first | {"name": f"zigzag {k}", "eps_rmsn": dict.fromkeys(first["eps_rmsn"], x)}
        for k, x in enumerate(errors)
    ]
    shown = [" ".join(line.split()[:2]) for line in lines(run) if line.startswith("zigzag ")]
    assert {"zigzag 3", "zigzag 9"} <= {*shown}
    assert "zigzag 8" not in shown
    assert shown == sorted(shown)
    assert any(line.split()[2:] == ["trials", "with", "less"] for line in lines(run))


def test_the_verdict_comes_first_and_then_what_to_do(result):
    shown = lines(result, file="pipelines/a.toml")
    assert shown[1].startswith("The model lacks nonlinear yaw damping")
    place = shown.index("Next: trialid add pipelines/a.toml yaw_damping_cubic")
    assert place < shown.index("") < [s.startswith("error by RMS") for s in shown].index(True)
    run = copy.deepcopy(result)
    run["verdict"]["kind"] = "nothing missing"
    (line,) = [line for line in lines(run, file="a.toml") if line.startswith("Next: ")]
    assert line.startswith("Next: Do not take what is left for noise")  # it follows the rudder
    run["where"] = []
    (line,) = [line for line in lines(run, file="a.toml") if line.startswith("Next: ")]
    assert line.startswith("Next: Use the model within the orders")
    run["verdict"]["kind"] = "not in catalogue"
    (line,) = [line for line in lines(run, file="a.toml") if line.startswith("Next: ")]
    assert line.startswith("Next: trialid run a.toml --draft my_effect.py")


def test_what_was_tried_without_a_verdict_is_told_with_its_errors(result):
    run = copy.deepcopy(result)
    said = "With yaw_damping_cubic: fitted 12.6 % -> 8.71 %, held out 14.4 % -> 9.12 %"
    assert said not in lines(run)  # the sentence of the verdict has them
    run["verdict"]["kind"] = "cannot tell"
    assert said in lines(run)


def test_a_search_that_did_not_end_is_said(result):
    run = copy.deepcopy(result)
    assert "did not converge" not in "\n".join(lines(run))
    run["fit"]["converged"] = False
    assert "The fit did not converge: rely on nothing here" in "\n".join(lines(run)[:5])
    run["verdict"] = {"kind": "no fit", "sentence": "no fit: it did not converge"}
    assert lines(run)[1] == "no fit: it did not converge"


def test_no_letter_is_left_unexplained(result):
    text = "\n".join(lines(result))
    for words in ("Eq. 14", "R_i", "S_imin"):
        assert words not in text
    assert "may be off" in text


def test_numbers_stay_where_names_are_long(result):
    run = copy.deepcopy(result)
    run["trials"][0]["name"] = "a trial of a ferry with a long name " * 3
    (line,) = [line for line in lines(run) if line.startswith("a trial of")]
    assert "\N{HORIZONTAL ELLIPSIS}" in line
    assert line.rstrip().endswith("fitted    8.10 %  11.2 %")


def test_what_a_reader_must_learn(result):
    text = "\n".join(lines(result))
    for words in (
        "zigzag-15     ",
        "held out  12.0 %  16.3 %",
        "noise 8.41 % (8.02 to 8.81 %) and model 9.44 % (9.07 to 9.79 %)",
        "Yr         1       0.0022310  2.5e-05      0.00166    0.00261      25.7 %",
        "1 yaw_damping_cubic",
        "Fails: 61.7 % of the squared yaw-rate error stands where",
        "The model lacks nonlinear yaw damping",
    ):
        assert words in text


def test_an_angle_and_its_range_are_in_degrees(result):
    run = copy.deepcopy(result)
    row = run["accuracy"]["parameters"][0]
    row |= {"name": "delta_0", "unit": "rad", "value": 0.1, "standard_error": 0.01}
    row["likely"] = [0.05, 0.12]
    (line,) = [each for each in lines(run) if each.lstrip().startswith("delta_0")]
    assert line.split()[:6] == ["delta_0", "deg", "5.7296", "0.57", "2.86", "6.88"]


def test_what_is_not_to_be_believed_is_said(result):
    run = copy.deepcopy(result)
    physical = [r for r in run["accuracy"]["parameters"] if r["kind"] != "nuisance"]
    for row in physical:
        row["likely"] = [row["value"] - 0.2 * abs(row["value"]), row["value"]]
    assert "Not to be believed" not in "\n".join(lines(run))
    physical[0]["likely"][0] = physical[0]["value"] - 0.51 * abs(physical[0]["value"])
    name = physical[0]["name"]
    assert f"Not to be believed: {name}; it may be off by more" in "\n".join(lines(run))
    physical[1]["likely"] = physical[1]["standard_error"] = None
    assert f"{name}, {physical[1]['name']}; each may be off" in "\n".join(lines(run))


def test_many_parameters_show_the_least_certain(result):
    run = copy.deepcopy(result)
    rows = run["accuracy"]["parameters"][:10]
    run["accuracy"]["parameters"] = [
        row | {"name": f"{row['name']}{k}", "value": 1.0, "likely": [1.0, 1.0 + k / 100]}
        for k, row in enumerate(rows + rows)
    ]
    text = "\n".join(lines(run))
    assert "T_E19" in text
    assert "Yv0 " not in text
    assert "13 more" in text


def test_brackets_in_names_are_text(result):
    run = copy.deepcopy(result)
    run["trials"][0]["name"] = "[red]zigzag[/red]"
    assert any(line.startswith("[red]zigzag[/red]") for line in lines(run))


def test_nothing_known_is_said_in_words():
    text = "\n".join(lines({}))
    assert "no route to the noise was open" in text
    assert "No verdict." in text
    assert "None" not in text


def test_the_band_is_said_with_what_it_held(result):
    run = copy.deepcopy(result)
    run["fit"]["band"] = {"r": 0.001, "phi": 0.02}
    for trial, share in zip(run["trials"], (0.5, 0.5, 0.93, 0.961), strict=False):
        trial["inside"] = {"r": share, "phi": share} if trial["use"] == "check" else {"r": 0.1}
    said = next(line for line in lines(run) if line.startswith("95 % band"))
    assert said.startswith(
        "95 % band of a trial like these: r +-0.0573 deg/s, φ +-1.15 deg; of the"
    )
    assert "96 %" in "\n".join(lines(run))
    assert "10 %" not in said  # how fitted trials keep to it says nothing


def test_a_band_as_wide_as_with_no_model_is_no_success(result):
    """An outsider's boat of 1.7 m/s had one of 4.9 m/s, of which 100 % lay inside."""
    run = copy.deepcopy(result)
    for trial in run["trials"]:
        trial["inside"] = {"r": 1.0, "phi": 1.0} if trial["use"] == "check" else {}
    moved = run["fit"]["y_rms"]
    run["fit"]["band"] = {"r": 1.9 * moved["r"], "phi": 2.0 * moved["phi"]}
    text = " ".join(lines(run))
    assert "φ: as wide as with no model, too few trials tell it, or too unlike; of the held" in text
    run["fit"]["band"] = {n: 2.0 * x for n, x in moved.items()}
    assert "lie inside" not in " ".join(lines(run))
    run["fit"]["band"] = {n: 1.9 * x for n, x in moved.items()}
    text = " ".join(lines(run))
    assert "of the held-out samples 100 % lie inside" in text
    assert "no model" not in text


def test_a_heading_that_may_be_any_has_no_band_of_three_turns(result):
    run = copy.deepcopy(result)
    for half, said in ((18.0, "ψ anywhere"), (0.02, "ψ +-1.15 deg")):
        run["fit"]["band"] = {"psi": half}
        text = "\n".join(lines(run))
        assert f"95 % band of a trial like these: {said}" in text


def test_two_at_once_are_said_with_the_command_that_adds_them(result):
    run = copy.deepcopy(result)
    run["verdict"] |= {"kind": "cannot tell", "effect": None, "together": ["a", "b"]}
    assert "Next: trialid run container_ship.toml --auto  # adds them, goes on" in lines(
        run, file="container_ship.toml"
    )


def test_what_a_person_has_to_judge_in_a_record_is_told_whatever_the_verdict(result):
    run = copy.deepcopy(result)
    assert not any("To check" in line for line in lines(run, lines=60))
    run["trials"][0]["remarks"] = [
        "r: 1 value out of line, at 30.0 s; masked",
        "psi: 1 value jumped by up to 13 deg, at 41.5 s; left as it is",
        "heels inward in turns: correlation of phi with r u 1.00",
        "r: does not change from 46.7 to 76.7 s; stuck?",
    ]
    for kind in ("missing", "no fit"):
        run["verdict"]["kind"] = kind
        said = " ".join(" ".join(lines(run, lines=60)).split())
        name = run["trials"][0]["name"]
        assert f"To check, in {name}: psi: 1 value jumped by up to 13 deg" in said
        assert "(2 more on the page)" in said
        assert "masked" not in said


def test_beside_numbers_that_rest_on_doubtful_records_that_is_said(result):
    """Of a rate behind a filter of 4 s two of three ranges were wrong, and no word said."""
    said = "What the records leave in doubt may be in all numbers here, and in their ranges."
    run = copy.deepcopy(result)
    assert said not in " ".join(lines(run, lines=60))
    run["verdict"]["doubts"] = ["r comes 3.9 s later than the slope of psi"]
    assert said in " ".join(" ".join(lines(run, lines=60)).split())
    assert said in page(result_of(run), [])
