"""The same positions in every format that has them, by each format's own library where it has one.

NMEA 0183 and Signal K are put together by hand, PX4's ULog from its public description.
"""

import csv
import json
import struct
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import openpyxl
import pyarrow as pa
import pyarrow.parquet as pq
import scipy.io
from mcap.writer import Writer as McapWriter
from numpy.typing import NDArray
from pymavlink.dialects.v20 import all as dialect
from rosbags.rosbag1 import Writer as BagWriter
from rosbags.rosbag2 import Writer as Rosbag2Writer
from rosbags.typesys import Stores, get_typestore

sys.path.insert(0, str(Path(__file__).parents[2] / "ingest"))
import write_can
import write_dataflash
import write_tlog
import write_ulog
from write_nmea0183 import checksum, iso

Stamps = NDArray[np.int64]
Vector = NDArray[np.float64]
FIX = "sensor_msgs/msg/NavSatFix"
CENTIMETRES = 3.0
"""What steps of 1e-7 deg or 1e-5 minutes are, and half of one beside."""


@dataclass(frozen=True)
class Positions:
    """A format with positions: its writer, and the channels that come back."""

    name: str
    write: Callable[[Path, Stamps, Vector, Vector], None]
    lat: str
    lon: str


def minutes(angle: float, digits: int) -> str:
    """dddmm.mmmmm as devices write it."""
    whole, rest = divmod(round(abs(angle) * 60.0, 5), 60.0)
    return f"{int(whole):0{digits}d}{rest:08.5f}"


def sides(lat: float, lon: float) -> tuple[str, ...]:
    """The four fields of a place in NMEA 0183."""
    return minutes(lat, 2), "SN"[int(lat >= 0.0)], minutes(lon, 3), "WE"[int(lon >= 0.0)]


LAYOUTS = {
    "RMC": lambda p: ["101010.00", "A", *p, "7.1", "31.5", "141123", "", "", "A"],
    "GGA": lambda p: ["101010.00", *p, "2", "09", "0.94", "1.0", "M", "2.0", "M", "", ""],
    "GLL": lambda p: [*p, "101010.00", "A", "D"],
    "GNS": lambda p: ["101010.00", *p, "AN", "09", "0.94", "1.0", "2.0", "", ""],
}


def sentence(talker: str, kind: str, fields: list[str]) -> str:
    """One sentence with its checksum."""
    body = ",".join([talker + kind, *fields])
    return f"${body}*{checksum(body)}"


def _sentences(kind: str) -> Positions:
    def write(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
        told = (sentence("GN", kind, LAYOUTS[kind](sides(*p))) for p in zip(lat, lon, strict=True))
        rows = (f"{iso(int(at))} {text}\r\n" for at, text in zip(t, told, strict=True))
        path.write_text("".join(rows), newline="")

    return Positions(f"NMEA 0183 {kind}", write, f"{kind}/GN:latitude", f"{kind}/GN:longitude")


def _tlog(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    log, by = write_tlog.Log(), write_tlog.sender()
    for at, n, e in zip(t.tolist(), lat, lon, strict=True):
        place = {"lat": round(n * 1e7), "lon": round(e * 1e7), "alt": 0}
        boot = (at - int(t[0])) // 1_000_000 + 1000
        whole = {"relative_alt": 0, "vx": 0, "vy": 0, "vz": 0, "hdg": 0}
        log.add(
            at // 1000,
            dialect.MAVLink_global_position_int_message(boot, **place, **whole),
            by,
        )
        raw = {"eph": 90, "epv": 100, "vel": 100, "cog": 100, "satellites_visible": 9}
        log.add(at // 1000, dialect.MAVLink_gps_raw_int_message(boot * 1000, 3, **place, **raw), by)
    path.write_bytes(log.content())


def _dataflash(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    rows = []
    for at, n, e in zip(t.tolist(), lat, lon, strict=True):
        since = (at - int(t[0])) // 1000
        fix = (10**6 + since, 0, 3, 100_000 + since // 1000, 2200, 9, 0.9)
        rows.append(write_dataflash.packed(write_dataflash.GPS, *fix, n, e, *(0, 7, 10, 0, 0)))
    path.write_bytes(write_dataflash.description() + b"".join(rows))


def _rapid(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    places = np.rint(np.column_stack([lat, lon]) * 1e7).astype(int).tolist()
    sent = [(at, 129025, struct.pack("<ii", *p)) for at, p in zip(t.tolist(), places, strict=True)]
    path.write_text("\n".join(write_can.candump_lines(sent, "-l")) + "\n")


def gnss(lat: float, lon: float, method: int = 1) -> bytes:
    """The payload of PGN 129029."""
    head = struct.pack("<BHI", 0, 19_000, 360_000_000)
    place = struct.pack("<qqq", round(lat * 1e16), round(lon * 1e16), 0)
    return head + place + struct.pack("<BBBhh5x", method << 4, 0xFC, 11, 94, 120)


def _gnss(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    sent = [(at, 129029, gnss(n, e)) for at, n, e in zip(t.tolist(), lat, lon, strict=True)]
    path.write_text("\n".join(write_can.canboat_lines(sent)) + "\n")


def _ulog(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    """`lat` and `lon` of SensorGps of PX4 1.14 on, in degrees."""
    layout = "uint64_t timestamp;double latitude_deg;double longitude_deg;uint8_t fix_type;"
    topic = "vehicle_gps_position"
    parts = [
        write_ulog.message("B", bytes(40)),
        write_ulog.message("F", f"{topic}:{layout}".encode()),
        write_ulog.message("A", struct.pack("<BH", 0, 0) + topic.encode()),
    ]
    for at, n, e in zip(t.tolist(), lat, lon, strict=True):
        fields = struct.pack("<HQddB", 0, at // 1000, n, e, 3)
        parts.append(write_ulog.message("D", fields))
    start = struct.pack("<Q", int(t[0]) // 1000)
    path.write_bytes(b"ULog\x01\x12\x35\x01" + start + b"".join(parts))


def _fixes(t: Stamps, lat: Vector, lon: Vector, store, counted: bool):
    """NavSatFix messages of a ROS; that of ROS 1 counts its headers."""
    made = store.types
    for at, n, e in zip(t.tolist(), lat, lon, strict=True):
        stamp = made["builtin_interfaces/msg/Time"](*divmod(at, 10**9))
        head = made["std_msgs/msg/Header"](*((0,) if counted else ()), stamp, "gnss")
        status = made["sensor_msgs/msg/NavSatStatus"](0, 1)
        place = {"latitude": float(n), "longitude": float(e), "altitude": 0.0}
        unknown = {"position_covariance": np.zeros(9), "position_covariance_type": 0}
        yield at, made[FIX](header=head, status=status, **place, **unknown)


def _bag(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    store, there = get_typestore(Stores.ROS1_NOETIC), path.with_suffix(".bag")
    with BagWriter(there) as writer:
        topic = writer.add_connection("/fix", FIX, typestore=store)
        for at, fix in _fixes(t, lat, lon, store, counted=True):
            writer.write(topic, at, bytes(store.serialize_ros1(fix, FIX)))
    there.rename(path)


def _db3(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    store, place = get_typestore(Stores.ROS2_HUMBLE), path.with_suffix(".folder")
    with Rosbag2Writer(place, version=9) as writer:
        topic = writer.add_connection("/fix", FIX, typestore=store)
        for at, fix in _fixes(t, lat, lon, store, counted=False):
            writer.write(topic, at, store.serialize_cdr(fix, FIX))
    next(place.glob("*.db3")).rename(path)


def _mcap(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    store = get_typestore(Stores.ROS2_HUMBLE)
    with path.open("wb") as file:
        writer = McapWriter(file)
        writer.start()
        text, _ = store.generate_msgdef(FIX, ros_version=2)
        topic = writer.register_channel(
            "/fix", "cdr", writer.register_schema(FIX, "ros2msg", text.encode())
        )
        for at, fix in _fixes(t, lat, lon, store, counted=False):
            writer.add_message(topic, at, bytes(store.serialize_cdr(fix, FIX)), at)
        writer.finish()


def _signal_k(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    rows = []
    for at, n, e in zip(t.tolist(), lat, lon, strict=True):
        value = {"latitude": float(n), "longitude": float(e)}
        update = {"$source": "gnss", "values": [{"path": "navigation.position", "value": value}]}
        delta = json.dumps({"context": "vessels.self", "updates": [update]})
        rows.append(f"{at // 1_000_000};I;{delta}\n")
    path.write_text("".join(rows))


def _csv(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["t[s]", "lat[deg]", "lon[deg]"])
        writer.writerows(
            [f"{at / 1e9:.3f}", f"{n:.7f}", f"{e:.7f}"]
            for at, n, e in zip(t, lat, lon, strict=True)
        )


def _excel(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    book = openpyxl.Workbook(write_only=True)
    sheet = book.create_sheet("track")
    sheet.append(["t [s]", "lat [deg]", "lon [deg]"])
    for at, n, e in zip(t.tolist(), lat, lon, strict=True):
        sheet.append([at / 1e9, float(n), float(e)])
    book.save(path)


def _parquet(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    table = {"time": pa.array(t, pa.timestamp("ns", "UTC")), "lat": lat, "lon": lon}
    pq.write_table(pa.table(table), path)


def _matlab(path: Path, t: Stamps, lat: Vector, lon: Vector) -> None:
    with path.open("wb") as file:
        scipy.io.savemat(file, {"t": (t - t[0]) / 1e9, "lat": lat, "lon": lon})


FORMATS = (
    *(_sentences(kind) for kind in LAYOUTS),
    Positions("NMEA 2000 129025", _rapid, "position/11:latitude", "position/11:longitude"),
    Positions("NMEA 2000 129029", _gnss, "gnss/11:latitude", "gnss/11:longitude"),
    Positions("MAVLink", _tlog, "GLOBAL_POSITION_INT/1/1:lat", "GLOBAL_POSITION_INT/1/1:lon"),
    Positions("MAVLink, raw", _tlog, "GPS_RAW_INT/1/1:lat", "GPS_RAW_INT/1/1:lon"),
    Positions("dataflash", _dataflash, "GPS/0:Lat", "GPS/0:Lng"),
    Positions(
        "PX4", _ulog, "vehicle_gps_position:latitude_deg", "vehicle_gps_position:longitude_deg"
    ),
    Positions("rosbag", _bag, "/fix:latitude", "/fix:longitude"),
    Positions("rosbag2", _db3, "/fix:latitude", "/fix:longitude"),
    Positions("MCAP", _mcap, "/fix:latitude", "/fix:longitude"),
    Positions(
        "Signal K",
        _signal_k,
        "navigation.position/gnss:latitude",
        "navigation.position/gnss:longitude",
    ),
    Positions("CSV", _csv, "lat", "lon"),
    Positions("Excel", _excel, "lat", "lon"),
    Positions("Parquet", _parquet, "lat", "lon"),
    Positions("MATLAB", _matlab, "lat", "lon"),
)
