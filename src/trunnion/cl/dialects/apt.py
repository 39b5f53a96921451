"""APT CL data with the words of ISO 4343, as post-processors of several makers take it."""

from collections.abc import Mapping
from typing import Final

from trunnion.cl.conventions import CycleWords
from trunnion.cl.dialect import Dialect, Handler, marks
from trunnion.cl.statements import HANDLERS, apt_arcs, apt_motion, apt_refused, apt_tools, events, motion, operations

#: What the statements of all APT dialects mean.
APT_HANDLERS: Final[Mapping[str, Handler]] = {
    **{word: handler for word, handler in HANDLERS.items() if word not in ("TOOLPATH", "END-OF-PATH", "MSYS", "PAINT")},
    **dict.fromkeys(apt_refused.PART_PROGRAM_WORDS, apt_refused.part_program),
    **dict.fromkeys(apt_refused.REFUSED_WORDS, apt_refused.refuse),
    "UNIT": operations.units,
    "CUTTER": apt_tools.cutter,
    "LOADTL": apt_tools.loadtl,
    "LOAD": apt_tools.load,
    "SELECTL": apt_tools.select,
    "SELCTL": apt_tools.select,
    "TLAXIS": apt_motion.tlaxis,
    "MULTAX": apt_motion.multax,
    "CLRSRF": apt_motion.clearance,
    "CLEARP": apt_motion.clearance,
    "RETRCT": apt_motion.retrct,
    "GOHOME": apt_motion.gohome,
    "ORIGIN": apt_motion.no_shift,
    "TRANS": apt_motion.no_shift,
    "CUTCOM": apt_motion.cutcom,
    "CIRCLE": motion.plain_circle,
    "MOVARC": apt_arcs.movarc,
    "AUTOPS": operations.ignore,
    "PSIS": operations.ignore,
    "INDIRV": apt_arcs.indirv,
    "TLON": apt_arcs.tlon,
    "TLON,GOFWD": apt_arcs.gofwd,
    "GOFWD": apt_arcs.gofwd,
    "REWIND": operations.ignore,
    "TPRINT": apt_tools.tprint,
    "PPRINT": events.quoted_message,
    **dict.fromkeys(("NURBS", "KNOT", "CNTRL", "MOVNRB"), motion.unsupported),
}

_POST: Final = "its meaning differs from post-processor to post-processor"

#: Without DEEP for chip breaking, as one maker has it: full retracts are right in both readings.
CYCLES: Final = CycleWords(
    modes={
        "DRILL": ("DRILL",),
        "FACE": ("FACE",),
        "DEEP": ("DRILL", "DEEP"),
        "BRKCHP": ("DRILL", "BRKCHP"),
        "TAP": ("TAP",),
        "REAM": ("REAM",),
    },
    words={"DEPTH": "FEDTO", "CLEAR": "RAPTO"},
    refused={"THRU": _POST, "BORE": _POST, "RETURN": _POST, "PULLOUT": _POST},
)

APT: Final = Dialect(
    name="apt",
    title="APT CL data (ISO 4343)",
    marks=marks(
        rb"PARTNO\b", rb"MACHIN\b", rb"UNITS?[ \t]*/", rb"LOADTL[ \t]*/", rb"MULTAX\b", rb"CUTTER[ \t]*/", rb"FINI\b",
        rb"TLAXIS[ \t]*/", rb"MACRO[ \t]*/", rb"[A-Z0-9]+[ \t]*=[ \t]*(?:MACRO|POINT|LINE|PLANE|CIRCLE)\b",
    ),
    handlers={**APT_HANDLERS, "MULTAX": apt_motion.multax},
    cycles=CYCLES,
    is_general=True,
)  # fmt: skip
