"""The compiled kernel: same numbers as the reference, on any cache, from any process or thread."""

import os
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trialid.effects import CATALOGUE
from trialid.ship.model import STATES, ShipModel
from trialid.ship.particulars import Ship
from trialid.simulation.emit import module_text
from trialid.simulation.integrate import domain, prepare, respond
from trialid.simulation.kernel import Kernel
from trialid.simulation.trace import trace
from trialid.trial import Trial

SHIPS = Path(__file__).parents[2] / "sample_data" / "ships"

SMALL = ("linear_hull", "linear_rudder")
TWINS = {
    "propeller_thrust", "rudder_servo", "rudder_servo_second_order", "rudder_backlash",
}  # fmt: skip
"""Share parameters or states with a twin that stays."""

ELSEWHERE = f"""
import numpy as np
from pathlib import Path
from trialid.effects import CATALOGUE
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.simulation.emit import module_text
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

ship = read_ship(Path({str(SHIPS / "s175q.toml")!r}))
names = ("linear_hull", "linear_rudder", "sway_drag_vav", "linear_roll", "heel_yaw", "bias_r")
model = ShipModel(ship, ("v", "p", "r", "phi"), tuple(CATALOGUE[n] for n in names))
simulator = prepare(model.with_values({{"b_r": 0.0}}), ["Nv", "Yv", "GM", "b_r"], ["r", "phi"])
t = np.arange(200.0)
signals = {{"u": np.full(200, 7.3), "delta": 0.2 * np.sin(0.05 * t)}}
values = {{n: simulator.model.value(n) for n in simulator.equations.free}}
answer = respond(simulator, Trial("zigzag", "fit", 1.0, signals, {{}}), values, {{}})
"""
NUMBERS = ELSEWHERE + "print(answer.y.tobytes().hex() + answer.S.tobytes().hex())"
TEXT = ELSEWHERE + "print(module_text(simulator.equations, True))"


def environment(cache: Path, **more: str) -> dict[str, str]:
    return {**os.environ, "TRIALID_CACHE": str(cache), **more}


def elsewhere(script: str, cache: Path, **more: str) -> str:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", script],
        env=environment(cache, **more), capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert done.returncode == 0, f"exit {done.returncode}: {done.stderr[-500:]}"
    return done.stdout


@pytest.fixture(scope="session")
def known_good(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str, bytes]:
    """The numbers on an empty cache, and the name and bytes of the kernel left in it."""
    cache = tmp_path_factory.mktemp("good")
    numbers = elsewhere(NUMBERS, cache)
    [file] = cache.iterdir()
    return numbers, file.name, file.read_bytes()


@pytest.fixture
def small(s175q: Ship) -> ShipModel:
    return ShipModel(s175q, ("v", "r"), tuple(CATALOGUE[n] for n in SMALL))


def test_the_whole_catalogue_in_one_kernel(s175q: Ship, lively: Callable[..., Trial]) -> None:
    effects = tuple(e for n, e in CATALOGUE.items() if n not in TWINS)
    start = {n: p.start for e in effects for n, p in e.parameters.items()}
    model = ShipModel(s175q, STATES, effects, start)
    free = tuple(n for e in effects for n in e.parameters)
    values, trial = {n: model.value(n) for n in free}, lively(samples=60)
    compiled, plain = (
        respond(prepare(model, free, ("r", "phi", "u"), engine), trial, values, {})
        for engine in ("compiled", "numpy")
    )
    np.testing.assert_allclose(compiled.y, plain.y, rtol=1e-12, atol=1e-15)
    size = np.abs(plain.S).max(axis=0)
    assert np.max(np.abs(compiled.S - plain.S) / np.where(size > 0.0, size, 1.0)) < 1e-12


@pytest.mark.parametrize("gear", ["rudder_servo_second_order", "rudder_backlash"])
def test_other_gears_in_a_kernel(small: ShipModel, lively: Callable[..., Trial], gear: str) -> None:
    values = {n: p.start for n, p in CATALOGUE[gear].parameters.items()}
    model = (small + CATALOGUE[gear]).with_values(values)
    compiled, plain = (
        respond(prepare(model, tuple(values), ("r",), engine), lively(60), values, {})
        for engine in ("compiled", "numpy")
    )
    np.testing.assert_allclose(compiled.y, plain.y, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(compiled.S, plain.S, rtol=1e-11, atol=1e-15)


def test_sim_and_sens_walk_the_same_path(
    everything: ShipModel, lively: Callable[..., Trial]
) -> None:
    simulator = prepare(everything, ("Nr", "m", "GM"), ("r", "phi"), substeps=2)
    values = {n: everything.value(n) for n in simulator.equations.free}
    alone = respond(simulator, lively(60), values, {}, sensitivities=False)
    both = respond(simulator, lively(60), values, {})
    assert alone.S is None
    np.testing.assert_allclose(alone.y, both.y, rtol=1e-13, atol=1e-16)


def test_candidates_at_null_cost_nothing_in_the_answer(
    everything: ShipModel, lively: Callable[..., Trial]
) -> None:
    """A parameter at zero among the free ones leaves the path alone and still has a slope."""
    more = everything + CATALOGUE["yaw_cubic_rrr"]
    more = more.with_values({"Nrrr": 0.0})
    without = respond(prepare(everything, ("Nr",), ("r",)), lively(), {"Nr": -0.0025}, {})
    simulator = prepare(more, ("Nr", "Nrrr"), ("r",))
    with_it = respond(simulator, lively(), {"Nr": -0.0025, "Nrrr": 0.0}, {})
    column = simulator.columns.index("Nrrr")
    np.testing.assert_allclose(with_it.y, without.y, rtol=1e-13)
    assert np.abs(with_it.S[:, 0, column]).max() > 0.0


def test_threads_give_what_one_thread_gives(
    everything: ShipModel, lively: Callable[..., Trial]
) -> None:
    free = ("Nv", "Nr", "Yv", "GM", "m", "x_G")
    simulator = prepare(everything, free, ("r", "phi"))
    values = {n: everything.value(n) for n in free}
    trials = [lively(400, 0.5, seed) for seed in range(12)]

    def run(trial: Trial) -> tuple[bytes, bytes]:
        answer = respond(simulator, trial, values, {})
        return answer.y.tobytes(), answer.S.tobytes()

    serial = [run(t) for t in trials]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(run, trials * 3)) == serial * 3


def test_a_kernel_compiled_by_four_threads_at_once(
    small: ShipModel, lively: Callable[..., Trial]
) -> None:
    simulator = prepare(small, ("Nv", "Nr"), ("r", "v"))
    values = {n: small.value(n) for n in ("Nv", "Nr")}
    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(lambda _: respond(simulator, lively(), values, {}), range(4)))
    assert len({a.S.tobytes() for a in answers}) == 1


def test_the_text_is_the_same_in_every_process(tmp_path: Path) -> None:
    texts = {elsewhere(TEXT, tmp_path, PYTHONHASHSEED=seed) for seed in ("0", "1", "77")}
    assert len(texts) == 1
    assert "define i64 @sens" in texts.pop()


def test_the_text_is_the_same_twice_in_one_process(everything: ShipModel) -> None:
    first, second = (trace(everything, ("Nr", "m"), ("r", "phi")) for _ in range(2))
    assert module_text(first, True) == module_text(second, True)


def test_two_processes_compile_the_same_kernel_at_once(
    tmp_path: Path, known_good: tuple[str, str, bytes]
) -> None:
    both = [
        subprocess.Popen(
            [sys.executable, "-W", "error", "-c", NUMBERS],
            env=environment(tmp_path), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        for _ in range(2)
    ]  # fmt: skip
    answers = [process.communicate(timeout=60) for process in both]
    assert [process.returncode for process in both] == [0, 0], answers
    assert [out for out, _ in answers] == [known_good[0]] * 2
    assert [file.name for file in tmp_path.iterdir()] == [known_good[1]]


def test_a_second_process_finds_the_kernel(
    tmp_path: Path, known_good: tuple[str, str, bytes]
) -> None:
    numbers, name, code = known_good
    (tmp_path / name).write_bytes(code)
    before = (tmp_path / name).stat()
    assert elsewhere(NUMBERS, tmp_path) == numbers
    assert (tmp_path / name).stat().st_mtime_ns == before.st_mtime_ns


def damaged(code: bytes, how: str) -> bytes:
    middle = len(code) // 2
    match how:
        case "empty":
            return b""
        case "cut in half":
            return code[:middle]
        case "not an object":
            return b"not an object file" * 50
        case "zeros":
            return bytes(len(code))
    return code[:middle] + bytes(b ^ 0xFF for b in code[middle : middle + 64]) + code[middle + 64 :]


@pytest.mark.parametrize("how", ["empty", "cut in half", "not an object", "zeros", "flipped"])
def test_a_damaged_cache_file_is_compiled_again(
    how: str, tmp_path: Path, known_good: tuple[str, str, bytes]
) -> None:
    numbers, name, code = known_good
    (tmp_path / name).write_bytes(damaged(code, how))
    assert elsewhere(NUMBERS, tmp_path) == numbers


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no such modes here")
@pytest.mark.parametrize("what", ["file", "folder"])
def test_what_others_may_write_is_not_run(
    what: str, tmp_path: Path, known_good: tuple[str, str, bytes]
) -> None:
    """Code of somebody else's under a checksum that fits: it is compiled again."""
    numbers, name, code = known_good
    path = tmp_path / name
    path.write_bytes(code)
    (path if what == "file" else tmp_path).chmod(0o777)
    before = path.stat()
    assert elsewhere(NUMBERS, tmp_path) == numbers
    assert path.stat().st_mtime_ns != before.st_mtime_ns


def test_a_folder_that_cannot_be_made_is_done_without(
    tmp_path: Path, known_good: tuple[str, str, bytes]
) -> None:
    """A file stands where the folder should be: not even root can write there."""
    (tmp_path / "file").write_text("here", encoding="utf-8")
    assert elsewhere(NUMBERS, tmp_path / "file" / "kernels") == known_good[0]


def test_a_read_only_folder_is_done_without(
    tmp_path: Path, known_good: tuple[str, str, bytes]
) -> None:
    tmp_path.chmod(0o500)
    try:
        assert elsewhere(NUMBERS, tmp_path) == known_good[0]
    finally:
        tmp_path.chmod(0o700)


def arguments(kernel: Kernel, model: ShipModel, samples: int) -> tuple[np.ndarray, ...]:
    theta = np.array([model.value(n) for n in kernel.equations.parameters])
    u = np.column_stack([np.full(samples, 0.1), np.full(samples, 7.3)])
    return theta, np.zeros(2), u, domain(model)


def test_inputs_of_any_layout(small: ShipModel) -> None:
    """A column-wise or single-precision input is copied; the copy must outlive the call."""
    kernel = Kernel(trace(small, ("Nr",), ("r",)))
    theta, x0, u, limit = arguments(kernel, small, 4000)
    plain, _ = kernel.simulate(theta, x0, u, limit, 0.5, 1)
    columns, _ = kernel.simulate(theta, x0, np.asfortranarray(u), limit, 0.5, 1)
    np.testing.assert_array_equal(columns, plain)


def test_one_sample_stays_inside_its_memory(
    small: ShipModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    behind = np.full((8, 2), 77.0)

    def room(x0: np.ndarray, samples: int) -> np.ndarray:
        behind[0] = x0
        return behind[:samples]

    monkeypatch.setattr("trialid.simulation.kernel._room", room)
    kernel = Kernel(trace(small, (), ("r",)))
    theta, x0, u, limit = arguments(kernel, small, 8)
    kernel.simulate(theta, x0, u[:1], limit, 1.0, 1)
    assert np.all(behind[1:] == 77.0)


def test_one_sample_in_the_reference(small: ShipModel) -> None:
    trial = Trial("one", "fit", 1.0, {"u": np.array([7.3]), "delta": np.array([0.1])}, {})
    simulator = prepare(small, ("Nr",), ("r",), "numpy")
    assert respond(simulator, trial, {"Nr": -0.0025}, {"r": 0.01}).y.tolist() == [[0.01]]


def with_row(small: ShipModel, name: str) -> ShipModel:
    return replace(small, effects=(*small.effects, CATALOGUE[name]))


def test_nan_passes_through_a_limit(small: ShipModel) -> None:
    model = with_row(small, "rudder_servo_limited").with_values({"T_servo": 1.0, "rate_max": 0.05})
    order = np.full(6, 0.1)
    order[2] = np.nan
    trial = Trial("hole", "fit", 0.5, {"u": np.full(6, 7.3), "delta_order": order}, {})
    for engine in ("numpy", "compiled"):
        answer = respond(prepare(model, (), ("r",), engine), trial, {}, {}, sensitivities=False)
        assert answer.departure is not None, engine
