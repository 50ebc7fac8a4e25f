"""Every shipped pipeline, from its logs to its folder: whole and consistent."""

import html
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from valid_result import assert_valid

import trialid
from trialid import own_files
from trialid.errors import PipelineError
from trialid.pipeline_file import load
from trialid.sample.hidden_effect import HIDDEN
from trialid.workflow.run import run
from trialid.workflow.write_run import write

ROOT = Path(__file__).parent.parent
OTHERS = ("design_", "structures")  # files of other commands
PIPELINES = sorted(p for p in (ROOT / "pipelines").glob("*.toml") if not p.name.startswith(OTHERS))
HIDDEN_EFFECT = ROOT / "pipelines/hidden_effect.toml"
STEADY = 0.15
"""Share by which the noise part may move when an effect is added: noise is not the model's."""


@dataclass(frozen=True)
class Finished:
    """A run's folder, and what is in it."""

    pipeline: Path
    folder: Path
    result: Mapping[str, Any]
    series: pd.DataFrame


Finish = Callable[[Path], Finished]


@pytest.fixture(scope="module")
def finish(sample_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Finish:
    """Give the folder of a pipeline's run, made once for all tests."""

    @cache
    def once(pipeline: Path) -> Finished:
        folder = sample_run
        if pipeline != HIDDEN_EFFECT:
            write(run(load(pipeline)), folder := tmp_path_factory.mktemp("runs") / pipeline.stem)
        found = json.loads((folder / "result.json").read_bytes(), parse_constant=_refuse)
        return Finished(pipeline, folder, found, pd.read_csv(folder / "series.csv"))

    return once


@pytest.fixture(scope="module", params=PIPELINES, ids=lambda path: path.stem)
def finished(request: pytest.FixtureRequest, finish: Finish) -> Finished:
    return finish(request.param)


@pytest.fixture(scope="module")
def hidden(finish: Finish) -> Finished:
    return finish(HIDDEN_EFFECT)


def _refuse(constant: str) -> None:
    raise AssertionError(f"{constant} in result.json")


def test_there_are_pipelines() -> None:
    assert HIDDEN_EFFECT in PIPELINES


# --- the schema trialid-result/1 ----------------------------------------------------------------

Shape = Any
"""A type, a set of words, [a shape] for a list, {...: a shape} for a table by any name, a table by
fixed names (it may hold more), or a tuple of alternatives; None is null."""

NUMBER = (int, float)
MAYBE = (int, float, None)
BY_OUTPUT = {...: NUMBER}
INTERVAL = [NUMBER]

TRIAL = {
    "name": str,
    "use": {"fit", "check"},
    "logs": [{"path": str, "sha256": str, "adapter": str}],
    "samples": int,
    "period": NUMBER,
    "duration": NUMBER,
    "remarks": [str],
    "eps_rmsn": {...: MAYBE},
}
FIT = {
    "eps_rmsn": NUMBER,
    "eps_rmsn_by_output": BY_OUTPUT,
    "eps_rmsn_check": MAYBE,
    "eps_rmsn_check_by_output": ({...: NUMBER}, None),
    "V": NUMBER,
    "iterations": [{"V": NUMBER, "eps_rmsn": NUMBER, "step": NUMBER}],
    "converged": bool,
    "reason": str,
}
SPLIT = (
    {
        "noise": NUMBER,
        "undermodelling": NUMBER,
        "method": str,
        "interval": {"noise": INTERVAL, "undermodelling": INTERVAL},
        "by_output": {...: {"noise": NUMBER, "undermodelling": NUMBER}},
    },
    {"noise": None, "undermodelling": None, "method": {"not separable"}, "why": str},
)
PARAMETER = {
    "name": str,
    "value": NUMBER,
    "unit": str,
    "S_i": NUMBER,
    "S_imin": NUMBER,
    "R_i": MAYBE,
    "relative_error": MAYBE,
    "noise_error": MAYBE,
    "undermodelling_error": MAYBE,
    "standard_error": MAYBE,
    "kind": {"physical", "nuisance"},
}
STABILITY = {
    "L_r": NUMBER,
    "L_v": NUMBER,
    "margin": NUMBER,
    "standard_error": MAYBE,
    "stable": bool,
}
ACCURACY = {
    "S_min": NUMBER,
    "S_max": NUMBER,
    "R": MAYBE,
    "n_effective": NUMBER,
    "weighting": str,
    "parameters": [PARAMETER],
    "stability": (STABILITY, None),
}
BARS = {
    "form": {"bars"},
    "by": str,
    "unit": str,
    "edges": [NUMBER],
    "names": [str],
    "samples": [NUMBER],
    "share": [NUMBER],
    "mean_square": [NUMBER],
    "low": [NUMBER],
    "high": [NUMBER],
    "mean": ([NUMBER], None),
    "error": ([NUMBER], None),
    "mean_unit": str,
    "standing": [bool],
}
SPECTRUM = {
    "form": {"spectrum"},
    "frequency": [NUMBER],
    "density": [NUMBER],
    "coherent": [NUMBER],
    "coherence": [NUMBER],
    "threshold": NUMBER,
}
FINDING = {
    "output": str,
    "finding": {
        "stretch", "rudder amplitude", "turn-rate amplitude", "roll amplitude", "side",
        "heading sector", "speed", "frequency", "mean offset",
    },
    "doing": (str, None),
    "share": NUMBER,
    "excess": NUMBER,
    "p_value": NUMBER,
    "t_start": MAYBE,
    "t_end": MAYBE,
    "trial": (str, None),
    "sentence": str,
    "picture": (BARS, SPECTRUM),
}  # fmt: skip
WHERE_ELSE = {
    "by_output": [{"output": str, "share": NUMBER, "sentence": str}],
    "rest": [{"output": str, "sentence": str, "picture": SPECTRUM}],
    "not_examined": [str],
    "questions": int,
}
CANDIDATE = {
    "rank": int,
    "effect": str,
    "family": [str],
    "parameters": {...: {"expected": MAYBE, "refitted": MAYBE}},
    "eps_rmsn_predicted": NUMBER,
    "eps_rmsn_refitted": MAYBE,
    "eps_rmsn_check": MAYBE,
    "p_value": NUMBER,
    "visibility": NUMBER,
    "verdict": str,
}
VERDICT = {
    "kind": {"missing", "nothing missing", "not in catalogue", "cannot tell"},
    "effect": (str, None),
    "family": [str],
    "together": [str],
    "sentence": str,
    "next_trial": (dict, None),
}
STAGE = {
    "step": {"as written", "added", "dropped", "proposed"},
    "effects": [str],
    "added": (str, None),
    "dropped": (str, None),
    "verdict": (str, None),
    "free": [str],
    "logs": [str],
    "version": str,
    "eps_rmsn": NUMBER,
    "noise": MAYBE,
    "undermodelling": MAYBE,
    "eps_rmsn_check": MAYBE,
}
RESULT = {
    "schema": {"trialid-result/1"},
    "version": {trialid.__version__},
    "pipeline": str,
    "trials": [TRIAL],
    "model": {"states": [str], "effects": [str], "free": [str], "inputs": [str]},
    "fit": FIT,
    "split": SPLIT,
    "accuracy": ACCURACY,
    "where": [FINDING],
    "where_else": WHERE_ELSE,
    "missing": [CANDIDATE],
    "verdict": VERDICT,
    "history": [STAGE],
    "sources": [{"path": str, "sha256": str}],
}


def problems(value: Any, shape: Shape, at: str = "result") -> Iterator[str]:
    """Where a value is not of a shape."""
    if isinstance(shape, tuple):
        found = [list(problems(value, one, at)) for one in shape]
        if all(found):
            yield from min(found, key=len)
    elif isinstance(shape, dict):
        yield from _table_problems(value, shape, at)
    elif isinstance(shape, list):
        entries = enumerate(value) if isinstance(value, list) else [(None, value)]
        for place, one in entries:
            yield from problems(one, shape[0] if place is not None else list, f"{at}[{place}]")
    elif not _is(value, shape):
        yield f"{at}: {value!r} is not {shape!r}"


def _table_problems(value: Any, shape: Mapping[Any, Shape], at: str) -> Iterator[str]:
    if not isinstance(value, dict):
        yield f"{at}: {value!r} is no table"
    elif ... in shape:
        for key, one in value.items():
            yield from problems(one, shape[...], f"{at}.{key}")
    else:
        for key, one in shape.items():
            if key in value:
                yield from problems(value[key], one, f"{at}.{key}")
            else:
                yield f"{at}.{key} is missing"


def _is(value: Any, shape: Shape) -> bool:
    if shape is None:
        return value is None
    if isinstance(shape, set):
        return value in shape
    return isinstance(value, shape) and (shape is bool or not isinstance(value, bool))


@pytest.mark.parametrize(("value", "shape"), [
    (True, int), (None, NUMBER), ("1", NUMBER), (3, [int]), ([1, None], [int]),
    ({}, {"a": int}), ({"a": 1.5}, {"a": int}), ({"b": ""}, {...: NUMBER}), ("x", {"y"}),
    ({"noise": None}, SPLIT), (3, (str, None)),
])  # fmt: skip
def test_the_check_of_the_schema_finds_what_is_wrong(value: Any, shape: Shape) -> None:
    assert list(problems(value, shape))


def test_the_result_conforms_to_the_schema(finished: Finished) -> None:
    assert list(problems(finished.result, RESULT)) == []
    assert_valid(dict(finished.result))


def test_numbers_are_possible(finished: Finished) -> None:
    """The schema's types leave more open than its words."""
    result = finished.result
    for trial in result["trials"]:
        assert [log for log in trial["logs"] if len(log["sha256"]) != 64] == []
        assert trial["duration"] == pytest.approx(trial["period"] * (trial["samples"] - 1))
    assert [i for i in _intervals(result["split"]) if not (len(i) == 2 and i[0] <= i[1])] == []
    stretches = [f for f in result["where"] if f["finding"] == "stretch"]
    assert [f for f in stretches if not f["t_start"] < f["t_end"]] == []
    assert [f for f in result["where"] if not 0.0 <= f["p_value"] <= 0.05] == []
    assert sum(row["share"] for row in result["where_else"]["by_output"]) == pytest.approx(1.0)
    assert [f for f in result["where"] if not 0.0 < f["share"] <= 1.0] == []
    for candidate in result["missing"]:
        assert 0.0 <= candidate["p_value"] <= 1.0
        assert 0.0 <= candidate["visibility"] <= 1.0 + 1e-9
        assert candidate["effect"] in candidate["family"]
    assert [c["rank"] for c in result["missing"]] == list(range(1, len(result["missing"]) + 1))


def _intervals(split: Mapping[str, Any]) -> Iterable[list[float]]:
    return (split["interval"] or {}).values()


def test_parts_of_the_result_agree(finished: Finished) -> None:
    result = finished.result
    fit, split = result["fit"], result["split"]
    by_output = list(fit["eps_rmsn_by_output"].values())
    assert fit["eps_rmsn"] == pytest.approx(math.sqrt(np.mean(np.square(by_output))))
    assert fit["V"] == pytest.approx(0.5 * fit["eps_rmsn"] ** 2)
    assert fit["iterations"][-1]["V"] == pytest.approx(fit["V"])
    if split["noise"] is not None:
        whole = math.hypot(split["noise"], split["undermodelling"])
        assert whole == pytest.approx(fit["eps_rmsn"], rel=0.01)
    physical = [p for p in result["accuracy"]["parameters"] if p["kind"] == "physical"]
    assert [p["name"] for p in physical] == result["model"]["free"]
    for p in result["accuracy"]["parameters"]:
        if p["R_i"] is not None:
            assert p["R_i"] == pytest.approx(p["S_i"] / p["S_imin"])
        if p["relative_error"] is not None:
            both = p["noise_error"] + p["undermodelling_error"]
            assert p["relative_error"] == pytest.approx(both)
    first = result["history"][0]
    assert (first["effects"], first["added"]) == (result["model"]["effects"], None)
    assert first["eps_rmsn"] == fit["eps_rmsn"]
    verdict = result["verdict"]
    assert (verdict["effect"] is not None) == (verdict["kind"] == "missing")
    assert (len(result["history"]) > 1) == (verdict["kind"] == "missing")


# --- the folder ---------------------------------------------------------------------------------


def test_the_folder_is_whole(finished: Finished) -> None:
    names = "pipeline.toml predicted.mcap report.html result.json run.json series.csv standing.npz"
    assert {path.name for path in finished.folder.iterdir()} == {own_files.LIST, *names.split()}
    assert (finished.folder / "pipeline.toml").read_bytes() == finished.pipeline.read_bytes()
    assert finished.result["pipeline"] in {finished.pipeline.name, load(finished.pipeline).name}
    for trial in finished.result["trials"]:
        for log in trial["logs"]:
            assert (finished.pipeline.parent / log["path"]).is_file()


def _residual(rows: pd.DataFrame, output: str) -> pd.DataFrame:
    """Measured and residual of one output where they were compared."""
    columns = {
        role: next(c for c in rows.columns if c.startswith(f"{output}_{role}_"))
        for role in ("measured", "predicted", "residual")
    }
    pieces = pd.DataFrame({role: rows[name] for role, name in columns.items()})
    kept = pieces.assign(trial=rows["trial"]).dropna()
    difference = kept["measured"] - kept["predicted"]
    np.testing.assert_allclose(difference, kept["residual"], rtol=0, atol=1e-12)
    return kept


def _norm(rows: pd.DataFrame, output: str) -> float:
    """y_RMS of Eq. 8 over the trials to fit, each about its own mean."""
    kept = _residual(rows[rows["use"] == "fit"], output)
    moved = kept["measured"] - kept.groupby("trial")["measured"].transform("mean")
    return float(np.sqrt(np.mean(moved**2)))


def _eps(rows: pd.DataFrame, output: str, norm: float) -> float:
    return float(np.sqrt(np.mean(_residual(rows, output)["residual"] ** 2)) / norm)


def test_errors_follow_from_the_series(finished: Finished) -> None:
    fit, series = finished.result["fit"], finished.series
    fitted, checked = series[series["use"] == "fit"], series[series["use"] == "check"]
    held_out = []
    for output, stated in fit["eps_rmsn_by_output"].items():
        norm = _norm(series, output)
        assert _eps(fitted, output, norm) == pytest.approx(stated, rel=1e-3)
        for trial in finished.result["trials"]:
            eps = _eps(series[series["trial"] == trial["name"]], output, norm)
            assert eps == pytest.approx(trial["eps_rmsn"][output], rel=1e-3)
        if len(checked):
            held_out.append(_eps(checked, output, norm))
    if held_out:
        expected = math.sqrt(np.mean(np.square(held_out)))
        assert expected == pytest.approx(fit["eps_rmsn_check"], rel=1e-3)
    else:
        assert fit["eps_rmsn_check"] is None


def test_the_series_hold_every_trial(finished: Finished) -> None:
    for trial in finished.result["trials"]:
        rows = finished.series[finished.series["trial"] == trial["name"]]
        assert set(rows["use"]) == {trial["use"]}
        assert len(rows) == trial["samples"]
        assert rows["t_s"].iloc[-1] == pytest.approx(trial["duration"])
        np.testing.assert_allclose(np.diff(rows["t_s"]), trial["period"])


def test_the_recording_holds_the_same_series_and_result(finished: Finished) -> None:
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    with (finished.folder / "predicted.mcap").open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        (attached,) = reader.iter_attachments()
        assert json.loads(attached.data) == finished.result
        for trial in finished.result["trials"]:
            topic = f"/trialid/{trial['name']}/predicted"
            messages = [m for _, _, _, m in reader.iter_decoded_messages(topics=[topic])]
            rows = finished.series[finished.series["trial"] == trial["name"]]
            _same_numbers(messages, rows, "predicted")


def _same_numbers(messages: list[Any], rows: pd.DataFrame, role: str) -> None:
    """The fields of the messages are the columns of the series, in the same order."""
    columns = [c for c in rows.columns if f"_{role}_" in c]
    fields = [f.name for f in messages[0].DESCRIPTOR.fields if f.name != "timestamp"]
    assert [f.rpartition("_")[2] for f in fields] == [c.rpartition("_")[2] for c in columns]
    for field, column in zip(fields, columns, strict=True):
        played = [getattr(m, field) for m in messages]
        np.testing.assert_array_equal(played, rows[column].to_numpy())


def test_the_report_says_what_the_result_says(finished: Finished) -> None:
    result = finished.result
    page = (finished.folder / "report.html").read_text(encoding="utf-8")
    words = " ".join(html.unescape(page).replace("<wbr>", "").split())
    assert " ".join(result["verdict"]["sentence"].split()) in words
    for trial in result["trials"]:
        assert trial["name"] in words
        assert all(log["sha256"][:8] in words for log in trial["logs"])
    for parameter in result["accuracy"]["parameters"]:
        assert parameter["name"] in words
    assert f"{100.0 * result['fit']['eps_rmsn']:.2f}" in words


# --- the hidden effect --------------------------------------------------------------------------


@pytest.fixture(scope="module")
def truth() -> str:
    """Name of the effect that the sample trials have and the pipeline's model lacks."""
    name, _ = HIDDEN
    return str(name)


def test_the_hidden_effect_is_named(hidden: Finished, truth: str) -> None:
    assert truth not in hidden.result["model"]["effects"]
    verdict = hidden.result["verdict"]
    assert verdict["kind"] == "missing"
    assert truth in {verdict["effect"], *verdict["family"]}
    best = hidden.result["missing"][0]
    assert truth in {best["effect"], *best["family"]}
    assert verdict["effect"] in verdict["sentence"]


def test_with_it_the_error_falls_where_it_was_fitted_and_where_not(hidden: Finished) -> None:
    before, after = hidden.result["history"]
    assert after["added"] == hidden.result["verdict"]["effect"]
    assert after["effects"] == [*before["effects"], after["added"]]
    assert after["eps_rmsn"] < 0.85 * before["eps_rmsn"]
    assert after["eps_rmsn_check"] < 0.85 * before["eps_rmsn_check"]


def test_the_noise_stays_and_the_model_error_goes(hidden: Finished) -> None:
    change = hidden.result["before_after"]
    noise, model = change["noise"], change["undermodelling"]
    assert abs(noise[1] / noise[0] - 1.0) <= STEADY
    assert model[1] < 0.5 * model[0]
    assert hidden.result["split"]["interval"]["undermodelling"][0] > 0.0
    assert change["undermodelling_interval"][0] <= 0.0


def test_its_size_is_found(hidden: Finished, truth: str) -> None:
    """Where the true effect was refitted its parameter is within a quarter of the truth."""
    row = next(row for row in hidden.result["missing"] if row["effect"] == truth)
    for name, value in HIDDEN[1].items():
        assert row["parameters"][name]["refitted"] == pytest.approx(value, rel=0.25)


def test_a_quiet_stretch_outside_its_trial_is_refused(tmp_path: Path) -> None:
    text = HIDDEN_EFFECT.read_text(encoding="utf-8")
    text = text.replace('"../sample_data', f'"{(ROOT / "sample_data").as_posix()}')
    wrong = tmp_path / "quiet.toml"
    wrong.write_text(text + '\nquiet = [{ trial = "zigzag-10", window = [0.0, 5000.0] }]\n')
    with pytest.raises(
        PipelineError, match=r"diagnose.quiet\[0\].window: \[0, 5000\] s is outside"
    ):
        run(load(wrong))
