"""Cures of messages about cycles that are posted: what they lack, and what controls cannot make."""

from typing import Final

from tests.support.cures.cure import Cure, marked, post
from tests.support.posting import CLEAR, FOOT

_END: Final = "CYCLE/OFF\n" + FOOT
_HOLE: Final = f"GOTO/50,0,0\n{_END}"
_HEIGHTS: Final = "FEDTO,-10,RAPTO,3"
#: A hole as motion, from the place above it and back.
_MOTION: Final = ("+ RAPID", "+ GOTO/50,0,50", "+ FEDRAT/MMPM,100", "+ GOTO/50,0,-10", "+ GOTO/50,0,50")


def _hole(message: str, *lines: str, on: str = "yl569", head: str = CLEAR, **settings: str) -> Cure:
    """Lines up to a hole."""
    return marked(message, post(on), *lines, head=head, foot=_HOLE, **settings)


def _cycle(message: str, wrong: str, cured: str, on: str = "yl569", **settings: str) -> Cure:
    """What a cycle has besides its heights, and what it should have."""
    return _hole(message, f"- CYCLE/{wrong}", f"+ CYCLE/{cured}", on=on, **settings)


def _motion(message: str, cycle: str, on: str = "yl569", head: str = CLEAR, **settings: str) -> Cure:
    """A cycle, and its hole as motion."""
    lines = (f"- CYCLE/{cycle}", "- GOTO/50,0,0", "- CYCLE/OFF", *_MOTION)
    return marked(message, post(on), *lines, head=head, foot=FOOT, **settings)


_SPINDLE: Final = "SPINDL/RPM,4000.0000,CLW"
_STANDING: Final = CLEAR.replace(f"{_SPINDLE}\n", "")
_LEFT: Final = CLEAR.replace("CLW", "CCLW")
_NOWHERE: Final = CLEAR.replace("RAPID\nGOTO/0.0,0.0,50.0,0.0,0.0,1.0\n", "")
_LEANING: Final = CLEAR.replace("0.0,0.0,1.0", "0.0,0.6,0.8")

CURES: Final = (
    _cycle("PLN610 cycle_bore_without", "BORE,FEDTO,-10,RAPTO,3", "BORE,FEDTO,-10,RAPTO,3,MMPM,100"),
    _cycle("PLN610 cycle_drill_csink", "DRILL,CSINK,RAPTO,3,CSKDIA,10,MMPM,250",
           "DRILL,CSINK,RAPTO,3,CSKDIA,10,TLANGL,90,MMPM,250"),
    _cycle("PLN610 step_without_shortest", f"DRILL,DEEP,{_HEIGHTS},STEP,4,1,MMPM,250",
           f"DRILL,DEEP,{_HEIGHTS},STEP,4,1,1,MMPM,250",
           "dmu65"),
    _cycle("PLN620 cycle_drill_csink", "DRILL,CSINK,FEDTO,-9,RAPTO,3,CSKDIA,10,TLANGL,90,MMPM,250",
           "DRILL,CSINK,RAPTO,3,CSKDIA,10,TLANGL,90,MMPM,250"),
    _cycle("PLN620 cycle_fedto_0", "DRILL,DEEP,FEDTO,0,RAPTO,3,STEP,2,MMPM,250",
           "DRILL,DEEP,FEDTO,-5,RAPTO,3,STEP,2,MMPM,250"),
    _cycle("PLN620 cycle_number_no", "DRILL,FEDTO,-1e9,RAPTO,3,MMPM,250", "DRILL,FEDTO,-10,RAPTO,3,MMPM,250"),
    _motion("PLN630 cycle_bore_back", f"BORE,BACK,{_HEIGHTS},MMPM,250"),
    _motion("PLN630 cycle_cycle_cannot", f"DRILL,TAP,{_HEIGHTS},MMPM,250"),
    _cycle("PLN630 cycle_option_compensating", f"TAP,DEEP,{_HEIGHTS},STEP,4,MMPR,1,OPTION",
           f"TAP,DEEP,{_HEIGHTS},STEP,4,MMPR,1"),
    _hole("PLN650 cycle_while_tool_below", "FEDRAT/MMPM,100", "GOTO/50,0,1", "+ RAPID", "+ GOTO/50,0,50",
          f"CYCLE/DRILL,{_HEIGHTS},MMPM,100"),
    _hole("PLN650 cycle_while_tool", "FEDRAT/MMPM,100", "GOTO/50,0,1", "+ RAPID", "+ GOTO/50,0,50",
          f"CYCLE/DRILL,{_HEIGHTS},MMPM,100",
          cycles="off"),
    _hole("PLN650 cut_beside_skipped", "FEDRAT/MMPM,100", "GOTO/0,0,5", "+ RAPID", "+ GOTO/0,0,50",
          "OPSKIP/ON", "RAPID", "GOTO/0,0,50", "OPSKIP/OFF", f"CYCLE/DRILL,{_HEIGHTS},MMPM,100", cycles="off"),
    _hole("PLN650 rtrcto_auto_before", "+ RAPID", "+ GOTO/50,0,50,0,0,1",
          f"CYCLE/DRILL,{_HEIGHTS},MMPM,100,RTRCTO,AUTO", head=_NOWHERE),
    _hole("PLN660 cycle_bore_drag", f"+ {_SPINDLE}", f"CYCLE/BORE,DRAG,{_HEIGHTS},MMPM,100", head=_STANDING,
          cycles="off",
          standing_spindle="allowed"),
    _hole("PLN660 dwell_rev_while", f"+ {_SPINDLE}", f"CYCLE/DRILL,{_HEIGHTS},DWELL,REV,3,MMPM,100", head=_STANDING,
          cycles="off",
          standing_spindle="allowed"),
    _hole("PLN660 while_spindle_stands", f"+ {_SPINDLE}", f"CYCLE/TAP,{_HEIGHTS},MMPR,1", head=_STANDING,
          standing_spindle="allowed"),
    _motion("CTL350 dwell_control_no", f"BORE,MANUAL,{_HEIGHTS},DWELL,1,MMPM,100", "matsuura_mx330",
            missing_cycles="G88 P"),
    _motion("CTL350 control_no_cycle", f"BORE,MANUAL,{_HEIGHTS},MMPM,100", "matsuura_mx330", missing_cycles="G88"),
    _cycle("CTL350 decreasing_peck_depths_thread", f"TAP,DEEP,{_HEIGHTS},STEP,4,1,1,MMPR,1",
           f"TAP,DEEP,{_HEIGHTS},STEP,4,MMPR,1"),
    _motion("CTL350 cycle_no_cycle", f"BORE,MANUAL,{_HEIGHTS},MMPM,100", "dmu65"),
    _motion("CTL350 cycle_no_cycle_linuxcnc", f"BORE,MANUAL,{_HEIGHTS},MMPM,100", "xyzac_trt"),
    _cycle("CTL350 dwell_bottom_thread", f"TAP,{_HEIGHTS},DWELL,1,MMPR,1", f"TAP,{_HEIGHTS},MMPR,1", "xyzac_trt"),
    _cycle("CTL350", f"TAP,{_HEIGHTS},DWELL,1,MMPR,1", f"TAP,{_HEIGHTS},MMPR,1", "xyzac_trt"),
    _motion("CTL350 no_documented_cycle", f"BORE,MANUAL,{_HEIGHTS},MMPM,100", "hs664rt"),
    _motion("CTL350 thread_left_hand", f"TAP,{_HEIGHTS},MMPR,1", "hs664rt", head=_LEFT),
    _cycle("CTL320 thread_mm_min", f"TAP,{_HEIGHTS},MMPR,1.0001", f"TAP,{_HEIGHTS},MMPR,1", "hs664rt"),
    _cycle("CTL330 feed_per_revolution_control", f"DRILL,{_HEIGHTS},MMPR,0.1", f"DRILL,{_HEIGHTS},MMPM,400", "hs664rt"),
    _cycle("CTL360 bore_nodrag_angle", f"BORE,NODRAG,90,{_HEIGHTS},MMPM,100", f"BORE,NODRAG,{_HEIGHTS},MMPM,100",
           "matsuura_mx330",
           bore_lift="1"),
    _cycle("CTL360 cycle_whether_g84", f"TAP,DEEP,{_HEIGHTS},STEP,4,MMPR,1", f"TAP,{_HEIGHTS},MMPR,1",
           "matsuura_mx330"),
    _cycle("CTL110 cycle_q", f"DRILL,{_HEIGHTS},DWELL,90000,MMPM,100", f"DRILL,{_HEIGHTS},DWELL,9,MMPM,100", "dmu65"),
)  # fmt: skip
