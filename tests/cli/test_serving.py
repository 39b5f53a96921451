"""Pages that commands serve: they open, survive a client that leaves, and end cleanly by Ctrl-C."""

import os
import signal
import socket
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from tests.support.locations import GOLDEN

COMMANDS = {
    "view": ["view", str(GOLDEN / "yl569" / "3_blade_finish.expected.mpf"), "--machine", "yl569"],
    "build": ["build"],
}


@pytest.mark.skipif(os.name == "nt", reason="Ctrl-C is sent to a whole console there")
@pytest.mark.parametrize("name", COMMANDS)
def test_it_serves_until_ctrl_c(name: str, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "trunnion", *COMMANDS[name], "--no-browser"]
    # A shell in the background makes its children ignore Ctrl-C.
    restore = "import signal, sys, runpy; signal.signal(signal.SIGINT, signal.default_int_handler); "
    restore += f"sys.argv = {command[2:]!r}; runpy.run_module('trunnion', run_name='__main__')"
    with subprocess.Popen(
        [sys.executable, "-c", restore], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as served:
        assert served.stdout is not None
        assert served.stderr is not None
        address = served.stdout.readline().strip()
        assert address.startswith("http://127.0.0.1:")
        with urllib.request.urlopen(address, timeout=120) as answer:
            assert b"<title>" in answer.read()
        port = int(address.rsplit(":", 1)[1].rstrip("/"))
        with socket.create_connection(("127.0.0.1", port)) as connection:
            connection.sendall(b"GET / HTTP/1.1\r\n")  # and it goes without a word
        with urllib.request.urlopen(address, timeout=120) as answer:
            assert answer.status == 200
        served.send_signal(signal.SIGINT)
        assert served.wait(30) == 0
        assert "Traceback" not in served.stderr.read()
    assert list(tmp_path.iterdir()) == []
