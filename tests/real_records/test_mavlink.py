"""Real logs of an underwater vehicle, value by value against pymavlink."""

from collections import defaultdict

import numpy as np
import pytest
from real_record import DATA

from trialid.ingest import read
from trialid.ingest.mavlink.mavlink_meanings import unit

BIN, TLOG = DATA / "mavlink" / "small.BIN", DATA / "mavlink" / "small.tlog"
LEFT_OUT = {"FMT", "FMTU", "UNIT", "MULT", "PARM", "FILE", "PARAM_VALUE", "PARAM_EXT_VALUE"}
pytestmark = [
    pytest.mark.real_data,
    pytest.mark.skipif(not TLOG.exists(), reason="real records are not here"),
]


def all_of(log):
    found = defaultdict(list)
    while (message := log.recv_msg()) is not None:
        found[message.get_type()].append(message)
    log.close()
    return found


def test_every_value_of_a_dataflash_log():
    from pymavlink import DFReader

    recording, log = read(BIN), DFReader.DFReader_binary(str(BIN))
    compared = 0
    for kind, messages in all_of(log).items():
        if kind in LEFT_OUT:
            continue
        form = messages[0].fmt
        for k, field in enumerate(form.columns):
            if field in {"TimeUS", form.instance_field} or form.format[k] in "aZNn":
                continue
            devices = defaultdict(list)
            for message in messages:
                device = f"/{getattr(message, form.instance_field)}" if form.instance_field else ""
                devices[device].append((message.TimeUS, getattr(message, field)))
            for device, pairs in devices.items():
                t, y = np.array(pairs, float).T
                channel = recording.channels[f"{kind}{device}:{field}"]
                assert np.array_equal(channel.t, t.astype(np.int64) * 1000)
                factor = _factor(log, form, k)
                assert np.allclose(channel.y, y * factor, rtol=1e-12, atol=0, equal_nan=True)
                compared += len(t)
    assert compared > 50_000
    assert recording.channels["ATT:Roll"].unit == "deg"


def _factor(log, form, k):
    """Multiplier the log states; pymavlink puts it into the unit where the column has none."""
    if form.msg_mults[k] is not None or not form.units or not form.units[k]:
        return 1.0
    known = {"c": 1e-2, "m": 1e-3, "d": 1e-1, "µ": 1e-6, "n": 1e-9}
    for letter, factor in known.items():
        plain = form.units[k].removeprefix(letter)
        if plain != form.units[k] and plain in log.unit_lookup.values():
            return factor if form.units[k] not in log.unit_lookup.values() else 1.0
    return float(form.units[k].split()[0]) if " " in form.units[k] else 1.0


@pytest.mark.study(turn="each")
def test_every_value_of_a_telemetry_log(monkeypatch):
    monkeypatch.setenv("MAVLINK20", "1")
    from pymavlink import mavutil

    recording = read(TLOG)
    log = mavutil.mavlink_connection(str(TLOG), dialect="all", notimestamps=False)
    compared = 0
    for kind, messages in all_of(log).items():
        if kind in LEFT_OUT or kind == "BAD_DATA":
            continue
        for message in messages[:1]:
            for field in message.get_fieldnames():
                compared += _compare(recording, kind, messages, field)
    assert compared > 200_000
    assert any("4 messages fail their checksum" in one for one in recording.remarks)


def _compare(recording, kind, messages, field):
    sources = defaultdict(list)
    for one in messages:
        source = f"/{one.get_srcSystem()}/{one.get_srcComponent()}"
        device = getattr(one, one._instance_field) if one._instance_field else ""
        sources[f"{source}/{device}" if device else source].append(one)
    compared = 0
    for source, mine in sources.items():
        channel = recording.channels.get(f"{kind}{source}:{field}")
        if channel is None:
            continue
        y = np.array([getattr(one, field) for one in mine], float)
        y /= unit(mine[0].fieldunits_by_name.get(field, ""))[1]
        known = ~np.isnan(channel.y)
        assert np.allclose(channel.y[known], y[known], rtol=1e-12, atol=0)
        if channel.received is not None and channel.clock == "boot clock time_boot_ms":
            sent = np.array([one.time_boot_ms for one in mine]) * 1_000_000
            assert np.array_equal(channel.t, sent)
            received = np.array([one._timestamp for one in mine])
            assert np.abs(channel.received / 1e9 - received).max() < 1e-5
        compared += int(known.sum())
    return compared
