"""Cures of messages about programs that are posted: what settings state of single operations."""

from collections.abc import Mapping
from typing import Final

from tests.support.cures.cure import Cure, marked, post
from tests.support.cures.posting.rows import by_lines, by_settings
from tests.support.posting import CLEAR, FOOT, HEAD, LEANING

_TILTED: Final = CLEAR.replace("0.0,0.0,1.0", "0.0,0.6,0.8") + "FEDRAT/MMPM,500.0\nGOTO/10.0,0.0,5.0\n"
_LOW: Final = HEAD.replace("4000.0", "0.4")

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

CURES: Final[tuple[Cure, ...]] = (
    *(
        by_settings(f"CTL220 {variant}", {"compensation": "OP1:left_out"},
                    f"{head}CUTCOM/LEFT{plane}\nGOTO/20,9,5\nCUTCOM/OFF\nGOTO/30,9,5,0,0,1\n", on, **given)
        for variant, head, plane, on, given in _LEFT_OUT
    ),
    by_settings("CTL220 contour_not_left_out", {"compensation": "OP1:programmed"},
                HEAD + "$$ contour data\nCUTCOM/LEFT\nGOTO/20,9,5\nGOTO/20,20,5\nCUTCOM/OFF\nGOTO/30,20,5\n",
                compensation="left_out"),
    by_lines("CTL220 cutcom_left_out", "CUTCOM/LEFT", "GOTO/20,9,5", "CUTCOM/OFF", "GOTO/30,9,5",
             compensation="left_out"),
    by_settings("ARG230 no_cutcom_there", {"compensation": None}, compensation="OP1:left_out"),
    by_settings("CTL320 speed_below_least", {"spindle": "OP1:400"}, _LOW),
    by_settings("ARG230 states_other_sense", {"spindle": "OP1:400"}, _LOW, spindle="OP1:-400"),
    marked("CTL320 speed_replaced", post(), "GOTO/20,0,5", head=_LOW, foot=FOOT, spindle="OP1:400"),
)  # fmt: skip
