"""No function takes more than six things: what belongs together is a record, and options come by their names."""

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from tests.support.locations import ROOT

MOST: Final = 6

#: How functions are marked that Numba compiles: their parameters are arrays and numbers, and a record costs there.
KERNELS: Final = ("kernel", "inner", "inlined")


def is_kernel(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Whether Numba compiles a function."""
    return any(ast.unparse(each).startswith(KERNELS) for each in function.decorator_list)


def longer(file: Path) -> Iterator[tuple[str, int]]:
    """Functions of a file that take more than six things, with how many."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) or is_kernel(node):
            continue
        given = [each.arg for each in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
        count = len(given) - (given[:1] in (["self"], ["cls"]))
        if count > MOST:
            yield f"{file.relative_to(ROOT / 'src' / 'trunnion').as_posix()}:{node.name}", count


def test_no_function_takes_more_than_six_things() -> None:
    assert dict(each for file in (ROOT / "src" / "trunnion").rglob("*.py") for each in longer(file)) == {}
