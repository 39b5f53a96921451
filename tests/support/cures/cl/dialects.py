"""Cures of messages about CL files of other systems than NX, each by the lines that go out and come in."""

from typing import Final

from tests.support.apt_heads import HEADS
from tests.support.cures.cure import Cure, marked, read


def _in(dialect: str, message: str, *lines: str) -> Cure:
    """Lines behind the head of a dialect."""
    return marked(message, read, *lines, head="\n".join(HEADS[dialect]) + "\n", foot="FINI\n")


def _apt(message: str, *lines: str) -> Cure:
    """Lines behind a cut of a general APT file, and another cut."""
    return _in("apt", message, "RAPID", "GOTO/0,0,50", "FEDRAT/200,MMPM", "GOTO/0,0,0", *lines, "GOTO/9,0,0")


def _catia(message: str, *lines: str) -> Cure:
    """Lines behind a cut of CATIA."""
    return _in("catia", message, "RAPID", "GOTO/0,0,50", "FEDRAT/200,MMPM", "GOTO/50,20,0", *lines, "GOTO/90,0,0")


def _fusion(message: str, *lines: str) -> Cure:
    """Lines of Fusion behind its names."""
    return marked(message, read, "MODE/MILL", "PARTNO/'1001'", "PPRINT/'1001'", *lines, "END", "FINI")


def _camworks(message: str, *lines: str, axis: str = "0.0,-1.0,0.0") -> Cure:
    """Lines of an operation of CAMWorks, with the turns of its setup."""
    tool = "CUTTER/ 20.0,0.0,10.0,0.0,0.0,0.0,100.0,"
    return marked(message, read, "UNITS/ MM ", "BOX/ 0.0,1.5,0.0,90.0,3.0,55.0 ", tool, f"TLAXIS/ {axis} ",
                  "OPFEATSTART/A", *lines, "OPFEATEND/A", "FINI ")  # fmt: skip


def _own(message: str, *lines: str) -> Cure:
    """Lines of a file in Trunnion's own profile."""
    return marked(message, read, *lines, foot="END-OF-PATH\nFINI\n")


def _turns(a: str, b: str, c: str) -> tuple[str, ...]:
    return f"ROTABL/ {a},AAXIS,TABLE,CCLW ", f"ROTABL/ {b},BAXIS,TABLE,CCLW ", f"ROTABL/ {c},CAXIS,TABLE,CCLW "


def _gofwd(message: str, wrong: str, direction: str = "0,1,0") -> Cure:
    """An arc of CATIA from 50,20,0 that is in doubt, and the arc as the cure has it."""
    arc = "INDIRV/0,1,0", "TLON,GOFWD/(CIRCLE/40,20,0,10),ON,(LINE/40,20,0,40,30,0)"
    return _catia(message, f"- INDIRV/{direction}", f"- {wrong}", *(f"+ {line}" for line in arc))


def _matrix(x: str = "1 0 0 0", y: str = "0 1 0 0", z: str = "0 0 1 0") -> tuple[str, ...]:
    return "$$*CATIA0", "$$ A", f"$$ {x}", f"$$ {y}", f"$$ {z}"


def _axes(message: str, *lines: str) -> Cure:
    """Lines of CATIA without MULTAX, behind the first statements."""
    head = "$$ CATIA APT VERSION 1.0\nLOADTL/1\nSPINDL/1000,RPM,CLW\nFEDRAT/100,MMPM\n"
    return marked(message, read, *lines, head=head, foot="FINI\n")


def _out(*lines: str) -> tuple[str, ...]:
    return tuple(f"- {line}" for line in lines)


_PART: Final = ("TLAXIS/0,0,1", "GOTO/-40,-30,20", "GOTO/-40,30,20")
_SECTION: Final = ("PPRINT/'Contour (2)'", "CUTTER/10.0, 1.0, 0.0, 1.0, 0.0, 0.0, 30.0", "LOADTL/5, 0, 60.0, 5")
_UPRIGHT: Final = _turns("1.570796", "-0.0", "0.0")
_BACK: Final = (
    "ROTABL/ -0.0,CAXIS,TABLE,CCLW ",
    "ROTABL/ 0.0,BAXIS,TABLE,CCLW ",
    "ROTABL/ -1.570796,AAXIS,TABLE,CCLW ",
)
_POINTS: Final = ("RAPID/ ", "GOTO/ -30.0,-15.0,25.0 ", "FEDRAT/ MMPM,100.0", "GOTO/ -30.0,-15.0,-1.0 ",
                  "GOTO/ -20.0,-15.0,-1.0 ")  # fmt: skip
_PECKING: Final = "CYCLE/ DRILL,G98,6.00161,PECKING,5.0,2.0,MMPM,1101.5,3.0,25.0 25.0 DWELL,0.0"

_CUT_OFF: Final = "\n".join((*HEADS["apt"], "GOTO/0,0,5"))

_NAMED: Final = ("$$-> TRUNNION / 1", "UNITS/MM")
_FINISH: Final = ("TOOL PATH/A,TOOL,B", "FEDRAT/MMPM,100", "GOTO/0,0,5")

CURES: Final = (
    _apt("CL120 defined_here_apt", "- M1 = MACRO/A"),
    _apt("CL120 statement_apt_part", "- LOOPND"),
    _apt("CL120 word_number_numbers", "- 1009/ 73, 12", "+ COOLNT/FLOOD"),
    Cure("CL130", "file_no_behind_last", read, _CUT_OFF, ((_CUT_OFF, f"{_CUT_OFF}0\nFINI\n"),)),
    _apt("CL210 damaged", "- COOLNT,ON", "+ COOLNT/ON"),
    _in("ncl", "CL160 behind_begins_line", "RAPID", "GOTO/0,0,50", "- FEDRAT / 200, MMPM$$-> CUTTER / 12",
        "+ FEDRAT / 200, MMPM", "+ $$-> CUTTER / 12", "RAPID", "GOTO/10,10,1"),
    _in("ncl", "CL220 comment_all_but", "$$-> SETSTART / 1", "GOTO / 1,2,3"),
    _catia("CL120 other_meanings", "- SYN/"),
    _catia("CL230", "SYN/'TLAXIS','$$*TLAXIS'"),
    _in("ncl", "CL240 taken_csys_under", "CAMERA/1,0,0,0,0,1,0,0,0,0,1,0", "GOTO / 1,2,3"),
    _catia("CL250 motion_cannot", "- CNTRL/1,2,3", "+ GOTO/1,2,3"),
    _apt("CL250 no_point", "- POSITN/TABLE", "+ GOTO/5,0,0"),
    _apt("CL250 unreadable_motion", "- MOVE/1,2,3", "+ GOTO/1,2,3"),
    _apt("CL260 subprogram", "- CALSUB/1", "+ GOTO/5,0,0"),
    _apt("CL260 turning", "- SWITCH/9"),
    _apt("CL260 probing", "- PROBE/POINTS,MMPM,500,DIST,30,5"),
    _in("catia", "CL260 toolno_belongs_turning", "- TOOLNO/1,TURN,1,0,9,0.4", "- LOADTL/1", "- GOTO/1,2,3", "RAPID",
        "GOTO/0,0,50"),
    _fusion("CL260 mode_turn_turning", "- MODE/TURN", *_out(*_SECTION, "GOTO/1,2,3"), *_SECTION, "GOTO/1,2,3"),
    _apt("CL320 loadtl_twice", "- LOADTL/5,LENGTH,90.5,LENGTH,80", "+ LOADTL/5,LENGTH,80"),
    _apt("CL330 loadtl_not_known", "RAPID", "GOTO/0,0,50", "- LOADTL/5,2,1", "+ LOADTL/5,ADJUST,1", "RAPID"),
    _apt("CL330 movarc_not_known", "- MOVARC/4.5,0,0,0,0,1,4.5", "+ MOVARC/4.5,0,0,0,0,1,4.5,ANGLE,180"),
    _apt("CL480 points_follow_would", "- MODE/INCR,ON", "- GOTO/1,0,0", "+ GODLTA/1,0,0"),
    _apt("CL480 repeats_motion", "- INDEX/1"),
    _apt("CL480 shifts_turns_points", "- TRANS/1,2,3", "- GOTO/1,0,0", "+ GOTO/2,2,3"),
    _apt("CL480 turns_rotary_axis", "- ROTATE/CAXIS,90", "- GOTO/1,0,0", "+ GOTO/1,0,0,0,0,1"),
    _apt("CL530 point_without_tool_axis", "GOTO/1,0,0,1,0,0", "MULTAX/OFF", "- GOTO/2,0,0", "+ GOTO/2,0,0,0,0,1"),
    _in("solidworks", "CL530 point_without_tool", "GOTO/0,0,0", "CSYS/0,0,1.,0,0,1.,0,0,-1.,0,0,0", "- GOTO/1,2,3",
        "+ GOTO/1,2,3,1,0,0"),
    _axes("CL530 three_more_numbers", "+ MULTAX", "GOTO/1,2,3,1,0,0"),
    _fusion("CL550 plane_not_given", "UNITS/MM", "MULTAX/ON", *_SECTION, "- GOTO/1.0, 2.0, 3.0, 0.0, 0.6, 0.8",
            "+ GOTO/1.0, 2.0, 3.0, 0.0, 0.0, 1.0"),
    _apt("CL550 tilted_tool_axis", "CLRSRF/50", "GOTO/1,2,3,1,0,0", "- RETRCT", "+ GOTO/50,2,3,1,0,0",
         "GOTO/9,0,0,1,0,0",
         "GOTO/9,0,0,0,0,1"),
    _in("ncl", "CL560 point_same_circle", "GOTO / 5,0,0", "CIRCLE / 0,0,0,0,0,1,5", "GOTO / 3,4,0", "- GOTO / -5,0,0"),
    _catia("CL560 indirv_without_arc", "- INDIRV/0,1,0"),
    _apt("CL570 arc_turns_degrees", "GOTO/5,0,0", "- MOVARC/0,0,0,0,0,1,5,ANGLE,90", "+ MOVARC/0,0,0,0,0,-1,5,ANGLE,90",
         "GOTO/0,-5,0"),
    _apt("CL570 movarc_angle_degrees", "GOTO/5,0,0", "- MOVARC/0,0,0,0,0,1,5,ANGLE,-90",
         "+ MOVARC/0,0,0,0,0,-1,5,ANGLE,90",
         "GOTO/0,-5,0"),
    _gofwd("CL250 gofwd_along_other", "GOFWD/L1,ON,L2"),
    _gofwd("CL310 gofwd_where_numbers", "TLON,GOFWD/(CIRCLE/40,20,A,10),ON,(LINE/40,20,0,40,30,0)"),
    _gofwd("CL570 gofwd_direction_axis", "TLON,GOFWD/(CIRCLE/40,20,0,10),ON,(LINE/40,20,0,40,30,0)", "0,0,0"),
    _gofwd("CL570 gofwd_ends_line", "TLON,GOFWD/(CIRCLE/40,20,0,10),ON,(LINE/41,20,0,40,30,0)"),
    _gofwd("CL570 gofwd_ends_off", "TLON,GOFWD/(CIRCLE/40,20,0,10),ON,(LINE/40,20,0,40,30,-1)"),
    _gofwd("CL570 gofwd_turns_degrees_where", "TLON,GOFWD/(CIRCLE/40,20,0,10),ON,(LINE/40,20,0,40,10,0)"),
    _gofwd("CL570 gofwd_turns_degrees", "TLON,GOFWD/(CIRCLE/40,20,0,10),ON,2,INTOF,(LINE/40,20,0,40,30,0)"),
    _gofwd("CL570 indirv_not_tangent", "TLON,GOFWD/(CIRCLE/40,20,0,10),ON,(LINE/40,20,0,40,30,0)", "1,0,0"),
    _in("catia", "CL510 gofwd_without_start", "+ GOTO/50,20,0", "+ INDIRV/0,1,0",
        "TLON,GOFWD/(CIRCLE/40,20,0,10),ON,(LINE/40,20,0,40,30,0)"),
    _axes("CL430 catia0_behind_points", *_PART, "- $$*CATIA0", *_out(*_matrix()[1:]), *_PART),
    _axes("CL430 catia0_not_followed", "$$*CATIA0", "$$ A", "$$ 1 0 0 0", "+ $$ 0 1 0 0", "+ $$ 0 0 1 0", *_PART),
    _axes("CL430 catia0_within_cycle", *_matrix(), *_PART, "CYCLE/DRILL,DEPTH,5,MMPM,100,CLEAR,2", "GOTO/1,2,3",
          "+ CYCLE/OFF",
          *_matrix(z="0 0 1 20"), "TLAXIS/0,0,1", "+ CYCLE/DRILL,DEPTH,5,MMPM,100,CLEAR,2", "GOTO/4,5,6", "CYCLE/OFF"),
    _axes("CL430 catia0_without_matrix", *_PART, "- $$*CATIA0", "- $$ PPTABLE / STD-MM.pptable", *_PART),
    _axes("CL430 only_catia0_known", "- $$*CATIA1", "+ $$*CATIA0", *_matrix()[1:], *_PART),
    _axes("CL440 machining_axis_system", *_matrix(), *_PART, "- $$*CATIA0", *_out(*_matrix("0 1 0 0", "1 0 0 0")[1:]),
          *_PART),
    _axes("CL450 machining_axis_system", *_matrix(), *_PART, *_matrix(z="0 0 1 20"), *_PART),
    _in("ncl", "CL430 coordinate_system_points", "$$-> CSYS / 1,0,0,0,0,1,0,0,0,0,1,0", "GOTO / 1,2,3",
        "- $$-> CSYS / 0,1,0,0,1,0,0,0,0,0,-1,0", "- GOTO / 4,2,3"),
    _in("solidworks", "CL430 trntyp_coordinate_system", "- TRNTYP/LOCAL,0,0,0", "+ TRNTYP/WORLD,0,0,0", "RAPID",
        "GOTO/0,0,50"),
    _in("solidworks", "CL440 columns_csys_not", "- CSYS/1,0,0,0,0,2,0,0,0,0,1,0", "+ CSYS/1,0,0,0,0,1,0,0,0,0,1,0",
        "RAPID",
        "GOTO/0,0,50"),
    _camworks("CL430 opfeatend_operation_without", *(f"+ {line}" for line in _UPRIGHT), *_POINTS,
              *(f"+ {line}" for line in _BACK)),
    _camworks("CL430 rotabl_not_known", "- ROTABL/ 90.0", f"+ {_UPRIGHT[0]}", *_UPRIGHT[1:], *_POINTS, *_BACK),
    _camworks("CL430 rotabl_turns_other", *_out(*reversed(_UPRIGHT)), *(f"+ {line}" for line in _UPRIGHT), *_POINTS,
              *_BACK),
    _camworks("CL430 rotabl_turns_setup", *_out(*_turns("0.5", "0.5", "0.0")), *(f"+ {line}" for line in _UPRIGHT),
              *_POINTS),
    _camworks("CL440 rotabl_does_not", *_out(*_turns("-1.570796", "-0.0", "0.0")), *(f"+ {line}" for line in _UPRIGHT),
              *_POINTS),
    _camworks("CL320 cycle_two_heights", *_UPRIGHT, f"- {_PECKING.replace('25.0 25.0', '25.0 24.0')}", *_POINTS),
    _camworks("CL820 cycle_no_number", *_UPRIGHT, f"- {_PECKING.replace('3.0,', '3.-0,')}", f"+ {_PECKING}",
              *_POINTS[:2], "CYCLE/OFF"),
    _camworks("CL820 cycle_not_known", *_UPRIGHT, f"- {_PECKING.replace('PECKING', 'BORING')}", *_POINTS),
    _camworks("CL330 circle_not_known", *_UPRIGHT, *_POINTS, "- CIRCLE/ ",
              "+ CIRCLE/ -25.0,-15.0,-1.0,0.0,0.0,1.0,5.0,CLOCKWISE ",
              "GOTO/ -30.0,-15.0,-1.0 "),
    _fusion("CL460 loadtl_export_writes", "- LOADTL/5, IN, 0, LENGTH, 60, OSETNO, 5", *_out("GOTO/1,2,3"), *_SECTION,
            "GOTO/1,2,3,0,0,1"),
    _fusion("CL460 some_revisions_export", "UNITS/MM", *_SECTION, "GOTO/1,2,3"),
    _fusion("CL460 units_each_operation", "UNITS/MM", *_SECTION, "GOTO/1,2,3", "- UNITS/MM", *_SECTION, "GOTO/1,2,3"),
    _in("ncl", "CL470 cutcom_geometry_type", "$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_PROFILE", "GOTO/0,0,50"),
    _catia("CL470 cutcom_radius_compensation", "- CUTCOM/ENDPT", "GOTO/1,2,3,0,0,1"),
    _catia("CL470 goto_numbers_compensation", "- GOTO/0,0,0,0,0,0,0,0,1", "+ GOTO/0,0,0,0,0,1"),
    _apt("CL590 not_plane_constant", "- CLRSRF/YZPLAN,5", "+ CLRSRF/5"),
    _in("apt", "CL590 retrct_before_any", "CLRSRF/50", "+ GOTO/0,0,9", "RETRCT", "GOTO/0,0,9"),
    _apt("CL590 retrct_where_tool", "CLRSRF/50", "- RETRCT/5", "+ GOTO/0,0,50"),
    _fusion("CL740 spindl_alone_these", "UNITS/MM", *_SECTION, "- SPINDL/OFF", "GOTO/1,2,3"),
    _catia("CL750 operation_no_coolnt", "COOLNT/FLOOD", "GOTO/0,0,-2", "$$ OPERATION NAME : B", "+ COOLNT/FLOOD",
           "RAPID", "GOTO/0,0,50",
           "FEDRAT/200,MMPM", "GOTO/0,0,-2"),
    _apt("CL760 operation_cuts_without_cutcom", "CUTCOM/LEFT", "GOTO/40,0,-2", "+ CUTCOM/OFF", "+ GOTO/50,0,-2",
         "GOHOME", "RAPID",
         "GOTO/0,0,50", "FEDRAT/200,MMPM"),
    _apt("CL770 corner_tool_would", "RAPID", "GOTO/0,0,50", "- CUTTER/12,5,1,1,0,0,80", "+ CUTTER/12,5,1,5,0,0,80",
         "RAPID"),
    _apt("CL780 tool_called_another", "+ RAPID", "+ GOTO/0,0,50", "LOADTL/5,7", "+ RAPID", "+ GOTO/0,0,50",
         "+ FEDRAT/200,MMPM"),
    _in("catia", "CL780 tool_stated_not", "RAPID", "GOTO/0,0,9", "TOOLNO/6,8", "+ LOADTL/6", "RAPID", "GOTO/0,0,9"),
    _apt("CL790 operation_begins_cut", "INTOL/0.01", "RAPID", "GOTO/0,0,50", "FEDRAT/9,MMPM", "GOTO/0,0,0", "INTOL/0.1",
         "+ RAPID",
         "+ GOTO/0,0,50", "+ FEDRAT/9,MMPM"),
    marked("CL790 way_before_first", read, "$$ CATIA APT VERSION 1.0", "TLAXIS/0,0,1", "GOTO/0,0,100",
           "CUTTER/16,0,8,4.6,30,0,50",
           "LOADTL/1", "RAPID", "GOTO/0,0,1", "FEDRAT/10,MMPM", "GOTO/0,0,-2", "FINI"),
    _in("ncl", "CL800 control_may_leave", "- OUTTOL/10", "+ OUTTOL/0.01", "RAPID", "GOTO/0,0,50"),
    _apt("CL820 cycle_cannot_read", "- CYCLE/THRU,FEDTO,5,RAPTO,1"),
    _catia("CL820 cycle_number_too", "- CYCLE/DRILL, 3, 5, 6", "+ CYCLE/DRILL,DEPTH,5,MMPM,100,CLEAR,2", "GOTO/1,0,0",
           "CYCLE/OFF"),
    _apt("CL820 cycle_numbers_without", "- CYCLE/DRILL, 12.0, MMPM, 80.0, 5.0",
         "+ CYCLE/DRILL,FEDTO,12,RAPTO,5,MMPM,80", "GOTO/1,0,0",
         "CYCLE/OFF"),
    _in("solidworks", "CL820 cycle_one_1stpeck", "- CYCLE/DEEP2,FEDTO,5,1STPECK,1,RAPTO,1",
        "+ CYCLE/DEEP2,FEDTO,5,1STPECK,1,SUBPECK,1,RAPTO,1",
        "GOTO/0,0,0", "CYCLE/OFF"),
    _in("ncl", "CL820 cycle_without_clear", "- CYCLE / DRILL, DEPTH, 5", "+ CYCLE / DRILL, DEPTH, 5, CLEAR, 2",
        "GOTO/0,0,0", "CYCLE/OFF"),
    _in("ncl", "CL830 cycle_rapto_passes", "- CYCLE / DRILL, DEPTH, 5, CLEAR, 1, RAPTO, 2",
        "+ CYCLE / DRILL, DEPTH, 5, CLEAR, 1, RAPTO, 1",
        "GOTO/0,0,0", "CYCLE/OFF"),
    _in("solidworks", "CL830 cycle_subpeck_not", "- CYCLE/DEEP2,FEDTO,5,1STPECK,1,SUBPECK,0,RAPTO,1",
        "+ CYCLE/DEEP2,FEDTO,5,1STPECK,1,SUBPECK,1,RAPTO,1", "GOTO/0,0,0", "CYCLE/OFF"),
    _in("solidworks", "CL860 pecks_behind_first",
        "- CYCLE/DEEP2,FEDTO,45,1STPECK,5.,SUBPECK,30.,MMPM,9,RAPTO,3.,RTRCTO,27",
        "+ CYCLE/DEEP2,FEDTO,45,1STPECK,30.,SUBPECK,30.,MMPM,9,RAPTO,3.,RTRCTO,27", "GOTO/0,0,0", "CYCLE/OFF"),
    _own("CL160 blank_before_arrow", *_NAMED, "- $$ -> STOCK / CYLINDER,9,9,0",
         "+ $$-> STOCK / CYLINDER,9,9,0", *_FINISH),
    _own("CL320 stock_twice", *_NAMED, "$$-> STOCK / CYLINDER,9,9,0", "- $$-> STOCK / CYLINDER,8,9,0", *_FINISH),
    _own("CL320 tool_word_twice", *_NAMED, *_FINISH, "- $$-> TOOL / MILL,DIAMETER,8,DIAMETER,8",
         "+ $$-> TOOL / MILL,DIAMETER,8"),
    _own("CL330 profile_version", "- $$-> TRUNNION / 3", "+ $$-> TRUNNION / 1", *_NAMED[1:], *_FINISH),
    _own("CL330 profile_stock", *_NAMED, "- $$-> STOCK / BLOCK,9,9,9,0,0,0",
         "+ $$-> STOCK / BOX,9,9,9,0,0,0", *_FINISH),
    _own("CL330 profile_tool", *_NAMED, *_FINISH, "- $$-> TOOL / MILL,10", "+ $$-> TOOL / MILL,DIAMETER,10"),
    _own("CL330 profile_paint", *_NAMED, *_FINISH, "- PAINT/PATH", "+ PAINT/COLOR,31"),
    _own("CL350 profile_first_line", "- $$ PART 7", *_NAMED, "+ $$ PART 7", "$$-> STOCK / CYLINDER,9,9,0", *_FINISH),
    _own("CL350 profile_behind_head", *_NAMED, "+ $$-> STOCK / CYLINDER,9,9,0", *_FINISH,
         "- $$-> STOCK / CYLINDER,9,9,0"),
    _own("CL350 profile_outside", *_NAMED, "- $$-> HOLDER / HSK 63", "TOOL PATH/A,TOOL,B", "+ $$-> HOLDER / HSK 63",
         *_FINISH[1:]),
    _own("CL330 profile_work_offset", *_NAMED, *_FINISH[:2], "- $$-> WORK-OFFSET / 0", "+ $$-> WORK-OFFSET / 2",
         *_FINISH[2:]),
    _own("CL350 profile_behind_motion", *_NAMED, *_FINISH[:2], "+ $$-> WORK-OFFSET / 2", *_FINISH[2:],
         "- $$-> WORK-OFFSET / 2"),
    _own("CL490 not_stated", *_NAMED, *_FINISH[:2], "+ $$-> WORK-OFFSET / 1", *_FINISH[2:], "END-OF-PATH",
         "TOOL PATH/C,TOOL,B", "$$-> WORK-OFFSET / 2", *_FINISH[1:]),
    _own("CL410 profile_units", *_NAMED[:1], "+ UNITS/MM", *_FINISH),
)  # fmt: skip
