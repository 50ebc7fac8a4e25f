"""Messages to channels; the oracle is `nmea2000`, which wraps canboat's own decoder."""

import itertools
import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nmea2000.decoder import NMEA2000Decoder

from trialid.ingest.nmea2000 import nmea2000_frames, nmea2000_messages
from trialid.ingest.nmea2000.nmea2000_pgns import LAYOUTS

THEIRS = {
    (127237, "rudder_order"): "commandedRudderAngle",
    (127237, "{}_heading_to_steer"): "headingToSteerCourse",
    (127237, "rate_of_turn_order"): "rateOfTurnOrder",
    (127237, "{}_heading"): "vesselHeading",
    (127245, "order"): "angleOrder",
    (127245, "position"): "position",
    (127250, "{}"): "heading",
    (127250, "deviation"): "deviation",
    (127250, "variation"): "variation",
    (127251, "rate"): "rate",
    (127252, "heave"): "heave",
    (127257, "yaw"): "yaw",
    (127257, "pitch"): "pitch",
    (127257, "roll"): "roll",
    (127258, "variation"): "variation",
    (127488, "speed"): "speed",
    (127493, "gear"): "transmissionGear",
    (128259, "water"): "speedWaterReferenced",
    (128259, "ground"): "speedGroundReferenced",
    (128267, "below_transducer"): "depth",
    (128267, "offset"): "offset",
    (129025, "latitude"): "latitude",
    (129025, "longitude"): "longitude",
    (129026, "{}_cog"): "cog",
    (129026, "sog"): "sog",
    (129029, "latitude"): "latitude",
    (129029, "longitude"): "longitude",
    (129029, "satellites"): "numberOfSvs",
    (129029, "hdop"): "hdop",
    (130306, "{}_speed"): "windSpeed",
    (130306, "{}_angle"): "windAngle",
    (130578, "longitudinal_water"): "longitudinalSpeedWaterReferenced",
    (130578, "transverse_water"): "transverseSpeedWaterReferenced",
    (130578, "longitudinal_ground"): "longitudinalSpeedGroundReferenced",
    (130578, "transverse_ground"): "transverseSpeedGroundReferenced",
    (130578, "stern_water"): "sternSpeedWaterReferenced",
    (130578, "stern_ground"): "sternSpeedGroundReferenced",
}
"""Our fields and the same of the oracle."""

LENGTH = {127237: 21, 129029: 43, 130578: 12}
S = 1_000_000_000


def decode(messages, wanted=None, **more):
    """Channels of (second, group, source, payload) messages."""
    t, pgn, source, payloads = zip(*messages, strict=True)
    return nmea2000_messages.channels(
        np.array(t, np.int64) * S, np.array(pgn), np.array(source), payloads, "test", wanted, **more
    )


def oracle(decoder, pgn, payload):
    data = ",".join(f"{byte:02x}" for byte in payload)
    line = f"2020-01-01T00:00:00.000Z,2,{pgn},7,255,{len(payload)},{data}"
    message = decoder.decode(line)
    return {one.id: one.value for one in message.fields}


def test_every_field_has_its_oracle():
    assert set(THEIRS) == {(p, one.name) for p, lay in LAYOUTS.items() for one in lay.fields}


@pytest.mark.parametrize("pgn", LAYOUTS)
def test_any_payload_reads_as_the_oracle_reads_it(pgn):
    layout, rng, decoder = LAYOUTS[pgn], np.random.default_rng(pgn), NMEA2000Decoder()
    edges = [0, 1, 0x7F, 0x80, 0xFC, 0xFD, 0xFE, 0xFF]
    compared = 0
    for k in range(300):
        payload = bytearray(rng.integers(0, 256, LENGTH.get(pgn, 8), np.uint8).tobytes())
        for one in layout.fields:  # the codes at the ends of the range, which chance misses
            if k % 3 == 0:
                payload[one.at] = edges[k // 3 % 8]
                payload[one.at + 1 : one.end] = bytes([edges[k // 24 % 8]] * (one.size - 1))
        ours, _ = decode([(0, pgn, 7, bytes(payload))])
        theirs = oracle(decoder, pgn, payload)
        for one in layout.fields:
            names = [name for name in ours if _is(name.partition(":")[2], one.name)]
            value = theirs[THEIRS[pgn, one.name]]
            value = {"Forward": 0, "Neutral": 1, "Reverse": 2}.get(value, value)
            if value is not None and value > one.limit + one.step / 2:
                value = None  # the oracle keeps to the lower end of a range only
            if pgn == 129029 and one.unit == "deg" and payload[31] >> 4 in (0, 6, 7, 8, 14):
                value = None  # the message itself says that no satellite told it
            assert len(names) == (value is not None), (payload.hex(), one.name, value)
            if names:
                assert ours[names[0]].y[0] == pytest.approx(value, rel=1e-12, abs=1e-12)
                compared += 1
    assert compared > 80 * len(layout.fields)


def _is(name, pattern):
    _, brace, tail = pattern.partition("{}")
    if not brace:
        return name == pattern
    known = ("true", "magnetic", "apparent", "reference")
    return name.startswith(known) and name.endswith(tail) and (tail or "_" not in name)


def rudder(position, order=0x7FFF, instance=0):
    return struct.pack("<BBhhH", instance, 0xFF, order, position, 0xFFFF)


def claim(name):
    return struct.pack("<Q", name)


def test_order_and_position_are_two_channels_and_so_are_sources_and_instances():
    messages = [
        (0, 127245, 204, rudder(0x7FFF, 1000, 255)),
        (1, 127245, 11, rudder(-2000, instance=255)),
        (2, 127245, 11, rudder(500)),
        (3, 127245, 11, rudder(-1000, instance=255)),
    ]
    channels, remarks = decode(messages)
    assert {name: one.y.tolist() for name, one in channels.items()} == {
        "rudder/204/255:order": [0.1],
        "rudder/11/255:position": [-0.2, -0.1],
        "rudder/11/0:position": [0.05],
    }
    position = channels["rudder/11/255:position"]
    assert position.t.tolist() == [1 * S, 3 * S]
    assert (position.unit, position.quantity, position.positive) == ("rad", "delta", "starboard")
    words = "PGN 127245 rudder, source 11, instance 255, angle fed back"
    assert position.description == words
    assert channels["rudder/204/255:order"].quantity == "delta_order"
    assert remarks == [
        "`not available` throughout, left out: rudder/11/0:order, rudder/11/255:order, "
        "rudder/204/255:position"
    ]


def test_only_the_wanted():
    messages = [(0, 127245, 11, rudder(5, 7)), (0, 127251, 11, bytes(8)), (1, 127251, 12, bytes(8))]
    assert set(decode(messages, ["rudder/11/0:order"])[0]) == {"rudder/11/0:order"}
    rates = {"rate_of_turn/11:rate", "rate_of_turn/12:rate"}
    assert set(decode(messages, ["rate_of_turn"])[0]) == rates


def test_short_messages_are_counted_and_give_what_they_hold():
    messages = [(k, 127245, 11, rudder(5, 7)[: 6 - 2 * (k > 3)]) for k in range(9)]
    channels, remarks = decode(messages)
    assert len(channels["rudder/11/0:order"].y) == 9
    assert channels["rudder/11/0:position"].t.tolist() == [0, 1 * S, 2 * S, 3 * S]
    short = "5 of 9 messages end early, the fields they lack are left out"
    assert remarks == [f"rudder (PGN 127245): {short}"]
    assert decode([(0, 127245, 1, b"")])[0] == {}


def test_references_are_channels_of_their_own():
    def wind(reference):
        return struct.pack("<BHHBH", 0, 100, 200, reference, 0)

    messages = [(k, 130306, 5, wind(k)) for k in range(8)]
    channels, _ = decode(messages)
    assert [name.partition(":")[2] for name in channels if name.endswith("angle")] == [
        *(f"{name}_angle" for name in ("true_north", "magnetic_north", "apparent")),
        *(f"{name}_angle" for name in ("true_boat", "true_water")),
        *(f"reference{k}_angle" for k in (5, 6, 7)),
    ]
    assert channels["wind/5:apparent_angle"].quantity == "gamma_aw"
    assert channels["wind/5:apparent_speed"].quantity == "V_aw"
    assert channels["wind/5:true_water_angle"].quantity is None


def test_speed_is_unsigned():
    (channel,) = decode([(0, 128259, 5, bytes([0, 0xFF, 0x7F, 0xFF, 0xFF, 0, 0, 0]))])[0].values()
    assert (channel.name, channel.y.tolist()) == ("speed/5:water", [327.67])


def test_an_address_that_changes_hands_is_two_senders():
    messages = [
        (0, 127245, 11, rudder(1000)),
        (1, 60928, 11, claim(0xC0FFEE)),
        (2, 127245, 11, rudder(2000)),
        (3, 60928, 11, claim(0xBEEF)),
        (4, 127245, 11, rudder(3000)),
    ]
    channels, remarks = decode(messages)
    assert {name: one.y.tolist() for name, one in channels.items()} == {
        "rudder/11-0000000000C0FFEE/0:position": [0.1, 0.2],
        "rudder/11-000000000000BEEF/0:position": pytest.approx([0.3]),
    }
    owners = "11-0000000000C0FFEE and 11-000000000000BEEF"
    assert remarks[0] == f"address 11 changed hands in this log: its devices are {owners}"


def test_a_device_that_moves_is_one_sender():
    name = 0xC0508C0020A3B2F1
    messages = [
        (0, 60928, 11, claim(name)),
        (1, 127245, 11, rudder(1000)),
        (2, 60928, 11, claim(5)),
        (2, 60928, 254, claim(name)),
        (3, 60928, 13, claim(name)),
        (4, 127245, 13, rudder(2000)),
    ]
    channels, remarks = decode(messages)
    assert channels["rudder/11/0:position"].y.tolist() == [0.1, 0.2]
    assert "NAME C0508C0020A3B2F1" in channels["rudder/11/0:position"].description
    moved = "moved from address 11 to 13: its channels are those of source 11"
    assert remarks[0] == f"device C0508C0020A3B2F1 {moved}"
    assert len(channels) == 1


def test_a_claim_repeated_changes_nothing():
    messages = [
        (k, *([60928, 11, claim(7)] if k % 2 else [127245, 11, rudder(k)])) for k in range(9)
    ]
    channels, _ = decode(messages)
    assert list(channels) == ["rudder/11/0:position"]


def test_two_buses_are_kept_apart():
    messages = [(0, 127245, 11, rudder(1)), (1, 127245, 256 + 11, rudder(2))]
    channels, _ = decode(messages, buses=("can0", "can1"))
    assert list(channels) == ["rudder/can0.11/0:position", "rudder/can1.11/0:position"]


def test_the_time_of_the_bus_is_a_remark():
    def time(t):
        days, tick = divmod(t * 10_000, 864_000_000)
        return struct.pack("<BBHI", 0, 0xF0, days, tick)

    messages = [(t, 126992, 3, time(t + 7200)) for t in range(1_600_000_000, 1_600_000_005)]
    messages.append((1_600_000_006, 126992, 3, b"\xff" * 8))
    channels, remarks = decode(messages)
    told = "is 7200.000 s ahead of the stamps (median of 5, spread 0.000 s)"
    assert (channels, remarks) == ({}, [f"system time (PGN 126992) of source 3 {told}"])


# frames


def frames_of(pgn, source, payload, sequence):
    """A fast packet as its frames: (identifier, 8 bytes)."""
    stream = bytes([len(payload)]) + payload
    parts = [stream[i : i + 7] for i in range(0, len(stream), 7)]
    return [
        (0x08000000 | pgn << 8 | source, bytes([sequence % 8 << 5 | k]) + part.ljust(7, b"\xff"))
        for k, part in enumerate(parts)
    ]


def assembled(frames, gap=1_000_000, bus=0):
    ids, data = zip(*frames, strict=True)
    table = np.frombuffer(b"".join(data), np.uint8).reshape(-1, 8)
    t = np.arange(len(ids), dtype=np.int64) * gap
    return nmea2000_frames.assemble(t, np.array(ids), table, np.full(len(ids), 8), bus)


def payloads_of(whole):
    data = whole.payloads
    spans = zip(data.start.tolist(), data.length.tolist(), strict=True)
    return [data.buffer[start : start + length].tobytes() for start, length in spans]


A = [bytes([k]) * 12 for k in range(20)]
B = [bytes([100 + k]) * 21 for k in range(20)]


def test_identifiers_agree_with_the_oracle():
    ids = np.random.default_rng(4).integers(0, 1 << 29, 2000)
    pgn, source = nmea2000_frames.group_and_source(ids)
    for k, one in enumerate(ids.tolist()):
        assert NMEA2000Decoder.extract_header(one)[:2] == (pgn[k], source[k])


def test_interleaved_senders_and_groups():
    streams = [
        [f for k in range(20) for f in frames_of(130578, 1, A[k], k)],
        [f for k in range(20) for f in frames_of(130578, 2, A[k], k)],
        [f for k in range(20) for f in frames_of(127237, 1, B[k], k)],
    ]
    mixed = [f for row in itertools.zip_longest(*streams) for f in row if f is not None]
    whole = assembled(mixed)
    assert (whole.packets, whole.lost) == (60, 0)
    for source, pgn, sent in ((1, 130578, A), (2, 130578, A), (1, 127237, B)):
        mine = (whole.source == source) & (whole.pgn == pgn)
        got = [one for one, is_mine in zip(payloads_of(whole), mine, strict=True) if is_mine]
        assert got == sent


@pytest.mark.parametrize("sequence", [lambda k: k, lambda k: 0])
def test_a_lost_frame_costs_its_packet_only(sequence):
    frames = [f for k in range(20) for f in frames_of(127237, 1, B[k], sequence(k))]
    for gone in range(4, len(frames) - 4):
        whole = assembled(frames[:gone] + frames[gone + 1 :])
        lost = gone // 4
        assert payloads_of(whole) == B[:lost] + B[lost + 1 :]
        assert whole.lost == 1


def test_a_log_that_begins_and_ends_within_a_packet():
    frames = [f for k in range(6) for f in frames_of(127237, 1, B[k], k)]
    assert payloads_of(assembled(frames[1:-1])) == B[1:5]


def test_frames_of_a_packet_out_of_order():
    frames = [f for k in range(6) for f in frames_of(127237, 1, B[k], k)[::-1]]
    whole = assembled(frames)
    assert payloads_of(whole) == B[:6]
    assert whole.t.tolist() == [k * 4_000_000 for k in range(6)]


def test_a_packet_left_open_is_not_filled_up_much_later():
    first, second = frames_of(127237, 1, B[0], 3), frames_of(127237, 1, B[1], 3)
    assert (
        payloads_of(assembled([*first[:2], *second[2:]], gap=nmea2000_frames.PACKET_NS + 1)) == []
    )


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.data())
def test_whatever_is_lost_no_payload_is_made_up(data):
    streams = [
        [f for k in range(12) for f in frames_of(127237, 1, B[k], k)],
        [f for k in range(12) for f in frames_of(130578, 1, A[k], k)],
    ]
    frames = [f for row in itertools.zip_longest(*streams) for f in row if f is not None]
    keep = data.draw(st.lists(st.booleans(), min_size=len(frames), max_size=len(frames)))
    kept = [f for f, is_kept in zip(frames, keep, strict=True) if is_kept]
    if kept:
        assert set(payloads_of(assembled(kept))) <= {*A, *B}


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.lists(st.tuples(st.integers(0, 3), st.binary(min_size=8, max_size=8)), max_size=60))
def test_any_frames_at_all(frames):
    pgns = (127237, 130578, 129029, 127245)
    if frames:
        whole = assembled([(0x08000000 | pgns[k] << 8, data) for k, data in frames])
        nmea2000_messages.channels(whole.t, whole.pgn, whole.source, whole.payloads, "test")
        assert whole.payloads.length.max(initial=0) <= nmea2000_frames.LONGEST
