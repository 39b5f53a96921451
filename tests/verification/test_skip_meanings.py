"""A program with blocks that may be skipped has two meanings, and passes only if both do."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.examples import THIRDS
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


@pytest.mark.third
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


@pytest.mark.third
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


LEVELS = (
    "TOOL PATH/ONE,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\n"
    "RAPID\nGOTO/0,0,50,0,0,1\nFEDRAT/MMPM,500\nGOTO/0,0,5\nRAPID\nGOTO/0,0,30\n"
    "OPSKIP/ON\nGOTO/5,0,6\nSTOP\nSPINDL/RPM,1000,CLW\nGOTO/5,7,6\nRAPID\nGOTO/5,7,25\nOPSKIP/OFF\n"
    "OPSKIP/ON\nRAPID\nGOTO/6,9,25\nGOTO/7,9,6\nGOTO/8,9,6\nOPSKIP/OFF\n"
    "OPSKIP/ON\nGOTO/9,9,6\nSTOP\nSPINDL/RPM,1000,CLW\nGOTO/9,8,6\nOPSKIP/OFF\n"
    "GOTO/9,8,6.5\nRAPID\nGOTO/9,8,30\nRAPID\nGOTO/10,7,30\nGOTO/10,7,6\nGOTO/30,0,6\nRAPID\nGOTO/30,0,50\nEND-OF-PATH\n"
)

#: Controls with several levels of block skip: Klartext has one.
WITH_LEVELS = ["yl569", "matsuura_mx330", "haas_umc750", "xyzac_trt", "hs664rt"]

#: Where the points of each OPSKIP end in X.
ENDS = [5.0, 8.0]


def with_levels(machine: str, folder: Path) -> tuple[Path, list[str]]:
    """A CL file, and the lines of its program, in which each OPSKIP has a level of its own."""
    cl, program = folder / "p.cls", folder / "p.nc"
    cl.write_text(LEVELS, encoding="utf-8")
    trunnion.post(cl, machine=machine, output=program)
    lines = program.read_text(encoding="utf-8").splitlines()
    run = trunnion.read_program(program, machine=machine)
    for event in (each for each in run.events if each.kind == "block_skip"):
        level = 1 + sum(run.tip[event.before_row, 0] > end + 1e-6 for end in ENDS)
        lines[event.line - 1] = f"/{level} {lines[event.line - 1].removeprefix('/')}"
    return cl, lines


def checked(folder: Path, lines: list[str], machine: str, cl: Path) -> trunnion.Verification:
    program = folder / "levels.nc"
    program.write_text("\n".join([*lines, ""]), encoding="utf-8")
    return trunnion.verify(program, machine=machine, cl=cl)


@pytest.mark.parametrize("machine", WITH_LEVELS)
def test_each_level_is_compared_with_the_cl_file_without_its_opskip(machine: str, tmp_path: Path) -> None:
    """What each block states again is needed while the blocks before it are skipped, and only then."""
    cl, lines = with_levels(machine, tmp_path)
    sound = checked(tmp_path, lines, machine, cl)
    assert sound.passed
    assert sound.skip_levels == (frozenset({1}), frozenset({2}), frozenset({3}))
    assert next(check.state for check in sound.checks if check.key == "stops") == "ok"
    mutants = [(1, r" X6\.", r" Z25\S*"), (2, r" X9\.", r" G1\b"), (2, r" X9\.", r" Y9\S*"), (2, r" X9\.", r" Z6\S*")]
    for level, block, word in mutants:
        if (machine, word) == ("hs664rt", r" G1\b"):
            continue  # a Fidia's rapids are lines as well
        at = next(k for k, line in enumerate(lines) if re.search(block, line))
        other = re.sub(word, "", lines[at])
        assert other != lines[at]
        wrong = checked(tmp_path, [*lines[:at], other, *lines[at + 1 :]], machine, cl)
        failed = [each.summary for each in wrong.checks if not each.passed]
        assert failed, other
        assert all(each.startswith(f"with blocks of level {level} skipped (/, first in line ") for each in failed), (
            other
        )


@pytest.mark.parametrize("third", THIRDS)
@pytest.mark.parametrize("machine", WITH_LEVELS)
def test_a_block_that_is_lost_from_any_level_fails(machine: str, third: int, tmp_path: Path) -> None:
    cl, lines = with_levels(machine, tmp_path)
    passed = []
    skipped = [at for at, line in enumerate(lines) if line.startswith("/") and ";" not in line and "(" not in line]
    for at in skipped[third::3]:
        line = lines[at]
        others = [lines[:at] + lines[at + 1 :]]
        for word in (r" M3\b", r" Z30\S*", *([] if machine == "hs664rt" else [r" G1\b"])):
            if re.search(word, line):
                others.append([*lines[:at], re.sub(word, "", line), *lines[at + 1 :]])
        passed += [f"{line} -> {other[at]}" for other in others if checked(tmp_path, other, machine, cl).passed]
    assert not passed


def test_an_opskip_that_is_skipped_in_part_is_not_checked_with_its_levels(tmp_path: Path) -> None:
    cl, lines = with_levels("yl569", tmp_path)
    at = next(k for k, line in enumerate(lines) if line.startswith("/2"))
    mixed = checked(tmp_path, [*lines[:at], "/1" + lines[at][2:], *lines[at + 1 :]], "yl569", cl)
    stops = next(check for check in mixed.checks if check.key == "stops")
    assert stops.state == "not checked"
    told = [str(each) for each in stops.missing]
    assert told[0].startswith("with blocks of level 1 skipped (/, first in line ")
    assert told[0].endswith("not compared with the CL file, for an OPSKIP is skipped only in part")
    assert [each.split(" skipped")[0] for each in told] == [
        f"with blocks of {which}" for which in ("level 1", "level 2", "levels 1 and 3", "levels 2 and 3")
    ]  # with levels 1 and 2 on it is skipped whole


def test_all_combinations_of_three_levels_are_judged_and_not_those_of_four(tmp_path: Path) -> None:
    cl, lines = with_levels("yl569", tmp_path)
    program = tmp_path / "levels.nc"
    checked(tmp_path, lines, "yl569", cl)
    run = trunnion.read_program(program, machine="yl569")
    assert [sorted(each.levels) for each in run.skipped] == [[1, 2, 3], [1], [2], [3], [1, 2], [1, 3], [2, 3]]
    at = max(k for k, line in enumerate(lines) if line.startswith("/3"))
    four = checked(tmp_path, [*lines[:at], "/4" + lines[at][2:], *lines[at + 1 :]], "yl569", cl)
    assert [sorted(each.levels) for each in four.run.skipped] == [[1, 2, 3, 4], [1], [2], [3], [4]]
    stops = next(check for check in four.checks if check.key == "stops")
    assert (
        str(stops.missing[-1])
        == "block skip: compared with all 4 levels on and each alone, not with other combinations"
    )


#: What an OPSKIP may hold: motions, holes, and what stands between motions.
WITHIN = {
    "cuts": "GOTO/5,0,6\nGOTO/5,7,6\n",
    "a cut out and back": "GOTO/5,0,6\nRAPID\nGOTO/0,0,30\n",
    "holes": "CYCLE/DRILL,RAPTO,3,FEDTO,8,MMPM,200,RTRCTO,20\nGOTO/5,5,2\nGOTO/9,5,2\nCYCLE/OFF\nRAPID\nGOTO/9,5,30\n",
    "a dwell": "DELAY/2\n",
    "a stop": "STOP\nSPINDL/RPM,1000,CLW\n",
    "coolant": "COOLNT/FLOOD\n",
    "another speed": "SPINDL/RPM,1500,CLW\n",
}


def with_opskip(within: str) -> str:
    """A CL file in which the operator may skip something."""
    before, behind = CL.split("OPSKIP/ON\n")[0], CL.split("OPSKIP/OFF\n")[1]
    return f"{before}OPSKIP/ON\n{within}OPSKIP/OFF\n{behind}"


#: Each of it on every third machine, and on each machine some of it; nightly has the others.
WITHIN_ON_MACHINES = [
    pytest.param(machine, within, marks=[pytest.mark.nightly] * ((k + other) % 3 > 0))
    for k, within in enumerate(WITHIN)
    for other, machine in enumerate([*MACHINES, "generic_head_head_ca"])
]


@pytest.mark.parametrize(("machine", "within"), WITHIN_ON_MACHINES)
def test_an_opskip_of_which_no_block_may_be_skipped_fails(machine: str, within: str, tmp_path: Path) -> None:
    cl, program = tmp_path / "p.cls", tmp_path / "p.nc"
    cl.write_text(with_opskip(WITHIN[within]), encoding="utf-8")
    trunnion.post(cl, machine=machine, output=program)
    sound = trunnion.verify(program, machine=machine, cl=cl)
    assert sound.passed
    assert "1 OPSKIP" in next(check.summary for check in sound.checks if check.key == "stops")
    lines = program.read_text(encoding="utf-8").splitlines()
    first = min(k for k, line in enumerate(lines) if line.startswith("/"))
    program.write_text("\n".join([*(line.removeprefix("/") for line in lines), ""]), encoding="utf-8")
    lost = trunnion.verify(program, machine=machine, cl=cl)
    assert [check.key for check in lost.checks if not check.passed] == ["stops"]
    place = next(check.places[0] for check in lost.checks if check.key == "stops")
    assert place.text == "the CL file has OPSKIP here, and no block may be skipped (/)"
    assert place.cl_line == cl.read_text(encoding="utf-8").splitlines().index("OPSKIP/ON") + 1
    assert abs(place.nc_line - first - 1) <= 12  # of holes: the block behind them


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
def test_one_of_two_opskip_may_not_be_lost(machine: str, tmp_path: Path) -> None:
    cl, program = tmp_path / "p.cls", tmp_path / "p.nc"
    second = "RAPID\nGOTO/10,7,30\nOPSKIP/ON\nGOTO/20,7,6\nRAPID\nGOTO/20,7,30\nOPSKIP/OFF\nRAPID\nGOTO/30,0,50\n"
    cl.write_text(CL.replace("RAPID\nGOTO/30,0,50\n", second), encoding="utf-8")
    trunnion.post(cl, machine=machine, output=program)
    assert trunnion.verify(program, machine=machine, cl=cl).passed
    lines = program.read_text(encoding="utf-8").splitlines()
    at = [k for k, line in enumerate(lines) if line.startswith("/")]
    split = next(i for i in range(1, len(at)) if any(line.strip() for line in lines[at[i - 1] + 1 : at[i]]))
    for own in (at[:split], at[split:]):
        text = [line.removeprefix("/") if k in own else line for k, line in enumerate(lines)]
        program.write_text("\n".join([*text, ""]), encoding="utf-8")
        lost = trunnion.verify(program, machine=machine, cl=cl)
        stops = next(check for check in lost.checks if check.key == "stops")
        assert [place.text for place in stops.places] == [
            "the CL file has OPSKIP here, and no block may be skipped (/)"
        ]


def test_an_opskip_that_changes_nothing_needs_no_block(tmp_path: Path) -> None:
    cl, program = tmp_path / "p.cls", tmp_path / "p.nc"
    cl.write_text(with_opskip("SPINDL/RPM,1000,CLW\n").replace("GOTO/0,0,5", "COOLNT/FLOOD\nGOTO/0,0,5"))
    trunnion.post(cl, machine="yl569", output=program)
    text = program.read_text(encoding="utf-8")
    program.write_text("\n".join(line.removeprefix("/") for line in text.splitlines()) + "\n", encoding="utf-8")
    assert trunnion.verify(program, machine="yl569", cl=cl).passed


_CUT = (
    "TOOL PATH/ONE,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\n"
    "RAPID\nGOTO/20,-40,40,0,0,1\nRAPID\nGOTO/20,-40,2\nFEDRAT/MMPM,500\nGOTO/20,-40,-5\nGOTO/20,40,-5\n"
)
_UP = "RAPID\nGOTO/20,40,40\n"
_OVER = "RAPID\nGOTO/-30,-30,40\n"
_DOWN = "RAPID\nGOTO/-30,-30,2\nFEDRAT/MMPM,500\nGOTO/-30,-30,-5\n"
_ON = "GOTO/-30,30,-5\nRAPID\nGOTO/-30,30,40\nEND-OF-PATH\n"
_AGAIN = "RAPID\nGOTO/20,40,2\nFEDRAT/MMPM,500\nGOTO/20,40,-5\n"


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(
    ("rest", "said"),
    [
        (f"OPSKIP/ON\n{_UP}OPSKIP/OFF\n{_OVER}{_DOWN}{_ON}", ""),
        (f"OPSKIP/ON\n{_UP}{_OVER}{_DOWN}OPSKIP/OFF\n{_ON}", "goes from line 13 aslant to line 24"),
        (f"OPSKIP/ON\nGOTO/30,40,-5\nOPSKIP/OFF\nRAPID\nGOTO/30,40,40\n{_OVER}{_DOWN}{_ON}", "from line 13 aslant"),
        (f"{_UP}OPSKIP/ON\n{_OVER}{_DOWN}GOTO/-30,9,-5\n{_OVER}OPSKIP/OFF\nRAPID\nGOTO/-30,30,40\nEND-OF-PATH\n", ""),
        (f"OPSKIP/ON\n{_UP}{_AGAIN}OPSKIP/OFF\nGOTO/-30,40,-5\n{_ON}", ""),
    ],
    ids=["a retract", "a link", "a cut", "a pass", "there and back"],
)
def test_a_retract_that_the_cl_file_lets_the_operator_skip_is_judged(
    machine: str, rest: str, said: str, tmp_path: Path
) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(_CUT + rest, encoding="utf-8")
    if not said:
        trunnion.post(cl, machine=machine)
        return
    with pytest.raises(trunnion.TrunnionError, match=said):
        trunnion.post(cl, machine=machine)
