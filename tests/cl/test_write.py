"""CL files written: what ``write_cl`` writes, ``read_cl`` reads back."""

import io
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from tests.support.cl_reading import Body, Read
from tests.support.examples import examples
from tests.support.locations import YL569
from tests.support.toolpath_strategies import OTHERS, SAYABLE, toolpaths
from trunnion.cl import read_cl
from trunnion.cl.read_back import read_back_problems
from trunnion.cl.write import write_cl
from trunnion.cl.writers import WRITERS
from trunnion.errors import InputError
from trunnion.model.toolpath import (
    Arcs,
    Coolant,
    CycleOff,
    CycleOn,
    Event,
    Frame,
    From,
    Kind,
    Moves,
    Operation,
    Phase,
    Tool,
    Toolpath,
)

GOLDEN = sorted(path.stem for path in YL569.glob("*.cls"))

#: An axis that is in force without being said.
UPRIGHT = b",0.000000000000,0.000000000000,1.000000000000"


def made(*events: tuple[Event, ...]) -> Toolpath:
    """One cut for each tuple of events."""
    columns = [np.full(1, value) for value in (np.uint8(Kind.LINEAR), np.uint8(Phase.CUT), 100.0, False, np.int32(1))]
    moves = [Moves(np.full((1, 3), float(k)), np.array([[0.0, 0.0, 1.0]]), *columns) for k in range(len(events))]
    tool = Tool("MILL", "T", 10.0, 0.5, 50.0)
    found = (Operation(f"OP{k}", tool, Frame(), each, Arcs.empty(), events[k], 1) for k, each in enumerate(moves))
    return Toolpath("made.cls", tuple(found))


#: In inches a digit of it is lost at which rounding to fewer goes up or down.
HALF_WAY = made((From(0, 1, (-0.779575, 0.000625, -0.002775), (0.0, 0.0, 1.0)),))

#: The second operation begins with a cut, and one with coolant does not go on with it.
GOES_ON = made((Coolant(0, 1, "FLOOD"),), ())


def written(toolpath: Toolpath, *comments: str) -> bytes:
    """The bytes of the CL file."""
    sink = io.BytesIO()
    write_cl(toolpath, sink, comments=comments)
    return sink.getvalue()


def again(toolpath: Toolpath, folder: Path) -> Toolpath:
    """Written and read back."""
    path = folder / "again.cls"
    path.write_bytes(written(toolpath))
    return read_cl(path)


def assert_same_event(first: Event, second: Event) -> None:
    """The same but for the line; axes of FROM within their decimals."""
    assert type(first) is type(second)
    for field in fields(first):
        a, b = getattr(first, field.name), getattr(second, field.name)
        if isinstance(first, From) and field.name == "axis":
            assert np.abs(np.array(a) - np.array(b)).max() < 1.5e-12
        elif field.compare and field.name != "line":
            assert a == b


def assert_same(first: Operation, second: Operation) -> None:
    """All that a CL file holds is the same: exactly, or to the 12 decimals of a tool axis."""
    assert (first.name, first.tool, first.frame) == (second.name, second.tool, second.frame)
    assert (first.intol, first.outtol) == (second.intol, second.outtol)
    for column in ("tip", "kind", "phase", "feed", "per_rev"):
        np.testing.assert_array_equal(getattr(first.moves, column), getattr(second.moves, column), column)
    assert np.abs(first.moves.axis - second.moves.axis).max() < 1.5e-12
    for column in ("row", "centre", "normal", "radius", "full_turns"):
        np.testing.assert_array_equal(getattr(first.arcs, column), getattr(second.arcs, column), column)
    assert len(first.events) == len(second.events)
    for a, b in zip(first.events, second.events, strict=True):
        assert_same_event(a, b)


def arcs_in_cycles(operation: Operation) -> bool:
    """Whether a row is both an arc and a hole."""
    cycles = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
    latest = (next((each for each in reversed(cycles) if each.row <= row), None) for row in operation.arcs.row)
    return any(isinstance(cycle, CycleOn) for cycle in latest)


@settings(deadline=None, max_examples=examples(60))
@given(toolpaths(SAYABLE | OTHERS))
def test_a_toolpath_written_and_read_is_the_same(tmp_path_factory: pytest.TempPathFactory, toolpath: Toolpath) -> None:
    assume(not any(arcs_in_cycles(operation) for operation in toolpath.operations))  # a CL file cannot have them
    back = again(toolpath, tmp_path_factory.getbasetemp())
    assert back.part == toolpath.part
    for first, second in zip(toolpath.operations, back.operations, strict=True):
        assert_same(first, second)


@settings(deadline=None, max_examples=examples(25))
@given(toolpaths(SAYABLE | OTHERS), st.sampled_from(list(WRITERS)), st.booleans())
@example(HALF_WAY, "clsf", True)
@example(HALF_WAY, "catia", True)
@example(GOES_ON, "ncl", False)
@example(GOES_ON, "catia", False)
def test_every_dialect_says_a_toolpath_whole_or_refuses_it(
    tmp_path_factory: pytest.TempPathFactory, toolpath: Toolpath, dialect: str, inch: bool
) -> None:
    assume(not any(arcs_in_cycles(operation) for operation in toolpath.operations))
    writer, sink = WRITERS[dialect](toolpath, inch=inch), io.BytesIO()
    path = tmp_path_factory.getbasetemp() / "again"
    try:
        writer.write(sink)
    except InputError:
        assert dialect != "clsf"
        assert sink.getvalue() == b""
        return
    path.write_bytes(sink.getvalue())
    assert read_back_problems(writer.toolpath, path, dialect) == []


@pytest.mark.parametrize("name", GOLDEN)
def test_golden_files_come_back(name: str, tmp_path: Path) -> None:
    toolpath = read_cl(YL569 / f"{name}.cls")
    back = again(toolpath, tmp_path)
    for first, second in zip(toolpath.operations, back.operations, strict=True):
        assert_same(first, second)


@pytest.mark.parametrize("name", GOLDEN)
def test_points_of_golden_files_are_the_lines_that_they_were(name: str) -> None:
    majors = (b"GOTO", b"RAPID", b"FEDRAT", b"SPINDL", b"LOAD", b"COOLNT")
    lines = (YL569 / f"{name}.cls").read_bytes().splitlines()
    wanted = [line.removesuffix(UPRIGHT) for line in lines if line.startswith(majors)]
    found = [line for line in written(read_cl(YL569 / f"{name}.cls")).splitlines() if line.startswith(majors)]
    assert len(wanted) == len(found)
    unlike = [pair for pair in zip(wanted, found, strict=True) if pair[0] != pair[1]]
    assert all(_apart(first, second) < 1.5e-12 for first, second in unlike)


def _apart(first: bytes, second: bytes) -> float:
    """Largest difference of two points; an axis as read is a unit vector, and no longer the digits that it was."""
    a, b = (np.array([float(n) for n in line.removeprefix(b"GOTO/").split(b",")]) for line in (first, second))
    return float(np.abs(a - b).max())


@settings(deadline=None, max_examples=examples(80))
@given(st.floats(1e-7, 1e-3), st.floats(0, 2 * np.pi), st.permutations([0, 1, 2]), st.sampled_from([-1.0, 1.0]))
def test_near_a_coordinate_axis_the_direction_of_the_lean_is_kept(
    tmp_path_factory: pytest.TempPathFactory, tilt: float, angle: float, order: list[int], sign: float
) -> None:
    axis = np.array([np.sin(tilt) * np.cos(angle), np.sin(tilt) * np.sin(angle), sign * np.cos(tilt)])[order]
    operation = read_cl(YL569 / "2_hub_rough.cls").operations[0]
    axes = operation.moves.axis.copy()
    axes[3] = axis
    leaning = replace(operation, moves=replace(operation.moves, axis=axes))
    back = again(Toolpath("a", (leaning,)), tmp_path_factory.getbasetemp()).operations[0].moves.axis[3]
    small = np.argsort(np.abs(axis))[:2]
    assert np.abs(back[small] - axis[small]).max() <= 1e-16 * max(1.0, 1e-2 / tilt)


def test_numbers_with_all_digits_go_a_slower_way_and_stay(body: Body, tmp_path: Path) -> None:
    operation = body("GOTO/0.1234567890123456,1.0,100000.00000000001,0,0,1", "GOTO/1e-7,2,3")
    assert_same(operation, again(Toolpath("a", (operation,)), tmp_path).operations[0])


@pytest.mark.parametrize("rows", [1, 32767, 32768, 32769, 70000])
def test_no_point_is_lost_between_chunks(rows: int, body: Body, tmp_path: Path) -> None:
    one = body("FEDRAT/MMPM,100", *(f"GOTO/{row},0.5,0.25" for row in range(rows)))
    assert_same(one, again(Toolpath("a", (one,)), tmp_path).operations[0])


def test_phases_that_no_colours_say_are_remarked_upon(body: Body) -> None:
    operation = body("FEDRAT/MMPM,100", *(f"GOTO/{row},0,0" for row in range(4)))
    moves = operation.moves
    phase = np.array([Phase.CUT, Phase.APPROACH, Phase.INITIAL, Phase.CUT], np.uint8)
    remarks = write_cl(Toolpath("a", (replace(operation, moves=replace(moves, phase=phase)),)), io.BytesIO())
    assert len(remarks) == 1
    assert "OP: 2 points in another phase, the first in departure instead of approach" in remarks[0].what


def test_the_head_has_comments_and_the_part(body: Body, tmp_path: Path) -> None:
    operation = body("GOTO/1,2,3")
    text = written(Toolpath("a", (operation,), "C:\\零件.prt"), "--set title=零件$")
    assert text.startswith("$$ --set title=零件$\nPARTNO/C:\\零件.prt\nTOOL PATH/OP,TOOL,T1\n".encode())
    (tmp_path / "a.cls").write_bytes(text)
    assert read_cl(tmp_path / "a.cls").part == "C:\\零件.prt"


def test_a_name_that_looks_like_another_encoding_gets_a_byte_order_mark(body: Body, tmp_path: Path) -> None:
    operation = replace(body("GOTO/1,2,3"), name="յ")
    assert written(Toolpath("a", (operation,))).startswith(b"\xef\xbb\xbf")
    assert again(Toolpath("a", (operation,)), tmp_path).operations[0].name == "յ"


def test_unknown_tools_stay_unknown(read: Read, tmp_path: Path) -> None:
    toolpath = read("TOOL PATH/OP,TOOL,T1\nTLDATA/PROBE,1,2\nGOTO/1,2,3\nEND-OF-PATH\n")
    back = again(toolpath, tmp_path)
    assert back.operations[0].tool == toolpath.operations[0].tool
    assert back.operations[0].events == ()


@pytest.mark.parametrize(
    ("tldata"),
    [
        "TLDATA/MILL,10.0,1.0,50.0,3.0,0.5",
        "TLDATA/MILL,10.0,1.0,50.0,3.0,0.5,0,0,12.5,0,0",
        "TLDATA/DRILL,8.0,0.0,75.0,118.0,35.0",
        "TLDATA/TCUTTER,50.0,1.0,2.0,50.0,10.0",
        "TLDATA/BARREL,50.0,1.0,100.0,0.0,10.0",
    ],
)
def test_forms_of_tools_come_back(tldata: str, read: Read, tmp_path: Path) -> None:
    toolpath = read(f"TOOL PATH/OP,TOOL,T1\n{tldata}\nGOTO/1,2,3\nEND-OF-PATH\n")
    assert again(toolpath, tmp_path).operations[0].tool == toolpath.operations[0].tool


def test_frames_come_back(read: Read, tmp_path: Path) -> None:
    toolpath = read("TOOL PATH/O,TOOL,T\nMSYS/1,2.5,3,0.6,0.8,0,-0.8,0.6,0\nGOTO/1,2,3\nEND-OF-PATH\n")
    assert again(toolpath, tmp_path).operations[0].frame == toolpath.operations[0].frame


def test_what_no_cl_file_can_hold_is_said_before_anything_is_written(body: Body) -> None:
    operation = body("GOTO/0,0,0", "PPRINT/x", "CIRCLE/5,0,0,0,0,1,5", "GOTO/10,0,0")
    bad = replace(
        operation,
        name="a,TOOL,b",
        events=tuple(replace(event, text="a\nM30") for event in operation.events),  # type: ignore[call-arg]
        arcs=replace(operation.arcs, centre=operation.arcs.centre + np.array([0.5, 0.0, 0.0])),
    )
    sink = io.BytesIO()
    with pytest.raises(InputError) as caught:
        write_cl(Toolpath("a.mpf", (bad,)), sink)
    text = str(caught.value)
    assert "',TOOL,'" in text
    assert "a.mpf:4: error: text of Message has a line break" in text
    assert "a.mpf:6: error: an end of the arc lies 0.500 mm off its radius" in text
    assert sink.getvalue() == b""


def test_nothing_is_no_cl_file() -> None:
    with pytest.raises(InputError, match="there is no operation"):
        write_cl(Toolpath("a", ()), io.BytesIO())
