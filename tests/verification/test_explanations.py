"""Every check is explained by its name, and nothing is explained that is none."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import trunnion
from tests.support.verifying import CL_FOOT, CL_HEAD, FOOT, HEAD, Verifier
from trunnion.explanations import explanations

ROOT = Path(trunnion.__file__).parent


def key_places(tree: ast.Module) -> dict[str, int]:
    """What makes a check within a module, and the place of the check's key among its arguments."""
    return {
        node.name: [argument.arg for argument in node.args.args].index("key")
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef) and isinstance(node.returns, ast.Name) and node.returns.id == "Check"
        if "key" in (names := [argument.arg for argument in node.args.args]) and "self" not in names
    }


def stated_keys() -> set[str]:
    """The keys that all modules state; parsed are those alone that can make a check."""
    texts = [path.read_text(encoding="utf-8") for path in ROOT.rglob("*.py")]
    makers = {text: key_places(ast.parse(text)) for text in texts if "-> Check:" in text}
    shared = {"Check": 0} | {
        name: place for places in makers.values() for name, place in places.items() if not name.startswith("_")
    }
    makes = re.compile(rf"\.check\(|\b({'|'.join(shared)})\(").search
    return {key for text in texts if text in makers or makes(text) for key in stated(ast.parse(text), shared)}


def stated(tree: ast.Module, shared: dict[str, int]) -> Iterator[str]:
    """The keys that a module states, as texts or by its own constants."""
    constants = {
        node.targets[0].id: node.value.value
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
        if isinstance(node.targets[0], ast.Name)
    }
    places = shared | key_places(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith(".check") and len(node.args) == 2:
            # A collector makes it: ``Faults.check``.
            key = node.args[0]
            found = key.value if isinstance(key, ast.Constant) else constants.get(ast.unparse(key))
            if isinstance(found, str):
                yield found
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in places:
            key = node.args[places[node.func.id]]
            found = key.value if isinstance(key, ast.Constant) else constants.get(ast.unparse(key))
            assert isinstance(found, str) or ast.unparse(key) in ("key", "self.key", "check.key"), ast.unparse(node)
            if isinstance(found, str):
                yield found


def explained() -> set[str]:
    return {code for code, found in explanations().items() if found.subject == "checks"}


def test_exactly_the_checks_that_can_be_made_are_explained() -> None:
    assert stated_keys() == explained()


def test_the_checks_of_a_verification_are_explained(verified: Verifier) -> None:
    keys = {check.key for check in verified(HEAD + "G0 X0 Y0 Z50\n" + FOOT, CL_HEAD + CL_FOOT).checks}
    assert len(keys) > 15
    assert keys <= explained()


def test_an_unknown_word_fails_with_its_code(verified: Verifier) -> None:
    found = verified(HEAD + "G0 X0 Y0 Z50 G999\n" + FOOT)
    words = next(check for check in found.checks if check.key == "words")
    assert not words.passed
    assert words.places[0].code == "NC211"
    assert "[NC" not in words.places[0].text
    assert words.summary.endswith("[NC211]")
