"""The interface of a control family's writer: what words and templates of a definition cannot express.

A writer is a module with everything that ``FamilyWriter`` lists; ``trunnion.families`` names the writers that there
are. It turns events, arcs, cycles and planes into words and lines, with the codes and number formats of the
definition. The sequence of a program and its modal state are common to all families (``trunnion.output``).
"""

import re
from collections.abc import Mapping
from typing import Final, Protocol

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.template import Value
from trunnion.controls.words import IncrementWords, NumberFormat
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.splines import Spline
from trunnion.model.toolpath import Arcs, Coolant, CutterComp, Dwell, Message, Operation, SpindleOff, SpindleOn, Stop
from trunnion.planning.holes.cycles import Cycle, SpindleState
from trunnion.records import dataclass

Formats = Mapping[str, NumberFormat]
Codes = Mapping[str, int]

#: Events that are words and can join a motion block.
WordEvent = SpindleOn | SpindleOff | Coolant | CutterComp

#: Placeholder in a line of ``cycle_call`` for X and Y of the first hole, which then has no block of its own.
FIRST_HOLE: Final = "{at}"

#: Placeholder in a line of ``cycle_call`` for X and Y of each hole: all lines are written for every hole.
EACH_HOLE: Final = "{each}"

#: Greatest error of the centre that a control computes from a radius, in last digits; beyond it the centre is written.
MAX_CENTRE_ERROR_DIGITS: Final = 2.0


class UnsupportedFeatureError(Exception):
    """The family cannot express something."""

    def __init__(self, wording: Wording) -> None:
        super().__init__(wording)
        self.wording = wording


@dataclass(frozen=True, slots=True, eq=False)
class ArcWords:
    """The words that turn rows of a block table into arcs.

    columns  word -> (a,) int64 counts, one for each arc
    forced   word -> (a,) int64, 1 where the word is written even if it is modal and unchanged
    lines    (a,) a line before the block of each arc, empty for none; None: no arc needs one
    """

    columns: Mapping[str, Ints]
    forced: Mapping[str, Ints]
    lines: list[str] | None = None


class FamilyWriter(Protocol):
    """The writer of a control family: a module of functions without state.

    WORDS             words of its motion blocks besides the axes; a definition must define all of them
    COMPENSATES_WITH_TCP  radius compensation is by the radius of the tool with TCP too, in the working plane
    CODES             codes that its definitions must give
    PLANE_COMMANDS    its commands for tilted planes, the default first; template names end with them
    PLANE_TEMPLATES_OF  commands -> the command whose templates they share, but for the one that switches the plane on
    PLANES_OF_POSE    commands that take the plane from the rotary positions that they print
    SETTING_CHOICES   settings of its definitions with a fixed set of values, the default first
    SETTING_MEANINGS  what each of these settings changes, in sentences
    SETTING_FIELDS    settings that act through values of its templates alone -> those values; where no template of a
                      definition prints one of them, the setting has no effect
    LINE_COMMENTS     beginnings of lines that are comments to their end; the first one begins further lines
    COMMENTS          group 1 is a comment within a line, or a message to the operator; what else matches has none
    TEMPLATE_FIELDS   values that its templates may print besides the common ones: the keys of ``template_values``
    BLOCK_NUMBER_LETTERS  what may stand before a block number; empty among them: numbers without a letter, or none
    HIGHEST_BLOCK_NUMBER  the highest that the control takes
    NEVER_NUMBERED    signs with which lines begin that can have no block number
    INCREMENTS        how X, Y and Z are said as increments; None: they cannot be
    """

    WORDS: tuple[str, ...]
    COMPENSATES_WITH_TCP: bool
    CODES: tuple[str, ...]
    PLANE_COMMANDS: tuple[str, ...]
    PLANE_TEMPLATES_OF: Mapping[str, str]
    PLANES_OF_POSE: frozenset[str]
    SETTING_CHOICES: Mapping[str, tuple[str, ...]]
    SETTING_MEANINGS: Mapping[str, str]
    SETTING_FIELDS: Mapping[str, tuple[str, ...]]
    TEMPLATE_FIELDS: frozenset[str]
    LINE_COMMENTS: tuple[str, ...]
    COMMENTS: re.Pattern[str]
    BLOCK_NUMBER_LETTERS: tuple[str, ...]
    HIGHEST_BLOCK_NUMBER: int
    NEVER_NUMBERED: str
    INCREMENTS: IncrementWords | None

    def comment(self, text: str) -> list[str]:
        """Return a text as comment lines, whatever characters are in it."""

    def escape_comment(self, text: str) -> str:
        """Return a text without what would end or break a comment of a template."""

    def tool_call(self, number: int, name: str, by_name: bool) -> str:
        """Return the tool as a tool change names it: its number, or its name.

        Raises ``UnsupportedFeatureError`` if the control cannot call the tool so.
        """

    def tool_preselection(self, call: str) -> list[str]:
        """Return the lines that bring a tool to the changer, named as ``tool_call`` returned it; none if unknown."""

    def dwell(self, event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
        """Return the lines of a dwell; ``rpm`` is the spindle speed, None while the spindle is stopped.

        Raises ``UnsupportedFeatureError`` if the control cannot dwell so.
        """

    def stop(self, event: Stop, codes: Codes) -> list[str]:
        """Return the lines of a program stop."""

    def message(self, event: Message) -> list[str]:
        """Return the lines of a comment for the reader of the program, or of a message to the operator."""

    def event_words(self, event: WordEvent, codes: Codes, coolant: Codes) -> dict[str, float]:
        """Return the words of an event and their values; they join a motion block."""

    def first_block_words(
        self, motion: Motion, tool: str, register: int, settings: Mapping[str, str]
    ) -> dict[str, float]:
        """Return the words that join the first motion block, such as those of the tool length.

        Where the tool goes to X and Y before Z, they are in the block with Z.

        motion    all rows of one machining mode, in one plane
        tool      the tool as ``tool_call`` returned it, or as the run's setting gives it
        register  of the tool length, as LOAD/TOOL names it; 0 for none
        settings  those of the run over those of the definition
        """

    def validate_operation(
        self, operation: Operation, spindle_known: bool
    ) -> list[tuple[int, UnsupportedFeatureError]]:
        """Return what the control would reject in an operation, with lines of the CL file.

        ``spindle_known`` tells whether a spindle speed is active from an earlier operation.
        """

    def validate_settings(self, settings: Mapping[str, str]) -> list[tuple[str, Wording]]:
        """Return the invalid settings, each with the phrase of what to write; those of ``SETTING_CHOICES`` are checked
        elsewhere.
        """

    def validate_plane(self, settings: Mapping[str, str], plane: Floats, of_pose: Floats) -> Wording | None:
        """Return why the control cannot say a tilted plane by the command of the settings; None if it can.

        settings  those of the run over those of the definition, and ``PROJECTED_ANGLES`` of the vocabulary
        plane     (3, 3) float64: X, Y and Z of the plane as columns, in program coordinates
        of_pose   (3, 3) float64: the same of the plane in which the machine stands at its rotary position
        """

    def cycle_call(
        self, cycle: Cycle, top: float, spindle: SpindleState | None, settings: Mapping[str, str], formats: Formats
    ) -> list[str]:
        """Return the lines that make a drilling cycle modal: every position that follows is a hole.

        A line with ``FIRST_HOLE`` drills the first hole itself, with X and Y in that place and the feed at its end.
        Lines of which one has ``EACH_HOLE`` make a single hole, and are written for each.

        cycle     with a retract height
        top       Z of the hole points, mm
        spindle   None while it is stopped
        settings  those of the run over those of the definition. ``HOLES_SETTING`` is ``HOLES_IN_PLANES`` unless each
                  hole has its own tool axis: then ``top`` is measured along that axis, and ``EACH_HOLE`` is a line
                  alone, before those of a hole's cycle
        formats   of the definition

        Raises ``CycleError`` if the control cannot make the cycle.
        """

    def cycle_cancel(self) -> list[str]:
        """Return the lines that cancel a modal cycle."""

    def row_words(self, rapid: Flags, per_rev: Flags, codes: Codes) -> dict[str, Ints]:
        """Return the motion and feed-mode words of n rows, as if none were an arc: word -> (n,) int64 counts."""

    def arc_words(
        self, arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool
    ) -> ArcWords:
        """Return the words that turn rows into arcs.

        arcs            all arcs of the operation, about X, Y or Z
        tip             (n, 3) float64: end points of the whole operation, mm
        rows            (a,) int64: indices into ``arcs`` of the arcs to write
        codes, formats  of the definition
        by_radius       program circles by their radius where that is safe; only for families with ``RADIUS_ARC_WORDS``
        """

    def takes_spline(self, spline: Spline) -> bool:
        """Whether the control has words for a spline; the setting ``splines`` lets ``spline_lines`` write them."""

    def spline_lines(self, spline: Spline, formats: Formats) -> list[str]:
        """Return the lines that lead along a spline, a block each, from its start; the feed is said before.

        Raises ``WordRangeError`` if a number is beyond the limits of its format.
        """

    def template_values(self, settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
        """Return the values of ``TEMPLATE_FIELDS`` for one operation.

        settings  those of the run over those of the definition; and ``PLANES_USED`` and ``TCP_USED`` of the vocabulary,
                  absent or None where no operation of the program uses any
        plane     (3, 3) float64: X, Y and Z of the operation's tilted plane as columns, in program coordinates; None
                  without one
        """
