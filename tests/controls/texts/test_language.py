"""Templates with expressions: what they write, what they may not do, and that nothing in them runs away."""

from collections.abc import Mapping

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.controls.template import Budget, Printing, Value
from trunnion.controls.texts.template import text_template
from trunnion.controls.texts.values import Fault, Length, Record
from trunnion.controls.words import NumberFormat
from trunnion.errors import InputError

TOOLS = tuple(
    Record(call, {"call": call, "number": int(call), "name": name, "diameter": Length(size), "operations": 1})
    for call, name, size in (("1", "D10", 10.0), ("2", None, 6.0))
)
VALUES: Mapping[str, Value] = {"title": "Blade Größe 2", "date": None, "pressure": "70", "home_z": 50.8, "tool": "1"}


def printing(unit: float = 1.0, budget: Budget | None = None) -> Printing:
    formats = {"coordinate": NumberFormat(3, unit=unit), "angle": NumberFormat(2)}
    lists = {"tools": TOOLS, "tool": TOOLS[0]}
    return Printing(formats, {"home_z"}, unit, {"pressure"}, lists, budget or Budget())


def lines(text: str, unit: float = 1.0) -> list[str]:
    template, fault = text_template("program_end", text, "ours.toml", 7)
    assert fault is None, fault.wording.what
    return template.expand(VALUES, printing(unit))


def refused(text: str) -> str:
    """What is said of a template, when it is read or when it is written."""
    template, fault = text_template("program_end", text, "ours.toml", 7)
    if fault is not None:
        return fault.wording.what
    with pytest.raises(InputError) as caught:
        template.expand(VALUES, printing())
    (problem,) = caught.value.problems
    assert problem.file == "ours.toml"
    return problem.what


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{% if pressure > 40 %}\nM88\n{% else %}\nM89\n{% endif %}", ["M88"]),
        ("{% for one in tools %}\n(T{{ one }} {{ one.name }})\n{% endfor %}", ["(T1 D10)"]),
        ("{% for one in tools %}\n(T{{ one }}[[ {{ one.name }}]])\n{% endfor %}", ["(T1 D10)", "(T2)"]),
        ("{{ tools | count }} {date}\nG0 Z{home_z:coordinate}", ["G0 Z50.8"]),
        ("{# a remark #}\n{{ title | ascii }}", ["BLADE GROSSE 2"]),
        ("{{ title | lower | replace(' ', '_') | cut(5) }}", ["blade"]),
        ("{{ tool | pad(4) }} {{ 3 | pad(2, ' ') }}", ["0001  3"]),
        ("{{ date | default('NO DATE') }} {{ '12' | number + 1 }}", ["NO DATE 13"]),
        (
            "{{ 1 / 3 }} {{ 7 // 2 }} {{ 7 % 4 }} {{ -(2 - 5) }} {{ 2.5 | round }} {{ -3 | abs }}",
            ["0.333333 3 3 3 2 3"],
        ),
        ("{{ tool.diameter / 2 | coordinate }}", None),
        ("{{ (tool.diameter / 2) | coordinate }} {50:coordinate}", ["5. 50."]),
        ("{% set half = tool.diameter / 2 %}\n{% if half == 5 %}\n{{ half }}\n{% endif %}", ["5"]),
        ("{% for k in range(1, 4) %}\n{{ k }}{{ ',' if not loop.last else ';' }}\n{% endfor %}", ["1,", "2,", "3;"]),
        ("{% for k in ['A', 'B'] %}\n{{ loop.index }}{{ k }}\n{% endfor %}", ["1A", "2B"]),
        ("{{ tools | join(' ') }} {{ (tools | first).name }} {{ tools[1] }} {{ range(3) | last }}", ["1 2 D10 2 2"]),
        ("X{{ date ~ 'Y' }}\n[[Z{{ tools[5].name }}]]W", ["W"]),
        ("{{ 'M88' if pressure > 90 }}\n{{ 'D' in title }}", None),
        ("{{ 1e15 / 10 }} {{ 0.0000001 }} {{ -0.0 }}", None),
        ("{{ 'A\\nM30' }}", ["A M30"]),
        ("{% if title is none or tools is none or 3 is even %}\nA\n{% elif 3 is odd %}\nB\n{% endif %}", ["B"]),
    ],
)
def test_what_a_template_writes(text: str, expected: list[str] | None) -> None:
    if expected is None:
        assert refused(text)
    else:
        assert lines(text) == expected


def test_lengths_are_in_the_unit_of_the_program() -> None:
    text = (
        "{{ home_z }} {{ home_z + 25.4 }} {{ 2 * home_z }} {{ home_z / home_z }} {{ home_z | coordinate }} {pressure}"
    )
    assert lines(text) == ["50.8 76.2 101.6 1 50.8 70"]
    assert lines(text, 25.4) == ["2 3 4 1 2. 70"]
    template, _ = text_template("program_end", "{{ home_z | angle }}", "ours.toml", 7)
    with pytest.raises(InputError, match="by the format angle, which is in mm"):
        template.expand(VALUES, printing(25.4))


#: What gets out of Jinja's sandbox where it can be got out of, or takes time or memory without end.
ESCAPES = [
    "{{ ''.__class__.__mro__[1].__subclasses__() }}", "{{ tool.__class__ }}", "{{ tool['__class__'] }}",
    "{{ tools.__len__ }}", "{{ title.upper.__globals__ }}", "{{ title.format }}",
    "{{ '{0.__class__}'.format(title) }}",
    "{{ '%s' % title }}", "{{ '%99999999d' is odd }}", "{{ title | attr('__class__') }}", "{{ title.encode() }}",
    "{{ tools | map(attribute='__class__') | list }}", "{{ tools | selectattr('__class__') }}",
    "{{ tools | groupby('__class__') }}", "{{ tools | sort }}", "{{ title | format(1) }}", "{{ title | xmlattr }}",
    "{{ lipsum(100) }}", "{{ lipsum.__globals__['os'] }}", "{{ cycler('a') }}", "{{ cycler.__init__.__globals__ }}",
    "{{ joiner(',') }}", "{% set all = namespace(x=1) %}", "{% set tool.name = 1 %}", "{{ dict(a=1) }}",
    "{{ {'a': 1} }}",
    "{{ self }}", "{{ self.__init__ }}", "{{ caller() }}", "{{ varargs }}", "{{ _rendering }}", "{{ __builtins__ }}",
    "{{ config }}", "{{ loop }}", "{% for x in tools %}{{ loop.cycle('a') }}{% endfor %}",
    "{% for x in tools %}{{ loop.__class__ }}{% endfor %}",
    "{% for x in tools recursive %}{{ loop(tools) }}{% endfor %}",
    "{% for a, b in tools %}{% endfor %}", "{% for x in title %}{% endfor %}", "{% for _x in tools %}{% endfor %}",
    "{% include '/etc/passwd' %}", "{% import 'os' as os %}", "{% from 'os' import system %}", "{% extends 'x' %}",
    "{% block x %}{% endblock %}", "{% macro m() %}{{ m() }}{% endmacro %}{{ m() }}", "{% call m() %}{% endcall %}",
    "{% filter upper %}{% endfilter %}", "{% set x %}{% endset %}", "{% with x = 1 %}{% endwith %}", "{% do 1 %}",
    "{% autoescape true %}{% endautoescape %}", "{{ 2 ** 99999999 }}", "{{ 'a' * 10000000000 }}",
    "{{ [1] * 1000000000 }}",
    "{{ tools * 2 }}", "{{ title + title }}", "{{ [tools, tools] }}", "{{ (title, tools) }}",
    "{{ range(1000000000) }}",
    "{{ range(0, 5, 0) }}", "{{ range(1.5) }}", "{% for x in range(99999) %}{% endfor %}",
    "{% for x in range(9999) %}{% for y in range(9999) %}{% endfor %}{% endfor %}",
    "{% for x in range(9999) %}" + "x" * 200 + "{% endfor %}",
    "{% set a = title ~ title %}" + "{% set a = a ~ a %}" * 60,
    "{{ title | replace('e', title | replace('e', title | replace('e', title * 9))) }}",
    "{{ title | pad(999999999) }}",
    "{{ title | center(999999999) }}", "{{ title | indent(999999999) }}", "{{ title | wordwrap(1) }}",
    "{{ range(9999) | join(title) }}", "{{ 1 | round(999999) }}", "{{ 9e99 }}", "{{ 1e400 }}",
    "{{ 0x" + "f" * 9000 + " }}",
    "{{ " + "9" * 9000 + " }}", "{{ " + "(" * 5000 + "1" + ")" * 5000 + " }}", "{{ " + "-" * 5000 + "1 }}",
    "{{ " + "not " * 5000 + "title }}", "{{ title" + ".name" * 5000 + " }}", "{{ title" + " | upper" * 5000 + " }}",
    "{{ 1" + " + 1" * 5000 + " }}", "{{ title" + " ~ title" * 6000 + " }}",
    "{{ title" + " if title else title" * 999 + " }}",
    "{% if title %}" * 200 + "{% endif %}" * 200, "{% for x in tools %}" * 30 + "{% endfor %}" * 30,
    "{% if title %}" + "{% elif title %}" * 4000 + "{% endif %}", "{{ title }}" * 6000, "{{ [" + "1," * 9000 + "] }}",
    "x" * 70000 + "{{ title }}", "{{ 1 / 0 }}", "{{ 1 // 0 }}", "{{ 1 % 0 }}", "{{ title < 1 }}", "{{ true }}",
    "{{ tools }}", "{{ tool.name.x }}", "{{ title is callable }}", "{{ title is in(tools) }}", "{{ title | nothing }}",
    "{{ tools[1:] }}", "{{ tools[title] }}", "{{ title[0] }}", "{% if %}", "{{ title", "{% endfor %}", "{{ }}",
]  # fmt: skip


def answer(text: str) -> str:
    """What a template is refused with; nothing, if it is taken."""
    try:
        return refused(text)
    except pytest.fail.Exception:
        return ""


def test_what_templates_cannot_do() -> None:
    assert [text[:80] for text in ESCAPES if not answer(text)] == []


def test_a_program_has_a_budget_for_all_its_texts() -> None:
    template, fault = text_template("program_end", "{% for x in range(900) %}\nN{{ x }}\n{% endfor %}", "ours.toml", 7)
    assert fault is None
    budget = Budget(steps=20_000)
    template.expand(VALUES, printing(budget=budget))
    used = 20_000 - budget.steps
    assert used > 900
    while budget.steps >= used:
        template.expand(VALUES, printing(budget=budget))
    with pytest.raises(InputError, match="goes on for too long"):
        template.expand(VALUES, printing(budget=budget))
    with pytest.raises(InputError, match="writes too much"):
        template.expand(VALUES, printing(budget=Budget(characters=100)))


@pytest.mark.parametrize(
    "work", ["s | upper", "s | ascii", "s | trim", "s ~ s", "s | replace('q', 'p')", "s == s", "'q' in s", "s | number"]
)
def test_long_texts_cost_more_than_short_ones(work: str) -> None:
    def cost(letters: int, what: str) -> int:
        text = f"{{% set s = 'x' | pad({letters}) %}}{{% set s = s ~ s ~ s ~ s %}}{{% if {what} %}}A{{% endif %}}"
        template, fault = text_template("program_end", text, "ours.toml", 7)
        assert fault is None
        budget = Budget()
        before = budget.steps
        template.expand(VALUES, printing(budget=budget))
        return before - budget.steps

    of_making_it = cost(200, "title") - cost(1, "title")
    assert cost(200, work) - cost(1, work) >= of_making_it + 800 // 8 - 1


def test_a_fault_is_told_at_its_line() -> None:
    template, fault = text_template(
        "program_end", "\n;A\n;B\n{% if title < 3 %}\n;C\n{% endif %}\n".lstrip("\n"), "a.toml", 7
    )
    assert fault is None
    with pytest.raises(InputError) as caught:
        template.expand(VALUES, printing())
    assert caught.value.problems[0].line == 9
    _, fault = text_template("program_end", ";A\n;B\n{{ title.upper }}", "a.toml", 7)
    assert isinstance(fault, Fault)
    assert (fault.line, fault.wording.what) == (3, "asks for .upper, which nothing has")


PIECES = (
    "{{ ", " }}", "{% ", " %}", "{", "}", "[[", "]]", "\n", "for x in ", "endfor", "if ", "elif ", "else", "endif",
    "set x = ",
    "tools", "tool", "title", "x", "date", "home_z", ".diameter", ".__class__", ".name", "[0]", "(", ")", " | ",
    "upper",
    "join", "coordinate", "count", "default", "range(", "9999", "3", "0", "-", " + ", " * ", " ~ ", " == ", " < ",
    " in ", "'a'", ",",
    " and ", "not ", " if ", " else ", " is none", "macro m()", "include 'x'", "loop.index", "attr", "**",
    "T{tool}", "{home_z:coordinate}",
)  # fmt: skip


@settings(max_examples=examples(150))
@given(st.lists(st.sampled_from(PIECES), max_size=14).map("".join), st.booleans())
def test_whatever_is_written_prints_plain_lines_or_is_refused(text: str, tagged: bool) -> None:
    template, fault = text_template("program_end", f"{{{{ {text} }}}}" if tagged else text, "ours.toml", 7)
    template.fields(), template.plain_lines(), template.pattern_lines(), template.unread_fields()
    if fault is not None:
        assert fault.wording.what
        return
    try:
        found = template.expand(VALUES, printing())
    except InputError:
        return
    assert all(line.strip() and line.isprintable() for line in found)
