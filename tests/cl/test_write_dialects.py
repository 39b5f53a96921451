"""What dialects other than NX's say in their own way, what they cannot say, and that a wrong word is found."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.cl_reading import Body, Read
from tests.support.locations import SHARED
from trunnion.cl import ClReading, read_cl
from trunnion.cl.read_back import read_back_problems
from trunnion.cl.write import write_cl
from trunnion.cl.writers import WRITERS
from trunnion.cl.writers.catia import CatiaWriter
from trunnion.errors import InputError
from trunnion.model.arcs import arc_gaps
from trunnion.model.toolpath import (
    CutterComp,
    Insert,
    Kind,
    Message,
    Operation,
    SpindleOn,
    Stop,
    Toolpath,
    UnknownStatement,
)

OTHERS = ("catia", "ncl")


def again(toolpath: Toolpath, dialect: str, folder: Path, *, inch: bool = False) -> tuple[Toolpath, list[str]]:
    """A toolpath that was written and read back without a difference, and what was lost."""
    path, sink = folder / "again", io.BytesIO()
    writer = WRITERS[dialect](toolpath, inch=inch)
    writer.write(sink)
    path.write_bytes(sink.getvalue())
    assert read_back_problems(writer.toolpath, path, dialect) == []
    return read_cl(path, ClReading(strict=True)), [remark.what for remark in writer.remarks]


def refused(dialect: str, *operations: Operation) -> str:
    """Why a toolpath cannot be written."""
    with pytest.raises(InputError) as caught:
        write_cl(Toolpath("a.cls", operations), io.BytesIO(), dialect=dialect)
    return str(caught.value)


@pytest.mark.third
@pytest.mark.parametrize("dialect", OTHERS)
@pytest.mark.parametrize(("k", "degrees"), [(k, degrees) for k in range(4) for degrees in (20, 175, 181, 300)])
def test_arcs_in_any_plane_and_of_any_angle(dialect: str, k: int, degrees: int, body: Body, tmp_path: Path) -> None:
    if k == 3:
        u, v = np.array([0.6, 0.8, 0.0]), np.array([-0.48, 0.36, 0.8])
    else:
        u, v = np.roll(np.eye(3)[0], k + 1), np.roll(np.eye(3)[1], k + 1)
    angle, centre = np.radians(degrees), np.array([5.0, -7.0, 2.0])
    for side in (1.0, -1.0):
        start, end = centre + 9.0 * u, centre + 9.0 * (np.cos(angle) * u + side * np.sin(angle) * v)
        normal = side * np.cross(u, v)
        numbers = ",".join(f"{value:.9f}" for value in (*centre, *normal, 9.0))
        points = [",".join(f"{value:.9f}" for value in point) for point in (start, end)]
        operation = body("FEDRAT/MMPM,100", f"GOTO/{points[0]},0.6,0,0.8", f"CIRCLE/{numbers}", f"GOTO/{points[1]}")
        back, _ = again(Toolpath("a", (operation,)), dialect, tmp_path)
        assert back.operations[0].moves.axis[-1].tolist() == pytest.approx([0.6, 0.0, 0.8])


@pytest.mark.parametrize("dialect", OTHERS)
def test_full_circles_become_halves(dialect: str, body: Body, tmp_path: Path) -> None:
    circle = ("CIRCLE/5,0,0,0,0,-1,5", "GOTO/0,0,0")
    lines = ("RAPID", "GOTO/0,0,0", "FEDRAT/MMPM,100", *circle, "COOLNT/ON", *circle, "GOTO/9,0,0", "STOP")
    back, lost = again(Toolpath("a", (body(*lines),)), dialect, tmp_path)
    (operation,) = back.operations
    assert operation.moves.tip.tolist() == [[0, 0, 0], [10, 0, 0], [0, 0, 0], [10, 0, 0], [0, 0, 0], [9, 0, 0]]
    assert operation.moves.kind.tolist() == [Kind.RAPID, *[Kind.ARC] * 4, Kind.LINEAR]
    assert [event.row for event in operation.events] == [3, 6]
    assert arc_gaps(operation.arcs, operation.moves.tip).tolist() == [10, 10, 10, 10]
    assert any("2 full circles become two arcs each" in what for what in lost)


@pytest.mark.parametrize("dialect", OTHERS)
@pytest.mark.parametrize(
    ("lines", "why"),
    [
        (("GOTO/0,0,0", "CIRCLE/5,0,0,0,0,1,5", "GOTO/10,0,3"), "a.cls:6: error: a helix"),
        (("GOTO/0,0,0", "CIRCLE/5,0,0,0,0,1,5,TIMES,2", "GOTO/10,0,0"), "several turns"),
        (("CYCLE/BORE,NODRAG,90,RAPTO,3,FEDTO,-5,MMPM,10", "GOTO/0,0,0"), "a.cls:3: error: CYCLE with NODRAG"),
        (("CYCLE/TAP,RAPTO,3,FEDTO,-5,MMPR,1,OPTION", "GOTO/0,0,0"), "CYCLE with OPTION,"),
        (("CYCLE/DRILL,CSINK,CSKDIA,8,TLANGL,90,RAPTO,3,MMPM,10", "GOTO/0,0,0"), "CSKDIA and TLANGL"),
        (("CYCLE/DRILL,RAPTO,3,MMPM,10", "GOTO/0,0,0"), "CYCLE without FEDTO"),
    ],
)
def test_motion_that_a_dialect_cannot_say_is_an_error(
    dialect: str, lines: tuple[str, ...], why: str, body: Body
) -> None:
    operation = body("FEDRAT/MMPM,100", *lines) if lines[0].startswith("GOTO") else body(*lines)
    assert why in refused(dialect, operation).replace("/a.cls", "a.cls")


def test_what_only_one_dialect_cannot_say(body: Body, tmp_path: Path) -> None:
    turning = body("FEDRAT/MMPM,100", "GOTO/0,0,0", "CIRCLE/5,0,0,0,0,1,5", "GOTO/10,0,0,0,0.6,0.8")
    assert "a.cls:6: error: the tool axis turns along an arc" in refused("catia", turning)
    again(Toolpath("a", (turning,)), "ncl", tmp_path)
    clearing = body("CYCLE/DRILL,RAPTO,3,FEDTO,-5,RTRCTO,AUTO,MMPM,10", "GOTO/0,0,0")
    assert "RTRCTO,AUTO" in refused("catia", clearing)
    again(Toolpath("a", (clearing,)), "ncl", tmp_path)


@pytest.mark.parametrize("dialect", OTHERS)
def test_a_feed_of_the_operation_before_is_not_taken_over(dialect: str, body: Body, tmp_path: Path) -> None:
    first, second = body("FEDRAT/MMPM,100", "GOTO/0,0,0"), body("GOTO/1,0,0")
    assert "OP cuts before it has a feed" in refused(dialect, first, second)
    holes = body("CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,10", "GOTO/1,0,0", "CYCLE/OFF")
    for operations in ((second, second), (first, holes)):
        again(Toolpath("a", operations), dialect, tmp_path)


@pytest.mark.parametrize("dialect", OTHERS)
def test_behind_gohome_the_name_goes_on(dialect: str, body: Body, tmp_path: Path) -> None:
    one = body("INTOL/0.01", "FEDRAT/MMPM,100", "GOTO/0,0,0", "GOHOME", "RAPID", "GOTO/1,0,0", "GOHOME")
    two = body("FEDRAT/MMPM,100", "GOTO/2,0,0")
    back, lost = again(Toolpath("a", (one, two)), dialect, tmp_path)
    names = [operation.name for operation in back.operations]
    assert names == (["OP"] * 3 if dialect == "catia" else ["FEATNO 1", "FEATNO 1", "FEATNO 2"])
    assert any("OP states no tolerance" in what for what in lost)


@pytest.mark.parametrize("dialect", OTHERS)
def test_compensation_ends_with_its_operation(dialect: str, body: Body, tmp_path: Path) -> None:
    on = body("RAPID", "GOTO/0,0,0", "CUTCOM/LEFT", "FEDRAT/MMPM,100", "GOTO/1,0,0")
    for begin in ((), ("RAPID",)):  # one operation with the one before, and one of its own
        after = body("FEDRAT/MMPM,100", *begin, "GOTO/2,0,0", "FEDRAT/MMPM,100", "GOTO/3,0,0")
        back, _ = again(Toolpath("a", (on, after)), dialect, tmp_path)
        sides = [(event.row, event.side) for event in back.operations[0].events if isinstance(event, CutterComp)]
        assert sides == [(1, "LEFT"), (2, "OFF")]
        for other in WRITERS:
            again(back, other, tmp_path)
    home = body("CUTCOM/RIGHT", "FEDRAT/MMPM,100", "GOTO/0,0,0", "GOHOME", "RAPID", "GOTO/1,0,0")
    assert "a.cls:6: error: CUTCOM/RIGHT is on at GOHOME" in refused(dialect, home)


@pytest.mark.parametrize("dialect", OTHERS)
def test_coordinate_systems_become_that_of_the_first_operation(dialect: str, read: Read, tmp_path: Path) -> None:
    one = "TOOL PATH/{},TOOL,T\nMSYS/{}\nFEDRAT/MMPM,100\nRAPID\nGOTO/1,2,3,0,0,1\nEND-OF-PATH\n"
    text = one.format("A", "10,0,0,1,0,0,0,1,0") + one.format("B", "10,0,5,0,1,0,0,0,1")
    back, lost = again(read(text), dialect, tmp_path)
    tips = [operation.moves.tip[0].tolist() for operation in back.operations]
    assert tips == [[1, 2, 3], [3, 1, 7]]
    assert back.operations[1].moves.axis[0].tolist() == [1, 0, 0]
    assert any("coordinate systems of their own" in what for what in lost)


def test_a_coordinate_system_stays_in_its_dialect(read: Read, tmp_path: Path) -> None:
    rows = "0,1,0,5.5, -1,0,0,6, 0,0,1,7"
    toolpath = read(f"UNITS/MM\n$$-> CSYS / {rows}\nFEDRAT/100,MMPM\nGOTO/1,2,3\nFINI\n")
    back, lost = again(toolpath, "ncl", tmp_path, inch=True)
    assert back.system == pytest.approx(toolpath.system)
    assert toolpath.system[3] == 5.5
    assert len(lost) == 1
    for other in ("catia", "clsf"):
        assert any("in that of the model is not carried over" in what for what in again(toolpath, other, tmp_path)[1])
    matrix = "$$*CATIA0\n$$ A\n$$ 0 1 0 5.5\n$$ -1 0 0 6\n$$ 0 0 1 7\nFEDRAT/100,MMPM\nMULTAX\nGOTO/1,2,3,0,0,1\nFINI\n"
    assert again(read(matrix), "catia", tmp_path)[0].system == toolpath.system


@pytest.mark.parametrize("dialect", [*OTHERS, "clsf"])
def test_unknown_statements_stay_whole_and_unknown(dialect: str, body: Body, tmp_path: Path) -> None:
    operation = body("COOLNT/FLOOD,HIGH", "AUXFUN/27,$", "  NOW", "FEDRAT/MMPM,100", "GOTO/0,0,0")
    sink = io.BytesIO()
    write_cl(Toolpath("a", (operation,)), sink, dialect=dialect)
    path = tmp_path / "again"
    path.write_bytes(sink.getvalue())
    events = read_cl(path).operations[0].events
    unknown = [event for event in events if isinstance(event, UnknownStatement)]
    assert [event.text for event in unknown] == ["COOLNT/FLOOD,HIGH", "AUXFUN/27,NOW"]
    assert len(events) == len(unknown) + 1


@pytest.mark.parametrize("dialect", [*OTHERS, "clsf"])
def test_texts_names_and_registers_survive(dialect: str, read: Read, tmp_path: Path) -> None:
    text = (
        "PARTNO/A PART $\nTOOL PATH/零件 1,TOOL,MILL 6\nTLDATA/MILL,6,3,50,0,0\nLOAD/TOOL,7,ADJUST,12\nSELECT/TOOL,8\n"
        "INTOL/0.03\nOUTTOL/0.01\nFROM/0,0,99,0,0.6,0.8\nPPRINT/'quoted'\nDISPLY/'SHOWN'\nINSERT/  G4 F1\n"
        "CUTCOM/LEFT,ZXPLAN,5\nSTOP/look\nOPSTOP\nOPSKIP/ON\nDELAY/3,REV\nSPINDL/RPM,1234.5,CCLW\nFEDRAT/MMPR,0.1\n"
        "GOTO/0,0,9\nRAPID\nGOTO/1,1,9\nGOHOME\nEND-OF-PATH\n"
    )
    back, lost = again(read(text), dialect, tmp_path, inch=dialect == "ncl")
    (operation,) = back.operations
    assert (back.part, operation.tool.name) == ("A PART $", "MILL 6")
    assert (operation.intol, operation.outtol) == pytest.approx((0.03, 0.01))
    assert operation.name == ("FEATNO 1" if dialect == "ncl" else "零件 1")
    assert lost == (["names of 1 operation become numbers: Creo NCL has no names"] if dialect == "ncl" else [])


def test_a_dollar_sign_in_the_last_column_stays_one_of_its_text(read: Read, tmp_path: Path) -> None:
    text = "x" * 64 + "$"
    lines = f"PARTNO/{text}\nTOOL PATH/A,TOOL,{text}\nLOAD/TOOL,7\nPPRINT/{text}\nINSERT/{text}\n"
    toolpath = read(f"{lines}STOP/xx{text}\nGOTO/0,0,9\nGOTO/0,0,8\nEND-OF-PATH\n")
    back, _ = again(toolpath, "catia", tmp_path)
    assert (back.part, back.operations[0].tool.name) == (text, text)
    before, after = (
        [replace(event, line=0) for event in each.operations[0].events if isinstance(event, Message | Insert | Stop)]
        for each in (toolpath, back)
    )
    assert before == after


def test_holders_and_lengths_in_the_spindle(read: Read, tmp_path: Path) -> None:
    head = "UNITS/MM\n$$-> CUTTER / 8\nTPRINT/MILL 8,HSK 63\nLOADTL/3,LENGTH,121.5,OSETNO,4\n"
    text = head + "FEDRAT/9,MMPM\nGOTO/1,2,3\nFINI\n"
    toolpath = read(text)
    for dialect in OTHERS:
        back, lost = again(toolpath, dialect, tmp_path)
        tool, (load,) = back.operations[0].tool, back.operations[0].events
        assert (tool.name, tool.holder, tool.set_length) == ("MILL 8", "HSK 63", 121.5)
        assert (load.number, load.adjust) == (3, 4)  # type: ignore[attr-defined]
        assert not any("tool" in what for what in lost)
    assert again(toolpath, "clsf", tmp_path)[1] == ["tool MILL 8: holder, length in the spindle not carried over"]


def test_losses_that_move_nothing_are_remarked_upon(read: Read, tmp_path: Path) -> None:
    text = (
        "TOOL PATH/A,TOOL,DRILL, LONG\nTLDATA/DRILL,6,0,50,118,35\nMSYS/1,2,3,1,0,0,0,1,0\nPAINT/COLOR,42\n"
        "FEDRAT/MMPM,100\nGOTO/1,2,3\nEND-OF-PATH\n"
    )
    back, lost = again(read(text), "catia", tmp_path)
    said = "\n".join(lost)
    for word in ("MSYS", "phases of motion", "flute length, name behind the comma not carried over"):
        assert word in said
    assert back.operations[0].tool.kind == "DRILL"
    assert back.operations[0].tool.tip_angle == pytest.approx(118.0)


@pytest.mark.parametrize("dialect", ["catia", "ncl"])
@pytest.mark.parametrize("load", ["", "LOAD/TOOL,1\n", "LOAD/TOOL,2\n"])
def test_a_tool_without_a_form_behind_one_with_a_form_keeps_none(
    dialect: str, load: str, read: Read, tmp_path: Path
) -> None:
    first = "TOOL PATH/A,TOOL,T10\nTLDATA/MILL,10,0,50,0,0\nLOAD/TOOL,1\nFEDRAT/MMPM,100\nGOTO/1,2,3\nEND-OF-PATH\n"
    second = f"TOOL PATH/B,TOOL,T8\n{load}FEDRAT/MMPM,100\nGOTO/2,2,3\nEND-OF-PATH\n"
    back, _ = again(read(first + second + first.replace("/A", "/C")), dialect, tmp_path)
    assert [(each.tool.kind, each.tool.diameter) for each in back.operations] == [
        ("MILL", 10.0), ("UNKNOWN", 0.0), ("MILL", 10.0)
    ]  # fmt: skip


def test_a_second_tool_of_an_operation_is_refused_where_it_would_begin_another(body: Body, tmp_path: Path) -> None:
    operation = body("LOAD/TOOL,1", "FEDRAT/MMPM,100", "GOTO/0,0,0", "LOAD/TOOL,2", "GOTO/1,0,0")
    back, _ = again(Toolpath("a", (operation,)), "clsf", tmp_path)
    assert len(back.operations) == 1
    assert "a.cls:6: error: OP loads a second tool" in refused("catia", operation)


@pytest.mark.parametrize(
    ("fault", "what"),
    [
        (lambda text: text.replace("SPINDL/ 500", "SPINDL/ 501"), "statement: SpindleOn 501"),
        (lambda text: text.replace("1.000000, 2.0", "1.000000, 2.1"), "position"),
        (lambda text: text.replace("0.600000000000", "-0.600000000000"), "tool axis"),
        (lambda text: text.replace("RAPID\n", ""), "kind of motion"),
        (lambda text: text.replace("100.0000, MMPM", "101.0000, MMPM"), "feed"),
        (lambda text: text.replace("COOLNT/ ON\n", ""), "Coolant OFF instead of Coolant ON"),
        (lambda text: text.replace("FINI", "COOLNT/MIST\nFINI"), "Coolant MIST is added"),
        (lambda text: text.replace("CUTTER/ 10", "CUTTER/ 12"), "tool diameter"),
        (lambda text: text.replace("INDIRV/ 0.000000000000, -", "INDIRV/ 0.000000000000, "), "normal of an arc"),
        (lambda text: text.replace("GOTO  / 1", "GOTO  / 1, 2, 3\nGOTO  / 1"), "number of points"),
        (lambda text: text.replace("MULTAX", "ROTABL/1"), "could not be read"),
        (lambda text: text.replace("$$ OPERATION NAME", "$$ NAME"), "taken for APT"),
    ],
)  # fmt: skip
def test_a_wrong_file_is_found(fault: object, what: str, body: Body, tmp_path: Path) -> None:
    operation = body(
        "SPINDL/RPM,500,CLW", "COOLNT/ON", "RAPID", "GOTO/1,2,3,0.6,0,0.8", "FEDRAT/MMPM,100", "GOTO/0,0,0",
        "CIRCLE/5,0,0,0,0,1,5", "GOTO/10,0,0", "COOLNT/OFF", "GOTO/1,1,1",
    )  # fmt: skip
    path, sink = tmp_path / "again", io.BytesIO()
    writer = CatiaWriter(Toolpath("a", (operation,)))
    writer.write(sink)
    text = sink.getvalue().decode()
    wrong = fault(text)  # type: ignore[operator]
    assert wrong != text
    path.write_text(wrong, encoding="utf-8")
    found = read_back_problems(writer.toolpath, path, "catia")
    assert any(what in problem.what for problem in found), found


def test_a_wrong_writer_is_found(body: Body, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = CatiaWriter.spindle
    monkeypatch.setattr(CatiaWriter, "spindle", lambda self, event: own(self, replace(event, rpm=event.rpm + 1)))
    writer, sink = CatiaWriter(Toolpath("a", (body("SPINDL/RPM,9,CLW", "FEDRAT/MMPM,1", "GOTO/0,0,0"),))), io.BytesIO()
    writer.write(sink)
    (tmp_path / "again").write_bytes(sink.getvalue())
    (problem,) = read_back_problems(writer.toolpath, tmp_path / "again", "catia")
    assert problem.line == 3
    assert "SpindleOn 10.0 CLW instead of SpindleOn 9.0 CLW" in problem.what
    assert isinstance(writer.toolpath.operations[0].events[0], SpindleOn)


def test_a_stated_speed_reads_back_as_one_of_the_file(body: Body, tmp_path: Path) -> None:
    operation = body("SPINDL/RPM,9,CLW", "FEDRAT/MMPM,1", "GOTO/0,0,0")
    stated = tuple(replace(each, stated=True) if isinstance(each, SpindleOn) else each for each in operation.events)
    writer, sink = CatiaWriter(Toolpath("a", (replace(operation, events=stated),))), io.BytesIO()
    writer.write(sink)
    (tmp_path / "again").write_bytes(sink.getvalue())
    assert not [*read_back_problems(writer.toolpath, tmp_path / "again", "catia")]


FILES = sorted(path for each in ("creo", "nx", "solidworks") for path in (SHARED / "data" / each).glob("*"))


@pytest.mark.skipif(not FILES, reason="the files of others are not beside the project")
@pytest.mark.parametrize("dialect", WRITERS)
def test_real_files_read_back_in_every_dialect(dialect: str, tmp_path: Path) -> None:
    for path in FILES:
        again(read_cl(path), dialect, tmp_path)
