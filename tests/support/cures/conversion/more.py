"""Cures of messages about conversions: more of them, by the lines that go out and come in, and by arguments."""

from typing import Final

from tests.support.cures.conversion.rows import FANUC, PROGRAMS, TNC, converting, edited, within
from tests.support.cures.cure import Change, Cure, marked, post
from tests.support.cures.scripts import run, script
from tests.support.posting import FOOT, HEAD


def _argument(message: str, text: str, change: Change, **given: str) -> Cure:
    """Arguments of a conversion, and what the cure makes of them."""
    code, _, variant = message.partition(" ")
    return Cure(code, variant, converting(), text, (change,), given)


def _set(message: str, setting: str) -> Cure:
    """A setting of a conversion to a CL file, which is left out then."""
    text = f"trunnion convert part.nc --machine {FANUC} --to-cl --output q.cls --set {setting}"
    return script(message, text, f" --set {setting}", "")


_NC: Final = "".join(PROGRAMS[FANUC])
_CL: Final = HEAD + FOOT
_TO_CL: Final = {"to_cl": "yes"}

_RESTATED: Final = "G0 G43 H1 X0. Y0. Z50."
_STILL: Final = "%\nO0001\nG21 G90 G54\nT1 M6\nG53 G0 Z0.\nM30\n%\n"

CURES: Final = (
    _argument("CNV110 no_target", _CL, {"to_cl": "yes"}),
    _argument("CNV110 two_targets", _NC, {"to_machine": None}, machine=FANUC, to_cl="yes", to_machine="yl569"),
    Cure("CNV110", "missing_source_machine", converting(to_machine="yl569"), _CL, (), cured_by=post("yl569")),
    Cure("CNV110", "read_as_cl_file", converting(**_TO_CL), _NC, (), cured_by=converting(machine=FANUC, **_TO_CL)),
    _argument("CNV111 unknown_choice", _CL, {"cl_units": "mm"}, to_cl="yes", cl_units="furlong"),
    _argument("CNV111 no_meaning_between_cl_files", _CL, {"title": None}, to_cl="yes", title="A"),
    within("CNV120 not_understood", "- G777"),
    Cure("CNV121", "no_motion_at_part", converting(machine=FANUC, **_TO_CL), _STILL, ((_STILL, _NC),)),
    Cure("CNV121", "", converting(machine=FANUC, **_TO_CL), _STILL, ((_STILL, _NC),)),
    within("CNV130 cannot_be_converted", "- M19"),
    edited("CNV144 selects_none", "G21 G17 G90 G94 G40 G80\n", "G21 G17 G90 G94 G40 G80 G54\n"),
    edited("CNV144 selects_offset_of_its_own", "G21 G17 G90 G94 G40 G80\n", "G21 G17 G90 G94 G40 G80 G54\n", cl=False),
    within("CNV150", "COMPCAD", on="yl569"),
    within("CNV150 not_carried", "COMPCAD", on="yl569"),
    within("CNV150 variable_not_carried", "R7=5", on="yl569"),
    within("CNV150 stock_not_carried", "BLK FORM 0.1 Z X+0 Y+0 Z-20", "BLK FORM 0.2 X+100 Y+100 Z+0", on=TNC),
    within("CNV151 word_machine_s", "- M88", cl=False),
    edited("CNV153 skips_tool", "/T1 M6", "T1 M6"),
    edited("CNV153 skips_head", "/S1000 M3", "S1000 M3"),
    edited("CNV153 skips_length", "/G0 G43 H1 X0. Y0. Z50.", "G0 G43 H1 X0. Y0. Z50."),
    edited("CNV153 skips_machine_move", "/G53 G0 Z0.", "G53 G0 Z0."),
    edited("CNV154 cuts_without_spindle", "S1000\n", "S1000 M3\n"),
    edited("CNV154 cuts_without_tool", "T1\n", "T1 M6\n"),
    edited("CNV154 no_end", "G53 G0 Z0.\n%", "G53 G0 Z0.\nM30\n%"),
    within("CNV160 tool_turns_point", "TRAORI", "G54", "G0 X0 Y0 Z50", "ORIWKS", "ORIVECT", "G1 Z5 F100", "G1 X5 B10",
        "G1 X6 B0",
        "TRAFOOF", "G54",
        on="yl569"),
    within("CNV161 goes_machine_position", "SUPA G0 Z300 D0", "G0 X0 Y0 Z50 D1", on="yl569"),
    within("CNV163 spline_program_lines", "G1 X1 Y0 Z5 F100", "POLY PO[X]=(10) PO[Y]=(2,1)", "G1 X12", on="yl569"),
    within("CNV170 spindle_stops_angle", "- M19"),
    within("CNV171 cuts_where_tip", "G1 Z-1. F100", "G53 G0 Z0.", f"+ {_RESTATED}"),
    within("CNV172 radius_compensation_stays", "G1 Z-1. F100", "G41 D1 X5. Y5.", "X20.", "+ G40 X30. Y9.", "G53 G0 Z0.",
        "- G40", _RESTATED),
    edited("CNV173 length_radius_tool", "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z", "TOOL CALL 1 Z", on=TNC),
    edited("CNV173 dl_dr_tool", "TOOL CALL 1 Z S1000 DL+1", "TOOL CALL 1 Z S1000", on=TNC),
    edited("CNV174", "G53 G0 Z0.\nT2 M6\nM30", "G53 G0 Z0.\nM30"),
    within("CNV175 tool_leaves_workpiece", "G1 Z-1. F100", "X5.", "G53 G0 Z0.", _RESTATED),
    Cure("CNV110", "no_meaning_for_cl_files", converting(**_TO_CL), _CL,
         ({"tool_length": None},), {"tool_length": "50"}),
    _argument("CNV110 dialect_without_cl_file", _NC, {"to_dialect": None}, machine=FANUC, to_machine="yl569",
              to_dialect="catia"),
    _argument("CNV111 program_states_unit", _NC, {"cl_units": None}, machine=FANUC, to_cl="yes", cl_units="mm"),
    within("CNV170 constant_surface_speed", "- G96 S100", "+ G97 S1000", force="yes"),
    within("CNV170 moves_feed_position", "G1 Z-1. F100", "- G53 X0 Y0", "+ G53 G0 Z0", "G0 X0 Y0", "Z50"),
    within("CNV163 block_surface_normal", "M128", "LN X+5 Y+0 Z+0 NX+0 NY+0 NZ+1 F100", "M129", on=TNC),
    within("CNV180 no_feed_mm", "TRAORI", "G54", "G0 X0 Y0 Z5", "G93 G1 B10 F2", "G94", "G1 B0 F100", "TRAFOOF", "G54",
        on="yl569"),
    within("CNV180", "TRAORI", "G54", "G0 X0 Y0 Z5", "G93 G1 B10 F2", "G94", "G1 B0 F100", "TRAFOOF", "G54",
        on="yl569"),
    within("CNV155 means_something_else", "G1 Z-1. F100", "- /G1 X5.", "+ G1 X5.", "Y5."),
    within("CNV150 t_not_carried", 'T="NEXT"', on="yl569"),
    script("CNV141 no_such_offset_but", "trunnion post part.cls --machine yl569 --set work_offset=G505 --output p.mpf\n"
           "trunnion convert p.mpf --machine yl569 --to-machine matsuura_mx330 --output q.nc", "--output q.nc",
           "--set work_offset=G54 --output q.nc"),
    within("CNV140 not_carried_over", "CYCLE832(.02,1,.02)", on="yl569", cl=False),
    _set("CNV111 no_dialect_of_programs", "dialect=apt"),
    _set("CNV111 only_of_cl_files", "open_cycle=ends"),
    _set("CNV111 cl_file_in_mm", "units=inch"),
    _set("CNV111 no_zero_in_cl_files", "zero=0,0,0"),
    within("CNV143 within_operation", "G1 Z-1. F100", "+ G0 Z50.", "+ M5", "+ T2 M6", "+ S1000 M3", "G55",
        "+ G0 G43 H2 X0. Y0. Z50.", "+ G1 Z-1.", "X5."),
    within("CNV176 cycle_toolpath_does", "- G98 G88 X5. Y5. Z-3. R2. P100 F100.", "- G80", "+ G0 X5. Y5.",
        "+ G1 Z-3. F100.", "+ G0 Z50."),
    within("CNV176 cycle_does_not", "- G18", "G98 G84 X5. Y3. Z-5. R2. F1000.", "G80", "+ S1000 M3", "G17"),
    marked("CNV170 m60_changes_pallet", converting(machine="xyzac_trt", **_TO_CL), "- M60",
           head="G21 G90 G94 G54\nT5 M6\nS500 M3\nG43 H5\nG0 X0 Y0 Z50\nG1 X5 F100\n", foot="G53 G0 Z0\nG49\nM2\n"),
    script("CNV178 program_says_must", "edit part.cls 4000.0 90000.0\ntrunnion post part.cls --machine yl569 --force "
           "--output p.mpf\ntrunnion convert p.mpf --machine yl569 --to-cl --output q.cls", "90000.0", "4000.0"),
    marked("CNV140 setting_unknown_there", run, "trunnion post part.cls --machine dmu65 --set tolerance=0.02 "
           "--output p.h", "trunnion convert p.h --machine dmu65 --to-machine hs664rt --output q.nc"),
    within("CNV170 block_skip_signs", "R1=1", "AGAIN:", "- /G1 X5 F100", "+ G1 X5 F100", "X6", "R1=R1+1",
        "IF R1<3 GOTOB AGAIN", on="yl569"),
)  # fmt: skip
