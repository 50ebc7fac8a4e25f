"""Tables with one value a row are the same log as a table with a column a channel."""

import numpy as np
import pandas as pd
import pytest

from trialid.ingest import read

T = np.arange(0.0, 60.0, 0.5)
MOTION = {"rudder_deg": 10.0 * np.sign(np.sin(T / 9.0)), "rot [deg/min]": 20.0 * np.sin(T / 9.0)}


def rows(value="value", **more):
    """The motion one value a row, as a table; its channels every second sample apart."""
    parts = [
        pd.DataFrame({"time": T[k::2], "tag": name, value: y[k::2], **more})
        for k, (name, y) in enumerate(MOTION.items())
    ]
    return pd.concat(parts).sort_values("time", kind="stable")


@pytest.mark.parametrize("form", ["csv", "parquet", "xlsx"])
@pytest.mark.parametrize("value", ["value", "Wert", "_value"])
def test_each_name_is_a_channel_with_its_own_stamps(tmp_path, form, value):
    path = tmp_path / f"log.{form}"
    write = {"csv": "to_csv", "parquet": "to_parquet", "xlsx": "to_excel"}[form]
    getattr(rows(value), write)(path, index=False)
    found = read(path).channels
    assert list(found) == ["rudder_deg", "rot"]
    assert found["rot"].unit == "deg/min"
    for k, (channel, y) in enumerate(zip(found.values(), MOTION.values(), strict=True)):
        np.testing.assert_allclose(channel.t / 1e9, T[k::2], atol=1e-9)
        np.testing.assert_allclose(channel.y, y[k::2], rtol=1e-14)


def test_units_stand_in_a_column_of_their_own_and_text_is_left_out(tmp_path):
    table = rows(unit="deg")
    mode = pd.DataFrame({"time": [0.0, 30.0], "tag": "mode", "value": ["AUTO", "HAND"], "unit": ""})
    pd.concat([table, mode]).to_csv(tmp_path / "log.csv", index=False)
    found = read(tmp_path / "log.csv")
    assert [one.unit for one in found.channels.values()] == ["deg", "deg/min"]
    assert "'mode' holds text, left out" in found.remarks


def test_messages_by_number_keep_what_the_number_is(tmp_path):
    table = rows().replace({"tag": {"rudder_deg": 3, "rot [deg/min]": 5}})
    table.rename(columns={"tag": "MsgID", "value": "Data"}).to_csv(tmp_path / "a.csv", index=False)
    assert list(read(tmp_path / "a.csv").channels) == ["MsgID 3", "MsgID 5"]


def test_a_column_of_modes_beside_a_channel_makes_no_channels(tmp_path):
    text = "time,mode,rudder\n0,AUTO,1\n1,HAND,2\n2,AUTO,3\n"
    (tmp_path / "a.csv").write_text(text)
    assert list(read(tmp_path / "a.csv").channels) == ["rudder"]


def test_a_channel_is_read_alone(tmp_path):
    rows().to_csv(tmp_path / "log.csv", index=False)
    assert list(read(tmp_path / "log.csv", ["rot"]).channels) == ["rot"]


@pytest.mark.parametrize("names", ["parameter_id", "TagName", "signal name"])
def test_a_column_of_names_may_say_that_it_is_one(tmp_path, names):
    table = rows(vessel_id="name_FRAM").rename(columns={"tag": names})
    table.to_csv(tmp_path / "a.csv", index=False)
    assert list(read(tmp_path / "a.csv").channels) == ["rudder_deg", "rot"]


def test_of_a_number_and_a_name_the_name_is_meant(tmp_path):
    table = rows().rename(columns={"tag": "sensor_name"})
    table.insert(0, "sensor_id", [3] * len(table))
    table.to_csv(tmp_path / "a.csv", index=False)
    assert list(read(tmp_path / "a.csv").channels) == ["rudder_deg", "rot"]
