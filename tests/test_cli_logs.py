"""`trialid inspect` and `trialid align` as typed."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from trialid import ingest, pipeline_file
from trialid.cli import console, main

ROOT = Path(__file__).parent.parent
LOGS = ROOT / "sample_data" / "hidden_effect"
PIPELINE = ROOT / "pipelines" / "hidden_effect.toml"
CSV = LOGS / "zigzag-15.csv"


def trialid_(*arguments: str | Path) -> Result:
    return CliRunner().invoke(main.commands, [str(a) for a in arguments], prog_name="trialid")


def refused(*arguments: str | Path) -> str:
    done = trialid_(*arguments)
    assert done.exit_code == 2, done.output
    assert done.stdout == ""
    assert done.stderr.startswith("trialid: ")
    assert done.stderr.count("\n") == 1
    return done.stderr


# --- inspect ------------------------------------------------------------------------------------


def test_inspect_shows_what_is_in_a_log() -> None:
    done = trialid_("inspect", CSV)
    assert done.exit_code == 0
    assert done.stderr == ""
    assert "rudder angle δ" in done.stdout


def test_several_logs_are_shown_one_after_another() -> None:
    done = trialid_("inspect", CSV, LOGS / "zigzag-10.mcap")
    assert done.stdout.index("zigzag-15.csv") < done.stdout.index("zigzag-10.mcap")
    assert "\n\n" in done.stdout


def test_json_is_machine_readable_and_nothing_else(tmp_path: Path) -> None:
    one = json.loads(trialid_("inspect", CSV, "--json").stdout)
    assert {c["quantity"] for c in one["channels"]} == {"delta", "r", "phi", "u"}
    two = json.loads(trialid_("inspect", CSV, CSV, "--json").stdout)
    assert two == [one, one]
    done = trialid_("inspect", CSV, "--json", "--init", tmp_path / "a.toml", "--length", 175)
    assert json.loads(done.stdout) == one
    assert "Written: " in done.stderr


def test_init_writes_a_pipeline_that_is_read(tmp_path: Path) -> None:
    done = trialid_("inspect", CSV, "--init", tmp_path / "a.toml", "--length", "175")
    assert done.exit_code == 0, done.output
    assert f"trialid run {tmp_path / 'a.toml'}" in done.stderr
    made = pipeline_file.load(tmp_path / "a.toml")
    assert made.trials[0].use == "fit"
    assert made.ship == tmp_path / "a_ship.toml"


def test_init_says_what_is_left_to_fill_in(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    rows = np.column_stack([np.arange(300), *rng.normal(size=(2, 300)), np.full(300, 5.0)])
    rows[:, 3] += 0.1 * rng.normal(size=300)
    np.savetxt(
        tmp_path / "a.csv", rows, delimiter=",", header="t,rudder[deg],rot[deg/min],stw[m/s]",
        comments="",
    )  # fmt: skip
    done = trialid_("inspect", tmp_path / "a.csv", "--init", tmp_path / "a.toml", "--length", "50")
    assert done.exit_code == 0
    assert "To fill in: a.csv: delta" in done.stderr
    assert "trialid.signals.delta.positive" not in done.stderr
    assert "trial[0].signals.delta.positive" in refused("run", tmp_path / "a.toml")


def test_init_replaces_nothing(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text("mine")
    assert "a.toml exists" in refused(
        "inspect", CSV, "--init", tmp_path / "a.toml", "--length", "9"
    )
    (tmp_path / "b_ship.toml").write_text("mine")
    assert "b_ship.toml exists" in refused(
        "inspect", CSV, "--init", tmp_path / "b.toml", "--length", "9"
    )
    assert not (tmp_path / "b.toml").exists()
    assert (tmp_path / "a.toml").read_text() == "mine"


def test_init_without_a_ship_is_one_line_and_writes_nothing(tmp_path: Path) -> None:
    done = trialid_("inspect", CSV, "--init", tmp_path / "a.toml")
    assert done.exit_code == 2
    assert "--length METRES" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nowhere.mcap"], "no such file"),
        ([str(CSV), "--init", "a.txt", "--length", "9"], "a pipeline file ends in .toml"),
        ([str(CSV), "--init", "no/a.toml", "--length", "9"], "there is no folder no"),
        (
            [str(CSV), "--init", "a.toml", "--length", "96", "--beam", "960", "--block", "2"],
            "2 things are wrong: (1) beam 960 m is more than the length 96 m; are both in metres?; "
            "(2) block coefficient 2 is above 1",
        ),
        (
            [str(CSV), "--init", "a.toml", "--beam", "16"],
            "the length is missing",
        ),
        ([str(CSV), "--dbc", "no.dbc"], "no.dbc: no such file"),
        ([str(LOGS / "zigzag-10.mcap"), "--zone", "Europe/Oslo"], "zone"),
        (
            [str(CSV), "--zone", "Oslo"],
            "--zone: 'Oslo' is no time zone; write it like Europe/Oslo "
            "(did you mean 'Europe/Oslo'?)",
        ),
        ([str(CSV), "--zone", "Xyz"], "'Xyz' is no time zone; write it like Europe/Oslo\n"),
    ],
)
def test_mistakes_are_one_line(
    arguments: list[str], words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert words in refused("inspect", *arguments)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "arguments", [[], [str(CSV), "--length", "9"], [str(CSV), "--init", "a.toml", "--length", "x"]]
)
def test_misuse_leads_to_the_help(arguments: list[str]) -> None:
    assert refused("inspect", *arguments).rstrip().endswith("; see trialid inspect --help")


def test_a_template_is_drafted_where_the_reader_of_tables_can(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ingest, "draft_template", lambda path: f"# of {path.name}\n", raising=False)
    done = trialid_("inspect", CSV, "--template", tmp_path / "t.toml")
    assert done.exit_code == 0, done.output
    assert (tmp_path / "t.toml").read_text() == "# of zigzag-15.csv\n"
    assert "exists" in refused("inspect", CSV, "--template", tmp_path / "t.toml")


# --- align --------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".mat", ".mcap", ".CSV"])
def test_align_writes_every_format(tmp_path: Path, suffix: str) -> None:
    if suffix == ".parquet":
        pytest.importorskip("pyarrow")
    done = trialid_("align", PIPELINE, "--out", tmp_path / f"a{suffix}", "--trial", "zigzag-15")
    assert done.exit_code == 0, done.output
    assert "zigzag-15: 2400 samples, 0.5 s apart: delta, r, phi, u" in done.stdout
    assert (tmp_path / f"a{suffix}").stat().st_size > 1000


def test_align_writes_one_trial_or_all(tmp_path: Path) -> None:
    out = tmp_path / "a.csv"
    assert trialid_("align", PIPELINE, "--out", out, "--quiet").stdout == ""
    everything = out.read_text().splitlines()
    assert "exists" in refused("align", PIPELINE, "--out", out)
    done = trialid_("align", PIPELINE, "--out", out, "--trial", "binary-15", "--force")
    assert done.exit_code == 0
    one = out.read_text().splitlines()
    assert [line for line in everything if line.startswith("binary-15,")] == one[1:]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([PIPELINE, "--out", "a.xls"], "the suffix says the format"),
        ([PIPELINE, "--out", "a.csv", "--trial", "zigzag"], "no trial 'zigzag'; did you mean"),
        (["no.toml", "--out", "a.csv"], "no such pipeline file"),
        ([PIPELINE, "--out", "no/a.csv"], "there is no folder no"),
    ],
)
def test_mistakes_of_align_are_one_line(
    arguments: list[str], words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert words in refused("align", *arguments)
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_channel_and_a_damaged_log_are_one_line(tmp_path: Path) -> None:
    text = CSV.read_text()
    (tmp_path / "log.csv").write_text(text)
    shutil.copy(ROOT / "sample_data" / "ships" / "s175q.toml", tmp_path / "ship.toml")
    pipeline = tmp_path / "p.toml"
    trialid_("inspect", tmp_path / "log.csv", "--init", pipeline, "--ship", tmp_path / "ship.toml")
    good = pipeline.read_text()
    pipeline.write_text(good.replace('"heel"', '"heal"'))
    assert "no channel 'heal'" in refused("align", pipeline, "--out", tmp_path / "a.csv")
    pipeline.write_text(good)
    lines = text.splitlines()
    lines[50] = lines[50].replace(lines[50].split(",")[2], "ERR")
    (tmp_path / "log.csv").write_text("\n".join(lines) + "\n")
    assert "log.csv, line" in refused("align", pipeline, "--out", tmp_path / "a.csv")
    assert not (tmp_path / "a.csv").exists()


# --- numbers and names on the line ----------------------------------------------------------------


def test_only_the_trials_that_are_named_are_written(tmp_path: Path) -> None:
    out = tmp_path / "one.csv"
    options = ("--out", out, "--trial", "zigzag-15", "--quiet")
    done = trialid_("align", PIPELINE, *options)
    assert done.exit_code == 0, done.output
    names = {line.partition(",")[0] for line in out.read_text(encoding="utf-8").splitlines()[1:]}
    assert names == {"zigzag-15"}


def test_a_stated_speed_is_in_knots(tmp_path: Path) -> None:
    """Fourteen of them are 7.2 m/s."""
    t = np.arange(0.0, 600.0, 0.5)
    delta = 10.0 * np.sign(np.sin(t / 40.0))
    rate = 0.4 * np.sin(t / 40.0 - 0.3)
    log, path = tmp_path / "a.csv", tmp_path / "a.toml"
    table = np.column_stack([t, delta, rate])
    np.savetxt(log, table, delimiter=",", header="t[s],rudder[deg],rot[deg/s]", comments="")
    options = ("--init", path, "--length", "175", "--speed", "14")
    done = trialid_("inspect", log, *options)
    assert done.exit_code == 0, done.output
    (trial,) = pipeline_file.load(path).trials
    assert trial.speed == pytest.approx(14.0 * 1852.0 / 3600.0, rel=1e-3)


def test_what_is_said_cannot_steer_a_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    console.say("a name \x1b]0;title\x07 of a file")
    said = capsys.readouterr().out
    assert not {"\x1b", "\x07"} & {*said}
    assert "of a file" in said
