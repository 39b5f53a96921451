"""Programs for controls other than the Sinumerik, proven, and byte for byte as they were: a change is a change of its
own.
"""

import pytest

from tests.support.golden_controls import CASES
from tests.support.locations import GOLDEN
from tests.support.proof import unproven
from trunnion.cli import main


@pytest.mark.parametrize("name", CASES)
def test_a_program_is_proven_and_the_one_that_it_was(name: str, capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    case = CASES[name]
    machine = str(GOLDEN / case.machine) if case.machine.endswith(".toml") else case.machine
    said = [f"--set={setting}" for setting in case.settings]
    code = main(["post", str(GOLDEN / case.cl), "--machine", machine, "--output", "-", *said])
    out, err = capfdbinary.readouterr()
    left = [line for line in unproven(err.decode()).splitlines() if not case.warned or case.warned not in line]
    assert (code, left) == (0, [])
    assert out == (GOLDEN / name).read_bytes()


def test_every_golden_program_of_these_folders_is_made() -> None:
    folders = [GOLDEN / name for name in ("dmu65", "fanuc", "four_axis", "haas", "linuxcnc", "mikron_600u")]
    there = {f"{folder.name}/{path.name}" for folder in folders for path in folder.glob("*.expected.*")}
    assert there == set(CASES)
