"""Cures of messages about tools that CL files describe."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended
from trunnion.simulation.tools.choice import choose_tools, tools_of_toolpaths
from trunnion.simulation.tools.cl_tools import cl_tool_shape
from trunnion.simulation.tools.text import parse_tool

_OPERATION: Final = "TOOL PATH/A,TOOL,R5\nTLDATA/MILL,10,1,60,0,0\nLOADTL/3\nGOTO/0,0,0\nEND-OF-PATH\n"
_STATED: Final = "=ball:10,length=60,flutes=20"


def _chosen(called: str = "3", *, stated: bool = False) -> Trial:
    """Return what has a tool of a program sought in a CL file, and before it in what is stated."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        file = folder / "part.cls"
        file.write_text(text, encoding="utf-8")
        own = [parse_tool(called + _STATED)] if stated else []
        toolpath = trunnion.read_cl(file)
        return ended(lambda: choose_tools([called], own, [], tools_of_toolpaths([toolpath])))

    return tried


def _shaped(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Make the tool of a CL file a body, which no program calls; one that states it has a kind and sizes."""
    file = folder / "part.cls"
    file.write_text(text, encoding="utf-8")
    tool = trunnion.read_cl(file).operations[0].tool
    return ended(lambda: cl_tool_shape(tool, None, file=str(file), line=1))


def _tool(code: str, variant: str, text: str, called: str = "3") -> Cure:
    """A tool that cannot be used as the CL file has it, and is stated in its place."""
    return Cure(code, variant, _chosen(called), text, (), cured_by=_chosen(called, stated=True))


_TAPERED: Final = _OPERATION.replace("10,1,60,0,0", "10,1,60,3,0")
_TWICE: Final = _OPERATION + _OPERATION.replace("10,1,60", "12,1,60").replace("PATH/A", "PATH/B")
_TOO_SHORT: Final = _OPERATION.replace("MILL,10,1,60,0,0", "DRILL,20,0,5,90,5")

_NAMELESS: Final = _TAPERED.replace("TOOL,R5", "TOOL").replace("LOADTL/3\n", "")

CURES: Final = (
    _tool("SIM152", "of_cl_file", _TOO_SHORT),
    Cure("SIM152", "of_cl_file", _chosen(), _TOO_SHORT, (("20,0,5,90", "20,0,60,90"),)),
    _tool("SIM154", "tool", _TAPERED),
    _tool("SIM154", "unsettled_tool", _TAPERED.replace("LOADTL/3\n", ""), "R5"),
    _tool("SIM151", "tool_another_one", _TWICE),
    Cure("SIM151", "tool_another_one", _chosen(), _TWICE, (("12,1,60,0,0\nLOADTL/3", "12,1,60,0,0\nLOADTL/4"),)),
    Cure("SIM154", "unsettled_own_tool", _shaped, _NAMELESS, (), cured_by=_chosen(stated=True)),
)
