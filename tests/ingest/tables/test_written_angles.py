"""Positions as people write them: degrees, minutes and a side, in the text of a table."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from trialid.ingest import read
from trialid.inspection import inspect_log
from trialid.inspection.positions import position_words, positions

ROWS = 40
T = np.arange(float(ROWS))
LAT, LON = -12.5 + 1e-3 * T, 11.2 - 2e-3 * T


def minutes(angle: float, sides: str) -> str:
    """12°30.0000'S, as a plotter writes it."""
    whole = int(abs(angle))
    return f"{whole}°{60.0 * (abs(angle) - whole):.5f}'{sides[int(angle >= 0.0)]}"


def seconds(angle: float, sides: str) -> str:
    whole = int(abs(angle))
    part = 60.0 * (abs(angle) - whole)
    return f"{sides[int(angle >= 0.0)]} {whole:03d} {int(part):02d} {60.0 * (part % 1.0):.3f}"


def run_together(angle: float, sides: str) -> str:
    whole = int(abs(angle))
    return f"{whole:02d}{60.0 * (abs(angle) - whole):08.5f} {sides[int(angle >= 0.0)]}"


def plain(angle: float, sides: str) -> str:
    return f"{abs(angle):.7f}{sides[int(angle >= 0.0)]}"


def table(file: Path, heads: str, first: list[str], second: list[str]) -> Path:
    rows = [f"{t},{a},{b}" for t, a, b in zip(T, first, second, strict=True)]
    file.write_text("\n".join([f"t [s],{heads}", *rows]) + "\n", encoding="utf-8")
    return file


@pytest.mark.parametrize("form", [minutes, seconds, run_together, plain])
def test_degrees_and_minutes_with_a_side(form, tmp_path: Path) -> None:
    file = table(
        tmp_path / "log.csv",
        "Position 1,Position 2",
        [form(x, "SN") for x in LAT],
        [form(x, "WE") for x in LON],
    )
    lat, lon = (read(file).channels[f"Position {k}"] for k in (1, 2))
    assert (lat.unit, lon.unit) == ("deg", "deg")
    np.testing.assert_allclose(lat.y, LAT, atol=1e-6)
    np.testing.assert_allclose(lon.y, LON, atol=1e-6)
    assert "column 'Position 1': latitude, its degrees and minutes as text" in read(file).remarks
    found = positions(inspect_log(file).channels.values())
    assert {n: one.name for n, one in found.items()} == {"lat": "Position 1", "lon": "Position 2"}


NO_ANGLES = {
    "times": ["12:30", "12:31"],
    "codes": ["E1", "E2"],
    "more than 60 minutes": ["12°61.0'N", "12°10.0'N"],
    "beyond the pole": ["91°0'N", "1°0'N"],
    "two axes": ["12°1'N", "12°1'E"],
    "sides": ["N", "S"],
    "broken degrees and minutes": ["12.5°30'N", "1°1'N"],
}


@pytest.mark.parametrize("cells", NO_ANGLES.values(), ids=NO_ANGLES)
def test_what_is_no_angle_stays_text(cells: list[str], tmp_path: Path) -> None:
    many = [cells[k % 2] for k in range(ROWS)]
    recording = read(table(tmp_path / "log.csv", "a,b", many, [str(x) for x in T]))
    assert [*recording.channels] == ["b"]
    assert "column 'a' holds text, left out" in recording.remarks


HEADS = {
    "Latitude,Longitude": "lat = Latitude, lon = Longitude",
    "GPS_Breite,GPS_Laenge": "lat = GPS_Breite, lon = GPS_Laenge",
    "Northing [m],Easting [m]": "x = Northing, y = Easting",
    "Breite,u": None,
    "lat,heading": None,
}


@pytest.mark.parametrize(("heads", "found"), HEADS.items(), ids=HEADS)
def test_a_position_is_told_where_both_of_it_are(
    heads: str, found: str | None, tmp_path: Path
) -> None:
    file = table(tmp_path / "log.csv", heads, [f"{x:.6f}" for x in LAT], [f"{x:.6f}" for x in LON])
    said = position_words(inspect_log(file).channels.values())
    assert (said == []) if found is None else (f"({found})" in said[0])


def degrees_and_minutes(angle: float) -> str:
    whole = int(abs(angle))
    return f"{whole}{60.0 * (abs(angle) - whole):08.5f}"


@pytest.mark.parametrize("write", [degrees_and_minutes, lambda angle: f"{abs(angle):.7f}"])
@pytest.mark.parametrize(("count", "wanted"), [(40, None), (20_000, ["Latitude", "Longitude"])])
def test_a_side_in_the_next_column_is_the_sign(tmp_path, write, count, wanted) -> None:
    """South and west were north and east, 1230.25 no latitude; a long log is read in parts."""
    t = np.arange(float(count))
    south, west = -12.5 + 1e-5 * t, -7.2 - 2e-5 * t
    rows = [f"{t},{write(a)},S,{write(b)},W" for t, a, b in zip(t, south, west, strict=True)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(["t [s],Latitude,N/S,Longitude,E/W", *rows]) + "\n")
    found = read(path, wanted).channels
    assert [found[n].unit for n in ("Latitude", "Longitude")] == ["deg", "deg"]
    np.testing.assert_allclose(found["Latitude"].y, south, atol=1e-6)
    np.testing.assert_allclose(found["Longitude"].y, west, atol=1e-6)
    pd.read_csv(path).to_parquet(tmp_path / "log.parquet")
    again = read(tmp_path / "log.parquet", wanted).channels
    np.testing.assert_allclose(again["Longitude"].y, west, atol=1e-6)
