"""What may stand in a template: the tree that Jinja's parser makes, checked node by node, and what becomes of it.

Fields (``{name:format}``) become expressions, number formats and ``range`` become filters, and each loop gets the
price of its passes.
"""

import math
import re
from collections.abc import Callable, Iterable, Iterator
from typing import Final

from jinja2 import nodes

from trunnion.controls.texts import filters
from trunnion.controls.texts.sandbox import LOOP_VALUES, SANDBOX
from trunnion.controls.texts.values import Fault
from trunnion.controls.vocabulary import RECORD_VALUES
from trunnion.definitions.messages import meant_word

#: Letters of a template; statements and expressions within each other, as Jinja's compiler recurses.
LONGEST_SOURCE: Final = 65_536
_DEEPEST: Final = 40
_DEEPEST_STATEMENTS: Final = 8

#: Parts of one template: names, numbers, operators, statements. A text of a hundred lines has some 500.
_MOST_NODES: Final = 5000

#: Marks in a printed line around what may be left out of it.
OPENING: Final = "\1"
CLOSING: Final = "\2"

FIELD: Final = re.compile(r"\{([A-Za-z_][A-Za-z0-9_]*|[-+]?(?:\d+\.?\d*|\.\d+)(?=:))(?::([A-Za-z_][A-Za-z0-9_]*))?\}")

_ALLOWED: Final = (
    nodes.Template, nodes.Output, nodes.TemplateData, nodes.Name, nodes.Const, nodes.If, nodes.For, nodes.Assign,
    nodes.Getattr, nodes.Getitem, nodes.Filter, nodes.Test, nodes.Compare, nodes.Operand, nodes.And, nodes.Or,
    nodes.Not, nodes.Neg, nodes.Pos, nodes.Add, nodes.Sub, nodes.Mul, nodes.Div, nodes.FloorDiv, nodes.Mod,
    nodes.Concat, nodes.CondExpr, nodes.List, nodes.Tuple,
)  # fmt: skip

#: How people call what may not stand in a template.
_REFUSED: Final[dict[type[nodes.Node], str]] = {
    nodes.Include: "include", nodes.Import: "import", nodes.FromImport: "from … import", nodes.Extends: "extends",
    nodes.Block: "block", nodes.Macro: "macro", nodes.CallBlock: "call", nodes.FilterBlock: "filter",
    nodes.AssignBlock: "set … endset", nodes.With: "with", nodes.Call: "a call", nodes.Pow: "**",
    nodes.NSRef: "an attribute that is set", nodes.Slice: "[a:b]", nodes.Dict: "{…}", nodes.Break: "break",
    nodes.ScopedEvalContextModifier: "autoescape", nodes.Continue: "continue", nodes.MarkSafe: "safe",
}  # fmt: skip


def parsed(text: str) -> nodes.Template:
    """Return the checked tree of a template.

    Raises ``Fault`` with the first thing in it that may not be there.

    Raises ``TemplateSyntaxError`` if Jinja does not understand it.

    Raises ``RecursionError`` if it is too deep for Jinja's parser.
    """
    if len(text) > LONGEST_SOURCE:
        raise Fault("too_many_letters", most=LONGEST_SOURCE)
    tree = SANDBOX.parse(text)
    _check_depth(tree)
    for node in (tree, *tree.find_all(nodes.Node)):
        _check(node)
    _replace_ranges(tree)
    return tree


def for_compiler(tree: nodes.Template, formats: Iterable[str]) -> int:
    """Change a checked tree into what is compiled, and return how many operations it is without passes of loops."""
    names = frozenset(formats)
    for choice in tree.find_all(nodes.CondExpr):
        choice.expr2 = choice.expr2 or nodes.Const(None, lineno=choice.lineno)
    for node in tree.find_all(nodes.Filter):
        if node.name in names:
            node.args, node.name = [nodes.Const(node.name, lineno=node.lineno)], filters.FORMAT
    _replace_concatenations(tree)
    for comparison in tree.find_all(nodes.Compare):
        comparison.expr = _compared(comparison.expr)
        for operand in comparison.ops:
            operand.expr = _compared(operand.expr)
    for loop in tree.find_all(nodes.For):
        price = nodes.Const(_size(loop), lineno=loop.lineno)
        loop.iter = nodes.Filter(loop.iter, filters.EACH, [price], [], None, None, lineno=loop.lineno)
    tree.set_environment(SANDBOX)
    return _size(tree)


def with_fields(tree: nodes.Template) -> nodes.Template:
    """Replace the fields among the text of a parsed template by expressions, and its brackets by marks."""
    for output in list(tree.find_all(nodes.Output)):
        output.nodes = [each for node in output.nodes for each in _parts(node)]
    return tree


def formats_of(tree: nodes.Template) -> Iterator[tuple[int, str, str]]:
    """Yield the number formats of a template: line, the name or number that is printed, else "", and the format."""
    for node in tree.find_all(nodes.Filter):
        if node.name not in filters.ALL:
            what = node.node
            value = (
                what.name if isinstance(what, nodes.Name) else str(what.value) if isinstance(what, nodes.Const) else ""
            )
            yield node.lineno, value, node.name


def _parts(node: nodes.Expr) -> Iterator[nodes.Expr]:
    if not isinstance(node, nodes.TemplateData):
        yield node
        return
    text, line, at = node.data.replace("[[", OPENING).replace("]]", CLOSING), node.lineno, 0
    for match in FIELD.finditer(text):
        between = text[at : match.start()]
        if between:
            yield nodes.TemplateData(between, lineno=line)
        line += between.count("\n")
        name, number_format = match[1], match[2]
        is_name = name[0].isalpha() or name[0] == "_"
        value: nodes.Expr = nodes.Name(name, "load", lineno=line) if is_name else nodes.Const(float(name), lineno=line)
        yield nodes.Filter(value, number_format, [], [], None, None, lineno=line) if number_format else value
        at = match.end()
    if text[at:]:
        yield nodes.TemplateData(text[at:], lineno=line)


def _check_depth(tree: nodes.Template) -> None:
    """Refuse what would be too deep for a compiler that calls itself."""
    waiting: list[tuple[nodes.Node, int, int]] = [(tree, 0, 0)]
    count = 0
    while waiting:
        node, depth, statements = waiting.pop()
        statements += isinstance(node, nodes.For | nodes.If)
        count += 1
        if count > _MOST_NODES:
            raise Fault("too_many_parts", node.lineno or 0, most=_MOST_NODES)
        if depth > _DEEPEST or statements > _DEEPEST_STATEMENTS:
            raise Fault("too_deep", node.lineno)
        # An elif is a statement behind the others, not within them.
        waiting += [(child, depth + 1, statements) for child in node.iter_child_nodes(exclude=("elif_",))]
        if isinstance(node, nodes.If):
            waiting += [(child, depth, statements - 1) for child in node.elif_]


def _check(node: nodes.Node) -> None:
    line = node.lineno or 0
    if isinstance(node, nodes.Call) and _is_range(node):
        return
    if not isinstance(node, _ALLOWED):
        raise Fault("no_part_of_templates", line, part=_REFUSED.get(type(node), type(node).__name__.lower()))
    if isinstance(node, nodes.Name) and node.name.startswith("_"):
        raise Fault("no_name", line, name=node.name)
    if isinstance(node, nodes.Name) and node.name == "self":
        raise Fault("self_is_no_part", line)
    if isinstance(node, nodes.Getattr) and node.attr not in RECORD_VALUES | LOOP_VALUES:
        if near := meant_word(node.attr, RECORD_VALUES | LOOP_VALUES):
            raise Fault("attribute_of_nothing_but_near", line, attribute=node.attr, near=near)
        raise Fault("attribute_of_nothing", line, attribute=node.attr)
    if isinstance(node, nodes.Const):
        _check_constant(node)
    elif isinstance(node, nodes.For):
        if node.recursive or not isinstance(node.target, nodes.Name):
            raise Fault("loop_of_other_kind", line)
    elif isinstance(node, nodes.Assign):
        if not isinstance(node.target, nodes.Name):
            raise Fault("sets_other_thing", line)
    elif isinstance(node, nodes.List | nodes.Tuple):
        if not all(isinstance(item, nodes.Const) for item in node.items):
            raise Fault("list_of_other_things", line)
    elif isinstance(node, nodes.Filter | nodes.Test):
        _check_arguments(node)


def _check_constant(node: nodes.Const) -> None:
    value = node.value
    if isinstance(value, int | float) and not (math.isfinite(value) and abs(value) <= 1e12):
        raise Fault("too_large_number", node.lineno)


def _check_arguments(node: nodes.Filter | nodes.Test) -> None:
    named = node.kwargs or node.dyn_args or node.dyn_kwargs
    if isinstance(node, nodes.Filter) and node.name not in filters.ALL and (node.args or named):
        if near := meant_word(node.name, filters.MOST_ARGUMENTS):
            raise Fault("format_takes_no_values_but_near", node.lineno, name=node.name, near=near)
        raise Fault("format_takes_no_values", node.lineno, name=node.name)
    if named or (isinstance(node, nodes.Filter) and len(node.args) > filters.MOST_ARGUMENTS.get(node.name, 0)):
        raise Fault("not_taken_by_filter", node.lineno, name=node.name)
    if isinstance(node, nodes.Test) and (node.name not in filters.TESTS or node.args):
        raise Fault("no_such_test", node.lineno, name=node.name, known=tuple(sorted(filters.TESTS)))
    if isinstance(node, nodes.Filter) and node.node is None:
        raise Fault("no_part_of_templates", node.lineno, part="filter")


def _is_range(node: nodes.Call) -> bool:
    plain = not (node.kwargs or node.dyn_args or node.dyn_kwargs)
    return isinstance(node.node, nodes.Name) and node.node.name == "range" and plain and 1 <= len(node.args) <= 3


def _replace_ranges(tree: nodes.Template) -> None:
    def replaced(node: nodes.Node) -> nodes.Node:
        if not isinstance(node, nodes.Call):
            return node
        first, *others = node.args
        return nodes.Filter(first, filters.RANGE, others, [], None, None, lineno=node.lineno)

    _replace(tree, replaced)


def _replace_concatenations(tree: nodes.Template) -> None:
    def replaced(node: nodes.Node) -> nodes.Node:
        if not isinstance(node, nodes.Concat):
            return node
        first, *others = node.nodes
        return nodes.Filter(first, filters.JOINED, others, [], None, None, lineno=node.lineno)

    _replace(tree, replaced)


def _compared(side: nodes.Expr) -> nodes.Expr:
    """One side of a comparison, which is paid for by its letters."""
    if isinstance(side, nodes.Const) and not isinstance(side.value, str):
        return side
    return nodes.Filter(side, filters.COMPARED, [], [], None, None, lineno=side.lineno)


def _replace(tree: nodes.Node, replaced: Callable[[nodes.Node], nodes.Node]) -> None:
    """Replace nodes everywhere below a tree."""
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        for name in node.fields:
            value = getattr(node, name)
            if isinstance(value, list):
                value[:] = [replaced(each) if isinstance(each, nodes.Node) else each for each in value]
            elif isinstance(value, nodes.Node):
                setattr(node, name, replaced(value))
        waiting += node.iter_child_nodes()


def _size(tree: nodes.Node) -> int:
    return 1 + sum(1 for _ in tree.find_all(nodes.Node))
