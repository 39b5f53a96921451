"""Programs of other posts: what their words are converted to."""

from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import SHARED
from trunnion.controls import load_control
from trunnion.conversion import Conversion, convert
from trunnion.errors import Problem
from trunnion.machines import load_machine
from trunnion.model.toolpath import (
    Coolant,
    CutterComp,
    Dwell,
    Insert,
    Kind,
    LoadTool,
    Message,
    Operation,
    Phase,
    SelectTool,
    Sense,
    SpindleOff,
    SpindleOn,
    Stop,
)
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions

MACHINE = load_machine("yl569")
CONTROL = load_control(MACHINE.control)


class Programs:
    """Converts the text of programs."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def all(self, *lines: str) -> Conversion:
        """The program as a whole."""
        (self.folder / "part.mpf").write_text("\n".join(lines) + "\nM30\n", encoding="utf-8")
        return convert(
            run_program(self.folder / "part.mpf", MACHINE, RunOptions(subprograms=sorted(self.folder.glob("*.SPF")))),
            CONTROL,
        )

    def one(self, *lines: str) -> Operation:
        """Its only operation."""
        (operation,) = self.all(*lines).toolpath.operations
        return operation


@pytest.fixture
def programs(tmp_path: Path) -> Programs:
    """A converter in a folder of its own."""
    return Programs(tmp_path)


def remarks(found: Conversion) -> list[Problem]:
    """All but that these pieces of programs call neither tool nor spindle, which they are told besides."""
    return [each for each in found.warnings if each.code != "CNV154"]


def test_without_heads_operations_begin_at_tool_changes(programs: Programs) -> None:
    found = programs.all(
        'T="ROUGHER"', "M6", "S1000 M3", "G0 X0 Y0 Z10", "G1 Z0 F100", "T2", "M6", "G0 X5 Y5 Z10", "G1 Z1 F50"
    ).toolpath.operations
    assert [operation.name for operation in found] == ["TOOL_ROUGHER", "TOOL_2"]
    assert [len(operation.moves) for operation in found] == [2, 2]
    assert found[0].events == (SpindleOn(0, 3, 1000.0, Sense.CLW),)
    assert found[1].events == (LoadTool(0, 7, 2),)


def test_a_program_without_tool_changes_is_one_operation_of_its_name(programs: Programs) -> None:
    operation = programs.one("G0 X1 Y2 Z3", "G1 X2 F100")
    assert (operation.name, operation.line) == ("part", 1)
    assert operation.moves.line.tolist() == [1, 2]
    assert operation.moves.phase.tolist() == [Phase.RAPID, Phase.CUT]


def test_feeds_are_those_in_force_and_none_before_the_first_cut(programs: Programs) -> None:
    moves = programs.one("F100", "G0 X1 Y2 Z3", "G1 X2", "G0 X3", "G95 G1 X4 F0.5", "G0 X5", "G94 G1 X6 F80").moves
    np.testing.assert_array_equal(moves.feed, [np.nan, 100, 100, 0.5, 0.5, 80])
    assert moves.per_rev.tolist() == [False, False, False, True, True, False]


def test_inverse_time_becomes_mm_per_minute(programs: Programs) -> None:
    moves = programs.one("G0 X0 Y0 Z0", "G93 G1 X10 F2", "G3 X10 Y20 I0 J10 F1").moves
    np.testing.assert_allclose(moves.feed[1:], [20.0, 10 * np.pi])


def test_events_are_told_by_their_words(programs: Programs) -> None:
    operation = programs.one(
        "T3", "G0 X0 Y0 Z5 S500 M3", "; look", "M8", "G1 Z0 F10", "M26", "G4 F2", "G4 S3", "X1", "M61 M1", 'MSG("Hi")',
        "X2", "H5", "X3 M9", "M0", "X4 M5",
    )  # fmt: skip
    assert operation.events == (
        SelectTool(0, 1, 3),
        SpindleOn(0, 2, 500.0, Sense.CLW),
        Message(1, 3, "look"),
        Coolant(1, 4, "ON"),
        Coolant(2, 6, "THRU"),
        Dwell(2, 7, 2.0),
        Dwell(2, 8, 3.0, True),
        Insert(3, 10, "M61"),
        Stop(3, 10, True),
        Message(3, 11, "Hi", True),
        Insert(4, 13, "H5"),
        Coolant(4, 14, "OFF"),
        Stop(5, 15, False),
        SpindleOff(5, 16),
    )


def test_what_ends_in_a_block_of_its_own_is_said_twice_to_get_one_again(programs: Programs) -> None:
    operation = programs.one("G0 X0 Y0 Z5 S500 M3 M8", "M9", "G1 X1 F10", "X2 M5")
    assert [event for event in operation.events if event.row > 0] == [
        Coolant(1, 2, "OFF"),
        Coolant(1, 2, "OFF"),
        SpindleOff(2, 4),
    ]


def test_coolant_runs_on_into_the_next_operation_and_a_spindle_that_stands_stays(programs: Programs) -> None:
    cut = "G0 X0 Y0 Z5", "G1 X1 F10"
    operations = programs.all("T1 M6", "S500 M3 M8", *cut, "T2 M6", *cut, "M5", "T3 M6", *cut, "M9 M5", "T4 M6", *cut)
    found = [[e for e in operation.events if e.row == 0] for operation in operations.toolpath.operations]
    assert found[1] == [Coolant(0, 2, "ON"), LoadTool(0, 5, 2)]
    assert found[2] == [SpindleOff(0, 9), Coolant(0, 2, "ON"), LoadTool(0, 9, 3)]
    assert found[3] == [SpindleOff(0, 13), LoadTool(0, 13, 4)]


def test_tools_are_preselected_and_changes_without_motion_are_remarked_upon(programs: Programs) -> None:
    converted = programs.all("T1 M6", "M0", "T2", "M6", "T3", "G0 X0 Y0 Z5", "G1 X1 F10", "M6", "M5")
    (operation,) = converted.toolpath.operations
    assert operation.events[:3] == (Stop(0, 2, False), LoadTool(0, 4, 2), SelectTool(0, 5, 3))
    assert [(remark.line, remark.what) for remark in converted.warnings] == [
        (1, "no motion follows the change to tool 1: not carried over"),
        (8, "no motion follows the change to tool 3: not carried over"),
        (7, "cuts while the spindle stands, and so does the new program"),
    ]


def test_compensation_comes_back_with_its_plane(programs: Programs) -> None:
    operation = programs.one("G0 X0 Y0 Z5", "G41 G18 G1 X1 F10", "G17 X2", "G40 X3", "G42 X4", "X5")
    assert operation.events == (CutterComp(1, 2, "LEFT", "ZXPLAN"), CutterComp(3, 4, "OFF"), CutterComp(4, 5, "RIGHT"))


def test_machine_positions_and_the_placing_of_rotary_axes_are_no_motion_of_the_part(programs: Programs) -> None:
    operation = programs.one("SUPA G0 Z0", "G0 B30 C60", "TRAORI", "G54", "G0 X1 Y2 Z3", "G1 X2 F10", "SUPA G0 Z0")
    assert operation.moves.tip.tolist() == [[1.0, 2.0, 3.0], [2.0, 2.0, 3.0]]
    half = np.sqrt(0.75) / 2
    np.testing.assert_allclose(operation.moves.axis, [[0.25, half, np.sqrt(0.75)]] * 2)


def test_machine_positions_on_the_way_are_remarked_upon(programs: Programs) -> None:
    converted = programs.all("G0 X1 Y2 Z3", "SUPA G0 Z0", "G0 X2 Y2 Z3")
    assert [len(operation.moves) for operation in converted.toolpath.operations] == [1, 1]
    what = "the tool leaves the workpiece within an operation, for positions of the machine or to turn without TCP"
    assert [(remark.line, remark.what) for remark in remarks(converted)] == [(2, what)]


def test_frames_and_cycles_come_back_as_the_motion_that_they_make(programs: Programs) -> None:
    operation = programs.one("TRANS X10", "G0 X0 Y0 Z5 F100", "MCALL CYCLE81(5,0,2,-3)", "X1", "X2", "MCALL")
    assert set(operation.moves.tip[:, 0].tolist()) == {10.0, 11.0, 12.0}
    assert operation.moves.tip[:, 2].min() == -3.0


def test_an_arc_keeps_the_point_where_it_begins(programs: Programs) -> None:
    lines = "T1 M6", "G0 X0 Y0 Z0", "G1 X0 F100", "T2 M6", "G2 X10 Y0 Z0 I5 J0"
    _, operation = programs.all(*lines).toolpath.operations
    assert operation.moves.kind.tolist() == [Kind.LINEAR, Kind.ARC]
    assert operation.arcs.row.tolist() == [1]


def test_words_that_only_drive_the_machine_are_remarked_upon(programs: Programs) -> None:
    found = remarks(programs.all("G0 X0 Y0 Z0", "G64 SOFT", "G1 X1 F1", "COMPCAD", "X2"))
    assert [(remark.line, remark.what) for remark in found] == [
        (2, "G64 SOFT is not carried over"),
        (4, "COMPCAD is not carried over"),
    ]


def test_a_turn_under_an_upright_tool_is_remarked_upon(programs: Programs) -> None:
    found = remarks(programs.all("TRAORI", "G0 X0 Y0 Z0 B0 C0", "G1 X1 C90 F1", "X2"))
    assert [(remark.line, remark.what) for remark in found] == [
        (3, "other rotary positions than the tool axis gives at 2 points, the first in C")
    ]


@pytest.mark.parametrize(
    ("begin", "turn", "kept"),
    [
        ("B0 C0", "C90", 2),
        ("B0 C0", "X0 C90", 2),
        ("B0 C0", "C90 M8", 2),
        ("B0 C0", "C90 M9", 3),  # after the motion
        ("B0 C0", "X1 C90", 3),
        ("B30 C0", "B-30 C180", 3),  # the tool axis swings through +Z and back
        ("B30 C0", "C90", 3),
    ],
)
def test_a_turn_about_the_tool_axis_at_rest_is_no_point(programs: Programs, begin: str, turn: str, kept: int) -> None:
    operation = programs.one("TRAORI", f"G0 X0 Y0 Z0 {begin}", "; look", f"G1 {turn} F7", "; here", "X2")
    assert len(operation.moves) == kept
    assert operation.moves.tip[-1].tolist() == [2.0, 0.0, 0.0]
    assert operation.moves.feed.tolist()[1:] == [7.0] * (kept - 1)
    messages = [(event.row, event.text) for event in operation.events if isinstance(event, Message)]
    assert messages == [(1, "look"), (kept - 1, "here")]


def warnings_for(programs: Programs, *lines: str) -> list[tuple[int, str]]:
    """Line and text of the warnings."""
    return [(remark.line, remark.what) for remark in remarks(programs.all(*lines))]


@pytest.mark.parametrize(
    ("lines", "line", "what"),
    [
        (["G0 X0 Y0 Z0", "N20 G1 G64 X1 F1"], 2, "G64 is not carried over"),
        (["DYNFINISH", "G0 X0 Y0 Z0", "G1 X1 F1"], 1, "DYNFINISH is not carried over"),
        (["G0 X0 Y0 Z0", "FGROUP(X,Y,Z)", "G1 X1 F1"], 2, "FGROUP is not carried over"),
        (["G0 X0 Y0 Z0", "CYCLE832(0.1,_FINISH,1)", "G1 X1 F1"], 2, "CYCLE832 is not carried over"),
        (
            ["SUPA G0 Z300", "G0 X0 Y0 Z0", "G1 X1 F1"],
            1,
            "Z goes to the machine position 300, which is not carried over",
        ),
        (
            ["TRAORI", "ORIWKS", "ORIVECT", "G0 X0 Y0 Z0 B0 C0", "G1 X1 B30 F1"],
            5,
            "the tool turns on a great circle to 1 point, which is not carried over",
        ),
    ],
)
def test_what_a_toolpath_has_no_place_for_is_remarked_upon(
    lines: list[str], line: int, what: str, programs: Programs
) -> None:
    assert warnings_for(programs, *lines) == [(line, what)]


@pytest.mark.parametrize("harmless", ["; G64 SOFT", 'MSG("G64 SOFT")', "G17 G90 G40", "MSG()"])
def test_words_in_texts_and_those_said_anyhow_are_not_remarked_upon(harmless: str, programs: Programs) -> None:
    assert warnings_for(programs, "G0 X0 Y0 Z0", harmless, "G1 X1 F1") == []


def test_a_phase_without_motion_is_remarked_upon(programs: Programs) -> None:
    lines = [";Start of Path", "G0 X0 Y0 Z0", ";Engage Move", ";Cutting", "G1 X1 F1", ";Retract Move", ";End of Path"]
    assert warnings_for(programs, *lines) == [
        (3, "no motion follows 'Engage Move', which is not carried over"),
        (6, "no motion follows 'Retract Move', which is not carried over"),
    ]
    assert programs.one(*lines).moves.phase.tolist() == [Phase.INITIAL, Phase.CUT]


def test_words_of_a_subprogram_are_remarked_upon_in_its_file(programs: Programs) -> None:
    (programs.folder / "HOLE.SPF").write_text("G1 Z0 F10\nSOFT\nG0 Z5\nM17\n")
    (remark,) = remarks(programs.all("G0 X0 Y0 Z5", "HOLE"))
    assert (Path(remark.file).name, remark.line, remark.what) == ("HOLE.SPF", 2, "SOFT is not carried over")


@pytest.mark.parametrize(
    ("lines", "line", "what"),
    [
        (["G0 X0 Y0 Z0", "G96 S100 M3", "G1 X1 F1"], 2, "constant surface speed"),
        (["G0 X0 Y0 Z0", "SPOS=90", "G1 X1 F1"], 2, "the spindle stops at an angle"),
        (["G0 X0 Y0 Z0 D1", "G1 X1 F1", "D2", "X2"], 4, "D2 within an operation, which has D1"),
        (["G54", "G0 X0 Y0 Z0", "G55 G1 X1 F1"], 3, "G55 within an operation, which has G54"),
    ],
)
def test_what_must_not_be_lost_is_refused(lines: list[str], line: int, what: str, programs: Programs) -> None:
    found = [(error.line, error.what) for error in programs.all(*lines).errors]
    assert [each[0] for each in found] == [line]
    assert found[0][1].startswith(what)


def test_block_skip_has_no_place_in_a_program_with_jumps_and_compensation_has(programs: Programs) -> None:
    lines = "R1=0", "AGAIN:", "G41 G0 X=R1 Y0 Z0", "/G1 X9 F1", "G40 X10", "R1=R1+1", "IF R1<2 GOTOB AGAIN"
    found = programs.all(*lines)
    assert [(error.line, error.what) for error in found.errors] == [
        (4, "block skip signs in a program with jumps or subprograms: a toolpath cannot hold them")
    ]
    (operation,) = found.toolpath.operations
    sides = [(event.row, event.side) for event in operation.events if isinstance(event, CutterComp)]
    assert sides == [(0, "LEFT"), (2, "OFF"), (3, "LEFT"), (5, "OFF")]


def test_work_offsets_of_operations_go_by_their_names(programs: Programs) -> None:
    found = programs.all("T1 M6", "G54", "G0 X0 Y0 Z5", "G1 X1 F9", "T2 M6", "G55", "G0 X0 Y0 Z5", "G1 X1")
    assert found.settings["work_offset"] == "G54,TOOL_2:G55"
    assert found.errors == ()


def test_jumps_and_subprograms_are_followed(programs: Programs) -> None:
    (programs.folder / "HOLE.SPF").write_text("; hole\nG1 Z0 F10\nG0 Z5\nM17\n")
    operation = programs.one("G0 X0 Y0 Z5 M8", "R1=0", "AGAIN:", "HOLE", "R1=R1+1", "G0 X=R1", "IF R1<3 GOTOB AGAIN")
    assert len(operation.moves) == 10
    assert [event.row for event in operation.events if isinstance(event, Message)] == [1, 4, 7]


def test_files_of_others_convert(tmp_path: Path) -> None:
    files = sorted((SHARED / "data" / "sinumerik").glob("*.mpf"))
    if not files:
        pytest.skip("no files of others here")
    found = {file.name: convert(run_program(file, MACHINE), CONTROL) for file in files}
    # Some cut before X, Y and Z have been programmed, which is refused: nobody knows the workpiece zero here.
    whole = {name: converted.toolpath.operations for name, converted in found.items() if not converted.errors}
    assert whole
    for name, operations in whole.items():
        assert sum(len(operation.moves) for operation in operations) > 0, name
