"""Cures of messages about conversions: more of them, by the lines that go out and come in, and by arguments."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import trunnion
from tests.support.cures.cure import Change, Cure, Outcome, Trial, marked, post
from tests.support.cures.scripts import run, script
from tests.support.posting import FOOT, HEAD
from trunnion.errors import TrunnionError

_ARGUMENTS: Final = ("machine", "to_machine", "to_cl", "to_dialect", "dialect", "units", "zero", "tool_length", "force",
                     "positions")  # fmt: skip
_FANUC: Final = "matsuura_mx330"
_TNC: Final = "dmu65"


def _convert(**fixed: str) -> Trial:
    """Return what converts a file; settings are arguments, and settings of the new program."""

    def converted(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        stated = {**fixed, **settings}
        file = folder / ("part.h" if stated.get("machine") == _TNC else "part.nc")
        file.write_text(text, encoding="utf-8")
        given: dict[str, Any] = {key: value for key, value in stated.items() if key in _ARGUMENTS}
        for key in ("to_cl", "force"):
            given |= {key: True} if key in given else {}
        if "tool_length" in given:
            given["tool_length"] = float(given["tool_length"])
        more = {key: value for key, value in stated.items() if key not in _ARGUMENTS}
        try:
            found = trunnion.convert(file, settings=more or None, **given)
        except TrunnionError as error:
            return Outcome(tuple(error.problems), False)
        return Outcome(found.problems, found.passed)

    return converted


_PROGRAMS: Final = {
    _FANUC: (
        "%\nO0001\nG21 G17 G90 G94 G40 G80 G54\nT1 M6\nS1000 M3\nG0 G43 H1 X0. Y0. Z50.\n",
        "G1 Z-1. F100\nX10.\nG0 X20.\nZ50.\nM5\nG53 G0 Z0.\nM30\n%\n",
    ),
    "yl569": (
        "G710 G17 G90 G94 G54\nT1\nM6\nS1000 M3\nG0 X0 Y0 Z50 D1\n",
        "G1 Z-1 F100\nX10\nG0 X20\nZ50\nM5\nSUPA G0 Z0 D0\nM30\n",
    ),
    _TNC: (
        "BEGIN PGM A MM\nCYCL DEF 247 DATUM SETTING Q339=1\nTOOL CALL 1 Z S1000\nM3\nL X+0 Y+0 Z+50 R0 FMAX\n",
        "L Z-1 F100\nL X+10\nL X+20 FMAX\nL Z+50 FMAX\nM5\nL Z+560 R0 FMAX M91\nEND PGM A MM\n",
    ),
}


def _in(message: str, *lines: str, on: str = _FANUC, cl: bool = True, **given: str) -> Cure:
    """Lines of a program above its first cut, converted to a CL file, or for another machine."""
    head, foot = _PROGRAMS[on]
    target = {"to_cl": "yes"} if cl else {"to_machine": "yl569" if on != "yl569" else _TNC}
    return marked(message, _convert(machine=on, **target, **given), *lines, head=head, foot=foot)


def _edited(message: str, wrong: str, cured: str, on: str = _FANUC, cl: bool = True, **given: str) -> Cure:
    """A line of a program in place of one of it, and that line."""
    code, _, variant = message.partition(" ")
    text = "".join(_PROGRAMS[on])
    assert cured in text
    target = {"to_cl": "yes"} if cl else {"to_machine": "yl569" if on != "yl569" else _TNC}
    return Cure(code, variant, _convert(machine=on, **target, **given), text.replace(cured, wrong), ((wrong, cured),))


def _argument(message: str, text: str, change: Change, **given: str) -> Cure:
    """Arguments of a conversion, and what the cure makes of them."""
    code, _, variant = message.partition(" ")
    return Cure(code, variant, _convert(), text, (change,), given)


def _set(message: str, setting: str) -> Cure:
    """A setting of a conversion to a CL file, which is left out then."""
    text = f"trunnion convert part.nc --machine {_FANUC} --to-cl --output q.cls --set {setting}"
    return script(message, text, f" --set {setting}", "")


_NC: Final = "".join(_PROGRAMS[_FANUC])
_CL: Final = HEAD + FOOT
_TO_CL: Final = {"to_cl": "yes"}

_RESTATED: Final = "G0 G43 H1 X0. Y0. Z50."
_STILL: Final = "%\nO0001\nG21 G90 G54\nT1 M6\nG53 G0 Z0.\nM30\n%\n"

CURES: Final = (
    _argument("CNV110 no_target", _CL, {"to_cl": "yes"}),
    _argument("CNV110 two_targets", _NC, {"to_machine": None}, machine=_FANUC, to_cl="yes", to_machine="yl569"),
    Cure("CNV110", "missing_source_machine", _convert(to_machine="yl569"), _CL, (), cured_by=post("yl569")),
    Cure("CNV110", "read_as_cl_file", _convert(**_TO_CL), _NC, (), cured_by=_convert(machine=_FANUC, **_TO_CL)),
    _argument("CNV111 unknown_choice", _CL, {"cl_units": "mm"}, to_cl="yes", cl_units="furlong"),
    _argument("CNV111 no_meaning_between_cl_files", _CL, {"title": None}, to_cl="yes", title="A"),
    _in("CNV120 not_understood", "- G777"),
    Cure("CNV121", "no_motion_at_part", _convert(machine=_FANUC, **_TO_CL), _STILL, ((_STILL, _NC),)),
    Cure("CNV121", "", _convert(machine=_FANUC, **_TO_CL), _STILL, ((_STILL, _NC),)),
    _in("CNV130 cannot_be_converted", "- M19"),
    _edited("CNV144 selects_none", "G21 G17 G90 G94 G40 G80\n", "G21 G17 G90 G94 G40 G80 G54\n"),
    _edited("CNV144 selects_offset_of_its_own", "G21 G17 G90 G94 G40 G80\n", "G21 G17 G90 G94 G40 G80 G54\n", cl=False),
    _in("CNV150", "COMPCAD", on="yl569"),
    _in("CNV150 not_carried", "COMPCAD", on="yl569"),
    _in("CNV150 stock_not_carried", "BLK FORM 0.1 Z X+0 Y+0 Z-20", "BLK FORM 0.2 X+100 Y+100 Z+0", on=_TNC),
    _in("CNV151 word_machine_s", "- M88", cl=False),
    _edited("CNV153 skips_tool", "/T1 M6", "T1 M6"),
    _edited("CNV153 skips_head", "/S1000 M3", "S1000 M3"),
    _edited("CNV153 skips_length", "/G0 G43 H1 X0. Y0. Z50.", "G0 G43 H1 X0. Y0. Z50."),
    _edited("CNV153 skips_machine_move", "/G53 G0 Z0.", "G53 G0 Z0."),
    _edited("CNV154 cuts_without_spindle", "S1000\n", "S1000 M3\n"),
    _edited("CNV154 cuts_without_tool", "T1\n", "T1 M6\n"),
    _edited("CNV154 no_end", "G53 G0 Z0.\n%", "G53 G0 Z0.\nM30\n%"),
    _in("CNV160 tool_turns_point", "TRAORI", "G54", "G0 X0 Y0 Z50", "ORIWKS", "ORIVECT", "G1 Z5 F100", "G1 X5 B10",
        "G1 X6 B0",
        "TRAFOOF", "G54",
        on="yl569"),
    _in("CNV161 goes_machine_position", "SUPA G0 Z300 D0", "G0 X0 Y0 Z50 D1", on="yl569"),
    _in("CNV163 spline_program_lines", "G1 X1 Y0 Z5 F100", "POLY PO[X]=(10) PO[Y]=(2,1)", "G1 X12", on="yl569"),
    _in("CNV170 spindle_stops_angle", "- M19"),
    _in("CNV171 cuts_where_tip", "G1 Z-1. F100", "G53 G0 Z0.", f"+ {_RESTATED}"),
    _in("CNV172 radius_compensation_stays", "G1 Z-1. F100", "G41 D1 X5. Y5.", "X20.", "+ G40 X30. Y9.", "G53 G0 Z0.",
        "- G40", _RESTATED),
    _edited("CNV173 length_radius_tool", "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z", "TOOL CALL 1 Z", on=_TNC),
    _edited("CNV173 dl_dr_tool", "TOOL CALL 1 Z S1000 DL+1", "TOOL CALL 1 Z S1000", on=_TNC),
    _edited("CNV174", "G53 G0 Z0.\nT2 M6\nM30", "G53 G0 Z0.\nM30"),
    _in("CNV175 tool_leaves_workpiece", "G1 Z-1. F100", "X5.", "G53 G0 Z0.", _RESTATED),
    Cure("CNV110", "no_meaning_for_cl_files", _convert(**_TO_CL), _CL, ({"tool_length": None},), {"tool_length": "50"}),
    _argument("CNV110 dialect_without_cl_file", _NC, {"to_dialect": None}, machine=_FANUC, to_machine="yl569",
              to_dialect="catia"),
    _argument("CNV111 program_states_unit", _NC, {"cl_units": None}, machine=_FANUC, to_cl="yes", cl_units="mm"),
    _in("CNV170 constant_surface_speed", "- G96 S100", "+ G97 S1000", force="yes"),
    _in("CNV170 moves_feed_position", "G1 Z-1. F100", "- G53 X0 Y0", "+ G53 G0 Z0", "G0 X0 Y0", "Z50"),
    _in("CNV163 block_surface_normal", "M128", "LN X+5 Y+0 Z+0 NX+0 NY+0 NZ+1 F100", "M129", on=_TNC),
    _in("CNV180 no_feed_mm", "TRAORI", "G54", "G0 X0 Y0 Z5", "G93 G1 B10 F2", "G94", "G1 B0 F100", "TRAFOOF", "G54",
        on="yl569"),
    _in("CNV180", "TRAORI", "G54", "G0 X0 Y0 Z5", "G93 G1 B10 F2", "G94", "G1 B0 F100", "TRAFOOF", "G54",
        on="yl569"),
    _in("CNV155 means_something_else", "G1 Z-1. F100", "- /G1 X5.", "+ G1 X5.", "Y5."),
    _in("CNV150 t_not_carried", 'T="NEXT"', on="yl569"),
    script("CNV141 no_such_offset_but", "trunnion post part.cls --machine yl569 --set work_offset=G505 --output p.mpf\n"
           "trunnion convert p.mpf --machine yl569 --to-machine matsuura_mx330 --output q.nc", "--output q.nc",
           "--set work_offset=G54 --output q.nc"),
    _in("CNV140 not_carried_over", "CYCLE832(.02,1,.02)", on="yl569", cl=False),
    _set("CNV111 no_dialect_of_programs", "dialect=apt"),
    _set("CNV111 cl_file_in_mm", "units=inch"),
    _set("CNV111 no_zero_in_cl_files", "zero=0,0,0"),
    _in("CNV143 within_operation", "G1 Z-1. F100", "+ G0 Z50.", "+ M5", "+ T2 M6", "+ S1000 M3", "G55",
        "+ G0 G43 H2 X0. Y0. Z50.", "+ G1 Z-1.", "X5."),
    _in("CNV176 cycle_toolpath_does", "- G98 G88 X5. Y5. Z-3. R2. P100 F100.", "- G80", "+ G0 X5. Y5.",
        "+ G1 Z-3. F100.", "+ G0 Z50."),
    _in("CNV176 cycle_does_not", "- G18", "G98 G84 X5. Y3. Z-5. R2. F1000.", "G80", "+ S1000 M3", "G17"),
    marked("CNV170 m60_changes_pallet", _convert(machine="xyzac_trt", **_TO_CL), "- M60",
           head="G21 G90 G94 G54\nT5 M6\nS500 M3\nG43 H5\nG0 X0 Y0 Z50\nG1 X5 F100\n", foot="G53 G0 Z0\nG49\nM2\n"),
    script("CNV178 program_says_must", "edit part.cls 4000.0 90000.0\ntrunnion post part.cls --machine yl569 --force "
           "--output p.mpf\ntrunnion convert p.mpf --machine yl569 --to-cl --output q.cls", "90000.0", "4000.0"),
    marked("CNV140 setting_unknown_there", run, "trunnion post part.cls --machine dmu65 --set tolerance=0.02 "
           "--output p.h", "trunnion convert p.h --machine dmu65 --to-machine hs664rt --output q.nc"),
    _in("CNV170 block_skip_signs", "R1=1", "AGAIN:", "- /G1 X5 F100", "+ G1 X5 F100", "X6", "R1=R1+1",
        "IF R1<3 GOTOB AGAIN", on="yl569"),
)  # fmt: skip
