"""Small clusters of Dask on this computer: a scheduler and workers, each a process of its own."""

import os
import socket
import subprocess
import sys
import time
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from types import TracebackType

import pytest

from tests.support.locations import ROOT

HAS_DASK = find_spec("distributed") is not None

#: Tests that need Dask are skipped without it; where CI runs them they fail.
needs_dask = pytest.mark.skipif(
    not HAS_DASK and not os.environ.get("CI"), reason="Dask is not installed (extra cluster)"
)


class Cluster:
    """A scheduler at a port, which can be ended and started again, and workers of one thread with it."""

    def __init__(self, folder: Path, workers: int) -> None:
        self._folder, self._count = folder, workers
        self.port = _free_port()
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.scheduler = self._start_scheduler()
        self._wait_for_scheduler()
        self.workers = [self.start_worker() for _ in range(workers)]

    def __enter__(self) -> "Cluster":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()

    def start_worker(self) -> subprocess.Popen[bytes]:
        """Start a worker; it looks for the scheduler until that is there."""
        return self._start(
            "worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory",
            str(self._folder), "--host", "127.0.0.1",
        )  # fmt: skip

    def kill_worker(self, number: int = 0) -> None:
        """Kill a worker, and start another one."""
        self.workers[number].kill()
        self.workers[number].wait()
        self.workers[number] = self.start_worker()

    def restart_scheduler(self) -> None:
        """Kill the scheduler, start it again at its port, and the workers too: theirs is gone."""
        for process in (self.scheduler, *self.workers):
            process.kill()
            process.wait()
        self.scheduler = self._start_scheduler()
        self.workers = [self.start_worker() for _ in range(self._count)]

    def _start_scheduler(self) -> subprocess.Popen[bytes]:
        return self._start("scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard")

    def _wait_for_scheduler(self) -> None:
        """Wait until it listens: a client that finds none waits for some seconds only, however busy the computer is."""
        while self.scheduler.poll() is None:
            with suppress(OSError), socket.create_connection(("127.0.0.1", self.port)):
                return
            time.sleep(0.05)
        raise AssertionError("the scheduler has ended")

    def _start(self, what: str, *arguments: str) -> subprocess.Popen[bytes]:
        script = f"from distributed.cli.dask_{what} import main; main()"
        command = [sys.executable, "-c", script, *arguments]
        with (self._folder / f"{what}{time.monotonic_ns()}.log").open("wb") as log:
            return subprocess.Popen(command, stdout=log, stderr=log, stdin=subprocess.DEVNULL, cwd=ROOT)


def _free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])
