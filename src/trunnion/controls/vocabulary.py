"""The names that control definitions use: template fields, templates, words, and the values of some keys.

``docs/controls`` explains each of them.
"""

from typing import Final

from trunnion.encoding import ENCODINGS
from trunnion.options.groups import POSTING

#: Values that the templates of every family may print, besides the settings.
COMMON_TEMPLATE_FIELDS: Final = frozenset(
    {
        "primary", "secondary", "primary_word", "secondary_word", "operation", "tool", "tool_name", "tool_type",
        "length_number", "tool_diameter", "tool_length", "tool_corner_radius", "tool_flute_length", "tool_taper_angle",
        "tool_tip_angle", "tool_upper_radius", "tool_corner_e", "tool_corner_f", "tool_holder", "tool_extension",
        "tool_set_length", "intol", "outtol", "machine",
        "gauge_length",
        "zero_x", "zero_y", "zero_z", "time", "total_time", "time_shown", "total_time_shown",
        "home_x", "home_y", "home_z", "primary_home", "secondary_home", "primary_returns", "secondary_returns",
        "plane_x", "plane_y", "plane_z", "plane_side", "plane_sign",
        "spindle_speed", "new_speed", "spindle_code", "subprogram", "unit_word", "entry_unit", "operation_number",
        "next_tool",
    }
)  # fmt: skip

#: Units of lengths and feeds in programs.
MM: Final = "mm"
INCH: Final = "inch"

#: Fields that are lengths, besides settings; and words of motion blocks that are lengths or feeds.
LENGTH_FIELDS: Final = frozenset(
    {
        "tool_diameter", "tool_length", "tool_corner_radius", "tool_flute_length", "tool_upper_radius", "tool_corner_e",
        "tool_corner_f", "tool_extension", "tool_set_length", "intol", "outtol", "gauge_length", "zero_x", "zero_y",
        "zero_z", "home_x", "home_y", "home_z", "plane_x", "plane_y", "plane_z",
    }
)  # fmt: skip
LENGTH_WORDS: Final = frozenset({*"XYZIJK", "arc_radius", "arc_rise", "feed", "feed_per_rev"})

#: Units of numbers in setting rules that a program in inches converts.
LENGTH_UNITS: Final = ("mm", "mm/min")

#: The setting for what the registers of the radius hold.
RADIUS_REGISTER_SETTING: Final = "radius_register"

#: The setting for what X, Y and Z of motions count from, and the value with which they are increments.
DISTANCES_SETTING: Final = "distances"
INCREMENTAL: Final = "incremental"

#: Settings of a program that every control has: what it says about times and tools, which tools it calls, and the unit
#: of its lengths. The default is the first value.
PROGRAM_CHOICES: Final = {
    "units": (MM, INCH),
    "times": ("default", "on", "off"),
    "tool_list": ("off", "on"),
    "operation_list": ("off", "on"),
    "encoding": ENCODINGS,
    "line_ends": ("lf", "crlf"),
    "comments": ("as_written", "capitals"),
    "preselect": ("off", "on"),
    "restart": ("off", "on"),
    "standing_spindle": ("refused", "allowed"),
    "program_from": ("setting", "file"),
    RADIUS_REGISTER_SETTING: ("unknown", "difference", "radius"),
    "stop_between": ("off", "on"),
    "same_tool": ("home", "retract", "clearance"),
    "keep_rotary": ("off", "same_tool", "on"),
    "first_approach": ("as_control", "in_turn"),
    DISTANCES_SETTING: ("absolute", INCREMENTAL),
}

#: What each of them changes.
PROGRAM_MEANINGS: Final = {
    "units": "What lengths and feeds of the program count in. Settings that are lengths stay in mm.",
    "times": "Machining times of each operation and of the program as comments. By default Klartext has them, and the "
    "other controls do not.",
    "tool_list": "With on, all tools with their data are comments at the head.",
    "operation_list": "With on, all operations are comments at the head: tool, time, spindle, least and greatest feed, "
    "and what they cut in X, Y and Z.",
    "encoding": "What names and texts are written in. A character that it lacks is transliterated, with a warning.",
    "line_ends": "What ends a line: LF, or CR and LF.",
    "comments": "With capitals, comments and messages to the operator have no small letters.",
    "preselect": "With on, the program selects the next other tool after each tool change; without it SELECT/TOOL of "
    "the CL file does.",
    "restart": "With on, every operation calls its tool and its speed, so that the program can be entered there.",
    "standing_spindle": "With allowed, cuts before the first SPINDL of the CL files, or after SPINDL/OFF, are written, "
    "for tools that do not turn; they are refused otherwise.",
    "program_from": "Where the number or name of the program comes from: the setting program, or the name of its "
    "file, as 1234 of O1234.nc.",
    RADIUS_REGISTER_SETTING: "What radius compensation works with: a difference (by how much the tool is larger than "
    "in the CL file, in the register D or as the radius in the tool table), or the radius itself. The proof and the "
    "simulation follow the path that the control makes of it; with unknown they say that nobody has stated it.",
    "stop_between": "With on, an optional stop (M1) stands between operations, where the tool is at home.",
    "same_tool": "How the tool goes on to an operation that it cuts too: home; retract goes home along the spindle "
    "only, and the rotary axes turn there; clearance leaves along the tool to operation_clearance where the tilt "
    "stays, and retracts elsewhere.",
    "keep_rotary": "With on, the rotary axes stay at their tilt on the way home where the next operation begins with "
    "it; with same_tool only where the tool stays, too.",
    "first_approach": "With in_turn, axes move one group after the other at the start of an operation, and behind "
    "turns to another plane or hole within one: the rotary axes, those across the tool, the one along it; as_control "
    "does so where the control's definition says it.",
    DISTANCES_SETTING: "What X, Y and Z of motions count from: the zero, or with incremental the position printed "
    "before (G91; I words in Klartext), in three-axis operations and tilted planes. Approaches, holes of cycles, "
    "splines, blocks that may be skipped, and motion with TCP or turning axes stay absolute.",
}

#: Settings of a run besides these: a definition cannot set them.
RUN_ONLY_SETTINGS: Final = frozenset(
    {
        "cl_units", "cutcom", "dialect", "spline_tolerance", "zero", "tcp", "tool_length", "tip_tolerance",
        "axis_tolerance", "numbers", "programs", "split", "rewind", "frame", "mode", "cycles", "drills_sideways",
        "tool_retract", "limit_margin", "clearance", "pole", "pole_angle", "lower_feed", "feed", "feed_limit",
        "compensation", "feed_rapid_from", "first_block", "first_number", "listing", "missing_feed", "open_cycle",
        "spindle",
        *(option.setting for option in POSTING),
    }
)  # fmt: skip

#: Settings whose value is also a template field.
FIELD_SETTINGS: Final = frozenset({"tool"})

#: Settings of definitions that writers read themselves, on any control; others are printed by templates, or have rules.
READ_SETTINGS: Final = frozenset({"method", "disengage", "program", "bore_lift", "missing_cycles"})

#: Keys of ``[control.reading]``, which count nowhere else.
READING_KEYS: Final = frozenset(
    {
        "approach_without_side", "arc_centres", "arc_vectors", "behind_circles", "block_ends", "compensation_start",
        "corner_feed", "cycles_along_tool", "cycles_repeat_with", "dwells", "end_in_subprogram", "extended_offsets",
        "feed_without_tcp", "home_ends_length", "home_takes_all", "kept_by", "least_increment_mm", "length_along_z",
        "m114", "m_codes", "machine_positions", "more_comments", "needs_program_number", "nested_comments",
        "numbers_anywhere", "peck_clearance_mm", "program_digits", "program_numbers", "reference_positions",
        "start_distances", "start_modes", "start_plane", "swivel_axes", "tape_marks", "threads_stop_spindle",
        "tool_change_stops", "units", "variables", "whole_feeds", "whole_numbers", "words",
    }
)  # fmt: skip

#: Formats that writers use although no word and no template names them, and that of plane angles, which the basic Fanuc
#: keeps for definitions that have planes.
WRITER_FORMATS: Final = frozenset(
    {"coordinate", "dwell", "feed", "speed", "pitch", "angle", "arc_angle", "primary", "inverse_time", "plane_angle"}
)

#: How comments begin in the head of a program that was written although it was refused.
FORCED_NOTICE: Final = "MUST NOT RUN AS IT IS"

#: The same in a program whose motion a user's hooks have changed.
HOOKS_NOTICE: Final = "MOTION CHANGED BY HOOKS"

#: The same for what the operator enters for radius compensation; every program of the toolpath says it anew.
ENTRY_NOTICE: Final = "radius compensation of tool"

#: Values of the records of tools and of operations, for templates with expressions.
TOOL_VALUES: Final = (
    "call", "number", "name", "kind", "diameter", "corner_radius", "length", "flute_length", "taper_angle", "tip_angle",
    "holder", "extension", "set_length", "operations",
)  # fmt: skip
OPERATION_VALUES: Final = (
    "name", "number", "tool", "mode", "method", "time", "points", "spindle_speed", "spindle_sense", "coolant",
    "least_feed", "greatest_feed", "x_min", "x_max", "y_min", "y_max", "z_min", "z_max", "work_offset", "planes",
)  # fmt: skip
RECORD_VALUES: Final = frozenset((*TOOL_VALUES, *OPERATION_VALUES))

#: Lists that templates with expressions may go through, and records that they may ask.
LISTS: Final = frozenset({"tools", "operations"})

#: Filters of templates with expressions, besides the number formats; `controls.texts.filters` has them.
FILTERS: Final = (
    "upper", "lower", "trim", "ascii", "cut", "pad", "replace", "default", "number", "round", "abs", "count", "first",
    "last", "join",
)  # fmt: skip

#: Templates that every definition must have.
REQUIRED_TEMPLATES: Final = (
    "program_start", "operation_start", "first_tool", "tool_change", "approach_three_axis", "operation_end_three_axis",
    "program_end",
)  # fmt: skip

#: Suffixes of the templates for operations with the tool along +Z, with TCP, and without TCP while rotary axes turn;
#: and with M114, on controls that have it.
#: Those for tilted planes end with the plane command.
THREE_AXIS: Final = "three_axis"
FIVE_AXIS: Final = "five_axis"
WITHOUT_TCP: Final = "without_tcp"
M114: Final = "m114"

#: Templates that every program has once.
PROGRAM_TEMPLATES: Final = ("program_start", "program_end")

#: Templates that say in which unit a file counts.
PROGRAM_START_TEMPLATES: Final = ("program_start", "subprogram_start")

#: The template that starts the spindle, on controls where that takes blocks of its own.
SPINDLE_ON: Final = "spindle_on"

#: The same for a new speed while TCP, or M114, is on, on controls where the block of a speed wants it off.
NEW_SPEED_WITH_TCP: Final = "spindle_on_with_tcp"
NEW_SPEED_WITH_M114: Final = "spindle_on_with_m114"

#: Templates for a program with subprograms: the call, the start of a subprogram, the start of one that continues an
#: operation, and the end.
SUBPROGRAM_TEMPLATES: Final = ("subprogram_call", "subprogram_start", "subprogram_part", "subprogram_end")

#: Words of a motion block that every family has.
AXIS_WORDS: Final = ("X", "Y", "Z", "primary", "secondary")

#: The word that calls the cycle defined before, on controls that call it at each hole; also the name of its code.
CYCLE_CALL_WORD: Final = "call"

#: The word for the register of radius compensation, on controls that do not take the radius of the tool in the spindle.
RADIUS_NUMBER_WORD: Final = "radius_number"

#: Words for the tool axis as a vector from tip to holder, on controls that accept it instead of rotary words; and the
#: word that replaces ``line`` in such blocks where they need one. X, Y and Z are then written in every block.
TOOL_VECTOR_WORDS: Final = ("axis_x", "axis_y", "axis_z")
VECTOR_LINE_WORD: Final = "vector_line"

#: Words for the surface normal at the contact point, in blocks with ``VECTOR_LINE_WORD``.
SURFACE_NORMAL_WORDS: Final = ("surface_x", "surface_y", "surface_z")

#: Words that switch between orienting by tool vectors and by rotary axes, on controls that need the switch.
ORIENT_BY_VECTOR_WORD: Final = "by_vector"
ORIENT_BY_AXES_WORD: Final = "by_axes"

#: Words of circles that are programmed by their radius, in families that can do so.
RADIUS_ARC_WORDS: Final = ("arc_by_radius", "arc_radius")

#: The setting for holes between which the tool axis changes, and the value that all controls with tilted planes have:
#: each tool axis gets a plane of its own. With any other value the tool turns from hole to hole under TCP.
HOLES_SETTING: Final = "holes"
HOLES_IN_PLANES: Final = "planes"

#: The setting for splines of controls that have words for them, and the value that all of these have: their points
#: become lines.
SPLINES_SETTING: Final = "splines"
LINES_FOR_SPLINES: Final = "linearize"

#: Settings that a program has only once: those of its head and its files, and those by which all of it is planned.
#: All others can differ by operation, unless the templates of the head or the end of the program print them.
PROGRAM_SETTINGS: Final = frozenset(
    {
        "title", "part", "date", "program", "series", "blank", "call", "call_folder", "normals", "rapid_feed",
        "rotary_feed", "orientation", "plane", HOLES_SETTING, SPLINES_SETTING, "bore_lift", "disengage", "rigid_tap",
        "cycle_form",
    }
)  # fmt: skip

#: Settings that only templates bring into a program, by their own names.
PRINTED_SETTINGS: Final = frozenset({"title", "part", "date", "series", "work_offset", "smoothing"})

#: Settings of the machining mode with TCP.
TCP_SETTINGS: Final = frozenset({"orientation", "tcp_on", "tcp_on_vector", "tcp_off"})

#: The value of ``feed_without_tcp`` for a control of which it is not known what F means while rotary axes turn without
#: TCP. Operations without TCP are then refused.
UNKNOWN_FEED: Final = "unknown"

#: Values of ``feed_without_tcp``: inverse time; the path of all axes together, with a degree as a millimetre; the path
#: of the linear axes, or degrees where these rest.
FEEDS_WITHOUT_TCP: Final = ("inverse_time", "all_axes", "slides", UNKNOWN_FEED)

#: Values of ``holes_from``, the height at which a cycle goes to the next hole: that of the last retract; the retract
#: height of the next hole; or the height at which the tool was when the cycle began. In the last case the tool must be
#: at the retract height then, and G80 leaves no motion word active.
HOLE_APPROACH_HEIGHTS: Final = ("above", "retract", "initial")

PHASES: Final = ("rapid", "approach", "engage", "cut", "stepover", "retract", "departure", "traverse")
#: Beginning of the template that retracts the tool before it turns to the next plane where it stands.
DRAW_BACK: Final = "draw_back"
#: The header of an operation with the tool of the one before, and the beginning of the templates by which the one
#: before leaves the part for it.
FOLLOWING: Final = "operation_follows"
#: The start of an operation with the tool of the one before, which has gone home; without it the usual one.
AGAIN: Final = "operation_again"
LEAVING: Final = "leave"
COOLANTS: Final = ("OFF", "ON", "FLOOD", "MIST", "TAP", "THRU", "AIR")
TOOL_TYPES: Final = ("MILL", "BALL", "TCUTTER", "BARREL", "DRILL", "UNKNOWN")

#: The setting for what operations switch off at their start, and its values: what the program itself uses, or all that
#: an aborted run of another program may have left on.
SAFE_START_SETTING: Final = "safe_start"
ALL_LEFT_ON: Final = "all"
SAFE_START_CHOICES: Final = ("own", ALL_LEFT_ON)

#: The template field for the work offset where rotary axes turn before the program needs it.
OFFSET_BEFORE_TURN: Final = "offset_before_turn"

#: Among the settings that a family gets for its templates: an operation of the program is in a tilted plane, under TCP;
#: its operations have different work offsets.
PLANES_USED: Final = "planes_used"
TCP_USED: Final = "tcp_used"
OFFSETS_DIFFER: Final = "offsets_differ"

#: ``Control.blocks_in_compensation`` of controls without a limit.
NO_LIMIT: Final = 9999

#: The key of a control that says what its projected angles of a plane mean, and its values: unknown; turns about Y and
#: X, as spatial angles are; both rising with the axis.
PROJECTED_ANGLES: Final = "projected_angles"
PROJECTED_CHOICES: Final = ("unknown", "turning", "rising")
