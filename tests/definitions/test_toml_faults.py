"""Mistakes of people who write TOML seldom are told in plain words, at the line to correct, with what to write."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.definitions import load_table
from trunnion.definitions.toml_faults import toml_fault
from trunnion.errors import InputError, Problem

HEAD = "schema = 1\n"


def told(folder: Path, text: str) -> Problem:
    file = folder / "mine.toml"
    file.write_text(HEAD + text, encoding="utf-8", newline="")
    with pytest.raises(InputError) as caught:
        load_table(file, folder)
    (problem,) = caught.value.problems
    assert (problem.file, problem.code) == (str(file), "DEF130")
    return problem


@pytest.mark.parametrize(
    ("text", "line", "what", "cure"),
    [
        ("name = Our mill\n", 2, "a text without quotation marks", 'name = "Our mill"'),
        ("extends = yl569 # ours\n", 2, "a text without quotation marks", 'extends = "yl569"'),
        ("part = C:\\parts\\a.stl\n", 2, "a text without quotation marks", "part = 'C:\\parts\\a.stl'"),
        ("[facts]\nseconds = 4,5\n", 3, "a comma in a number", "seconds = 4.5"),
        ("a = -4,25 # s\n", 2, "a comma in a number", "a = -4.25"),
        ("seconds 4.5\n", 2, "no = between", "seconds = 4.5"),
        ("seconds: 4.5\n", 2, ": between key and value", "seconds = 4.5"),
        ("seconds =\n", 2, "no value behind seconds", "take the line out"),
        ("seconds\n", 2, "a key without = and value", "seconds = …"),
        ("[facts\nseconds = 4\n", 2, "brackets do not match", "write [facts]"),
        ("[[axis]\nname = 1\n", 2, "brackets do not match", "write [[axis]]"),
        ("[axis]]\nname = 1\n", 2, "brackets do not match", "write [[axis]]"),
        ("[our axis]\nname = 1\n", 2, "whose name is none", "without blanks"),
        ("[facts] seconds = 4\n", 2, "seconds = 4 behind the header [facts]", "in the next line"),
        ('file = "C:\\parts\\x.stl"\n', 2, "a \\ in a text", "'C:\\parts\\x.stl'"),
        ('cl = ["C:\\parts\\x.cls"]\n', 2, "a \\ in a text", "'C:\\parts\\x.cls'"),
        ('file = "C:\\Users\\me"\n', 2, "a \\ in a text", "'C:\\Users\\me'"),
        ('name = "open\nnext = 1\n', 2, 'begins with " does not end', 'write " behind it'),
        ("name = 'open\nnext = 1\n", 2, "begins with ' does not end", "write ' behind it"),
        ("name = '''\nopen\nopen\n", 2, "begins with ''' does not end", "write ''' in a line of its own"),
        ("limits = [1,\n2\nnext = 3\n", 2, "begins with [ does not end", "write ] behind it"),
        ("pose = { a = 1\n}\n", 2, "begins with { does not end", "in one line"),
        ("name = “Ours”\n", 2, "typographic quotation marks", 'straight ones: "'),
        ("limit = 4.5 mm\n", 2, "mm behind a number", "limit = 4.5"),
        ("limit = 90°\n", 2, "° behind a number", "limit = 90"),
        ("limit = .5\n", 2, "begins or ends with its point", "limit = 0.5"),
        ("limit = -5.\n", 2, "begins or ends with its point", "limit = -5.0"),
        ("limit = 05\n", 2, "zeros before it", "limit = 5"),
        ("endless = True\n", 2, "True for a flag", "endless = true"),
        ("endless = no\n", 2, "no for a flag", "endless = false"),
        ("; ours\n", 2, "comment of another language", "with #"),
        ("// ours\n", 2, "comment of another language", "with #"),
        ("max rpm = 3\n", 2, "the key 'max rpm'", "without blanks"),
        ("größe = 3\n", 2, "the key 'größe'", "from A to Z"),
        ("a = 1 b = 2\n", 2, "two keys in one line", "a line of its own"),
        ('name = "A" mill\n', 2, "something behind the text", "name ="),
        ("limits_mm = [0 mm, 500 mm]\n", 2, "mm behind a number", "limits_mm = [0, 500]; keys name the unit"),
        ("limits_deg = [-11°, 100.5 °] # B\n", 2, "° behind a number", "limits_deg = [-11, 100.5]"),
        ("limits_deg = [-11; 100]\n", 2, "; between its values", "limits_deg = [-11, 100]"),
        ("limits_deg = [\n-11,\n100 deg\n]\n", 4, "deg behind a number", "write 100;"),
        ("[control.known]\nG65 P9020 = 'comes back'\n", 3, "G65 P9020 without", "write \"G65 P9020\" = 'comes"),
        ("[control.known] # ours\nM60 = 'stop'\nCYCL DEF 392 = 'stop'\n", 4, "CYCL DEF 392", 'write "CYCL DEF 392"'),
        ("\r\na = 4,5\r\n", 3, "a comma in a number", "a = 4.5"),
    ],
)  # fmt: skip
def test_a_common_mistake_is_told_in_plain_words(tmp_path: Path, text: str, line: int, what: str, cure: str) -> None:
    problem = told(tmp_path, text)
    assert problem.line == line
    assert what in problem.what
    assert cure in problem.cure


@given(text=st.text(max_size=80), line=st.integers(0, 9), message=st.sampled_from([
    "Invalid value", "Illegal character '\\n'", "Unterminated string", "Unclosed array", "Expected \"'''\"",
    "Expected newline or end of document after a statement", "Expected '=' after a key in a key/value pair",
]))  # fmt: skip
def test_any_line_is_told_somehow(text: str, line: int, message: str) -> None:
    fault = toml_fault(text, line, message)
    assert 0 <= fault.line <= max(line, text.count("\n") + 1)
    assert fault.wording.what
    assert fault.wording.cure
    assert len(fault.wording.what + fault.wording.cure) < 400


def test_a_mistake_that_nobody_knows_is_told_in_the_words_of_the_parser(tmp_path: Path) -> None:
    problem = told(tmp_path, "a = [1,, 2]\n")
    assert (problem.line, problem.cure) == (2, "correct the line, or the one before it")
