"""From the ``[control]`` table of a definition to a ``Control``, with every mistake reported at once."""

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Final

from trunnion.controls.consistency import check_formats, check_setting_names, check_templates
from trunnion.controls.definition import MM_PER_INCH, ArcRules, Control, FormatPair, SubprogramNaming, WordDefinition
from trunnion.controls.family_writer import FamilyWriter
from trunnion.controls.settings_reading import (
    check_settings,
    read_method_defaults,
    read_rules,
    read_setting_meanings,
    read_settings,
)
from trunnion.controls.template_reading import read_templates
from trunnion.controls.vocabulary import (
    AXIS_WORDS,
    COOLANTS,
    FEEDS_WITHOUT_TCP,
    HOLE_APPROACH_HEIGHTS,
    INCH,
    MM,
    NO_LIMIT,
    PHASES,
    PROJECTED_ANGLES,
    PROJECTED_CHOICES,
    RADIUS_ARC_WORDS,
    TOOL_TYPES,
)
from trunnion.controls.words import BlockNumbers, NumberFormat
from trunnion.definitions import LocatedValue, Table, TextForm, definition_names, resolve_extends
from trunnion.definitions.duplicate_keys import report_duplicates, statement_form
from trunnion.errors import InputError
from trunnion.families import FAMILIES, load_writer
from trunnion.messages import Wording, phrase
from trunnion.model.axis_tolerance import AxisTolerance

#: What may stand for 0: nothing, which is as other numbers, or a text that a control reads as 0.
_ZERO: Final = r"([+-]?(0{1,2}(\.0{0,4})?|\.0{1,4}))?"

#: M words that no coolant may have: those of ``codes``, and what ends a program or changes the tool.
_OTHER_M_WORDS: Final = (
    "spindle_clockwise",
    "spindle_counterclockwise",
    "spindle_off",
    "stop",
    "optional_stop",
    "call",
)
#: Coolants of which each has an M word of its own.
_MEDIA: Final = ("FLOOD", "MIST", "THRU", "AIR")
_M_OF_PROGRAMS: Final = {2: "the end of a program", 30: "the end of a program", 6: "a tool change"}


def control_library() -> Traversable:
    """Return the folder of the shipped control definitions."""
    return files("trunnion.controls").joinpath("library")


def shipped_controls() -> list[str]:
    """Return the names of the shipped controls, sorted."""
    return definition_names(control_library())


@lru_cache(maxsize=16)  # one process posts many files on a machine
def load_control(own: Table) -> Control:
    """Read the definition of a control.

    own  the ``[control]`` table of a machine. The definition that its ``extends`` names is merged under it

    Raises ``InputError`` with every mistake, each at its file and line.
    """
    table = resolve_extends(own, control_library())
    family = _load_family(table)
    words = (*AXIS_WORDS, *family.WORDS)
    formats = {entry.text("name"): _read_format(entry) for entry in table.tables("format")}
    templates, settings = table.table("templates"), table.table("settings")
    plane_from_pose, units = table.flag("plane_from_pose", False), table.table("units")
    control = Control(
        name=table.text("name"),
        description=table.text("description", ""),
        family=family,
        family_name=table.text("family"),
        extension=_read_extension(table),
        longest_line=table.integer("longest_line", 1 << 20, at_least=40, at_most=1 << 20),
        continued=table.text("continued", ""),
        block_numbers=_read_block_numbers(table.table("block_numbers"), family),
        formats=formats,
        words=tuple(_read_word(entry, formats, words) for entry in table.tables("word")),
        codes=(codes := _read_integers(table.table("codes"), family.CODES)),
        coolant=_read_coolant(table.table("coolant"), codes),
        initial_modal_state=_read_integers(table.table("in_force"), words, complete=False),
        statements=_read_statements(table.table("statements")),
        setting_rules=(rules := read_rules(table.table("setting_rules"), settings, family)),
        settings=read_settings(settings, rules, family),
        setting_meanings=read_setting_meanings(table.table("setting_meanings"), settings, family),
        method_defaults=read_method_defaults(table.tables("by_method"), settings, rules),
        tool_types=_read_texts(table.table("tool_types"), TOOL_TYPES),
        phases=_read_texts(table.table("phases"), PHASES),
        arcs=_read_arc_rules(table.table("arcs"), words),
        plane_x_from_machine=table.text("plane_x", "program", one_of=("program", "machine")) == "machine",
        tcp=table.flag("tcp", True),
        feed_without_tcp=table.text("feed_without_tcp", "inverse_time", one_of=FEEDS_WITHOUT_TCP),
        shorter_way=table.flag("shorter_way", False),
        own_blocks=table.flag("own_blocks", False),
        blocks_in_compensation=table.integer("blocks_in_compensation", 1, at_least=0, at_most=NO_LIMIT),
        stops_in_compensation=table.flag("stops_in_compensation", False),
        radius_as_diameter=table.text("radius_as_diameter", ""),
        threads_stop_spindle=table.flag("threads_stop_spindle", False),
        first_lines=table.integer("first_lines", 0, at_least=0, at_most=9),
        axis_tolerance=_read_axis_tolerance(table.table("between_points")),
        level_approach=table.flag("level_approach", False),
        plane_from_pose=plane_from_pose,
        projected_angles=table.text(PROJECTED_ANGLES, PROJECTED_CHOICES[0], one_of=PROJECTED_CHOICES),
        rapid_into_planes=table.flag("rapid_into_planes", False),
        holes_from=table.text("holes_from", "above", one_of=HOLE_APPROACH_HEIGHTS),
        subprograms=_read_subprogram_naming(table.table("subprograms")) if "subprograms" in table else None,
        templates=read_templates(templates, family, plane_from_pose, subprograms="subprograms" in table),
        length_settings=units.texts("settings", ()),
        unit_words=_read_unit_words(units),
    )
    defined = {word.name for word in control.words}
    for missing in dict.fromkeys(name for name in words if name not in defined):
        table.add_problem("word", Wording("DEF530", "no_entry_programs", missing=repr(missing)))
    check_templates(templates, control)
    check_formats(table.tables("format"), control)
    check_setting_names(settings, control)
    check_settings(settings, table.tables("by_method"), control)
    units.report_unread_keys()
    table.report_unread_keys()
    table.raise_problems()
    return control


def _load_family(table: Table) -> FamilyWriter:
    key = table.text("family", one_of=tuple(FAMILIES))
    if not key:
        table.raise_problems()
    table.mark_read("reading", "known")  # only for the readers of programs
    family: FamilyWriter = load_writer(key)
    return family


def _read_format(entry: Table) -> FormatPair:
    decimals = entry.integer("decimals", at_least=0, at_most=9)
    decimals_three_axis = entry.integer("decimals_three_axis", decimals, at_least=0, at_most=9)
    common = {
        "point": entry.flag("point", True),
        "leading_zero": entry.flag("leading_zero", False),
        "trailing_zeros": entry.flag("trailing_zeros", False),
        "plus": entry.flag("plus", False),
    }
    zero = entry.text("zero", "", written=TextForm(phrase("zero_of_control"), _ZERO))
    least, greatest = entry.number("least", -99999999.0), entry.number("greatest", 99999999.0)
    pair = [
        NumberFormat(n, zero=zero, least=least, greatest=greatest, **common) for n in (decimals, decimals_three_axis)
    ]
    inch = _read_inch_format(entry.table("inch"), pair) if "inch" in entry else None
    entry.report_unread_keys()
    return FormatPair(pair[0], pair[1], inch)


def _read_inch_format(entry: Table, pair: Sequence[NumberFormat]) -> FormatPair:
    """Return the formats of lengths in inches: limits as they are printed, ``part`` the inches of a printed unit."""
    decimals = entry.integer("decimals", at_least=0, at_most=9)
    decimals_three_axis = entry.integer("decimals_three_axis", decimals, at_least=0, at_most=9)
    unit = MM_PER_INCH * entry.number("part", 1.0, above=0.0, at_most=1.0)
    least, greatest = entry.number("least", pair[0].least / unit), entry.number("greatest", pair[0].greatest / unit)
    entry.report_unread_keys()
    five_axis, three_axis = (
        replace(number_format, decimals=n, least=least * unit, greatest=greatest * unit, unit=unit)
        for number_format, n in zip(pair, (decimals, decimals_three_axis), strict=True)
    )
    return FormatPair(five_axis, three_axis)


def _read_unit_words(table: Table) -> dict[str, str]:
    found = {MM: table.text(MM)} if table.keys() else {}
    return found | {INCH: table.text(INCH)} if INCH in table else found


def _read_word(entry: Table, formats: Mapping[str, FormatPair], words: Sequence[str]) -> WordDefinition:
    name = entry.text("name", one_of=words)
    rotary = name.startswith(("primary", "secondary"))
    letter = entry.text("letter", "") if rotary else entry.text("letter")
    closing = entry.text("closing", "", written=TextForm(phrase("one_character"), "[ -~]?"))
    most = 4 if rotary else 8
    if len(letter.encode()) > most:
        entry.add_problem("letter", Wording("DEF530", "is", letter=repr(letter), most=most))
        letter = letter[:1]
    bare = entry.flag("bare", False)
    number_format = "" if bare else entry.text("format", one_of=tuple(formats))
    word = WordDefinition(name, letter, number_format, not bare and entry.flag("modal", True), closing, bare)
    entry.report_unread_keys()
    return word


def _read_extension(table: Table) -> str:
    extension = table.text("extension")
    if not re.fullmatch(r"\.[\w.+-]*\w", extension):
        table.add_problem("extension", Wording("DEF330", "no_extension", extension=repr(extension)))
    return extension


def _read_block_numbers(table: Table, family: FamilyWriter) -> BlockNumbers:
    letter = table.text("letter", "N", one_of=family.BLOCK_NUMBER_LETTERS)
    numbers = BlockNumbers(
        letter,
        table.integer("start", 10, at_least=0),
        table.integer("step", 10, at_least=1),
        table.integer("highest", 99999999, at_least=1, at_most=99999999),
        table.flag("numbered", bool(letter)),
        table.text("unnumbered", ""),
        table.integer("every", 1, at_least=1),
        table.text("at", "blocks", one_of=("blocks", "operations")) == "operations",
    )
    for key in ("every", "at"):
        if not letter and key in table:
            table.add_problem(key, Wording("DEF330", "given_numbers_without"))
    if numbers.numbered and not letter and len(family.BLOCK_NUMBER_LETTERS) > 1:
        table.add_problem("numbered", Wording("DEF330", "true_numbers_without"))
    if numbers.highest < numbers.start:
        table.add_problem(
            "highest", Wording("DEF330", "but_numbers_start", highest=numbers.highest, start=numbers.start)
        )
    if numbers.numbered:
        _check_numbers(table, numbers, family)
    table.report_unread_keys()
    return numbers


def _check_numbers(table: Table, numbers: BlockNumbers, family: FamilyWriter) -> None:
    """Report numbers that the control does not take, or not in that place."""
    if numbers.highest > family.HIGHEST_BLOCK_NUMBER:
        table.add_problem(
            "highest",
            Wording(
                "DEF330", "control_takes_no", highest=numbers.highest, highest_block_number=family.HIGHEST_BLOCK_NUMBER
            ),
        )
    for key, found, only in (("start", numbers.start, 0), ("step", numbers.step, 1)):
        if family.BLOCK_NUMBER_LETTERS == ("",) and found != only:
            table.add_problem(key, Wording("DEF330", "control_counts_all", found=found, only=only))
    if missing := "".join(sign for sign in family.NEVER_NUMBERED if sign not in numbers.unnumbered):
        table.add_problem(
            "unnumbered", Wording("DEF330", "lacks_lines_begin", missing=missing, never_numbered=family.NEVER_NUMBERED)
        )


def _read_integers(table: Table, names: tuple[str, ...], complete: bool = True) -> dict[str, int]:
    found = {
        name: table.integer(name, at_least=0) if complete else table.integer(name, None, at_least=0) for name in names
    }
    table.report_unread_keys()
    return {name: number for name, number in found.items() if number is not None}


def _read_coolant(table: Table, codes: Mapping[str, int]) -> dict[str, int]:
    """Return the M codes of coolants; ``"none"`` takes away what the definition extends.

    The reader takes the meaning of a coolant's number from here, so none may be that of a word with another effect, or
    of another coolant; ON and TAP are names for any of them.
    """
    stated = {name: table.integer(name, None, at_least=0, nothing="none") for name in COOLANTS}
    table.report_unread_keys()
    found = {name: code for name, code in stated.items() if code is not None}
    others = {codes[name]: name for name in _OTHER_M_WORDS if name in codes} | dict(_M_OF_PROGRAMS)
    media = dict[int, str]()
    for name, code in found.items():
        other = "OFF" if name != "OFF" and code == found.get("OFF") else others.get(code)
        if name in _MEDIA and media.setdefault(code, name) != name:
            other = other or media[code]
        if other:
            table.add_problem(name, Wording("DEF330", "coolant_is_other_word", code=code, other=other))
    return found


def _read_texts(table: Table, names: tuple[str, ...]) -> dict[str, str]:
    found = {name: table.text(name, "") for name in names}
    table.report_unread_keys()
    return found


def _read_statements(table: Table) -> dict[str, str]:
    """Return what becomes of CL statements; each is a line of the program, or nothing."""
    found = {statement: table.text(statement) for statement in table.names()}
    for statement, line in found.items():
        if any(ord(character) < 32 for character in line):
            table.add_problem(statement, Wording("DEF550", "line_break_control"))
    report_duplicates(table, statement_form)
    table.report_unread_keys()
    return found


def _read_arc_rules(table: Table, words: Sequence[str]) -> ArcRules:
    rules = ArcRules(
        chord_tolerance=table.number("chord_tolerance", 0.001, above=0.0),
        only_about_z=table.text("about", "XYZ", one_of=("XYZ", "Z")) == "Z",
        by_radius=table.text("by", "centre", one_of=("centre", "radius")) == "radius",
        helices=table.flag("helices", True),
        multi_turn=table.flag("turns", True),
    )
    if rules.by_radius and not set(RADIUS_ARC_WORDS) <= set(words):
        table.add_problem("by", Wording("DEF530", "radius_control_s"))
    table.report_unread_keys()
    return rules


def _read_axis_tolerance(table: Table) -> AxisTolerance:
    default = AxisTolerance()
    tolerance = AxisTolerance(
        cutting=table.number("axis_tolerance_deg", default.cutting, at_least=0.001, at_most=10.0),
        finishing=table.number("finishing_axis_tolerance_deg", default.finishing, at_least=0.001, at_most=10.0),
    )
    table.report_unread_keys()
    return tolerance


def _read_subprogram_naming(table: Table) -> SubprogramNaming:
    letters = table.text("letters", "capital", one_of=("capital", "small"))
    first = table.integer("first_number", 0, at_least=0, at_most=9999)
    naming = SubprogramNaming(
        extension=_read_extension(table),
        capitals=letters == "capital",
        max_length=4 if first else table.integer("longest_name", at_least=8),
        reserved_prefixes=table.texts("reserved", ()),
        first_number=first or None,
        prefix=table.text("before_name", ""),
    )
    table.report_unread_keys()
    return naming


def with_control(table: Table) -> LocatedValue:
    """Return the definition of a machine with its control merged onto what that extends, or as it is if that fails."""
    root = table.content
    with suppress(InputError):
        control = resolve_extends(table.unread_copy().table("control"), control_library())
        assert isinstance(root.value, dict)
        root = LocatedValue({**root.value, "control": control.content}, root.file, root.line)
        own = table.unread_copy().table("control").content.value
        if isinstance(own, dict) and "extends" in own and isinstance(control.content.value, dict):
            control.content.value["extends"] = own["extends"]
    return root
