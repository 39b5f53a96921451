"""A program is run while it is being written as it is run afterwards."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.support.locations import YL569
from tests.support.run_comparison import facts
from trunnion.errors import InputError
from trunnion.files import WriteProgress
from trunnion.machines import Machine, load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program

LOOP = b"R1=3\nAGAIN:\nG1 X=R1 F100\n;and again\nR1=R1-1\nIF R1>0 GOTOB AGAIN\nX9\nM30\n"

PROGRAMS = {
    "plain": (YL569 / "2_hub_rough.expected.mpf").read_bytes(),
    "with circles": (YL569 / "1_contour_rough.expected.mpf").read_bytes(),
    "with a jump": LOOP,
    "without an end": LOOP[:-5],
    "with a jump far on": (YL569 / "3_blade_finish.expected.mpf").read_bytes().replace(b"M30", b"") + LOOP,
    "longer than what is read at a time": b"".join(b"N%d G1 X%d Y.5 F%d\n" % (k, k % 7, k) for k in range(20_000)),
    "empty": b"",
}


def written(data: bytes, ends: Sequence[int], file: Path, write_progress: WriteProgress) -> None:
    """Write a file in pieces, and say so."""
    with file.open("wb") as sink:
        for start, end in zip([0, *ends], [*ends, len(data)], strict=True):
            sink.write(data[start:end])
            sink.flush()
            write_progress.advance(end, len(data) // 2)
    write_progress.finish()


def run_beside(data: bytes, ends: Sequence[int], file: Path, machine: Machine) -> Run:
    """The run of a program that somebody writes at the same time."""
    file.write_bytes(b"")
    write_progress = WriteProgress()
    with ThreadPoolExecutor(1) as aside:
        writing = aside.submit(written, data, ends, file, write_progress)
        run = run_program(file, machine, write_progress=write_progress)
        writing.result()
    return run


@given(name=st.sampled_from(sorted(PROGRAMS)), data=st.data())
def test_a_program_that_is_still_written_runs_as_when_it_is_complete(
    name: str, data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    machine, text = load_machine("yl569"), PROGRAMS[name]
    file = tmp_path_factory.getbasetemp() / "growing.mpf"
    ends = sorted(data.draw(st.lists(st.integers(0, len(text)), max_size=8)))
    beside = run_beside(text, ends, file, machine)
    afterwards = run_program(file, machine)
    assert len(beside) == len(afterwards)
    assert list(facts(beside)) == list(facts(afterwards))


def test_what_cannot_be_read_is_said_while_it_is_written(tmp_path: Path, yl569: Machine) -> None:
    text = b"G1 X1 F100\n" * 1000 + b"X" * 400_000 + b"\nM30\n"
    with pytest.raises(InputError, match="is longer than"):
        run_beside(text, [500, 20_000, 300_000], tmp_path / "long.mpf", yl569)


def test_a_jump_waits_for_the_place_that_it_leads_to(tmp_path: Path, yl569: Machine) -> None:
    text = b"G1 X1 F100\nGOTOF THERE\n" + b"X2\n" * 5000 + b"THERE:\nX3\nM30\n"
    run = run_beside(text, [15, 30, 9000], tmp_path / "jump.mpf", yl569)
    assert run.xyz[:, 0].tolist() == [1.0, 3.0]
    assert run.line.tolist() == [1, 5004]
