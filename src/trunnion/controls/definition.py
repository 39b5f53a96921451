"""The definition of a control: everything about its language that is data.

Formats, words and their order, codes, templates and settings come from TOML (``control/library`` and the ``[control]``
table of a machine); only what words cannot say is code, in the module of the control's family, which also says what
words and codes it asks for.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import TypedDict

from trunnion.controls.family_writer import HOLES_IN_PLANES, HOLES_SETTING, RADIUS_ARC_WORDS, FamilyWriter
from trunnion.controls.template import Template
from trunnion.controls.words import BlockNumbers, NumberFormat, Word
from trunnion.definitions import Table, resolve_extends
from trunnion.families import FAMILIES, load_writer
from trunnion.model.motion import MachiningMode

#: Values that templates of all families may print besides the settings; what each is stands in docs/controls.
COMMON_TEMPLATE_FIELDS = frozenset(
    {
        "primary", "secondary", "primary_word", "secondary_word", "operation", "tool", "tool_name", "tool_type",
        "tool_diameter", "tool_length", "tool_corner_radius", "intol", "outtol", "machine", "gauge_length",
        "zero_x", "zero_y", "zero_z", "time", "total_time",
        "home_x", "home_y", "home_z", "primary_home", "secondary_home",
        "plane_x", "plane_y", "plane_z", "plane_side", "plane_sign",
        "spindle_speed", "new_speed", "spindle_code", "subprogram",
    }
)  # fmt: skip

#: Templates that every definition has.
REQUIRED_TEMPLATES = (
    "program_start", "operation_start", "first_tool", "tool_change", "approach_three_axis", "operation_end_three_axis",
    "program_end",
)  # fmt: skip

#: How the templates of operations with TCP are called.
FIVE_AXIS = "five_axis"

#: Those without.
WITHOUT_TCP = "without_tcp"

#: The template of a control on which the spindle is started by blocks of its own; others have words for it.
SPINDLE_ON = "spindle_on"

#: The templates of controls on which a main program can call one subprogram an operation: the call; a subprogram's
#: beginning, where it goes on with what another has begun, and its end.
SUBPROGRAM_TEMPLATES = ("subprogram_call", "subprogram_start", "subprogram_part", "subprogram_end")

#: The word, and its code, of controls on which each position of a hole calls the cycle that was defined before.
CYCLE_CALL_WORD = "call"

#: The words of the tool axis as a vector, from tip to holder, on controls that take it in place of rotary words; and
#: the word that opens such blocks in place of ``line``, on those that have one: they want X, Y and Z in each of them.
TOOL_VECTOR_WORDS = ("axis_x", "axis_y", "axis_z")
VECTOR_LINE_WORD = "vector_line"

#: The words of the surface's normal where the tool touches it, in blocks that open with ``VECTOR_LINE_WORD``.
SURFACE_NORMAL_WORDS = ("surface_x", "surface_y", "surface_z")

#: Words that say whether an orientation is gone to by its vector or by the rotary axes, on controls that can have both.
ORIENT_BY_VECTOR_WORD, ORIENT_BY_AXES_WORD = "by_vector", "by_axes"

#: Words of a motion block that all families have.
AXIS_WORDS = ("X", "Y", "Z", "primary", "secondary")

#: The format of words that print no number.
_NO_NUMBER = NumberFormat(0)

#: Nobody knows what F means where nobody holds the tip and rotary axes turn: then the control has no words for it.
UNKNOWN_FEED = "unknown"

#: How feeds can be said there: as the time of each block; as an F that counts the way of all axes together, a degree as
#: a millimetre; or as one that counts the way of the slides alone, or the degrees where these rest.
FEEDS_WITHOUT_TCP = ("inverse_time", "all_axes", "slides", UNKNOWN_FEED)

#: From where a control goes to the next hole: the height of the last retract (whatever the next one needs above it is
#: said before), or the retract height of the next hole itself; or it draws back to where the tool stood when the cycle
#: began, so that this has to be the retract height, and its G80 leaves no motion word in force.
HOLE_APPROACH_HEIGHTS = ("above", "retract", "initial")

PHASES = ("rapid", "approach", "engage", "cut", "stepover", "retract", "departure", "traverse")
COOLANTS = ("OFF", "ON", "FLOOD", "MIST", "TAP", "THRU", "AIR")
TOOL_TYPES = ("MILL", "BALL", "TCUTTER", "BARREL", "DRILL", "UNKNOWN")


@dataclass(frozen=True, slots=True)
class SubprogramNaming:
    """How subprograms are called on a control.

    extension  of their files
    capitals   letters of names are capitals, else small ones
    max_length  characters of a name, at most
    reserved_prefixes  names do not begin so: the control has such programs of its own
    first_number  names are numbers of four digits from here on, whatever operations are called; None: they are not
    prefix    stands before a name in that of its file
    """

    extension: str
    capitals: bool
    max_length: int
    reserved_prefixes: tuple[str, ...] = ()
    first_number: int | None = None
    prefix: str = ""


@dataclass(frozen=True, slots=True)
class FormatPair:
    """A number format as five-axis operations use it, and as three-axis operations do."""

    five_axis: NumberFormat
    three_axis: NumberFormat


@dataclass(frozen=True, slots=True)
class WordDefinition:
    """A word of a motion block; for the rotary axes, which the machine names, ``letter`` is what follows the name.

    A ``bare`` word is letters without a number, and has no format.
    """

    name: str
    letter: str
    format: str
    modal: bool
    closing: str = ""
    bare: bool = False


@dataclass(frozen=True, slots=True)
class Control:
    """A control's language, read and checked.

    longest_line      bytes of a line, at most
    continued         what ends a line that goes on in the next, in the same block; empty: there is none
    by_method         settings that follow from the method's name where nobody gave them: setting -> (part of the name,
                      value), the first that is found in it
    only_arcs_about_z      only arcs about Z can be said; others become lines
    arcs_by_radius    circles are told by their radius where that is safe, and not by their centre
    plane_along_machine  X of a tilted plane is that of the machine once it has turned, unless the CL file has its own
    helices           it can be told circles that rise, and more than one turn
    multi_turn_arcs             it can be told circles and helices of more than one turn
    tcp               it can hold the tip of the tool while rotary axes turn
    feed_without_tcp  one of ``FEEDS_WITHOUT_TCP``
    shorter_way       endless axes go the shorter way, so that none goes past the end of the turn that it displays
    own_blocks        spindle, coolant and radius compensation stand in blocks of their own
    first_lines       of a program before which nothing may stand, be it a comment
    level_approach    where the tool has been drawn back, it goes to its place in X and Y first, then in Z
    plane_from_pose   a tilted plane is the one on which the tool stands: its zero is the work offset's, its axes are
                      those of the tool, and no words say its angles
    subprograms       how the programs are called that a main program calls; None: it can call none
    holes_from        height at which the control goes from hole to hole: one of ``HOLE_APPROACH_HEIGHTS``
    """

    name: str
    family: FamilyWriter
    extension: str
    longest_line: int
    continued: str
    block_numbers: BlockNumbers
    formats: Mapping[str, FormatPair]
    words: tuple[WordDefinition, ...]
    codes: Mapping[str, int]
    coolant: Mapping[str, int]
    initial_modal_state: Mapping[str, int]
    settings: Mapping[str, str]
    method_defaults: Mapping[str, tuple[tuple[str, str], ...]]
    tool_types: Mapping[str, str]
    phases: Mapping[str, str]
    chord_tolerance: float
    only_arcs_about_z: bool
    arcs_by_radius: bool
    plane_x_from_machine: bool
    helices: bool
    multi_turn_arcs: bool
    tcp: bool
    feed_without_tcp: str
    shorter_way: bool
    own_blocks: bool
    first_lines: int
    level_approach: bool
    plane_from_pose: bool
    holes_from: str
    subprograms: SubprogramNaming | None
    templates: Mapping[str, Template] = field(repr=False)

    def default_for_method(self, setting: str, method: str) -> str | None:
        """What a setting is for operations of a method where nobody gave it; None where nothing says so."""
        rules = self.method_defaults.get(setting, ())
        return next((value for part, value in rules if part.upper() in method.upper()), None)

    def template_suffix(self, mode: MachiningMode, settings: Mapping[str, str]) -> str:
        """What the templates of operations made in a manner are called; empty where the definition has none."""
        plane = settings.get("plane") or self.settings.get("plane") or next(iter(self.family.PLANE_COMMANDS), "")
        names = {
            MachiningMode.THREE_AXIS: "three_axis",
            MachiningMode.TILTED: plane,
            MachiningMode.WITHOUT_TCP: WITHOUT_TCP,
        }
        name = names.get(mode, FIVE_AXIS if self.tcp else "")
        if name == WITHOUT_TCP and self.feed_without_tcp == UNKNOWN_FEED:
            return ""
        return name if f"approach_{name}" in self.templates else ""

    @property
    def vectors_exclude_angles(self) -> bool:
        """Whether an operation that is told by vectors has no rotary words at all, nor words for centres of circles."""
        mixes = {ORIENT_BY_VECTOR_WORD, VECTOR_LINE_WORD}
        return TOOL_VECTOR_WORDS[0] in self.family.WORDS and not mixes & set(self.family.WORDS)

    def uses_tool_vectors(self, settings: Mapping[str, str]) -> bool:
        """Whether orientations are said by vectors under TCP."""
        return (settings.get("orientation") or self.settings.get("orientation")) == "vector"

    def modes(self, settings: Mapping[str, str]) -> frozenset[MachiningMode]:
        """In which manners operations can be said."""
        return frozenset(mode for mode in MachiningMode if self.template_suffix(mode, settings))

    def turns_between_holes(self, settings: Mapping[str, str]) -> bool:
        """Whether the tool turns from hole to hole under TCP, and cycles drill along it."""
        return (settings.get(HOLES_SETTING) or self.settings.get(HOLES_SETTING, HOLES_IN_PLANES)) != HOLES_IN_PLANES

    def number_formats(self, three_axis: bool) -> dict[str, NumberFormat]:
        """The number formats by name, for one kind of operation."""
        return {name: pair.three_axis if three_axis else pair.five_axis for name, pair in self.formats.items()}

    def block_words(self, primary: str, secondary: str, three_axis: bool) -> list[Word]:
        """The words of a motion block in their order; ``primary`` and ``secondary`` are the rotary axes' letters."""
        formats = self.number_formats(three_axis)
        axes = dict.fromkeys(("primary", "primary_shortest"), primary)
        axes |= dict.fromkeys(("secondary", "secondary_shortest"), secondary)
        return [
            Word(w.name, axes.get(w.name, "") + w.letter, formats.get(w.format, _NO_NUMBER), w.modal, w.closing, w.bare)
            for w in self.words
        ]


class _ArcSettings(TypedDict):
    chord_tolerance: float
    only_arcs_about_z: bool
    arcs_by_radius: bool
    helices: bool
    multi_turn_arcs: bool


def library() -> Traversable:
    """The folder of shipped control definitions."""
    return files("trunnion.controls").joinpath("library")


def load_control(own: Table) -> Control:
    """Read a control's definition.

    Parameters
    ----------
    own
        The ``[control]`` table of a machine; what its ``extends`` names in the library of controls is merged under it.

    Raises
    ------
    InputError
        With every mistake, each at its file and line.
    """
    table = resolve_extends(own, library())
    key = table.text("family")
    if key not in FAMILIES:
        known = ", ".join(FAMILIES)
        table.add_problem("family", f"is {key!r}, for which no programs can be written yet", f"write one of {known}")
        table.raise_problems()
    table.mark_read("reading")  # for whoever reads programs
    family: FamilyWriter = load_writer(key)
    words = (*AXIS_WORDS, *family.WORDS)
    formats = {}
    for entry in table.tables("format"):
        name = entry.text("name")
        formats[name] = _read_format(entry)
    control = Control(
        name=table.text("name"),
        family=family,
        extension=table.text("extension"),
        longest_line=table.integer("longest_line", 1 << 20, at_least=40, at_most=1 << 20),
        continued=table.text("continued", ""),
        block_numbers=_read_block_numbers(table.table("block_numbers")),
        formats=formats,
        words=tuple(_read_word(entry, formats, words) for entry in table.tables("word")),
        codes=_read_integers(table.table("codes"), family.CODES),
        coolant=_read_integers(table.table("coolant"), COOLANTS, complete=False),
        initial_modal_state=_read_integers(table.table("in_force"), words, complete=False),
        settings=_read_settings(table.table("settings"), family),
        method_defaults=_method_defaults(table.tables("by_method"), table.table("settings")),
        tool_types=_read_texts(table.table("tool_types"), TOOL_TYPES),
        phases=_read_texts(table.table("phases"), PHASES),
        **_read_arcs(table.table("arcs"), words),
        plane_x_from_machine=table.text("plane_x", "program", one_of=("program", "machine")) == "machine",
        tcp=table.flag("tcp", True),
        feed_without_tcp=table.text("feed_without_tcp", "inverse_time", one_of=FEEDS_WITHOUT_TCP),
        shorter_way=table.flag("shorter_way", False),
        own_blocks=table.flag("own_blocks", False),
        first_lines=table.integer("first_lines", 0, at_least=0, at_most=9),
        level_approach=table.flag("level_approach", False),
        plane_from_pose=table.flag("plane_from_pose", False),
        holes_from=table.text("holes_from", "above", one_of=HOLE_APPROACH_HEIGHTS),
        subprograms=_read_subprogram_naming(table.table("subprograms")) if "subprograms" in table else None,
        templates=_read_templates(
            table.table("templates"), family, table.flag("plane_from_pose", False), "subprograms" in table
        ),
    )
    for lacking in dict.fromkeys(name for name in words if name not in {word.name for word in control.words}):
        table.add_problem("word", f"has no entry {lacking!r}, which programs of this family need", "write it")
    _check_templates(table.table("templates"), control)
    table.report_unread_keys()
    table.raise_problems()
    return control


def _read_format(entry: Table) -> FormatPair:
    decimals = entry.integer("decimals", at_least=0, at_most=9)
    three = entry.integer("decimals_three_axis", decimals, at_least=0, at_most=9)
    common = {
        "point": entry.flag("point", True),
        "leading_zero": entry.flag("leading_zero", False),
        "trailing_zeros": entry.flag("trailing_zeros", False),
        "plus": entry.flag("plus", False),
    }
    zero = entry.text("zero", "")
    least, greatest = entry.number("least", -99999999.0), entry.number("greatest", 99999999.0)
    if len(zero) > 8:
        entry.add_problem("zero", f"is {zero!r}", "write at most 8 characters")
        zero = ""
    entry.report_unread_keys()
    pair = [NumberFormat(n, zero=zero, least=least, greatest=greatest, **common) for n in (decimals, three)]
    return FormatPair(*pair)


def _read_word(entry: Table, formats: Mapping[str, FormatPair], words: Sequence[str]) -> WordDefinition:
    name = entry.text("name", one_of=words)
    rotary = name.startswith(("primary", "secondary"))
    letter, closing = entry.text("letter", "") if rotary else entry.text("letter"), entry.text("closing", "")
    most = 4 if rotary else 8
    if len(letter.encode()) > most:
        entry.add_problem("letter", f"is {letter!r}", f"write at most {most} characters")
        letter = letter[:1]
    if len(closing.encode()) > 1:
        entry.add_problem("closing", f"is {closing!r}", "write one character")
        closing = ""
    bare = entry.flag("bare", False)
    form = "" if bare else entry.text("format", one_of=tuple(formats))
    rule = WordDefinition(name, letter, form, not bare and entry.flag("modal", True), closing, bare)
    entry.report_unread_keys()
    return rule


def _read_block_numbers(table: Table) -> BlockNumbers:
    letter = table.text("letter", "N")
    numbers = BlockNumbers(
        letter,
        table.integer("start", 10, at_least=0),
        table.integer("step", 10, at_least=1),
        table.integer("highest", 99999999, at_least=1, at_most=99999999),
        table.flag("numbered", bool(letter)),
        table.text("unnumbered", ""),
    )
    table.report_unread_keys()
    return numbers


def _read_integers(table: Table, names: tuple[str, ...], complete: bool = True) -> dict[str, int]:
    found = {name: table.integer(name, at_least=0) for name in names if complete or name in table}
    table.report_unread_keys()
    return found


def _read_texts(table: Table, names: tuple[str, ...]) -> dict[str, str]:
    found = {name: table.text(name, "") for name in names}
    table.report_unread_keys()
    return found


def _read_settings(table: Table, family: FamilyWriter) -> dict[str, str]:
    found = {name: table.text(name) for name in list(table.keys())}
    for name, choices in family.SETTING_CHOICES.items():
        if found.setdefault(name, choices[0]) not in choices:
            table.add_problem(name, f"is {found[name]!r}", f"write one of {', '.join(choices)}")
    for name, cure in family.validate_settings(found):
        table.add_problem(name, f"is {found[name]!r}", cure)
    table.report_unread_keys()
    return found


def _method_defaults(entries: Sequence[Table], settings: Table) -> dict[str, tuple[tuple[str, str], ...]]:
    found: dict[str, tuple[tuple[str, str], ...]] = {}
    for entry in entries:
        name = entry.text("setting", one_of=settings.keys())
        found[name] = (*found.get(name, ()), (entry.text("method"), entry.text("value")))
        entry.report_unread_keys()
    return found


def _read_arcs(table: Table, words: Sequence[str]) -> _ArcSettings:
    tolerance = table.number("chord_tolerance", 0.001, above=0.0)
    about, helices = table.text("about", "XYZ", one_of=("XYZ", "Z")), table.flag("helices", True)
    multi_turn_arcs, by_radius = (
        table.flag("turns", True),
        table.text("by", "centre", one_of=("centre", "radius")) == "radius",
    )
    if by_radius and not set(RADIUS_ARC_WORDS) <= set(words):
        table.add_problem("by", "is 'radius', and the control's family has no words for that", "leave it out")
    table.report_unread_keys()
    return {
        "chord_tolerance": tolerance,
        "only_arcs_about_z": about == "Z",
        "arcs_by_radius": by_radius,
        "helices": helices,
        "multi_turn_arcs": multi_turn_arcs,
    }


def _read_subprogram_naming(table: Table) -> SubprogramNaming:
    letters = table.text("letters", "capital", one_of=("capital", "small"))
    first = table.integer("first_number", 0, at_least=0, at_most=9999)
    naming = SubprogramNaming(
        extension=table.text("extension"),
        capitals=letters == "capital",
        max_length=4 if first else table.integer("longest_name", at_least=8),
        reserved_prefixes=table.texts("reserved", ()),
        first_number=first or None,
        prefix=table.text("before_name", ""),
    )
    table.report_unread_keys()
    return naming


def _read_templates(
    table: Table, family: FamilyWriter, plane_from_pose: bool, subprograms: bool
) -> dict[str, Template]:
    """Those that every definition has, those of subprograms, and those of the kinds of operations that it has any for.

    The way from home to the next axis of an operation with holes is one that a definition need not have.

    Where a plane is taken from the rotary position, the tool may have to be drawn back before the next one.
    """
    found = {}
    of_planes = ("approach", "plane_on", *(("draw_back",) if plane_from_pose else ()), "next_plane", "operation_end")
    kinds = [_template_names(kind, ("approach", "operation_end")) for kind in (FIVE_AXIS, WITHOUT_TCP)]
    kinds += [(f"next_axis_{kind}",) for kind in (FIVE_AXIS, WITHOUT_TCP)]
    kinds += [_template_names(plane, of_planes) for plane in family.PLANE_COMMANDS]
    wanted = [name for names in ((SPINDLE_ON,), *kinds) if any(name in table for name in names) for name in names]
    for name in (*REQUIRED_TEMPLATES, *(SUBPROGRAM_TEMPLATES if subprograms else ()), *wanted):
        text = table.text(name)
        file, line = table.location(name)
        found[name] = Template(name, tuple(text.strip("\n").split("\n")) if text.strip() else (), file, line)
    table.report_unread_keys()
    return found


def _template_names(kind: str, parts: Sequence[str]) -> tuple[str, ...]:
    """The templates of a kind of operation that not every definition has."""
    return tuple(f"{part}_{kind}" for part in parts)


def _check_templates(templates: Table, control: Control) -> None:
    """A template that asks for what does not exist is a mistake of the definition, not of the run."""
    known = COMMON_TEMPLATE_FIELDS | control.family.TEMPLATE_FIELDS | control.settings.keys()
    call = control.templates.get(SUBPROGRAM_TEMPLATES[0])
    if call is not None and "subprogram" not in {name for name, _ in call.fields()}:
        templates.add_problem(call.name, "does not say which subprogram it calls", "write {subprogram} in it")
    for template in control.templates.values():
        for name, form in sorted(template.fields()):
            if name not in known:
                templates.add_problem(
                    template.name,
                    f"asks for {{{name}}}, which nobody sets",
                    f"write one of {', '.join(sorted(known))}, or add it to [control.settings]",
                )
            if form and form not in control.formats:
                templates.add_problem(
                    template.name,
                    f"prints {{{name}:{form}}}, but there is no format {form!r}",
                    f"write one of {', '.join(sorted(control.formats))}",
                )
