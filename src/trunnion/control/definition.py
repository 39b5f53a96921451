"""The definition of a control: everything about its language that is data.

Formats, words and their order, codes, templates and settings come from TOML (``control/library`` and the ``[control]``
table of a machine); only what words cannot say is code, in the module of the control's family.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from importlib.resources.abc import Traversable

from trunnion.control.template import Template
from trunnion.definition import Table, extended
from trunnion.nc import BlockNumbers, NumberFormat, Word

#: Families of controls whose programs can be written.
FAMILIES = ("sinumerik_840d",)

#: Values that templates may print besides the settings; what each is stands in docs/controls/sinumerik.md.
FIELDS = frozenset(
    {
        "primary", "secondary", "primary_word", "secondary_word", "operation", "tool", "tool_name", "tool_type",
        "tool_diameter", "tool_length", "tool_corner_radius", "intol", "outtol", "machine",
        "plane_x", "plane_y", "plane_z", "plane_first", "plane_second", "plane_third", "plane_mode", "plane_side",
    }
)  # fmt: skip

TEMPLATES = (
    "program_start", "operation_start", "first_tool", "tool_change", "approach_five_axis", "approach_three_axis",
    "operation_end_five_axis", "operation_end_three_axis", "program_end",
    "approach_cycle800", "plane_on_cycle800", "next_plane_cycle800", "operation_end_cycle800",
    "approach_frames", "plane_on_frames", "next_plane_frames", "operation_end_frames",
)  # fmt: skip

#: mm; NaN is no less.
_FARTHEST_LIFT = 100.0

#: What some settings may say: the way to say a tilted plane, and the axes of CYCLE800's three turns.
CHOICES = {"plane": ("cycle800", "frames"), "swivel_mode": ("57", "27", "39", "45", "30", "54")}

CODES = (
    "rapid", "linear", "arc_clockwise", "arc_counterclockwise", "plane_xy", "plane_zx", "plane_yz",
    "feed_per_minute", "feed_per_revolution", "comp_off", "comp_left", "comp_right",
    "spindle_clockwise", "spindle_counterclockwise", "spindle_off", "stop", "optional_stop",
)  # fmt: skip

WORDS = (
    "cutter_comp", "feed_mode", "plane", "motion", "X", "Y", "Z", "primary", "secondary", "I", "J", "K", "turns",
    "speed", "edge", "spindle", "coolant", "feed",
)  # fmt: skip

PHASES = ("rapid", "approach", "engage", "cut", "stepover", "retract", "departure", "traverse")
COOLANTS = ("OFF", "ON", "FLOOD", "MIST", "TAP", "THRU", "AIR")
TOOL_TYPES = ("MILL", "BALL", "TCUTTER", "BARREL", "DRILL", "UNKNOWN")


@dataclass(frozen=True, slots=True)
class Format:
    """A number format as five-axis operations use it, and as three-axis operations do."""

    five_axis: NumberFormat
    three_axis: NumberFormat


@dataclass(frozen=True, slots=True)
class WordRule:
    """A word of a motion block; ``letter`` is empty for the rotary axes, which the machine names."""

    name: str
    letter: str
    format: str
    modal: bool


@dataclass(frozen=True, slots=True)
class Control:
    """A control's language, read and checked."""

    name: str
    family: str
    extension: str
    numbers: BlockNumbers
    formats: Mapping[str, Format]
    words: tuple[WordRule, ...]
    codes: Mapping[str, int]
    coolant: Mapping[str, int]
    in_force: Mapping[str, int]
    settings: Mapping[str, str]
    kinds: tuple[tuple[str, str], ...]
    tool_types: Mapping[str, str]
    phases: Mapping[str, str]
    chord_tolerance: float
    templates: Mapping[str, Template] = field(repr=False)

    def number_formats(self, three_axis: bool) -> dict[str, NumberFormat]:
        """The number formats by name, for one kind of operation."""
        return {name: pair.three_axis if three_axis else pair.five_axis for name, pair in self.formats.items()}

    def block_words(self, primary: str, secondary: str, three_axis: bool) -> list[Word]:
        """The words of a motion block in their order; ``primary`` and ``secondary`` are the rotary axes' letters."""
        formats = self.number_formats(three_axis)
        letters = {"primary": primary, "secondary": secondary}
        return [Word(w.name, letters.get(w.name, w.letter), formats[w.format], w.modal) for w in self.words]


def library() -> Traversable:
    """The folder of shipped control definitions."""
    return files("trunnion.control").joinpath("library")


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
    table = extended(own, library())
    family = table.text("family")
    if family not in FAMILIES:
        known = ", ".join(FAMILIES)
        table.problem("family", f"is {family!r}, for which no programs can be written yet", f"write one of {known}")
        table.check()
    table.skip("reading")  # for whoever reads programs
    formats = {}
    for entry in table.tables("format"):
        name = entry.text("name")
        formats[name] = _format(entry)
    control = Control(
        name=table.text("name"),
        family=family,
        extension=table.text("extension"),
        numbers=_numbers(table.table("block_numbers")),
        formats=formats,
        words=tuple(_word(entry, formats) for entry in table.tables("word")),
        codes=_integers(table.table("codes"), CODES),
        coolant=_integers(table.table("coolant"), COOLANTS, complete=False),
        in_force=_integers(table.table("in_force"), WORDS, complete=False),
        settings=_settings(table.table("settings")),
        kinds=tuple(_kind(entry) for entry in table.tables("cycle832")),
        tool_types=_texts(table.table("tool_types"), TOOL_TYPES),
        phases=_texts(table.table("phases"), PHASES),
        chord_tolerance=_chord_tolerance(table.table("arcs")),
        templates=_templates(table.table("templates")),
    )
    _check_templates(table.table("templates"), control)
    table.finish()
    table.check()
    return control


def _format(entry: Table) -> Format:
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
        entry.problem("zero", f"is {zero!r}", "write at most 8 characters")
        zero = ""
    entry.finish()
    pair = [NumberFormat(n, zero=zero, least=least, greatest=greatest, **common) for n in (decimals, three)]
    return Format(*pair)


def _word(entry: Table, formats: Mapping[str, Format]) -> WordRule:
    name = entry.text("name", one_of=WORDS)
    rotary = name in ("primary", "secondary")
    letter = entry.text("letter", "") if rotary else entry.text("letter")
    if len(letter.encode()) > 8:
        entry.problem("letter", f"is {letter!r}", "write at most 8 characters")
        letter = letter[:1]
    rule = WordRule(name, letter, entry.text("format", one_of=tuple(formats)), entry.flag("modal", True))
    entry.finish()
    return rule


def _numbers(table: Table) -> BlockNumbers:
    numbers = BlockNumbers(
        table.text("letter", "N"),
        table.integer("start", 10, at_least=0),
        table.integer("step", 10, at_least=1),
        table.integer("highest", 99999999, at_least=1, at_most=99999999),
    )
    table.finish()
    return numbers


def _integers(table: Table, names: tuple[str, ...], complete: bool = True) -> dict[str, int]:
    found = {name: table.integer(name, at_least=0) for name in names if complete or name in table}
    table.finish()
    return found


def _texts(table: Table, names: tuple[str, ...]) -> dict[str, str]:
    found = {name: table.text(name, "") for name in names}
    table.finish()
    return found


def _settings(table: Table) -> dict[str, str]:
    found = {name: table.text(name) for name in list(table.keys())}
    for name, choices in CHOICES.items():
        if found.setdefault(name, choices[0]) not in choices:
            table.problem(name, f"is {found[name]!r}", f"write one of {', '.join(choices)}")
    if not is_lift(found.get("bore_lift", "")):
        table.problem("bore_lift", f"is {found['bore_lift']!r}", "write millimetres, or nothing")
    table.finish()
    return found


def is_lift(text: str) -> bool:
    """Whether the setting ``bore_lift`` is empty, or millimetres that a tool could lift off in a bore."""
    try:
        return not text or abs(float(text)) < _FARTHEST_LIFT
    except ValueError:
        return False


def _kind(entry: Table) -> tuple[str, str]:
    kind = entry.text("method"), entry.text("mode")
    entry.finish()
    return kind


def _chord_tolerance(table: Table) -> float:
    tolerance = table.number("chord_tolerance", 0.001, above=0.0)
    table.finish()
    return tolerance


def _templates(table: Table) -> dict[str, Template]:
    found = {}
    for name in TEMPLATES:
        text = table.text(name)
        file, line = table.origin(name)
        found[name] = Template(name, tuple(text.strip("\n").split("\n")) if text.strip() else (), file, line)
    table.finish()
    return found


def _check_templates(templates: Table, control: Control) -> None:
    """A template that asks for what does not exist is a mistake of the definition, not of the run."""
    known = FIELDS | control.settings.keys()
    for template in control.templates.values():
        for name, form in sorted(template.fields()):
            if name not in known:
                templates.problem(
                    template.name,
                    f"asks for {{{name}}}, which nobody sets",
                    f"write one of {', '.join(sorted(known))}, or add it to [control.settings]",
                )
            if form and form not in control.formats:
                templates.problem(
                    template.name,
                    f"prints {{{name}:{form}}}, but there is no format {form!r}",
                    f"write one of {', '.join(sorted(control.formats))}",
                )
