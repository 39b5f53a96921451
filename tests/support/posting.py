"""CL text posted for a Sinumerik."""

from pathlib import Path

import pytest

from tests.support.proof import unproven
from trunnion.cli import main

HEAD = """TOOL PATH/OP1,TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,4000.0000,CLW
RAPID
GOTO/0.0,0.0,50.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
GOTO/10.0,0.0,5.0
"""
FOOT = "END-OF-PATH\n"

#: The beginning of an operation with a tilted tool.
LEANING = HEAD.replace("50.0,0.0,0.0,1.0", "50.0,0.0,0.5,0.8660254").replace("10.0,0.0,5.0", "10.0,0.0,5.0,0.0,0.6,0.8")

#: The beginning of an operation without its cut.
CLEAR = HEAD.replace("FEDRAT/MMPM,500.0\nGOTO/10.0,0.0,5.0\n", "")


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> "Post":
    return Post(tmp_path, capfd)


class Post:
    """Posts CL text on the YL569, or on another machine."""

    def __init__(self, folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
        self._folder, self._capfd = folder, capfd

    def __call__(self, text: str, *arguments: str, machine: str = "yl569") -> list[str]:
        """The lines of the program without block numbers; stderr may hold only passed checks."""
        code, out, err = self.all(text, *arguments, machine=machine)
        assert (code, unproven(err)) == (0, "")
        return out

    def all(self, text: str, *arguments: str, machine: str = "yl569") -> tuple[int, list[str], str]:
        """Exit code, lines of the program without block numbers, and stderr."""
        file = self._folder / "part.cls"
        file.write_text(text, encoding="utf-8")
        code = main(["post", str(file), "--machine", machine, "--output", "-", *arguments])
        out, err = self._capfd.readouterr()
        lines = [line.split(" ", 1)[1] if line.startswith("N") else line for line in out.splitlines()]
        return code, lines, err.replace(str(file), "part.cls")
