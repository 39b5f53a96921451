"""Every text of a message stands in a catalogue, all that stand there are said, and parameters agree."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from string import Formatter

import trunnion
from trunnion.messages import AROUND, CATALOGUES, CHECKS, PHRASES, catalogue

SOURCE = Path(trunnion.__file__).parent

#: What makes a message, and at which place it takes its wording.
MAKERS = {"Problem": 2, "argument_problem": 1, "add_problem": 1, "error": 1, "remark": 1, "fatal": 1}

#: Where texts of others become messages: records of a batch, lines of checks and findings, what hooks say.
OF_OTHERS = {"batch/records.py", "batch/processing.py", "jobs/post_project/checks.py"}

#: What makes a message of a wording alone, and at which place it takes it.
MAKERS_OF_WORDINGS = {
    **dict.fromkeys(("_note", "note", "note_wait", "_note_left", "report_left", "_limit_error", "_fail"), 0),
    **dict.fromkeys(("BlockError", "KlartextError", "ExpressionError", "WordedError"), 0),
    **dict.fromkeys(("CycleExecutionError", "ArcError", "SplineError"), 0),
    **dict.fromkeys(("problem", "require"), 1),
}

#: What makes a wording, and the code of those whose code is no argument.
SAYERS = {
    "Wording": None,
    "phrase": "",
    "said": "terminal",
    "line": "results",
    "part": "results",
    "label": "report",
    "on_sheet": "sheet",
    "on_survey": "survey",
    "because": "foreign",
    "Fault": "DEF580",
    "_TextError": "SIM153",
    "_SizeError": "SIM123",
}

#: Catalogues of the lines of results and reports.
OF_RESULTS = {"results", "report", "sheet", "survey"}

#: Names of fields that are no parameters but what a user may set.
SETTABLE = {"setting", "argument", "switch"}

#: What looks into a text; and places where attributes of the same names are no sentences.
LOOKS = {
    "startswith",
    "endswith",
    "partition",
    "rpartition",
    "replace",
    "removeprefix",
    "removesuffix",
    "split",
    "find",
}
NO_SENTENCES = {
    "jobs/post/papers/manifests.py: file.what == 'program'",
    "jobs/post_project/case_papers.py: each.what == 'report'",
    "simulation/finding.py: self.what is What.NEAR",
}

#: In modules that say nothing themselves: values of data, and what stands for the name of a file.
WORDS_OF_DATA = {"not checked", "from home", "CL file", "swivel data"}

#: What is no sentence in any language: nothing, a value that a definition states, and a word of CL files.
NO_WORDS = {"''", "stated", "f'CYCLE/{method}'"}

#: Words of a sentence.
MOST_WORDS = 35


@cache
def trees() -> dict[Path, ast.Module]:
    """Every module of the product."""
    return {path: ast.parse(path.read_text(encoding="utf-8")) for path in sorted(SOURCE.rglob("*.py"))}


def texts() -> Iterator[tuple[str, str, dict[str, str]]]:
    """Code, variant and parts of every text; the code of a phrase is empty."""
    for name in (*CATALOGUES.values(), CHECKS):
        for code, variants in catalogue("en", name).items():
            for variant, parts in variants.items():
                yield code, variant, parts
    for variant, text in catalogue("en", PHRASES).items():
        yield "", variant, {"what": text}


def fields(template: str) -> Iterator[str]:
    """The parameters of a template."""
    for _, name, spec, _ in Formatter().parse(template):
        if name is not None and name not in SETTABLE:
            yield name
        if spec and "{" in spec:
            yield from fields(spec)


def constants(node: ast.expr) -> list[str]:
    """The texts that an expression may be; none if it is not known here."""
    if isinstance(node, ast.IfExp):
        return [*constants(node.body), *constants(node.orelse)]
    return [node.value] if isinstance(node, ast.Constant) and isinstance(node.value, str) else []


def calls() -> Iterator[tuple[str, ast.Call, ast.Module]]:
    """Every wording and phrase that is made, and where."""
    for path, tree in trees().items():
        for node in ast.walk(tree):
            if not isinstance(node, ast.Call) or any(keyword.arg == "declared" for keyword in node.keywords):
                continue
            if isinstance(node.func, ast.Name) and node.func.id in SAYERS:
                yield f"{path.relative_to(SOURCE)}:{node.lineno}", node, tree


def literals(tree: ast.Module) -> Iterator[object]:
    """Every literal of a module."""
    return (node.value for node in ast.walk(tree) if isinstance(node, ast.Constant))


@cache
def names_of_lines() -> set[str]:
    """Every literal of the modules that print results: rows name their lines, and others print them."""
    folders = ("cli", "reporting", "jobs")
    return {
        str(value).removeprefix("#")  # of columns of numbers
        for path, tree in trees().items()
        if path.relative_to(SOURCE).parts[0] in folders
        for value in literals(tree)
    }


def said() -> Iterator[tuple[str, str, str, set[str] | None]]:
    """Where a text is said, its code and variant, and its parameters if the call names them all."""
    known = {(code, variant) for code, variant, _ in texts()}
    for place, call, tree in calls():
        assert isinstance(call.func, ast.Name)
        of_sayer = SAYERS[call.func.id]
        codes = [of_sayer] if of_sayer is not None else constants(call.args[0]) if call.args else []
        behind = call.args[1 if of_sayer is None else 0 :]
        variants = constants(behind[0]) if behind else []
        if not variants:  # chosen before: by a text of the module
            in_module = names_of_lines() if of_sayer in OF_RESULTS else set(map(str, literals(tree)))
            variants = [variant for code, variant in known if code in codes and variant in in_module]
            if behind and isinstance(behind[0], ast.JoinedStr):  # one of those that begin like this
                start = str(getattr(behind[0].values[0], "value", ""))
                variants += [variant for code, variant in known if code in codes and variant.startswith(start)]
            named: set[str | None] = {None}
        else:
            named = {keyword.arg for keyword in call.keywords}
        if not codes:  # chosen before: by a code of the same kind of messages
            codes = sorted({code for code, variant in known if code and variant in variants})
        for code in codes:
            for variant in variants:
                yield place, code, variant, None if None in named else {name for name in named if name}


def is_text(node: ast.expr) -> bool:
    """Whether an expression is a text, or is put together from texts."""
    if isinstance(node, ast.IfExp):
        return is_text(node.body) or is_text(node.orelse)
    if isinstance(node, ast.BinOp):
        return is_text(node.left) or is_text(node.right)
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def called(node: ast.Call) -> str:
    """The name of what is called."""
    return node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def has_text(node: ast.Call) -> bool:
    """Whether a message is made of a text."""
    if called(node) == "foreign":
        return ast.unparse(node.args[0]) not in NO_WORDS
    place = MAKERS.get(called(node))
    if place is None:
        return False
    return any(each.arg == "code" for each in node.keywords) or any(map(is_text, node.args[place:]))


def test_messages_are_wordings() -> None:
    texts_of_their_own = [
        f"{path.relative_to(SOURCE)}:{node.lineno}"
        for path, tree in trees().items()
        if path.relative_to(SOURCE).as_posix() not in OF_OTHERS and path.parent.name != "messages"
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and has_text(node)
    ]
    assert not texts_of_their_own, "\n".join(texts_of_their_own)


def test_readers_say_wordings() -> None:
    texts_of_their_own = [
        f"{path.relative_to(SOURCE)}:{node.lineno}"
        for path, tree in trees().items()
        if "readers" in path.relative_to(SOURCE).parts
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
        and (name := node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", ""))
        in MAKERS_OF_WORDINGS
        and len(node.args) > MAKERS_OF_WORDINGS[name]
        and is_text(node.args[MAKERS_OF_WORDINGS[name]])
    ]
    assert not texts_of_their_own, "\n".join(texts_of_their_own)


def words_in(tree: ast.Module) -> Iterator[ast.Constant]:
    """Texts of a module that are words of a sentence: none of its docstrings, annotations, assertions and kernels."""
    aside: set[ast.AST] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            aside.add(node.value)
        elif isinstance(node, ast.Raise | ast.Assert):
            aside.update(ast.walk(node))
        elif isinstance(node, ast.arg | ast.AnnAssign) and node.annotation:
            aside.update(ast.walk(node.annotation))
        elif isinstance(node, ast.FunctionDef) and (node.name == "__repr__" or node.returns):
            aside.update(ast.walk(node) if node.name == "__repr__" else ast.walk(node.returns or node))
        elif isinstance(node, ast.Call) and called(node) == "kernel":
            aside.update(each.value for each in node.keywords)
    for node in ast.walk(tree):
        if not isinstance(node, ast.Constant) or node in aside or node.value in WORDS_OF_DATA:
            continue
        if isinstance(node.value, str) and re.search(r"[a-z]{2}[,;:]? |[ (][a-z]{2}", node.value):
            yield node


def test_checks_and_comparisons_have_no_words_of_their_own() -> None:
    texts_of_their_own = [
        f"{path.relative_to(SOURCE)}:{node.lineno}: {ast.unparse(node)}"
        for path, tree in trees().items()
        if "verification" in path.parts
        for node in words_in(tree)
    ]
    assert not texts_of_their_own, "\n".join(texts_of_their_own)


def test_what_is_said_is_in_a_catalogue_and_the_other_way_round() -> None:
    known = {(code, variant) for code, variant, _ in texts()}
    used = {(code, variant): place for place, code, variant, _ in said()}
    assert not {pair: used[pair] for pair in used.keys() - known}
    assert not known - used.keys()


def test_parameters_are_those_of_the_text() -> None:
    wanted = {(c, variant): set().union(*map(fields, parts.values())) for c, variant, parts in texts()}
    wrong = [
        f"{place}: {code} {variant}: {given} for {wanted[code, variant]}"
        for place, code, variant, given in said()
        if given is not None and given != wanted[code, variant]
    ]
    assert not wrong, "\n".join(wrong)


def test_parameters_have_names_of_their_own() -> None:
    numbered = {
        name for _, _, entry in texts() for text in entry.values() for name in fields(text) if name[-1:].isdigit()
    }
    assert numbered == set()


def test_sentences_around_are_used_and_hold_what_they_are_around() -> None:
    source = "\n".join(path.read_text(encoding="utf-8") for path in trees())
    for name, template in catalogue("en", AROUND).items():
        assert f'within("{name}"' in source, name
        assert "what" in fields(template), name


def test_words_are_those_of_the_glossary() -> None:
    """Linear axes are no slides, and messages report; they tell nothing."""
    wrong = [
        f"{code} {variant}: {text}"
        for code, variant, parts in texts()
        for text in parts.values()
        if re.search(r"\b(slides?|tells?|told)\b", re.sub(r"\{[^}]*\}", "", text))
    ]
    assert not wrong, "\n".join(wrong)


def is_said(node: ast.expr) -> bool:
    """Whether an expression is what a message says, or its cure."""
    return isinstance(node, ast.Attribute) and node.attr in ("what", "cure")


def test_no_code_looks_into_a_sentence() -> None:
    looking = []
    for path, tree in trees().items():
        for node in ast.walk(tree):
            called = node.func if isinstance(node, ast.Call) else None
            by_method = isinstance(called, ast.Attribute) and called.attr in LOOKS and is_said(called.value)
            compared = [node.left, *node.comparators] if isinstance(node, ast.Compare) else []
            if by_method or any(map(is_said, compared)):
                looking.append(f"{path.relative_to(SOURCE)}: {ast.unparse(node)}")
    assert set(looking) == NO_SENTENCES, "\n".join(looking)


def test_no_sentence_is_long() -> None:
    sentences = [
        sentence
        for _, _, parts in texts()
        for text in parts.values()
        for sentence in re.split(r"[;:.] ", text)
        if len(sentence.split()) > MOST_WORDS
    ]
    assert not sentences
