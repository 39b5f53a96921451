"""Cures of messages about programs that are posted: what planner and controls refuse."""

from collections.abc import Mapping
from typing import Final

from tests.support.cures.cure import Change, Cure, post
from tests.support.posting import CLEAR, FOOT, HEAD, LEANING

_SECOND: Final = HEAD.replace("OP1", "OP2")
_CUT: Final = HEAD + "GOTO/20,0,5\n" + FOOT
_DRILL: Final = "CYCLE/DRILL,FEDTO,-10,RAPTO,3,MMPM,100\n"
_UNNUMBERED: Final = HEAD.replace("LOAD/TOOL,1,ADJUST,1\n", "")
_FEED: Final = "FEDRAT/MMPM,500.0\n"
_SPEED: Final = "SPINDL/RPM,4000.0000,CLW\n"
_TLDATA: Final = "TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000\n"
_TOOL: Final = "LOAD/TOOL,1,ADJUST,1\n"


def _said(code: str, variant: str, text: str, *changes: Change, on: str = "yl569", **settings: str) -> Cure:
    return Cure(code, variant, post(on), text, changes, settings)


def _within(
    code: str, variant: str, line: str, cured: str | Mapping[str, str | None], on: str = "yl569", **settings: str
) -> Cure:
    """A line behind the first cut, and what stands in its place."""
    text = f"{HEAD}{line}\nGOTO/20,0,5\n{FOOT}"
    change: Change = cured if not isinstance(cured, str) else (f"{line}\n", cured and f"{cured}\n")
    return _said(code, variant, text, change, on=on, **settings)


def _holes(
    code: str, variant: str, cycle: str, cured: str | Mapping[str, str | None], on: str = "yl569", **settings: str
) -> Cure:
    """A cycle with two holes, and the cycle in its place, or settings."""
    text = f"{CLEAR}{cycle}\nGOTO/50,0,0\nGOTO/60,0,0\nCYCLE/OFF\n{FOOT}"
    change: Change = cured if not isinstance(cured, str) else (f"{cycle}\n", cured and f"{cured}\n")
    return _said(code, variant, text, change, on=on, **settings)


_COMPENSATED: Final = f"{HEAD}CUTCOM/LEFT\nGOTO/20,0,5\nGOTO/20,30,5\nCUTCOM/OFF\nGOTO/0,30,5\n{FOOT}"

_BARE: Final = _UNNUMBERED.replace(_SPEED, "")
_TWO_BARE: Final = _BARE + FOOT + _BARE.replace("OP1", "OP 2").replace("D10", "D12") + FOOT
_TWO_UNNUMBERED: Final = _UNNUMBERED + FOOT + _UNNUMBERED.replace("OP1", "OP 2").replace("D10", "D12") + FOOT

_SIDES: Final = (
    HEAD.replace("50.0,0.0,0.0,1.0", "50.0,0.0,0.6,0.8").replace(_FEED, _FEED + "CUTCOM/LEFT,XYPLAN\n")
    + "GOTO/20,0,5\nGOTO/30,0,5\nCUTCOM/OFF\nGOTO/40,0,5\n"
    + FOOT
)
_WIDE: Final = HEAD + "GOTO/300,0,5\nGOTO/-300,0,5\n" + FOOT

_FLIPPED: Final = LEANING + "GOTO/10.1,0.0,5.0,0.6,0.0,0.8\n" + FOOT

#: A corner with radius compensation.
_BESIDE: Final = "GOTO/20,0,5\nCUTCOM/LEFT\nGOTO/40,0,5\nGOTO/40,30,5\nCUTCOM/OFF\nGOTO/60,60,5\n"

CURES: Final = (
    _said("NC390", "too_slow_for_feed", _FLIPPED, {"lower_feed": "yes"}),
    _said("NC390", "too_slow_for_feed", _FLIPPED, {"feed": "fastest"}),
    _said("CTL220", "cutcom_where_tool", _SIDES, {"mode": "OP1:tilted"}, mode="tcp"),
    _said("CTL220", "cutcom_where_tool", _SIDES, ("CUTCOM/LEFT,XYPLAN\n", ""), ("CUTCOM/OFF\n", ""), mode="tcp"),
    _said(
        "CTL220",
        "cutcom_begins_twice",
        _COMPENSATED.replace("GOTO/20,30", "CUTCOM/RIGHT\nGOTO/20,30"),
        ("CUTCOM/RIGHT\n", "CUTCOM/OFF\nGOTO/25,9,5\nCUTCOM/RIGHT\n"),
        on="xyzac_trt",
    ),
    _said(
        "CTL220",
        "cutcom_changes_side",
        _COMPENSATED.replace("GOTO/20,30", "CUTCOM/RIGHT\nGOTO/20,30"),
        ("CUTCOM/RIGHT\n", "CUTCOM/OFF\nGOTO/25,9,5\nCUTCOM/RIGHT\n"),
        on="dmu65",
    ),
    Cure("PLN125", "axis_would_go", post("yl569"), _WIDE, (), cured_by=post("generic_head_head_ca")),
    _within("CTL230", "cutcom_names_register", "CUTCOM/LEFT,XYPLAN,7", "CUTCOM/LEFT,XYPLAN", on="dmu65"),
    _within("CTL430", "gohome_before_operation", "GOHOME", ""),
    _within("CTL430", "tool_change_within", "LOAD/TOOL,2", f"{FOOT}{_SECOND}".strip()),
    _said("CTL820", "insert_goes_into", HEAD + "INSERT/; Ж\n" + FOOT, ("Ж", "Z"), encoding="ascii"),
    _said("CTL810", "only_encoding_lacks_letter", HEAD.replace("OP1", "凸") + FOOT, ("凸", "A"), on="matsuura_mx330"),
    _said("CTL115", "line_brings_block", HEAD + "INSERT/N10 MSG()\n" + FOOT, {"numbers": "off"}),
    _said("PLN510", "without_tcp_program", LEANING + FOOT, {"zero": "0,0,100"}, tcp="off", on="dmu65"),
    _said("ARG210", "unknown_but_near", _CUT, {"mdoe": None, "mode": "tcp"}, mdoe="tcp"),
    _said("ARG220", "no_choice", _CUT, {"programs": "one"}, programs="several"),
    _said("ARG220", "out_of_range", _CUT, {"axis_tolerance": "0.05"}, axis_tolerance="50"),
    _said("ARG220", "only_with_fastest_feed", _CUT, {"feed": "fastest"}, feed_limit="5000"),
    _said("ARG220", "lower_feed_with_fastest", _CUT, {"lower_feed": None}, feed="fastest", lower_feed="yes"),
    _said("ARG220", "unknown_mode", _CUT, {"mode": "auto"}, mode="quick"),
    _said("ARG220", "mode_twice", _CUT, {"mode": "auto,OP1:tcp"}, mode="OP1:tcp,OP1:tilted"),
    _said("ARG220", "value_twice", _CUT, {"spindle": "500"}, spindle="500,600"),
    _said("ARG230", "states_own_speed", _CUT, {"spindle": None}, spindle="OP1:500"),
    _said("ARG230", "no_operation_before_colon", _CUT, {"tool": "OP1:7"}, tool="OP9:7"),
    _said("ARG230", "two_values_of_operation", _CUT, {"tool": "OP1:7"}, tool="OP1:7,OP1:8"),
    _said("ARG240", "split_without_subprograms", _CUT, {"split": None}, split="100000"),
    _said(
        "ARG240",
        "first_number_without_subprograms",
        _CUT,
        {"first_number": None},
        first_number="7",
        on="matsuura_mx330",
    ),
    _said("ARG250", "first_block_of_control", _CUT, {"first_block": None}, on="mikron_600u", first_block="7"),
    _said("ARG250", "first_block_without_numbers", _CUT, {"numbers": "on"}, first_block="7", numbers="off"),
    _said("ARG250", "first_block_beyond", _CUT, {"first_block": "500"}, on="matsuura_mx330", first_block="99999999"),
    _said("ARG240", "first_number_without_numbers", _CUT, {"first_number": None}, first_number="7"),
    _said("ARG250", "no_numbers_of_operations", _CUT, {"numbers": None}, numbers="operations", on="mikron_600u"),
    _said("ARG250", "units_inch_no", _CUT, {"units": None}, units="inch", on="hs664rt"),
    _said("ARG250", "no_file_to_name", _CUT, {"program_from": None}, program_from="file", on="matsuura_mx330"),
    _said(
        "FIL210", "no_place_for_several_files", _CUT, {"programs": "one"}, programs="operations", on="matsuura_mx330"
    ),
    _said(
        "CTL570",
        "settings_of_operations",
        _TWO_BARE,
        {"tool": "OP1:7,OP 2:8", "spindle": "OP1:900,OP 2:800"},
        on="matsuura_mx330",
    ),
    _said("CTL570", "settings_of_operations", _TWO_UNNUMBERED, {"tool": "OP1:7,OP 2:8"}, on="matsuura_mx330"),
    _said("CTL570", "settings_of_operations", _TWO_BARE, {"spindle": "OP1:900,OP 2:800"}),
    _said("SIM147", "difference_not_known", _COMPENSATED.replace(_TLDATA, ""), ("MSYS", f"{_TLDATA}MSYS")),
    _said("CTL310", "cutting_motion_without_feed", _CUT.replace(_FEED, ""), ("GOTO/10.0", _FEED + "GOTO/10.0")),
    _said("CTL310", "cutting_motion_without_feed", _CUT.replace(_FEED, ""), {"missing_feed": "OP1:300"}),
    _holes("CTL310", "cycle_without_feed", "CYCLE/DRILL,FEDTO,-10,RAPTO,3", _DRILL.strip()),
    _holes("CTL310", "cycle_without_feed", "CYCLE/DRILL,FEDTO,-10,RAPTO,3", {"missing_feed": "OP1:300"}),
    _said("CTL320", "speed_below_least", _CUT.replace("RPM,4000.0000", "RPM,0.4"), ("RPM,0.4", "RPM,400")),
    _said("ARG220", "value_twice", _CUT.replace(_FEED, ""), {"missing_feed": "500,OP1:300"}, missing_feed="500,300"),
    _said("ARG230", "no_such_feed", _CUT, {"feed_rapid_from": None}, feed_rapid_from="OP1:90000"),
    _said("ARG230", "no_such_feed_at_all", _CUT, {"feed_rapid_from": None}, feed_rapid_from="90000"),
    Cure(
        "CTL315",
        "feeds_as_rapids",
        post("yl569"),
        _CUT.replace("GOTO/20,0,5", "GOTO/20,0,5\nFEDRAT/MMPM,4000\nGOTO/20,0,50"),
        (),
        {"feed_rapid_from": "4000"},
        stays=True,
    ),
    Cure("CTL320", "speed_stated", post("yl569"), _CUT.replace(_SPEED, ""), (), {"spindle": "4000"}, stays=True),
    _said(
        "ARG230",
        "rapid_in_compensation",
        _COMPENSATED.replace("GOTO/20,30,5", "FEDRAT/MMPM,4000\nGOTO/20,30,5\nFEDRAT/MMPM,500"),
        {"feed_rapid_from": None},
        feed_rapid_from="4000",
    ),
    _said("ARG230", "no_cut_left", _CUT, {"feed_rapid_from": None}, feed_rapid_from="10"),
    _said("ARG230", "states_own_feeds", _CUT, {"missing_feed": None}, missing_feed="OP1:300"),
    _said("CTL510", "operation_cuts_while", _CUT.replace(_SPEED, ""), ("RAPID\n", _SPEED + "RAPID\n")),
    _said("CTL510", "operation_cuts_while", _CUT.replace(_SPEED, ""), {"spindle": "OP1:4000"}),
    _said("ARG220", "value_twice", _CUT.replace(_SPEED, ""), {"spindle": "500,OP1:4000"}, spindle="500,4000"),
    _said("ARG230", "states_own_speed", _CUT, {"spindle": None}, spindle="OP1:4000"),
    _said("CTL510", "speed_stated_for_another", _TWO_BARE, {"spindle": "OP1:900,OP 2:800"}, spindle="OP1:900"),
    _said("CTL570", "operation_not_to_name", _BARE.replace("OP1", "A:B") + FOOT, {"spindle": "900"}),
    _said(
        "ARG220",
        "beyond_revolution",
        _CUT.replace(_FEED, ""),
        {"missing_feed": "300"},
        missing_feed="300MMPR",
    ),
    _said(
        "CTL510",
        "operation_cuts_while_spindle",
        HEAD + "SPINDL/OFF\nGOTO/20,0,5\n" + FOOT,
        {"standing_spindle": "allowed"},
    ),
    _said(
        "CTL520",
        "operation_no_spindle",
        _CUT.replace(_SPEED, ""),
        ("RAPID\n", _SPEED + "RAPID\n"),
        standing_spindle="allowed",
    ),
    _said(
        "CTL520",
        "operation_loads_tool",
        HEAD
        + FOOT
        + _SECOND.replace(_SPEED, "").replace("TOOL,1", "TOOL,2").replace("ADJUST,1", "ADJUST,2").replace("D10", "D12")
        + FOOT,
        ("LOAD/TOOL,2,ADJUST,2\n", "LOAD/TOOL,2,ADJUST,2\n" + _SPEED),
    ),
    _said("CTL130", "tools_called_number", _UNNUMBERED + FOOT, {"tool": "OP1:7"}, on="matsuura_mx330"),
    _said("CTL130", "tool_name_quotation", _UNNUMBERED.replace("TOOL,D10", 'TOOL,D"10') + FOOT, {"tool": "OP1:7"}),
    _said("CTL140", "operation_no_load", _UNNUMBERED + FOOT, {"tool": "OP1:7"}),
    _said("CTL145", "operation_no_load", _UNNUMBERED.replace(",TOOL,D10", ",TOOL,") + FOOT, {"tool": "OP1:7"}),
    _said(
        "CTL330", "feed_per_revolution", _CUT.replace("MMPM,500.0", "MMPR,0.1"), ("MMPR,0.1", "MMPM,400"), on="hs664rt"
    ),
    _said(
        "CTL330",
        "feed_per_revolution_before",
        _CUT.replace("MMPM,500.0", "MMPR,0.1").replace(_SPEED, ""),
        ("RAPID\n", _SPEED + "RAPID\n"),
        standing_spindle="allowed",
        on="matsuura_mx330",
    ),
    _said(
        "CTL330",
        "feed_per_revolution_program",
        "UNITS/MM\n" + _CUT.replace("MMPM,500.0", "MMPR,0.1"),
        {"units": "mm"},
        units="inch",
        on="mikron_600u",
    ),
    _said(
        "CTL530", "operation_no_intol", LEANING.replace("INTOL/0.01\nOUTTOL/0.01\n", "") + FOOT, {"tolerance": "0.01"}
    ),
    _said(
        "CTL530",
        "operation_no_intol",
        LEANING.replace("INTOL/0.01\nOUTTOL/0.01\n", "") + FOOT,
        ("LOAD/", "INTOL/0.01\nOUTTOL/0.01\nLOAD/"),
    ),
    _within("CTL230", "cutcom_does_not", "CUTCOM/ON", "CUTCOM/LEFT"),
    _within("CTL410", "no_coolant", "COOLNT/THRU", "COOLNT/FLOOD", on="xyzac_trt"),
    _within("CTL420", "dwell_control_waits", "DELAY/1e7", "DELAY/10"),
    _said(
        "CTL420",
        "dwell_spindle_revolutions_while",
        _CUT.replace(_SPEED, "DELAY/5,REV\n" + _SPEED),
        ("DELAY/5,REV\n" + _SPEED, _SPEED + "DELAY/5,REV\n"),
    ),
    _within("CTL440", "select_tool_not", "SELECT/TOOL,4", "", on="hs664rt"),
    _within("CTL455", "changes_something", "INSERT/G91", ""),
    _within("CTL450", "insert_may_length", "INSERT/R1=5", {"units": "mm"}, units="inch"),
    _said(
        "CL415",
        "other_unit_than_program",
        "UNITS/INCHES\n" + _CUT.replace("50.0", "5.0").replace("20,", "2,").replace("10.0,0.0,5.0", "1.0,0.0,1.0"),
        {"units": "inch"},
    ),
    _said("CL410", "unit_not_stated", CLEAR + FOOT, {"cl_units": "mm"}, units="inch", on="mikron_600u"),
    _said(
        "CL420",
        "all_feeds_inches",
        _CUT.replace("MMPM,500.0", "IPM,20").replace("50.0,0.0,0.0,1.0", "5,0,0,1"),
        {"cl_units": "mm"},
    ),
    _said(
        "CTL710",
        "operations_both_call",
        HEAD + "GOTO/20,0,5\n" + FOOT + _SECOND.replace("10.0000,0.0000,75", "12,0,75").replace("D10", "D12") + FOOT,
        {"tool": "OP2:2"},
    ),
    _said(
        "CTL710",
        "tool_operation",
        HEAD + "GOTO/20,0,5\n" + FOOT + _SECOND.replace("D10", "D12") + FOOT,
        {"tool": "OP2:2"},
    ),
    _said(
        "CTL710",
        "tool_operation_length",
        HEAD + "GOTO/20,0,5\n" + FOOT + _SECOND.replace("TOOL,1", "TOOL,2").replace("D10", "D12") + FOOT,
        {"tool": "OP2:2"},
        on="matsuura_mx330",
    ),
    *(
        _said(
            "CTL710",
            variant,
            HEAD + _BESIDE + FOOT + _SECOND.replace("TOOL,1,ADJUST,1", "TOOL,2,ADJUST,2") + _BESIDE + FOOT,
            {"radius_offset": cure},
            on="matsuura_mx330",
            radius_offset=offset,
        )
        for variant, offset, cure in (
            ("tool_operation_radius", "OP1:1", "0"),
            ("tool_operation_table", "1", "100"),
        )
    ),
    _holes(
        "CTL360",
        "bore_nodrag_does_not",
        "CYCLE/BORE,NODRAG,FEDTO,-10,RAPTO,3,MMPM,100",
        {"disengage": "1"},
        on="mikron_600u",
    ),
    _holes(
        "CTL360",
        "bore_nodrag_does",
        "CYCLE/BORE,NODRAG,FEDTO,-10,RAPTO,3,MMPM,100",
        {"bore_lift": "0.5"},
        on="matsuura_mx330",
    ),
    _holes("CTL360", "bore_nodrag_does_not_say", "CYCLE/BORE,NODRAG,FEDTO,-10,RAPTO,3,MMPM,100", {"bore_lift": "0.5"}),
    _holes("PLN610", "cycle_without_rapto", "CYCLE/DRILL,FEDTO,-10,MMPM,100", _DRILL.strip()),
    _holes("PLN610", "cycle_without_depth", "CYCLE/DRILL,RAPTO,3,MMPM,100", _DRILL.strip()),
    _holes(
        "PLN610",
        "cycle_without_step",
        "CYCLE/DRILL,DEEP,FEDTO,-10,RAPTO,3,MMPM,100",
        "CYCLE/DRILL,DEEP,STEP,3,FEDTO,-10,RAPTO,3,MMPM,100",
    ),
    _holes("PLN610", "cycle_tap_without", "CYCLE/TAP,FEDTO,-10,RAPTO,3", "CYCLE/TAP,FEDTO,-10,RAPTO,3,MMPR,1.0"),
    _holes("PLN610", "cycle_tap_without", "CYCLE/TAP,FEDTO,-10,RAPTO,3", {"missing_feed": "OP1:1.25MMPR"}),
    _holes(
        "PLN610",
        "rtrcto_manual_does",
        "CYCLE/DRILL,FEDTO,-10,RAPTO,3,MMPM,100,RTRCTO,MANUAL",
        "CYCLE/DRILL,FEDTO,-10,RAPTO,3,MMPM,100,RTRCTO,AUTO",
    ),
    _said("PLN430", "no_such_speed", _CUT.replace("4000.0000", "90000"), ("90000", "6000")),
    _said("PLN340", "leans_too_far", LEANING + FOOT, {"max_tilt": "40"}, max_tilt="10"),
    _said(
        "PLN350",
        "tool_sideways",
        _CUT.replace("TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000", "TLDATA/DRILL,10,0,75,118,50"),
        {"drills_sideways": "allowed"},
    ),
    _said("PLN510", "without_tcp_program", LEANING + FOOT, {"zero": "0,0,0"}, tcp="off"),
    _said(
        "PLN520",
        "without_tcp_slides",
        LEANING + FOOT,
        {"tool_length": "100"},
        tcp="off",
        zero="0,0,0",
        on="generic_head_head_ca",
    ),
    _said("PLN330", "not_upright", LEANING + FOOT, {"mode": None}, mode="three-axis"),
    _said("PLN120", "at_point", LEANING.replace("0.0,0.6,0.8", "0.0,0.0,-1.0") + FOOT, ("0.0,0.0,-1.0", "0.0,0.0,1.0")),
    _said(
        "CTL810", "encoding_lacks_letter", HEAD.replace("OP1", "ФРЕЗА") + FOOT, {"encoding": "utf-8"}, encoding="ascii"
    ),
)
