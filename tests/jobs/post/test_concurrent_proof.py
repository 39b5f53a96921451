"""A program is read back while it is written: the proof is that of the bytes on disk, as if it had begun afterwards."""

from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO, cast

import pytest

from tests.support.jobs import post_job
from tests.support.locations import GOLDEN, YL569
from tests.support.run_comparison import facts
from trunnion.cl import read_cl
from trunnion.controls import load_control
from trunnion.files import OutputFiles
from trunnion.jobs.observer import SILENT
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import PostJob
from trunnion.jobs.post.posting import post_toolpaths
from trunnion.jobs.post.result import ProofFailedError
from trunnion.jobs.post.writing import read_back_while_writing, write
from trunnion.jobs.result_output import Target
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.output.program import Program
from trunnion.planning import PlanOptions
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions

CASES = {
    "yl569": YL569 / "2_hub_rough.cls",
    "dmu65": GOLDEN / "dmu65" / "corner.cls",
    "hs664rt": GOLDEN / "hs664rt" / "radial_holes.cls",
    "xyzbc_trt": YL569 / "3_blade_finish.cls",
}


class Spoiled:
    """A sink that replaces one byte of what is written by another."""

    def __init__(self, sink: BinaryIO, old: bytes, new: bytes) -> None:
        self._sink, self._old, self._new = sink, old, new

    def write(self, data: Any) -> int:
        return self._sink.write(bytes(data).replace(self._old, self._new, 1))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._sink, name)


class Full(Spoiled):
    """A sink on a disk that is full."""

    def write(self, data: Any) -> int:
        raise OSError(28, "No space left on device")


def case(name: str) -> tuple[PostJob, Toolpath]:
    """A golden CL file and its machine."""
    machine = load_machine(name)
    return post_job(machine, load_control(machine.control), PlanOptions(), {}), read_cl(CASES[name])


def write_and_run(program: Program, files: OutputFiles) -> Run | None:
    """Write a program and run it meanwhile."""
    with read_back_while_writing(files, program.machine, encoding="utf-8", divided=False) as (progress, run):
        write(program, files.main, progress)
    return run.result()


@pytest.mark.parametrize("name", sorted(CASES))
def test_a_program_that_is_read_while_it_is_written_runs_as_one_that_is_complete(name: str, tmp_path: Path) -> None:
    job, toolpath = case(name)
    program = plan_program([toolpath], replace(job, force=True))[0]
    files = OutputFiles(tmp_path, "program")
    run = write_and_run(program, files)
    files.close()
    meanwhile = files.path.read_bytes()
    with files.path.open("wb") as sink:
        write(program, sink)
    assert meanwhile == files.path.read_bytes()
    assert run is not None
    assert list(facts(run)) == list(facts(run_program(files.path, program.machine, RunOptions(encoding="utf-8"))))


def test_what_is_proven_is_what_is_on_disk(tmp_path: Path) -> None:
    job, toolpath = case("yl569")
    files = OutputFiles(tmp_path, "program")
    files.main = cast("BinaryIO", Spoiled(files.main, b" Y12.98584 ", b" Y12.98684 "))
    with pytest.raises(ProofFailedError, match=r"the program fails its proof: .* \(tip\)") as failed:
        post_toolpaths([toolpath], job, Target(files), SILENT)
    files.close()
    assert [check.key for check in failed.value.result.checks if not check.passed] == ["tip"]


def test_a_program_that_cannot_be_written_to_its_end_does_not_block_its_reader(tmp_path: Path) -> None:
    job, toolpath = case("yl569")
    program = plan_program([toolpath], job)[0]
    files = OutputFiles(tmp_path, "program")
    files.main = cast("BinaryIO", Full(files.main, b"", b""))
    with pytest.raises(OSError, match="No space left"):
        write_and_run(program, files)
    files.close()
