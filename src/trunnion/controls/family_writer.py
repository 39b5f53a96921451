"""The seam between what all controls share and what a family of them says in its own way.

In:     events, arcs, planes and rows, with the codes and number formats of the control's definition.
Out:    the words and lines that say them.

A family is a module that has everything of ``FamilyWriter``; ``trunnion.output.families.registry`` names those that
there are. Programs, their order and their modal state are made by ``trunnion.output.program_writer`` for all of them.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.template import Value
from trunnion.controls.words import NumberFormat
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Arcs, Coolant, CutterComp, Dwell, Message, Operation, SpindleOff, SpindleOn, Stop
from trunnion.planning.holes.cycles import Cycle, SpindleState

Formats = Mapping[str, NumberFormat]
Codes = Mapping[str, int]

#: In the call of a cycle: here stand X and Y of the first hole, which then has no block of its own.
FIRST_HOLE = "{at}"

#: In the call of a cycle: here stand X and Y of every hole, each of which is said by all lines of the call.
EACH_HOLE = "{each}"


#: The words of circles that are told by their radius, in families that can say them so.
RADIUS_ARC_WORDS = ("arc_by_radius", "arc_radius")

#: So many of its last digits may the centre be off that a control finds by a radius; beyond that it is told the centre.
MAX_CENTRE_ERROR_DIGITS = 2.0

#: The setting that says how holes are made between which the tool axis changes, on controls that have several ways, and
#: the way that all have which know tilted planes: each axis has its plane. Any other turns the tool from hole to hole.
HOLES_SETTING, HOLES_IN_PLANES = "holes", "planes"


class UnsupportedFeatureError(Exception):
    """A family has no way to say something; ``what`` it is, and the ``cure``."""

    def __init__(self, what: str, cure: str) -> None:
        super().__init__(what)
        self.what, self.cure = what, cure


#: Events that are words, and may join a motion block.
WordEvent = SpindleOn | SpindleOff | Coolant | CutterComp


@dataclass(frozen=True, slots=True, eq=False)
class ArcWords:
    """What makes rows of a table into arcs.

    columns  word -> (a,) int64 counts, one for each arc
    forced   word -> (a,) int64 1 where the word is written though it prints as before
    lines    (a,) a line of its own before each arc's block, empty where it needs none; None: no block does
    """

    columns: Mapping[str, Ints]
    forced: Mapping[str, Ints]
    lines: list[str] | None = None


class FamilyWriter(Protocol):
    """What words and templates of a definition cannot say; a module of functions without any state.

    WORDS    the words that its motion blocks need besides the axes; a definition must have them all
    CODES    the codes that it asks of its definitions
    PLANES   the ways it has to say a tilted plane, the usual one first; templates are called after them
    CHOICES  the settings of its definitions that have but a few values, with those, the usual one first
    FIELDS   the values that its templates may print besides those of all families: what ``values`` returns
    """

    WORDS: tuple[str, ...]
    CODES: tuple[str, ...]
    PLANE_COMMANDS: tuple[str, ...]
    SETTING_CHOICES: Mapping[str, tuple[str, ...]]
    TEMPLATE_FIELDS: frozenset[str]

    def comment(self, text: str) -> list[str]:
        """Lines that the control ignores, whatever the text is."""

    def escape_comment(self, text: str) -> str:
        """A text as it may stand in the comments that templates hold."""

    def tool_call(self, number: int, name: str, by_name: bool) -> str:
        """What templates print for the tool: its number, or its name.

        Raises
        ------
        UnsayableError
            When the control cannot call it so.
        """

    def dwell(self, event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
        """The lines that wait; ``rpm`` is the spindle's speed, None while it stands.

        Raises
        ------
        UnsayableError
            When the control cannot wait so.
        """

    def stop(self, event: Stop, codes: Codes) -> list[str]:
        """The lines that stop the program."""

    def message(self, event: Message) -> list[str]:
        """The lines that speak to the reader of the program or to the operator."""

    def event_words(self, event: WordEvent, codes: Codes, coolant: Codes) -> dict[str, float]:
        """The words of an event that joins a motion block, with their values."""

    def first_block_words(
        self, motion: Motion, tool: str, register: int, settings: Mapping[str, str]
    ) -> dict[str, float]:
        """The words that join the first block of a motion's rows, such as those of the tool's length.

        Where X and Y are gone to before Z, they stand in the block with Z.

        Parameters
        ----------
        motion
            All rows of one manner, in one plane.
        tool
            What ``tool_call`` returned for the tool in the spindle, or the setting of the run.
        register
            Of its length, as LOAD/TOOL names it; 0 for none.
        settings
            Those of the run over those of the definition.
        """

    def validate_operation(
        self, operation: Operation, spindle_known: bool
    ) -> list[tuple[int, UnsupportedFeatureError]]:
        """What the control would refuse in an operation though it has words for it, with lines of the CL file.

        ``spindle_known`` says whether a speed is in force from an operation before.
        """

    def validate_settings(self, settings: Mapping[str, str]) -> list[tuple[str, str]]:
        """Settings besides ``SETTING_CHOICES`` that make no sense, with what to write in their place."""

    def cycle_call(
        self, cycle: Cycle, top: float, turning: SpindleState | None, settings: Mapping[str, str], formats: Formats
    ) -> list[str]:
        """The lines that make a hole-making cycle modal: each position that follows is a hole.

        A line with ``FIRST_HOLE`` in it is the first hole too, with its position there and the feed at its end. Lines
        of which one has ``EACH_HOLE`` in it are no cycle: they make one hole, and are said for each.

        Parameters
        ----------
        cycle
            With a retract height.
        top
            Z of the points of the holes, mm.
        turning
            The spindle; None while it stands.
        settings
            Those of the run over those of the definition. ``HOLES_SETTING`` is ``HOLES_IN_PLANES`` unless each hole
            has its own tool axis: then ``top`` is along it, and ``EACH_HOLE`` is a line alone, before those of a
            hole's cycle.
        formats
            Of the definition.

        Raises
        ------
        CycleError
            When the cycle cannot be said.
        """

    def cycle_cancel(self) -> list[str]:
        """The lines that end a modal cycle."""

    def row_words(self, rapid: Flags, per_rev: Flags, codes: Codes) -> dict[str, Ints]:
        """The words that say how rows are gone to: word -> (n,) int64 counts, for every row as if none were an arc."""

    def arc_words(
        self, arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool
    ) -> ArcWords:
        """The words that make rows into arcs.

        Parameters
        ----------
        arcs
            All arcs of the operation, about X, Y or Z.
        tip : (n, 3) float64
            End points of the whole operation, mm.
        rows : (a,) int64
            Indices into ``arcs`` of those that are wanted.
        codes, formats
            Of the definition.
        by_radius
            Say circles by their radius where that is safe; only families with the words ``RADIUS_ARC_WORDS`` are asked
            to.
        """

    def template_values(self, settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
        """What ``TEMPLATE_FIELDS`` names, in one operation.

        Parameters
        ----------
        settings
            Those of the run over those of the definition.
        plane : (3, 3) float64
            X, Y and Z of the operation's tilted plane as columns, as seen from the program; None without one.
        """
