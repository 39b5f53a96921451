"""NX CLSF."""

import re
from typing import Final

from trunnion.cl.builder import StatedPoints
from trunnion.cl.conventions import CycleWords
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import Dialect, marks
from trunnion.cl.state import ReaderState
from trunnion.cl.statements import HANDLERS
from trunnion.cl.statements.cutcom_points import CutcomPoints
from trunnion.cl.text_format import CLSF_TEXT
from trunnion.messages import Wording

_MODES: Final = (
    "DRILL", "DEEP", "BRKCHP", "CSINK", "TAP", "BORE", "DRAG", "NODRAG", "MANUAL", "FACE", "REAM", "THRU", "BACK",
)  # fmt: skip

#: What NX writes above a path: its points are those of the contour, those of the tool ("centerline and contact point"
#: has both), or of another contact, such as that of a tilted tool.
_CONTOUR: Final = re.compile(r"\s*(?:contact\s+)?contour\s+data\s*", re.IGNORECASE)
_CENTRE: Final = re.compile(r"\s*cent(?:er|re)\s*line\b.*", re.IGNORECASE)
#: Commands of Trunnion's own profile (``trunnion.cl.dialects.trunnion``), whose first line is lost.
_OF_PROFILE: Final = re.compile(r"->\s*(?:TRUNNION|STOCK|TOOL|HOLDER)\s*/.*", re.IGNORECASE)
_CONTACT: Final = re.compile(r"\s*contact\b.*\bdata\s*", re.IGNORECASE)


def _comment(state: ReaderState, text: str) -> None:
    """Read a comment that says what the points of its operation are."""
    if _CONTOUR.fullmatch(text) or _CENTRE.fullmatch(text):
        lost = Wording("CL470", "contour_without_cutcom", text=text)
        of_contour = _CONTOUR.fullmatch(text) is not None
        state.own(CutcomPoints).take(state, StatedPoints(of_contour, state.line, f"$${text}", lost, refuses=True))
    elif _CONTACT.fullmatch(text):
        raise StatementError(Wording("CL470", "points_those_contact", text=text))
    elif _OF_PROFILE.fullmatch(text):
        raise StatementError(Wording("CL350", "profile_first_line"))


CLSF: Final = Dialect(
    name="clsf",
    title="NX CLSF",
    marks=marks(rb"TOOL[ \t]*PATH[ \t]*/", rb"END-OF-PATH\b", rb"MSYS[ \t]*/", rb"TLDATA[ \t]*/", rb"PAINT[ \t]*/"),
    handlers=HANDLERS,
    cycles=CycleWords({word: (word,) for word in _MODES}),
    in_sections=True,
    has_end=False,
    text=CLSF_TEXT,
    comment=_comment,
)
