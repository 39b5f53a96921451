"""Ctrl-C where it would come at a bad moment."""

import signal
import subprocess
import sys

import pytest

from trunnion.files.interrupts import children_without_interrupts

ASK = "import signal; print(signal.getsignal(signal.SIGINT) == signal.SIG_IGN)"


@pytest.mark.skipif(sys.platform == "win32", reason="only the console knows it there")
def test_children_ignore_ctrl_c_from_their_first_moment_and_this_process_does_not_lose_it() -> None:
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        _interrupted()
    assert signal.getsignal(signal.SIGINT) is before
    assert _child_ignores() == "False"


def _interrupted() -> None:
    with children_without_interrupts():
        assert _child_ignores() == "True"
        signal.raise_signal(signal.SIGINT)


def _child_ignores() -> str:
    return subprocess.run([sys.executable, "-S", "-c", ASK], capture_output=True, text=True, check=True).stdout.strip()
