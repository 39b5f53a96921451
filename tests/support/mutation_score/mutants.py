"""Mutants of the sources: one small change of one place of one module."""

import ast
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Final

_COMPARISONS: Final[dict[type[ast.cmpop], type[ast.cmpop]]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
_ARITHMETIC: Final[dict[type[ast.operator], type[ast.operator]]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult,
    ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Mutant:
    """A change of a module.

    begin, end  the bytes of its source that are replaced
    """

    file: Path
    kind: str
    line: int
    begin: int
    end: int
    before: str
    after: str

    def source(self) -> bytes:
        """The module as it is with the change."""
        data = self.file.read_bytes()
        return data[: self.begin] + self.after.encode() + data[self.end :]


def mutants_of(file: Path) -> Iterator[Mutant]:
    """All mutants of a module."""
    data = file.read_bytes()
    starts = [0]
    for line in data.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    for node in _nodes(ast.parse(data)):
        for kind, change in KINDS.items():
            if (after := change(node)) is not None:
                begin = starts[node.lineno - 1] + node.col_offset
                end = starts[(node.end_lineno or node.lineno) - 1] + (node.end_col_offset or 0)
                yield Mutant(file, kind, node.lineno, begin, end, data[begin:end].decode(), after)


def _nodes(node: ast.AST) -> Iterator[ast.expr | ast.stmt]:
    """Nodes that run: neither annotations nor f-strings, of which Python 3.11 does not know the places."""
    for name, value in ast.iter_fields(node):
        for child in value if isinstance(value, list) else [value]:
            if name in ("annotation", "returns") or not isinstance(child, ast.AST) or isinstance(child, ast.JoinedStr):
                continue
            if isinstance(child, ast.expr | ast.stmt):
                yield child
            yield from _nodes(child)


def _comparison(node: ast.AST) -> str | None:
    if not isinstance(node, ast.Compare) or type(node.ops[0]) not in _COMPARISONS:
        return None
    return (
        f"({ast.unparse(ast.Compare(node.left, [_COMPARISONS[type(node.ops[0])](), *node.ops[1:]], node.comparators))})"
    )


def _arithmetic(node: ast.AST) -> str | None:
    if not isinstance(node, ast.BinOp) or type(node.op) not in _ARITHMETIC:
        return None
    return f"({ast.unparse(ast.BinOp(node.left, _ARITHMETIC[type(node.op)](), node.right))})"


def _constant(node: ast.AST) -> str | None:
    if not isinstance(node, ast.Constant):
        return None
    if isinstance(node.value, bool):
        return str(not node.value)
    return f"({node.value + 1!r})" if isinstance(node.value, int | float) else None


def _boolean(node: ast.AST) -> str | None:
    if isinstance(node, ast.BoolOp):
        return f"({ast.unparse(ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values))})"
    return f"({ast.unparse(node.operand)})" if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not) else None


def _return(node: ast.AST) -> str | None:
    is_something = isinstance(node, ast.Return) and node.value is not None
    return "return None" if is_something and ast.unparse(node) != "return None" else None


def _deleted(node: ast.AST) -> str | None:
    """Of assignments, those into an object: without a name of its own the next line fails, whatever the tests are."""
    is_call = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
    is_into = isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute | ast.Subscript)
    return "pass" if is_call or is_into or isinstance(node, ast.AugAssign | ast.Raise) else None


#: Kind of a change -> what stands in place of a node; None: the node has no such change.
KINDS: Final[dict[str, Callable[[ast.AST], str | None]]] = {
    "comparison": _comparison,
    "arithmetic": _arithmetic,
    "constant": _constant,
    "boolean": _boolean,
    "return": _return,
    "deleted statement": _deleted,
}


def draw_mutants(folder: Path, count: int, rng: random.Random) -> list[Mutant]:
    """Mutants of the modules in a folder, or of one module, as many of each kind."""
    places = dict[str, list[Mutant]]()
    for file in sorted(folder.rglob("*.py")) or [folder]:
        for mutant in mutants_of(file):
            places.setdefault(mutant.kind, []).append(mutant)
    for each in places.values():
        rng.shuffle(each)
    turns = [mutant for turn in zip_longest(*(places.get(kind, []) for kind in KINDS)) for mutant in turn if mutant]
    return turns[:count]
