"""A scheduler and its workers as processes of their own, to be killed and started again."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from generated_fleet import ROOT

distributed = pytest.importorskip("distributed")


@dataclass
class Apart:
    """Processes by name, each with a folder of its own below this one."""

    folder: Path
    address: str = ""
    begun: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)

    def begin(self, kind: str, name: str, options: str) -> None:
        """Start one; what it says goes to its log."""
        place = self.folder / name
        place.mkdir(exist_ok=True)
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "ignore"}
        command = [sys.executable, "-m", f"distributed.cli.dask_{kind}", "--no-dashboard"]
        command += ["--scheduler-file", str(self.folder / "scheduler.json"), *options.split()]
        log = (place / "log").open("ab")
        self.begun[name] = subprocess.Popen(
            command, cwd=place, env=environment, stdout=log, stderr=log
        )

    def begin_all(self, threads: int) -> None:
        """A scheduler and two workers, ready."""
        file = self.folder / "scheduler.json"
        file.unlink(missing_ok=True)  # of one that was killed
        self.begin("scheduler", "scheduler", "--host 127.0.0.1 --port 0")
        for name in ("one", "two"):
            local = self.folder / name
            self.begin("worker", name, f"--nthreads {threads} --local-directory {local}")
        with distributed.Client(scheduler_file=str(file), timeout="30s") as client:
            client.wait_for_workers(2, timeout=60)
            self.address = client.scheduler.address

    def kill(self, name: str) -> None:
        """End one without a word."""
        process = self.begun.pop(name)
        process.kill()
        process.wait(30)

    def end(self) -> None:
        """End all."""
        for process in self.begun.values():
            process.terminate()
        for process in self.begun.values():
            process.wait(30)
        self.begun.clear()


@contextmanager
def processes(folder: Path, threads: int = 1) -> Iterator[Apart]:
    """A scheduler and two workers, each a process with a folder of its own."""
    apart = Apart(folder)
    try:
        apart.begin_all(threads)
        yield apart
    finally:
        apart.end()
