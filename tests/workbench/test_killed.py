"""Killed at any moment, the workbench loses no edit that it has answered for."""

import contextlib
import http.client
import random
import signal
import threading
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pytest
import quick
from quick import ADDED, OTHER, SPARE, Address

from trialid.pipeline_file import load
from trialid.workflow import history

EFFECTS = (ADDED, OTHER, SPARE)


@dataclass
class Hand:
    """Somebody who adds and drops at random, until nobody answers.

    `held` are the effects after each edit that was answered for; `asked` those of the last one
    that was not, None where there is none.
    """

    address: Address
    chance: random.Random
    held: list[tuple[str, ...]]
    asked: tuple[str, ...] | None = None
    wrong: list[str] = field(default_factory=list)

    def work(self) -> None:
        """Edit until the end."""
        with contextlib.suppress(OSError, http.client.HTTPException):
            while not self.wrong:
                self.one()

    def one(self) -> None:
        now, effect = self.held[-1], self.chance.choice(EFFECTS)
        verb = "drop" if effect in now else "add"
        version = self.address.status()["version"]
        rest = tuple(name for name in now if name != effect)
        self.asked = rest if verb == "drop" else (*now, effect)
        body = {"version": version, "do": verb, "effect": effect}
        answer = self.address.post("/api/edit", body)
        if answer.status == 200:
            self.held.append(self.asked)
        elif answer.status != 409:  # better starts were written between: the version is another
            self.wrong.append(answer.body.decode())
        self.asked = None


def killed(folder: Path, seed: int) -> tuple[int, bool]:
    """Kill a workbench at work; how many edits it had answered for, and whether one was open."""
    chance = random.Random(seed)
    path = quick.write(folder)
    with quick.running(str(path), "--port", "0") as bench:
        hand = Hand(bench.address, chance, [load(path).model.effects])
        thread = threading.Thread(target=hand.work)
        thread.start()
        thread.join(chance.uniform(0.02, 2.0))  # the moment: any is as good as another
        bench.process.send_signal(signal.SIGKILL)
        thread.join(quick.LONGEST)
        assert bench.process.wait(quick.LONGEST) == -signal.SIGKILL
    assert hand.wrong == []
    found = load(path).model.effects
    assert found in (hand.held[-1], hand.asked)
    assert history.read(path)[1] == ""
    works_again(path, found)
    return len(hand.held) - 1, hand.asked is not None


def works_again(path: Path, effects: Sequence[str]) -> None:
    """What is left is a pipeline to go on with, whatever lies beside it."""
    with quick.opened(path) as desk:
        quick.diagnosed(desk)
        assert desk.shown.pipeline.model.effects == effects
        name = next(name for name in EFFECTS if name in desk.shown.catalogue)
        quick.edit(desk, "drop" if name in effects else "add", effect=name)
        quick.diagnosed(desk)
    steps, words = history.read(path)
    assert words == ""
    assert (steps[-1].dropped if name in effects else steps[-1].added) == name


@pytest.mark.study(turn=6)
def test_an_edit_answered_for_is_never_lost(tmp_path: Path) -> None:
    killed(tmp_path, seed=1)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("first", range(100, 120, 4))
def test_twenty_workbenches_killed(tmp_path: Path, first: int) -> None:
    edits, open_ = [], 0
    for seed in range(first, first + 4):
        folder = tmp_path / str(seed)
        folder.mkdir()
        done, unanswered = killed(folder, seed)
        edits.append(done)
        open_ += unanswered
    print(f"\n4 killed after {min(edits)} to {max(edits)} edits, {sum(edits)} in all, none lost; "
          f"{open_} with an edit not answered for")  # fmt: skip
    assert sum(edits) > 4
