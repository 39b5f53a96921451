"""What each family of controls refuses, and why; all else is written and proven. A page in the docs lists it."""

from typing import Final

from tests.support.locations import DOCS
from tests.support.matrix.paths import (
    CYCLES,
    Family,
    off_the_pole,
    simultaneous,
    three_axis,
    tilted_drilling,
    tilted_milling,
)

PAGE: Final = DOCS / "controls" / "matrix.md"

#: Settings of a run without TCP.
WITHOUT_TCP: Final = ("tcp=off", "zero=10,-20,30", "tool_length=83.5")

#: Family of paths -> its strategy, and the settings of the run.
FAMILIES: Final[dict[str, tuple[Family, tuple[str, ...]]]] = {
    "three-axis milling": (three_axis, ()),
    "three-axis milling without TCP": (three_axis, WITHOUT_TCP),
    "milling in tilted planes": (tilted_milling, ()),
    "drilling in five planes": (tilted_drilling, ()),
    "simultaneous milling with TCP": (simultaneous, ("tcp=on",)),
    "the same, the tool axis as a vector": (simultaneous, ("tcp=on", "orientation=vector")),
    "simultaneous milling without TCP": (off_the_pole, WITHOUT_TCP),
}

_NO_VECTORS: Final = "orientation is not a setting"
_NO_CYCLE: Final = "no documented cycle"
_LEAVES: Final = "leaves the hole as it asks for"
_PECKS: Final = "whether G84 pecks, and how, is a parameter of the control"

#: Names of control families for the page, by their first key in definitions.
NAMES: Final = {
    "fanuc_30i": "Fanuc",
    "fanuc_31i_basic": "Fanuc without options",
    "fidia_nc15": "Fidia",
    "haas_ngc": "Haas",
    "heidenhain_itnc530": "Heidenhain",
    "linuxcnc": "LinuxCNC",
    "sinumerik_840d": "Sinumerik",
}

_FANUC: Final = {
    "TAP,BRKCHP": _PECKS,
    "TAP,DEEP": _PECKS,
    "BORE,NODRAG": "the angle at which the spindle stops is a parameter of the control",
}

#: Control family, or a control that refuses more than its family -> family of paths, or cycle -> part of the reason
#: for which all of them are refused.
REFUSED: Final[dict[str, dict[str, str]]] = {
    "fanuc_30i": _FANUC,
    "fanuc_31i_basic": {
        **_FANUC,
        "simultaneous milling with TCP": "tcp is on, and the machine's control has none",
        "the same, the tool axis as a vector": "it has no effect on Fanuc 31i without options, for it has no TCP",
    },
    "fidia_nc15": {
        "the same, the tool axis as a vector": _NO_VECTORS,
        "simultaneous milling without TCP": "does not support the mode without TCP",
        "TAP,BRKCHP": _NO_CYCLE,
        "TAP,DEEP": _NO_CYCLE,
        "BORE,NODRAG": _NO_CYCLE,
        "BORE,MANUAL": _NO_CYCLE,
    },
    "haas_ngc": {
        **_FANUC,
        "the same, the tool axis as a vector": "this control has no TCP that takes the tool axis as a vector",
        "BORE,MANUAL": "for which this control has no cycle",
    },
    "heidenhain_itnc530": {
        "BORE,NODRAG": "does not say to which side the tool moves off the wall",
        "BORE,MANUAL": _LEAVES,
    },
    "linuxcnc": {
        "the same, the tool axis as a vector": _NO_VECTORS,
        "TAP,BRKCHP": _LEAVES,
        "TAP,DEEP": _LEAVES,
        "BORE,NODRAG": _LEAVES,
        "BORE,MANUAL": _LEAVES,
    },
    "sinumerik_840d": {
        "BORE,NODRAG": "does not say how far and to which side the tool lifts off",
    },
}

#: Reasons for which some paths of a family are refused, on the controls and machines to which they apply.
SOMETIMES: Final = {
    "simultaneous milling without TCP": "a rotary axis goes past the end of the turn that it displays",
}


_HEAD: Final = """# The matrix

Every control in `controls/library` moves every machine in `machines/library`: a definition that `extends` the machine
and names the control is enough. `tests/matrix` posts families of random paths for all of these pairs, reads each
program back, runs it, and compares it with the CL file: all checks pass, and every point is met within half the last
digit. What a control does not support is refused with a reason; the tests keep this page complete.

| family of paths | refused |
| --- | --- |
"""

_FOOT: Final = """
The linear axes have room enough in these definitions; their limits have tests of their own. Without TCP the workpiece
zero and the tool's length are set. On machines whose head turns the tool, a program without TCP is for one length, and
`verify` with another finds the tip off; on machines whose tables do all the turning the length makes no difference.
"""


def page() -> str:
    """The page of the docs."""
    rows = []
    for path in (*FAMILIES, *CYCLES):
        name = f"cycle {path}" if path in CYCLES else path
        who: dict[str, list[str]] = {}
        for family, reasons in REFUSED.items():
            if path in reasons:
                who.setdefault(reasons[path], []).append(NAMES[family])
        told = [f"{', '.join(names)}: {reason}" for reason, names in who.items()]
        if path in SOMETIMES:
            told.append(
                f"where a machine folds its axes and the control has no word for the shorter way: {SOMETIMES[path]}"
            )
        rows.append(f"| {name} | {'; '.join(told) or '–'} |\n")
    return _HEAD + "".join(rows) + _FOOT


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
