"""What can be known of a program without its CL files: faults made by hand, and what is said of each."""

from pathlib import Path

import pytest

import trunnion
from tests.support.faults_without_cl import FAULTS, LAST
from tests.support.two_tools import JOBS
from trunnion.verification import Verification


def _said(found: Verification, sound: Verification) -> str:
    """Return what is said of a changed program that is not said of the sound one, as the table has it."""
    before = {each.key: each.missing for each in sound.checks}
    codes = [each.code for each in found.remarks]
    for each in sound.remarks:
        codes.remove(each.code) if each.code in codes else None
    if failed := [each.key for each in found.checks if not each.passed]:
        return f"fails {failed[0]}"
    if left := [each.key for each in found.checks if each.missing != before[each.key]]:
        return f"open {left[-1]}"
    return f"warns {codes[0]}" if codes else "passes"


@pytest.mark.third
@pytest.mark.parametrize("machine", JOBS)
def test_what_a_program_alone_tells_of_a_fault(machine: str, tmp_path: Path) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(JOBS[machine], encoding="utf-8")
    text = trunnion.post(cl, machine=machine, settings={"part": "PART"}).text or ""
    program.write_text(text, encoding="utf-8")
    sound = trunnion.verify(program, machine=machine)
    assert sound.passed
    other = []
    for _, written, becomes, wanted in (row for row in FAULTS if row[0] == machine):
        at = text.rindex(written) if written in LAST else text.index(written)
        program.write_text(text[:at] + becomes + text[at + len(written) :], encoding="utf-8")
        said = _said(trunnion.verify(program, machine=machine), sound)
        if said != wanted:
            other.append((written, becomes, said, wanted))
    assert other == []
