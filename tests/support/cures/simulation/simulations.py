"""Cures of messages about programs that are simulated."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended, limited
from tests.support.simulating import HEAD, SLOT, STOCK, TOOL, cuboid, slotted
from trunnion.errors import TrunnionError
from trunnion.simulation.meshes import save_mesh
from trunnion.simulation.stock import solids
from trunnion.simulation.stock.surface import stock_surface

#: The head of a definition of one's own.
HEAD_OF_OURS: Final = 'schema = 1\nextends = "xyzac_trt"\nname = "Ours"\n'
_KLARTEXT: Final = (
    "0 BEGIN PGM PART MM\n1 TOOL CALL 1 Z S3000\n2 L X-20 Y+0 R0 FMAX M3\n3 L Z+20 FMAX\n4 L Z-5 FMAX\n"
    "5 L X+70 F500\n6 L Z+20 FMAX\n7 M30\n8 END PGM PART MM\n"
)
_DEFINED: Final = _KLARTEXT.replace("1 TOOL CALL", "1 TOOL DEF 1 L+110 R+5\n1 TOOL CALL")
_CL: Final = (
    "$$-> TRUNNION / 1\nUNITS/MM\n{head}TOOL PATH/A,TOOL,B\n$$-> TOOL / MILL,DIAMETER,10\nMSYS/0,0,0,1,0,0,0,1,0\n"
    "LOADTL/1\nRAPID\nGOTO/0,0,50\nEND-OF-PATH\nFINI\n"
)
_BLOCK: Final = "$$-> STOCK / BOX,60,40,10,0,-20,-10\n"
_SINUMERIK: Final = "T1 D1\nM6\nG54 G17 G90\nS3000 M3\nG0 X-20 Y0 Z20\nG0 Z-5\nG1 X70 F500\nG0 Z20\nM30\n"


def simulated(text: str, machine: str, folder: Path, **given: Any) -> Outcome:
    """Simulate a program; tools stand one behind the other in a text."""
    file = folder / "part.nc"
    file.write_text(text, encoding="utf-8")
    given = {"stock": STOCK, "tools": TOOL, "cell": 2.0, **given}
    numbers: dict[str, Any] = {
        name: float(given[name]) for name in ("cell", "accuracy", "turn", "tilt") if name in given
    }
    given = {**given, "tools": given["tools"].split(), **numbers}
    try:
        found = trunnion.simulate(file, machine=machine, **given)
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return Outcome(tuple(found.remarks), found.passed)


def on(machine: str = "xyzac_trt", **fixed: Any) -> Trial:
    """Return what simulates a program on a machine; settings are further arguments."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        return simulated(text, machine, folder, **{**fixed, **settings})

    return tried


def _saved(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Simulate a program, and write the stock as it leaves it."""
    (folder / "part.ngc").write_text(text.replace("Z-5", "Z-1"), encoding="utf-8")
    found = trunnion.simulate(folder / "part.ngc", machine="xyzac_trt", tools=[TOOL], cell=2.0, **settings)  # type: ignore[arg-type]
    return ended(lambda: save_mesh(stock_surface(found.simulation.stock), folder / "left.stl"))


_SLOT: Final = on()
SHORT: Final = "1=flat:10,length=30,flutes=20,holder=40x20"
#: A zero at which the stock stands on the table.
ABOVE_TABLE: Final = "-25,0,12"
_PLACED: Final = on(zero=ABOVE_TABLE, tool_length="50", tools=SHORT)
_TWO_TOOLS: Final = SLOT.replace("M5\nM30", "G49\nT2 M6\nG43 H2\nS1000 M3\nG0 X-20 Y10 Z-3\nG1 X70\nG0 Z20\nM5\nM30")
_BOTH: Final = on(tools=f"{TOOL} {TOOL.replace('1=', '2=', 1)}")
_PART: Final = on(part=slotted(5.0))
_MOVED_BY_TABLE: Final = SLOT.replace("N70 G0 Z20\n", "N70 G0 Z20\nG53 G0 Z0\n")
_ACROSS: Final = SLOT.replace("N70 G0 Z20", "N65 G1 X20\nN70 G53 G0 X20 Y60\nN80 G53 G0 Z0")
_SWIVEL: Final = SLOT.replace("N70 G0 Z20", "N70 G0 Z10\nN75 G0 A30\nN78 G0 A0\nN80 G0 Z20")


def _with_cl(*heads: str) -> Trial:
    """Return what simulates a program with CL files that have these lines in their heads."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        files = [folder / f"part{k}.apt" for k in range(len(heads))]
        for file, head in zip(files, heads, strict=True):
            file.write_text(_CL.format(head=head), encoding="utf-8")
        return simulated(text, "xyzac_trt", folder, **{"stock": None, "cl": files, **settings})

    return tried


def _line(code: str, variant: str, text: str, change: tuple[str, str], trial: Trial = _SLOT) -> Cure:
    return Cure(code, variant, trial, text, (change,))


CURES: Final = (
    Cure("SIM110", "missing", on(stock=None), SLOT, ({"stock": STOCK},)),
    Cure("SIM110", "stock_nowhere", _with_cl(""), SLOT, ({"stock": STOCK},)),
    Cure("SIM110", "two_stocks", _with_cl(_BLOCK, _BLOCK.replace("60", "61")), SLOT, ({"stock": STOCK},)),
    Cure("SIM114", "no_block", on(), SLOT, ({"until": "N60"},), {"until": "N99"}),
    Cure("SIM120", "mm_tool_mm", on(tools="1=flat:2,length=60,flutes=20"), SLOT, ({"cell": "1"},), {"cell": "2"}),
    Cure("SIM120", "cells_mm_take", limited(on(), solids, "MOST_BYTES", 1e5), SLOT, ({"cell": "1.4"},), {"cell": "1"}),
    Cure("SIM121", "coarser_than_cells", on(), SLOT, ({"accuracy": "1"},), {"accuracy": "1.2"}),
    Cure("SIM121", "coarser_than_cells", on(), SLOT, ({"cell": "3"},), {"accuracy": "1.2"}),
    Cure("SIM130", "reaches_mm_beyond", on(), SLOT, ({"zero": "-25,0,12"},), {"zero": "-900,0,12"}),
    Cure("SIM131", "reaches_mm_beyond_stock", _PART, SLOT, ({"stock": STOCK},), {"stock": "box:50,40,9,0,-20,-10"}),
    Cure(
        "SIM132",
        "missing_before_anything_is_cut",
        on(part=cuboid((-30, -30, -10), (30, 30, -5)), until=60),
        SLOT,
        ({"stock": "box:80,80,5,-40,-40,-10"},),
        {"stock": "cylinder:70,10,-10"},
    ),
    Cure("SIM133", "takes_nothing_from", on(), SLOT, ({"stock": STOCK},), {"stock": "box:50,40,10,0,90,-10"}),
    Cure("SIM140", "no_program_of_machine", on("yl569"), _KLARTEXT, (), cured_by=on("dmu65")),
    _line("SIM142", "", SLOT.replace("N70", "G777\nN70"), ("G777\n", "")),
    _line("SIM143", "block_feed_from", SLOT.replace("X-20 Y0 Z20", "Z20"), ("G0 Z20\nN50", "G0 X-20 Y0 Z20\nN50")),
    _line("SIM144", "crosses_tool_axis", _ACROSS, ("N70 G53", "G53 G0 Z0\nN70 G53")),
    Cure("SIM144", "swivels_beside_stock", on(), _SWIVEL, (("N75", "G53 G0 Z0\nN75"),)),
    Cure("SIM145", "machine_positions_taken", on(), _MOVED_BY_TABLE, (), cured_by=_PLACED),
    Cure("SIM145", "machine_positions_taken_retracts", on(zero="0,0,-100"), _MOVED_BY_TABLE, (), cured_by=_PLACED),
    Cure(
        "SIM148",
        "nothing_moves",
        on(),
        HEAD[: HEAD.index("G0 X")] + "M30\n",
        ((HEAD[: HEAD.index("G0 X")] + "M30\n", SLOT),),
    ),
    Cure(
        "SIM150",
        "cuts_before_first_tool",
        on(),
        SLOT.replace("T1 M6\nG43 H1\n", ""),
        (),
        cured_by=on(tools="0=ball:10"),
    ),
    Cure("SIM161", "works_edge_d", on("yl569"), _SINUMERIK.replace("D1", "D2"), (("D2", "D1"),)),
    _line("SIM160", "tool_cuts_length", SLOT.replace("H1", "H2").replace("M5\n", "T2 M6\nG49\n"), ("H2", "H1"), _BOTH),
    _line("SIM160", "cuts_length_tool", _TWO_TOOLS.replace("H2", "H1"), ("T2 M6\nG43 H1", "T2 M6\nG43 H2"), _BOTH),
    _line("SIM160", "cuts_without_tool", SLOT.replace("G43 H1\n", ""), ("T1 M6\n", "T1 M6\nG43 H1\n")),
    _line(
        "SIM162",
        "moves_tool_mm",
        _SINUMERIK.replace("G0 Z-5", "TOFF[3]=0.5\nG0 Z-5"),
        ("TOFF[3]=0.5\n", ""),
        on("yl569"),
    ),
    _line(
        "SIM162",
        "adds_mm_radius",
        _KLARTEXT.replace("S3000", "S3000 DR+0.5").replace("X+70", "X+70 RL"),
        (" DR+0.5", ""),
        on("dmu65"),
    ),
    _line("SIM163", "tool_def_gives", _DEFINED.replace("110", "100"), ("L+100", "L+110"), on("dmu65")),
    _line(
        "SIM163",
        "tool_def_gives_tool",
        _DEFINED.replace("R+5", "R+4").replace("X+70", "X+70 RL"),
        ("R+4", "R+5"),
        on("dmu65"),
    ),
    Cure("SIM310", "bodies_machine_not", on(), SLOT, (), cured_by=_PLACED),
    Cure("SIM161", "", on(), SLOT.replace("H1", "H5"), (("H5", "H1"),)),
    Cure("SIM155", "", on(tools="1=flat:10,length=60"), SLOT, (), cured_by=on()),
    Cure(
        "SIM310", "length_of_some_tools", _BOTH, _TWO_TOOLS, ({"tool_length": "1=110,2=85"},), {"tool_length": "1=110"}
    ),
    _line(
        "SIM143",
        "cuts_from_unknown",
        SLOT.replace("N60 G1", "G1 X10 F500\nG53 G0 Z0\nN60 G1"),
        ("N60 G1", "G0 X-20 Y0 Z20\nG0 Z-5\nN60 G1"),
    ),
    Cure("SIM219", "", _saved, SLOT, ({"stock": STOCK},), {"stock": "box:9,9,1,0,-4.5,0"}),
)
