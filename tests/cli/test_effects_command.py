"""What `trialid effects` tells: the list, one line each, and all about one."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from trialid.cli import main


def test_effects_lists_the_catalogue() -> None:
    from trialid.effects import CATALOGUE

    answer = CliRunner().invoke(main.commands, ["effects", "--json"])
    assert answer.exit_code == 0
    told = json.loads(answer.stdout)
    rows = {row["name"]: row for row in told["effects"]}
    assert set(rows) == set(CATALOGUE)
    assert rows["righting_arm_cubic"]["parameters"]["GM3"]["unit"] == "m"
    assert rows["rudder_servo"]["parameters"]["T_delta"]["scan"]
    assert {row["what"] for row in told["left_out"]} >= {"gusts", "bank suction"}
    assert all(row["why"] for row in told["left_out"])


@pytest.mark.parametrize("width", [80, 120])
def test_effects_takes_one_line_each_and_says_what_is_left_out(width: int) -> None:
    from trialid.effects import CATALOGUE
    from trialid.report.terminal.catalogue import WIDE, meaning

    shown = CliRunner().invoke(main.commands, ["effects"], env={"COLUMNS": str(width)})
    lines = shown.stdout.splitlines()
    assert max(map(len, lines)) <= width
    for name, effect in CATALOGUE.items():
        [line] = [x for x in lines if x.startswith(f"{name} ")]
        if width < WIDE:  # a word of what it is, and nothing cut
            assert line.split("  ", 1)[1].strip() == meaning(effect)
        else:
            assert effect.equation[:15] in line
            assert re.search(r" (linear|scanned|no) +\S", line)
    order = [
        lines.index(next(x for x in lines if x.startswith(f"{p}:")))
        for p in ("hull", "rudder", "sensors")
    ]
    assert order == sorted(order)
    assert "Left out, and why:" in lines
    assert "bank suction" in shown.stdout.partition("Left out")[2]


def test_effects_in_a_file_are_not_cut_short() -> None:
    from trialid.effects import CATALOGUE

    command = [sys.executable, "-m", "trialid", "effects"]
    outcome = subprocess.run(
        command, capture_output=True, text=True, check=True, timeout=60, env=without_columns()
    )
    longest = max((e.equation for e in CATALOGUE.values()), key=len)
    assert longest in outcome.stdout


def without_columns() -> dict[str, str]:
    return {n: x for n, x in os.environ.items() if n != "COLUMNS"}


def test_effects_tells_how_one_looks_and_what_it_is_taken_for() -> None:
    shown = CliRunner().invoke(main.commands, ["effects", "gyro_cross_axis"])
    wanted = ["r_measured = r + e_rp p", "source: sensor practice", "needs: p, r"]
    wanted += ["shows as: a line at the roll frequency in r", "-0.2 .. 0.2", "heel_yaw 0.70"]
    for said in (*wanted, "scored: linear"):
        assert said in shown.stdout
    one = CliRunner().invoke(main.commands, ["effects", "gyro_cross_axis", "--json"])
    assert json.loads(one.stdout)["looks_like"]["mixed amplitudes"]["cos"]["heel_yaw"] == 0.7


def test_effects_tells_all_about_one_and_includes_ones_own(tmp_path: Path) -> None:
    shown = CliRunner().invoke(main.commands, ["effects", "rudder_servo"])
    assert "T_delta" in shown.stdout
    assert "adds the states: delta" in shown.stdout
    own = tmp_path / "mine.py"
    own.write_text(
        "from trialid.ship.effect import Force, effect\n"
        '@effect(source="me")\n'
        "def keel(v, *, Ykeel=-0.02):\n"
        '    """Y = Ykeel v."""\n'
        "    return Force(Y=Ykeel * v)\n"
    )
    mine = CliRunner().invoke(main.commands, ["effects", "keel", "--from", str(own)])
    assert "Ykeel" in mine.stdout
    lost = CliRunner().invoke(main.commands, ["effects", "kel", "--from", str(own)])
    assert lost.exit_code == 2
    assert "did you mean 'keel'" in lost.stderr
