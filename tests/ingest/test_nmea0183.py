"""NMEA 0183 sentences to numbers: against pynmeagps, and what must be no number."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pynmeagps import NMEAMessage, NMEAReader
from write_nmea0183 import checksum, iso, sentence

from trialid.ingest import read
from trialid.ingest.nmea0183 import nmea0183_columns, nmea0183_sentences

START = 1_700_000_000_000_000_000
N = 200


def number(rng):
    """A decimal as devices print it."""
    digits = int(rng.integers(0, 4))
    text = f"{rng.uniform(-400, 400):.{digits}f}"
    return rng.choice([text, text, text, f"+{text.lstrip('-')}", ""])


def letter(*letters):
    return lambda rng: str(rng.choice(letters))


def fixed(text):
    return lambda rng: text


AV = letter("A", "A", "V")
EW = letter("E", "W")
LR = letter("L", "R")
# talker, sentence, makers of its fields, and for each of our channels: the field of pynmeagps and
# what that becomes, given the whole message
SENTENCES = [
    ("AG", "RSA", [number, AV, number, AV], {
        "RSA/AG:starboard": lambda m: m.stbdangle if m.stbdstatus == "A" else "",
        "RSA/AG:port": lambda m: m.portangle if m.portstatus == "A" else ""}),
    ("AG", "ROR", [number, AV, number, AV, fixed("B")], {
        "ROR/AG:starboard": lambda m: m.stbdrudderorder if m.stbdrudderstatus == "A" else "",
        "ROR/AG:port": lambda m: m.portrudderorder if m.portrudderstatus == "A" else ""}),
    ("AG", "HTC", [AV, number, LR, fixed("M"), fixed("N"), *[number] * 7, fixed("T"), AV], {
        "HTC/AG:rudder_order": lambda m: sided(m.cmdrudderang, m.cmdrudderdir == "L"),
        "HTC/AG:heading_order": lambda m: m.cmdheading}),
    ("AG", "HTD", [AV, number, LR, fixed("M"), fixed("N"), *[number] * 7, fixed("T"), AV, AV, AV,
                   number], {
        "HTD/AG:rudder_order": lambda m: sided(m.cmdrudderang, m.cmdrudderdir == "L"),
        "HTD/AG:heading_order": lambda m: m.cmdheading}),
    ("TI", "ROT", [number, AV], {"ROT/TI:rate": lambda m: m.rot if m.valid == "A" else ""}),
    ("HE", "HDT", [number, fixed("T")], {"HDT/HE:heading": lambda m: m.headingT}),
    ("HC", "HDM", [number, fixed("M")], {"HDM/HC:heading": lambda m: m.headingM}),
    ("HE", "THS", [number, letter("A", "E", "M", "S", "V")], {
        "THS/HE:heading": lambda m: m.headt if m.mi in "AE" else ""}),
    ("HC", "HDG", [number, number, EW, number, EW], {
        "HDG/HC:heading": lambda m: m.headingM,
        "HDG/HC:deviation": lambda m: sided(m.deviation, m._payload[2] == "W"),
        "HDG/HC:variation": lambda m: sided(m.variation, m._payload[4] == "W")}),
    ("VD", "VBW", [number, number, AV, number, number, AV, number, AV, number, AV], {
        "VBW/VD:longitudinal_water": lambda m: m.longwaterspd if m.waterspdstatus == "A" else "",
        "VBW/VD:transverse_water": lambda m: m.transwaterspd if m.waterspdstatus == "A" else "",
        "VBW/VD:longitudinal_ground": lambda m: (
            m.longgroundspd if m.groundspdstatus == "A" else ""),
        "VBW/VD:transverse_ground": lambda m: (
            m.transgroundspd if m.groundspdstatus == "A" else ""),
        "VBW/VD:stern_transverse_water": lambda m: (
            m.sterntranswaterspd if m.sternwaterspdstatus == "A" else ""),
        "VBW/VD:stern_transverse_ground": lambda m: (
            m.sterntransgroundspd if m.sterngroundspdstatus == "A" else "")}),
    ("VW", "VHW", [number, fixed("T"), number, fixed("M"), number, fixed("N"), number,
                   fixed("K")], {
        "VHW/VW:true_heading": lambda m: m.hdgT,
        "VHW/VW:magnetic_heading": lambda m: m.hdgM,
        "VHW/VW:speed": lambda m: m.spdN,
        "VHW/VW:speed_kmh": lambda m: m.spdK}),
    ("GP", "VTG", [number, fixed("T"), number, fixed("M"), number, fixed("N"), number, fixed("K"),
                   letter("A", "D", "N")], {
        "VTG/GP:true_course": lambda m: m.cogt if m.posMode != "N" else "",
        "VTG/GP:magnetic_course": lambda m: m.cogm if m.posMode != "N" else "",
        "VTG/GP:speed": lambda m: m.sogn if m.posMode != "N" else "",
        "VTG/GP:speed_kmh": lambda m: m.sogk if m.posMode != "N" else ""}),
    ("GP", "RMC", [fixed("221320"), AV, fixed("5310.81"), fixed("N"), fixed("00525.70"), fixed("E"),
                   number, number, fixed("141123"), number, EW, fixed("A")], {
        "RMC/GP:speed": lambda m: m.spd if m.status == "A" else "",
        "RMC/GP:course": lambda m: m.cog if m.status == "A" else "",
        "RMC/GP:variation": lambda m: sided(m.mv, m.mvEW == "W")}),
    ("WI", "MWV", [number, letter("R", "T"), number, fixed("N"), AV], {
        "MWV/WI:relative_angle": lambda m: m.angle if ok(m, "R") else skip(m, "R"),
        "MWV/WI:relative_speed": lambda m: m.speed if ok(m, "R") else skip(m, "R"),
        "MWV/WI:theoretical_angle": lambda m: m.angle if ok(m, "T") else skip(m, "T"),
        "MWV/WI:theoretical_speed": lambda m: m.speed if ok(m, "T") else skip(m, "T")}),
    ("II", "RPM", [fixed("S"), fixed("1"), number, number, AV], {
        "RPM/II/S1:speed": lambda m: m.rpm if m.status == "A" else "",
        "RPM/II/S1:pitch": lambda m: m.pitch if m.status == "A" else ""}),
    ("II", "XDR", [fixed("A"), number, fixed("D"), fixed("ROLL"), fixed("C"), number, fixed("C"),
                   fixed("AIR"), fixed("A"), number, fixed("D"), fixed("ROLL")], {
        "XDR/II/ROLL:angle": lambda m: m.data_01,
        "XDR/II/AIR:temperature": lambda m: m.data_02,
        "XDR/II/ROLL.2:angle": lambda m: m.data_03}),
    ("SD", "DPT", [number, number], {
        "DPT/SD:depth": lambda m: m.depth, "DPT/SD:offset": lambda m: m.offset}),
    ("SD", "DBT", [number, fixed("f"), number, fixed("M"), number, fixed("F")], {
        "DBT/SD:depth": lambda m: m.depthm, "DBT/SD:depth_feet": lambda m: m.depthf}),
    ("P", "ASHR", [fixed("085335.000"), number, fixed("T"), number, number, fixed("+00.10"),
                   fixed("0.1"), fixed("0.1"), fixed("0.2"), fixed("1"), fixed("0")], {
        "PASHR:heading": lambda m: m.trueHdg,
        "PASHR:roll": lambda m: m.roll,
        "PASHR:pitch": lambda m: m.pitch}),
    ("P", "ASHR", [fixed("ATT"), fixed("1.0"), number, number, number], {
        "PASHR:heading": lambda m: m.trueHdg,
        "PASHR:pitch": lambda m: m.pitch,
        "PASHR:roll": lambda m: m.roll}),
    ("P", "FEC", [fixed("GPatt"), number, number, number], {
        "PFEC:heading": lambda m: m.yaw,
        "PFEC:pitch": lambda m: m.pitch,
        "PFEC:roll": lambda m: m.roll}),
]  # fmt: skip

SKIP = object()


def sided(value, minus):
    return value if value == "" else -value if minus else value


def ok(message, reference):
    return message.reference == reference and message.status == "A"


def skip(message, reference):
    return "" if message.reference == reference else SKIP


def raw(talker, kind, fields):
    body = ",".join([talker + kind, *fields])
    return f"${body}*{checksum(body)}"


def log(tmp_path, sentences):
    path = tmp_path / "log"
    lines = [f"{iso(START + i * 100_000_000)} {text}\r\n" for i, text in enumerate(sentences)]
    path.write_text("".join(lines), newline="")
    return path


@pytest.mark.parametrize(
    ("talker", "kind", "makers", "expected"),
    SENTENCES,
    ids=lambda p: p if isinstance(p, str) else "",
)
def test_as_pynmeagps_reads_it(tmp_path, talker, kind, makers, expected):
    rng = np.random.default_rng(5)
    rows = [[str(maker(rng)) for maker in makers] for _ in range(N)]
    texts = [raw(talker, kind, fields) for fields in rows]
    messages = [NMEAReader.parse(text + "\r\n") for text in texts]
    empty = re.compile(r"0*\.?0*$")
    channels = read(log(tmp_path, texts)).channels
    assert set(channels) >= set(expected)
    for name, of in expected.items():
        y = []
        for message, fields in zip(messages, rows, strict=True):
            value = of(message)
            if value is SKIP:
                continue
            # pynmeagps reads an empty number as 0.0
            blank = value == 0.0 and not any(f and empty.match(f.lstrip("+-")) for f in fields)
            y.append(np.nan if value == "" or blank else float(value))
        got = channels[name].y
        assert len(got) == len(y)
        zero = np.asarray(y) == 0.0
        np.testing.assert_array_equal(got[~zero], np.asarray(y)[~zero])
        assert np.all((got[zero] == 0) | np.isnan(got[zero]))


def test_units_sides_and_words(tmp_path):
    texts = [
        raw("AG", "RSA", ["-3.5", "A", "", "V"]),
        raw("P", "SXN", ["23", "-1.47", "0.01", "235.77", "-0.38"]),
        raw("II", "RPM", ["S", "2", "-80", "50", "A"]),
        raw("II", "RPM", ["E", "0", "900", "", "A"]),
        raw("WI", "MWV", ["30", "R", "10", "M", "A"]),
    ]
    channels = read(log(tmp_path, texts)).channels
    rudder = channels["RSA/AG:starboard"]
    assert (rudder.unit, rudder.quantity, rudder.positive) == (None, "delta", "starboard")
    assert "relative, no unit: state unit (deg) and check gain" in rudder.description
    assert rudder.y.tolist() == [-3.5]
    assert "RSA/AG:port" not in channels
    got = {name: (c.unit, c.quantity, c.y.tolist()) for name, c in channels.items()}
    assert got["PSXN:roll"] == ("deg", "phi", [-1.47])
    assert got["PSXN:heave"] == ("m", None, [-0.38])
    assert got["RPM/II/S2:speed"] == ("rpm", "n_p", [-80.0])
    assert got["RPM/II/E0:speed"] == ("rpm", None, [900.0])
    assert got["MWV/WI:relative_speed"] == ("m/s", "V_aw", [10.0])
    assert got["MWV/WI:relative_angle"] == ("deg", "gamma_aw", [30.0])


def test_every_unit_can_be_converted():
    from trialid.ingest.nmea0183.nmea0183_instruments import INSTRUMENTS
    from trialid.ingest.nmea0183.nmea0183_transducers import TRANSDUCER_UNITS
    from trialid.ingest.signalk.signalk_deltas import PATHS
    from trialid.names import quantities, units

    fields = [f for layouts in INSTRUMENTS.values() for layout in layouts for f in layout.fields]
    pairs = [(f.unit, f.quantity) for f in fields] + [(u, q) for u, q, _ in PATHS.values()]
    for unit, quantity in pairs:
        if unit is not None and quantity is not None:
            assert units.factor(unit, quantities.SIGNALS[quantity].unit) > 0
    for unit in {*TRANSDUCER_UNITS.values(), *(unit for unit, _ in pairs if unit)}:
        assert units.factor(unit, unit) == pytest.approx(1)


def test_a_unit_that_changes(tmp_path):
    """The speed of the wind in knots, three times in m/s: two channels cannot have one name."""
    texts = [raw("WI", "MWV", ["30", "R", "10", "M" if i < 3 else "N", "A"]) for i in range(20)]
    recording = read(log(tmp_path, texts))
    speed = recording.channels["MWV/WI:relative_speed"]
    assert (len(speed.y), speed.unit) == (17, "kn")
    assert recording.remarks == (
        "MWV/WI:relative_speed: 3 samples in m/s left out, the unit changes",
    )


def test_a_number_that_is_none_is_said(tmp_path):
    texts = [raw("TI", "ROT", ["-4.-3" if i % 2 else "4.3", "A"]) for i in range(20)]
    recording = read(log(tmp_path, texts))
    y = recording.channels["ROT/TI:rate"].y
    np.testing.assert_array_equal(y, np.tile([4.3, np.nan], 10))
    assert recording.remarks == (
        "ROT/TI:rate: 10 of 20 values are no numbers (the first: '-4.-3'); not available",
    )


def test_old_vtg_without_letters_is_no_speed(tmp_path):
    """Before NMEA 0183 2.0: course, course, knots, km/h, with no letters between."""
    recording = read(log(tmp_path, [raw("GP", "VTG", ["90.0", "89.0", "10.0", "18.5"])] * 20))
    assert "VTG/GP:speed" not in recording.channels
    assert "VTG/GP:true_course" not in recording.channels


def test_transducers_behind_a_field_too_many(tmp_path):
    """From a real boat: `C` stands twice, and all that follows is moved."""
    body = "IIXDR,C,C,10.7,C,AIRTEMP,A,0.5,D,HEEL,A,A,-4.-3,D,RUDDER"
    text = f"${body}*{checksum(body)}"
    channels = read(log(tmp_path, [text] * 20)).channels
    assert sorted(channels) == ["XDR/II/AIRTEMP:temperature", "XDR/II/HEEL:angle"]
    assert set(channels["XDR/II/HEEL:angle"].y) == {0.5}


def parsed(texts):
    data = np.frombuffer(("," + ",".join(texts) + ",").encode(), np.uint8)
    comma = np.flatnonzero(data == 44)
    return nmea0183_columns.numbers(data, nmea0183_sentences.Span(comma[:-1] + 1, comma[1:]))


@pytest.mark.parametrize(
    "text", ["-4.-3", "1e5", "nan", "inf", "1_0", "--1", "+", "-", ".", "1.2.3", "0x1", "1 2", "A"]
)
def test_what_is_no_number(text):
    y, bad = parsed([text, "1.5"])
    assert np.isnan(y[0])
    assert bad.tolist() == [True, False]


@settings(max_examples=200, deadline=None, derandomize=True)
@given(
    st.lists(
        st.from_regex(
            r" ?[+-]?([0-9]{1,12}(\.[0-9]{0,8})?|\.[0-9]{1,18}) ?", fullmatch=True
        ).filter(lambda text: text.isascii()),
        min_size=1,
        max_size=20,
    )
)
def test_numbers_are_those_of_python(texts):
    y, bad = parsed(texts)
    assert not bad.any()
    np.testing.assert_array_equal(y, [float(text) for text in texts])


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.binary(max_size=400), st.booleans())
def test_any_bytes_give_only_sound_sentences(noise, checked):
    text = sentence("TI", "ROT", ["1.0", "A"]).encode() + b"\r\n"
    data = np.frombuffer(noise + text, np.uint8)
    block = nmea0183_sentences.sentences(data, checked)
    for a, b in zip(block.body.a, block.body.b, strict=True):
        body = data[a:b].tobytes()
        if checked:
            assert int(data[b + 1 : b + 3].tobytes(), 16) == int(
                checksum(body.decode("latin-1")), 16
            ) or (not body.isascii())


def test_made_by_pynmeagps_itself(tmp_path):
    text = NMEAMessage("TI", "ROT", 0, rot=-3.05, valid="A").serialize().decode().rstrip()
    assert read(log(tmp_path, [text])).channels["ROT/TI:rate"].y.tolist() == [-3.05]
