"""The definition of a control: everything about its language that is data.

Number formats, words and their order, codes, templates and settings come from TOML (``trunnion.controls.loading``).
What these cannot express is code, in the writer module of the control's family.
"""

from collections.abc import Mapping
from dataclasses import field, replace
from itertools import chain
from typing import Final

from trunnion.controls.family_writer import FamilyWriter, UnsupportedFeatureError
from trunnion.controls.setting_rules import SettingKind, SettingRule, tool_number
from trunnion.controls.template import Template
from trunnion.controls.vocabulary import (
    DISTANCES_SETTING,
    FIVE_AXIS,
    HOLES_IN_PLANES,
    HOLES_SETTING,
    INCH,
    LENGTH_FIELDS,
    LENGTH_UNITS,
    M114,
    MM,
    NEW_SPEED_WITH_M114,
    NEW_SPEED_WITH_TCP,
    ORIENT_BY_VECTOR_WORD,
    PRINTED_SETTINGS,
    PROGRAM_CHOICES,
    PROGRAM_SETTINGS,
    PROGRAM_TEMPLATES,
    TCP_SETTINGS,
    THREE_AXIS,
    TOOL_VECTOR_WORDS,
    UNKNOWN_FEED,
    VECTOR_LINE_WORD,
    WITHOUT_TCP,
)
from trunnion.controls.words import BlockNumbers, NumberFormat, Word
from trunnion.messages import Wording, phrase
from trunnion.model.axis_tolerance import AxisTolerance
from trunnion.model.motion import MachiningMode
from trunnion.records import dataclass

#: Millimetres of an inch.
MM_PER_INCH: Final = 25.4

#: The format of words without a number.
_NO_NUMBER = NumberFormat(0)


@dataclass(frozen=True, slots=True, eq=False)
class SubprogramNaming:
    """How a control names subprograms.

    extension          of their files
    capitals           letters are upper case; else lower case
    max_length         most characters of a name
    reserved_prefixes  no name starts with one of these: the control has its own programs there
    first_number       names are four-digit numbers from this one on; None: they are made of the operations' names
    prefix             precedes the name in the file name
    """

    extension: str
    capitals: bool
    max_length: int
    reserved_prefixes: tuple[str, ...] = ()
    first_number: int | None = None
    prefix: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class FormatPair:
    """A number format for five-axis and for three-axis operations; ``inch`` for lengths in programs in inches."""

    five_axis: NumberFormat
    three_axis: NumberFormat
    inch: "FormatPair | None" = None


@dataclass(frozen=True, slots=True, eq=False)
class WordDefinition:
    """A word of a motion block.

    name     its key in the definition
    letter   the address; for rotary axes, whose name the machine defines, what follows that name
    format   name of the number format; empty for a bare word
    modal    left out of a block while it would print the same number
    closing  one character behind the number, or none
    bare     letters without a number
    """

    name: str
    letter: str
    format: str
    modal: bool
    closing: str = ""
    bare: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class ArcRules:
    """Which arcs a control accepts; others become lines.

    chord_tolerance  greatest distance between such lines and the arc, mm
    only_about_z     only arcs about Z
    by_radius        circles are programmed by their radius where that is safe, and not by their centre
    helices          circles that rise
    multi_turn       circles and helices of more than one turn
    """

    chord_tolerance: float
    only_about_z: bool
    by_radius: bool
    helices: bool
    multi_turn: bool


@dataclass(frozen=True, slots=True, eq=False)
class Control:
    """A control's language, read and checked.

    family                the writer module of its family
    family_name           its key in ``trunnion.families``
    description           a sentence about it; may be empty
    extension             of program files
    longest_line          most bytes of a line
    continued             what ends a line whose block continues in the next line; empty: blocks have one line
    block_numbers         of all blocks
    formats, words        number formats by name; words of motion blocks in their order
    codes, coolant        numbers of G and M words by name, as the family asks for them
    initial_modal_state   word -> code that is active after the program start
    statements            what becomes of CL statements that Trunnion does not know: statement -> line of the program,
                          empty for nothing
    settings              name -> default value
    setting_rules         name -> what the setting may be; any text of one line where there is no rule
    setting_meanings      name -> what the setting changes, in sentences
    method_defaults       setting -> (part of a method's name, value): defaults that depend on the machining method;
                          the first part that occurs in the name decides
    tool_types, phases    texts for templates and for comments between motions
    plane_x_from_machine  X of a tilted plane is that of the machine after the tilt, unless the CL file defines another
    tcp                   the control can hold the tool tip while rotary axes turn
    feed_without_tcp      one of ``FEEDS_WITHOUT_TCP``
    shorter_way           endless axes take the shorter way, so that none crosses the end of its displayed turn
    own_blocks            spindle, coolant and radius compensation have blocks of their own
    blocks_in_compensation  most blocks in a row without motion in the plane, within radius compensation, before which
                          the control still finds the corner; ``NO_LIMIT`` where it reads as many as there are
    stops_in_compensation  it finds the corner across a stop (M0, M1) too
    radius_as_diameter    when the operator enters the radius of compensation as a diameter: ``always``, or a condition
                          ("setting 40 is DIAMETER"); empty: never
    threads_stop_spindle  the spindle stands still after a thread, until the program starts it again
    first_lines           lines at the start of a program before which nothing may be written, not even a comment
    axis_tolerance        how far the tool axis may leave its path between CL points where no setting says it
    level_approach        after a retract the tool goes to X and Y first, then to Z, not only in tilted planes
    plane_from_pose       a tilted plane is taken from the rotary position, without angles: its origin is the work
                          offset's, its axes are those of the tool
    projected_angles      what projected angles of a plane mean, of ``PROJECTED_CHOICES``
    rapid_into_planes     the first motion in a new tilted plane must be a rapid, which states X, Y and Z there
    holes_from            one of ``HOLE_APPROACH_HEIGHTS``
    subprograms           how subprograms are named; None: a program cannot call any
    templates             by name
    unit_words            the word of each unit of lengths: ``mm``, and ``inch`` where programs can count in inches
    length_settings       settings of lengths in mm whose rules do not say so
    units                 in which programs count; ``trunnion.controls.inches`` changes it with the formats
    """

    name: str
    description: str
    family: FamilyWriter
    family_name: str
    extension: str
    longest_line: int
    continued: str
    block_numbers: BlockNumbers
    formats: Mapping[str, FormatPair]
    words: tuple[WordDefinition, ...]
    codes: Mapping[str, int]
    coolant: Mapping[str, int]
    initial_modal_state: Mapping[str, int]
    statements: Mapping[str, str]
    settings: Mapping[str, str]
    setting_rules: Mapping[str, SettingRule]
    setting_meanings: Mapping[str, str]
    method_defaults: Mapping[str, tuple[tuple[str, str], ...]]
    tool_types: Mapping[str, str]
    phases: Mapping[str, str]
    arcs: ArcRules
    plane_x_from_machine: bool
    tcp: bool
    feed_without_tcp: str
    shorter_way: bool
    own_blocks: bool
    blocks_in_compensation: int
    stops_in_compensation: bool
    radius_as_diameter: str
    threads_stop_spindle: bool
    first_lines: int
    axis_tolerance: AxisTolerance
    level_approach: bool
    plane_from_pose: bool
    projected_angles: str
    rapid_into_planes: bool
    holes_from: str
    subprograms: SubprogramNaming | None
    templates: Mapping[str, Template] = field(repr=False)
    unit_words: Mapping[str, str] = field(default_factory=dict)
    length_settings: tuple[str, ...] = ()
    units: str = MM

    @property
    def unit(self) -> float:
        """A length of one in a program, mm."""
        return MM_PER_INCH if self.units == INCH else 1.0

    @property
    def length_fields(self) -> frozenset[str]:
        """Values of templates that are lengths or feeds, in mm."""
        rules = self.setting_rules.items()
        return LENGTH_FIELDS | {name for name, rule in rules if rule.is_number and rule.unit in LENGTH_UNITS}

    def differs_by_operation(self, setting: str) -> bool:
        """Whether operations of one program can have different values of a setting."""
        if setting not in self.settings or setting in PROGRAM_SETTINGS or setting in PROGRAM_CHOICES:
            return False
        templates = [self.templates[name] for name in PROGRAM_TEMPLATES if name in self.templates]
        return all(name != setting for template in templates for name, _ in template.fields())

    def values_by_operation(self, setting: str, text: str) -> list[tuple[str, str]]:
        """Return the operations and values in a setting such as ``G54,TOP:G55``; no name stands for all operations."""
        if ":" not in text or not self.differs_by_operation(setting):
            return [("", text)]
        entries = (entry.rpartition(":") for entry in text.split(","))
        return [(operation, value) for operation, _, value in entries]

    def default_for_method(self, setting: str, method: str) -> str | None:
        """Return the default of a setting for operations of a machining method, or None if there is no rule for it."""
        rules = self.method_defaults.get(setting, ())
        return next((value for part, value in rules if part.upper() in method.upper()), None)

    def allowed_instead(self, name: str, text: str) -> Wording | None:
        """Return what to write instead of a text that a setting may not be, a phrase; None if it may.

        A number that a template prints must not print as 0 unless it is 0.
        """
        formats = [self.formats[number_format] for number_format in self._printing_formats(name)]
        rule = self.setting_rule(name)
        if not rule.allows(text):
            return rule.allowed()
        if rule.kind is SettingKind.TOOL and tool_number(text or "0") is None:
            try:
                self.family.tool_call(0, text.strip('"'), by_name=True)
            except UnsupportedFeatureError:
                return rule.allowed()
        for number_format in (each for pair in formats if text for each in (pair.five_axis, pair.three_axis)):
            if float(text) and number_format.text(float(text)) == number_format.text(0.0):
                return phrase("at_least_a_digit", digit=number_format.digit)
        return None

    def setting_rule(self, name: str) -> SettingRule:
        """Return what a setting may be; a setting that a template prints with a number format is a number."""
        words = PROGRAM_CHOICES.get(name, ())
        by_default = SettingRule(SettingKind.CHOICE, one_of=words, optional=False) if words else SettingRule()
        rule = self.setting_rules.get(name, by_default)
        if rule.is_number or not self._printing_formats(name):
            return rule
        return SettingRule(SettingKind.NUMBER)

    def _printing_formats(self, name: str) -> set[str]:
        """Return the formats in which templates print a number of this name."""
        fields = chain.from_iterable(template.fields() for template in self.templates.values())
        return {number_format for field, number_format in fields if field == name and number_format in self.formats}

    def has_effect(self, setting: str) -> bool:
        """Whether a setting changes programs: a template prints it, or the writer or the planner reads it."""
        printed = {name for template in self.templates.values() for name, _ in template.fields()}
        if setting in TCP_SETTINGS and not self.template_suffix(MachiningMode.TCP, {}):
            return False
        if setting == DISTANCES_SETTING and self.family.INCREMENTS is None:
            return False
        fields = self.family.SETTING_FIELDS.get(setting, ())
        if fields or setting in PRINTED_SETTINGS:
            return bool(printed & {setting, *fields})
        return True

    def missing_beside(self, setting: str, settings: Mapping[str, str]) -> str:
        """Return a setting without which no line of the program has a printed setting; empty if there is none."""
        places = [place for template in self.templates.values() for place in template.fields_beside(setting)]
        empty = {name for name in self.settings if not settings.get(name) and name not in self.method_defaults}
        if setting not in PRINTED_SETTINGS or not places or not all(place & empty for place in places):
            return ""
        return min(name for place in places for name in place & empty)

    def without_functions(self) -> "Control":
        """Return the control with the templates of its definition alone, and none that are functions of a user."""
        kept = ((name, template.of_definition) for name, template in self.templates.items())
        return replace(self, templates={name: template for name, template in kept if template is not None})

    def with_rotary_axes(self, count: int) -> "Control":
        """Return the control of a machine with so many rotary axes: one prints no second one, none have no TCP."""
        if count != 1:
            return self if count else replace(self, tcp=False)
        return replace(self, templates={name: each.without_secondary() for name, each in self.templates.items()})

    def template_suffix(self, mode: MachiningMode, settings: Mapping[str, str]) -> str:
        """Return the suffix of the templates for a machining mode; empty if the control cannot work in that mode."""
        plane = settings.get("plane") or self.settings.get("plane") or next(iter(self.family.PLANE_COMMANDS), "")
        suffixes = {
            MachiningMode.THREE_AXIS: THREE_AXIS,
            MachiningMode.TILTED: plane,
            MachiningMode.WITHOUT_TCP: WITHOUT_TCP,
            MachiningMode.M114: M114,
        }
        suffix = suffixes.get(mode, FIVE_AXIS if self.tcp else "")
        if suffix == WITHOUT_TCP and self.feed_without_tcp == UNKNOWN_FEED:
            return ""
        return suffix if f"approach_{suffix}" in self.templates else ""

    def new_speed_template(self, mode: MachiningMode) -> str:
        """Return the template for a new speed while TCP, or M114, is on; empty where the mode needs none of its own."""
        name = {MachiningMode.TCP: NEW_SPEED_WITH_TCP, MachiningMode.M114: NEW_SPEED_WITH_M114}.get(mode, "")
        return name if name in self.templates else ""

    def modes(self, settings: Mapping[str, str]) -> frozenset[MachiningMode]:
        """Return the machining modes for which the control has templates."""
        return frozenset(mode for mode in MachiningMode if self.template_suffix(mode, settings))

    @property
    def vectors_exclude_angles(self) -> bool:
        """Whether an operation with tool vectors can have no rotary words, nor words for the centres of circles."""
        mixed = {ORIENT_BY_VECTOR_WORD, VECTOR_LINE_WORD}
        return TOOL_VECTOR_WORDS[0] in self.family.WORDS and not mixed & set(self.family.WORDS)

    def uses_tool_vectors(self, settings: Mapping[str, str]) -> bool:
        """Whether the tool axis is programmed as a vector under TCP."""
        return (settings.get("orientation") or self.settings.get("orientation")) == "vector"

    def turns_between_holes(self, settings: Mapping[str, str]) -> bool:
        """Whether the tool turns from hole to hole under TCP, and cycles drill along it."""
        return (settings.get(HOLES_SETTING) or self.settings.get(HOLES_SETTING, HOLES_IN_PLANES)) != HOLES_IN_PLANES

    def number_formats(self, three_axis: bool) -> dict[str, NumberFormat]:
        """Return the number formats by name, for three-axis or five-axis operations."""
        return {name: pair.three_axis if three_axis else pair.five_axis for name, pair in self.formats.items()}

    def block_words(self, primary: str, secondary: str, three_axis: bool) -> list[Word]:
        """Return the words of a motion block in their order.

        ``primary`` and ``secondary`` are the names of the machine's rotary axes.
        """
        formats = self.number_formats(three_axis)
        axes = dict.fromkeys(("primary", "primary_shortest"), primary)
        axes |= dict.fromkeys(("secondary", "secondary_shortest"), secondary)
        return [
            Word(w.name, axes.get(w.name, "") + w.letter, formats.get(w.format, _NO_NUMBER), w.modal, w.closing, w.bare)
            for w in self.words
        ]
