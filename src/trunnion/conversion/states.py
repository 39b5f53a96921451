"""What becomes of each state of a program that a reader knows, on each control: conversion acts by this table.

Every kind of event and every column of a run belongs to a row. A kind without one must not be lost: it is refused. The
page on conversion is made of the table, and a test converts a program with each state to each target.
"""

from collections.abc import Iterator
from dataclasses import KW_ONLY
from enum import StrEnum
from typing import Final

from trunnion.messages import Wording
from trunnion.records import dataclass

#: Where a program can go: a CL file, or a control of these families.
TARGETS: Final = ("CL", "Sinumerik", "Klartext", "Fanuc", "Haas", "Fidia", "LinuxCNC")

_NC: Final = TARGETS[1:]


class Fate(StrEnum):
    """What becomes of a state."""

    CARRIED = "carried"
    PATH = "in the path"
    REPORTED = "reported"
    REFUSED = "refused"


@dataclass(frozen=True, slots=True)
class State:
    """A state of a program.

    name     as the docs call it
    words    words that set it
    fate     what becomes of it; PATH: its words are gone, and the motion has what they do
    lacks    targets that cannot say it
    lacking  what becomes of it there
    kinds    events of a run that set it
    columns  columns of a run that hold it
    loss     what is said of an event of these kinds that no operation can hold
    by_value  each is named by its value, as not carried over, instead
    """

    name: str
    words: str
    fate: Fate
    _: KW_ONLY
    lacks: tuple[str, ...] = ()
    lacking: Fate = Fate.REFUSED
    kinds: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    loss: Wording | None = None
    by_value: bool = False

    def on(self, target: str) -> Fate:
        """Return what becomes of it on a target."""
        return self.lacking if target in self.lacks else self.fate


def _others(*targets: str) -> tuple[str, ...]:
    """Return the controls but these."""
    return tuple(target for target in _NC if target not in targets)


_CARRIED, _PATH, _REPORTED, _REFUSED = Fate.CARRIED, Fate.PATH, Fate.REPORTED, Fate.REFUSED

#: A state whose words are known by the text alone has neither kinds nor columns.
STATES: Final = (
    State(
        "work offset that most controls have", "G54 to G59", _CARRIED, lacks=("Klartext", "Fidia"),
        kinds=("offset",), columns=("work_offset",),
    ),
    State("work offset of a family", "G154 P3, G505, G55 O2, cycle 247", _CARRIED, lacks=_others("Fanuc", "Haas")),
    State(
        "edge of the tool", "D2", _CARRIED, lacks=_others("Sinumerik"), lacking=_REPORTED, columns=("edge",),
    ),
    State(
        "number of the tool length that is not the tool's", "H5", _CARRIED, lacks=("Sinumerik", "Klartext", "Fidia"),
        lacking=_REPORTED,
    ),
    State("tool", "T, M6, TOOL CALL, M306", _CARRIED, kinds=("tool_change",), columns=("tool",)),
    State("next tool", "T, TOOL DEF", _CARRIED, lacks=("Fidia",), lacking=_REPORTED, kinds=("tool",)),
    State("tool without motion behind it", "T7 M6", _REPORTED),
    State(
        "what is added to the tool", "DL+0.5, TOFFL, G43.1", _REFUSED, kinds=("delta",),
        loss=Wording("CNV173", "dl_dr_tool"),
    ),
    State(
        "tilted plane", "CYCLE800, PLANE, G68.2, G254", _PATH, kinds=("tilt", "plane", "cycle800", "level"),
        columns=("plane", "xyz_is_tip", "length_axis", "working_plane"),
    ),
    State("frame and shift", "TRANS, ROT, SCALE, G52, cycle 7", _PATH, kinds=("frame",)),
    State("TCP", "TRAORI, M128, G43.4, G96 (Fidia)", _PATH, columns=("tcp",)),
    State("limit of the compensating motions", "M128 F1000", _REPORTED, kinds=("following",), by_value=True),
    State("tip at the ends of blocks", "M114", _PATH, columns=("at_ends",)),
    State("turn of the tool on a great circle", "ORIVECT, PATHCTRL VECTOR", _REPORTED, columns=("orientation",)),
    State("other rotary positions than the tool axis gives", "C90 with an upright tool", _REPORTED),
    State(
        "smoothing cycle", "CYCLE832, cycle 32", _REPORTED, kinds=("cycle832", "cycle32"),
    ),
    State("smoothing words", "G64, G5.1 Q1, G8 P1, G187, COMPCAD, SOFT", _REPORTED),
    State("exact stop", "G60, G61, G9", _REPORTED, kinds=("exact_stop",)),
    State(
        "tolerance of the path", "CTOL, OTOL, G187 E0.05", _REPORTED, kinds=("tolerance", "orientation_tolerance"),
    ),
    State("flood", "M8", _CARRIED, kinds=("coolant",)),
    State("mist", "M7", _CARRIED, lacks=("Haas",)),
    State("coolant through the tool", "M26, M88", _CARRIED, lacks=_others("Sinumerik", "Klartext")),
    State("clamps and other words of the builder", "M10, M61, H7", _CARRIED, lacks=_NC, kinds=("m", "h")),
    State(
        "words that a definition declares", "[control.known]", _CARRIED, lacks=_NC, lacking=_REPORTED, kinds=("known",),
    ),
    State("feed", "F, G94", _CARRIED, columns=("feed",)),
    State("feed per revolution", "G95, M136", _CARRIED, lacks=("Fidia",), columns=("feed_mode",)),
    State("inverse time", "G93", _PATH),
    State("feed along another way than the tip's", "M116, G94 on rotary axes", _PATH, columns=("feed_path",)),
    State("speed and sense of the spindle", "S, M3, M4", _CARRIED, kinds=("speed",), columns=("rpm",)),
    State("spindle off", "M5", _CARRIED, kinds=("spindle",), columns=("spindle",)),
    State("spindle at an angle", "SPOS, M19, cycle 13", _REFUSED),
    State("constant surface speed", "G96", _REFUSED),
    State("jump, loop, subprogram", "GOTO, WHILE, CALL LBL, M97", _PATH, columns=("file",)),
    State("subprogram in a file of its own", "M98, CALL PGM", _REPORTED, lacks=("CL",), lacking=_PATH),
    State("block skip", "/", _CARRIED, kinds=("block_skip",)),
    State("block skip of a tool change, a length, a head or an end", "/M6, /G43, /M5", _REPORTED),
    State("block skip in a program with jumps", "/", _REFUSED),
    State(
        "radius compensation", "G41, G42, RL, RR", _CARRIED,
        columns=("compensation", "compensation_plane", "compensation_style", "stated_radius"),
    ),
    State(
        "register of the radius that is not the tool's", "D13", _CARRIED, lacks=_others("Fanuc", "Haas"),
        columns=("radius",),
    ),
    State("dwell", "G4, cycle 9", _CARRIED, kinds=("dwell",)),
    State("stop", "M0, M1, STOP", _CARRIED, kinds=("stop", "optional_stop")),
    State("change of the pallet", "M60 (LinuxCNC)", _REFUSED),
    State("message", "MSG, (MSG,)", _CARRIED, kinds=("message",)),
    State("comment", "( ), ;", _CARRIED),
    State(
        "stock for the control's graphics", "BLK FORM, WORKPIECE", _REPORTED, kinds=("stock",),
        loss=Wording("CNV150", "stock_not_carried"),
    ),
    State("limits of the axes off", "G23", _REPORTED),
    State("override of the feed", "M49, M50 P0", _REPORTED, kinds=("unasked",)),
    State("output of the machine", "M67", _REPORTED),
    State("function that prints, waits, or speaks to the PLC", "FN 14 to FN 38, SETAL, M118", _REPORTED),
    State("unit", "G20, G70, INCH", _PATH, columns=("inches",)),
    State(
        "position of the machine", "SUPA, G53, M91, M140", _REPORTED, kinds=("retract", "leave"),
        columns=("machine_frame", "machine_steps"),
    ),
    State("rotary axes between operations and at the end", "G0 A30", _REPORTED),
    State("drilling cycle", "CYCLE81, G83, cycle 200", _REPORTED, kinds=("hole", "cycle_value")),
    State("variable", "#1, #100, Q1", _PATH),
    State("variable that outlives the program", "R1, #500, QR1", _REPORTED, kinds=("variable",), by_value=True),
    State("end", "M30, M2", _PATH, kinds=("end",)),
    State("begin anew", "M99 of a main program", _REPORTED),
)  # fmt: skip

#: Words without effect on the path that every header writes again, that set what is so anyhow, or that other means
#: convert: they are not reported.
SAID_ANYHOW: Final = frozenset(
    {"G40", "FNORM", "COMPOF", "EXTERN", "G49", "G80", "G90", "G94", "G97"}
    | {"G43", "G43.1", "G43.2", "G44"}  # tool lengths
    | {"G15", "G50", "G50.1", "G13.1", "G22", "G91.1", "G90.1"}  # cancellations
)

_BY_KIND: Final = {kind: state for state in STATES for kind in state.kinds}


def loss_of(kind: str, value: object = None) -> tuple[Fate, Wording | None]:
    """Return what becomes of an event that no operation holds, and what is said of it; one without a row is refused."""
    state = _BY_KIND.get(kind)
    if state is None:
        return Fate.REFUSED, Wording("CNV170", "unknown_state", kind=kind)
    if state.by_value:
        variant = "variable_not_carried" if kind == "variable" else "not_carried"
        return state.fate, Wording("CNV150", variant, lost=(str(value),))
    return state.fate, state.loss


def table_rows() -> Iterator[tuple[str, ...]]:
    """Yield the rows of the page on conversion: name, words, and the fate on each target."""
    for state in STATES:
        yield (state.name, state.words, *(state.on(target) for target in TARGETS))
