import json

from trialid.report.shape import SHAPE, Each, Maybe, whole


def test_a_full_result_is_left_as_it_is(result):
    run = whole(result)
    for key in ("trials", "model", "fit", "missing", "history", "where"):
        assert run[key] == result[key]
    pair = {k: v for k, v in result["before_after"].items() if k != "parameters"}
    assert run["before_after"] | pair == run["before_after"]


def test_everything_is_there_and_unknown_when_nothing_is_given():
    run = whole({})
    assert set(run) == set(SHAPE)
    assert run["fit"]["eps_rmsn"] is None
    assert run["fit"]["eps_rmsn_by_output"] == {}
    assert run["accuracy"]["stability"] is None
    assert run["split"]["routes"] == []


def test_null_and_absent_are_the_same(result):
    nothing = dict.fromkeys(SHAPE)
    assert whole(nothing) == whole({})


def test_what_the_schema_does_not_know_is_kept():
    assert whole({"fit": {"note": "kept"}})["fit"]["note"] == "kept"


def test_survives_json(result):
    assert whole(json.loads(json.dumps(result))) == whole(result)


def test_shape_is_made_of_its_few_pieces():
    def walk(shape):
        match shape:
            case None:
                return
            case Maybe(inner) | Each(inner):
                walk(inner)
            case [row]:
                walk(row)
            case dict():
                for inner in shape.values():
                    walk(inner)
            case _:
                raise AssertionError(shape)

    walk(SHAPE)
