"""A pipeline whose whole loop takes half a second, its workbench, and how to wait for it."""

import contextlib
import http.client
import json
import os
import re
import shutil
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import uvicorn

from trialid.result.schema import Result
from trialid.workbench import server
from trialid.workbench.desk import Desk
from trialid.workbench.status import Status
from trialid.workflow import history

ROOT = Path(__file__).parent.parent.parent
SAMPLES = ROOT / "sample_data"
ADDED = "righting_arm_cubic"
"""What the record lacks."""

OTHER = "sway_froude"
SPARE = "roll_rate_yaw"
"""An effect of the model without which it still can be fitted."""

LONGEST = 60.0
"""A machine that needs more for what takes a second here is broken [s]."""

TEXT = """\
# A quick one.
name = "quick"
ship = "s175q.toml"

[[trial]]
name = "early"
logs = ["log.csv"]
window = [0, 600]

[[trial]]
name = "late"
logs = ["log.csv"]
window = [600, 1000]
use = "check"  # held out

[signals]
delta = { channel = "rudder", unit = "deg", positive = "starboard" }
r     = { channel = "rot", unit = "deg/min" }
phi   = { channel = "heel", unit = "deg" }
u     = { channel = "stw", unit = "kn" }

[align]
period = 1.0

[model]
states  = ["v", "p", "r", "phi"]
effects = [
  "linear_hull", "linear_rudder", "linear_roll", "centripetal_added_mass",  # the core
  "heel_roll", "heel_sway", "heel_yaw", "roll_rate_yaw",
  "sway_drag_vav", "sway_drag_var", "yaw_drag_vav", "yaw_drag_var", "yaw_drag_rar",
  "roll_drag_vav", "roll_drag_var",
]

[identify]
free     = ["Yv", "Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM", "Yvav", "Nrar"]
outputs  = ["r", "phi"]
nuisance = ["initial_state", "bias", "rudder_offset", "delay"]

[diagnose]
candidates = ["righting_arm_cubic", "heel_yaw_drift", "sway_froude"]
refit = 1
"""
OWN = """\
from trialid.ship.effect import Force, effect

@effect(source="the mate")
def mine(v, r, *, Nx=-0.001):
    "N = Nx v|v|: what the mate thinks."
    return Force(N=Nx * v * abs(v))
"""


def write(folder: Path, text: str = TEXT) -> Path:
    """Write the pipeline with its ship and log; its path."""
    folder.mkdir(exist_ok=True)
    shutil.copy(SAMPLES / "ships" / "s175q.toml", folder)
    shutil.copy(SAMPLES / "hidden_effect" / "zigzag-15.csv", folder / "log.csv")
    path = folder / "quick.toml"
    path.write_text(text, encoding="utf-8")
    return path


def with_own(folder: Path) -> Path:
    """The pipeline with an effect of the user's own, in the model and free."""
    (folder / "mine.py").write_text(OWN, encoding="utf-8")
    text = TEXT.replace('"roll_drag_var",\n]', '"roll_drag_var", "mine",\n]')
    text = text.replace("\n\n[identify]", '\neffects_from = ["mine.py"]\n\n[identify]')
    return write(folder, text.replace('"Nrar"]', '"Nrar", "Nx"]'))


def until(condition: Callable[[], Any], what: str) -> Any:
    """Wait for a condition; what it gave."""
    end = time.monotonic() + LONGEST
    while time.monotonic() < end:
        if found := condition():
            return found
        time.sleep(0.01)
    raise AssertionError(f"in vain: {what}")


def settled(desk: Desk) -> Status:
    """Wait until nothing is computed any more."""
    return until(lambda: (now := desk.status).working is None and now, "the work to end")


def diagnosed(desk: Desk) -> Status:
    """Wait until the file's model is worked out, and without trouble."""
    status = settled(desk)
    assert (status.stage, status.trouble) == ("diagnosed", None)
    return status


def edit(desk: Desk, do: str, **what: Any) -> None:
    desk.edit({"version": desk.status.version, "do": do, **what})


@contextmanager
def opened(path: Path) -> Iterator[Desk]:
    """A desk, closed in the end, its last computation over."""
    desk = Desk(path)
    try:
        yield desk
    except BaseException:
        desk.close()
        raise
    desk.close()
    with desk._computing:
        pass


@dataclass(frozen=True)
class Answer:
    status: int
    headers: http.client.HTTPMessage
    body: bytes

    @property
    def json(self) -> Any:
        return json.loads(self.body)


@dataclass(frozen=True)
class Address:
    """Where a workbench answers."""

    port: int
    cookie: str = ""
    host: str = "127.0.0.1"

    def ask(
        self,
        method: str,
        path: str,
        body: Any = None,
        headers: dict[str, str] | None = None,
    ) -> Answer:
        """Send a request; a body that is not bytes is sent as JSON."""
        link = http.client.HTTPConnection(self.host, self.port, timeout=LONGEST)
        with contextlib.closing(link):
            if body is not None and not isinstance(body, bytes):
                body = json.dumps(body).encode()
            kind = {} if body is None else {"Content-Type": "application/json"}
            held = {"Cookie": self.cookie} if self.cookie else {}
            link.request(method, path, body, {**held, **kind, **(headers or {})})
            answer = link.getresponse()
            return Answer(answer.status, answer.headers, answer.read())

    def get(self, path: str, **headers: str) -> Answer:
        return self.ask("GET", path, headers=headers)

    def post(self, path: str, body: Any) -> Answer:
        return self.ask("POST", path, body)

    def status(self) -> Any:
        return self.get("/api/status").json

    def edit(self, do: str, **what: Any) -> Answer:
        return self.post("/api/edit", {"version": self.status()["version"], "do": do, **what})

    def raw(self, text: bytes) -> bytes:
        """Everything that comes back for bytes sent as they are, up to the end."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=LONGEST) as link:
            link.sendall(text)
            return b"".join(iter(lambda: link.recv(65536), b""))


@contextmanager
def serving(desk: Desk, token: str | None = None, port: int = 0) -> Iterator[Address]:
    """The workbench's real server, on a free port unless one is given."""
    with socket.create_server(("127.0.0.1", port)) as listening:
        app = server.application(desk, token)
        config = uvicorn.Config(
            app, log_level="warning", lifespan="off", timeout_graceful_shutdown=1
        )
        running = uvicorn.Server(config)
        thread = threading.Thread(target=running.run, args=([listening],), daemon=True)
        thread.start()
        try:
            yield Address(listening.getsockname()[1])
        finally:
            running.should_exit = True
            thread.join(LONGEST)


@dataclass(frozen=True)
class Running:
    """`trialid workbench` in a process of its own, and what it printed first."""

    process: subprocess.Popen[str]
    address: Address
    said: str

    def ended(self) -> tuple[int, str, str]:
        """Wait for its end: its status, the rest of what it printed, and its complaints."""
        out, err = self.process.communicate(timeout=LONGEST)
        return self.process.returncode, out, err


def command(*words: str) -> subprocess.Popen[str]:
    """`trialid workbench` with these words."""
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    return subprocess.Popen(
        [sys.executable, "-u", "-m", "trialid", "workbench", *words],
        env={**os.environ, "PYTHONPATH": path}, text=True,
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip


def greeted(said: str, port: int) -> Address:
    """The printed address, its token changed for the cookie."""
    found = re.search(r"http://(?:\[(\S+)\]|([^:/\s]+)):\d+(/\S*)", said)
    assert found is not None, said
    host = found[1] or found[2]
    answer = Address(port, host=host).get(found[3])
    assert answer.status == 303, (said, answer)
    return Address(port, answer.headers["set-cookie"].partition(";")[0], host)


@contextmanager
def running(*words: str) -> Iterator[Running]:
    """The command once it answers; ended in any case."""
    with command(*words) as process:
        try:
            assert process.stdout is not None
            said = process.stdout.readline()
            found = re.search(r":(\d+)/", said)
            assert found is not None, said + "".join(process.stderr or ())
            yield Running(process, greeted(said, int(found[1])), said)
        finally:
            process.kill()


def result(desk: Desk) -> Result:
    """The result shown, without what stands in it of the model before."""
    shown = desk.shown
    assert shown.run is not None
    return replace(shown.run.result, change=None)


def steps(path: Path) -> list[tuple[str, str | None]]:
    """The history in the file."""
    rows, words = history.read(path)
    assert words == ""
    return [(row.step, row.added or row.dropped) for row in rows]


def still_alone(path: Path) -> bool:
    """Whether nothing but the history was left beside the pipeline."""
    names = {p.name for p in path.parent.iterdir()}
    return names <= {"log.csv", "quick.toml", "s175q.toml", "quick.history.jsonl", "__pycache__"}
