"""Cures of messages about cycles 27 and 28: a sound program with a fault in it, and the program again."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from tests.support.cures.cure import Change, Cure, Outcome, verify
from tests.support.locations import GOLDEN

_GROOVE: Final = (GOLDEN / "cylinder" / "groove.h").read_text(encoding="utf-8")
_PLACED: Final = {"zero": "0,0,200", "tool_length": "150"}
_ROTATED: Final = "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+{}\n"


def _placed(text: str, _: Mapping[str, str], folder: Path) -> Outcome:
    return verify("dmu65")(text, _PLACED, folder)


def _fault(message: str, *changes: Change) -> Cure:
    """A program in which the changes have been made, which the cure takes back."""
    text = _GROOVE
    for before, after in changes:
        text = text.replace(before, after)
    code, variant = message.split()
    return Cure(code, variant, verify("dmu65"), text, tuple((after, before) for before, after in changes), _PLACED)


CURES: Final = (
    _fault(
        "NC380 no_contour",
        ("7 CYCL DEF 14.0 CONTOUR\n8 CYCL DEF 14.1 CONTOUR LABEL1\n9 CYCL", "9 CYCL"),
    ),
    _fault("NC380 several_contours", ("LABEL1\n", "LABEL1/2\n")),
    _fault("NC380 no_contour_label", ("14 LBL 1\n", "14 LBL 3\n")),
    _fault("NC380 contour_too_short", ("15 L C+40 Y-220 R0\n", "15 L C+40 Y-220 R0\nLBL 0\n")),
    _fault("NC380 contour_ends_in_corner", ("23 RND R7.5\n24 L C+40\n", "23 RND R7.5\n")),
    _fault("NC380 corner_without_room", ("17 RND R7.5\n", "17 RND R30\n")),
    _fault("NC380 bad_dimension_type", ("Q17=+1", "Q17=+3")),
    _fault("NC380 deeper_than_radius", ("Q1=-7", "Q1=-70")),
    _fault("NC380 cylinder_in_frame", ("10 CYCL CALL\n", "M128\n10 CYCL CALL\nM129\n")),
    Cure("NC380", "cylinder_without_zero", verify("dmu65"), _GROOVE, (), {}, cured_by=_placed),
    _fault("NC380 no_axis_for_cylinder", ("L C+40 Y-220 R0", "L B+40 Y-220 R0"), ("16 L C+50", "16 L B+50"),
           ("L IC-20", "L IB-20"), ("24 L C+40", "24 L B+40")),
    _fault("NC380 cylinder_in_turned_datum",
           ("10 CYCL CALL\n", f"{_ROTATED.format(30)}10 CYCL CALL\n{_ROTATED.format(0)}")),
    _fault("NC380 tool_not_across", ("4 L A-90 C+0", "4 L A-60 C+0")),
    _fault("NC380 tool_beside_axis", ("5 L X+0", "5 L X+3")),
    _fault("NC210 contour_needs_labels", ("LABEL1\n", "LABEL\n")),
    _fault("NC210 corner_between_lines", ("17 RND R7.5\n", "17 RND R7.5\nRND R7.5\n")),
    _fault("NC220 cylinder_contour_axes", ("15 L C+40 Y-220 R0\n", "15 L C+40 R0\n"), ("16 L C+50", "16 L C+50 Y-220")),
)  # fmt: skip
