from dataclasses import replace

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.result.series import OutputSeries, read_csv, write_csv


def assert_same(ours, theirs):
    assert (ours.name, ours.use) == (theirs.name, theirs.use)
    assert np.array_equal(ours.t, theirs.t)
    assert list(ours.inputs) == list(theirs.inputs)
    for name, values in ours.inputs.items():
        assert np.array_equal(values, theirs.inputs[name])
    assert len(ours.outputs) == len(theirs.outputs)
    for one, other in zip(ours.outputs, theirs.outputs, strict=True):
        assert one.name == other.name
        assert np.array_equal(one.compared, other.compared)
        assert np.array_equal(one.predicted, other.predicted)
        assert np.array_equal(one.observed, other.observed, equal_nan=True)


def test_round_trip_keeps_every_digit_and_every_gap(tmp_path, series):
    write_csv(tmp_path / "series.csv", series)
    back = read_csv(tmp_path / "series.csv")
    assert len(back) == len(series)
    for ours, theirs in zip(series, back, strict=True):
        assert_same(ours, theirs)


def test_headers_carry_si_units_and_gaps_are_empty_fields(tmp_path, series):
    write_csv(tmp_path / "series.csv", series[1:2])
    head, *rows = (tmp_path / "series.csv").read_text().splitlines()
    assert head == (
        "trial,use,t_s,delta_rad,delta_order_rad,u_mps,r_measured_radps,r_predicted_radps,"
        "r_residual_radps,phi_measured_rad,phi_predicted_rad,phi_residual_rad"
    )
    gap = int(np.flatnonzero(~series[1].outputs[0].compared)[0])
    _, _, _, _, _, _, measured, predicted, residual, *_ = rows[gap].split(",")
    assert (measured, residual) == ("", "")
    assert float(predicted) == series[1].outputs[0].predicted[gap]


def test_trials_may_differ_in_signals_and_have_any_name(tmp_path, series):
    first = replace(series[0], name='NA, "so called"', inputs={"n": series[0].t})
    second = replace(series[1], name="007", outputs=series[1].outputs[:1])
    write_csv(tmp_path / "series.csv", [first, second])
    back = read_csv(tmp_path / "series.csv")
    assert_same(first, back[0])
    assert_same(second, back[1])


def test_an_output_never_compared_is_kept(tmp_path, series):
    never = np.zeros(len(series[0].t), dtype=bool)
    output = replace(series[0].outputs[0], compared=never)
    write_csv(tmp_path / "series.csv", [replace(series[0], outputs=(output,))])
    (back,) = read_csv(tmp_path / "series.csv")
    assert not back.outputs[0].compared.any()


def test_no_trials_make_an_empty_table(tmp_path):
    write_csv(tmp_path / "series.csv", ())
    assert read_csv(tmp_path / "series.csv") == ()


def test_residual_is_measured_minus_predicted():
    compared = np.array([True, False])
    output = OutputSeries("r", np.array([3.0, 9.0]), np.array([1.0, 1.0]), compared)
    assert np.array_equal(output.residual, [2.0, np.nan], equal_nan=True)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("a,b\n1,2\n", "no column trial, use, t_s"),
        ("", "cannot be read"),
        ("trial,use,t_s,r_predicted_radps\nz,fit,0,1\n", "r_measured_radps"),
        ("trial,use,t_s,u_mps\nz,fit,0,fast\n", "'u_mps': could not convert"),
        ("trial,use,t_s,u_mps\nz,fit,0,1\nz,fit", "row 3 is cut or torn: expected 4"),
    ],
)
def test_another_file_is_refused_with_its_reason(tmp_path, text, says):
    path = tmp_path / "series.csv"
    path.write_text(text)
    with pytest.raises(LogError, match=says):
        read_csv(path)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(LogError, match="nowhere"):
        read_csv(tmp_path / "nowhere.csv")
