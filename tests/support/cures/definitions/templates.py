"""Cures of messages about templates: what is not understood of them, and what fails as they are printed."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from tests.support.cures.cure import Cure, Outcome
from trunnion.controls.template import Budget, PrintedText, Printing, Value
from trunnion.controls.texts.template import text_template
from trunnion.controls.texts.values import Length, Record
from trunnion.controls.words import NumberFormat
from trunnion.errors import InputError, Problem

_RECORD: Final = {"number": 1, "name": "D10", "diameter": Length(10.0), "holder": "SK40"}
_TOOLS: Final = (Record("1", _RECORD), Record("2", _RECORD))
_VALUES: Final[Mapping[str, Value]] = {
    "title": "Blade 2", "date": None, "home_z": 50.8, "tool": "1", "pressure": "70", "time": PrintedText("4 s"),
}  # fmt: skip
_FORMATS: Final = {"coordinate": NumberFormat(3, unit=25.4), "angle": NumberFormat(2), "digits": NumberFormat(0)}


def _print(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Read a template, and print it into a program in inches."""
    template, fault = text_template("program_end", text, "ours.toml", 7)
    if fault is not None:
        return Outcome((Problem("ours.toml", fault.line, fault.wording),), False)
    lists = {"tools": _TOOLS, "tool": _TOOLS[0]}
    try:
        template.expand(_VALUES, Printing(_FORMATS, {"home_z"}, 25.4, {"pressure"}, lists, Budget()))
    except InputError as error:
        return Outcome(error.problems, False)
    return Outcome((), True)


def _slip(variant: str, text: str, cured: str) -> Cure:
    """A template, and how it stands once its cure is followed."""
    return Cure("DEF580", variant, _print, text, ((text, cured),))


def _if(variant: str, condition: str, cured: str) -> Cure:
    """A condition, and another in its place."""
    return _slip(variant, f"{{% if {condition} %}}\nM8\n{{% endif %}}", f"{{% if {cured} %}}\nM8\n{{% endif %}}")


def _value(variant: str, value: str, cured: str) -> Cure:
    """An expression that is printed, and another in its place."""
    return _slip(variant, f"M8 {{{{ {value} }}}}", f"M8 {{{{ {cured} }}}}")


CURES: Final = (
    _slip("beginning_without_end", "{% if date %}\nM8", "{% if date %}\nM8\n{% endif %}"),
    _slip("branch_without_if", "M8\n{% else %}\nM9", "M8\nM9"),
    _slip("branch_without_if", "M8\n{% else %}\nM9\n{% endif %}", "{% if date %}\nM8\n{% else %}\nM9\n{% endif %}"),
    _slip("end_alone", "{% if date %}\nM8\n{% end %}", "{% if date %}\nM8\n{% endif %}"),
    _slip("end_in_two_words", "{% if date %}\nM8\n{% end if %}", "{% if date %}\nM8\n{% endif %}"),
    _slip("end_without_beginning", "M8\n{% endif %}", "M8"),
    _slip("end_without_beginning", "M8\n{% endif %}", "{% if date %}\nM8\n{% endif %}"),
    _slip("other_must_end_first", "{% for one in tools %}\n{% if date %}\nM8\n{% endfor %}\n{% endif %}",
          "{% for one in tools %}\n{% if date %}\nM8\n{% endif %}\n{% endfor %}"),
    _slip("if_behind_else", "{% if date %}\nM8\n{% else if title %}\nM9\n{% endif %}",
          "{% if date %}\nM8\n{% elif title %}\nM9\n{% endif %}"),
    _slip("something_behind_else", "{% if date %}\nM8\n{% else date %}\nM9\n{% endif %}",
          "{% if date %}\nM8\n{% else %}\nM9\n{% endif %}"),
    _slip("something_behind_end", "{% if date %}\nM8\n{% endif date %}", "{% if date %}\nM8\n{% endif %}"),
    _slip("no_loop", "{% for one of tools %}\nM8\n{% endfor %}", "{% for one in tools %}\nM8\n{% endfor %}"),
    _slip("loop_of_other_kind", "{% for a, b in tools %}\nM8\n{% endfor %}", "{% for a in tools %}\nM8\n{% endfor %}"),
    _slip("sets_nothing", "{% set depth 5 %}\nM8", "{% set depth = 5 %}\nM8"),
    _slip("sets_other_thing", "{% set tool.name = 5 %}\nM8", "{% set name = 5 %}\nM8"),
    _slip("sets_other_thing", "{% set a, b = 5 %}\nM8", "{% set a = 5 %}\nM8"),
    _slip("no_statement", "{% goto 5 %}\nM8", "{% set goto = 5 %}\nM8"),
    _slip("no_statement_but_near", "{% fro one in tools %}\nM8\n{% endfor %}",
          "{% for one in tools %}\nM8\n{% endfor %}"),
    _slip("statement_of_other_language", "{% if date %}\nM8\n{% elseif title %}\nM9\n{% endif %}",
          "{% if date %}\nM8\n{% elif title %}\nM9\n{% endif %}"),
    _slip("without_statement", "{% %}\nM8\n{% endif %}", "{% if date %}\nM8\n{% endif %}"),
    _slip("tag_does_not_end", "M8\n{{ title }\nM9", "M8\n{{ title }}\nM9"),
    _slip("text_does_not_end", "{% if title == 'A %}\nM8\n{% endif %}", "{% if title == 'A' %}\nM8\n{% endif %}"),
    _slip("unseen_sign_by_name", "M8 {{ tit\u200ble }}", "M8 {{ title }}"),
    _if("behind_condition", "date then", "date"),
    _if("nothing_in_it", "", "date"),
    _if("single_equals", "title = 'A'", "title == 'A'"),
    _if("sign_for_and", "title && date", "title and date"),
    _if("sign_for_or", "title || date", "title or date"),
    _if("sign_for_not", "!date", "not date"),
    _if("sign_for_unequal", "title <> 'A'", "title != 'A'"),
    _if("sign_for_at_least", "home_z => 1", "home_z >= 1"),
    _if("sign_for_at_most", "home_z ≤ 1", "home_z <= 1"),
    _if("needless_sign", "date;", "date"),
    _if("typographic_quotation_mark", "title == “A”", 'title == "A"'),
    _if("no_such_test", "title is defined", "title is none"),
    _if("no_such_test", "title is eq 'A'", "title == 'A'"),
    _if("compares_other_kinds", "title < 3", "(title | number | default(0)) < 3"),
    _if("compares_other_kinds", "date < 3", "date | default(0) < 3"),
    _if("looks_within_other_kind", "3 in home_z", "3 in [3, 4]"),
    _if("looks_within_other_kind", "'3' in home_z", "'3' in title"),
    _value("sign_for_choice", "title ? 1 : 2", "1 if title else 2"),
    _value("sign_for_power", "home_z ^ 2", "home_z * home_z"),
    _value("sign_for_times", "2 × 3", "2 * 3"),
    _value("sign_for_divided", "6 ÷ 3", "6 / 3"),
    _value("sign_for_minus", "6 \u2212 3", "6 - 3"),
    _value("sign_of_unit", "90°", "90"),
    _value("sign_for_fraction", "½", "0.5"),
    _value("unit_behind_number", "3mm", "3"),
    _value("closes_no_bracket", "1 + 2)", "1 + 2"),
    _value("closes_no_bracket", "1 + 2)", "(1 + 2)"),
    _value("bracket_not_closed", "(1 + 2", "(1 + 2)"),
    _value("nothing_behind", "home_z +", "home_z + 2"),
    _value("side_by_side", "tool title", "tool ~ title"),
    _value("side_by_side", "tool ~ BLADE TOP", 'tool ~ "BLADE TOP"'),
    _value("number_wanted", "title + 'A'", "title ~ 'A'"),
    _value("number_wanted", "'5' + 3", "('5' | number) + 3"),
    _value("divides_by_0", "1 / (home_z - 50.8)", "1 / (home_z - 50.8) if home_z != 50.8"),
    _value("length_in_format_of_mm", "home_z | angle", "home_z | coordinate"),
    _value("prints_neither_text_nor_number", "tools", "tools | join(', ')"),
    _slip("prints_neither_text_nor_number", "M8 {{ tools }}", "{% for one in tools %}\nM8 {{ one }}\n{% endfor %}"),
    _value("range_of_no_whole_numbers", "range(1.5) | last", "range(3) | last"),
    _value("range_of_no_whole_numbers", "range(1.5, 4) | last", "range(1, 4) | last"),
    _value("machining_time_for_value", "time | upper", "time"),
    _value("attribute_not_there_but_near", "tool.mode", "tool.holder"),
    _value("attribute_of_nothing_but_near", "tool.diametr", "tool.diameter"),
    _value("index_of_no_list", "title[0]", "tools[0]"),
    _value("format_takes_no_values", "3 | coordinate(3)", "3 | coordinate"),
    _value("format_takes_no_values_but_near", "3 | rund(3)", "3 | round(3)"),
    _value("list_of_other_things", "[title, date] | first", "['TOP', 'SIDE'] | first"),
    _value("self_is_no_part", "self", "title"),
    _value("whole_number_wanted", "title | cut(-2)", "title | cut(2)"),
    _value("prints_beyond_format", "(9999999 * 9999) | coordinate", "home_z | coordinate"),
    _slip("goes_on_too_long", "{% for a in range(9999) %}{% for b in range(9999) %}{% endfor %}{% endfor %}",
          "{% for a in range(9999) %}{% endfor %}"),
    _slip("writes_too_much", "{% for x in range(9999) %}" + "x" * 200 + "{% endfor %}",
          "{% for x in range(999) %}" + "x" * 200 + "{% endfor %}"),
    _slip("too_many_letters", "x" * 70_000 + "{{ title }}",
          "{% for a in range(700) %}\n" + "x" * 100 + "\n{% endfor %}{{ title }}"),
    _slip("too_many_parts", "{{ title }}\n" * 4000, "{% for a in range(4000) %}\nM8 {{ title }}\n{% endfor %}"),
    _value("too_deep", "(1 +" * 50 + "1" + ")" * 50, "1"),
    _value("attribute_of_nothing", "tool.colour", "tool"),
    _value("no_part_of_templates", "title.upper()", "title"),
    _slip("no_part_of_templates", "{% include 'other.txt' %}M8", "M8"),
    _value("not_taken_by_filter", "3 | abs(3)", "3 | abs"),
    _value("tag_not_understood", ".tool", "tool"),
    _slip("tag_not_understood", "M8 {{ .tool }}", "M8"),
    _value("sign_for_root", "√title", "title"),
    _if("not_allowed_by_values", "3 in title", "'3' in title"),
    _if("not_allowed_by_values", "3 in title", "3 in [3, 4]"),
    _value("not_compiled", "(" * 5000 + "1" + ")" * 5000, "1"),
    _value("not_compiled", "9" * 5000, "9"),
    _value("template_fails", "1 / 0", "1"),
    _value("", "1 / (date | default(0))", "1"),
)  # fmt: skip
