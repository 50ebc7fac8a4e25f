"""The command: what it prints, where it answers, and how it ends."""

import contextlib
import http.client
import re
import signal
import socket
import time
from pathlib import Path

import pytest
import quick
from click.testing import CliRunner
from quick import ADDED, Address

from trialid.cli import main
from trialid.cli.workbench_command import PORT, TRIED, _family
from trialid.pipeline_file import load


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return quick.write(tmp_path)


def refused(*words: str) -> str:
    """The one line with which the command ends."""
    done = CliRunner().invoke(main.commands, ["workbench", *words], prog_name="trialid")
    assert isinstance(done.exception, SystemExit), repr(done.exception)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith("trialid: ")
    assert done.stderr.count("\n") == 1
    return done.stderr


@pytest.mark.parametrize(("spoil", "words"), [
    (lambda p: p.unlink(), ("no such pipeline",)),
    (lambda p: p.write_text("[model"), ("quick.toml: not TOML",)),
    (lambda p: p.write_text(quick.TEXT.replace("outputs", "outptus")), ("identify.outptus",)),
    (lambda p: p.write_text(quick.TEXT.replace("log.csv", "lg.csv")), ("lg.csv",)),
    (lambda p: p.write_text(quick.TEXT + '[model]\n'), ("not TOML",)),
    (lambda p: (p.unlink(), p.mkdir()), ("quick.toml",)),
])  # fmt: skip
def test_a_wrong_file_is_one_line(path: Path, spoil, words) -> None:
    spoil(path)
    said = refused(str(path))
    assert [word for word in words if word not in said] == [], said


def test_a_port_that_is_taken_is_one_line(path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        said = refused(str(path), "--port", str(port))
    assert f"port {port}" in said
    assert "--port" in said


@pytest.mark.parametrize("host", ["192.0.2.1", "no.such.host.invalid", "::zz", "a b", ""])
def test_an_address_that_is_not_this_machines_is_one_line(path: Path, host: str) -> None:
    said = refused(str(path), "--host", host, "--port", "0")
    assert "--host" in said
    assert "cannot answer on" in said
    assert "choose another --port" not in said


@pytest.mark.parametrize("port", ["-1", "65536", "x"])
def test_a_port_that_is_none(path: Path, port: str) -> None:
    done = CliRunner().invoke(main.commands, ["workbench", str(path), "--port", port])
    assert done.exit_code == 2


@pytest.mark.study(turn=12)
def test_it_says_where_it_is_and_edits_the_file(path: Path) -> None:
    with quick.running(str(path), "--port", "0") as bench:
        port = bench.address.port
        address = rf"Workbench: http://127\.0\.0\.1:{port}/\?token=[\w-]{{32,}}\n"
        assert re.fullmatch(address, bench.said)
        assert Address(port).get("/").status == 401
        assert bench.process.stdout is not None
        assert bench.process.stdout.readline() == (
            f"Every edit is in {path} at once. Ctrl-C ends it.\n"
        )
        answer = bench.address.get("/")
        assert answer.status == 200
        assert "server" not in answer.headers
        assert bench.address.edit("add", effect=ADDED).status == 200
        assert load(path).model.effects[-1] == ADDED
        bench.process.send_signal(signal.SIGINT)  # with a fit under way
        assert bench.ended() == (0, "", "")
    assert load(path).model.effects[-1] == ADDED


@pytest.mark.study(turn=11)
def test_the_next_port_is_taken_where_the_usual_one_is(path: Path) -> None:
    with contextlib.ExitStack() as stack:
        with contextlib.suppress(OSError):  # something else has it: as good
            stack.enter_context(socket.create_server(("127.0.0.1", PORT)))
        bench = stack.enter_context(quick.running(str(path)))
        assert PORT < bench.address.port < PORT + TRIED
        assert bench.address.get("/api/status").status == 200


@pytest.mark.study(turn=13)
def test_ctrl_c_ends_it_with_pages_listening(path: Path) -> None:
    with quick.running(str(path), "--port", "0") as bench, contextlib.ExitStack() as stack:
        for _ in range(3):
            link = http.client.HTTPConnection("127.0.0.1", bench.address.port, timeout=30)
            stack.enter_context(contextlib.closing(link))
            link.request("GET", "/api/events", headers={"Cookie": bench.address.cookie})
            assert link.getresponse().readline().startswith(b"data: ")
        quick.until(lambda: bench.address.status()["working"] is None, "the work to end")
        begin = time.monotonic()
        bench.process.send_signal(signal.SIGINT)
        status, _, complaints = bench.ended()
        assert (status, complaints) == (0, "")
        assert time.monotonic() - begin < 10.0  # the pages would listen for ever
    assert path.read_text(encoding="utf-8") == quick.TEXT


@pytest.mark.study
def test_on_every_address_it_asks_for_a_token(path: Path) -> None:
    with quick.running(str(path), "--host", "0.0.0.0", "--port", "0") as bench:
        found = re.search(r"\?token=([\w-]{32,})\n", bench.said)
        assert found is not None, bench.said
        assert Address(bench.address.port).get("/api/status").status == 401
        cookie = bench.address.cookie
        assert found[1] in cookie
        assert bench.address.get("/api/status").status == 200
    with quick.running(str(path), "--host", "0.0.0.0", "--port", "0") as other:
        assert found[1] not in other.said
        assert other.address.get("/api/status", Cookie=cookie).status == 401


@pytest.mark.study
@pytest.mark.parametrize("host", ["127.0.0.1", "127.0.0.2", "localhost", "::1", "0.0.0.0"])
def test_the_address_it_prints_is_answered(path: Path, host: str) -> None:
    try:
        socket.create_server((host, 0), family=_family(host)).close()
    except OSError:
        pytest.skip("this machine has no such address")
    with quick.running(str(path), "--host", host, "--port", "0") as bench:
        assert bench.address.host == host
        assert bench.address.get("/api/status").status == 200
        assert Address(bench.address.port, host=host).get("/api/status").status == 401
        assert bench.address.edit("add", effect=ADDED).status == 200


@pytest.mark.study
def test_two_at_once_keep_their_own_cookies(path: Path, tmp_path: Path) -> None:
    """A browser sends the cookies of every port of a host."""
    (tmp_path / "second").mkdir()
    second = quick.write(tmp_path / "second")
    with (
        quick.running(str(path), "--port", "0") as one,
        quick.running(str(second), "--port", "0") as other,
    ):
        both = f"{one.address.cookie}; {other.address.cookie}"
        for bench in (one, other):
            assert bench.address.get("/api/status", Cookie=both).status == 200
        assert one.address.get("/api/status", Cookie=other.address.cookie).status == 401
