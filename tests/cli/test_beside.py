"""The proof of a program begins while it is being written: it finds what one afterwards would, on the bytes on disk."""

from pathlib import Path
from typing import Any, BinaryIO, cast

import pytest

from tests.paths import GOLDEN, YL569
from tests.reader.test_growing import facts
from trunnion.cl import read_cl
from trunnion.cli.post import WrittenProgram, plan_program, prove_program, run_while_writing, write_for_proof
from trunnion.controls import load_control
from trunnion.errors import RefusedError
from trunnion.files import OutputFiles
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.output.program import Program
from trunnion.planning import PlanOptions
from trunnion.readers import run_program

CASES = {
    "yl569": YL569 / "2_hub_rough.cls",
    "dmu65": GOLDEN / "dmu65" / "corner.cls",
    "hs664rt": GOLDEN / "hs664rt" / "radial_holes.cls",
    "xyzbc_trt": YL569 / "3_blade_finish.cls",
}


class Spoiled:
    """A sink that lets one byte of what is written become another one."""

    def __init__(self, sink: BinaryIO, old: bytes, new: bytes) -> None:
        self._sink, self._old, self._new = sink, old, new

    def write(self, data: Any) -> int:
        return self._sink.write(bytes(data).replace(self._old, self._new, 1))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._sink, name)


def planned(name: str) -> tuple[Program, PlanOptions, Toolpath]:
    """The program of a case for its machine."""
    machine, toolpath = load_machine(name), read_cl(CASES[name])
    control = load_control(machine.control)
    options = PlanOptions()
    return plan_program([toolpath], machine, control, {}, True, options)[0], options, toolpath


def write_and_run(program: Program, made: OutputFiles, options: PlanOptions) -> tuple[WrittenProgram, Run | None]:
    """As ``trunnion post`` does it."""
    with run_while_writing(made, program.machine, None) as (write_progress, run):
        claim = write_for_proof(program, made.main, options, write_progress)
    return claim, run.result()


@pytest.mark.parametrize("name", sorted(CASES))
def test_beside_and_afterwards_are_one(name: str, tmp_path: Path) -> None:
    program, options, _ = planned(name)
    file = tmp_path / "program"
    made = OutputFiles(tmp_path, file.name)
    claim, run = write_and_run(program, made, options)
    made.close()
    beside = file.read_bytes()
    with file.open("wb") as sink:
        alone = write_for_proof(program, sink, options)
    assert beside == file.read_bytes()
    assert (claim.rows, claim.operations, claim.settings) == (alone.rows, alone.operations, alone.settings)
    assert run is not None
    assert list(facts(run)) == list(facts(run_program(file, program.machine)))


def test_what_is_proven_is_what_is_on_disk(tmp_path: Path) -> None:
    program, options, toolpath = planned("yl569")
    made = OutputFiles(tmp_path, "program")
    made.main = cast("BinaryIO", Spoiled(made.main, b" Y12.98584 ", b" Y12.98684 "))
    claim, run = write_and_run(program, made, options)
    with pytest.raises(RefusedError, match="does not do what this file asks for: tip"):
        prove_program(claim, run, [toolpath], made, "program")
    made.close()


def test_a_program_that_cannot_be_written_to_its_end_is_not_run_on_for_ever(tmp_path: Path) -> None:
    program, options, _ = planned("yl569")

    class Full(Spoiled):
        def write(self, data: Any) -> int:
            raise OSError(28, "No space left on device")

    made = OutputFiles(tmp_path, "program")
    made.main = cast("BinaryIO", Full(made.main, b"", b""))
    with pytest.raises(OSError, match="No space left"):
        write_and_run(program, made, options)
    made.close()
