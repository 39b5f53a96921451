"""Words that options take; the modules that know them need NumPy, so they stand here too, and a test compares them."""

from typing import Final

#: Values of the setting ``feed``.
FEEDS: Final = ("programmed", "fastest")

#: What positions of a program are while no tool length is in force.
POSITIONS: Final = ("tip", "gauge_line")

#: What becomes of a file that is not as a job has written it, where a new program takes its place.
EDITED: Final = ("refuse", "keep", "replace")

#: Settings that say how CL files are read, in every command that reads them.
CL_SETTINGS: Final = ("cl_units", "dialect", "cutcom", "open_cycle", "spline_tolerance")

#: The setting of a post that says which coordinate system the program has, and so where stock of CL files lies.
FRAME_SETTING: Final = "frame"

#: Settings of a post that its CL files do not show and the proof stands on: ``verify`` is told them again.
PROOF_SETTINGS: Final = (
    "same_tool", "operation_clearance", "first_approach", "stop_between", "radius_offset", "edge_from", "rapid_feed",
    "rigid_tap", "swivel_data", "delta_length", "delta_radius", "tolerance", "three_axis_tolerance",
    "fallback_tolerance", "spindle", "missing_feed", "feed_rapid_from", "compensation", *CL_SETTINGS,
)  # fmt: skip

#: Words in cures of messages in whose place a value is to be written.
WORDS_TO_FILL: Final = ("RPM", "MM_MIN", "PITCH_MMPR", "MM", "DEGREES", "NUMBER", "X,Y,Z", "…")

#: What the best place is best for.
GOALS: Final = ("margin", "rotary", "slides", "time", "overspeed", "collisions")

#: Kinds of files that there are schemas of.
SCHEMAS: Final = ("machine", "control", "project", "tools", "impeller", "nodes", "batch")

#: Shells whose completion can be printed.
SHELLS: Final = ("bash", "zsh", "fish", "powershell")

#: Commands whose kernels can be compiled without those of the others.
PREPARED: Final = ("post", "verify", "convert", "simulate")

#: What a batch does with each file.
ACTIONS: Final = ("post", "convert", "verify", "simulate")

#: Tasks among which one simulation of a batch may be divided.
MOST_TILES: Final = 1000
