from dataclasses import replace

import pytest

from trialid.report.words.ranking import ranking, reason, remark
from trialid.result.finding_rows import VerdictPart
from trialid.result.json_file import result_of

NOW = {"fit": {"eps_rmsn": 0.10, "eps_rmsn_check": 0.12}}


def row(**known):
    plain = {
        "rank": 1,
        "effect": "an_effect",
        "eps_rmsn_predicted": 0.08,
        "eps_rmsn_refitted": 0.08,
    }
    run = result_of(NOW | {"missing": [plain | {"verdict": "stands out"} | known]})
    return run.missing[0], run


def test_every_candidate_stands_in_one_place(result):
    run = result_of(result)
    ranked = ranking(run)
    placed = [leader.row.effect for leader in ranked.leaders]
    placed += [each.effect for each in ranked.followers + ranked.others + ranked.hidden]
    placed += [each.effect for each, _ in ranked.ruled_out]
    assert sorted(placed) == sorted(each.effect for each in run.missing)
    assert placed[:3] == [each.effect for each in run.missing[:3]]
    assert ranked.not_tried == (("needs psi, which the record does not hold", ("steady_wind",)),)


def test_where_none_was_fitted_the_first_that_stand_out_lead():
    rows = [{"rank": k, "effect": str(k), "verdict": "stands out"} for k in range(5)]
    ranked = ranking(result_of({"missing": rows}))
    assert [leader.row.effect for leader in ranked.leaders] == ["0", "1", "2"]
    assert [each.effect for each in ranked.followers] == ["3", "4"]


def test_only_what_the_record_speaks_for_follows_and_no_more_than_a_screen_of_it():
    words = ["stands out"] * 12 + ["no evidence"] * 5
    rows = [{"rank": k, "effect": str(k), "verdict": word} for k, word in enumerate(words)]
    ranked = ranking(result_of({"missing": rows}))
    assert [each.effect for each in ranked.followers] == ["3", "4", "5", "6", "7", "8"]
    assert [each.effect for each in ranked.others] == [str(k) for k in range(9, 17)]


def test_where_the_record_speaks_for_none_three_are_shown():
    rows = [{"rank": k, "effect": str(k), "verdict": "no evidence"} for k in range(9)]
    ranked = ranking(result_of({"missing": rows}))
    assert ranked.leaders == ()
    assert [each.effect for each in ranked.followers] == ["0", "1", "2"]
    assert [each.effect for each in ranked.others] == [str(k) for k in range(3, 9)]


def test_bars_share_a_scale_and_drops_count_from_now():
    _, run = row(eps_rmsn_refitted=0.07, eps_rmsn_check=0.09)
    (leader,) = ranking(run).leaders
    assert [bar.length for bar in leader.bars] == pytest.approx(
        [100 * eps / 0.12 for eps in (0.10, 0.08, 0.07, 0.12, 0.09)]
    )
    assert [bar.drop for bar in leader.bars] == [
        None, pytest.approx(0.02), pytest.approx(0.03), None, pytest.approx(0.03),
    ]  # fmt: skip


def test_a_family_tells_how_alike_its_members_are():
    known, run = row(family=["an_effect", "other"], cosines={"other": 0.96})
    verdict = VerdictPart(effect="an_effect", family=("an_effect", "rival", "other"))
    run = replace(run, verdict=verdict)
    (leader,) = ranking(run).leaders
    assert [(a.effect, a.cosine) for a in leader.family] == [("other", 0.96), ("rival", None)]
    assert leader.family[0].differs == pytest.approx(0.28)
    assert not any(a.told_apart for a in leader.family)
    run = replace(run, verdict=replace(verdict, family=("an_effect",)))
    assert [a.told_apart for a in ranking(run).leaders[0].family] == [True]
    assert known.family == ("an_effect", "other")


@pytest.mark.parametrize(
    ("refitted", "says"),
    [
        (0.0770, ""),
        (0.0830, ""),
        (0.0740, "1.3 times what was foreseen: the effect is too strong for a straight line"),
        (0.0850, "or it is not the one that is missing"),
        (0.1100, "gains only 0"),
        (None, ""),
    ],
)
def test_a_gain_off_by_more_than_a_fifth_is_explained(refitted, says):
    found = remark(*row(eps_rmsn_refitted=refitted))
    assert says in found
    assert bool(found) == bool(says)


def test_a_sign_that_turned_is_told():
    turned = {"c": {"expected": -1.0, "refitted": 0.5}, "d": {"expected": 1.0, "refitted": 2.0}}
    assert remark(*row(parameters=turned)).startswith("c changes its sign when fitted")


def test_a_value_that_stops_at_its_limit_is_told():
    ends = {"low": -0.1, "high": 0.1}
    at = {"c": ends | {"expected": 0.02, "refitted": 0.1}, "d": ends | {"refitted": 0.09}}
    assert remark(*row(parameters=at)) == "c stops at the end of the physical range."


@pytest.mark.parametrize(
    ("parameter", "why"),
    [
        ({"expected": 0.2, "low": -1.0, "high": 0.0}, "c would have to be 0.2000, the wrong sign"),
        (
            {"expected": -3.0, "low": -2.0, "high": None, "unit": "m"},
            "c would have to be \N{MINUS SIGN}3.000 m, below its physical limit of "
            "\N{MINUS SIGN}2.000 m",
        ),
        ({"expected": 0.1, "low": -1.0, "high": 1.0}, "no value that it may physically have"),
        ({"expected": None, "low": None, "high": None}, "no value that it may physically have"),
    ],
)
def test_why_an_effect_is_ruled_out(parameter, why):
    known, _ = row(parameters={"c": parameter})
    assert reason(known).startswith(why)
