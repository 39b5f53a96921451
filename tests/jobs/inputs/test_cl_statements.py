"""CL statements that the reader does not know become what the machine's definition says.

Without it, what may change the machine is refused, and anything else is left out with a warning.
"""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.cli import main
from trunnion.messages import catalogue

#: One machine of each family of controls.
MACHINES = ("yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt")

#: What moves an axis, changes a tool or switches something, in the words of several CAM systems.
STATEMENTS = (
    "ROTATE/TABLE,AAXIS,90", "ROTABL/ATANGL,90,CLW", "TLAXIS/0,1,0", "AUXFUN/31", "PREFUN/91", "CLAMP/ON",
    "TURRET/3", "HEAD/2", "PIVOTZ/100", "COOLNT/MIST,HIGH", "SPINDL/RPM,800,CLW,RANGE,2",
    "LOAD/TOOL,1,LENGTH,90", "MULTAX/OFF", "OPSKIP/ON,2", "CLRSRF/50", "TOOLNO/3,TURN", "TLCOMP/ON,LEFT",
    "WPLANE/XYPLAN", "MCS/1,0,0,0,0,1,0,-1,0,0,0,0",
)  # fmt: skip

#: Damaged statements: a letter is wrong, missing or too many, a slash or a line end is lost.
DAMAGED = (
    "GOTP/1,2,3", "GTO/1,2,3", "GOTOO/1,2,3", "OGTO/1,2,3", "GOTO1,2,3", "RAPIDGOTO/1,2,3", "SPINDLOFF", "COLNT/ON",
    "G0TO/1,2,3", "M3YS/0,0,0,1,0,0,0,1,0",
)  # fmt: skip

#: Words that nobody knows, and some that are known to say nothing about the machine.
LEFT_OUT = (
    "SEQNO/100", "USER_EVENT/1", "SHOPEV/1,2,3", "FROBNICATE", "PRINT/ON", "TITLES/A", "REWIND/0", "UDE/X", "NOTE/1",
    "PPLOT/ON",
)  # fmt: skip


def part(folder: Path, *statements: str) -> Path:
    file = folder / "part.cls"
    file.write_text(HEAD + "".join(f"{statement}\n" for statement in statements) + "GOTO/10.0,9.0,5.0\n" + FOOT)
    return file


def definition(folder: Path, *entries: str) -> Path:
    file = folder / "own.toml"
    file.write_text("\n".join(['extends = "yl569"', "[control.statements]", *entries, ""]))
    return file


@pytest.mark.parametrize("statement", STATEMENTS)
def test_a_statement_that_moves_or_chooses_something_is_never_dropped(tmp_path: Path, statement: str) -> None:
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(part(tmp_path, statement), machine="yl569")
    (problem,) = caught.value.problems
    assert (problem.file, problem.line) == (str(tmp_path / "part.cls"), 12)
    assert "[control.statements]" in problem.cure


@pytest.mark.parametrize("statement", ["SET/MODE,INCR", "MODE/TURN"])
def test_a_mode_that_changes_the_meaning_of_what_follows_cannot_be_settled_by_a_definition(
    tmp_path: Path, statement: str
) -> None:
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(part(tmp_path, statement), machine="yl569")
    (problem,) = caught.value.problems
    assert problem.line == 12
    assert problem.what.startswith(statement)


def test_what_looks_like_a_damaged_statement_is_refused_too(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(part(tmp_path, *DAMAGED), machine="yl569")
    assert [problem.line for problem in caught.value.problems] == list(range(12, 12 + len(DAMAGED)))
    assert all("may be a damaged" in problem.what for problem in caught.value.problems)


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(
    ("statement", "meant"),
    [
        ("GTO/1,2,3", ["GOTO"]), ("GOTO1,2,3", ["GOTO"]), ("RAPID,GOTO/1,2,3", ["RAPID", "GOTO"]), ("RAPD", ["RAPID"]),
        ("GODLT/1,2,3", ["GODLTA"]), ("GOHOM", ["GOHOME"]), ("CYCL/DRILL", ["CYCLE"]), ("CICLE/1,2,3", ["CIRCLE"]),
    ],
)  # fmt: skip
def test_the_cure_of_a_damaged_motion_is_the_word_that_is_meant(
    tmp_path: Path, statement: str, meant: list[str], machine: str
) -> None:
    """A line that is removed would be missing in the program, and in the CL file that it is compared with."""
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(part(tmp_path, statement), machine=machine)
    (problem,) = caught.value.problems
    assert problem.cure.startswith(f"write {' and '.join(meant)}")
    (remark,) = trunnion.read_cl(part(tmp_path, statement)).remarks
    assert remark.cure == problem.cure


def test_no_cure_of_a_statement_removes_it() -> None:
    for text in catalogue("en", "cl")["CL210"].values():
        assert "remove" not in text["cure"]
        assert "leave" not in text["cure"]
    for code in ("CTL450", "CTL455"):
        assert all("out" not in text["cure"].split() for text in catalogue("en", "controls")[code].values())


def test_a_line_of_numbers_alone_is_refused(tmp_path: Path) -> None:
    for line, said in (("1.0,2.0,3.0", "numbers without a word"), ("/1,2,3", "numbers without a word")):
        with pytest.raises(trunnion.InputError, match=f"12: error: {said}"):
            trunnion.post(part(tmp_path, line), machine="yl569")


def test_a_word_that_nobody_knows_is_left_out_with_a_warning(tmp_path: Path) -> None:
    plain = trunnion.post(part(tmp_path), machine="yl569").text
    cl = part(tmp_path, *LEFT_OUT, "SHOPEV/4")
    result = trunnion.post(cl, machine="yl569")
    assert result.text == plain
    warnings = {problem.line: problem.what for problem in result.problems if "is not known" in problem.what}
    assert sorted(warnings) == list(range(12, 12 + len(LEFT_OUT)))
    assert warnings[14] == "SHOPEV is not known (2 times, first here)"
    found = {unknown.line: (unknown.count, unknown.acts) for unknown in trunnion.describe_cl(cl).unknown}
    assert found == {line: (1 + (line == 14), False) for line in warnings}
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(cl, machine="yl569", strict=True)
    assert len(caught.value.problems) == len(LEFT_OUT) + 1


@pytest.mark.parametrize("machine", MACHINES)
def test_no_control_drops_it(tmp_path: Path, machine: str) -> None:
    with pytest.raises(trunnion.InputError, match=r"12: error: ROTABL is not known \(2 times, first here\)"):
        trunnion.post(part(tmp_path, "ROTABL/ATANGL,90", "ROTABL/ATANGL,0"), machine=machine)
    with pytest.raises(trunnion.InputError, match="ROTABL is not known"):
        trunnion.plan(part(tmp_path, "ROTABL/ATANGL,90"), machine=machine)


def test_a_tool_loaded_inside_an_operation_by_the_older_word_is_refused(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="tool change within an operation"):
        trunnion.post(part(tmp_path, "LOADTL/7"), machine="yl569")


def test_the_definition_says_what_becomes_of_a_statement(tmp_path: Path) -> None:
    cl = part(tmp_path, "SEQNO/100", "AUXFUN/31", "AUXFUN/32", "PPRINT/HERE", "COOLNT/FLOOD,HIGH")
    machine = definition(
        tmp_path, '"SEQNO" = ""', '"AUXFUN/31" = ";CHIP CONVEYOR ON"', '"AUXFUN" = ""', '"COOLNT/HIGH" = ";12 BAR"'
    )
    result = trunnion.post(cl, machine=machine)
    assert result.passed
    assert result.text is not None
    lines = [line.partition(" ")[2] for line in result.text.splitlines()]
    assert lines[lines.index(";CHIP CONVEYOR ON") + 1] == ";HERE"
    assert ";12 BAR" in lines
    assert "M8" in " ".join(lines).split()
    assert not any("not known" in problem.what for problem in result.problems)
    file = tmp_path / "part.mpf"
    file.write_text(result.text)
    assert trunnion.verify(file, machine=machine, cl=cl).passed


def words(folder: Path, *entries: str) -> Path:
    file = folder / "own.toml"
    file.write_text("\n".join(['extends = "yl569"', "[cl.words]", *entries, ""]))
    return file


def test_the_definition_says_which_statement_a_word_is(tmp_path: Path) -> None:
    machine = words(tmp_path, '"SHOPCL/1" = "COOLNT/FLOOD"', '"SHOPCL/0" = ""', '"SHOPTX" = "PPRINT/SHOP TEXT"')
    result = trunnion.post(part(tmp_path, "SHOPCL/0", "SHOPTX/5", "SHOPCL/1"), machine=machine)
    assert result.passed
    assert result.text is not None
    assert ";SHOP TEXT" in result.text
    assert "M8" in result.text.replace("\n", " ").split()
    (left,) = (each for each in trunnion.post(part(tmp_path, "SHOPCL/2"), machine=machine).problems if each.line == 12)
    assert left.what == "SHOPCL is not known"


@pytest.mark.parametrize(
    "statement",
    ["GOTO/1,2,3", "RAPID", "FEDRAT/5", "CYCLE/OFF", "NOWORD/1", "CIRCLE/1", "ROTABL/1", "MSYS/1", "SPINDL/SFM,9"],
)
def test_a_word_can_only_be_an_event(tmp_path: Path, statement: str) -> None:
    with pytest.raises(trunnion.InputError, match=r"own\.toml:3: error: cl\.words\.SHOP "):
        trunnion.post(part(tmp_path), machine=words(tmp_path, f'"SHOP" = "{statement}"'))


def test_words_that_no_entry_names_stay_errors(tmp_path: Path) -> None:
    machine = definition(tmp_path, '"COOLNT/HIGH" = ""', '"CLAMP/ON" = ""')
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(part(tmp_path, "COOLNT/FLOOD,HIGH,SLOW", "CLAMP/OFF", "CLAMP/ON,AAXIS"), machine=machine)
    assert [problem.line for problem in caught.value.problems] == [12, 13]


def test_verify_refuses_and_warns_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "part.mpf"
    text = trunnion.post(part(tmp_path), machine="yl569").text
    assert text is not None
    file.write_text(text)
    with pytest.raises(trunnion.InputError, match="ROTABL is not known"):
        trunnion.verify(file, machine="yl569", cl=part(tmp_path, "ROTABL/ATANGL,90"))
    assert main(["verify", str(file), "--machine", "yl569", "--cl", str(part(tmp_path, "SHOPEV/1"))]) == 0
    assert "part.cls:12: warning: SHOPEV is not known; nothing becomes of it" in capsys.readouterr().err


def test_a_line_of_a_definition_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="line break"):
        trunnion.post(part(tmp_path), machine=definition(tmp_path, '"CLAMP" = "M10\\nM11"'))
