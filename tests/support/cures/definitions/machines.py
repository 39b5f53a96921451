"""Cures of messages about definitions of machines."""

from typing import Final

from tests.support.cures.cure import Cure, define

_HEAD: Final = 'schema = 1\nextends = "yl569"\nname = "Ours"\n'


def _line(code: str, variant: str, line: str, cured: str) -> Cure:
    """A line of a definition that extends a shipped one, and what stands in its place."""
    return Cure(code, variant, define, f"{_HEAD}{line}\n", ((f"{line}\n", cured and f"{cured}\n"),))


def _head(code: str, variant: str, old: str, new: str, cured: str = "") -> Cure:
    """A part of the head that is wrong, and what stands in its place: by default what stood there."""
    return Cure(code, variant, define, _HEAD.replace(old, new), ((new, cured or old),))


def _axis(code: str, variant: str, line: str, cured: str, axis: str = "B") -> Cure:
    """A key of an axis, and what stands in its place."""
    table = f'[[axis]]\nname = "{axis}"\n'
    return _line(code, variant, table + line, table + cured)


CURES: Final = (
    _head("DEF210", "extends_nothing_shipped_but_near", '"yl569"', '"yl56"'),
    _head("DEF210", "extends_nothing_shipped", '"yl569"', '"nothing_at_all"'),
    _head("DEF210", "extends", '"yl569"', "5", '"generic_head_table_bc"'),
    _head("DEF210", "extends_no_file_beside", '"yl569"', '"mine.toml"'),
    _head("DEF210", "extends_not_file_definition", '"yl569"', '"../mine.toml"'),
    _head("DEF130", "text_without_quotation_marks", '"Ours"', "Ours"),
    _head("DEF130", "typographic_quotation_marks", '"Ours"', "“Ours”"),
    _head("DEF130", "text_does_not_end_in_line", '"Ours"', '"Ours'),
    _head("DEF130", "no_value", 'name = "Ours"', "name ="),
    _head("DEF130", "no_equals", 'name = "Ours"', 'name "Ours"'),
    _head("DEF130", "colon_for_equals", 'name = "Ours"', 'name: "Ours"'),
    _head("DEF130", "key_alone", 'name = "Ours"', "name\n", 'name = "Ours"\n'),
    _head("DEF130", "something_behind_text", '"Ours"', '"Ours" mill'),
    _head("DEF130", "backslash_in_text", '"Ours"', '"C:\\mill"', "'C:\\mill'"),
    _head("DEF330", "not_in_quotes", '"Ours"', "55", '"55"'),
    _line(
        "DEF330",
        "sign_of_comments",
        '[control.reading]\nmore_comments = [";", "!"]\nblock_ends = [";"]',
        '[control.reading]\nmore_comments = ["!"]\nblock_ends = [";"]',
    ),
    _line(
        "NC190",
        "excluding_effects",
        '[control.known]\nM60 = "spindle clockwise, spindle off"',
        '[control.known]\nM60 = "spindle off"',
    ),
    _line("DEF130", "not_toml_already", 'name = "Twice"', ""),
    _line("DEF130", "comment_of_other_language", "// ours", "# ours"),
    _line("DEF130", "two_keys_in_line", 'description = "A" source = "B"', 'description = "A"'),
    _line("DEF130", "no_name_of_table", "[our table]", ""),
    _line("DEF130", "brackets_of_header", '[[axis]\nname = "B"', '[[axis]]\nname = "B"'),
    _line("DEF130", "something_behind_header", '[[axis]] B\nname = "B"', '[[axis]]\nname = "B"'),
    _line("DEF320", "unknown", "bogus = 1", ""),
    _line("DEF320", "unknown_but_near", 'descripton = "A"', 'description = "A"'),
    _line("DEF230", "name_missing", "[[axis]]\nlimits_deg = [-11, 90]", '[[axis]]\nname = "B"\nlimits_deg = [-11, 90]'),
    _line("DEF230", "nothing_to_remove_but_near", '[[axis]]\nname = "BB"\nremove = true', ""),
    _axis("DEF230", "remove", "remove = 1", "limits_deg = [-11, 90]"),
    _axis("DEF130", "decimal_comma", "home_deg = 1,5", "home_deg = 1.5"),
    _axis("DEF130", "point_at_end", "home_deg = 1.", "home_deg = 1.0"),
    _axis("DEF130", "leading_zeros", "home_deg = 05", "home_deg = 5"),
    _axis("DEF130", "unit_behind_number", "home_deg = 5 deg", "home_deg = 5"),
    _axis("DEF130", "unit_in_list", "limits_deg = [-11, 90 deg]", "limits_deg = [-11, 90]"),
    _axis("DEF130", "semicolon_in_list", "limits_deg = [-11; 90]", "limits_deg = [-11, 90]"),
    _axis("DEF130", "list_never_ends", "limits_deg = [-11, 90", "limits_deg = [-11, 90]"),
    _axis("DEF130", "other_word_for_flag", "endless = yes", "endless = false"),
    _axis("DEF330", "swapped", "limits_deg = [90, -11]", "limits_deg = [-11, 90]"),
    _axis("DEF330", "no_flag", 'endless = "false"', "endless = false"),
    _axis("DEF330", "in_quotes", 'home_deg = "5"', "home_deg = 5"),
    _axis("DEF330", "in_quotes", 'home_deg = "1,5 deg"', "home_deg = 1.5"),
    _axis("DEF325", "unit_does_not", "limits_mm = [-11, 90]", "limits_deg = [-11, 90]"),
    _axis("DEF420", "of_0_0", "direction = [0, 0, 0]", "direction = [0, 1, 0]"),
    _axis("DEF440", "outside_limits", "home_deg = 150", "home_deg = 50"),
    _axis("DEF440", "given_endless_axis", "limits_deg = [0, 90]", "", axis="C"),
    _line("DEF430", "name_second_time", '[[axis]]\nname = "B"\n[[axis]]\nname = "B"', '[[axis]]\nname = "B"'),
)
