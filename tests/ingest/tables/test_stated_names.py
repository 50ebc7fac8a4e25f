"""Tables whose names stand behind a comment sign, as numpy saves them, or as Tecplot is told."""

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.ingest import read

ROWS = np.column_stack([0.5 * np.arange(9.0), np.sin(np.arange(9.0)), 10.0 + np.arange(9.0)])
ZONE = 'ZONE T="zig-zag 10/10", I=9, F=POINT\n'


def saved(tmp_path, header, delimiter=" "):
    path = tmp_path / "log.dat"
    with path.open("w") as file:
        file.write(header)
        np.savetxt(file, ROWS, delimiter=delimiter)
    return path


@pytest.mark.parametrize("delimiter", [" ", ",", "\t", ";"])
@pytest.mark.parametrize("names", ["t delta r", "t, delta, r", "t;delta;r"])
def test_what_numpy_saves(tmp_path, delimiter, names):
    path = tmp_path / "log.txt"
    np.savetxt(path, ROWS, delimiter=delimiter, header=names)
    found = read(path).channels
    assert list(found) == ["delta", "r"]
    np.testing.assert_array_equal(found["delta"].t, (1e9 * ROWS[:, 0]).astype(np.int64))
    np.testing.assert_array_equal(found["r"].y, ROWS[:, 2])


@pytest.mark.parametrize(
    "header",
    [
        "% made by MATLAB\n% t[s] delta[deg] r[deg/s]\n",
        "# recorded 2024\n# time delta r\n# s deg deg/s\n",
        "// t [s], delta [deg], r [deg/s]\n",
        'TITLE = "KCS"\nVARIABLES = "t [s]" "delta [deg]" "r [deg/s]"\n' + ZONE,
        'VARIABLES = "t [s]"\n"delta [deg]"\n"r [deg/s]"\n' + ZONE,
        'variables="t [s]", "delta [deg]", "r [deg/s]"\n' + ZONE,
    ],
)
def test_names_come_with_their_units(tmp_path, header):
    found = read(saved(tmp_path, header)).channels
    assert {name: one.unit for name, one in found.items()} == {"delta": "deg", "r": "deg/s"}


def test_tecplot_may_be_told_bare_names(tmp_path):
    path = saved(tmp_path, "VARIABLES = t, delta, r\n" + ZONE)
    assert list(read(path).channels) == ["delta", "r"]


@pytest.mark.parametrize(
    "header",
    ["# t delta\n", "# a delta r\n", "# t delta delta\n", 'VARIABLES = "t" "delta"\n' + ZONE],
)
def test_what_does_not_name_every_column_is_left_to_a_template(tmp_path, header):
    with pytest.raises(LogError, match="is none of the formats"):
        read(saved(tmp_path, header))


def test_a_second_zone_is_no_row(tmp_path):
    path = saved(tmp_path, 'VARIABLES = "t" "delta" "r"\n' + ZONE)
    path.write_text(path.read_text() + ZONE + "0 1 2\n")
    with pytest.raises(LogError, match="line 12"):
        read(path)
