"""Settings of a Fanuc: how numbers without a decimal point count."""

import re
from collections.abc import Collection, Mapping
from dataclasses import field
from typing import Final

from trunnion.compensation.styles import TYPE_A, UNKNOWN_STYLE
from trunnion.definitions import Table
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.mode_words import END_OF_CYCLES
from trunnion.readers.control.start_modes import MOTION, PLANE_OF_POSE, check_start_modes
from trunnion.readers.families.fanuc.words import MORE_OFFSETS, NO_PLANE_OF_POSE, TABLE, THREADS, is_own_word
from trunnion.readers.program.declared_variables import read_variables
from trunnion.readers.program.forms import read_form
from trunnion.readers.program.settings import family_of, reading_of, unit_of
from trunnion.readers.rs274.block import Block, Number
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.word_meanings import NO_WORDS, WordMeanings, read_word_meanings
from trunnion.records import dataclass

#: Letters whose whole numbers count in least increments: lengths, and angles.
LENGTHS: Final = (*"XYZUVWIJKRQ", ",R", ",C")
ANGLES: Final = tuple("ABC")

#: What decides on a Fanuc which modes a reset, and so the end of a program, ends.
KEPT_BY: Final = "parameter 3402"

#: How the reader takes the control to start.
START_MODES: Final = {
    "distances": "G90", "plane": "G17", "compensation": "G40", "feed": "G94", MOTION: "G80", "length": "G49",
    "tilted plane": "G69", END_OF_CYCLES: "G98",
}  # fmt: skip

#: P of G54.1 on a control with all of them.
HIGHEST_EXTENDED: Final = 300

#: The least increment of inches as a ratio of that of millimetres; feeds by feed mode and inches; seconds of a dwell.
_INCH_PART: Final = 0.1
_FEEDS: Final = {(94, False): 1.0, (94, True): 0.01, (95, False): 0.01, (95, True): 0.0001}
_SECONDS: Final = 0.001


#: How radius compensation begins and ends, by its name: no manual at hand says what type B makes of all corners.
_STYLES: Final = {"A": TYPE_A, "B": UNKNOWN_STYLE}

#: P of G30.
REFERENCE_POINTS: Final = (2, 3, 4)

#: Common variables.
VARIABLE: Final = re.compile(r"#[1-9][0-9]{2}")


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a control.

    calculator   numbers without a point are millimetres, inches and degrees, not least increments
    states_numbers   the definition says how they count
    unit         mm or inch, as long as a program states none; empty: not known
    increment    the least increment, mm and degrees; a tenth of it for inches
    words        words that the control has in place of the family's
    point_is_seconds   P of a dwell counts seconds if it has a point, milliseconds if not
    m_codes_last       M codes act at the end of their block, which may have one
    repeat_letter      the letter of how often a cycle drills: K, or L where I, J and K describe pecks
    program_digits     digits of program numbers in M98 P; more say how often
    needs_program_number  a main program begins with its O number
    threads_stop_spindle  the spindle stands still after threads, until M3 or M4
    home_ends_length  G28 takes the tool length off for the blocks behind it
    home_takes_all  G28 without axes takes all of them home
    length_along_z  G43 counts along Z in every working plane; else a parameter may make it count across the plane
    compensation_style  how it compensates the radius, a key of ``STYLES``: type A, or not known (type B)
    kept_by  what decides which modes the end of a program ends, as messages say it
    extended_offsets  the highest P of G54.1, or of the word that the control has in its place
    whole_feeds_count  whole numbers of F count in least increments, whatever the feed mode
    variables  values of common variables that the control has when a program starts
    reference_positions  where G30 P2 to P4 go, machine positions by axis, mm and degrees, as far as they are stated
    tool_change_stops  a tool change switches the spindle and coolant off
    """

    calculator: bool = False
    increment: float = 0.001
    unit: str = ""
    words: WordMeanings = NO_WORDS
    point_is_seconds: bool = False
    m_codes_last: bool = False
    repeat_letter: str = "K"
    program_digits: int = 4
    needs_program_number: bool = False
    threads_stop_spindle: bool = False
    whole_feeds_count: bool = False
    home_ends_length: bool = False
    home_takes_all: bool = False
    length_along_z: bool = False
    compensation_style: int = TYPE_A
    kept_by: str = KEPT_BY
    extended_offsets: int = HIGHEST_EXTENDED
    variables: Mapping[str, float] = field(default_factory=dict)
    reference_positions: Mapping[int, Mapping[str, float]] = field(default_factory=dict)
    tool_change_stops: bool = False
    states_numbers: bool = True

    def length(self, inches: bool) -> float:
        """Return the unit of whole numbers that are lengths, in mm or inches."""
        if self.calculator:
            return 1.0
        return self.increment * _INCH_PART if inches else self.increment

    @property
    def extended_word(self) -> str:
        """The word that selects an extended work offset: G54.1, or what the control has in its place."""
        return self.words.own_text(MORE_OFFSETS)

    def counts_in_cycles(self, codes: Collection[int]) -> str:
        """Return the letters of a cycle, or of a block that selects one, whose numbers count: repeats, and how many
        times as fast a thread is left.
        """
        leaves_faster = self.repeat_letter == "L" and not THREADS.isdisjoint(codes)
        return self.repeat_letter + ("J" if leaves_faster else "")

    @property
    def angle(self) -> float:
        """The unit of whole numbers that are angles, degrees."""
        return 1.0 if self.calculator else self.increment

    @property
    def seconds(self) -> float:
        """The unit of whole numbers that are times, seconds."""
        return 1.0 if self.calculator else _SECONDS

    def feed(self, mode: int, inches: bool) -> float:
        """Return the unit of whole numbers that are feeds; 1 for inverse time."""
        if self.whole_feeds_count and not self.calculator:
            return self.length(inches)
        return 1.0 if self.calculator else _FEEDS.get((mode, inches), 1.0)

    def scale(
        self, block: Block, mode: int, inches: bool, *, angles: str = "", plain: Collection[str] = frozenset()
    ) -> tuple[str, float] | None:
        """Scale the whole numbers of a block by their units; return the first word that this changes, and its value.

        The letters ``angles`` are angles besides A, B and C; those in ``plain`` count as they are written.
        """
        changed: tuple[str, float] | None = None
        if self.calculator:
            return changed
        for letter, number in block.words.items():
            if not number.whole or letter in plain:
                continue
            if letter in ANGLES or letter in angles:
                factor = self.angle
            elif letter in LENGTHS:
                factor = self.length(inches)
            elif letter == "F":
                factor = self.feed(mode, inches)
            else:
                continue
            block.words[letter] = Number(number.value * factor)
            if changed is None and number.value and factor != 1.0:
                changed = f"{letter}{number.value:g}", number.value * factor
        return changed

    def check_dwell(self, block: Block) -> None:
        """Refuse P of a dwell with a point, where P counts milliseconds and takes none: the control stops there."""
        dwell = block.words.get("P")
        if not self.point_is_seconds and dwell is not None and dwell.point:
            raise BlockError(Wording("NC215", "p_of_dwell_with_point"))

    def scale_dwell(self, block: Block) -> None:
        """Turn seconds of a dwell into milliseconds, where a point means seconds."""
        dwell = block.words.get("P")
        if self.point_is_seconds and dwell is not None and not dwell.whole:
            block.words["P"] = Number(dwell.value / _SECONDS)


def _reference_positions(table: Table, machine: Machine) -> dict[int, dict[str, float]]:
    """Return where G30 takes axes, machine positions by P and axis."""
    own = table.table("reference_positions")
    axes = [axis.name.upper() for axis in machine.axes]
    found = dict[int, dict[str, float]]()
    for number in REFERENCE_POINTS:
        positions = own.table(f"P{number}")
        found[number] = {name: positions.number(name) for name in axes if name in positions}
        positions.report_unread_keys()
    own.report_unread_keys()
    return found


def start_modes_of(words: WordMeanings) -> Mapping[str, str]:
    """Return the modes with which a control starts, by the words that it has for them."""
    if NO_PLANE_OF_POSE not in words.g.values():
        return START_MODES
    return {**START_MODES, PLANE_OF_POSE: words.own_text(NO_PLANE_OF_POSE)}


def settings_of(machine: Machine) -> Settings:
    """Read the settings of a machine's control; InputError if they are wrong."""
    table = reading_of(machine)
    numbers = table.text("whole_numbers", "increments", one_of=("increments", "calculator"))
    increment = table.number("least_increment_mm", 0.001, above=0.0)
    unit = unit_of(table)
    read_form(table, family_of(machine))
    words = read_word_meanings(table, is_own_word, TABLE.meanings)
    check_start_modes(table, start_modes_of(words))
    settings = Settings(
        numbers == "calculator",
        increment,
        unit,
        words,
        point_is_seconds=table.text("dwells", "milliseconds", one_of=("milliseconds", "point")) == "point",
        m_codes_last=table.text("m_codes", "each", one_of=("each", "last")) == "last",
        repeat_letter=table.text("cycles_repeat_with", "K", one_of=("K", "L")),
        program_digits=table.integer("program_digits", 4, at_least=4, at_most=8),
        needs_program_number=table.flag("needs_program_number", False),
        threads_stop_spindle=table.flag("threads_stop_spindle", False),
        whole_feeds_count=table.text("whole_feeds", "feeds", one_of=("feeds", "increments")) == "increments",
        home_ends_length=table.flag("home_ends_length", False),
        home_takes_all=table.flag("home_takes_all", False),
        length_along_z=table.flag("length_along_z", False),
        compensation_style=_STYLES[table.text("compensation_start", "A", one_of=tuple(_STYLES))],
        kept_by=table.text("kept_by", KEPT_BY),
        variables=read_variables(table, VARIABLE, "#500"),
        extended_offsets=table.integer("extended_offsets", HIGHEST_EXTENDED, at_least=1, at_most=HIGHEST_EXTENDED),
        tool_change_stops=table.flag("tool_change_stops", False),
        reference_positions=_reference_positions(table, machine),
        states_numbers="whole_numbers" in table,
    )
    table.report_unread_keys()
    table.raise_problems()
    return settings
