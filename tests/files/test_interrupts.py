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
    with pytest.raises(KeyboardInterrupt), children_without_interrupts():
        child = subprocess.run([sys.executable, "-S", "-c", ASK], capture_output=True, text=True, check=True)
        assert child.stdout.strip() == "True"
        signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before
    after = subprocess.run([sys.executable, "-S", "-c", ASK], capture_output=True, text=True, check=True)
    assert after.stdout.strip() == "False"
