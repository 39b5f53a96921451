"""CL files of every dialect from anybody: read with all their points, or refused with a message."""

import random
import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.cl_dialects import EVERY, Step, says
from tests.support.examples import examples
from tests.support.fuzz import oracle
from tests.support.fuzz.mangle import mangle
from trunnion.model.toolpath import UnknownStatement

PATH = [
    Step("TOOL", (5.0, 10.0, 1.0)),
    Step("SPINDLE", (900.0,), "CLW"),
    Step("RAPID", point=(1.0, 2.0, 50.0)),
    Step("FEED", (300.0,)),
    Step("GOTO", point=(10.0, 0.0, 5.0), axis=(0.6, 0.0, 0.8)),
    Step("ARC", point=(0.0, 10.0, 5.0), axis=(0.6, 0.0, 0.8), centre=(0.0, 0.0, 5.0), start=(10.0, 0.0, 5.0)),
    Step("CYCLE", (5.0, 2.0, 90.0, 1.0), "DRILL", holes=((1.0, 2.0, 3.0), (4.0, 5.0, 3.0))),
    Step("TOOL", (6.0, 8.0, 0.0)),
    Step("RAPID", point=(1.0, 2.0, 50.0)),
]
SEEDS = {
    name: writer(False).write([step for step in PATH if says(name, step)]).encode() for name, writer in EVERY.items()
}

#: No writer in the tests writes a second machining axis system, or the words of ICAM's table.
SEEDS["catia axes"] = b"""$$ CATIA APT VERSION 1.0
$$*CATIA0
$$ P
$$ 1 0 0 0
$$ 0 1 0 0
$$ 0 0 1 0
LOADTL/1
SPINDL/1000,RPM,CLW
FEDRAT/100,MMPM
TLAXIS/0,0,1
GOTO/-40,-30,20
GOTO/-40,30,20
$$*CATIA0
$$ A
$$ 0 0 1 100
$$ 1 0 0 5
$$ 0 1 0 0
SYN/'TLAXIS','$$*TLAXIS'
MODE/CIRCUL,5,2
PPFUN/15,12,OFF
TLAXIS/0,0,1
RAPID
GOTO/1,2,30
CYCLE/DRILL,DEPTH,5,MMPM,100,CLEAR,2
GOTO/1,2,3
CYCLE/OFF
FINI
"""

#: It has no tool numbers, and no writer in the tests.
SEEDS["clt"] = b"""UNITS/ MM
CUTTER/ 10.0,0.0,5.0,3.004303,31.0,0.0,130.0,
TLAXIS/ 0.0,-1.0,0.0
OPFEATSTART/Drill1-Hole1
ROTABL/ 1.570796,AAXIS,TABLE,CCLW
ROTABL/ -0.000000,BAXIS,TABLE,CCLW
ROTABL/ 0.000000,CAXIS,TABLE,CCLW
RAPID/
GOTO/ -30.0,-15.0,25.0
CYCLE/ ON
CYCLE/ DRILL,G98,6.00161,PECKING,5.0,2.0,MMPM,1101.5,3.0,25.0 25.0 DWELL,0.000000
GOTO/ -30.0,-15.0,-0.0
CYCLE/ OFF
FEDRAT/ MMPM,185.687240
GOTO/ -20.0,-15.0,-1.0
CIRCLE/ -25.0,-15.0,-1.0,0.0,0.0,1.0,5.0,CLOCKWISE
GOTO/ -30.0,-15.0,-1.0
OPFEATEND/Drill1-Hole1
FINI
"""

#: Lines that belong to some dialect, with sense and without.
LINES = (
    "GOTO/1,2,3", "GOTO / 1.0, 2.0, 3.0,  $\n0.6, 0.0, 0.8", "GOTO/1,2,3,0,0,1,0,1,0", "GOTO/", "1,2,3",
    "GODLTA/1,0,0", "RAPID", "CIRCLE/0,0,0,0,0,1", "CIRCLE/0,0,0,0,0,1,5", "MOVARC/0,0,0,0,0,1,5,ANGLE,90",
    "INDIRV/0,1,0", "TLON,GOFWD/(CIRCLE/0,2,3,$\n1),ON,(LINE/0,2,3,0,3,3)", "TLON,GOFWD/(CYLNDR/0,0,0,0,0,1,5),ON",
    "GOFWD/", "RETRCT", "CLRSRF/50", "TLAXIS/0,1,0", "MULTAX/OFF", "MULTAX", "LOADTL/5,1", "LOAD/TOOL,7",
    "CUTTER/10,1,4,1,0,0,50", "CUTTER/", "CYCLE/DRILL,3,5", "CYCLE/DEEP2,FEDTO,5,1STPECK,2,SUBPECK,1,RAPTO,1",
    "CYCLE / DRILL, DEPTH, 3, CLEAR, 1, RAPTO, 9", "CYCLE/OFF", "CYCLE/INIT",
    "$$-> CSYS / 1,0,0,5,  $\n0,1,0,0,  $\n0,0,1,0", "$$-> CUTTER / 3", "$$-> FEATNO / 7", "$$*CATIA0", "$$ A",
    "$$ 1.0 0.0 0.0 x", "$$ OPERATION NAME : B", "CSYS/0,0,1,0,0,1,0,0,-1,0,0,0", "TRNTYP/WORLD,0,0,0", "INSERT/NOTE",
    "REMARK -> CUTTER / $", "FROM/1,2,3", "GOHOME", "GOHOME/1,2,3", "FEDRAT/5,PERMIN", "FEDRAT/INVERS,AUTO",
    "M1=MACRO/A", "1009/5", "ROTABL/5", "TRANS/0,0,0", "UNITS/MM", "TOOL PATH/A,TOOL,B", "END-OF-PATH", "SHOPWD/1",
    "FINI", "PARTNO/1", "TPRINT/T1", "LOADTL/6,0,80.0,3", "CLEARP/XYPLAN,9", "PPWORD/A,1", "SPINDL/OFF", "$$->", "$$",
    "$", "GOTO,1,2,3", "GOTO/1,2,3,0.6,0.8,0", "TOOLNO/1,TURN", "MODE/INCR,ON", "PROBE/OFF", "PARTNO/'A'",
    "OPFEATSTART/A", "OPFEATEND/A", "ROTABL/ 1.570796,AAXIS,TABLE,CCLW", "ROTABL/ 0.0,BAXIS,TABLE,CCLW", "TLON",
    "GOFWD/(CIRCLE/0,2,3,$\n1),ON,(LINE/0,2,3,0,3,3)", "CIRCLE/0,0,0,0,0,1,5,CLOCKWISE", "MCS/1,0,0,0,0,1,0,-1,0,0,0,0",
)  # fmt: skip

_ROW = re.compile(r"(GOTO|GODLTA|(TLON,)?GOFWD|RETRCT|GOHOME/[-+.\d])", re.IGNORECASE)


_TEXT = re.compile(r"PPRINT|INSERT|PARTNO|TPRINT|REMARK|TOOLPATH|DISPL|(OP)?STOP", re.IGNORECASE)


def points_in(text: str) -> int:
    """Statements that move the tool, counted line after line."""
    count, statement, goes_on = 0, "", False
    for line in text.split("\n"):
        plain = line.strip()
        is_comment = plain.startswith("$$") and not plain.startswith("$$->")
        if not goes_on and (is_comment or _TEXT.match(re.sub(r"[\s$]", "", plain))):
            continue
        plain = plain.removeprefix("$$") if not goes_on else plain
        plain = plain.partition("$$")[0].strip()
        goes_on = plain.endswith("$")
        statement += plain.removesuffix("$")
        if not goes_on:
            count += _ROW.match(re.sub(r"\s", "", statement)) is not None
            statement = ""
    return count


def judge(data: bytes, folder: Path, *, count: bool) -> bool:
    """Whether a file is read; if it is, with all its points."""
    toolpath = oracle.judge_cl(data, folder)
    if toolpath is None:
        return False
    events = (event for operation in toolpath.operations for event in operation.events)
    if any(isinstance(event, UnknownStatement) and event.acts for event in events):
        return False  # no program is made of it
    if count and toolpath.dialect != "clsf":
        assert sum(len(operation.moves) for operation in toolpath.operations) == points_in(data.decode())
    return True


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder for CL files."""
    return tmp_path_factory.mktemp("cl")


@pytest.mark.parametrize("dialect", SEEDS)
def test_the_seeds_are_read(folder: Path, dialect: str) -> None:
    assert judge(SEEDS[dialect], folder, count=True)


@settings(max_examples=examples(50), deadline=None)
@given(head=st.sampled_from(sorted(SEEDS)), lines=st.lists(st.sampled_from(LINES), max_size=12), cut=st.integers(0, 30))
def test_statements_of_all_dialects_among_each_other_are_read_or_refused(
    folder: Path, head: str, lines: list[str], cut: int
) -> None:
    begun = SEEDS[head].decode().splitlines()[:cut]
    judge("\n".join([*begun, *lines, "FINI", ""]).encode(), folder, count=True)


@pytest.mark.parametrize("dialect", SEEDS)
def test_mangled_files_are_read_or_refused(folder: Path, dialect: str) -> None:
    rng = random.Random(dialect)
    for _ in range(40):
        judge(mangle(SEEDS[dialect], list(SEEDS.values()), rng), folder, count=False)
