"""`priors = "ship"` in a pipeline: one word for all that her file knows, or one line of refusal."""

from pathlib import Path

import pytest
from click.testing import CliRunner
from s175q import ROOT
from test_bad_input import PIPELINE

import trialid as ti
from trialid.cli.main import commands
from trialid.errors import NotIdentifiable, PipelineError
from trialid.pipeline_file import load
from trialid.pipeline_file.edit import drop_effect, fix_parameter
from trialid.pipeline_file.prior_section import OfTheShip
from trialid.workflow.build_model import available, build_model, priors_of, settings_of

SHIP = (ROOT / "sample_data" / "ships" / "s175q.toml").read_text(encoding="utf-8")
KNOWN = "\n[uncertainty]\nNr = 0.35\nNdelta = 0.25\n"
WORD = 'priors = "ship"'


def written(folder: Path, said: str = WORD, known: str = KNOWN) -> Path:
    """A pipeline that says something of priors, beside a ship that knows something."""
    (folder / "ship.toml").write_text(SHIP + known, encoding="utf-8")
    (folder / "log.csv").write_text("t,rudder,rot,heel,stw\n0,0,0,0,7\n", encoding="utf-8")
    path = folder / "p.toml"
    path.write_text(PIPELINE.replace("[diagnose]", f"{said}\n[diagnose]"), encoding="utf-8")
    return path


def priors(path: Path) -> dict[str, tuple[float, float]]:
    asked = load(path)
    model = build_model(asked, available(asked))
    assert settings_of(asked, model).priors == priors_of(asked, model)
    return priors_of(asked, model)


def test_the_word_stands_for_all_that_the_file_knows(tmp_path: Path) -> None:
    assert isinstance(load(written(tmp_path)).identify.priors, OfTheShip)
    assert priors(tmp_path / "p.toml") == {
        "Nr": pytest.approx((-0.00247579, 0.35 * 0.00247579)),
        "Ndelta": pytest.approx((0.00148048, 0.25 * 0.00148048)),
    }


def test_a_table_is_as_it_was(tmp_path: Path) -> None:
    path = written(tmp_path, "priors = { Nr = { mean = -0.002, std = 0.0005 } }", "")
    assert priors(path) == {"Nr": (-0.002, 0.0005)}
    assert priors(written(tmp_path, "", "")) == {}


@pytest.mark.parametrize(
    ("said", "known", "words"),
    [
        (WORD, "", r"identify\.priors: .*\[uncertainty\] says nothing of Nr, Ndelta"),
        (WORD, "\n[uncertainty]\nNr = 0\n", r"identify\.priors: .*Nr = 0 calls it exact"),
        ('priors = "shop"', KNOWN, r"identify\.priors: 'shop' is not known; write \"ship\""),
        ("priors = 3", KNOWN, r"identify\.priors: "),
        ("priors = { Nr = { mean = 1.0 } }", KNOWN, r"identify\.priors\.Nr\.std: missing"),
        ('priors = { Nr = "ship" }', KNOWN, r"identify\.priors\.Nr: must be a table"),
    ],
)
def test_what_it_cannot_mean_is_one_line(said: str, known: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(PipelineError, match=words) as caught:
        priors(written(tmp_path, said, known))
    assert "\n" not in str(caught.value)


def test_what_is_changed_by_hand_leaves_the_word(tmp_path: Path) -> None:
    text = written(tmp_path).read_text(encoding="utf-8")
    fixed, said = fix_parameter(text, "Nr")
    assert WORD in fixed
    assert said == ()
    dropped, said = drop_effect(text, "linear_roll", ["Kp", "GM"])
    assert WORD in dropped
    assert said == ()


@pytest.mark.study(turn=5)
def test_a_run_says_what_was_known_in_terminal_and_report(tmp_path: Path) -> None:
    """The shipped logs, from the length alone: begun, run, and told."""
    logs = ROOT / "sample_data" / "hidden_effect"
    path = tmp_path / "mine.toml"
    names = [str(logs / f"{n}.mcap") for n in ("zigzag-10", "zigzag-20")]
    given = ["--length", "175", "--beam", "25.4", "--draught", "8.5"]
    begun = CliRunner().invoke(commands, ["inspect", *names, "--init", str(path), *given])
    assert begun.exit_code == 0
    assert WORD in path.read_text(encoding="utf-8")
    assert ti.read_ship(tmp_path / "mine_ship.toml").particulars["B"] == 25.4
    folder = tmp_path / "run"
    done = CliRunner().invoke(commands, ["run", str(path), "--out", str(folder)])
    assert done.exit_code == 0
    said = " ".join(done.stdout.split())
    assert "Known beforehand, as a share of what is known now:" in said
    assert "Known beforehand" in (folder / "report.html").read_text(encoding="utf-8")
    table = (folder / "result.json").read_text(encoding="utf-8")
    assert '"prior_share"' in table


def test_from_python_the_word_is_the_same(tmp_path: Path) -> None:
    ship = ti.ship_from_particulars(length=175.0, beam=25.4, draught=8.5, speed=7.33, GM=0.3)
    model = ti.ShipModel(ship, ("v", "r"), (ti.CATALOGUE["linear_hull"],))
    trial = ti.Trial.from_arrays("a", [0.0, 0.5], {"r": [0.0, 0.0]}, units={"r": "rad/s"})
    with pytest.raises(NotIdentifiable, match="priors = 'shop' is not known"):
        ti.identify([trial], model, free=["Nr"], outputs=["r"], priors="shop")
