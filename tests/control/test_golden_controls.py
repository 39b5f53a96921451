"""Programs for Fanuc and LinuxCNC, proven, and byte for byte as they were: a changed one is a change of its own."""

from dataclasses import dataclass

import pytest

from tests.paths import GOLDEN
from tests.verify.proven import unproven
from trunnion.cli import main


@dataclass(frozen=True)
class Case:
    """What a golden program is made from; the CL file and a machine's file stand in ``GOLDEN``.

    ``warned``: words of every line that is said besides the checks'.
    """

    cl: str
    machine: str
    settings: tuple[str, ...] = ()
    warned: str = ""


_BLADE = "yl569/3_blade_finish.cls"

CASES = {
    "fanuc/flange.expected.nc": Case(
        "fanuc/flange.cls", "matsuura_mx330", ("program=7118", "title=Flange 7-1182 Rev B", "work_offset=G54.1 P3")
    ),
    "fanuc/blade.expected.nc": Case(_BLADE, "matsuura_mx330", ("contour=G05",)),
    "fanuc/blade_by_vectors.expected.nc": Case(_BLADE, "matsuura_mx330", ("orientation=vector",)),
    "fanuc/blade_without_options.expected.nc": Case(
        _BLADE, "fanuc/without_options.toml", ("zero=0,0,120", "tool_length=120", "numbers=off")
    ),
    "linuxcnc/blade.expected.ngc": Case(_BLADE, "xyzac_trt"),
    "linuxcnc/blade_without_tcp.expected.ngc": Case(_BLADE, "xyzac_trt", ("tcp=off", "zero=0,0,0")),
    "linuxcnc/contour.expected.ngc": Case("yl569/1_contour_rough.cls", "xyzac_trt"),
    "linuxcnc/plate.expected.ngc": Case("linuxcnc/plate.cls", "xyzac_trt", ("title=plate",), warned=" made as motion"),
}


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
    folders = [GOLDEN / name for name in ("fanuc", "linuxcnc")]
    there = {f"{folder.name}/{path.name}" for folder in folders for path in folder.glob("*.expected.*")}
    assert there == set(CASES)
