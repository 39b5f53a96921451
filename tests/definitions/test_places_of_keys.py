"""Keys at the wrong place of a definition are told with the place where they belong."""

from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.machines import load_machine
from trunnion.readers import run_program

HEAD = 'schema = 1\nextends = "matsuura_mx330"\nname = "T"\n'


@pytest.mark.parametrize(
    ("text", "line", "what", "cure"),
    [
        ('[spindle]\nmax_rpm = 9000\ndescription = "ours"\n', 6, "spindle.description", "above the first table"),
        ("[templates]\nfirst_cut = 'M88'\n", 4, "templates belongs to the control", "write [control.templates]"),
        ("[known]\nM88 = 'no effect'\n", 4, "known belongs to the control", "write [control.known]"),
        ("[spindle]\ntemplates = 1\n", 5, "spindle.templates is not a key", ""),
    ],
)
def test_a_key_is_told_with_its_place(text: str, line: int, what: str, cure: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(HEAD + text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_machine(file)
    (problem,) = caught.value.problems
    assert (problem.line, problem.code) == (line, "DEF320")
    assert what in problem.what
    assert cure in problem.cure


@pytest.mark.parametrize("key", ["G54.4", "G10.9.8"])
def test_a_declared_word_with_a_point_stands_in_quotes(key: str, tmp_path: Path) -> None:
    machine, program = tmp_path / "mine.toml", tmp_path / "a.nc"
    program.write_text("%\nO1\nG0 X1.\nM30\n%\n", encoding="utf-8")
    machine.write_text(f"{HEAD}[control.known]\n{key} = 'no effect'\nM88 = 'no effect'\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        run_program(program, load_machine(machine))
    (problem,) = caught.value.problems
    assert (problem.line, problem.code) == (5, "NC190")
    assert problem.cure == f'write "{key}" = "…", in quotes'
