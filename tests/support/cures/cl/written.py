"""Cures of messages about CL files that are written in a dialect."""

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import trunnion
from tests.support.apt_heads import HEADS
from tests.support.cures.cure import Cure, Outcome, Trial, marked, post
from tests.support.posting import CLEAR, FOOT, HEAD
from trunnion.cl.read_back import read_back_problems
from trunnion.cl.writers import WRITERS
from trunnion.errors import TrunnionError


def _written(dialect: str) -> Trial:
    """Return what converts a CL file to one in a dialect."""

    def written(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        file = folder / "part.cls"
        file.write_text(text, encoding="utf-8")
        try:
            found = trunnion.convert(file, to_cl=True, to_dialect=dialect)
        except TrunnionError as error:
            return Outcome(tuple(error.problems), False)
        return Outcome(found.problems, found.passed)

    return written


def _with_fault(wrong: str, right: str) -> Trial:
    """Return what writes a CL file for CATIA with a fault, and reads it back."""

    def written(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        file, again, sink = folder / "part.cls", folder / "again.cls", io.BytesIO()
        file.write_text(text, encoding="utf-8")
        writer = WRITERS["catia"](trunnion.read_cl(file), inch=False)
        writer.write(sink)
        again.write_text(sink.getvalue().decode().replace(right, wrong), encoding="utf-8")
        found = read_back_problems(writer.toolpath, again, "catia")
        return Outcome(tuple(found), not found)

    return written


def _to(dialect: str, message: str, *lines: str) -> Cure:
    """Lines behind the first cut, written in a dialect."""
    return marked(message, _written(dialect), *lines, head=HEAD, foot=FOOT)


def _holes(message: str, *lines: str) -> Cure:
    """A cycle and its hole, written for CATIA."""
    return marked(message, _written("catia"), *lines, head=CLEAR, foot=FOOT)


def _other(message: str, wrong: str, right: str, text: str = HEAD + FOOT) -> Cure:
    """A fault of one writer, and another dialect."""
    code, _, variant = message.partition(" ")
    return Cure(code, variant, _with_fault(wrong, right), text, (), cured_by=_written("ncl"))


_OP2: Final = HEAD.replace("OP1", "OP2")
_ASIDE: Final = _OP2.replace("MSYS/0.0000,0", "MSYS/9.0000,0")
_TLDATA: Final = "TLDATA/MILL,10,0,75,0,0"
_MATRIX: Final = (
    "$$*CATIA0\n$$ A\n$$ 0 1 0 5.5\n$$ -1 0 0 6\n$$ 0 0 1 7\nFEDRAT/100,MMPM\nMULTAX\nGOTO/1,2,3,0,0,1\nFINI\n"
)
_HOLE: Final = ("- GOTO/50,0,0", "- CYCLE/OFF")
_MOTION: Final = ("+ GOTO/50,0,3", "+ FEDRAT/MMPM,100", "+ GOTO/50,0,-10", "+ RAPID", "+ GOTO/50,0,50")
_CSYS: Final = (
    "$$* Pro/CLfile Version 8.0\nUNITS / MM\nLOADTL / 5\n$$-> CUTTER / 10.0\n"
    "$$-> CSYS / 0,1,0,5.5,-1,0,0,6,0,0,1,7\nFEDRAT / 100, MMPM\nGOTO / 1,2,3\nFINI\n"
)

CURES: Final = (
    _to("catia", "CL910 cutcom_gohome_another", "CUTCOM/LEFT", "GOTO/20,0,5", "+ CUTCOM/OFF", "+ GOTO/30,0,5", "GOHOME",
        "RAPID",
        "GOTO/1,0,50"),
    _to("catia", "CL910 cuts_before_feed",
        FOOT + _OP2.replace("RAPID\nGOTO/0.0,0.0,50.0,0.0,0.0,1.0\nFEDRAT/MMPM,500.0\nGOTO/10.0,0.0,5.0\n",
        "").rstrip(),
        "+ FEDRAT/MMPM,500", "GOTO/1,0,5,0,0,1"),
    _holes("CL910 cycle_not_settled", "- CYCLE/BORE,NODRAG,90,RAPTO,3,FEDTO,-5,MMPM,10", *_HOLE, *_MOTION),
    _holes("CL910 cycle_without_fedto", "- CYCLE/DRILL,RAPTO,3,MMPM,10", "+ CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,10",
           "GOTO/50,0,0",
           "CYCLE/OFF"),
    _to("catia", "CL910 helix_arc_several", "- CIRCLE/15,0,5,0,0,1,5", "- GOTO/20,0,8", "+ GOTO/15,-5,6",
        "+ GOTO/20,0,8"),
    _to("catia", "CL910 tool_axis_turns", "- CIRCLE/15,0,5,0,0,1,5", "- GOTO/20,0,5,0,0.6,0.8",
        "+ GOTO/15,-5,5,0,0.3,0.9539392",
        "+ GOTO/20,0,5,0,0.6,0.8"),
    _to("catia", "CL910 loads_second_tool", "- LOAD/TOOL,2", FOOT + _OP2.replace("TOOL,1", "TOOL,2").rstrip(),
        "GOTO/20,0,5"),
    _to("clsf", "CL910 points_of_contour", "- $$ contour data", "CUTCOM/LEFT", "GOTO/20,9,5", "CUTCOM/OFF",
        "GOTO/30,9,5"),
    _other("CL920 could_not_read", "ROTABL/1", "MULTAX"),
    _other("CL920 would_read_back", "SPINDL/ 4001", "SPINDL/ 4000"),
    _other("CL920 would_taken", "$$ NAME", "$$ OPERATION NAME"),
    _to("catia", "CL930 full_circle_become", "CIRCLE/15,0,5,0,0,1,5", "GOTO/10,0,5"),
    _to("ncl", "CL930 names_operation_become"),
    _to("catia", "CL930 operations_have_coordinate", FOOT + _ASIDE.rstrip()),
    marked("CL930 where_coordinate_system", _written("catia"), _ASIDE + FOOT.rstrip()),
    _to("catia", "CL930 phases_motion_colours", "PAINT/COLOR,42", "GOTO/20,0,5"),
    _to("catia", "CL930 states_no_tolerance", FOOT + "TOOL PATH/OP2,TOOL,D10", _TLDATA, "+ INTOL/0.01", "+ OUTTOL/0.01",
        "RAPID", "GOTO/0,0,50"),
    marked("CL930 not_carried", _written("clsf"), *HEADS["fusion"], "GOTO/0,0,9", "FINI"),
    marked("CL910 operation_name_tool", _written("clsf"), "$$ CATIA APT VERSION 1.0", "- $$ OPERATION NAME : A,TOOL,B",
           "+ $$ OPERATION NAME : A", *HEADS["catia"][1:], "GOTO/0,0,9", "FINI"),
    _to("trunnion", "CL910 unknown_statement", "- CLAMP/ON", "GOTO/20,0,5"),
    marked("CL910 dollar_in_holder", _written("trunnion"), *HEADS["apt"][:-1], "- TPRINT/A,B$3", "+ TPRINT/A,B3",
           "LOADTL/5", "GOTO/0,0,9", "FINI"),
    marked("CL930 stock", _written("clsf"), "$$-> TRUNNION / 1", "UNITS/MM", "$$-> STOCK / CYLINDER,9,9,0",
           "TOOL PATH/A,TOOL,B", "FEDRAT/MMPM,100", "GOTO/0,0,5", "END-OF-PATH", "FINI"),
    marked("CL930 work_offsets", _written("clsf"), "$$-> TRUNNION / 1", "UNITS/MM", "TOOL PATH/A,TOOL,B",
           "$$-> WORK-OFFSET / 2", "FEDRAT/MMPM,100", "GOTO/0,0,5", "END-OF-PATH", "FINI"),
    _other("CL920 would_read_back_another", "6.5000000000", "5.5000000000", _MATRIX),
    marked("CL930 unsettled_system", _written("catia"), _CSYS.rstrip()),
    _to("catia", "CL930 not_carried_over",
        FOOT + "TOOL PATH/OP2,TOOL,D6\nTLDATA/DRILL,6,0,50,118,35\nRAPID\nGOTO/0,0,50"),
    Cure("CL940", "operation", post("dmu65"), HEAD + FOOT, (), {"normals": "contact"}, stays=True),
)  # fmt: skip
