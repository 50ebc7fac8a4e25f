"""The model in use on the workbench: a manoeuvre tried, files handed out, what is refused."""

import io
import json
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
import quick
from quick import Address, diagnosed


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Address]:
    with quick.opened(quick.write(tmp_path_factory.mktemp("use") / "alone")) as desk:
        diagnosed(desk)
        with quick.serving(desk) as found:
            yield found


def test_a_manoeuvre_is_tried_on_the_spot(address: Address) -> None:
    made = address.post("/api/try", {"orders": "zigzag 10 10"})
    assert made.status == 200, made.body
    rows = {name: (float(value), likely) for name, value, likely in made.json["rows"]}
    value, likely = rows["first overshoot 10/10 [deg]"]
    low, high = (float(x) for x in likely.split(" to "))
    assert 0.0 < low <= value <= high
    picture = made.json["picture"]
    titles = [p["title"] for p in picture["panels"]]
    assert titles[0] == "rudder angle δ"
    assert {"yaw rate r", "heading ψ"} <= {*titles}
    assert all(p["line"] and p["band"] for p in picture["panels"][1:])
    assert picture["panels"][0]["band"] == ""
    assert len(picture["track"]["boxes"]) == 8
    said = {"zigzag 20,5 20": "'20,5': is no number; write it like 20.5", "zigzg 10": "'zigzag'"}
    for orders, words in said.items():
        error = address.post("/api/try", {"orders": orders}).json["error"]
        assert words in error
        assert "CSV" not in error
    for wrong in ({"orders": "zigzg 10"}, {"orders": ""}, {"orders": 3}, [1]):
        refused = address.post("/api/try", wrong)
        assert refused.status == 400
        assert "\n" not in refused.json["error"]


def test_the_model_is_handed_out(address: Address, tmp_path: Path) -> None:
    ship = address.get("/model/ship")
    assert ship.headers["content-disposition"] == 'attachment; filename="model.toml"'
    assert "uncertainty" in tomllib.loads(ship.body.decode())
    assert json.loads(address.get("/model/nomoto").body)["schema"] == "trialid-nomoto/1"
    names = {"json": "model.json", "nomoto": "model-nomoto.json", "pid": "model-pid.json"}
    for kind, name in names.items():
        told = address.get(f"/model/{kind}").headers["content-disposition"]
        assert told == f'attachment; filename="{name}"'
    with zipfile.ZipFile(io.BytesIO(address.get("/model/c").body)) as packed:
        assert set(packed.namelist()) == {"model.c", "model.h"}
    assert b"ATC_STR_RAT_FF," in address.get("/model/ardupilot?full_rudder=35").body
    wrongs = ("ardupilot?full_rudder=a", "ardupilot?full_rudder=-5", "ardupilot?full_command=1000")
    for wrong in ("ardupilot", *wrongs, "word"):
        assert address.get(f"/model/{wrong}").status == 400


def test_the_panel_links_to_what_is_there(address: Address) -> None:
    part = address.get("/api/screen").json["parts"]["use"]
    assert '<a href="/model/fmu" download>' in part
    assert 'data-path="/model/ardupilot"' in part
