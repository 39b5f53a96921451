"""A program with blocks that may be skipped has two meanings, and passes only if both do."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS

CASES = TESTS / "data" / "cases"
MACHINES = ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "xyzac_trt", "hs664rt"]


def posted(machine: str, folder: Path) -> Path:
    program = folder / "one.nc"
    trunnion.post(CASES / "contour.cls", machine=machine, output=program)
    return program


def skipping(program: Path, word: str) -> Path:
    """The program with the sign on every block that ends with a word, a pattern."""
    lines = program.read_text(encoding="utf-8").splitlines()
    assert any(re.search(f"{word}$", line) for line in lines)
    other = program.with_name("other.nc")
    text = "\n".join(f"/{line}" if re.search(f"{word}$", line) else line for line in lines)
    other.write_text(text + "\n", encoding="utf-8")
    return other


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("word", [" M9", r" Z\+?2\.?0*( R0)?( FMAX)?"])
def test_a_program_whose_blocks_may_be_skipped_is_another_one(machine: str, word: str, tmp_path: Path) -> None:
    program = posted(machine, tmp_path)
    if (machine, word) == ("hs664rt", " M9"):
        return  # nothing moves behind it
    other = skipping(program, word)
    assert not trunnion.diff(program, other, machine=machine).same
    found = trunnion.diff(other, program, machine=machine)
    assert "with blocks skipped (/, first in line" in str(found.first)
    assert trunnion.diff(other, other, machine=machine).same


def test_the_same_blocks_in_another_form_may_be_skipped(tmp_path: Path) -> None:
    program = skipping(posted("yl569", tmp_path), " M9")
    other = tmp_path / "third.nc"
    text = program.read_text(encoding="utf-8")
    other.write_text(text.replace("/N", "/0 N").replace(" M9", " M09\n/G90"), encoding="utf-8")
    assert trunnion.diff(program, other, machine="yl569").same


def test_what_has_been_read_knows_its_meanings(tmp_path: Path) -> None:
    program = skipping(posted("yl569", tmp_path), " M9")
    run = trunnion.read_program(program, machine="yl569")
    assert [sorted(each.levels) for each in run.skipped] == [[0]]
    assert trunnion.diff(run, run, machine="yl569").same
    assert not trunnion.diff(run, tmp_path / "one.nc", machine="yl569").same


HEAD = "%\nO0001\nG21 G17 G40 G80 G90 G94\nG49 G53 G0 Z0.\nT1 M6\nG54\nS1500 M3\n"
CUTS = "G0 X0. Y0.\nG43 H1 Z50.\n{}G1 Z-1. F200.\nX50.\n{}G0 Z50.\n{}X0.\nM5\nG49 G53 G0 Z0.\nM30\n%\n"


@pytest.mark.parametrize("skipped", [("", "", ""), ("/Z2.\n", "", ""), ("/M8\n", "/M9\n", "")])
def test_a_sound_program_may_skip_blocks(skipped: tuple[str, str, str], tmp_path: Path) -> None:
    program = tmp_path / "p.nc"
    program.write_text(HEAD + CUTS.format(*skipped), encoding="utf-8")
    assert trunnion.verify(program, machine="matsuura_mx330").passed


def test_a_program_that_is_wrong_without_its_blocks_fails(tmp_path: Path) -> None:
    program = tmp_path / "p.nc"
    text = HEAD.replace("S1500 M3", "/S1500 M3") + CUTS.format("", "", "")
    program.write_text(text, encoding="utf-8")
    found = trunnion.verify(program, machine="matsuura_mx330")
    modal = next(check for check in found.checks if check.key == "modal")
    assert not found.passed
    assert modal.summary.startswith("with blocks skipped (/, first in line 7): ")
    assert "spindle off" in modal.summary
    program.write_text(text.replace("/S", "S"), encoding="utf-8")
    assert trunnion.verify(program, machine="matsuura_mx330").passed


def test_each_level_is_a_meaning_of_its_own(tmp_path: Path) -> None:
    program = tmp_path / "p.nc"
    # Both together leave nothing that cuts; the first alone leaves a cut with the spindle off.
    text = HEAD.replace("S1500 M3", "/2S1500 M3") + CUTS.format("", "", "").replace("G1 Z", "/3G1 Z").replace(
        "X50.\n", "/3G1 X50. F200.\n"
    )
    program.write_text(text, encoding="utf-8")
    found = trunnion.verify(program, machine="matsuura_mx330")
    modal = next(check for check in found.checks if check.key == "modal")
    assert modal.summary.startswith("with blocks of level 2 skipped (/, first in line 7): ")


CL = (
    "TOOL PATH/ONE,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\n"
    "RAPID\nGOTO/0,0,50,0,0,1\nFEDRAT/MMPM,500\nGOTO/0,0,5\nRAPID\nGOTO/0,0,30\nOPSKIP/ON\nGOTO/5,0,6\n"
    "GOTO/5,7,6\nOPSKIP/OFF\nGOTO/10,7,6\nRAPID\nGOTO/30,0,50\nEND-OF-PATH\n"
)


@pytest.mark.parametrize("machine", [*MACHINES, "generic_head_head_ca"])
def test_what_a_cl_file_lets_skip_is_sound_when_it_is_skipped(machine: str, tmp_path: Path) -> None:
    """Words that the block behind repeats are needed once the blocks before it are skipped."""
    cl, program = tmp_path / "p.cls", tmp_path / "p.nc"
    cl.write_text(CL, encoding="utf-8")
    trunnion.post(cl, machine=machine, output=program)
    assert trunnion.verify(program, machine=machine, cl=cl).passed
    lines = program.read_text(encoding="utf-8").splitlines()
    behind = max(k for k, line in enumerate(lines) if line.startswith("/")) + 1
    for word, key in ((r" Y\+?7\S*", "tip"), (r" Z\+?6\S*", "tip"), (r" G1\b", "kind")):
        line = re.sub(word, "", lines[behind])
        if line == lines[behind] or (machine == "hs664rt" and key == "kind"):
            continue  # a Klartext line is a line; a Fidia's rapids are lines at a feed, which it says again
        program.write_text("\n".join([*lines[:behind], line, *lines[behind + 1 :], ""]), encoding="utf-8")
        failed = [each for each in trunnion.verify(program, machine=machine, cl=cl).checks if not each.passed]
        assert [each.key for each in failed] == [key], line
        assert failed[0].summary.startswith("with blocks skipped (/, first in line "), line


def test_a_block_of_klartext_is_skipped_with_the_lines_that_go_on(tmp_path: Path) -> None:
    cl, program = tmp_path / "p.cls", tmp_path / "p.h"
    holes = "CYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100\nGOTO/0,0,0\nOPSKIP/ON\nGOTO/9,0,0\nOPSKIP/OFF\nCYCLE/OFF\n"
    begin, _, end = CL.partition("OPSKIP/ON\n")
    cl.write_text(begin + holes + end.partition("OPSKIP/OFF\n")[2], encoding="utf-8")
    trunnion.post(cl, machine="dmu65", output=program)
    run = trunnion.read_program(program, machine="dmu65")
    assert [len(each.run.errors) for each in run.skipped] == [0]
