"""CL text posted for LinuxCNC."""

from pathlib import Path

import pytest

from tests.support.proof import unproven
from trunnion.cli import main

FOOT = "END-OF-PATH\n"


class Post:
    """Posts CL text on the xyzac-trt."""

    def __init__(self, folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
        self._folder, self._capfd = folder, capfd

    def all(self, text: str, *arguments: str) -> tuple[int, list[str], str]:
        """Exit code, lines of the program without block numbers, and stderr."""
        file = self._folder / "part.cls"
        file.write_text(text, encoding="utf-8")
        code = main(["post", str(file), "--machine", "xyzac_trt", "--output", "-", *arguments])
        out, err = self._capfd.readouterr()
        return code, [line.split(" ", 1)[1] for line in out.splitlines()], err.replace(str(file), "part.cls")

    def __call__(self, text: str, *arguments: str) -> list[str]:
        """The lines of a program that was proven without a message on stderr."""
        code, lines, err = self.all(text, *arguments)
        assert (code, unproven(err)) == (0, "")
        return lines


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)
