"""A few blocks for a Haas, as a program that is read."""

from pathlib import Path

import trunnion
from trunnion.model.run import Run

HEAD = "%\nO00001\nG21 G90 G94\nT5 M6\nG54\nS500 M3\nG43 H5 G0 X0. Y0. Z50.\n"


def read(folder: Path, lines: str, machine: str = "haas_umc750") -> Run:
    (folder / "part.nc").write_text(f"{HEAD}{lines}\nM30\n%\n")
    return trunnion.read_program(folder / "part.nc", machine=machine)


def errors(folder: Path, lines: str) -> list[str]:
    return [error.text for error in read(folder, lines).errors]
