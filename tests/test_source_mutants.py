"""The mutants by which the tests are judged: each is one change, and Python all the same."""

import ast
from pathlib import Path

from tests.support.source_mutants import KINDS, mutants_of

TEXT = '''"""A module with Größe."""


def largest(values: list[int], low: int = 3) -> int | None:
    """The largest, if it is large."""
    if not values or low < 2 and values[0] == 7:
        raise ValueError(f"{low + 1}")
    values.append(low)
    values[0] = low * 2
    return max(values)
'''


def test_a_mutant_changes_one_place(tmp_path: Path) -> None:
    file = tmp_path / "module.py"
    file.write_text(TEXT, encoding="utf-8")
    mutants = [*mutants_of(file)]
    assert {mutant.kind for mutant in mutants} == KINDS.keys()
    assert [(each.before, each.after) for each in mutants if each.kind != "constant"] == [
        ("not values or low < 2 and values[0] == 7", "(not values and (low < 2 and values[0] == 7))"),
        ("not values", "(values)"),
        ("low < 2 and values[0] == 7", "(low < 2 or values[0] == 7)"),
        ("low < 2", "(low <= 2)"),
        ("values[0] == 7", "(values[0] != 7)"),
        ('raise ValueError(f"{low + 1}")', "pass"),
        ("values.append(low)", "pass"),
        ("values[0] = low * 2", "pass"),
        ("low * 2", "(low / 2)"),
        ("return max(values)", "return None"),
    ]
    for mutant in mutants:
        assert ast.dump(ast.parse(mutant.source())) != ast.dump(ast.parse(TEXT))
