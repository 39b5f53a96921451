"""Tools as CL files describe them: one model, whatever the dialect writes."""

from pathlib import Path

import pytest

import trunnion
from trunnion.cl import ClReading, read_cl
from trunnion.cli import main
from trunnion.model.toolpath import Tool

HEADS = {
    "apt": "PARTNO A\nUNITS/MM\n",
    "ncl": "$$* Pro/CLfile Version 8.0\nUNITS / MM\n",
    "solidworks": "PARTNO/1\nUNIT/MM\nTRNTYP/WORLD,0,0,0\n",
    "catia": "$$ CATIA APT VERSION 1.0\n",
    "clsf": "TOOL PATH/A,TOOL,MILL_10\n",
}
MILL = Tool("MILL", "", 10.0, 1.0, 50.0, taper_angle=2.0)
SEVEN = "CUTTER/10,1,4,1,0,2,50\n"


def tools(tmp_path: Path, dialect: str, text: str) -> list[Tool]:
    file = tmp_path / "part.txt"
    file.write_text(HEADS[dialect] + text + ("END-OF-PATH\n" if dialect == "clsf" else "FINI\n"), encoding="utf-8")
    toolpath = read_cl(file, ClReading(dialect=dialect))
    assert toolpath.remarks == ()
    return [operation.tool for operation in toolpath.operations]


@pytest.mark.parametrize(
    ("dialect", "text", "expected"),
    [
        ("apt", SEVEN + "LOADTL/5,LENGTH,120.5\n", {"set_length": 120.5}),
        ("apt", SEVEN + "LOADTL/5,0,80,3\n", {"set_length": 80.0}),
        ("apt", "LOADTL/5,LENGTH,90\n" + SEVEN, {"set_length": 90.0}),
        ("catia", SEVEN + "TPRINT/T1 Mill D 10\nLOADTL/5\nLOADTL/5,1\n", {"name": "T1 Mill D 10"}),
        ("catia", SEVEN + "TPRINT/A,B,C\nLOADTL/5\n", {"name": "A", "holder": "B, C"}),
        ("catia", SEVEN + "TPRINT/A,B,B\nLOADTL/5\n", {"name": "A", "holder": "B"}),
        (
            "solidworks",
            "INSERT/[HOLDER=C40-M20EM3] 20MM CRB 2FL\n" + SEVEN + "LOAD/TOOL,5\nCSI_SET_FLUTE_LENGTH/38.\n"
            "CSI_SET_EXTENSION_LENGTH/60.\n",
            {"name": "20MM CRB 2FL", "holder": "C40-M20EM3", "flute_length": 38.0, "extension": 60.0},
        ),
        ("solidworks", "INSERT/50MM FACE MILL\n" + SEVEN + "LOAD/TOOL,5\n", {"name": "50MM FACE MILL"}),
        ("clsf", SEVEN, {"name": "MILL_10"}),
        ("clsf", "TLDATA/MILL,10,1,50,2,0\nCUTTER/10,0\n", {"name": "MILL_10"}),
        ("clsf", "CUTTER/10,0\nTLDATA/MILL,10,1,50,2,0\n", {"name": "MILL_10"}),
    ],
    ids=[
        "length", "length by place", "length before the form", "catia", "assembly and holder", "holder", "solidworks",
        "solidworks without holder", "cutter in a clsf", "tldata counts", "tldata counts after it",
    ],
)  # fmt: skip
def test_all_that_a_file_says_of_a_tool_is_kept(
    tmp_path: Path, dialect: str, text: str, expected: dict[str, object]
) -> None:
    (tool,) = tools(tmp_path, dialect, text + "GOTO/1,2,3\n")
    sizes = {field: getattr(MILL, field) for field in MILL.__slots__} | expected
    assert {field: getattr(tool, field) for field in tool.__slots__} == sizes


def test_another_tool_has_nothing_of_the_one_before(tmp_path: Path) -> None:
    text = SEVEN + "TPRINT/A,B\nLOADTL/5,LENGTH,80\nGOTO/1,2,3\nLOADTL/6\nGOTO/4,5,6\n"
    assert tools(tmp_path, "catia", text)[1] == Tool()


def test_lengths_are_in_mm_and_info_shows_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "part.apt"
    text = "PARTNO/1\nUNIT/INCHES\nTRNTYP/WORLD,0,0,0\nINSERT/[HOLDER=H1] MILL\nCUTTER/1.,0\n"
    file.write_text(text + "LOAD/TOOL,5,LENGTH,4.\nCSI_SET_EXTENSION_LENGTH/2.\nGOTO/1,2,3\nFINI\n", encoding="utf-8")
    (tool,) = trunnion.describe_cl(file).tools
    assert (tool.holder, tool.diameter, tool.extension, tool.set_length) == ("H1", 25.4, 50.8, 101.6)
    assert main(["info", str(file)]) == 0
    assert "T5 MILL  MILL d 25.4 stands out 50.8 length in the spindle 101.6; holder H1;" in capsys.readouterr().out


BARREL = "10,85,-80,20,0,0,50"


@pytest.mark.parametrize(
    ("dialect", "text"),
    [
        ("apt", f"CUTTER/{BARREL}\nLOADTL/5\n"),
        ("catia", f"CUTTER/{BARREL}\nLOADTL/5\n"),
        ("ncl", f"$$-> CUTTER / {BARREL}\nLOADTL / 5\n"),
        ("solidworks", f"CUTTER/{BARREL}\nLOAD/TOOL,5\n"),
        ("clsf", "TLDATA/MILL,10,85,50,0,0,-80,20\n"),
        ("clsf", f"CUTTER/{BARREL}\n"),
    ],
)
def test_the_centre_of_a_corner_is_kept_and_written(tmp_path: Path, dialect: str, text: str) -> None:
    (tool,) = tools(tmp_path, dialect, text + "RAPID\nGOTO/1,2,3\n")
    assert (tool.corner_radius, tool.corner_centre) == (85.0, (-80.0, 20.0))
    for written in ("clsf", "catia", "ncl"):
        folder = tmp_path / written
        folder.mkdir()
        trunnion.convert(tmp_path / "part.txt", to_cl=True, to_dialect=written, output=folder / "again.cls")
        assert read_cl(folder / "again.cls").operations[0].tool.corner_centre == (-80.0, 20.0)


def test_a_second_corner_is_kept_and_written_with_its_centre(tmp_path: Path) -> None:
    (tool,) = tools(tmp_path, "clsf", "TLDATA/BARREL,10,1,50,0,0,4,1,85,-80,20\nGOTO/1,2,3\n")
    assert (tool.corner_centre, tool.upper_radius, tool.upper_centre) == (None, 85.0, (-80.0, 20.0))


@pytest.mark.parametrize(
    ("dialect", "text", "line"),
    [
        ("clsf", "TLDATA/MILL,10,7,75,0,0\n", 2),
        ("apt", "LOADTL/5\nCUTTER/10,7\n", 4),
        ("catia", "CUTTER/10,7\nLOADTL/5\n", 2),
        ("ncl", "LOADTL / 5\n$$-> CUTTER / 10, 7\n", 4),
        ("solidworks", "CUTTER/10,7\nLOAD/TOOL,5\n", 4),
    ],
)
def test_an_impossible_tool_is_refused_with_its_line(tmp_path: Path, dialect: str, text: str, line: int) -> None:
    with pytest.raises(trunnion.InputError) as caught:
        tools(tmp_path, dialect, text + "GOTO/1,2,3\n")
    (problem,) = caught.value.problems
    assert (problem.line, "more than half its diameter" in problem.what) == (line, True)
