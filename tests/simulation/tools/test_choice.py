"""Which body a tool that a program calls has: stated tools, libraries, CL files, in this order."""

from dataclasses import replace
from pathlib import Path

import pytest

from trunnion.cl import read_cl
from trunnion.errors import InputError, Problem
from trunnion.messages import foreign
from trunnion.model.toolpath import Tool
from trunnion.simulation.tools.choice import ClTool, choose_tools, tools_of_toolpaths
from trunnion.simulation.tools.library import LibraryTool, ToolLibrary, UnusableTool
from trunnion.simulation.tools.shapes import ToolKind, ToolSizes, ball, flat
from trunnion.simulation.tools.text import parse_tool

BALL, FLAT = replace(ball(10.0), number=3), replace(flat(8.0), number=3, name="END_8")
LIBRARY = ToolLibrary("shop.toml", (LibraryTool(ToolSizes(ToolKind.FLAT, 8.0), 3, "END_8"),))
MILL = ClTool(3, Tool("MILL", "B6", 6.0, 3.0, 50.0), "part.cls", 7, "clsf")


def test_what_is_stated_comes_before_libraries_and_these_before_cl_files() -> None:
    assert choose_tools(["3"], [BALL], [LIBRARY], [MILL]) == {"3": BALL}
    assert choose_tools(["3"], [], [LIBRARY], [MILL]) == {"3": FLAT}
    assert choose_tools(["3"], [], [], [MILL])["3"].sections == ball(6.0, length=50.0).sections


def test_tools_are_called_by_number_with_zeros_or_by_name() -> None:
    found = choose_tools(["", "003", "END_8", "B6"], [], [LIBRARY], [MILL])
    assert (found["003"], found["END_8"], found["B6"].name) == (FLAT, FLAT, "B6")
    assert "" not in found


def test_all_that_nothing_describes_is_told_at_once() -> None:
    table = ToolLibrary("tool.tbl", diameters={5: 12.0})
    broken = UnusableTool(6, "", (Problem("shop.tools", 0, foreign("tool 6: odd", "state it")),))
    with pytest.raises(InputError) as raised:
        choose_tools(["4", "5", "6", "7"], [], [table, ToolLibrary("shop.tools", (), (broken,))], [])
    assert [str(problem) for problem in raised.value.problems] == [
        "tools: error: nothing says the form of tool 4, which the program calls; "
        "state it, such as 4=ball:10,length=60,flutes=20, or give a tool library that has it [SIM150]",
        "tool.tbl: error: tool 5 has a diameter of 12 mm, and nothing says its form; "
        "state its kind: 5=ball takes the diameter from the table [SIM150]",
        "shop.tools: error: tool 6: odd; state it",
        "tools: error: nothing says the form of tool 7, which the program calls; "
        "state it, such as 7=ball:10,length=60,flutes=20, or give a tool library that has it [SIM150]",
    ]
    shape = parse_tool("5=ball", table.diameters)
    assert choose_tools(["5"], [shape], [table]) == {"5": shape}


def test_two_tools_of_one_number_are_not_chosen_from() -> None:
    with pytest.raises(InputError, match="tool 3 is stated 2 times; state it once"):
        choose_tools(["3"], [BALL, FLAT])
    other = MILL._replace(tool=replace(MILL.tool, corner_radius=1.0), line=90)
    with pytest.raises(InputError, match=r"part\.cls:90: error: tool 3 is another one in line 7 of part\.cls"):
        choose_tools(["3"], [], [], [MILL, other])


def test_the_tools_of_a_cl_file_have_the_numbers_that_load_them(tmp_path: Path) -> None:
    file = tmp_path / "part.cls"
    operations = (
        ("ONE", "B10", "TLDATA/MILL,10.0,5.0,70.0,0.0,0.0\nLOAD/TOOL,3"),
        ("TWO", "B10", "TLDATA/MILL,10.0,5.0,70.0,0.0,0.0"),
        ("THREE", "F8", "TLDATA/MILL,8.0,0.0,60.0,0.0,0.0\nLOAD/TOOL,4"),
    )
    text = "".join(
        f"TOOL PATH/{name},TOOL,{tool}\n{words}\nMSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0\n"
        "RAPID\nGOTO/0.0,0.0,50.0,0.0,0.0,1.0\nEND-OF-PATH\n"
        for name, tool, words in operations
    )
    file.write_text(text, encoding="utf-8")
    found = tools_of_toolpaths([read_cl(file)])
    assert [(each.number, each.tool.name, each.tool.diameter) for each in found] == [
        (3, "B10", 10.0), (3, "B10", 10.0), (4, "F8", 8.0),
    ]  # fmt: skip
    shapes = choose_tools(["3", "4"], [], [], found)
    assert shapes["3"].sections == ball(10.0, length=70.0).sections
    assert shapes["4"].sections == flat(8.0, length=60.0).sections
