"""`result.json`: the keys it has, what may be unknown in it, and what is refused."""

import copy
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import pytest
from valid_result import assert_valid, validator

from trialid.errors import TrialidError
from trialid.result import json_file
from trialid.result.fit_rows import FitPart
from trialid.result.json_file import finite, json_schema, plain, result_of, text_of
from trialid.result.schema import SCHEMA, Result

KEYS = [
    "schema", "version", "versions", "pipeline", "file", "trials", "model", "fit", "split",
    "accuracy", "where", "where_else", "missing", "not_tried", "missing_force", "verdict", "imo",
    "sailed", "history", "before_after", "history_remark", "sources", "signals", "change", "grown",
]  # fmt: skip
"""The keys of `trialid-result/1` in their order: other programs read them."""


def as_file(data):
    """What is read back from the file that the result makes."""
    return json.loads(text_of(result_of(data)))


def assert_holds(given, kept, place="result"):
    """Everything given that the schema knows is kept as it was."""
    if isinstance(given, dict):
        for key in given.keys() & kept.keys():
            assert_holds(given[key], kept[key], f"{place}.{key}")
    elif isinstance(given, list):
        assert len(given) == len(kept), place
        for k, each in enumerate(given):
            assert_holds(each, kept[k], f"{place}[{k}]")
    else:
        assert kept == given, place


def test_a_full_result_is_left_as_it_is(result):
    kept = as_file(result)
    for key in result:
        assert_holds(result[key], kept[key], key)
    pair = {k: v for k, v in result["before_after"].items() if k != "parameters"}
    assert kept["before_after"] | pair == kept["before_after"]
    for key in ("fit", "accuracy", "where"):  # what the made-up result has of them is all of theirs
        assert result[key] == json.loads(json.dumps(result[key]))
        assert set(_keys(result[key])) <= set(_keys(kept[key])), key


def _keys(value):
    match value:
        case dict():
            yield from value
            for each in value.values():
                yield from _keys(each)
        case list():
            for each in value:
                yield from _keys(each)


def test_the_keys_of_the_first_schema_stay():
    assert SCHEMA == "trialid-result/1"
    assert list(as_file({})) == KEYS
    assert [each.name for each in fields(Result)] == KEYS
    assert list(json_schema()["properties"]) == KEYS


def test_everything_is_there_and_unknown_when_nothing_is_given():
    run = result_of({})
    assert list(plain(run)) == KEYS
    assert run == Result()
    assert run.fit.eps_rmsn is None
    assert run.fit.eps_rmsn_by_output == {}
    assert run.accuracy.stability is None
    assert run.split.routes == ()
    numbers = [v for v in _leaves(plain(run)) if isinstance(v, int | float) and v is not False]
    assert numbers == [], "what is not known is None, never 0"


def _leaves(value):
    match value:
        case dict():
            for each in value.values():
                yield from _leaves(each)
        case list() | tuple():
            for each in value:
                yield from _leaves(each)
        case _:
            yield value


def test_null_and_absent_are_the_same(result):
    """Where a key may be null; where it may not, null is refused by its name."""
    unknown = {each.name: each.default for each in fields(Result) if each.default is None}
    assert unknown.keys() == {
        *("missing_force", "imo", "sailed", "before_after", "history_remark", "change")
    }
    assert result_of(unknown) == result_of({})
    for key in KEYS:
        if key not in unknown:
            with pytest.raises(TrialidError, match=f"^{key}: input should be "):
                result_of({key: None})
    for each in fields(FitPart):
        if each.default is None:
            assert result_of({"fit": {each.name: None}}) == result_of({})


def test_what_the_schema_does_not_know_is_kept():
    """Names are the user's own: of outputs, parameters and effects the schema knows none."""
    assert result_of({"fit": {"y_rms": {"mine": 0.5}}}).fit.y_rms == {"mine": 0.5}
    assert as_file({"not_tried": {"mine": "why"}})["not_tried"] == {"mine": "why"}


def test_a_key_of_another_version_is_passed_over():
    later = {"fit": {"note": "of a later version", "eps_rmsn": 0.1}, "new": 1}
    assert result_of(later) == result_of({"fit": {"eps_rmsn": 0.1}})


def test_survives_json(result):
    run = result_of(result)
    assert result_of(json.loads(json.dumps(result))) == run
    again = result_of(json.loads(text_of(run)))
    assert again == run
    assert text_of(again) == text_of(run)


def test_a_number_keeps_every_digit_and_none_is_infinite():
    odd = 0.1 + 0.2
    assert as_file({"fit": {"eps_rmsn": odd}})["fit"]["eps_rmsn"] == odd
    lost = finite(FitPart(eps_rmsn=math.inf, y_rms={"r": 1.0}, V=math.nan))
    assert lost == FitPart(y_rms={"r": 1.0})
    with pytest.raises(ValueError, match="Out of range float"):
        text_of(Result(fit=FitPart(eps_rmsn=math.nan)))


EDITED = [
    (("fit", "eps_rmsn"), "small", "fit.eps_rmsn: input should be a valid number"),
    (("fit",), [], "fit: input should be "),
    (("trials", 1, "use"), "fits", "trials.1.use: input should be 'fit' or 'check'"),
    (("trials", 0, "logs", 0, "sha256"), 7, "trials.0.logs.0.sha256: input should be a valid str"),
    (("accuracy", "parameters", 3, "name"), None, "accuracy.parameters.3.name: input should be "),
    (("split", "interval", "noise"), [0.1], "split.interval.noise.1: field required"),
    (("history", 0, "step"), "guessed", "history.0.step: input should be 'as written'"),
    (("where", 0, "picture", "low"), None, "where.0.picture.bars.low: input should be "),
    (("where", 1, "picture", "density"), "x", "where.1.picture.spectrum.density: input should be "),
    (("missing", 2, "rank"), "first", "missing.2.rank: input should be a valid integer"),
]


@pytest.mark.parametrize(("place", "value", "says"), EDITED)
def test_an_edited_file_is_refused_in_one_line_with_its_key(
    tmp_path, result, place, value, says
):  # fmt: skip
    spoilt = as_file(result)
    path = tmp_path / "result.json"
    path.write_text(json.dumps(spoilt))
    assert json_file.read(path) == result_of(result)
    *above, last = place
    row = spoilt
    for key in above:
        row = row[key]
    row[last] = value
    path.write_text(json.dumps(spoilt))
    with pytest.raises(TrialidError) as refused:
        json_file.read(path)
    words = str(refused.value)
    assert words.startswith(f"{path}: {says}")
    assert words.endswith("; it was edited, run the pipeline anew")
    assert "\n" not in words
    assert not validator().is_valid(spoilt)


@pytest.mark.parametrize(("content", "says"), [
    ("{", "not JSON"),
    ("[1]", "not an object of JSON"),
    ("[" * 100_000, "not JSON"),
    ("{}", "schema None, expected 'trialid-result/1'"),
    ('{"schema": "trialid-result/2"}', "schema 'trialid-result/2', expected"),
    (None, "cannot be read"),
])  # fmt: skip
def test_another_file_is_no_result(tmp_path, content, says):
    path = tmp_path / "result.json"
    if content is not None:
        path.write_text(content)
    with pytest.raises(TrialidError) as refused:
        json_file.read(path)
    assert str(refused.value).startswith(f"{path}: {says}")


def test_the_json_schema_holds_for_a_result_and_for_none_that_was_edited(result):
    for given in ({}, result):
        assert_valid(as_file(given))
    spoilt = copy.deepcopy(as_file(result))
    spoilt["schema"] = "trialid-result/2"
    assert not validator().is_valid(spoilt)


PLAIN = {str, int, float, bool, NoneType}


def pieces(kind: Any) -> Iterator[Any]:
    """What a type of the schema is made of; anything else than its few pieces is an assertion."""
    inner = get_args(kind)
    match get_origin(kind):
        case None if is_dataclass(kind):
            yield from get_type_hints(kind, include_extras=True).values()
        case None:
            assert kind in PLAIN, kind
        case origin if origin is Literal:
            assert {type(word) for word in inner} == {str}, kind
        case origin if origin is Annotated:
            yield inner[0]
        case origin if origin in (Union, UnionType, tuple):
            yield from (each for each in inner if each is not Ellipsis)
        case origin:
            assert (origin, inner[0]) == (Mapping, str), kind
            yield inner[1]


def test_shape_is_made_of_its_few_pieces():
    """Frozen rows of plain values, tuples and mappings by name: nothing that JSON does not have."""
    rows, ahead = set(), [Result]
    while ahead:
        kind = ahead.pop()
        if kind not in rows:
            ahead += pieces(kind)
        if is_dataclass(kind):
            assert kind.__dataclass_params__.frozen, kind
            rows.add(kind)
    assert len(rows) > 25
