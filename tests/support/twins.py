"""Twins that run in a process of their own, as a user starts them, and programs in time."""

import os
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.support.locations import ROOT, YL569

HUB_ROUGH = YL569 / "2_hub_rough.expected.mpf"
BLADE_FINISH = YL569 / "3_blade_finish.expected.mpf"


@dataclass(frozen=True)
class ServedTwin:
    """A command ``trunnion twin`` that serves; its addresses, its process, and the fingerprint if it is secured.

    ``agent``: address of its own MTConnect agent; empty: it has none.
    """

    opcua: str
    mtconnect: tuple[str, int]
    fingerprint: str
    process: subprocess.Popen[str]
    agent: str = ""


@contextmanager
def served(program: Path, *options: str, home: Path | None = None, within: Sequence[str] = ()) -> Iterator[ServedTwin]:
    """Serve a program on free ports until the end of the block; ``within``: by the command that runs it elsewhere."""
    command = [*within, sys.executable, "-m", "trunnion", "twin", str(program), "--machine", "yl569", *options]
    for port in {"--port", "--adapter-port"}.difference(options):
        command += [port, "0"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    if home is not None:
        environment |= {"XDG_DATA_HOME": str(home), "LOCALAPPDATA": str(home)}
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment, encoding="utf-8")
    try:
        assert process.stderr is not None
        told = []
        for line in process.stderr:
            told.append(line)
            if "Ctrl-C" in line:
                break
        text = "".join(told)
        opcua = re.search(r"opc\.tcp://\S+", text)
        agents = re.search(r"connects to ([\d.]+):(\d+)", text)
        assert opcua is not None, text
        place = (agents[1], int(agents[2])) if agents else ("", 0)
        certificate = re.search(r"certificate ([0-9A-F]{40})", text)
        documents = re.search(r"(http://\S+)/probe", text)
        agent = documents[1] if documents else ""
        yield ServedTwin(opcua[0], place, certificate[1] if certificate else "", process, agent)
    finally:
        process.terminate()
        process.communicate()
