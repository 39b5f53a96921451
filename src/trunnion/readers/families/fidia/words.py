"""The words of a Fidia NC15; its G codes act before all others of their block."""

from typing import Final

from trunnion.readers.program.word_values import one_of
from trunnion.readers.rs274.iso_words import ISO_WORDS
from trunnion.readers.rs274.word_table import Effect, When, Word, WordTable

_ERROR: Final = Effect.ERROR

#: The value of the column ``work_offset`` for O0, which there is not: O1 is one more.
OFFSET_BASE: Final = 500

TABLE: Final = WordTable(
    *ISO_WORDS,
    Word("G4", "dwell, `HD` seconds", sets="HD", letters="H"),
    Word(
        "G17 G18 G19", "working plane XY, ZX, YZ", act="plane", sets=(2, 1, 0), group="plane", letters="Q",
        values={"Q": one_of(1)},
    ),
    Word("G20", "ends a plane of G21, which is not simulated", effect=_ERROR, moves=False),
    Word("G21", "a plane by its angles is not simulated", effect=_ERROR, letters="XYZ", moves=False),
    Word("G22 G23", "a helix by its angle is not simulated", effect=_ERROR, letters="XYZIJKP", moves=False),
    Word("G55", "work offset `O`, and the tool length on", act="work_offset", letters="O"),
    Word("G154", "takes up the plane perpendicular to the tool", act="take_plane", group="plane of the tool"),
    Word("G69", "ends that plane", act="end_plane", group="plane of the tool"),
    Word("G70 G71", "inches (an error: what F counts then is not known), millimetres", act="units",
         sets=(True, False), group="units"),
    Word("G81 G82 G83 G84 G85 G86 G89", "cycle", act="cycle", needs="ZER"),
    Word("G94", effect=Effect.NONE),
    Word("G96 G196", "TCP on", act="tcp", sets=True, group="tcp"),
    Word("G97 G197", "TCP off", act="tcp", sets=False, group="tcp"),
    Word("G290", "positions of the machine"),
    Word("M242", "event `retract`", act="retract"),
    Word("M306", "event `tool_change`", act="change_tool"),
    modes=When.BEFORE_FEED,
    within_compensation=dict.fromkeys(
        ("plane", "take_plane", "end_plane", "tcp", "M6", "change_tool", "work_offset"), "unconfirmed"
    ),
)  # fmt: skip

#: The words that switch TCP for rotary axes in the head and in the table; a machine with one of each has both pairs.
TCP_OF_HEADS: Final = ("G96", "G97")
TCP_OF_TABLES: Final = ("G196", "G197")

DWELL: Final = TABLE.code("G4")
MACHINE: Final = TABLE.code("G290")
