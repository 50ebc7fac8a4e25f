"""What a person can ask for: done in the file, and nothing else, or refused in one line."""

import json
import math
import os
import random
import tomllib
from pathlib import Path
from typing import Any

import pytest
import quick

from trialid.errors import TrialidError
from trialid.pipeline_file import Pipeline, load, read
from trialid.workbench.wishes import Granted, find_edit, grant, read_wish

LINE = 400


@pytest.fixture(scope="module")
def recipe(tmp_path_factory: pytest.TempPathFactory) -> Pipeline:
    return load(quick.write(tmp_path_factory.mktemp("wishes")))


def ask(recipe: Pipeline, do: str, **what: Any) -> Granted:
    return grant(recipe, read_wish({"version": "", "do": do, **what}))


def told(granted_: Granted) -> dict[str, Any]:
    return tomllib.loads(granted_.after.text)


def test_every_wish_changes_what_it_says_and_nothing_else(recipe: Pipeline) -> None:
    data = tomllib.loads(recipe.text)
    added = ask(recipe, "add", effect=quick.ADDED)
    assert told(added)["model"]["effects"] == [*data["model"]["effects"], quick.ADDED]
    assert added.edit is not None
    assert (added.words, added.edit.step) == (f"add {quick.ADDED}", "added")
    dropped = ask(recipe, "drop", effect=quick.SPARE)
    assert dropped.edit is not None
    assert (dropped.words, dropped.edit.step) == (f"drop {quick.SPARE}", "dropped")
    assert quick.SPARE not in dropped.after.text
    fixed = ask(recipe, "free", parameter="GM", free=False)
    assert (fixed.words, fixed.edit) == ("fix GM", None)
    free = [n for n in data["identify"]["free"] if n != "GM"]
    assert told(fixed) == {**data, "identify": {**data["identify"], "free": free}}
    freed = ask(fixed.after, "free", parameter="GM", free=True)
    assert freed.words == "free GM"
    assert freed.after.identify.free == (*free, "GM")
    bound = ask(recipe, "bounds", parameter="GM", low=-0.5, high=3.0)
    assert bound.words == "bounds of GM -0.5 to 3"
    assert told(bound)["identify"].pop("bounds") == {"GM": [-0.5, 3.0]}
    unbound = ask(bound.after, "bounds", parameter="GM", low=None, high=None)
    assert (unbound.words, unbound.after.text) == ("no bounds of GM", recipe.text)
    valued = ask(recipe, "value", parameter="Ydelta", value=2)
    assert (valued.words, told(valued)["model"]["values"]) == ("Ydelta = 2", {"Ydelta": 2.0})
    own = ask(valued.after, "value", parameter="Ydelta", value=None)
    assert (own.words, own.after.text) == ("no value of Ydelta", recipe.text)
    used = ask(recipe, "use", trial="late", use="fit")
    assert (used.words, [t.use for t in used.after.trials]) == ("late fitted", ["fit", "fit"])
    held = ask(used.after, "use", trial="early", use="check")
    assert (held.words, [t.use for t in held.after.trials]) == ("early held out", ["check", "fit"])


def test_a_bound_may_be_on_one_side_alone(recipe: Pipeline) -> None:
    above = ask(recipe, "bounds", parameter="GM", low=0.1, high=None)
    assert dict(above.after.identify.bounds) == {"GM": (0.1, math.inf)}
    assert above.words == "bounds of GM 0.1 to inf"
    below = ask(above.after, "bounds", parameter="GM", low=None, high=9.0)
    assert dict(below.after.identify.bounds) == {"GM": (-math.inf, 9.0)}


@pytest.mark.parametrize(("wish", "words"), [
    ({"do": "add", "effect": "righting_arm_cubik"}, ("no effect", "righting_arm_cubic")),
    ({"do": "add", "effect": quick.SPARE}, ("is there already",)),
    ({"do": "drop", "effect": quick.ADDED}, ("is not there",)),
    ({"do": "free", "parameter": "GM", "free": True}, ("GM is free already",)),
    ({"do": "free", "parameter": "Ydelta", "free": False}, ("Ydelta is fixed already",)),
    ({"do": "free", "parameter": "Nx", "free": True}, ("identify.free", "'Nx'")),
    ({"do": "bounds", "parameter": "GM", "low": 2.0, "high": 1.0}, ("identify.bounds.GM",)),
    ({"do": "bounds", "parameter": "GM", "low": None, "high": None}, ("it is so already",)),
    ({"do": "bounds", "parameter": "Ydelta", "low": 0.0, "high": 1.0}, ("Ydelta",)),
    ({"do": "bounds", "parameter": "GM", "low": 99.0, "high": None}, ("the start", "untick GM")),
    ({"do": "value", "parameter": "Nx", "value": 1.0}, ("model.values.Nx",)),
    ({"do": "value", "parameter": "GM", "value": None}, ("it is so already",)),
    ({"do": "use", "trial": "lat", "use": "fit"}, ("no trial 'lat'", "'late'")),
    ({"do": "use", "trial": "late", "use": "check"}, ("late is held out already",)),
    ({"do": "use", "trial": "early", "use": "fit"}, ("early is fitted already",)),
    ({"do": "use", "trial": "early", "use": "check"}, ("no trial to fit",)),
    ({"do": "use", "trial": "early", "use": "test"}, ("use: ",)),
    ({"do": "value", "parameter": "GM", "value": "1,5"}, ("value: ", "number")),
    ({"do": "value", "parameter": "GM", "value": "1.5"}, ("value: ", "number")),
    ({"do": "value", "parameter": "GM", "value": True}, ("value: ", "number")),
    ({"do": "value", "parameter": "GM", "value": float("nan")}, ("value: ", "finite")),
    ({"do": "value", "parameter": "GM", "value": float("inf")}, ("value: ", "finite")),
    ({"do": "value", "parameter": "GM", "value": 10**400}, ("value: ",)),
    ({"do": "value", "parameter": "GM"}, ("value: ", "required")),
    ({"do": "free", "parameter": "GM", "free": "no"}, ("free: ",)),
    ({"do": "add", "effect": ["x"]}, ("effect: ",)),
    ({"do": "add", "effect": "\ud800"}, ("effect: ",)),
    ({"do": "add", "effect": quick.ADDED, "more": 1}, ("more: ",)),
    ({"do": "remove", "effect": quick.ADDED}, ("edit: ", "'add'")),
    ({"do": "\ud800"}, ("edit: ",)),
    ({"do": None}, ("edit: ",)),
    ({}, ("edit: ",)),
    ({"do": "add", "effect": quick.ADDED, "version": None}, ("version: ",)),
])  # fmt: skip
def test_what_cannot_be_is_one_line(recipe: Pipeline, wish: Any, words: tuple[str, ...]) -> None:
    with pytest.raises(TrialidError) as caught:
        grant(recipe, read_wish({"version": "", **wish}))
    said = str(caught.value)
    said.encode()
    assert "\n" not in said
    assert len(said) < LINE
    assert [word for word in words if word not in said] == [], said


@pytest.mark.parametrize("asked", [None, [], "add", 3, {"version": ""}, {"do": "add"}])
def test_what_is_no_wish_is_refused(asked: object) -> None:
    with pytest.raises(TrialidError):
        read_wish(asked)


def test_the_copy_in_a_run_s_folder_is_what_ran(recipe: Pipeline, tmp_path: Path) -> None:
    """Refused when the edit is asked for, and not after it was fitted."""
    stood = os.path.relpath(recipe.path, tmp_path)
    (tmp_path / "run.json").write_text(json.dumps({"pipeline": stood}), encoding="utf-8")
    copy = read(recipe.content, tmp_path / "pipeline.toml")
    with pytest.raises(TrialidError, match="is what a finished run was made from"):
        ask(copy, "drop", effect=copy.model.effects[-1])
    assert ask(recipe, "drop", effect=recipe.model.effects[-1]).edit is not None


@pytest.mark.study(turn="each")
def test_strange_wishes_end_in_a_line_or_in_a_pipeline(recipe: Pipeline) -> None:
    """Whatever is asked for, what comes back can be loaded, and holds no more than was asked."""
    chance = random.Random(1)
    good = ["GM", "Yv", "Ydelta", "early", "late", quick.ADDED, quick.SPARE, "fit", "check"]
    texts = [*3 * good, "", "\n", '"', "]", "#", "a.b", "\x00", "\ud800", "[model]", "é",
             "x" * 3000, "'''", "\\"]  # fmt: skip
    numbers = [0, -1, 1e308, -1e308, 5e-324, 1e-7, float("nan"), 10**30, None, True]
    kinds = {"add": ["effect"], "drop": ["effect"], "free": ["parameter", "free"],
             "bounds": ["parameter", "low", "high"], "value": ["parameter", "value"],
             "use": ["trial", "use"]}  # fmt: skip
    done = 0
    for _ in range(600):
        do = chance.choice(list(kinds))
        names = {"effect", "parameter", "trial", "use"}
        wish = {key: chance.choice(texts if key in names else numbers) for key in kinds[do]}
        try:
            found = grant(recipe, read_wish({"version": "", "do": do, **wish}))
        except TrialidError as error:
            said = str(error)
            said.encode()
            assert "\n" not in said, wish
            continue
        done += 1
        assert found.after == read(found.after.content, recipe.path)
        assert "\n" not in found.words
    assert done > 20


def test_the_effect_by_which_two_pipelines_differ(recipe: Pipeline) -> None:
    added = ask(recipe, "add", effect=quick.ADDED).after
    edit = find_edit(recipe, added)
    assert edit is not None
    assert (edit.step, edit.effect.name, edit.after) == ("added", quick.ADDED, added)
    back = find_edit(added, recipe)
    assert back is not None
    assert (back.step, back.effect.name, back.after) == ("dropped", quick.ADDED, recipe)
    assert find_edit(recipe, recipe) is None
    two = ask(added, "add", effect=quick.OTHER).after
    assert find_edit(recipe, two) is None
    fixed = ask(recipe, "free", parameter="GM", free=False).after
    assert find_edit(recipe, fixed) is None


def test_no_edit_is_seen_where_the_effect_is_not_to_be_had(tmp_path: Path) -> None:
    path = quick.with_own(tmp_path)
    own = load(path)
    without = ask(own, "drop", effect="mine").after
    (tmp_path / "mine.py").write_text("def\n", encoding="utf-8")
    assert find_edit(without, own) is None
    assert find_edit(own, without) is None


def test_a_wish_is_read_as_json_gives_it() -> None:
    wish = read_wish(json.loads('{"version": "v", "do": "value", "parameter": "GM", "value": 1}'))
    assert (wish.version, wish.parameter, wish.value) == ("v", "GM", 1.0)
