"""The places of a program at which texts stand: templates of a definition, and functions of its user.

Each place is declared once: the names of its templates and of its function, what only it has, and what can be changed
there. Readers of definitions and of hooks, writers, messages and the tables of the docs are made of it.
"""

from typing import Final

from trunnion.records import dataclass

#: What a name of a template begins with at the statement of a CL file, whose word follows.
EVENT_PLACE: Final = "event_"
STOP_PLACE: Final = "stop"

#: Values of statements of a CL file.
_STATEMENT: Final = ("text", "number", "words", "numbers")
_MOTION: Final = ("phase", "feed", "x", "y", "z")
_WORDS_OF_BLOCK: Final = "those of its block, by their `name` in `[[control.word]]`"


@dataclass(frozen=True, slots=True)
class OutputPlace:
    """A place of a program.

    name       of its function, behind ``at_``
    templates  their names; one that ends with ``_`` is the beginning of several, by machining mode or by word
    meaning    where in a program it is, for the docs
    within     between the motions of an operation: its text is tried before anything is written
    is_own     shipped definitions have no text there
    values     that only this place has, for its templates and in the record of its function
    words      which words a function can change there, for the docs; empty: none
    """

    name: str
    templates: tuple[str, ...]
    meaning: str
    within: bool = False
    is_own: bool = False
    values: tuple[str, ...] = ()
    words: str = ""

    @property
    def function(self) -> str:
        """The name of its function in a file of hooks; empty where hooks have ``on_event``."""
        return "" if self.templates == (EVENT_PLACE,) else f"at_{self.name}"

    def has(self, template: str) -> bool:
        """Whether a template, by its name, stands here."""
        return any(template == each or (each.endswith("_") and template.startswith(each)) for each in self.templates)


def _motion(name: str, meaning: str) -> OutputPlace:
    return OutputPlace(name, (name,), meaning, True, True, _MOTION, _WORDS_OF_BLOCK)


#: All of them, in the order in which a program has them.
OUTPUT_PLACES: Final = (
    OutputPlace("program_start", ("program_start",), "first lines of the program"),
    OutputPlace(
        "tool_list", ("tool_list",),
        "behind the first lines, in place of the list of tools, with `tool_list=on`", is_own=True,
    ),
    OutputPlace("before_operation", ("before_operation",), "before everything of an operation", is_own=True),
    OutputPlace(
        "operation_start", ("operation_start", "operation_again", "operation_follows"),
        "the start of an operation; `operation_again` with the tool of the one before, `operation_follows` with "
        "`same_tool=retract`",
    ),
    OutputPlace("tool_change", ("first_tool", "tool_change"), "the call of the first tool, and of another one"),
    OutputPlace("same_tool", ("same_tool",), "an operation with the tool of the one before", is_own=True),
    OutputPlace(
        "preselect", ("preselect",),
        "behind a tool change, with `preselect=on`, in place of the control's own words: `{next_tool}` is the next "
        "other tool", is_own=True,
    ),
    OutputPlace("spindle_on", ("spindle_on",), "where a control starts the spindle by blocks of its own"),
    OutputPlace("approach", ("approach_",), "to the first point, by machining mode"),
    OutputPlace("plane_on", ("plane_on_",), "a tilted plane"),
    OutputPlace(
        "after_approach", ("after_approach",),
        "behind these: the rotary axes stand as the first point wants them; for each plane of an operation",
        is_own=True,
    ),
    OutputPlace(
        "engage", ("engage",),
        "before each way into the cut: moves that the CL file paints as engage, or else the first at feed behind a "
        "rapid",
        True, True,
    ),
    OutputPlace(
        "first_cut", ("first_cut",), "before the first motion at feed of an operation, or its first hole", True, True
    ),
    _motion("rapid", "before each rapid"),
    _motion("linear", "before each straight move at feed"),
    _motion("arc", "before each circle"),
    OutputPlace(
        "cycle", ("cycle",), "before a cycle: `{kind}` is its first word, as DRILL", True, True, ("kind",),
        "the numbers of the CYCLE statement, by the words before them: `STEP`, `DWELL`",
    ),
    OutputPlace(
        "coolant", ("coolant",), "before a coolant is switched: `{kind}` is its word in COOLNT", True, True, ("kind",),
        "`coolant`: its M code",
    ),
    OutputPlace(
        "rewind", ("rewind",), "before the tool draws back in the cut so that a rotary axis can rewind", True, True
    ),
    OutputPlace(
        "stop", (STOP_PLACE,),
        "in place of the words for STOP and OPSTOP: `{number}` is that of the M code, `{text}` that of the statement",
        is_own=True, values=_STATEMENT,
    ),
    OutputPlace(
        "event", (EVENT_PLACE,),
        "in place of what PPRINT, DISPLY and INSERT write (`{text}`), and for [statements that Trunnion does not "
        "know](cl.md#statements-that-are-not-known), by their word: AUXFUN, user events of NX", True, True, _STATEMENT,
    ),
    OutputPlace(
        "between_planes", ("between_planes",), "before the way from one plane of an operation to the next", is_own=True
    ),
    OutputPlace("next_axis", ("next_axis_",), "to the next tool axis of an operation with holes"),
    OutputPlace("draw_back", ("draw_back_",), "the tool leaves a plane"),
    OutputPlace("next_plane", ("next_plane_",), "to the next plane"),
    OutputPlace("retract", ("retract",), "behind the last motion of an operation, before its way home", True, True),
    OutputPlace(
        "operation_end", ("leave_", "operation_end_"),
        "the way home; `leave_…` with `same_tool=retract`: the way to the next operation",
    ),
    OutputPlace("after_operation", ("after_operation",), "behind the way home", is_own=True),
    OutputPlace("program_end", ("program_end",), "last lines of the program"),
    OutputPlace("subprogram_call", ("subprogram_call",), "the call of a subprogram"),
    OutputPlace("subprogram_start", ("subprogram_start",), "its head"),
    OutputPlace("subprogram_part", ("subprogram_part",), "the head of a file in which it goes on"),
    OutputPlace("subprogram_end", ("subprogram_end",), "its foot"),
)  # fmt: skip

#: Templates that shipped definitions do not have; names that begin with ``EVENT_PLACE`` are such, too.
OWN_TEMPLATES: Final = tuple(
    name for place in OUTPUT_PLACES if place.is_own for name in place.templates if name != EVENT_PLACE
)

#: Beginnings of template names in the order in which a program has them.
TEMPLATE_ORDER: Final = tuple(name for place in OUTPUT_PLACES for name in place.templates)


def place_of(template: str) -> OutputPlace | None:
    """Return the place of a template, by its name; None for one that is none."""
    return next((place for place in OUTPUT_PLACES if place.has(template)), None)


def own_values(template: str) -> frozenset[str]:
    """Return the values that only the place of a template has."""
    place = place_of(template)
    return frozenset(place.values) if place else frozenset()
