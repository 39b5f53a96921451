"""Cures of messages about CL files: what NX writes, read alone."""

from typing import Final

from tests.support.cures.cure import Change, Cure, read, verify
from tests.support.posting import CLEAR, FOOT, HEAD
from tests.support.program_heads import HEADS

#: A line that goes out.
_OUT: Final = ""

_THERE: Final = "GOTO/20,0,5\n" + FOOT
_CUT: Final = HEAD + _THERE
_DRILL: Final = "CYCLE/DRILL,FEDTO,-10,RAPTO,3,MMPM,100\n"


def _said(code: str, variant: str, text: str, *changes: Change, **settings: str) -> Cure:
    return Cure(code, variant, read, text, changes, settings)


def _within(code: str, variant: str, line: str, cured: str, **settings: str) -> Cure:
    """A line behind the first cut, and what stands in its place."""
    return _said(code, variant, f"{HEAD}{line}\nGOTO/20,0,5\n{FOOT}", (f"{line}\n", cured and f"{cured}\n"), **settings)


def _holes(code: str, variant: str, cycle: str, cured: str) -> Cure:
    """A cycle with two holes, and the cycle in its place."""
    text = f"{CLEAR}{cycle}\nGOTO/50,0,0\nGOTO/60,0,0\nCYCLE/OFF\n{FOOT}"
    return _said(code, variant, text, (f"{cycle}\n", cured and f"{cured}\n"))


_SECOND: Final = HEAD.replace("OP1", "OP2")
_ARC: Final = "CIRCLE/10,5,5,0,0,1,5"

_PROGRAM: Final = HEADS["mikron_600u"].format(lines="L X+10 F100")
_FAGOR: Final = "%PART,MX--\nN10 G90\n#RTCP ON\nN20 X5 F9\n#RTCP OFF\nM30\n"

CURES: Final = (
    Cure("CL110", "is_program", read, _PROGRAM, (), cured_by=verify("mikron_600u")),
    _said("CL110", "is_foreign_program", _FAGOR, (_FAGOR, _CUT)),
    Cure(
        "CL110",
        "begins_variable",
        read,
        HEADS["matsuura_mx330"].format(lines="G1 X#1 F100.").replace("%\n", "").replace("O0001", "#1=5"),
        (),
        cured_by=verify("matsuura_mx330"),
    ),
    _said("CL130", "operation_no_end_path", HEAD, ("GOTO/10.0,0.0,5.0\n", "GOTO/10.0,0.0,5.0\nEND-OF-PATH\n")),
    _said("CL130", "operation_no_end", HEAD + "GOTO/20,0", ("GOTO/20,0", "GOTO/20,0,5\nEND-OF-PATH\n")),
    _said("CL140", "file_empty", "", ("", _CUT)),
    _said("CL140", "no_motion_file", CLEAR.partition("RAPID")[0] + FOOT, ("END", "GOTO/0,0,5\nEND")),
    _said("CL150", "lines_end_lone", _CUT.replace("\n", "\r"), ("\r", "\n")),
    _said("CL160", "numbers_without_word", HEAD + "20,0,5\n" + FOOT, ("\n20,", "\nGOTO/20,")),
    _within("CL160", "dollar_sign_within", "GOTO/20,$ 0,5", "GOTO/20,$\n0,5"),
    _within("CL160", "within_statement_without", "COOLNT/FLOOD GOTO/15,0,5", "COOLNT/FLOOD\nGOTO/15,0,5"),
    _within("CL210", "unknown_in_strict", "CLAMP/ON", _OUT, strict="yes"),
    _within("CL310", "nothing_behind_comma", "FEDRAT/MMPM,500,", "FEDRAT/MMPM,500"),
    _within("CL310", "number_expected", "GOTO/1,2", "GOTO/1,2,3"),
    _within("CL310", "where_number_belongs", "GOTO/1,2 5,3", "GOTO/1,2.5,3"),
    _within("CL310", "where_whole_number", "LOAD/TOOL,1.5", "LOAD/TOOL,1"),
    _within("CL330", "coolnt_without_word", "COOLNT/", "COOLNT/FLOOD"),
    _within("CL340", "delay_negative", "DELAY/-1", "DELAY/1"),
    _said("CL340", "negative", HEAD.replace("INTOL/0.01", "INTOL/-0.01") + FOOT, ("INTOL/-", "INTOL/")),
    _said(
        "CL350",
        "motion_outside_any",
        _CUT + "GOTO/1,2,3\n",
        ("END-OF-PATH\nGOTO/1,2,3\n", "END-OF-PATH\nTOOL PATH/B,TOOL,D10\nGOTO/1,2,3\nEND-OF-PATH\n"),
    ),
    _said("CL350", "end_path_without", _CUT + FOOT, ("END-OF-PATH\nEND-OF-PATH", "END-OF-PATH")),
    _said("CL350", "operation_no_end", HEAD + _SECOND + FOOT, ("TOOL PATH/OP2", "END-OF-PATH\nTOOL PATH/OP2")),
    _said("CL350", "circle_outside_any", "CIRCLE/0,0,0,0,0,1,5\n" + _CUT, ("CIRCLE/0,0,0,0,0,1,5\n", _OUT)),
    _within("CL360", "coordinate_mm", "GOTO/1e7,0,0", "GOTO/10,0,0"),
    _within("CL410", "units_not_known", "UNITS/FURLONG", "UNITS/MM"),
    _said("CL410", "units_after_another", "UNITS/MM\n" + HEAD + "UNITS/INCHES\n" + FOOT, ("UNITS/INCHES\n", _OUT)),
    _said("CL430", "msys_after_motion", HEAD + "MSYS/0,0,0,1,0,0,0,1,0\n" + FOOT, ("MSYS/0,0,0,1,0,0,0,1,0\n", _OUT)),
    _said("CL440", "x_y_msys", _CUT.replace("0.0000000,1.0000000,0.0000000", "0.6,0.8,0"), ("0.6,0.8,0", "0,1,0")),
    _said("CL440", "vector_msys_length", _CUT.replace("0.0000000,1.0000000,0.0000000", "0,2,0"), ("0,2,0", "0,1,0")),
    _said(
        "CL510",
        "circle_no_start",
        CLEAR.replace("GOTO/0.0,0.0,50.0,0.0,0.0,1.0", "FEDRAT/MMPM,100\n" + _ARC + "\nGOTO/15,5,5") + FOOT,
        (_ARC, "FROM/10,0,5\n" + _ARC),
    ),
    _said(
        "CL510",
        "godlta_without_point",
        CLEAR.replace("GOTO/0.0,0.0,50.0,0.0,0.0,1.0", "GODLTA/1,0,0") + FOOT,
        ("GODLTA", "FROM/0,0,0\nGODLTA"),
    ),
    _within("CL540", "tool_axis_vector", "GOTO/15,0,5,0,0,0", "GOTO/15,0,5,0,0,1"),
    _within("CL540", "tool_axis_vector_length", "GOTO/15,0,5,0,0,1.1", "GOTO/15,0,5,0,0,1"),
    _said("CL560", "circle_without_goto", HEAD + _ARC + "\n" + FOOT, (_ARC, _ARC + "\nGOTO/15,5,5")),
    _said(
        "CL560", "where_goto_circle", HEAD + _ARC + "\n" + _ARC + "\nGOTO/15,5,5\n" + FOOT, (_ARC + "\n" + _ARC, _ARC)
    ),
    _within("CL570", "normal_circle_not", "CIRCLE/10,5,5,0,0,2,5\nGOTO/15,5,5", _ARC + "\nGOTO/15,5,5"),
    _within("CL570", "radius_circle_not", "CIRCLE/10,5,5,0,0,1,0\nGOTO/15,5,5", _ARC + "\nGOTO/15,5,5"),
    _within("CL570", "start_point_arc", "CIRCLE/10,5,5,0,0,1,4\nGOTO/14,5,5", _ARC + "\nGOTO/15,5,5"),
    _within("CL570", "end_point_arc", _ARC + "\nGOTO/16,5,5", _ARC + "\nGOTO/15,5,5"),
    _within("CL570", "circle_turns", _ARC + ",TIMES,0\nGOTO/15,5,5", _ARC + ",TIMES,1\nGOTO/15,5,5"),
    _within("CL580", "rapid_before_arc", "RAPID\n" + _ARC + "\nGOTO/15,5,5", _ARC + "\nGOTO/15,5,5"),
    _said(
        "CL620",
        "circle_within_cycle",
        CLEAR + _DRILL + "GOTO/10,0,5\n" + _ARC + "\nGOTO/15,5,5\nCYCLE/OFF\n" + FOOT,
        (_ARC, "CYCLE/OFF\nFEDRAT/MMPM,100\nGOTO/10,0,5\n" + _ARC),
        ("GOTO/15,5,5\nCYCLE/OFF", "GOTO/15,5,5"),
    ),
    _within("CL710", "fedrat_negative", "FEDRAT/MMPM,-100", "FEDRAT/MMPM,100"),
    _within("CL710", "fedrat_not_known", "FEDRAT/SPEEDY,100", "FEDRAT/MMPM,100"),
    _within("CL715", "fedrat_0", "FEDRAT/MMPM,0", "FEDRAT/MMPM,100"),
    _said("CL716", "inch_in_metric_file", f"UNITS/MM\n{HEAD}FEDRAT/IPM,800\n{_THERE}", ("IPM", "MMPM")),
    _said("CL716", "metric_in_inch_file", f"UNITS/INCHES\n{HEAD}{_THERE}", ("MMPM", "IPM")),
    _said(
        "CL735",
        "surface_speed_converted",
        _CUT.replace("SPINDL/RPM,4000.0000,CLW", "SPINDL/SMM,100,CLW"),
        ("SPINDL/SMM,100,CLW", "SPINDL/RPM,3183,CLW"),
    ),
    _within("CL730", "spindl_speed_0", "SPINDL/RPM,0,CLW", "SPINDL/RPM,1000,CLW"),
    _within("CL730", "spindl_negative_speed", "SPINDL/RPM,-1000", "SPINDL/RPM,1000,CCLW"),
    _within("CL730", "spindl_without_speed", "SPINDL/", "SPINDL/RPM,1000,CLW"),
    _said(
        "CL730",
        "spindl_without_sense",
        _CUT.replace("CLW", "CCLW") + _CUT[_CUT.index("TOOL PATH") :].replace(",CLW", "").replace("OP1", "OP2"),
        ("SPINDL/RPM,4000.0000\n", "SPINDL/RPM,4000.0000,CLW\n"),
    ),
    _said(
        "CL730",
        "spindl_turns_spindle",
        _CUT.replace("SPINDL/RPM,4000.0000,CLW", "SPINDL/ON"),
        ("SPINDL/ON", "SPINDL/RPM,4000,CLW"),
    ),
    _said(
        "CL730",
        "spindle_speed_surface",
        _CUT.replace("SPINDL/RPM,4000.0000,CLW", "SPINDL/SMM,100").replace(
            "TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000\n", ""
        ),
        ("SPINDL/SMM,100", "SPINDL/RPM,4000,CLW"),
    ),
    _said(
        "CL770",
        "tldata_number",
        _CUT.replace("TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000", "TLDATA/DRILL,1"),
        ("DRILL,1", "DRILL,10,0,118,75,50"),
    ),
    _said(
        "CL770",
        "tldata_number_expected",
        _CUT.replace("TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000", "TLDATA/MILL,1,2"),
        ("MILL,1,2", "MILL,10,0,75,0,0"),
    ),
    _said(
        "CL770",
        "tool_corner_radius",
        _CUT.replace("TLDATA/MILL,10.0000,0.0000", "TLDATA/MILL,10,6"),
        ("MILL,10,6", "MILL,10,5"),
    ),
    _said("CL770", "tool_negative", _CUT.replace("TLDATA/MILL,10.0000", "TLDATA/MILL,-10"), ("MILL,-10", "MILL,10")),
    _holes("CL820", "cycle_without_word", "CYCLE/", _DRILL.strip()),
    _holes("CL820", "cycle_without_number", "CYCLE/DRILL,FEDTO,-10,RAPTO", "CYCLE/DRILL,FEDTO,-10,RAPTO,3"),
    _holes("CL820", "cycle_numbers_behind", "CYCLE/DRILL,FEDTO,-10,5,RAPTO,3", "CYCLE/DRILL,FEDTO,-10,RAPTO,3"),
    _holes(
        "CL820", "cycle_only_uses", "CYCLE/DRILL,STEP,5,FEDTO,-10,RAPTO,3", "CYCLE/DRILL,DEEP,STEP,5,FEDTO,-10,RAPTO,3"
    ),
    _holes(
        "CL830", "cycle_dwell_below", "CYCLE/DRILL,FEDTO,-10,RAPTO,3,DWELL,-1", "CYCLE/DRILL,FEDTO,-10,RAPTO,3,DWELL,1"
    ),
    _holes("CL320", "cycle_twice", "CYCLE/DRILL,FEDTO,-10,FEDTO,-12,RAPTO,3", "CYCLE/DRILL,FEDTO,-12,RAPTO,3"),
    _within("CL320", "spindl_two_speeds", "SPINDL/RPM,100,200,CLW", "SPINDL/RPM,200,CLW"),
    _said(
        "CL850",
        "cycle_off_where",
        _CUT.replace("GOTO/20,0,5", "CYCLE/OFF"),
        ("CYCLE/OFF", _DRILL + "GOTO/50,0,0\nCYCLE/OFF"),
    ),
    _said(
        "CL850",
        "cycle_before_any",
        _CUT.replace("GOTO/20,0,5", "CYCLE/ON\nGOTO/50,0,0\nCYCLE/OFF"),
        ("CYCLE/ON", _DRILL.strip()),
    ),
    _said("CL110", "not_cl_file", "Dear Sir\nplease mill\n", ("Dear Sir\nplease mill\n", _CUT)),
    _said(
        "CL520",
        "from_another_point",
        CLEAR.replace("RAPID\n", "FROM/0,0,60\nFROM/0,0,70\nRAPID\n") + FOOT,
        ("FROM/0,0,60\n", _OUT),
    ),
    _said("CL170", "motion_stands_behind", "PARTNO/A\n" + _CUT + "FINI\n" + _CUT + "FINI\n", ("FINI\n", _OUT)),
)
