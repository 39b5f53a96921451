"""Cures of messages about CL files: more of what NX writes, each by the lines that go out and come in."""

from typing import Final

from tests.support.cures.cure import Cure, marked, read
from tests.support.posting import CLEAR, FOOT, HEAD


def _nx(message: str, *lines: str, **settings: str) -> Cure:
    """Lines behind the first cut."""
    return marked(message, read, *lines, head=HEAD, foot=FOOT, **settings)


def _file(message: str, *lines: str, **settings: str) -> Cure:
    """All lines of a file."""
    return marked(message, read, *lines, **settings)


def _holes(message: str, *lines: str) -> Cure:
    """A cycle and what belongs to it, with two holes behind it."""
    return marked(message, read, *lines, head=CLEAR, foot=f"GOTO/50,0,0\nGOTO/60,0,0\nCYCLE/OFF\n{FOOT}")


def _motion(message: str, cycle: str) -> Cure:
    """A cycle, and its hole as motion in its place."""
    motion = ("GOTO/50,0,3", "FEDRAT/MMPM,100", "GOTO/50,0,-10", "RAPID", "GOTO/50,0,50")
    return marked(
        message, read, f"- {cycle}", "- GOTO/50,0,0", "- CYCLE/OFF", *(f"+ {line}" for line in motion), head=CLEAR,
        foot=FOOT,
    )  # fmt: skip


def _tool(message: str, wrong: str, cured: str, settings: str = "") -> Cure:
    """The sizes of a tool."""
    rest = HEAD.partition("TLDATA/")[2].partition("\n")[2]
    return marked(message, read, f"- {wrong}", f"+ {cured}", head="TOOL PATH/OP1,TOOL,D10\n", foot=rest + FOOT)


#: The beginning of an operation that is nowhere yet.
_NOWHERE: Final = CLEAR.replace("RAPID\nGOTO/0.0,0.0,50.0,0.0,0.0,1.0\n", "FEDRAT/MMPM,9\n")
KNOTS: Final = ("KNOT/0.25,0.5", "KNOT/1.0")
POLES: Final = ("CNTRL/0,10,5", "CNTRL/10,20,5", "CNTRL/20,20,5", "CNTRL/30,10,6", "CNTRL/30,0,5")
_SPLINE: Final = ("NURBS/", *KNOTS, *POLES)
#: Splines turned off in the CAM system: points in their place.
_POINTS: Final = ("+ GOTO/15,8,5", "+ GOTO/30,0,5")


def _spline(message: str, *lines: str) -> Cure:
    """Lines of a spline, which go out for points."""
    return _nx(message, *(f"- {line}" for line in lines), *_POINTS)


CURES: Final = (
    marked("CL130 ends_within", read, "- COOLNT/$", "+ COOLNT/$", "+ FLOOD", head=HEAD + FOOT),
    _nx("CL150 carriage_return_without", "- COOLNT/ON\rGOTO/1,2,3", "+ COOLNT/ON", "+ GOTO/1,2,3"),
    _nx("CL150 unknown_encoding_byte", "- COOLNT/\x01ON", "+ COOLNT/ON"),
    _nx("CL150 unknown_encoding_byte_0x", "- $$ NOTE\x0cGOTO/11,0,5", "+ $$ NOTE", "+ GOTO/11,0,5"),
    _nx("CL150 unknown_encoding_nul", "- GOTO/1\x00,2,3", "+ GOTO/1,2,3"),
    _nx("CL160 comment_within_statement", "- GOTO/1,2,3 $$ NOTERAPID", "+ GOTO/1,2,3 $$ NOTE", "+ RAPID", "GOTO/9,9,9"),
    _holes("CL160 cycle_values_none", "- CYCLE/DRILL,FEDTO,-9,RAPTO,3" + "," * 99, "+ CYCLE/DRILL,FEDTO,-9,RAPTO,3"),
    _nx("CL160 statement_longer_bytes", "- " + "GOTO/1,2,3 " * 96000, "+ GOTO/1,2,3"),
    _nx("CL180", *(f"- WOBBLE{k}" for k in range(199))),
    _nx("CL210 unknown", "- CLAMP/ON"),
    _nx("CL220 unknown", "WOBBLE/1,2"),
    _nx("CL250 motion_cannot_read", "- GO,TO/(CIRCLE/5,0,5,5),ON,(LINE/5,0,0,5,5,0)", "+ CIRCLE/15,0,5,0,0,1,5",
        "+ GOTO/20,0,5"),
    _nx("CL320 contradict_each_other", "- SPINDL/RPM,500,SFM", "+ SPINDL/RPM,500"),
    _holes("CL320 cycle_behind", "- CYCLE/DRILL,RAPTO,2,FEDTO,-30,RTRCTO,AUTO,50",
           "+ CYCLE/DRILL,RAPTO,2,FEDTO,-30,RTRCTO,50"),
    _holes("CL320 cycle_rapto_clear", "- CYCLE/DRILL,RAPTO,3,CLEAR,30,FEDTO,-5", "+ CYCLE/DRILL,RAPTO,3,FEDTO,-5"),
    _holes("CL320 cycle_rtrcto_height", "- CYCLE/DRILL,RAPTO,3,FEDTO,-5,RTRCTO,AUTO,RTRCTO,20",
           "+ CYCLE/DRILL,RAPTO,3,FEDTO,-5,RTRCTO,AUTO"),
    _file("CL350 nurbs_outside_any", *(f"- {line}" for line in _SPLINE), HEAD + FOOT),
    _file("CL360 msys_origin_mm", "TOOL PATH/A,TOOL,T", "- MSYS/1e7,0,0,1,0,0,0,1,0", "+ MSYS/10,0,0,1,0,0,0,1,0",
          "GOTO/0,0,9", "END-OF-PATH"),
    _nx("CL360 number", "- GOTO/1,2,1E999", "+ GOTO/1,2,10"),
    Cure("CL410", "feeds_mm_line", read, f"{HEAD}FEDRAT/IPM,1\n{FOOT}", ({"units": "mm"},)),
    Cure("CL420", "file_states_another", read, f"UNITS/MM\n{HEAD}{FOOT}", ({"units": None},), {"units": "inch"}),
    Cure("CL420", "mm_assumed", read, CLEAR + FOOT, ({"units": "mm"},)),
    _file("CL430 operation_no_msys", "TOOL PATH/A,TOOL,T", "MSYS/100,0,0,1,0,0,0,1,0", "GOTO/0,0,9", "END-OF-PATH",
          "TOOL PATH/B,TOOL,T", "+ MSYS/0,0,0,1,0,0,0,1,0", "GOTO/0,0,9", "END-OF-PATH"),
    _nx("CL470 contour_without_cutcom", "$$ contour data", "+ CUTCOM/LEFT", "GOTO/0,9,5"),
    _nx("CL470 points_contradicted", "$$ centerline data", "- CUTCOM/LEFT,CONTACT", "+ CUTCOM/LEFT", "GOTO/0,0,5"),
    _nx("CL470 points_those_contact", "- $$ contact point data", "GOTO/0,0,0"),
    marked("CL510 nurbs_without_point", read, "+ FROM/0,0,5", *_SPLINE, head=_NOWHERE, foot=FOOT),
    _nx("CL520 from_another_point_one", "- FROM/0,0,60", "+ GOTO/0,0,60"),
    _nx("CL575 arcs_file_have",
        *(f"- CIRCLE/0,0,{-k},0,0,1,10,0.01,0.5,6,0,TIMES,9000\nGOTO/10,0,{-k}" for k in range(9))),
    _nx("CL580 rapid_before_nurbs", "- RAPID", *_SPLINE),
    _spline("CL600 cntrl_follows_neither", "CNTRL/1,2,3"),
    _spline("CL600 cntrl_tool_axis", "NURBS/", *KNOTS, "CNTRL/0,10,5,0,0,1", *POLES[1:]),
    _spline("CL600 knot_without_nurbs", *_SPLINE, "KNOT/1"),
    _spline("CL600 knots_not_increasing", "NURBS/", "KNOT/0,0.5,1", *POLES),
    _spline("CL600 last_knot", "NURBS/", "KNOT/0.2,0.5,0.9", *POLES),
    _spline("CL600 no_knots", "NURBS/", "CNTRL/0,0,0"),
    _spline("CL600 nurbs_spline_degree", "NURBS/3", *_SPLINE[1:]),
    _spline("CL600 other_degree", "NURBS/", "KNOT/0.5,1", *POLES),
    _spline("CL600 statement_within", *_SPLINE[:4], "COOLNT/ON", *POLES[1:]),
    _file("CL600 too_many_points", "TOOL PATH/A,TOOL,T", "FEDRAT/MMPM,100", "GOTO/0,0,5", "- NURBS/", "- KNOT/0.25,0.5",
          "- KNOT/1.0", "- CNTRL/9e8,0,0", *(f"- {line}" for line in POLES[1:]), *_POINTS, "END-OF-PATH"),
    _nx("CL610 spline_nurbs_control", *_SPLINE),
    _nx("CL620 nurbs_within_cycle", "CYCLE/DRILL,RAPTO,3,FEDTO,-1,MMPM,9", "GOTO/0,0,5", "+ CYCLE/OFF",
        "+ GOTO/0,0,9", *_SPLINE),
    marked("CL710 fedrat_invers_move", read, "FEDRAT/INVERS,9", "+ FROM/0,0,50", "GOTO/1,2,3", head=_NOWHERE,
           foot=FOOT),
    _tool("CL770 bottom_side_tool", "TLDATA/MILL,10,0,75,50,60", "TLDATA/MILL,10,0,75,50,0"),
    _tool("CL770 bottom_tool_degrees", "TLDATA/MILL,10,0,75,0,95", "TLDATA/MILL,10,0,75,0,5"),
    _tool("CL770 side_tool_degrees", "TLDATA/MILL,10,0,75,95,0", "TLDATA/MILL,10,0,75,5,0"),
    _tool("CL770 point_drill_degrees", "TLDATA/DRILL,10,0,75,190,50", "TLDATA/DRILL,10,0,75,118,50"),
    _tool("CL770 tool_mm", "TLDATA/MILL,99999,0,75,0,0", "TLDATA/MILL,10,0,75,0,0"),
    _tool("CL770 tool_flutes_mm", "TLDATA/DRILL,10,0,75,118,80", "TLDATA/DRILL,10,0,75,118,50"),
    _file("CL770 tldata_not_known", "TOOL PATH/A,TOOL,T", "TLDATA/TURN,1,2", "GOTO/1,1,1", "END-OF-PATH"),
    _file("CL770 tldata_not_known_form", "TOOL PATH/A,TOOL,T", "TLDATA/1,2", "GOTO/1,1,1", "END-OF-PATH"),
    _file("CL780 tool_loaded_does", "- LOAD/TOOL,9", HEAD + FOOT),
    _nx("CL810 operation_uses_colour", "- PAINT/COLOR,7", "+ PAINT/COLOR,31", "GOTO/1,0,5"),
    _holes("CL820 cycle_belongs_behind", "- CYCLE/DRILL,RAPTO,2,FEDTO,-10,REV,DWELL,3",
           "+ CYCLE/DRILL,RAPTO,2,FEDTO,-10,DWELL,REV,3"),
    _holes("CL830 cycle_pecks_cannot", "- CYCLE/DRILL,DEEP,STEP,2,5,RAPTO,2,FEDTO,-9",
           "+ CYCLE/DRILL,DEEP,STEP,2,0.5,RAPTO,2,FEDTO,-9"),
    _holes("CL830 cycle_would_peck", "- CYCLE/DRILL,DEEP,RAPTO,3,FEDTO,-500,STEP,.0001",
           "+ CYCLE/DRILL,DEEP,RAPTO,3,FEDTO,-500,STEP,5"),
    _nx("CL840 cycle_line_still", "CYCLE/DRILL,RAPTO,3,FEDTO,-5", "GOTO/0,0,0", "+ CYCLE/OFF", "LOAD/TOOL,2",
        "+ CYCLE/DRILL,RAPTO,3,FEDTO,-5", "GOTO/5,0,0", "CYCLE/OFF"),
)  # fmt: skip
