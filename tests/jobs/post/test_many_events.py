"""Files with very many statements between two points take work in proportion: lines of Python are counted, not time."""

import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

import trunnion

#: Statements that move nothing, together before one point or each before its own.
STATEMENTS = (
    "STOP", "OPSTOP", "DELAY/0.5", "PPRINT/HELLO", "INSERT/;HELLO", "COOLNT/FLOOD", "COOLNT/OFF", "SPINDL/RPM,3000,CLW",
    "SPINDL/RPM,3001,CLW", "CUTCOM/LEFT", "CUTCOM/OFF", "OPSKIP/ON", "OPSKIP/OFF", "SELECT/TOOL,2",
)  # fmt: skip

CYCLE = ("SPINDL/RPM,3000,CLW", "CYCLE/DRILL,RAPTO,3,FEDTO,-3,MMPM,100", "GOTO/20,0,0", "CYCLE/OFF")

HEAD = """UNITS/MM
TOOL PATH/A,TOOL,EM
TLDATA/MILL,10,0,80,0,0
LOAD/TOOL,1
SPINDL/RPM,3000,CLW
COOLNT/FLOOD
RAPID
GOTO/20,0,10
FEDRAT/MMPM,500
GOTO/20,0,0
"""

TAIL = """SPINDL/RPM,3000,CLW
GOTO/-10,0,0
RAPID
GOTO/-30,70,50
END-OF-PATH
"""

#: So many, twice and three times so many: what grows faster than the file shows in the second difference.
COUNT = 6


def body(kind: str, count: int) -> str:
    if kind == "before one point":
        statements = [statement for statement in STATEMENTS for _ in range(count)]
    else:
        ends = [f"GOTO/{20 - 0.01 * (k + 1):.3f},0,0" for k in range(count)]
        statements = [text for end in ends for text in (*STATEMENTS, end)]
    cycles = ["RAPID", "GOTO/20,0,10", *(text for _ in range(count) for text in CYCLE)]
    return "".join(f"{statement}\n" for statement in (*statements, *cycles))


def lines_of(work: Callable[[], object]) -> int:
    """How many lines of the package are executed, every round of a comprehension counted."""
    count = 0

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        nonlocal count
        if "trunnion" not in frame.f_code.co_filename:
            return None
        count += event == "line"
        return trace

    threading.settrace(trace)
    sys.settrace(trace)
    try:
        work()
    finally:
        sys.settrace(None)
        threading.settrace(None)
    return count


@pytest.mark.parametrize("kind", ["before one point", "before points"])
def test_work_grows_with_the_file(kind: str, tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"

    def work() -> None:
        assert trunnion.post(cl, machine="yl569").passed

    counts = []
    for times in (1, 2, 3):
        cl.write_text(HEAD + body(kind, times * COUNT) + TAIL)
        if times == 1:
            work()  # what is loaded and compiled once does not count
        counts.append(lines_of(work))
    first, second, third = counts
    assert third - second <= 1.04 * (second - first), counts
