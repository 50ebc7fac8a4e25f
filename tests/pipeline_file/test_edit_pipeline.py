"""An effect put into a pipeline's text and taken out: nothing else changes, byte for byte."""

import copy
import os
import signal
import stat
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trialid.errors import PipelineError
from trialid.pipeline_file.array_text import with_name, without_name
from trialid.pipeline_file.edit import (
    add_effect,
    drop_effect,
    fix_parameter,
    set_bounds,
    set_free,
    set_use,
    set_value,
    start_at,
)
from trialid.pipeline_file.rewrite import rewriting

ROOT = Path(__file__).parents[2]
PIPELINES = sorted(
    path
    for folder in ("pipelines", "tests/real_records")
    for path in (ROOT / folder).glob("*.toml")
    if "trial" in tomllib.loads(path.read_text(encoding="utf-8"))
)
OWN = ("P1", "P2")

LISTS = (
    "[]", "[ ]", "[\n]", "[ # none yet\n]", '["a"]', '[ "a" ]', '["a",]', '["a", "b"]',
    '["a", "b", ]', '["a" , "b" , ]', "['a', \"b\"]", '["""a""", "b"]', r'["a\"]", "b"]',
    '[\n  "a",\n  "b",\n]', '[\n  "a",\n  "b"\n]', '[\n\t"a", "b",\n\t"c"]',
    '[\n  "a",  # the "hull" ]\n  "b"  # last\n]', '[\n  "a",  # one\n  "b",  # two\n]',
    '["a",  # one\n "b"]', '["a",  # one\n]', '["a"  # one\n]', '["a"\n, "b"\n]',
    '["a"\n, # late\n]', '[\n  "a",\n  # "old",\n]', '["a",\n\n  "b",\n\n]',
)  # fmt: skip
FORMS = {
    "tables": '# [model]\n[model]\neffects = {}  # the model\n\n[identify]\nfree = {}  # ["a"]\n',
    "dotted": "model.effects = {}\nidentify.free   =   {}\n",
    "inline": "model = {{ states = [], effects = {} }} # x\nidentify = {{ free = {} }}\n",
    "twice": 'same = ["a"]\n[model]\nstates = ["a"]\neffects = {}\n[identify]\nfree = {}',
    "apart": "[model]\neffects = {}\n[x]\ny = 1\n[identify]\nfree = {}\n[model.values]\nq = 1\n",
}


def edited(text: str) -> str:
    """The text with an effect more, which is all that it says more."""
    more = add_effect(text, "new", OWN)
    old, new = (tomllib.loads(t.removeprefix("\ufeff")) for t in (text, more))
    old["model"]["effects"].append("new")
    old["identify"]["free"] += OWN
    assert new == old
    return more


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("written", LISTS)
@pytest.mark.parametrize(("ends", "mark"), [("\n", ""), ("\r\n", ""), ("\n", "\ufeff")])
def test_drop_takes_out_what_add_put_in(form: str, written: str, ends: str, mark: str) -> None:
    if form == "inline" and "\n" in written:
        written = '["a"]'  # an inline table is one line
    text = mark + FORMS[form].format(written, written).replace("\n", ends)
    assert drop_effect(edited(text), "new", OWN) == (text, ())


@pytest.mark.parametrize("path", PIPELINES, ids=lambda path: path.stem)
def test_drop_restores_every_pipeline(path: Path) -> None:
    text = path.read_bytes().decode("utf-8")
    more = edited(text)
    assert [line for line in text.splitlines() if "#" in line and line not in more] == []
    assert drop_effect(more, "new", OWN) == (text, ())


def test_a_name_gets_its_own_line_where_names_have_lines() -> None:
    text = '[\n  "a", "b",\n  "c",  # third\n]'
    assert with_name(text, "d") == '[\n  "a", "b",\n  "c",  # third\n  "d",\n]'


@pytest.mark.parametrize("written", LISTS)
@pytest.mark.parametrize("name", ["a", "b", "c"])
def test_a_name_written_by_hand_goes_too(written: str, name: str) -> None:
    before = tomllib.loads(f"x = {written}")["x"]
    if name in before:
        after = without_name(written, name)
        assert tomllib.loads(f"x = {after}")["x"] == [n for n in before if n != name]


def test_comments_stay_but_for_one_on_the_names_own_line() -> None:
    text = '[\n  "a",  # first\n  # between\n  "b",  # second\n  "c", "d",  # both\n]'
    assert without_name(text, "b") == '[\n  "a",  # first\n  # between\n  "c", "d",  # both\n]'
    assert without_name(text, "c") == (
        '[\n  "a",  # first\n  # between\n  "b",  # second\n  "d",  # both\n]'
    )


SPACE = st.sampled_from(["", " ", "\n", "\n  ", "  # x ]\n", "\r\n\t"])


@given(st.data())
def test_any_array_is_restored(data: st.DataObject) -> None:
    names = data.draw(st.lists(st.sampled_from("abc"), unique=True, max_size=3))
    text = "[" + data.draw(SPACE)
    for i, name in enumerate(names):
        last = i + 1 == len(names)
        comma = data.draw(st.sampled_from(["", ","])) if last else ","
        text += f'"{name}"' + data.draw(SPACE) + comma + data.draw(SPACE)
    text += "]"
    more = with_name(with_name(text, "x"), "y")
    assert tomllib.loads(f"q = {more}")["q"] == [*names, "x", "y"]
    assert without_name(without_name(more, "y"), "x") == text


# --- what the user wrote of an effect's parameters ----------------------------------------------


SAID = """\
[model]
effects = ["hull", "new"]
values = { P1 = 2.0, other = { value = 1.0, unit = "m" } }  # kept

[identify]
free = ["Yv", "P2"]
[identify.priors]
Yv = { mean = 1.0, std = 0.1 }
P2 = { mean = 2.0, std = 0.5 }  # from the basin
[identify.bounds]
# of the hull
P2 = [0.0, 9.0]
"""


def test_drop_says_what_of_the_users_goes_with_the_effect() -> None:
    text, said = drop_effect(SAID, "new", OWN)
    assert said == (
        "identify.priors.P2 = { mean = 2.0, std = 0.5 }",
        "identify.bounds.P2 = [0.0, 9.0]",
        "model.values.P1 = 2.0",
    )
    data = tomllib.loads(text)
    assert data["model"]["effects"] == ["hull"]
    assert data["identify"]["free"] == ["Yv"]
    assert data["identify"]["priors"] == {"Yv": {"mean": 1.0, "std": 0.1}}
    assert set(data["model"]["values"]) == {"other"}
    assert "# kept" in text
    assert "# of the hull" in text
    for words in said:  # it can be put back from what was said
        assert tomllib.loads(words)


@pytest.mark.parametrize("entry", [
    "priors = { P2 = { mean = 2.0, std = 0.5 } }", "priors.P2 = { mean = 2.0, std = 0.5 }",
    "priors.P2.mean = 2.0\npriors.P2.std = 0.5", "[identify.priors.P2]\nmean = 2.0\nstd = 0.5",
    "[identify.priors]\nP2 = { mean = 2.0, std = 0.5 }",
])  # fmt: skip
def test_a_prior_goes_however_it_is_written(entry: str) -> None:
    head = '# top\n[model]\neffects = ["new"]\n[identify]\nfree = ["P1", "Yv"]\n'
    text, said = drop_effect(f"{head}{entry}\n", "new", OWN)
    assert said == ("identify.priors.P2 = { mean = 2.0, std = 0.5 }",)
    data = tomllib.loads(text)
    assert data["identify"]["free"] == ["Yv"]
    assert not data["identify"].get("priors")
    assert text.startswith("# top\n")


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("ends", ["\n", "\r\n"])
def test_a_start_is_put_in_and_taken_out(form: str, ends: str) -> None:
    """In a line of its own where the form of the file has lines."""
    text = FORMS[form].format('["a"]', '["b"]').replace("\n", ends)
    started = start_at(start_at(edited(text), "P1", 0.5), "P2", -2e-5)
    values = tomllib.loads(started)["model"]["values"]
    assert (values["P1"], values["P2"]) == (0.5, -2e-5)
    dropped, said = drop_effect(started, "new", OWN)
    if form in ("inline", "apart"):
        assert said == ("model.values.P1 = 0.5", "model.values.P2 = -2e-05")
        old = tomllib.loads(text)
        new = tomllib.loads(dropped)
        assert new["model"].pop("values", {}) == old["model"].pop("values", {})
        assert new == old
    else:
        assert (dropped, said) == (text, ())


@pytest.mark.parametrize(("text", "words"), [
    ("[identify]\nfree = []", "model.effects: missing"),
    ("[model]\neffects = []", "identify.free: missing"),
    ("model = 3\n[identify]\nfree = []", "model.effects: missing"),
    ("[model", "not TOML"),
])  # fmt: skip
def test_a_text_without_the_lists_is_refused(text: str, words: str) -> None:
    with pytest.raises(PipelineError, match=words):
        add_effect(text, "new", OWN)


# --- one setting of a parameter or of a trial ---------------------------------------------------


Data = dict[str, Any]
WAYS = [("\n", ""), ("\r\n", ""), ("\n", "\ufeff")]


def data_of(text: str) -> Data:
    return tomllib.loads(text.removeprefix("\ufeff"))


def no_empty(value: Any) -> Any:
    """Data without tables that are empty: they say nothing."""
    if not isinstance(value, dict):
        return value
    kept = {key: no_empty(each) for key, each in value.items()}
    return {key: each for key, each in kept.items() if each != {}}


def changed(text: str, new: str, expect: Callable[[Data], object]) -> str:
    """A new text, which says what the old one said but for what is expected, in the old form."""
    wanted = copy.deepcopy(data_of(text))
    expect(wanted)
    assert no_empty(data_of(new)) == no_empty(wanted)
    assert new.startswith("\ufeff") == text.startswith("\ufeff")
    if "\r\n" in text:
        assert "\n" not in new.replace("\r\n", "")
    else:
        assert "\r" not in new
    comments = [line.partition("#")[2] for line in text.splitlines() if "#" in line]
    assert [comment for comment in comments if comment not in new] == []
    return new


def told(data: Data, section: str, table: str) -> Data:
    """A table of a section, made where it is not there."""
    return data.setdefault(section, {}).setdefault(table, {})


def few_lines(text: str, new: str) -> bool:
    """Whether no more than one line is other than it was, or new; a blank one may come with it."""
    old, now = ([line for line in t.splitlines() if line] for t in (text, new))
    return len(set(old) - set(now)) <= 1 and len(now) - len(old) in (0, 1)


@pytest.mark.parametrize(("ends", "mark"), WAYS)
@pytest.mark.parametrize("path", PIPELINES, ids=lambda path: path.stem)
def test_one_setting_of_every_pipeline(path: Path, ends: str, mark: str) -> None:
    text = mark + path.read_text(encoding="utf-8").replace("\n", ends)
    free = data_of(text)["identify"]["free"]
    more = set_free(text, "new")
    changed(text, more, lambda d: d["identify"]["free"].append("new"))
    assert fix_parameter(more, "new") == (text, ())
    bound = set_bounds(text, free[0], (-1.5, 2e-5))
    expect = {free[0]: [-1.5, 2e-5]}
    changed(text, bound, lambda d: told(d, "identify", "bounds").update(expect))
    value = set_value(text, free[0], -2.5e-4)
    changed(text, value, lambda d: told(d, "model", "values").update({free[0]: -2.5e-4}))
    for i in range(len(data_of(text)["trial"])):
        for use in ("fit", "check"):
            one = set_use(text, i, use)
            changed(text, one, lambda d, i=i, use=use: d["trial"][i].update(use=use))
            assert few_lines(text, one)
    assert few_lines(text, more)
    assert few_lines(text, bound)
    assert few_lines(text, value)
    assert no_empty(data_of(set_bounds(bound, free[0], None))) == _without(
        text, "identify", free[0]
    )


def _without(text: str, section: str, name: str) -> Data:
    data = data_of(text)
    told(data, section, "bounds").pop(name, None)
    return no_empty(data)


SETTINGS = {
    "none": "# top\n[model]\neffects = []  # none\n[identify]\nfree = ['GM', 'Yv']  # both\n",
    "inline": "[model]\neffects = []\nvalues = { Yv = 1.0 }  # of Yv\n"
    "[identify]\nfree = ['GM', 'Yv']\nbounds = { Yv = [0.0, 1] }  # of Yv\n",
    "dotted": "[model]\neffects = []\nvalues.Yv = 1.0  # of Yv\n"
    "[identify]\nfree = ['GM', 'Yv']\nbounds.Yv = [0.0, 1]  # of Yv\n",
    "tables": "[model]\neffects = []\n[model.values]\nYv = 1.0  # of Yv\n"
    "[identify]\nfree = ['GM', 'Yv']\n# of them all\n[identify.bounds]\nYv = [0.0, 1]  # of Yv\n"
    "[other]\nGM = 3  # not this\n",
    "one": "model = { effects = [], values = { Yv = 1.0 } }  # one line\n"
    "identify = { free = ['GM', 'Yv'], bounds = { Yv = [0.0, 1] } }\n",
    "start": "[model]\neffects = []\nvalues.Yv = 1.0  # start, by linearisation\n"
    "[identify]\nfree = ['GM', 'Yv']\n",
}


@pytest.mark.parametrize(("ends", "mark"), WAYS)
@pytest.mark.parametrize("form", SETTINGS)
@pytest.mark.parametrize("name", ["GM", "Yv"])
def test_a_setting_in_every_form(form: str, name: str, ends: str, mark: str) -> None:
    """Set where there is none, set over another, and taken out again."""
    text = mark + SETTINGS[form].replace("\n", ends)
    own = text.replace("  # start, by linearisation", "")  # marks a line that is not the user's
    for value in (0.25, -3.0, 1e-7):
        bound = set_bounds(text, name, (value, 4.0))
        expect = {name: [value, 4.0]}
        changed(text, bound, lambda d, e=expect: told(d, "identify", "bounds").update(e))
        valued = set_value(text, name, value)
        wanted = copy.deepcopy(data_of(text))
        told(wanted, "model", "values")[name] = value
        assert data_of(valued) == wanted
        if form != "start" or name == "GM":
            changed(own, valued.replace("  # start, by linearisation", ""),
                    lambda d, v=value: told(d, "model", "values").update({name: v}))  # fmt: skip
    for table, undone in (
        (("identify", "bounds"), set_bounds(bound, name, None)),
        (("model", "values"), set_value(valued, name, None)),
    ):
        wanted = copy.deepcopy(data_of(text))
        told(wanted, *table).pop(name, None)
        assert no_empty(data_of(undone)) == no_empty(wanted)


def test_a_start_by_linearisation_gives_way_to_ones_own() -> None:
    text = SETTINGS["start"]
    assert set_value(text, "Yv", None) == text.replace(
        "values.Yv = 1.0  # start, by linearisation\n", ""
    )
    assert "linearisation" not in set_value(text, "Yv", 2.0)
    assert "linearisation" in set_value(text, "GM", 2.0)


@pytest.mark.parametrize(("ends", "mark"), WAYS)
def test_what_is_fixed_loses_its_prior_and_bounds_and_keeps_its_value(ends: str, mark: str) -> None:
    text = mark + SAID.replace("\n", ends)
    fixed, said = fix_parameter(text, "P2")
    assert said == (
        "identify.priors.P2 = { mean = 2.0, std = 0.5 }",
        "identify.bounds.P2 = [0.0, 9.0]",
    )
    wanted = data_of(text)
    wanted["identify"]["free"] = ["Yv"]
    del wanted["identify"]["priors"]["P2"], wanted["identify"]["bounds"]
    assert no_empty(data_of(fixed)) == wanted
    assert fix_parameter(fixed, "Yv")[1] == ("identify.priors.Yv = { mean = 1.0, std = 0.1 }",)


@pytest.mark.parametrize("name", ["", "a b", 'a"b', "a\nb", "a.b", "\u00e9", "\x00", "'", "#", "]"])
@pytest.mark.parametrize("form", SETTINGS)
def test_a_strange_name_is_written_right_or_refused(name: str, form: str) -> None:
    text = SETTINGS[form]
    for change, section, key, value in (
        (lambda: set_free(text, name), "identify", "free", ["GM", "Yv", name]),
        (lambda: set_bounds(text, name, (0.0, 1.0)), "identify", "bounds", [0.0, 1.0]),
        (lambda: set_value(text, name, 1.0), "model", "values", 1.0),
    ):
        try:
            new = change()
        except PipelineError:
            continue
        wanted = data_of(text)
        if key == "free":
            wanted[section][key] = value
        else:
            told(wanted, section, key)[name] = value
        assert data_of(new) == wanted


# --- the file replaced at one stroke ------------------------------------------------------------


def test_nothing_happens_before_the_stroke(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(b"old")
    with pytest.raises(KeyboardInterrupt), rewriting(path, b"old", b"new"):
        raise KeyboardInterrupt
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_rights_and_links_are_kept(tmp_path: Path) -> None:
    real, link = tmp_path / "real.toml", tmp_path / "link.toml"
    real.write_bytes(b"old")
    real.chmod(0o640)
    link.symlink_to(real.name)
    with rewriting(link, b"old", b"new") as stroke:
        stroke()
    assert link.is_symlink()
    assert real.read_bytes() == b"new"
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    assert sorted(tmp_path.iterdir()) == [link, real]


@pytest.mark.parametrize("when", ["before", "within"])
def test_what_somebody_else_has_written_is_left_alone(tmp_path: Path, when: str) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(b"theirs" if when == "before" else b"old")
    with pytest.raises(PipelineError, match="was changed meanwhile"):
        _rewritten_late(path)
    assert path.read_bytes() == b"theirs"
    assert list(tmp_path.iterdir()) == [path]


def _rewritten_late(path: Path) -> None:
    with rewriting(path, b"old", b"new") as stroke:
        path.write_bytes(b"theirs")
        stroke()


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_file_without_the_right_to_write(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(b"old")
    path.chmod(0o400)
    with pytest.raises(PipelineError, match="cannot be written"), rewriting(path, b"old", b"new"):
        pass


def test_killed_at_the_stroke_the_file_is_the_old_one(tmp_path: Path) -> None:
    """SIGKILL, which nothing can tidy up after, the moment before the new file takes its place."""
    (tmp_path / "a.toml").write_bytes(b"old")
    code = (
        "import os, signal\nfrom pathlib import Path\n"
        "from trialid.pipeline_file.rewrite import rewriting\n"
        "Path.replace = lambda *_: os.kill(os.getpid(), signal.SIGKILL)\n"
        "with rewriting(Path('a.toml'), b'old', b'new') as stroke:\n    stroke()\n"
    )
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, check=False, timeout=60,
        env={**os.environ, "PYTHONPATH": path},
    )  # fmt: skip
    assert done.returncode == -signal.SIGKILL
    assert (tmp_path / "a.toml").read_bytes() == b"old"
