"""The words that controls of this kind share; the table of a control names what differs."""

from typing import Final

from trunnion.readers.rs274.word_table import Effect, When, Word

#: What the message says of radius compensation.
COMPENSATION: Final = (
    "radius compensation: the path is read as programmed, and the tool centre goes beside it by what the register holds"
)

ISO_WORDS: Final = (
    Word("G0 G1 G2 G3", "rapid, line, circles", act="motion", group="motion"),
    Word("G17 G18 G19", "working plane XY, ZX, YZ", act="plane", sets=(2, 1, 0), group="plane"),
    Word("G40", effect=Effect.NONE, act="compensation", sets=0, group="compensation"),
    Word(
        "G41 G42", COMPENSATION, effect=Effect.WARNING, act="compensation", sets=(1, -1), group="compensation",
        letters="D",
    ),
    Word("G80", "ends cycles", act="cancel"),
    Word("G90 G91", "absolute, incremental", act="distances", sets=(True, False), group="distances"),
    Word("M0 M1", "events `stop`, `optional_stop`", act="iso", group="stop", when=When.AFTER_MOTION),
    Word("M2 M30", "event `end`", act="iso", group="stop", when=When.AFTER_MOTION),
    Word("M3 M4 M19", "event `spindle`; oriented by `M19` it stands", act="iso", group="spindle"),
    Word("M5", "event `spindle`: off", act="iso", group="spindle", when=When.AFTER_MOTION),
    Word("M6", "event `tool_change`", act="iso", group="tool"),
    Word("M7 M8", "event `coolant`", act="iso", group="coolant"),
    Word("M9", "event `coolant`: off", act="iso", group="coolant", when=When.AFTER_MOTION),
)  # fmt: skip

#: Units, feed modes and the ends of cycles, with the codes that most controls have for them.
COMMON_WORDS: Final = (
    *ISO_WORDS,
    Word("G20 G21", "inches, millimetres", act="units", sets=(True, False), group="units", when=When.BEFORE_FEED),
    Word(
        "G93 G94 G95", "feeds: inverse time, per minute, per revolution", act="feed_mode", sets=(93, 94, 95),
        group="feed", when=When.BEFORE_FEED,
    ),
    Word("G96", "constant surface speed is not simulated", effect=Effect.ERROR, act="surface_speed", group="speed"),
    Word("G97", effect=Effect.NONE, group="speed"),
    Word(
        "G98 G99", "cycles end at the height where the first one began (default), or at R", act="end_of_cycles",
        sets=(True, False), group="end of cycles",
    ),
)  # fmt: skip
