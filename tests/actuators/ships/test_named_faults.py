"""Which of several actuators is at fault, and how: on a cargo ship, a ferry and a supply vessel.

The cargo ship's rudders tell themselves apart by the races they stand in. The truths are programmes
of their own (`three_ships.py`); the seeds of the studies were never looked at while building. All
kinds of ships and faults in one table: `fault_table.py`.
"""

from collections.abc import Sequence

import pytest
from faults import DRIVES_KEPT, FAULTS, Fault

OF_THE_CARGO = {f.words: f for f in FAULTS if f.ship.name == "cargo"}
STUCK = {(f.ship.name, f.words): f for f in FAULTS if f.act in DRIVES_KEPT}
OF_OTHERS = [f for f in FAULTS if f.ship.name != "cargo" and f.act not in DRIVES_KEPT]


def counted(fault: Fault, seeds: Sequence[int]) -> tuple[int, list[str]]:
    """How many are named right, and what wrong names are given."""
    right, wrong = 0, []
    for seed in seeds:
        found = fault.verdict(seed)
        if found.effect == fault.wanted(seed):
            right += 1
        elif found.effect is not None:
            wrong.append(f"{seed} {fault.words}: {found.sentence}")
        else:
            print(seed, fault.words, found.sentence)
    return right, wrong


@pytest.mark.study
def test_rudders_exchanged_are_named_where_their_races_differ() -> None:
    found = OF_THE_CARGO["rudders exchanged"].verdict(2203)
    assert found.family == ("rudder_port_rudder_stbd_exchanged",)


@pytest.mark.study(turn=13)
def test_the_only_tunnel_reversed_is_named_although_any_value_does_as_well() -> None:
    """Its gain is its own: what it is reversed by ends anywhere in its range, here at its end."""
    [reverse] = [f for f in OF_OTHERS if f.words == "bow reversed"]
    assert reverse.verdict(50003).family == ("bow_reversed",)


@pytest.mark.study(turn=13)
def test_pods_exchanged_are_named_where_one_misaligned_leaves_little_more() -> None:
    """0.090 of the motion, all of it noise, and 0.101: half of the error is in neither."""
    [exchange] = [f for f in OF_OTHERS if f.words == "pods exchanged"]
    assert exchange.verdict(50013).family == ("pod_3_pod_4_exchanged",)


@pytest.mark.study(turn=10)
def test_a_fault_that_takes_next_to_nothing_off_the_error_has_no_name() -> None:
    """A sound vessel: a weak screw was better in six blocks of six, by 0.01 of 10.7 %."""
    [sound] = [f for f in FAULTS if (f.ship.name, f.words) == ("supply", "nothing")]
    assert sound.verdict(73102).effect is None


@pytest.mark.parametrize(
    ("words", "seeds"),
    [
        pytest.param(
            ("nothing", "rudders exchanged"), range(2240, 2250), marks=pytest.mark.study(turn=10)
        ),
        pytest.param(
            ("screw 20 % weak", "rudder stuck"), range(2220, 2230), marks=pytest.mark.study(turn=14)
        ),
    ],
)
def test_faults_are_named_on_their_side_and_no_other(words, seeds) -> None:
    """Ten records of each; a wrong name in at most 2 of 100, a right one in 95."""
    counts = [counted(OF_THE_CARGO[one], seeds) for one in words]
    right, wrong = sum(n for n, _ in counts), [w for _, many in counts for w in many]
    print(right, wrong)
    assert right >= 0.95 * len(seeds) * len(words)
    assert len(wrong) <= 0.02 * len(seeds) * len(words)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("fault", OF_OTHERS, ids=lambda f: f"{f.ship.name}-{f.words}")
def test_a_fault_of_pods_screws_and_tunnel_is_named(fault: Fault) -> None:
    """One record of each, two or three kinds at a turn: named, or among what is told beside it.

    Of the supply vessel's weak screw the free gains leave 0.0001 of its trace: the fit finds 0.196
    where 0.2 is lost, and the verdict is that it cannot tell, with that screw as what does most.
    """
    found, wanted = fault.verdict(2260), fault.wanted(2260)
    leads = found.kind == "cannot tell" and found.sentence.startswith(f"with {wanted} the error")
    assert leads or wanted in (found.effect, *found.family), found.sentence


@pytest.mark.parametrize(
    ("ship", "words"),
    [
        pytest.param("cargo", "screw stuck", marks=pytest.mark.study(turn=0)),
        pytest.param("ferry", "pod's revolutions stuck", marks=pytest.mark.study(turn=13)),
        pytest.param("supply", "screw stuck", marks=pytest.mark.study(turn=10)),
        pytest.param("supply", "bow stuck", marks=pytest.mark.study(turn=13)),
    ],
)
def test_revolutions_that_do_not_change_are_named_on_their_side(ship: str, words: str) -> None:
    """And a tunnel with a gain of its own, where noise alone leaves 0.32 of what little moves."""
    fault = STUCK[ship, words]
    assert fault.verdict(3004).family == (fault.wanted(3004),)
