"""What a comparison of structures keeps, what it does not do again, and how it is told."""

import json
import shutil

import jsonschema
import pytest
from compared import FITS, result_in, run

import trialid as ti
from trialid.pipeline_file import load
from trialid.report.words.structure_words import sentences
from trialid.result.json_file import plain
from trialid.result.structure_rows import StructureRow, Structures
from trialid.workflow.structures.compare_structures import compare_structures

# --- what is kept -------------------------------------------------------------------------------


@pytest.mark.study(turn=4)
def test_an_interrupted_comparison_goes_on_and_ends_the_same(
    done, turning, tmp_path, count
) -> None:
    folder = tmp_path / "again"
    count["stop"] = 9
    said = run(turning, "--out", folder)
    assert said.exit_code == 130
    assert not (folder / "structures.json").exists()
    count["stop"] = None
    assert run(turning, "--out", folder).exit_code == 0
    assert count["fits"] == FITS
    assert result_in(folder) == result_in(done[0])


def test_a_second_run_fits_nothing_and_a_new_list_only_its_own(done, copy, tmp_path, count) -> None:
    folder = shutil.copytree(done[0], tmp_path / "kept")
    assert run(copy, "--out", folder).exit_code == 0
    assert count["fits"] == 0
    text = copy.read_text(encoding="utf-8") + 'drag = ["yaw_drag_rar"]\n'
    copy.write_text(text.replace("steps of the rudder", "renamed"), encoding="utf-8")
    assert run(copy, "--out", folder, "--quick").exit_code == 0
    assert count["fits"] == 5
    assert len(result_in(folder).rows) == 4


@pytest.mark.parametrize("change", ["log", "ship", "settings", "use"])
def test_what_went_in_and_is_another_is_fitted_again(done, copy, tmp_path, count, change) -> None:
    folder = shutil.copytree(done[0], tmp_path / "kept")
    if change == "log":
        log = copy.parent / "steps-20.csv"
        text = log.read_text(encoding="utf-8")
        log.write_text(text.replace("100,", "100.0001,", 1), encoding="utf-8")
    elif change == "ship":
        ship = copy.parent / "s175q.toml"
        text = ship.read_text(encoding="utf-8")
        ship.write_text(text.replace("m = 0.00792", "m = 0.00793"), encoding="utf-8")
    else:
        words = {
            "settings": ('nuisance = ["initial_state"]', 'nuisance = ["initial_state", "bias"]'),
            "use": ('use = "check"', 'use = "fit"'),
        }
        text = copy.read_text(encoding="utf-8")
        copy.write_text(text.replace(*words[change]), encoding="utf-8")
    assert run(copy, "--out", folder, "--quick").exit_code == 0
    assert count["fits"] == 3 * (6 if change == "use" else 5)


def test_fits_that_cannot_be_read_are_made_anew(done, turning, tmp_path, count) -> None:
    """A file of ours that was edited is not replaced; one that was lost is."""
    folder = shutil.copytree(done[0], tmp_path / "kept")
    (folder / "fits.json").write_text("{", encoding="utf-8")
    said = run(turning, "--out", folder)
    assert (said.exit_code, count["fits"]) == (2, 0)
    assert "was changed since it was written" in said.stderr
    assert (folder / "fits.json").read_text(encoding="utf-8") == "{"
    (folder / "fits.json").unlink()
    assert run(turning, "--out", folder, "--quick").exit_code == 0
    assert count["fits"] == 15


@pytest.mark.parametrize("name", ["structures.json", "fits.json", "notes.txt"])
def test_a_folder_of_somebody_elses_is_left_alone(turning, tmp_path, name, count) -> None:
    (tmp_path / name).write_text("mine", encoding="utf-8")
    said = run(turning, "--out", tmp_path)
    assert (said.exit_code, count["fits"]) == (2, 0)
    assert "choose another --out" in said.stderr
    assert [p.name for p in tmp_path.iterdir()] == [name]


def test_a_file_is_no_folder(turning, tmp_path, count) -> None:
    (tmp_path / "there").write_text("mine", encoding="utf-8")
    said = run(turning, "--out", tmp_path / "there")
    assert (said.exit_code, count["fits"]) == (2, 0)
    assert "is a file; --out takes a folder" in said.stderr


# --- how it is told -----------------------------------------------------------------------------


def test_the_table_fits_a_terminal_and_says_what_is_chosen(done) -> None:
    shown = done[1]
    assert max(map(len, shown.splitlines())) <= 80
    [line] = [x for x in shown.splitlines() if x.endswith("chosen")]
    assert line.startswith("cross-flow, race   ")
    assert "4 of 4 choices are the same" in " ".join(shown.split())
    assert str(done[0] / "structures.json") in shown


def test_structures_json_is_of_its_schema(done, turning) -> None:
    schema = json.loads(run("--schema").stdout)
    jsonschema.Draft202012Validator.check_schema(schema)
    data = json.loads((done[0] / "structures.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator(schema).validate(data)
    assert data == json.loads(json.dumps(plain(result_in(done[0]))))
    assert len(data["logs"]) == 5
    told = run(turning, "--out", done[0], "--json", "--quiet")
    assert json.loads(told.stdout) == data


def test_python_gives_the_same_as_tables(done, turning, capfd) -> None:
    found = ti.structures(turning, done[0])
    assert found.result == result_in(done[0])
    assert capfd.readouterr() == ("", "")
    assert list(found.errors.columns) == list(found.result.trials)
    mean = found.errors.loc["cross-flow"].mean()
    assert found.table.loc["cross-flow", "eps_rmsn_left_out"] == pytest.approx(mean)
    assert repr(found).startswith("cross-flow, race (6 free parameters")


def test_progress_tells_which_fit_and_how_far(done, turning) -> None:
    told = []
    compare_structures(load(turning), lambda words, share: told.append((words, share)), done[0])
    shares = [share for words, share in told if words.startswith("fitting")]
    assert len(shares) == FITS
    assert shares == sorted(shares)
    assert 0.0 <= shares[0] < shares[-1] < 1.0
    assert told[-1][0] == "fitting cross-flow, race without steps-15 and steps-25"


def test_what_cannot_be_chosen_is_said() -> None:
    lost = StructureRow(name="cubic", why_not="without 10/10: the search does not arrive")
    alone = StructureRow(name="linear", parameters=4, eps_rmsn_left_out=0.2, behind=0.0)
    nothing = sentences(Structures(trials=("a", "b", "c"), rows=(lost,)))
    assert nothing == (
        "No structure can be chosen: none could be fitted with every trial left out in turn.",
    )
    one = Structures(
        trials=tuple("abcdef"),
        rows=(alone, lost),
        best="linear",
        chosen="linear",
        chosen_without={"a": "linear", "b": None},
    )
    first, unfinished, second = sentences(one)
    assert unfinished.startswith("Not compared, as their searches did not arrive: `cubic`; with")
    assert first.endswith("is the only structure that stands, so there was no choice.")
    assert "1 of 2 choices are the same; without b: none." in second


@pytest.mark.parametrize(("without", "sure"), [("race", True), ("modulus", False)])
def test_a_choice_that_hangs_on_single_trials_is_not_said_as_if_it_were_sure(without, sure) -> None:
    """An outsider's hull without a race got one, and without one trial four times of five none."""
    rows = (
        StructureRow(name="race", parameters=10, eps_rmsn_left_out=0.0442, behind=0.0),
        StructureRow(name="modulus", parameters=9, eps_rmsn_left_out=0.0451, behind=0.0009),
    )
    again = dict.fromkeys("abcd", without) | {"e": "race"}
    found = Structures(
        trials=tuple("abcde"), rows=rows, best="race", chosen="race", chosen_without=again
    )
    first = sentences(found)[0]
    assert first.endswith("none that is simpler is as good.") == sure
    told = "; but that is not sure: with one trial left out, 4 of 5 are modulus."
    assert first.endswith(told) != sure
