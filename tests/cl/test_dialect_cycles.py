"""Cycles of APT dialects."""

from collections.abc import Callable

import pytest

from tests.support.apt_heads import HEADS
from tests.support.cl_reading import Read
from trunnion.model.toolpath import (
    CycleOn,
    Operation,
)
from trunnion.planning.holes.cycles import HoleMethod, cycle_from_event


def cycle(operation: Operation) -> CycleOn:
    """The only cycle of an operation."""
    (found,) = (event for event in operation.events if isinstance(event, CycleOn))
    return found


@pytest.mark.parametrize(
    ("dialect", "statement", "method", "heights", "pecks"),
    [
        ("ncl", "CYCLE / DEEP, DEPTH, 12, STEP, 4, MMPM, 50, CLEAR,$\n 1", HoleMethod.DEEP_DRILLING, (1, 12, 1), 4),
        ("ncl", "CYCLE / BRKCHP, DEPTH, 12, STEP, 4, MMPM, 50, CLEAR, 1", HoleMethod.CHIP_BREAKING, (1, 12, 1), 4),
        ("ncl", "CYCLE / DRILL, DEPTH, 9, MMPM, 50, CLEAR, 5, RAPTO, 3, RETURN, 9", HoleMethod.DRILL, (2, 9, 9), 0),
        ("ncl", "CYCLE / DRILL, DEPTH, 9, MMPM, 50, CLEAR, 5, RETURN, 0", HoleMethod.DRILL, (5, 9, None), 0),
        ("ncl", "CYCLE / DRILL, DEPTH, 9, MMPM, 50, CLEAR, 5, RAPTO, 3", HoleMethod.DRILL, (2, 9, 5), 0),
        ("solidworks", "CYCLE/DRILL,FEDTO,5,MMPM,9,RAPTO,3.,RTRCTO,27,DWELL,0", HoleMethod.DRILL, (3, 5, 27), 0),
        (
            "solidworks",
            "CYCLE/DEEP2,FEDTO,28.6,1STPECK,5.,SUBPECK,2.,MMPM,9,RAPTO,3.,RTRCTO,27",
            HoleMethod.DEEP_DRILLING,
            (3, 28.6, 27),
            5,
        ),
        ("solidworks", "CYCLE/DEEP,FEDTO,3,INCR,10.,MMPM,9,RAPTO,2,RTRCTO,4", HoleMethod.DEEP_DRILLING, (2, 3, 4), 10),
        ("catia", "CYCLE/DRILL,    3.000000,    5.000000", HoleMethod.DRILL, (5, 3, 5), 0),
        ("catia", "CYCLE/DRILL,    3.0,    5.0,  80.0,MMPM", HoleMethod.DRILL, (5, 3, 5), 0),
        ("catia", "CYCLE/TAP,   50.786017,    1.000000", HoleMethod.TAP, (1, 50.786017, 1), 0),
        ("apt", "CYCLE/DRILL,FEDTO,7,MMPM,9,RAPTO,2,RTRCTO,6", HoleMethod.DRILL, (2, 7, 6), 0),
        ("apt", "CYCLE/DEEP,FEDTO,7,STEP,3,MMPM,9,RAPTO,2", HoleMethod.DEEP_DRILLING, (2, 7, 2), 3),
    ],
)
def test_cycles_by_the_words_of_their_dialect(
    apt: Callable[..., Operation],
    dialect: str,
    statement: str,
    method: HoleMethod,
    heights: tuple[float, float, float | None],
    pecks: float,
) -> None:
    found = cycle_from_event(cycle(apt(dialect, "GOTO/0,0,9", statement, "GOTO/0,0,0", "CYCLE/OFF")))
    assert (found.method, (found.rapid_height, found.depth, found.retract_height)) == (method, heights)
    assert found.pecks[0] == pecks


def test_later_pecks_of_solidworks_are_of_one_length(apt: Callable[..., Operation]) -> None:
    statement = "CYCLE/DEEP2,FEDTO,28,1STPECK,5.,SUBPECK,2.,MMPM,9,RAPTO,3.,RTRCTO,27"
    assert dict(cycle(apt("solidworks", statement, "GOTO/0,0,0")).values)["STEP"] == (5, 3, 2)


def test_pecks_that_grow_are_all_as_long_as_the_first(read: Read) -> None:
    lines = [
        *HEADS["solidworks"],
        "CYCLE/DEEP2,FEDTO,45,1STPECK,5.,SUBPECK,30.,MMPM,9,RAPTO,3.,RTRCTO,27",
        "GOTO/0,0,0",
    ]
    toolpath = read("\n".join([*lines, "CYCLE/OFF", "FINI"]) + "\n")
    assert dict(cycle(toolpath.operations[-1]).values)["STEP"] == (5,)
    (remark,) = toolpath.remarks
    assert remark.what == "pecks of 30 behind a first one of 5: all are made as long as the first"


@pytest.mark.parametrize(
    ("dialect", "statement", "what"),
    [
        ("apt", "CYCLE/DRILL, 12.0, MMPM, 80.0, 5.0", "numbers without words"),
        ("apt", "CYCLE/THRU,FEDTO,5,RAPTO,1", "differs from post-processor"),
        ("apt", "CYCLE/BORE,FEDTO,5,RAPTO,1", "differs from post-processor"),
        ("ncl", "CYCLE / THRU, DEPTH, 5, CLEAR, 1", "no real file"),
        ("ncl", "CYCLE / DRILL, 5, 100, MMPM, 1", "numbers without words"),
        ("ncl", "CYCLE / DRILL, DEPTH, 5", "without CLEAR"),
        ("ncl", "CYCLE / DRILL, DEPTH, 5, CLEAR, 1, RAPTO, 2", "passes the point"),
        ("catia", "CYCLE/DRILL, 3, 5, 6, 7", "numbers without words"),
        ("catia", "CYCLE/DRILL, 3, 5, 6", "a feed without a unit"),
        ("solidworks", "CYCLE/DEEP2,FEDTO,5,1STPECK,1,RAPTO,1", "one of 1STPECK and SUBPECK"),
        ("solidworks", "CYCLE/DEEP2,FEDTO,5,1STPECK,1,SUBPECK,0,RAPTO,1", "SUBPECK that is not above 0"),
    ],
)
def test_cycles_in_doubt_are_refused(refused: Callable[..., str], dialect: str, statement: str, what: str) -> None:
    assert what in refused(dialect, statement)


@pytest.mark.parametrize(
    ("dialect", "begin"),
    [
        ("catia", "$$ OPERATION NAME : B"),
        ("ncl", "$$-> FEATNO / 2"),
        ("solidworks", "INSERT/B"),
        ("solidworks", "LOAD/TOOL,7"),
        ("fusion", "LOADTL/7, 0, 60., 7"),
        ("apt", "LOADTL/7"),
        ("apt", "GOHOME"),
    ],
)
def test_a_cycle_that_nothing_ends_is_refused(
    refused: Callable[..., str], apt: Callable[..., Operation], dialect: str, begin: str
) -> None:
    word = "CLEAR" if dialect in ("ncl", "catia") else "RAPTO"
    lines = ["FEDRAT/100,MMPM", f"CYCLE/DRILL,{'FEDTO' if word == 'RAPTO' else 'DEPTH'},3,{word},5", "GOTO/1,2,3"]
    assert "is still on where operation" in refused(dialect, *lines, begin, "GOTO/4,5,6")
    operation = apt(dialect, *lines, "CYCLE/OFF", begin, "RAPID", "GOTO/4,5,6", "GOTO/4,5,5")
    assert operation.moves.feed.tolist() == [100, 100]
