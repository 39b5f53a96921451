"""NX CLSF."""

from typing import Final

from trunnion.cl.dialect import CycleWords, Dialect, marks
from trunnion.cl.statements import HANDLERS

_MODES: Final = (
    "DRILL", "DEEP", "BRKCHP", "CSINK", "TAP", "BORE", "DRAG", "NODRAG", "MANUAL", "FACE", "REAM", "THRU", "BACK",
)  # fmt: skip

CLSF: Final = Dialect(
    name="clsf",
    title="NX CLSF",
    marks=marks(rb"TOOL[ \t]*PATH[ \t]*/", rb"END-OF-PATH\b", rb"MSYS[ \t]*/", rb"TLDATA[ \t]*/", rb"PAINT[ \t]*/"),
    handlers=HANDLERS,
    cycles=CycleWords({word: (word,) for word in _MODES}),
    in_sections=True,
)
