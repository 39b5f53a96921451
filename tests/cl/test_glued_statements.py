"""Statements without a line of their own: a lost line end, a continuation sign too many, a lone carriage return."""

import pytest

from tests.support.apt_heads import HEADS
from tests.support.cl_reading import Body, Fail, Read
from trunnion.cl.dialects import DIALECTS
from trunnion.cl.word_classes import Suspicion, acts_on_machine, words_that_count
from trunnion.model.toolpath import Message

POINT = "GOTO/10,0,-1,0,0,1"
CUT = ["RAPID", "GOTO/0,0,50,0,0,1", "FEDRAT/200,MMPM", "GOTO/0,0,-1,0,0,1"]
DIALECTS_OF_FILES = ("clsf", *HEADS)

#: Statements that say nothing, carry a text, or whose word is unknown, in each dialect that has them.
SILENT = {
    "MACHIN/A,1": DIALECTS_OF_FILES,
    "CLPRNT/ON": DIALECTS_OF_FILES,
    "LEADER/100": DIALECTS_OF_FILES,
    "SHOPEV/ON": DIALECTS_OF_FILES,
    "PPRINT/TEXT": DIALECTS_OF_FILES,
    "REMARK SOME TEXT": DIALECTS_OF_FILES,
    "$$ A NOTE": DIALECTS_OF_FILES,
    "FEDRAT/200,MMPM $$ A NOTE": DIALECTS_OF_FILES,
    "PAINT/PATH": ("clsf",),
    "PAINT/SPEED,10": ("clsf",),
    "PSIS/(PLANE/(POINT/0,0,0),PERPTO,(VECTOR/0,0,1))": ("apt", "catia", "solidworks"),
    "REWIND/0": ("apt", "catia"),
    "PPWORD/STEP,66": ("ncl",),
    "MULTAX/ON": ("ncl",),
    "$$-> FEATNO / 3": ("ncl",),
    "SETUP/START,1": ("solidworks",),
    "BOX/0,0,0,1,1,1": ("clt",),
}
NEXT = [
    POINT,
    "GODLTA/0,0,-1",
    "RAPID",
    "FEDRAT/50,MMPM",
    "SPINDL/3000,RPM,CLW",
    "COOLNT/FLOOD",
    "CUTCOM/LEFT",
    "TLAXIS/0,0,1",
]


def written(dialect: str, *lines: str) -> str:
    if dialect == "clsf":
        return "\n".join(["TOOL PATH/A,TOOL,T", *CUT, *lines, "GOTO/10,10,-1", "END-OF-PATH", ""])
    return "\n".join([*HEADS[dialect], *CUT, *lines, "GOTO/10,10,-1", "FINI", ""])


def damaged(before: str, after: str) -> list[str]:
    """A lost line end, and for a statement that may be continued a continuation sign too many."""
    carries_text = before.startswith(("PPRINT", "REMARK", "$$ ")) or "$$ A" in before
    return [before + after] + [f"{before}$\n{after}"] * (not carries_text)


@pytest.mark.parametrize("dialect", DIALECTS_OF_FILES)
def test_a_statement_without_a_line_of_its_own_is_refused(fails: Fail, read: Read, dialect: str) -> None:
    silent = [text for text, dialects in SILENT.items() if dialect in dialects]
    missed = []
    for before in silent:
        for after in NEXT:
            for text in damaged(before, after):
                problems = fails(written(dialect, text), dialect=dialect)
                line = len(HEADS.get(dialect, ["TOOL PATH"])) + len(CUT) + 1
                if [(problem.line, "within it" in problem.what) for problem in problems] != [(line, True)]:
                    missed.append((text, problems))
    assert not missed
    assert len(read(written(dialect, *silent), dialect=dialect).operations[-1].moves) == 3


@pytest.mark.parametrize(
    "text",
    [
        "PAINT/PATHPAINT/COLOR,31",
        "PAINT/SPEED,10INSERT M8",
        "PAINT/PATH$\nPPRINT NOTE",
        "PAINT/PATH,$\nRAPID",
        "PAINT/TOOL,NOMORELOAD/TOOL,2",
        "MACHIN/A,1TOOL PATH/B,TOOL,C",
        "INSERT/M8GOTO/1,2,3",
        "DISPLY/TEXT GOTO/1,2,3",
        "STOP/TEXTSPINDL/OFF",
        "COOLNT/ONLOAD/TOOL,2",
        "GOTO/1,2,3 $$ 1,2,3GOTO/4,5,6",
        "GOTO/1,2,$ $$ NOTEGOTO/4,5,6\n3",
        "GOTO/1,2,3 $$ NOTERAPID",
    ],
)
def test_more_statements_without_a_line_of_their_own_are_refused(body_fails: Fail, text: str) -> None:
    (problem,) = body_fails("GOTO/0,0,0", text, "GOTO/9,9,9")
    assert (problem.line, "without a line of its own" in problem.what) == (4, True)


@pytest.mark.parametrize(
    "text",
    ["SHOPEV/" + "A" * 900_000 + "/1", "PSIS/" + "(" * 400_000 + ")" * 400_000, "SHOPEV/" + "(GOTO/" * 99_000],
    ids=["long", "nested", "open"],
)
def test_a_statement_of_a_megabyte_takes_no_longer_than_others(read: Read, fails: Fail, text: str) -> None:
    if "GOTO" in text:
        assert "SHOPEV has GOTO within it" in fails(written("apt", text))[0].what
    else:
        assert len(read(written("apt", text)).operations[0].moves) == 3


@pytest.mark.parametrize("end", ["", "$\n", " "])
def test_a_command_of_creo_stands_on_a_line_of_its_own(fails: Fail, end: str) -> None:
    (problem,) = fails(written("ncl", f"FEDRAT / 200, MMPM{end}$$-> CUTTER / 12"))
    assert "has $$-> behind it" in problem.what


@pytest.mark.parametrize(
    "text",
    [
        "PPRINT/SPINDL/FEEDS AND CUTTER/TOOLS",
        "PPRINT/LOAD/UNLOAD BY HAND",
        "PPRINT/NON-RAPID",
        "REMARK GOTO/1,2,3",
        "$$ GOTO/1,2,3",
        "$$GOTO/1,2,3",
        "GOTO/1,2,3 $$ GOTO/1,2,3",
        "GOTO/1,2,3 $$ 11/22/2020",
        "$$ PRODUCT / PPTABLE / 3",
        "MACHIN/AX5/B",
    ],
)
def test_a_word_of_a_text_is_no_statement(body: Body, text: str) -> None:
    operation = body("GOTO/0,0,0", text, "GOTO/9,9,9")
    assert operation.moves.tip[-1].tolist() == [9, 9, 9]
    assert all(isinstance(event, Message) for event in operation.events)


@pytest.mark.parametrize("dialect", DIALECTS_OF_FILES)
def test_what_may_have_been_a_line_end_in_a_comment_is_refused(fails: Fail, dialect: str) -> None:
    for end, what in (("\r", "a carriage return"), ("\f", "byte 0x0c"), ("\x1a", "byte 0x1a")):
        for text in (f"$$ NOTE{end}{POINT}", f"{POINT} $$ 1{end}2", f"FEDRAT/9,MMPM $$ C{end}{POINT}"):
            (problem,) = fails(written(dialect, text), dialect=dialect)
            assert what in problem.what


def test_an_end_mark_of_dos_and_a_line_end_behind_a_comment_are_no_fault(read: Read) -> None:
    text = written("clsf", "$$ NOTE\r", f"{POINT} $$ 1,2,3 \r", "$$ TAB\tNOTE") + "$$ END\x1a"
    assert len(read(text).operations[0].moves) == 4


@pytest.mark.parametrize(
    ("major", "meant"),
    [
        ("OPSTOPLOAD", "OPSTOP"),
        ("END-OF-PATHTOOLPATH", "END-OF-PATH"),
        ("MULTAXTLAXIS", "MULTAX"),
        ("STOPCOOLNT", "STOP"),
        ("COOLNTON", "COOLNT"),
        ("CUTCOMLEFT,XYPLAN", "CUTCOM"),
        ("LOADTOOL,1", "LOAD"),
        ("UNITSINCHES", "UNITS"),
    ],
)
def test_a_word_glued_to_another_is_a_damaged_one(major: str, meant: str) -> None:
    for dialect in DIALECTS.values():
        assert acts_on_machine(major, words_that_count(dialect)) == Suspicion(meant, (meant,))
    for known in ("MODELS", "LOADCASE", "STOPPER", "FROMAT", "SHOPEV"):
        assert acts_on_machine(known, words_that_count(DIALECTS["clsf"])) is None


def test_the_name_of_a_tool_stands_behind_the_word_in_lower_case_too(read: Read) -> None:
    (operation,) = read("tool path/a,tool,t1\ngoto/0,0,0\nend-of-path\n").operations
    assert (operation.name, operation.tool.name) == ("a", "t1")
