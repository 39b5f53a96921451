"""The mutants by which the tests are judged: each is one change, and Python all the same."""

import ast
from pathlib import Path

from tests.support.mutation_score.mutants import KINDS, mutants_of
from tests.support.mutation_score.reach import Sources, rounds

TEXT = '''"""A module with Größe."""


def largest(values: list[int], low: int = 3) -> int | None:
    """The largest, if it is large."""
    if not values or low < 2 and values[0] == 7:
        raise ValueError(f"{low + 1}")
    values.append(low)
    values[0] = low * 2
    return max(values)
'''

#: Two modules and their tests.
FILES = {
    "src/trunnion/parts/kernels.py": "@kernel()\ndef doubled(value):\n    return 2 * value\n",
    "src/trunnion/parts/few.py": """from trunnion.parts.kernels import doubled

LIMIT = 3

class Part:
    def size(self): return doubled(LIMIT)
""",
    "tests/parts/test_few.py": """class Few:
    def test_size(self): assert Part().size == 6
""",
    "tests/parts/test_slow.py": "def test_doubled(): assert doubled(2) == 4\n",
    "tests/support/few.py": "def part_size(): return Part().size()\n",
    "tests/test_all.py": """@fixture
def six(): return part_size()

def test_few(six): assert six == 6

def test_none(): pass
""",
}


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


def test_tests_that_may_run_a_line_are_in_the_order_of_their_distance(tmp_path: Path) -> None:
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    sources = Sources(tmp_path, slow=["parts/test_slow.py"])
    assert sources.compiled == {"src/trunnion/parts/kernels.py"}
    in_kernel, in_constant = (
        sources.tests_of(f"src/trunnion/parts/{name}", line) for name, line in (("kernels.py", 3), ("few.py", 3))
    )
    near, far = "tests/parts/test_few.py::Few::test_size", "tests/test_all.py::test_few"
    assert in_kernel == [near, far, "tests/parts/test_slow.py::test_doubled"]
    assert in_constant == [near, far]


def test_rounds_grow() -> None:
    assert [len(each) for each in rounds([str(number) for number in range(100)])] == [8, 24, 68]
