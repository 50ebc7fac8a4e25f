"""Positions of every format that has them, against independent decoders, and what is no fix."""

import sys
from pathlib import Path

import numpy as np
import pytest
from nmea2000.decoder import NMEA2000Decoder
from position_logs import LAYOUTS, gnss, sentence, sides
from pymavlink import DFReader
from pymavlink.dialects.v20 import all as dialect
from pynmeagps import NMEAReader

from trialid.ingest import fix_quality, read
from trialid.ingest.nmea2000 import nmea2000_messages
from trialid.recording import Channel, Recording

sys.path.insert(0, str(Path(__file__).parents[2] / "ingest"))
import write_dataflash
import write_tlog
from write_nmea0183 import checksum, iso

START = 1_700_000_000_000_000_000
N = 60


def places(seed):
    """Latitudes and longitudes of every quarter of the earth, and of its poles and date line."""
    rng = np.random.default_rng(seed)
    lat, lon = rng.uniform(-90.0, 90.0, N), rng.uniform(-180.0, 180.0, N)
    lat[:4], lon[:4] = (0.0, 89.99999, -89.99999, 1e-5), (0.0, 179.99999, -179.99999, -1e-5)
    return lat, lon


def logged(tmp_path, texts):
    path = tmp_path / "log"
    lines = [f"{iso(START + i * 100_000_000)} {text}\r\n" for i, text in enumerate(texts)]
    path.write_text("".join(lines), newline="")
    return read(path)


@pytest.mark.parametrize("kind", LAYOUTS)
def test_nmea0183_as_pynmeagps_reads_it(tmp_path, kind):
    texts = [
        sentence("GN", kind, LAYOUTS[kind](sides(*one))) for one in zip(*places(3), strict=True)
    ]
    told = [NMEAReader.parse(text + "\r\n") for text in texts]
    found = logged(tmp_path, texts).channels
    for name, theirs in (("latitude", "lat"), ("longitude", "lon")):
        channel = found[f"{kind}/GN:{name}"]
        assert channel.unit == "deg"
        np.testing.assert_allclose(channel.y, [getattr(m, theirs) for m in told], atol=1e-9)
    if kind in ("GGA", "GNS"):
        assert {*found[f"{kind}/GN:hdop"].y} == {0.94}
        assert {*found[f"{kind}/GN:satellites"].y} == {9.0}


@pytest.mark.parametrize(
    ("kind", "at", "letters"),
    [
        ("RMC", 1, "V"),
        ("RMC", 11, "NEMS"),
        ("GGA", 5, "0678"),
        ("GLL", 5, "V"),
        ("GLL", 6, "NES"),
        ("GNS", 5, "N"),
    ],
)
def test_what_is_no_fix_of_nmea0183_is_masked_and_said(tmp_path, kind, at, letters):
    for letter in letters:
        texts = []
        for k in range(20):
            fields = LAYOUTS[kind](sides(-56.1, 12.3))
            fields = [*fields[:at], letter, *fields[at + 1 :]] if k % 2 else fields
            texts.append(sentence("GP", kind, fields))
        log = logged(tmp_path, texts)
        y = log.channels[f"{kind}/GP:latitude"].y
        np.testing.assert_allclose(y, np.tile([-56.1, np.nan], 10), atol=1e-7)
        said = f"{kind}/GP:latitude: 10 of 20 values flagged invalid by their status"
        assert said in log.remarks


def test_a_receiver_of_before_the_modes_and_sixty_minutes(tmp_path):
    """RMC of NMEA 0183 2.1 ends with the variation; 5360.00 is no place."""
    old = sentence("GP", "RMC", LAYOUTS["RMC"](sides(53.5, 5.4))[:-1])
    wrong = old[1:].partition("*")[0].replace("5330.00000", "5360.00000")
    log = logged(tmp_path, [old, f"${wrong}*{checksum(wrong)}"] * 10)
    y = log.channels["RMC/GP:latitude"].y
    np.testing.assert_allclose(y, np.tile([53.5, np.nan], 10), atol=1e-9)
    assert any("no numbers" in one for one in log.remarks)


def test_two_receivers_are_two(tmp_path):
    texts = []
    for k in range(20):
        for talker, lat in (("GP", 56.0), ("GL", 56.0002)):
            texts.append(sentence(talker, "GGA", LAYOUTS["GGA"](sides(lat + k * 1e-4, 12.0))))
    found = logged(tmp_path, texts).channels
    apart = found["GGA/GL:latitude"].y - found["GGA/GP:latitude"].y
    np.testing.assert_allclose(apart, 2e-4, atol=1e-7)


def mavlink(tmp_path, seed):
    """Every third raw fix is none, by its own word."""
    log, by = write_tlog.Log(), write_tlog.sender()
    sent = []
    for k, (lat, lon) in enumerate(zip(*places(seed), strict=True)):
        at = round(lat * 1e7), round(lon * 1e7)
        raw = dialect.MAVLink_gps_raw_int_message(
            time_usec=10**6 + 10**5 * k,
            fix_type=1 if k % 3 == 0 else 3,
            lat=at[0],
            lon=at[1],
            **{"alt": 0, "eph": 90, "epv": 100, "vel": 100, "cog": 100, "satellites_visible": 9},
        )
        whole = dialect.MAVLink_global_position_int_message(
            time_boot_ms=1000 + 100 * k,
            lat=at[0],
            lon=at[1],
            **{"alt": 0, "relative_alt": 0, "vx": 0, "vy": 0, "vz": 0, "hdg": 0},
        )
        for message in (raw, whole):
            log.add(START // 1000 + 10**5 * k, message, by)
        sent.append(at)
    path = tmp_path / "log"
    path.write_bytes(log.content())
    return path, np.array(sent) / 1e7


def test_mavlink_as_pymavlink_packs_it(tmp_path):
    path, sent = mavlink(tmp_path, 4)
    log = read(path)
    for place, name in enumerate(("lat", "lon")):
        channel = log.channels[f"GLOBAL_POSITION_INT/1/1:{name}"]
        assert channel.unit == "deg"
        np.testing.assert_allclose(channel.y, sent[:, place], rtol=1e-15)
        raw = log.channels[f"GPS_RAW_INT/1/1:{name}"].y
        assert np.isnan(raw[::3]).all()
        kept = np.arange(N) % 3 > 0
        np.testing.assert_allclose(raw[kept], sent[kept, place], rtol=1e-15)
    assert any("20 of 60 without a fix" in one and "fix_type" in one for one in log.remarks)
    alone = read(path, ["GPS_RAW_INT/1/1:lat"])
    assert [*alone.channels] == ["GPS_RAW_INT/1/1:lat"]
    assert np.isnan(alone.channels["GPS_RAW_INT/1/1:lat"].y[::3]).all()


def test_dataflash_as_pymavlink_reads_it(tmp_path):
    lat, lon = places(5)
    rows = []
    for k, place in enumerate(zip(lat, lon, strict=True)):
        fix = (10**6 + 10**5 * k, k % 2, 0 if k % 5 == 0 else 3, 1000 * k, 2200, 9, 0.9)
        rows.append(write_dataflash.packed(write_dataflash.GPS, *fix, *place, *(0, 7, 10, 0, 0)))
    path = tmp_path / "log.bin"
    path.write_bytes(write_dataflash.description() + b"".join(rows))
    theirs = DFReader.DFReader_binary(str(path))
    told = []
    while (message := theirs.recv_match(type="GPS")) is not None:
        told.append((message.I, message.Status, message.Lat, message.Lng))
    theirs.close()
    told = np.array(told)
    log = read(path)
    for device in (0, 1):
        mine = told[told[:, 0] == device]
        for place, name in ((2, "Lat"), (3, "Lng")):
            y = log.channels[f"GPS/{device}:{name}"].y
            fixed = mine[:, 1] > 1
            np.testing.assert_allclose(y[fixed], mine[fixed, place], rtol=1e-12)
            assert np.isnan(y[~fixed]).all()
    assert sum("without a fix" in one for one in log.remarks) == 2


def test_nmea2000_as_canboat_reads_it_and_each_method():
    decoder, methods = NMEA2000Decoder(), np.arange(N) % 16
    lat, lon = places(6)
    told = [gnss(*one) for one in zip(lat, lon, methods.tolist(), strict=True)]
    stamps, group = START + 10**8 * np.arange(N), np.full(N, 129029)
    found, remarks = nmea2000_messages.channels(stamps, group, np.full(N, 7), told, "test")
    theirs = []
    for one in told:
        data = ",".join(f"{byte:02x}" for byte in one)
        line = f"2020-01-01T00:00:00.000Z,2,129029,7,255,{len(one)},{data}"
        theirs.append({f.id: f.value for f in decoder.decode(line).fields})
    none = np.isin(methods, [0, 6, 7, 8, 14])
    for name in ("latitude", "longitude"):
        y = found[f"gnss/7:{name}"].y
        assert np.isnan(y[none]).all()
        told_so = np.array([one[name] for one in theirs])
        np.testing.assert_allclose(y[~none], told_so[~none], rtol=1e-12)
    said = {str(theirs[k]["method"]) for k in np.flatnonzero(none)}
    assert said == {"no GNSS", "Estimated (DR) mode", "Manual Input", "Simulate mode", "None"}
    assert found["gnss/7:hdop"].y == pytest.approx(0.94)
    assert any("are no fix by satellites" in r for r in remarks)


def test_a_fix_of_ros_and_what_is_not_asked_for():
    """NavSatFix: -1 is no fix, 0 a plain one; another message's stamps judge nothing."""
    t = START + 10**8 * np.arange(4)
    names = {"latitude": [56.0, 56.1, 56.2, 56.3], "status.status": [0.0, -1.0, 2.0, -1.0]}
    channels = {f"/fix:{n}": Channel(f"/fix:{n}", t, np.array(y)) for n, y in names.items()}
    log = Recording(Path("log"), "test", "", channels)
    asked = fix_quality.with_quality(["/fix:latitude"])
    assert "/fix:status.status" in (asked or ())
    found = fix_quality.without_poor_fixes(log, ["/fix:latitude"])
    assert [*found.channels] == ["/fix:latitude"]
    np.testing.assert_array_equal(found.channels["/fix:latitude"].y, [56.0, np.nan, 56.2, np.nan])
    assert "2 of 4 without a fix (/fix:status.status below 0), not available" in found.remarks[0]
    later = {**channels, "/fix:status.status": Channel("s", t + 1, channels["/fix:latitude"].y)}
    kept = fix_quality.without_poor_fixes(Recording(Path("log"), "test", "", later), None)
    assert kept.channels["/fix:latitude"] is channels["/fix:latitude"]
