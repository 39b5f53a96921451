"""Searches for motions that position the machine, against what a loop over the rows finds."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.control.row_buffer import StepColumnBuilder
from trunnion.verification.kinematics import positioning_moves
from trunnion.verification.kinematics.positioning_moves import approach_rows, first_workpiece_position

X, Y, Z, FIRST, FEED = (
    int(word)
    for word in (ProgrammedWord.X, ProgrammedWord.Y, ProgrammedWord.Z, ProgrammedWord.FIRST, ProgrammedWord.FEED)
)

#: Rows by the words of their block, whether they are rapids, in the machine frame, and right after a retract.
ROWS = st.lists(
    st.tuples(
        st.sampled_from((0, X, Y, Z, X | Y, X | Z, Y | FIRST, FIRST, FEED)), st.booleans(), st.booleans(), st.booleans()
    )
)


def run_of(rows: list[tuple[int, bool, bool, bool]]) -> Any:
    """What these searches need of a run."""
    frame = StepColumnBuilder(False)
    for row, (_, _, in_frame, _) in enumerate(rows):
        frame.set(row, in_frame)
    tcp = StepColumnBuilder(True).steps(len(rows), np.bool_)

    class Run(SimpleNamespace):
        def __len__(self) -> int:
            return len(rows)

    machine = SimpleNamespace(linear=(), workpiece_zero=None, tool_length=None)
    return Run(
        machine=machine,
        machine_at=lambda _: machine,
        programmed=np.array([words for words, *_ in rows], np.uint8),
        kind=np.where([rapid for _, rapid, *_ in rows], Kind.RAPID, Kind.LINEAR).astype(np.uint8),
        state=SimpleNamespace(
            machine_frame=frame.steps(len(rows), np.bool_),
            tcp=tcp,
            follows=tcp.part,
            follows_at=tcp.at,
        ),
        events=[SimpleNamespace(kind="retract", before_row=row) for row, each in enumerate(rows) if each[3]],
    )


@pytest.fixture(autouse=True)
def few_rows_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(positioning_moves, "_FEW", 1)
    monkeypatch.setattr(positioning_moves, "CHUNK", 4)


@pytest.fixture
def no_row_stands_still(monkeypatch: pytest.MonkeyPatch) -> None:
    """These runs have words, and no positions."""
    monkeypatch.setattr(positioning_moves, "repeats_position", lambda _, rows: np.zeros(len(rows), np.bool_))


@given(rows=ROWS, first=st.integers(0, 20), count=st.integers(0, 20))
def test_the_first_position_in_workpiece_coordinates(
    rows: list[tuple[int, bool, bool, bool]], first: int, count: int
) -> None:
    end = min(first + count, len(rows))
    goes = [row for row in range(first, end) if rows[row][0] & (X | Y | Z) and not rows[row][2]]
    assert first_workpiece_position(run_of(rows), first, end) == (goes[0] if goes else None)


@pytest.mark.usefixtures("no_row_stands_still")
@given(rows=ROWS)
def test_an_approach_goes_across_at_rapid_and_down_next(rows: list[tuple[int, bool, bool, bool]]) -> None:
    after_frame = {row for row in range(1, len(rows)) if rows[row - 1][2] and not rows[row][2]}
    # Where the tool is when the program begins, nobody knows.
    wanted, retracted = [], True
    for row, (words, rapid, in_frame, retract) in enumerate(rows):
        retracted = retracted or retract or row in after_frame
        if not words & (X | Y | Z) or in_frame:
            continue
        legs = [row]
        others = {X: Y, Y: X}
        half, half_at_rapid, half_in_frame, _ = rows[row + 1] if row + 1 < len(rows) else (X, False, False, False)
        if half == others.get(words & (X | Y | Z)) and half_at_rapid and not half_in_frame:
            legs.append(row + 1)
        end = legs[-1] + 1
        after, at_rapid, after_in_frame, _ = rows[end] if end < len(rows) else (X, False, False, False)
        down = not after & (X | Y) and (after & Z or not after & FIRST) and at_rapid and not after_in_frame
        # These runs are under TCP: where rotary axes turn too, the linear axes go elsewhere.
        if retracted and rapid and not words & (Z | FIRST) and down:
            wanted += legs
        retracted = False
    assert approach_rows(run_of(rows)).tolist() == wanted


@pytest.mark.parametrize(
    ("machine", "program"),
    [
        ("matsuura_mx330", "%\nO1\nG21 G17 G40 G80 G90 G94\nT1 M6\nS4000 M3\nG54 G0 X{0}. Y10.\nG43 H1 Z50.\n"
         "G1 Z-5. F100.\nX50.\nG0 Z50.\nM5\nG91 G28 Z0.\nG28 X0. Y0.\nM30\n%\n"),
        ("yl569", "G17 G40 G710 G90 G94 G54\nT=1\nM6\nD1\nS4000 M3\nG0 X{0} Y10\nG0 Z50\nG1 Z-5 F100\nX50\nG0 Z50\nM5\n"
         "SUPA G0 Z0 D0\nSUPA G0 X0 Y0\nM30\n"),
    ],
)  # fmt: skip
def test_a_program_may_begin_across_and_then_come_down(machine: str, program: str, tmp_path: Path) -> None:
    """As it is written by hand: how high the tool is over the first position, nobody says."""
    rows = "RAPID\nGOTO/10,10,50,0,0,1\nFEDRAT/MMPM,100\nGOTO/10,10,-5\nGOTO/50,10,-5\nRAPID\nGOTO/50,10,50\n"
    (tmp_path / "a.cls").write_text(HEAD.partition("RAPID")[0] + rows + FOOT, encoding="utf-8")
    for x, passes in ((10, True), (13, False)):
        path = tmp_path / "A.MPF"
        path.write_text(program.format(x), encoding="utf-8")
        found = trunnion.verify(path, machine=machine, cl=tmp_path / "a.cls")
        assert found.passed is passes, [check for check in found.checks if not check.passed]
