"""NX CLSF."""

import re
from typing import Final

from trunnion.cl.conventions import CycleWords
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import Dialect, marks
from trunnion.cl.state import ReaderState
from trunnion.cl.statements import HANDLERS
from trunnion.cl.text_format import CLSF_TEXT
from trunnion.messages import Wording

_MODES: Final = (
    "DRILL", "DEEP", "BRKCHP", "CSINK", "TAP", "BORE", "DRAG", "NODRAG", "MANUAL", "FACE", "REAM", "THRU", "BACK",
)  # fmt: skip

#: What NX writes above a path whose points are those of the contour; "centerline and contact point" has both.
_CONTOUR: Final = re.compile(r"\s*contact\b.*\bdata\s*", re.IGNORECASE)


def _comment(state: ReaderState, text: str) -> None:
    """Read a comment that says what the points are: those of the contour are no tips."""
    if _CONTOUR.fullmatch(text):
        raise StatementError(Wording("CL470", "points_those_contour", text=text))


CLSF: Final = Dialect(
    name="clsf",
    title="NX CLSF",
    marks=marks(rb"TOOL[ \t]*PATH[ \t]*/", rb"END-OF-PATH\b", rb"MSYS[ \t]*/", rb"TLDATA[ \t]*/", rb"PAINT[ \t]*/"),
    handlers=HANDLERS,
    cycles=CycleWords({word: (word,) for word in _MODES}),
    in_sections=True,
    text=CLSF_TEXT,
    comment=_comment,
)
