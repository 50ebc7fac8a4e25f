"""Aligned trials in every format: the same numbers, masked where masked, with their provenance."""

import json
from pathlib import Path

import numpy as np
import pytest

from trialid import export, pipeline_file
from trialid.alignment import SignalSource, align
from trialid.errors import TrialidError
from trialid.export.provenance import provenance
from trialid.ingest import read
from trialid.names import labels
from trialid.trial import Trial
from trialid.workflow.quantities_read import quantities_of
from trialid.workflow.read_trials import align_trials

ROOT = Path(__file__).parents[2]
PIPELINE = ROOT / "pipelines" / "hidden_effect.toml"
SUFFIXES = tuple(export.FORMATS)


@pytest.fixture(scope="module")
def aligned():
    found = pipeline_file.load(PIPELINE)
    trials = align_trials(found, lambda words, share: None)
    return trials, provenance(found, trials, quantities_of(found))


def gapped(start=1_700_000_000_000_000_000):
    """A trial with a gap in r in the middle, and nothing masked in delta."""
    t = np.arange(200) * 0.5
    valid = (t < 30) | (t > 60)
    signals = {"delta": 0.2 * np.sin(0.1 * t), "r": -0.01 * np.cos(0.1 * t)}
    masks = {"delta": np.ones(200, bool), "r": valid}
    return Trial("zig zag/20", "fit", 0.5, signals, masks, start=start)


ABOUT = {"schema": "s", "version": "0", "pipeline": "p.toml", "trials": []}


def source(trial, quantity, channel, unit=None):
    positive = "starboard" if quantity == "delta" else None
    return SignalSource(quantity, channel, unit, positive)


def assert_same(back, trial):
    for name, values in trial.signals.items():
        assert np.array_equal(back.valid[name], trial.valid[name]), name
        there = trial.valid[name]
        assert back.signals[name][there] == pytest.approx(values[there], abs=1e-12)


def test_a_csv_file_reads_back_as_the_same_trial(tmp_path, aligned):
    trials, about = aligned
    for trial in (*trials, gapped()):
        out = tmp_path / "a.csv"
        export.write(out, [trial], about)
        sources = [source(trial, name, name) for name in trial.signals]
        assert_same(align("back", "fit", [read(out)], sources, trial.period), trial)


def test_an_mcap_file_reads_back_as_the_same_trials(tmp_path, aligned):
    trials, about = aligned
    dated = [trial for trial in trials if trial.start > 10**17]
    out = tmp_path / "a.mcap"
    export.write(out, dated, about)
    recording = read(out)
    assert recording.remarks == ()
    for trial in dated:
        topic = f"/trialid/{trial.name}/aligned"
        sources = [
            source(trial, name, f"{topic}:{labels.message_field(name)}", labels.quantity(name).unit)
            for name in trial.signals
        ]
        back = align("back", "fit", [recording], sources, trial.period)
        assert back.start == trial.start
        assert_same(back, trial)


def test_a_gap_survives_in_mcap(tmp_path):
    out = tmp_path / "a.mcap"
    export.write(out, [gapped()], ABOUT)
    rate = read(out).channels["/trialid/zig_zag_20/aligned:yaw_rate_radps"]
    assert np.array_equal(np.isfinite(rate.y), gapped().valid["r"])
    assert rate.t[0] == gapped().start


def test_trials_without_a_date_begin_at_zero(tmp_path):
    out = tmp_path / "a.mcap"
    export.write(out, [gapped(), gapped(start=12)], ABOUT)
    starts = {int(channel.t.min()) for channel in read(out).channels.values()}
    # zero is no stamp to a reader, so that the sample there is the second one's
    assert starts <= {0, 500_000_000}


def test_a_matlab_file_has_a_struct_a_trial(tmp_path, aligned):
    from scipy.io import loadmat

    trials, about = aligned
    export.write(tmp_path / "a.mat", trials, about)
    back = loadmat(tmp_path / "a.mat", simplify_cells=True)
    for trial in trials:
        struct = back[trial.name.replace("-", "_")]
        assert struct["name"] == trial.name
        assert struct["use"] == trial.use
        assert struct["period_s"] == trial.period
        assert list(np.atleast_1d(struct["remarks"])) == list(trial.remarks)
        for name, values in trial.signals.items():
            expected = np.where(trial.valid[name], values, np.nan)
            assert np.array_equal(struct[labels.column(name)], expected, equal_nan=True)
    assert json.loads(str(back["provenance"])) == about


def test_a_parquet_file_has_a_row_a_sample_and_its_provenance(tmp_path, aligned):
    parquet = pytest.importorskip("pyarrow.parquet")
    trials, about = aligned
    export.write(tmp_path / "a.parquet", [*trials, gapped()], about)
    table = parquet.read_table(tmp_path / "a.parquet")
    assert table.num_rows == sum(t.samples for t in trials) + 200
    assert table.column_names == ["trial", "t_s", "delta_rad", "r_radps", "phi_rad", "u_mps"]
    assert table["phi_rad"].to_pylist()[-1] is None
    assert table["r_radps"].null_count == sum(
        int((~t.valid["r"]).sum()) for t in (*trials, gapped())
    )
    assert json.loads(table.schema.metadata[b"trialid"]) == about


def test_several_trials_are_one_table_with_their_names(tmp_path, aligned):
    trials, about = aligned
    export.write(tmp_path / "a.csv", trials, about)
    lines = (tmp_path / "a.csv").read_text().splitlines()
    assert lines[0] == "trial,t[s],delta[rad],r[rad/s],phi[rad],u[m/s]"
    assert len(lines) == 1 + sum(trial.samples for trial in trials)
    names = [line.partition(",")[0] for line in lines[1:]]
    assert list(dict.fromkeys(names)) == [trial.name for trial in trials]
    assert json.loads((tmp_path / "a.csv.json").read_text()) == about


def test_the_provenance_names_logs_channels_and_masked_samples(aligned):
    trials, about = aligned
    assert [one["name"] for one in about["trials"]] == [trial.name for trial in trials]
    first = about["trials"][0]
    assert first["start"].startswith("2026-05-28T20:26:40")
    assert first["signals"]["delta"]["source"]["positive"] == "starboard"
    assert first["signals"]["delta"]["masked"] == int((~trials[0].valid["delta"]).sum())
    assert all(len(log["sha256"]) == 64 for trial in about["trials"] for log in trial["logs"])
    assert str(ROOT) not in json.dumps(about)
    assert about["trials"][3]["start"] is None  # a table that counts from no date


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_same_trials_give_the_same_file(tmp_path, suffix):
    if suffix == ".mat":
        pytest.skip("its header states the day")
    for name in ("a", "b"):
        export.write(tmp_path / f"{name}{suffix}", [gapped()], ABOUT)
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


def test_nothing_is_left_of_a_write_that_fails(tmp_path, monkeypatch):
    (tmp_path / "a.csv").write_text("old")

    def failing(path, trials, about):
        path.write_text("half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(export, "FORMATS", {".csv": failing})
    with pytest.raises(TrialidError, match=r"a\.csv: no space left on device"):
        export.write(tmp_path / "a.csv", [gapped()], ABOUT)
    assert (tmp_path / "a.csv").read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]


def test_places_that_cannot_be_are_refused(tmp_path):
    (tmp_path / "old.csv").touch()
    (tmp_path / "new.csv.json").touch()
    for out, words in (
        ("a.xlsx", r"the suffix says the format, .csv, .parquet, .mat, .mcap; '.xlsx' is none"),
        ("a", "it has none"),
        ("no/a.csv", "there is no folder"),
        ("old.csv", "exists; name another, or add --force"),
        ("new.csv", r"new.csv.json exists"),
    ):
        with pytest.raises(TrialidError, match=words) as caught:
            export.check_place(tmp_path / out, replace=False)
        assert "\n" not in str(caught.value)
    export.check_place(tmp_path / "old.csv", replace=True)
    (tmp_path / "folder.mat").mkdir()
    with pytest.raises(TrialidError, match="is a folder"):
        export.check_place(tmp_path / "folder.mat", replace=True)


def test_a_command_of_a_thruster_has_the_unit_of_its_ship(tmp_path):
    """In newtons here; the dictionary knows no actuator of a ship, and had called it a share."""
    t = np.arange(20) * 0.5
    trial = Trial("a", "fit", 0.5, {"left_order": 3.0 * t}, {"left_order": np.ones(20, bool)})
    known = {"unit": "N", "masked": 0, "source": None}
    about = {**ABOUT, "trials": [{"name": "a", "signals": {"left_order": known}}]}
    for suffix, written in ((".csv", ("left_order", "N")), (".mcap", ("left_order_N", None))):
        out = tmp_path / f"a{suffix}"
        export.write(out, [trial], about)
        [(name, channel)] = [each for each in read(out).channels.items() if "left" in each[0]]
        assert (name.rpartition(":")[2], channel.unit) == written
