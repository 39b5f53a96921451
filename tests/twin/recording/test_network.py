"""``trunnion record`` over a network that is cut: recorder and twin in namespaces of their own, joined by a cable."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import ROOT
from tests.support.twins import BLADE_FINISH, served
from trunnion.arrays import Floats, Ints
from trunnion.cli import main
from trunnion.jobs.twin.serving import add_twin_user
from trunnion.model.recording import Mark, Recording
from trunnion.twin.recording.reading import read_recording

# Recordings that break off and go on have a shorter test: a relay in place of a cable (test_breaks).
pytestmark = [
    pytest.mark.nightly,
    pytest.mark.skipif(
        (shutil.which("ip") is None or os.name == "nt" or os.geteuid() != 0) and not os.environ.get("CI"),
        reason="a network namespace needs ip (Debian package iproute2) and root",
    ),
]

#: Seconds after which nothing more is waited for.
PATIENCE = 300.0

#: Rows that are recorded before the cable is cut, meanwhile, and after it.
ROWS = 150

#: What is compared: what the machine showed at a time.
SHOWN = ("X", "Y", "Z", "B", "C", "spindle", "line")


def ip(*arguments: str) -> None:
    subprocess.run(["ip", *arguments], check=True)


class Network:
    """Two namespaces and a cable between them."""

    def __init__(self) -> None:
        self.twin, self.recorder = (f"trunnion-{os.getpid()}-{side}" for side in ("twin", "recorder"))

    @contextmanager
    def laid(self) -> Iterator["Network"]:
        """Lay the cable until the end of the block."""
        try:
            ip("netns", "add", self.twin)
            ip("netns", "add", self.recorder)
            ip("-n", self.twin, "link", "add", "cable", "type", "veth", "peer", "name", "cable", "netns", self.recorder)
            for side, address in ((self.twin, "10.77.0.1/30"), (self.recorder, "10.77.0.2/30")):
                ip("-n", side, "address", "add", address, "dev", "cable")
                ip("-n", side, "link", "set", "lo", "up")
                ip("-n", side, "link", "set", "cable", "up")
            yield self
        finally:
            for side in (self.twin, self.recorder):
                with suppress(subprocess.CalledProcessError):
                    ip("netns", "delete", side)

    def plug(self, state: str) -> None:
        """Plug the cable in at the twin (up), or pull it out (down)."""
        ip("-n", self.twin, "link", "set", "cable", state)


def within(namespace: str) -> tuple[str, ...]:
    return ("ip", "netns", "exec", namespace)


class Recorder:
    """A recorder of a user in a namespace, and what it has said."""

    def __init__(self, folder: Path, namespace: str, address: str, trust: str) -> None:
        folder.mkdir()
        self.file, self._said = folder / "run.csv", folder / "said.txt"
        command = [*within(namespace), sys.executable, "-m", "trunnion", "record", address, "--output", str(self.file)]
        command += ["--secure", "--trust", trust, "--user", "ada"]
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "src"), "XDG_DATA_HOME": str(folder)}
        with self._said.open("w", encoding="utf-8") as said:
            self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=said, stderr=said, env=environment)
        assert self.process.stdin is not None
        self.process.stdin.write(b"correct horse\n")
        self.process.stdin.close()

    def until(self, reached: Callable[[], bool]) -> None:
        """Wait until something has happened while the recorder records."""
        end = time.monotonic() + PATIENCE
        while not reached():
            said = self._said.read_text(encoding="utf-8")
            assert self.process.poll() is None, said
            assert time.monotonic() < end, said
            time.sleep(0.05)

    def said(self, words: str) -> bool:
        return words in self._said.read_text(encoding="utf-8")

    def rows(self) -> int:
        return self.file.read_bytes().count(b"\n") if self.file.exists() else 0

    def more_rows(self) -> None:
        """Wait until more rows are recorded."""
        wanted = self.rows() + ROWS
        self.until(lambda: self.rows() >= wanted)

    def ended(self) -> Recording:
        """End it as a user does; what it has recorded."""
        self.process.send_signal(signal.SIGINT)
        assert self.process.wait(PATIENCE) == 0
        return read_recording(self.file)

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> tuple[Recording, Recording]:
    """The same run of a machine from beside it, and over a network that was cut meanwhile."""
    folder = tmp_path_factory.mktemp("network")
    users = folder / "users"
    add_twin_user("ada", "correct horse", operator=False, users=users)
    options = ("--host", "0.0.0.0", "--users", str(users), "--no-mtconnect", "--loop", "--speed", "5", "--rate", "50")
    with ExitStack() as ending:
        network = ending.enter_context(Network().laid())
        twin = ending.enter_context(served(BLADE_FINISH, *options, home=folder, within=within(network.twin)))

        def recorder(name: str, namespace: str, host: str) -> Recorder:
            made = Recorder(folder / name, namespace, twin.opcua.replace("0.0.0.0", host), twin.fingerprint)
            ending.callback(made.kill)
            made.until(lambda: made.said("Ctrl-C ends it"))
            return made

        beside = recorder("beside", network.twin, "127.0.0.1")
        far = recorder("far", network.recorder, "10.77.0.1")
        far.more_rows()
        network.plug("down")
        far.until(lambda: far.said("the connection is broken"))
        beside.more_rows()  # the machine goes on, and others see it
        network.plug("up")
        far.until(lambda: far.said("connected again"))
        far.more_rows()
        cut = far.ended()
        assert far.said("1 gap marked")
        beside.more_rows()
        return beside.ended(), cut


def whole(recording: Recording) -> tuple[Ints, Floats]:
    """The rows that show everything, and what they show."""
    shown = np.column_stack([recording.values[name] for name in SHOWN])
    return np.flatnonzero(np.isfinite(shown).all(axis=1)), shown


def test_nothing_is_lost_but_in_the_gap_that_is_marked(recordings: tuple[Recording, Recording]) -> None:
    beside, cut = recordings
    gaps = np.flatnonzero(cut.marked(Mark.GAP))
    assert len(gaps) == 1
    assert not beside.marked(Mark.GAP).any()
    gap = int(gaps[0])
    beside_rows, beside_shown = whole(beside)
    cut_rows, cut_shown = whole(cut)
    stamps = beside.source[beside_rows]
    for part in (cut_rows[cut_rows < gap], cut_rows[cut_rows > gap]):
        assert len(part) >= ROWS // 2
        first, last = int(cut.source[part[0]]), int(cut.source[part[-1]])
        there = beside_rows[(stamps >= first) & (stamps <= last)]
        assert cut.source[part].tolist() == beside.source[there].tolist()
        assert cut_shown[part].tobytes() == beside_shown[there].tobytes()
    missed = (stamps > cut.source[gap - 1]) & (stamps < cut.source[cut_rows[cut_rows > gap][0]])
    assert missed.sum() > ROWS // 2
    elapsed = cut.elapsed()
    assert (np.diff(elapsed) >= 0.0).all()


def test_what_was_recorded_is_still_compared(
    recordings: tuple[Recording, Recording], capsys: pytest.CaptureFixture[str]
) -> None:
    _, cut = recordings
    options = ["--recorded", cut.file, "--recorded-tolerance", "1e-6"]
    assert main(["verify", str(BLADE_FINISH), "--machine", "yl569", *options]) == 0, capsys.readouterr().out
