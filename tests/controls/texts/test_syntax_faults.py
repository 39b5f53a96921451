"""What is not understood of a template is told in the words of those who write it: what, where, and what to write."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.controls.template import Budget, Printing
from trunnion.controls.texts.template import text_template
from trunnion.controls.texts.values import Fault
from trunnion.controls.words import NumberFormat
from trunnion.errors import InputError

PRINTING = Printing(
    {"coordinate": NumberFormat(3), "angle": NumberFormat(2)}, {"home_z"}, 1.0, set(), {"tools": ()}, Budget()
)

#: Words of Jinja and Python that nobody must see.
RAW = re.compile(
    r"[Jj]inja|token|[Ee]xpected|[Ee]ncountered|unexpected|statement block|print statement|instances of|NoneType"
)


def fault_of(text: str) -> Fault:
    template, fault = text_template("program_end", text, "ours.toml", 7)
    assert fault is not None
    assert template.code is None
    return fault


@pytest.mark.third
@pytest.mark.parametrize(
    ("text", "line", "what", "cure"),
    [
        ("(A)\n{% if tool = 1 %}\nM8\n{% endif %}", 2, "{% if tool = 1 %} with =, which compares nothing", "write =="),
        ("{{ 'A' if tool = 1 }}", 1, "with =, which compares nothing", "write == to compare"),
        ("{% if tool == 1 and pressure = 2 %}\n{% endif %}", 1, "with =", "write == to compare"),
        ("{% if tool == 1 %}\nM8\nM9", 1, "{% if tool == 1 %} without its {% endif %}", "write {% endif %}"),
        ("{% for one in tools %}\nM8", 1, "{% for one in tools %} without its {% endfor %}", "write {% endfor %}"),
        ("M8\n{% endif %}", 2, "{% endif %} without its {% if … %}", "take it out"),
        ("M8\n{% else %}\nM9", 2, "{% else %} without its {% if … %}", "take it out"),
        ("{% if tool %}\n{% endfor %}", 2, "where the {% if tool %} of line 1", "write {% endif %} before it"),
        ("{% if tool %}\n{% for one in tools %}\n{% endif %}", 3, "{% for one in tools %} of line 2", "endfor"),
        ("{% if tool %}\n{% if date %}\n{% endif %}", 1, "{% if tool %} without its {% endif %}", "{% endif %}"),
        ("M8\n{% if tool }\nM9\n{% endif %}", 2, "{% if tool }, which does not end with %}", "write %} behind it"),
        ("M8\n{{ tool }\nM9", 2, "{{ tool }, which does not end with }}", "write }} behind it"),
        ("M8 {# ask\nM9", 1, "{# ask, which does not end with #}", "write #} behind it"),
        ("{% if tool == 'A %}\n{% endif %}", 1, "a text that begins with ' and does not end", "write ' behind it"),
        ('{{ "A }}\n(B)', 1, 'a text that begins with " and does not end', 'write " behind it'),
        ("{% if tool == “A” %}\n{% endif %}", 1, "with the quotation mark “", "write \" or '"),
        ("M8\n{{ 2 × 3 }}", 2, "{{ 2 × 3 }} with ×", "write * to multiply"),
        ("{{ 6 ÷ 3 }}", 1, "with ÷", "write / to divide"),
        ("{{ 6 \u2212 3 }}", 1, "with \u2212", "write the minus sign of the keyboard"),
        ("{% if tool ≤ 3 %}\n{% endif %}", 1, "with ≤", "write <= for at most"),
        ("{% if tool ≠ 3 %}\n{% endif %}", 1, "with ≠", "write != for unequal"),
        ("{{ 2² }}", 1, "with ²", "multiply"),
        ("M8\n{{ tit\u200ble }}", 2, "{{ tit<U+200B>le }} with a sign that nobody sees, U+200B (zero", "delete"),
        ("{%\ufeff if tool %}\n{% endif %}", 1, "U+FEFF", "delete it"),
        ("{{ self }}", 1, "has self, which templates do not have", "by its own name"),
        ("{{ 3 | coordinate(3) }}", 1, "gives coordinate values in brackets", "a number format has its decimals"),
        ("{{ 3 | rund(3) }}", 1, "gives rund values in brackets", 'did you mean "round"'),
        ("{{ 3 | abs(3) }}", 1, "gives abs what it does not take", "docs/templates.md"),
        ("{{ 3 | round(3, 4) }}", 1, "gives round what it does not take", "docs/templates.md"),
        ("{% elseif tool %}", 1, "which is no statement", "write elif"),
        ("{% if tool %}\n{% else if date %}\n{% endif %}", 2, "something behind else", "write {% elif … %}"),
        ("{% If tool %}\n{% Endif %}", 1, "{% If tool %}, which is no statement", "write if"),
        ("{% if tool %}\n{% end if %}", 2, "{% end if %}, which is no statement", "write {% endif %} in one word"),
        ("{% fro one in tools %}\n{% endfor %}", 1, "which is no statement", 'did you mean "for"'),
        ("{% for one of tools %}\n{% endfor %}", 1, "which is no loop", "write {% for one in list %}"),
        ("{% set depth 5 %}", 1, "which sets nothing", "write {% set name = value %}"),
        ("{% set depth == 5 %}", 1, "which sets nothing", "write {% set name = value %}"),
        ("{% if tool then %}\n{% endif %}", 1, "with then behind the condition", "leave it out"),
        ("{% if tool && date %}\n{% endif %}", 1, "with &&", "write and"),
        ("{% if tool || date %}\n{% endif %}", 1, "with ||", "write or"),
        ("{% if !tool %}\n{% endif %}", 1, "with !", "write not"),
        ("{% if tool <> 1 %}\n{% endif %}", 1, "with <>", "write !="),
        ("{% if tool => 1 %}\n{% endif %}", 1, "with =>", "write >="),
        ("{{ tool ? 1 : 2 }}", 1, "with ?", "write a if b else c"),
        ("{% if %}\n{% endif %}", 1, "{% if %} with nothing in it", "write a value or a condition"),
        ("{{ }}", 1, "{{ }} with nothing in it", "write a value or a condition"),
        ("{{ tool + }}", 1, "with nothing behind +", "write a value behind it"),
        ("{{ (1 + 2 }}", 1, "with (, which is not closed", "write ) where it ends"),
        ("{{ 1 + 2) }}", 1, "with ), which closes no bracket", "take it out"),
        ("{{ tool title }}", 1, "with tool and title side by side", "join texts by ~"),
        ("{{ 3mm }}", 1, "with mm right behind a number", "write numbers without units"),
        ("{{ .tool }}", 1, "{{ .tool }}, which is not understood", "docs/templates.md"),
    ],
)  # fmt: skip
def test_a_slip_is_told_with_its_line_and_its_cure(text: str, line: int, what: str, cure: str) -> None:
    fault = fault_of(text)
    assert (fault.line, what in fault.wording.what, cure in fault.wording.cure) == (line, True, True), (
        fault.wording.what,
        fault.wording.cure,
    )
    assert not RAW.search(fault.wording.what + fault.wording.cure)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("{% if title < 3 %}x{% endif %}", "compares a text with a number by <"),
        ("{% if date < 3 %}x{% endif %}", "compares an absent value with a number by <"),
        ("{% if tools > 3 %}x{% endif %}", "compares a list with a number by >"),
        ("{% if 3 in home_z %}x{% endif %}", "looks by in for something within a number"),
    ],
)  # fmt: skip
def test_values_that_do_not_fit_are_told_without_words_of_python(text: str, what: str) -> None:
    template, fault = text_template("program_end", text, "ours.toml", 7)
    assert fault is None
    with pytest.raises(InputError) as caught:
        template.expand({"title": "T", "date": None, "home_z": 5.0}, PRINTING)
    (problem,) = caught.value.problems
    assert what in problem.what
    assert not RAW.search(problem.what + problem.cure)


PIECES = [
    "{%", "%}", "{{", "}}", "{#", "#}", "{", "}", "%", " if ", " elif ", " else ", " endif ", " for ", " in ",
    " endfor ", " set ", " tool ", "tools",
    "'", '"', "=", "==", "<", "(", ")", "[", "]", "|", ".", ",", "1", " and ", "-",
    "+", "\n",
    "{% if tool %}", "{% endif %}", "{{ tool }}", "é", "\\",
]  # fmt: skip


@settings(max_examples=examples(400), deadline=None)
@given(st.lists(st.sampled_from(PIECES), max_size=14).map("".join))
def test_whatever_stands_in_a_template_no_word_of_the_parser_is_told(text: str) -> None:
    template, fault = text_template("program_end", text, "ours.toml", 7)
    if fault is None:
        return
    assert template.code is None
    assert 0 <= fault.line <= text.count("\n") + 1
    assert not RAW.search(fault.wording.what + fault.wording.cure), (text, fault.wording.what)


@pytest.mark.parametrize("text", [
    "{{ " + "a " * 30_000, "{{ " + "'" * 60_000, "{% if a %}" * 6000, "{{ " + "(" * 60_000 + " }}",
    "{{ a = 1 }}" * 5000, "{{ " + "a." * 30_000 + " }}", "{% x %}" * 9000,
])  # fmt: skip
def test_a_long_template_is_judged_as_well(text: str) -> None:
    assert len(fault_of(text).wording.what) < 300
