"""Faults of one line that once passed without a word: lost, doubled, contradicting and misplaced statements."""

import pytest

from tests.support.apt_heads import HEADS
from tests.support.cl_reading import Body, Fail, Read
from trunnion.cl.unknown import unknown_statement_errors
from trunnion.model.toolpath import CutterComp, CycleOn, SpindleOff, SpindleOn, UnknownStatement

CUT = ["RAPID", "GOTO/0,0,50", "FEDRAT/200,MMPM", "GOTO/0,0,-2"]


UPRIGHT_CUT = ["MULTAX", "RAPID", "GOTO/0,0,50,0,0,1", "FEDRAT/200,MMPM", "GOTO/0,0,-2,0,0,1"]
#: The way home between operations of one tool.
NEXT = {
    "catia": ["$$ OPERATION NAME : B"],
    "ncl": ["$$-> FEATNO / 2"],
    "solidworks": ["GOHOME"],
    "fusion": ["LOADTL/5, 0, 60., 5"],
    "apt": ["GOHOME"],
}


def text(dialect: str, *lines: str) -> str:
    return "\n".join([*HEADS[dialect], *lines, "FINI"]) + "\n"


@pytest.mark.parametrize(
    ("dialect", "cycle", "what"),
    [
        ("ncl", "CYCLE/DRILL,DEPTH,12,CLEAR,3,CLEAR,30", "CLEAR twice"),
        ("ncl", "CYCLE/DRILL,DEPTH,12,CLEAR,3,RETURN,0,RETURN,20", "RETURN twice"),
        ("solidworks", "CYCLE/DEEP,FEDTO,12,RAPTO,3,1STPECK,3,1STPECK,4,SUBPECK,3", "1STPECK twice"),
        ("catia", "CYCLE/REAM,DEPTH,12,CLEAR,3,STEP,3", "CYCLE/REAM has STEP"),
        ("apt", "CYCLE/DRILL,DEPTH,12,CLEAR,3,STEP,3", "CYCLE/DRILL has STEP"),
    ],
)
def test_words_of_a_cycle_that_contradict_are_refused(fails: Fail, dialect: str, cycle: str, what: str) -> None:
    (problem,) = fails(text(dialect, *CUT, cycle))
    assert what in problem.what


@pytest.mark.parametrize(
    ("words", "what"),
    [
        ("RAPTO,3,CLEAR,30,FEDTO,-5", "RAPTO and CLEAR"),
        ("RAPTO,3,FEDTO,-5,RTRCTO,AUTO,RTRCTO,20", "RTRCTO with a height and AUTO"),
    ],
)
def test_heights_of_a_cycle_that_contradict_are_refused(body_fails: Fail, words: str, what: str) -> None:
    (problem,) = body_fails("GOTO/0,0,50", f"CYCLE/DRILL,{words},MMPM,100", "GOTO/1,0,0")
    assert (problem.line, what in problem.what) == (4, True)


@pytest.mark.parametrize(
    ("dialect", "words", "what"),
    [
        ("clsf", "DRILL,RAPTO,2,FEDTO,-30,5", "2 numbers behind FEDTO, -30,5"),
        ("clsf", "DRILL,RAPTO,0,5,FEDTO,-30", "2 numbers behind RAPTO, 0,5"),
        ("clsf", "DRILL,RAPTO,2,FEDTO,-30,RTRCTO,2,5", "2 numbers behind RTRCTO, 2,5"),
        ("clsf", "DRILL,RAPTO,2,FEDTO,-12,20,MMPM,100", "2 numbers behind FEDTO, -12,20"),
        ("clsf", "DRILL,RAPTO,2,FEDTO,-30,DWELL,0,5", "2 numbers behind DWELL, 0,5"),
        ("clsf", "DRILL,RAPTO,2,FEDTO,-30,DWELL,REV,3,5", "2 numbers behind DWELL,REV, 3,5"),
        ("clsf", "DRILL,RAPTO,2,FEDTO,-30,RTRCTO,AUTO,50", "50 behind RTRCTO,AUTO"),
        ("clsf", "DRILL,5,RAPTO,2,FEDTO,-30", "DRILL has numbers without words"),
        ("clsf", "DRILL,CSINK,CSKDIA,12,5,TLANGL,90,RAPTO,2", "2 numbers behind CSKDIA, 12,5"),
        ("clsf", "BORE,NODRAG,90,5,RAPTO,2,FEDTO,-9", "CYCLE NODRAG has 2 numbers"),
        ("clsf", "DRILL,DEEP,STEP,3,3,1,.5,RAPTO,2,FEDTO,-9", "4 numbers behind STEP, 3,3,1,0.5"),
        ("clsf", "DRILL,DEEP,STEP,2,5,RAPTO,2,FEDTO,-9", "pecks that cannot be: STEP,2,5"),
        ("clsf", "DRILL,RAPTO,2,FEDTO,-10,AUTO,MMPM,100", "AUTO, which belongs behind RTRCTO"),
        ("clsf", "DRILL,RAPTO,2,FEDTO,-10,MANUAL,MMPM,100", "MANUAL, which belongs behind RTRCTO"),
        ("clsf", "DRILL,RAPTO,2,FEDTO,-10,REV,DWELL,3", "REV, which belongs behind DWELL"),
        ("clsf", "DRILL,CSKDIA,12,RAPTO,2,FEDTO,-10", "CYCLE/DRILL has CSKDIA"),
        ("clsf", "DRILL,OPTION,RAPTO,2,FEDTO,-10", "CYCLE/DRILL has OPTION"),
        ("ncl", "DRILL,DEPTH,12,5,CLEAR,3", "2 numbers behind DEPTH, 12,5"),
        ("ncl", "DRILL,DEPTH,12,CLEAR,3,RETURN,2,5", "2 numbers behind RETURN, 2,5"),
        ("catia", "DRILL,DEPTH,12,CLEAR,0,5", "2 numbers behind CLEAR, 0,5"),
        ("solidworks", "DRILL,FEDTO,12,RAPTO,0,5", "2 numbers behind RAPTO, 0,5"),
        ("solidworks", "DEEP,FEDTO,12,RAPTO,3,1STPECK,3,5,SUBPECK,3", "2 numbers behind 1STPECK, 3,5"),
        ("apt", "DRILL,DEPTH,12,CLEAR,3,DWELL,0,5", "2 numbers behind DWELL, 0,5"),
    ],
)
def test_each_number_of_a_cycle_belongs_to_a_word(
    fails: Fail, body_fails: Fail, dialect: str, words: str, what: str
) -> None:
    cycle = f"CYCLE/{words}"
    (problem,) = body_fails("GOTO/0,0,50", cycle) if dialect == "clsf" else fails(text(dialect, *CUT, cycle))
    assert what in problem.what


def test_revolutions_of_a_dwell_stand_on_either_side(body: Body) -> None:
    for dwell in ("DWELL,REV,3", "DWELL,3,REV"):
        cycle = body("GOTO/0,0,50", f"CYCLE/DRILL,RAPTO,3,FEDTO,-5,{dwell}", "GOTO/1,0,0").events[0]
        assert isinstance(cycle, CycleOn)
        assert (dict(cycle.values)["DWELL"], dict(cycle.words)["DWELL"]) == ((3,), "REV")


def test_the_end_of_a_cycle_that_never_began_is_told(read: Read) -> None:
    toolpath = read(text("apt", *CUT, "GOTO/9,0,0", "CYCLE/OFF"))
    assert any("CYCLE/OFF where no cycle is on" in problem.what for problem in toolpath.remarks)
    assert read(text("apt", "CYCLE/OFF", *CUT)).remarks == ()


def test_an_operation_without_msys_among_others_that_have_one_is_refused(read: Read, fails: Fail) -> None:
    operation = "TOOL PATH/{},TOOL,T\n{}GOTO/0,0,9\nEND-OF-PATH\n"
    msys = "MSYS/{},0,0,1,0,0,0,1,0\n"
    assert len(read(operation.format("A", msys.format(0)) + operation.format("B", "")).operations) == 2
    (problem,) = fails(operation.format("A", msys.format(100)) + operation.format("B", ""))
    assert (problem.line, problem.what[:29]) == (5, "operation B has no MSYS, and ")


def test_a_from_in_the_midst_is_where_the_tool_is(body: Body, body_fails: Fail, fails: Fail) -> None:
    assert len(body("GOTO/0,0,9", "FROM/0,0,9.001", "GOTO/1,0,9").moves) == 2
    (problem,) = body_fails("GOTO/0,0,9", "FROM/0,0,90", "GOTO/1,0,9")
    assert (problem.line, "FROM is another point" in problem.what) == (4, True)
    assert "FROM is another point" in fails(text("apt", *CUT, "FROM/0,0,90", "GOTO/1,0,-2"))[0].what


def test_tolerances_that_no_operation_has_are_told(body_fails: Fail, read: Read) -> None:
    (problem,) = body_fails("INTOL/-0.01", "GOTO/0,0,9")
    assert (problem.line, problem.what) == (3, "INTOL is negative: -0.01")
    assert "OUTTOL is 10" in read(text("ncl", "OUTTOL/10", *CUT)).remarks[0].what


def test_motion_behind_an_end_with_an_end_of_its_own_is_told(read: Read) -> None:
    toolpath = read(text("apt", *CUT, "FINI", "GOTO/9,0,-2"))
    assert ["behind an end of the file" in problem.what for problem in toolpath.remarks] == [True]
    assert read(text("apt", *CUT, "END", "FINI")).remarks == ()


def test_a_system_that_is_none_is_refused(fails: Fail) -> None:
    (problem,) = fails(text("solidworks", "CSYS/1,0,0,0,0,2,0,0,0,0,1,0", *CUT))
    assert "columns of CSYS" in problem.what


ON = ["CUTCOM/LEFT", "GOTO/40,0,-2"]


@pytest.mark.parametrize("dialect", ["catia", "ncl", "solidworks", "fusion", "apt"])
def test_compensation_on_where_another_operation_of_the_tool_cuts_is_refused(fails: Fail, dialect: str) -> None:
    (problem,) = fails(text(dialect, *CUT, *ON, *NEXT[dialect], *CUT, "CUTCOM/OFF", *NEXT[dialect], *CUT))
    line = len(HEADS[dialect]) + 5
    assert f"cuts without CUTCOM, and that of line {line} (LEFT) is still on" in problem.what
    assert problem.line > line


def test_compensation_on_where_the_axis_system_changes_is_refused(fails: Fail) -> None:
    systems = [["$$*CATIA0", "$$ A", f"$$ 1 0 0 {x}", "$$ 0 1 0 0", "$$ 0 0 1 0"] for x in (0, 9)]
    lines = [*systems[0], *UPRIGHT_CUT, "CUTCOM/LEFT", "GOTO/40,0,-2,0,0,1", *systems[1], *UPRIGHT_CUT]
    (problem,) = fails(text("catia", *lines))
    assert "cuts without CUTCOM" in problem.what


def test_compensation_that_nothing_cuts_with_is_no_error(read: Read) -> None:
    name = "$$ OPERATION NAME : B"
    own = [name, "RAPID", "GOTO/0,0,50", *ON]
    assert len(read(text("catia", *CUT, *ON, *own)).operations) == 2
    again = ["CUTCOM/OFF", name, *CUT, *ON, "CUTCOM/OFF"]
    assert len(read(text("catia", *CUT, *ON, *again)).operations) == 2
    (joined,) = read(text("catia", *CUT, *ON, name, "GOTO/50,0,-2", "CUTCOM/OFF")).operations
    assert [event.side for event in joined.events if isinstance(event, CutterComp)] == ["LEFT", "OFF"]
    tools = [*CUT, *ON, "TPRINT/T6", "LOADTL/6", *CUT, name, *CUT]
    (problem,) = read(text("catia", *tools)).remarks
    assert "that of line 10 (LEFT) is still on: with another tool it ends" in problem.what


def test_an_operation_whose_coolant_ended_is_told(read: Read) -> None:
    lines = ["COOLNT/FLOOD", *CUT, "$$ OPERATION NAME : B", *CUT]
    (problem,) = read(text("catia", *lines)).remarks
    assert (problem.line, "operation B has no COOLNT" in problem.what) == (11, True)
    assert read(text("catia", *lines, "COOLNT/MIST")).remarks == ()
    assert read(text("catia", *lines[:-5], "COOLNT/OFF", *lines[-5:])).remarks == ()


def test_a_tool_that_cuts_with_the_feed_of_another_is_told(read: Read) -> None:
    for dialect in ("catia", "ncl", "apt"):
        begin, cut = ["LOADTL/6"], ["RAPID", "GOTO/9,0,50", "GOTO/9,0,-2"]
        (problem,) = (p for p in read(text(dialect, *CUT, *begin, *cut)).remarks if "feed" in p.what)
        line = len(HEADS[dialect]) + len(CUT) + 1
        assert (problem.line, problem.what.partition("loads ")[2]) == (line, "tool 6, and cuts with the feed of tool 5")
        own = [*CUT, *begin, *cut[:2], "FEDRAT/90,MMPM", cut[2]]
        drilled = [*CUT, *begin, *cut[:2], "CYCLE/DRILL,DEPTH,5,MMPM,90,CLEAR,2", cut[2], "CYCLE/OFF"]
        for lines in (own, drilled):
            assert not [p for p in read(text(dialect, *lines)).remarks if "feed" in p.what]


@pytest.mark.parametrize(
    ("dialect", "line", "what"),
    [
        ("catia", "INDIRV/1,0,0\nTLON,GOFWD/(CIRCLE/0,10,-2,10),ON,(LINE/0,10,-2,0,20,-3)", "ends off the plane"),
        ("apt", "CUTTER/12,5,1,1,0,0,80", "would reach below its tip"),
        ("apt", "CUTTER/12,1,5,0,1,0,80", "would reach below its tip"),
        ("apt", "LOADTL/6,LENGTH,90.5,LENGTH,80", "LENGTH twice"),
        ("apt", "LOADTL/6,OSETNO,3,OFFSET,4", "contradict each other"),
        ("apt", "SELCTL/5,7", "2 numbers"),
        ("apt", "UNITS/MM,INCHES", "UNITS/MM,INCHES is not a known unit"),
        ("apt", "COOLNT/", "COOLNT/ without a word"),
        ("apt", "SPINDL/", "SPINDL without a speed or a word"),
        ("apt", "IF(1)L1,L2,L3", "IF is a statement of an APT part program"),
        ("catia", "INCLUD/OTHER", "INCLUD is a statement of an APT part program"),
        ("apt", "UNDEF", "UNDEF is a statement of an APT part program"),
        ("ncl", "$$ -> CSYS / 1,0,0,0,0,0,-1,0,0,1,0,0", "changes within the file"),
        ("apt", "CYCLE/DRILL" + "," * 900_000, "900001 values"),
        ("clsf", "CYCLE/DRILL" + ",A" * 100, "101 values"),
    ],
    ids=lambda value: str(value)[:30],
)
def test_more_that_was_lost_or_taken_wrong_is_refused(
    fails: Fail, body_fails: Fail, dialect: str, line: str, what: str
) -> None:
    if dialect == "clsf":
        problems = body_fails("GOTO/0,0,50", line)
    else:
        start = ["$$-> CSYS / 1,0,0,0,0,1,0,0,0,0,1,0"] * (dialect == "ncl")
        problems = fails(text(dialect, *start, *CUT, *line.split("\n"), "RAPID", "GOTO/0,0,50"))
    assert any(what in problem.what for problem in problems)


def test_creo_s_commands_may_have_blanks_before_their_arrow(read: Read) -> None:
    (operation,) = read(
        text("ncl", "$$  -> CUTTER / 8", "$$ -> FEATNO / 7", *CUT).replace("$$-> CUTTER / 10.0\n", "")
    ).operations
    assert (operation.name, operation.tool.diameter) == ("FEATNO 7", 8)


def test_a_number_goes_with_the_unknown_word_before_it(body: Body) -> None:
    for line, kept in (
        ("SPINDL/MAXRPM,3000", []),
        ("SPINDL/ORIENT,90", []),
        ("SPINDL/RPM,800,CLW,MAXRPM,3000", [800]),
        ("SPINDL/800,CLW,ORIENT,90", [800]),
    ):
        events = body(line, "GOTO/0,0,0").events
        assert [event.rpm for event in events if isinstance(event, SpindleOn)] == kept
        assert any(isinstance(event, UnknownStatement) for event in events)


def test_what_stands_beside_off_is_not_lost(body: Body) -> None:
    events = body("SPINDL/OFF,3000", "GOTO/0,0,0").events
    assert [type(event) for event in events] == [UnknownStatement, SpindleOff]


def test_zeros_for_letters_are_a_damaged_word(body: Body) -> None:
    (event,) = body("GOTO/0,0,0", "G0T0/5,5,5").events
    assert isinstance(event, UnknownStatement)
    assert (event.acts, str(event.what)) == (True, "G0T0 may be a damaged GOTO")


@pytest.mark.parametrize(
    ("unit", "feed", "told"),
    [
        ("MM", "FEDRAT/800,IPM", "800 IPM counts inches or feet, and the file is in millimetres (UNITS in line 2)"),
        ("MM", "FEDRAT/2,IPR", "the feed becomes 50.8 mm"),
        ("INCHES", "FEDRAT/200,MMPM", "200 MMPM counts millimetres, and the file is in inches (UNITS in line 2)"),
        ("MM", "FEDRAT/200,MMPM", ""),
        ("INCHES", "FEDRAT/8,IPM", ""),
    ],
)
def test_a_feed_in_a_unit_that_the_file_does_not_have_is_told_once(read: Read, unit: str, feed: str, told: str) -> None:
    lines = ["PARTNO A", f"UNITS/{unit}", "LOADTL/1", "RAPID", "GOTO/0,0,50", feed, "GOTO/0,0,-2", feed, "GOTO/1,0,-2"]
    remarks = [each for each in read("\n".join([*lines, "FINI"]) + "\n").remarks if each.code == "CL716"]
    assert [(each.line, told in each.what) for each in remarks] == ([(6, True)] if told else [])


def test_a_cycle_without_its_slash_is_no_two_statements(read: Read) -> None:
    lines = "CYCLE,DRILL,DEPTH,12,IPM,5,CLEAR,3,DWELL,1", "GOTO/5,0,0", "CYCLE/OFF"
    (problem,) = unknown_statement_errors(read(text("apt", *CUT, *lines)))
    assert (problem.line, problem.cure.split(",")[0]) == (len(HEADS["apt"]) + len(CUT) + 1, "write CYCLE")
    assert "with a slash before its values" in problem.cure
