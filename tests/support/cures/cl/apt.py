"""Cures of messages about CL files of SolidWorks CAM, CATIA and other APT."""

from typing import Final

from tests.support.apt_heads import HEADS
from tests.support.cures.cure import Change, Cure, post, read

_SOLIDWORKS: Final = "\n".join(HEADS["solidworks"]) + "\nSPINDL/1500,RPM,CLW\nRAPID/\nGOTO/10.,10.,25.\n"
_CYCLE: Final = "CYCLE/DRILL,FEDTO,9.8,MMPM,150.,RAPTO,3.,RTRCTO,25.\n"
_HOLE: Final = _CYCLE + "GOTO/10.,10.,0\n"
_APT: Final = "\n".join(HEADS["apt"]) + "\nSPINDL/RPM,500,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,100\nGOTO/0,0,0\n"


def _said(code: str, variant: str, text: str, *changes: Change) -> Cure:
    return Cure(code, variant, read, text, changes)


def _within(code: str, variant: str, line: str, cured: str) -> Cure:
    """A line behind the first cut of a general APT file, and what stands in its place."""
    return _said(code, variant, f"{_APT}{line}\nGOTO/9,0,0\nFINI\n", (f"{line}\n", cured and f"{cured}\n"))


_NEXT: Final = "SPINDL/1200,RPM,CLW\nTRNTYP/WORLD,0,0,0\n"
_OPEN: Final = _SOLIDWORKS + _HOLE + _NEXT
_HOLES: Final = _OPEN + "GOTO/40.,50.,0\nCYCLE/OFF\nRAPID/\nGOTO/40.,50.,25.\nFINI\n"
_CUTS: Final = _OPEN + (
    "RAPID/\nGOTO/40.,50.,25.\nRAPID/\nGOTO/40.,50.,2.\nFEDRAT/100,MMPM\nGOTO/40.,50.,-1.\nGOTO/50.,50.,-1.\nFINI\n"
)

CURES: Final = (
    _said("CL840", "cycle_line_still_holes", _HOLES,
          ("GOTO/10.,10.,0\n", "GOTO/10.,10.,0\nCYCLE/OFF\n"), ("GOTO/40.,50.,0\n", _CYCLE + "GOTO/40.,50.,0\n")),
    Cure("CL840", "cycle_line_still_holes", post(), _HOLES, ({"open_cycle": "OPERATION 2:goes_on"},)),
    Cure("CL840", "cycle_goes_on_as_stated", post(), _HOLES, (), {"open_cycle": "goes_on"}, stays=True),
    Cure("CL840", "cycle_ends_as_stated", post(), _CUTS, (), {"open_cycle": "OPERATION 2:ends"}, stays=True),
    _said("CL840", "cycle_line_still_where", _CUTS, ("GOTO/10.,10.,0\n", "GOTO/10.,10.,0\nCYCLE/OFF\n")),
    Cure("CL840", "cycle_line_still_where", post(), _CUTS, ({"open_cycle": "OPERATION 2:ends"},)),
    _said("CL130", "file_no_behind", _APT, ("GOTO/0,0,0\n", "GOTO/0,0,0\nFINI\n")),
    _within("CL760", "operation_cuts_without", "CUTCOM/LEFT\nGOTO/5,0,0\nLOADTL/6\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,90",
            "CUTCOM/LEFT\nGOTO/5,0,0\nCUTCOM/OFF\nGOTO/6,0,0\nLOADTL/6\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,90"),
    _within("CL720", "operation_loads_tool", "RAPID\nGOTO/0,0,50\nLOADTL/6\nRAPID\nGOTO/1,0,50",
            "RAPID\nGOTO/0,0,50\nLOADTL/6\nRAPID\nGOTO/1,0,50\nFEDRAT/MMPM,90"),
    _within("CL320", "another_line_operation", "INTOL/0.01\nINTOL/0.02", "INTOL/0.01"),
    _within("CL410", "units_not_known", "UNITS/FURLONG", ""),
    _within("CL590", "retrct_without_clearance", "RETRCT", "GOTO/0,0,50"),
    _within("CL510", "gofwd_without_indirv", "TLON,GOFWD/(CIRCLE/0,5,0,0,0,1,5),ON,(LINE/0,5,0,5,5,0)", "GOTO/5,5,0"),
    _within("CL120", "if_statement_apt", "IF(A-B)L1,L2,L3", ""),
)  # fmt: skip
