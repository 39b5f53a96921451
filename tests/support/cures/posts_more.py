"""Cures of messages about programs that are posted: more of what controls refuse, by lines and by settings."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from tests.support.cures.cure import Cure, Outcome, Trial, marked, post
from tests.support.posting import CLEAR, FOOT, HEAD, LEANING


def _lines(message: str, *lines: str, on: str = "yl569", head: str = HEAD, **settings: str) -> Cure:
    """Lines behind the first cut."""
    return marked(message, post(on), *lines, head=head, foot=FOOT, **settings)


def _settings(
    message: str, change: Mapping[str, str | None], text: str = HEAD, on: str = "yl569", **settings: str
) -> Cure:
    """Settings with which an operation is posted, and the one that the cure gives."""
    code, _, variant = message.partition(" ")
    return Cure(code, variant, post(on), text + FOOT, (change,), settings)


def _defined(text: str, **given: str) -> Trial:
    """Return what posts a CL file on the machine of a definition."""

    def posted(definition: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        machine = folder / "ours.toml"
        machine.write_text('schema = 1\nname = "Ours"\n' + definition, encoding="utf-8")
        return post(str(machine))(text, {**given, **settings}, folder)

    return posted


def _on(definition: str) -> Trial:
    """Return what posts a CL file on the machine of a definition."""

    def posted(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        return _defined(text, **settings)(definition, {}, folder)

    return posted


def _definition(message: str, *lines: str, text: str = HEAD, **settings: str) -> Cure:
    """Lines of the definition of the machine."""
    return marked(message, _defined(text + FOOT, **settings), *lines)


_FEED: Final = "FEDRAT/MMPM,500.0\n"
_OP2: Final = HEAD.replace("OP1", "OP2")
_LEANING2: Final = LEANING.replace("OP1", "OP2").replace("TOOL,1,ADJUST,1", "TOOL,2,ADJUST,2") + FOOT
_TILTED: Final = CLEAR.replace("0.0,0.0,1.0", "0.0,0.6,0.8") + _FEED + "GOTO/10.0,0.0,5.0\n"
_FAN: Final = (
    CLEAR
    + "RAPID\nGOTO/80,0,60,0.8,0,0.6\nCYCLE/BORE,NODRAG,90,RAPTO,3,FEDTO,-12,RTRCTO,9,MMPM,90\nGOTO/32,0,24,0.8,0,0.6\n"
    "GOTO/29.001849185,13.523784376,24,0.725046230,0.338094609,0.6\nCYCLE/OFF\n"
)
_ABOVE: Final = CLEAR.replace("0.0,0.0,1.0", "0.0,0.6,0.8")
_NORMALS: Final = HEAD.replace("0.0000,75", "5.0000,75").replace("RAPID\n", "$$ centerline and contact point\nRAPID\n")
_LEAN: Final = ("GOTO/40,0,5,0.5,0,0.8660254038 $$ 42.5,0,4.330127", "GOTO/50,0,5 $$ 52.5,0,4.330127")
_CONTOUR: Final = "$$ contour data\nCUTCOM/LEFT\nGOTO/20,9,5\nGOTO/20,20,5\nCUTCOM/OFF\nGOTO/30,20,5"
_CENTRE: Final = "CUTCOM/LEFT\nGOTO/20,9,5\nCUTCOM/OFF\nGOTO/30,9,5"
#: Variants of CTL220 that leave out CUTCOM: where, how it is written, the machine, and the settings.
_LEFT_OUT: Final[tuple[tuple[str, str, str, str, Mapping[str, str]], ...]] = (
    ("cutcom_where_tool", _TILTED, "", "yl569", {"mode": "tcp"}),
    ("cutcom_where_tool_not", LEANING, ",ZXPLAN", "yl569", {}),
    ("cutcom_where_control", _TILTED, "", "dmu65", {"mode": "tcp"}),
    ("cutcom_where_control_takes", HEAD, ",ZXPLAN", "dmu65", {"mode": "tcp"}),
    ("cutter_radius_compensation", LEANING, "", "matsuura_mx330", {}),
    ("cutter_radius_compensation_plane", HEAD, ",YZPLAN", "xyzac_trt", {}),
    ("cutter_radius_compensation_without", LEANING, "", "dmu65", {"tcp": "off", "zero": "0,0,100"}),
)
_TAP: Final = "TAP,FEDTO,-10,RAPTO,3,MMPR,1"

CURES: Final = (
    *(
        _settings(f"CTL220 {variant}", {"compensation": "OP1:left_out"},
                  f"{head}CUTCOM/LEFT{plane}\nGOTO/20,9,5\nCUTCOM/OFF\nGOTO/30,9,5,0,0,1\n", on, **given)
        for variant, head, plane, on, given in _LEFT_OUT
    ),
    _settings("CTL220 contour_not_left_out", {"compensation": "OP1:programmed"},
              HEAD + "$$ contour data\nCUTCOM/LEFT\nGOTO/20,9,5\nGOTO/20,20,5\nCUTCOM/OFF\nGOTO/30,20,5\n",
              compensation="left_out"),
    _lines("CTL220 cutcom_left_out", "CUTCOM/LEFT", "GOTO/20,9,5", "CUTCOM/OFF", "GOTO/30,9,5",
           compensation="left_out"),
    marked("CTL320 speed_replaced", post(), "GOTO/20,0,5", head=HEAD.replace("4000.0", "0.4"), foot=FOOT,
           spindle="OP1:400"),
    _settings("ARG230 no_cutcom_there", {"compensation": None}, compensation="OP1:left_out"),
    _lines("CTL110 word_beyond_format", "- FEDRAT/MMPM,1e9", "+ FEDRAT/MMPM,1000", "GOTO/20,0,5", on="matsuura_mx330"),
    _lines("CTL120 line_more_bytes", "- INSERT/(MSG, " + "x" * 300 + ")", "+ INSERT/(MSG, x)", on="xyzac_trt"),
    _lines("CTL220 contour_and_centre", _CONTOUR, FOOT + _OP2.rstrip(), "- CUTCOM/LEFT", "+ CUTCOM/LEFT,7",
           "GOTO/20,9,5", "GOTO/20,20,5", "CUTCOM/OFF",
           "GOTO/30,9,5", on="matsuura_mx330"),
    _lines("CTL220 cutcom_before_circle", "GOTO/20,0,5", "CUTCOM/LEFT", "+ GOTO/20,5,5", "- CIRCLE/20,10,5,0,0,1,10",
           "+ CIRCLE/20,15,5,0,0,1,10",
           "- GOTO/30,10,5", "+ GOTO/30,15,5", "+ GOTO/30,30,5", "CUTCOM/OFF", "GOTO/40,40,5", on="matsuura_mx330"),
    _lines("CTL220 cutcom_where_cycle", "- CUTCOM/LEFT", "CYCLE/DRILL,RAPTO,3,FEDTO,-20,MMPM,100", "GOTO/20,0,0",
           "- CUTCOM/OFF", "CYCLE/OFF"),
    _lines("CTL220 cutcom_where_tool_not", "- CUTCOM/LEFT,ZXPLAN", "GOTO/20,9,5,0,0,1", "- CUTCOM/OFF", "GOTO/30,0,5",
           head=LEANING),
    _settings("CTL220 cutcom_where_control", {"mode": "OP1:tilted"},
              _TILTED + "CUTCOM/LEFT\nGOTO/20,9,5\nCUTCOM/OFF\nGOTO/30,9,5\n",
              "dmu65", mode="tcp"),
    _lines("CTL220 cutcom_where_control_takes", "- CUTCOM/LEFT,ZXPLAN", "GOTO/20,9,5", "- CUTCOM/OFF", "GOTO/30,9,5",
           on="dmu65", mode="tcp"),
    _lines("CTL220 cutter_radius_compensation", "- CUTCOM/LEFT", "GOTO/20,9,5", "- CUTCOM/OFF", "GOTO/30,9,5,0,0,1",
           head=LEANING,
           on="matsuura_mx330"),
    _lines("CTL220 cutter_radius_compensation_plane", "- CUTCOM/LEFT,YZPLAN", "GOTO/20,9,5", "- CUTCOM/OFF",
           "GOTO/30,9,5", on="xyzac_trt"),
    _lines("CTL220 cutter_radius_compensation_without", "- CUTCOM/LEFT", "GOTO/20,9,5", "- CUTCOM/OFF",
           "GOTO/30,9,5,0,0,1", head=LEANING,
           on="dmu65", tcp="off", zero="0,0,100"),
    _lines("CTL220 radius_compensation_plane", "- CUTCOM/LEFT,ZXPLAN", "+ CUTCOM/LEFT,XYPLAN", "GOTO/20,9,5",
           "CUTCOM/OFF", "GOTO/30,9,5",
           on="dmu65"),
    _lines("CTL240 would_not_see", "CUTCOM/LEFT", "GOTO/20,9,5", "- STOP", "GOTO/30,9,5", "CUTCOM/OFF", "GOTO/40,9,5",
           "+ STOP"),
    _lines("CTL310 cutting_motion_without", "+ FEDRAT/MMPM,500", "GOTO/20,0,5", head=CLEAR, feed="fastest",
           feed_limit="500"),
    _settings("CTL315 lines_mm_min", {"rapid_feed": "5000"}, HEAD + "FEDRAT/MMPM,3000\nGOTO/20,0,5\n", "hs664rt",
              rapid_feed="3000"),
    _lines("CTL320 feed_below_least", "- FEDRAT/MMPR,0.0001", "+ FEDRAT/MMPM,0.4", "GOTO/20,0,5", on="matsuura_mx330"),
    _lines("CTL320 feed_below_least_control", "- FEDRAT/MMPM,0.2", "+ FEDRAT/MMPM,2", "GOTO/20,0,5", on="hs664rt"),
    _lines("CTL320 feed_prints", "- FEDRAT/MMPM,2.5", "+ FEDRAT/MMPM,3", "GOTO/20,0,5", on="hs664rt"),
    _lines("CTL320 feed_prints_off", "- FEDRAT/MMPR,0.0143", "+ FEDRAT/MMPM,57.2", "GOTO/20,0,5", on="matsuura_mx330"),
    _lines("CTL330 feed_per_revolution_without", "- FEDRAT/MMPR,0.1", "+ FEDRAT/MMPM,400", "GOTO/20,0,5,0,0,1",
           head=LEANING, on="dmu65",
           tcp="off", zero="0,0,100"),
    Cure("CTL340", "rotary_feed_tip",
         _on('extends = "generic_head_table_bc"\n[control]\nextends = "heidenhain_tnc640"\n'), LEANING + FOOT,
         ({"rotary_feed": None},), {"tcp": "off", "zero": "0,0,0", "tool_length": "50", "rotary_feed": "tip"}),
    _settings("CTL370 bore_nodrag_while", {"holes": "planes"},
              _FAN, on="yl569", holes="torot", bore_lift="0.5"),
    _settings("CTL370 hole_with_tcp", {"mode": None}, _ABOVE + f"CYCLE/{_TAP}\nGOTO/32,0,5\nCYCLE/OFF\n", mode="tcp"),
    _settings("CTL370 with_tcp", {"mode": None}, _ABOVE + f"CYCLE/{_TAP}\nGOTO/32,0,5\nCYCLE/OFF\n", "dmu65",
              mode="tcp"),
    _lines("CTL370 no_planes", "RAPID", "- GOTO/10,0,50,0,0.6,0.8", "+ GOTO/10,0,50", f"CYCLE/{_TAP}", "GOTO/32,0,5",
           "CYCLE/OFF", on="xyzac_trt", head=CLEAR),
    _lines("CTL425", "DELAY/0.0001", on="matsuura_mx330"),
    _lines("CTL460 cutcom_waits", "CUTCOM/LEFT", "GOTO/-30,0,20", "OPSKIP/ON", "GOTO/0,0,20", "- CUTCOM/OFF",
           "OPSKIP/OFF", "+ CUTCOM/OFF",
           "GOTO/0,-20,20", on="dmu65"),
    _lines("CTL460 opskip_ends_operation", "OPSKIP/ON", "GOTO/20,0,5", "+ OPSKIP/OFF"),
    _lines("CTL460 tool_axis_turns", "RAPID", "GOTO/0,0,30", "CYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100", "GOTO/0,0,0",
           "OPSKIP/ON", "GOTO/5,0,0",
           "+ OPSKIP/OFF", "GOTO/7,0,0", "GOTO/20,0,0,0.5,0,0.86602540378444", "+ OPSKIP/ON", "+ GOTO/20,3,0",
           "OPSKIP/OFF", "GOTO/20,5,0", "CYCLE/OFF"),
    _lines("CTL470 new_speed_in_cut", "GOTO/20,0,5,0.5,0.0,0.8660254038", "+ RAPID", "+ GOTO/20,0,60",
           "SPINDL/RPM,7000,CLW", "+ GOTO/20,0,5",
           "GOTO/30,0,5,0.0,-0.5,0.8660254038", on="dmu65", tcpm="m128"),
    _lines("CTL540 cut_first_motion", "+ RAPID", "+ GOTO/0,0,60,0.5,0,0.8660254037844386", "+ FEDRAT/MMPM,500",
           "GOTO/0,0,50,0.5,0,0.8660254037844386", "GOTO/10,0,5", on="haas_umc750",
           head=CLEAR.replace("RAPID\nGOTO/0.0,0.0,50.0,0.0,0.0,1.0\n", _FEED)),
    _lines("CTL610 circle_can_have", "GOTO/20,0,5 $$ 20,0,5", "GOTO/30,0,5 $$ 27,0,6", "- CIRCLE/40,0,5,0,0,1,10",
           "GOTO/40,10,5",
           head=_NORMALS, on="dmu65", normals="contact"),
    _settings("CTL610 operation_tcp_control", {"orientation": "vector"},
              _NORMALS + "GOTO/20,0,5 $$ 20,0,5\n" + "\n".join(_LEAN) + "\n", "dmu65",
              normals="contact"),
    _settings("CTL610 operation_surface_normals", {"normals": None},
              _NORMALS + "GOTO/20,0,5 $$ 20,0,5\n" + "\n".join(_LEAN) + "\n", "dmu65",
              normals="contact", tcp="off", zero="0,0,100"),
    _lines("CTL620 operation_no_contact", "GOTO/20,0,5 $$ 20,0,5", "GOTO/30,0,5 $$ 27,0,6", head=_NORMALS, on="dmu65",
           normals="contact"),
    _settings("CTL715 length_is_that_of_edge", {"edge": "5"}, HEAD.replace("ADJUST,1", "ADJUST,5")),
    _settings("CTL715 length_is_that_of_edge", {"edge_from": "adjust"}, HEAD.replace("ADJUST,1", "ADJUST,5")),
    _settings("CTL730 way_not_known", {"zero": "0,0,0", "tool_length": "50"}, _TILTED, "generic_head_table_bc"),
    _lines("CTL810 unseen_characters_left_out", "- STOP/A\u200bB", "+ STOP/AB"),
    _settings("CTL820 tool_called_name", {"tool_call": "number"}, HEAD.replace("D10", "\u51f8"), encoding="ascii",
              tool_call="name"),
    _lines("CTL458 goes_home", FOOT + _OP2.rstrip(), same_tool="clearance", restart="on"),
    _lines("CTL458 retracts", FOOT + _OP2.rstrip(), same_tool="clearance", stop_between="on"),
    _definition("CTL720 travel_not_stated", 'extends = "hs664rt"',
                *(f'+ [[axis]]\n+ name = "{axis}"\n+ limits_mm = [-300, 300]'.replace("\n+ ", "\n") for axis in "XYZ")),
    _definition("CTL720 retract_is_assumed", 'extends = "xyzac_trt"', '+ [[axis]]\nname = "Z"\nhome_mm = 0.0'),
    _definition("CTL810 definition_writes_no", 'extends = "yl569"', "[control]", "[control.templates]",
                '- program_start = "; \u00e9"',
                encoding="ascii"),
    _definition("CTL455 calls_subprogram", 'extends = "matsuura_mx330"',
                '+ [control.known]\n"M98 P77" = "comes back: probes"',
                text=HEAD + "INSERT/M98 P77\n"),
    _definition("CTL910 can_be_forced", 'extends = "yl569"', "[control]", "[control.templates]",
                '- program_start = "G91"'),
    _definition("CL210 unknown_refused", 'extends = "yl569"', '+ [control.statements]\n"CLAMP/ON" = ""',
                text=HEAD + "CLAMP/ON\n"),
    _lines("CTL940 can_be_forced", "- SPINDL/RPM,90000,CLW", "+ SPINDL/RPM,6000,CLW", "GOTO/20,0,5"),
    _lines("CTL940", "- SPINDL/RPM,90000,CLW", "+ SPINDL/RPM,6000,CLW", "GOTO/20,0,5"),
    _settings("PLN310 not_supported", {"mode": None}, _TILTED, "xyzac_trt", mode="tilted"),
    marked("PLN320 operation_control_does", post("xyzac_trt"), _TILTED.rstrip(), foot=FOOT),
    marked("PLN320 operation_control_does_not", post("xyzac_trt"), _TILTED.rstrip(), foot=FOOT, tcp="off",
           zero="0,0,0"),
    _lines("PLN640 as_motion", "CYCLE/DRILL,DEEP,FEDTO,-10,RAPTO,3,STEP,4,1,1,MMPM,100", "GOTO/50,0,0", "CYCLE/OFF",
           on="matsuura_mx330", head=CLEAR),
    _lines("PLN160", *(f"- GOTO/{k},0,5,0,0,-1" for k in range(30)), *(f"+ GOTO/{k},0,5,0,0,1" for k in range(30))),
    _lines("PLN120 in_hole", "CYCLE/DRILL,FEDTO,-10,RAPTO,3,MMPM,100", "- GOTO/20,0,5,0,0,-1", "+ GOTO/20,0,5,0,0,1",
           "CYCLE/OFF", head=CLEAR),
    Cure("PLN110", "no_rotary_position", post("generic_nutated_b45_c"),
         HEAD + "GOTO/20,0,5,0,0.98480775,-0.17364818\n" + FOOT, (),
         cured_by=post("generic_head_head_ca")),
    Cure("PLN530", "tools_program_without", post("generic_head_head_ca"), LEANING + FOOT + _LEANING2,
         ((_LEANING2, ""),),
         {"tcp": "off", "zero": "0,0,0", "tool_length": "100"}),
    _lines("PLN130 axis_turns_over", "GOTO/20,0,5,0,0,1", "CIRCLE/20,10,5,0,0,1,10", "- GOTO/30,10,5,0,0,-1",
           "+ GOTO/30,10,5,0,0,1"),
)  # fmt: skip
