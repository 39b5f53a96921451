"""The registry is the only place that knows which families there are."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import trunnion
from trunnion.controls import control_library
from trunnion.controls.family_writer import FamilyWriter
from trunnion.families import FAMILIES, load_reader, load_writer
from trunnion.readers.program.family_reader import FamilyReader

PACKAGE = Path(trunnion.__file__).parent
MODULES = sorted(path for path in PACKAGE.rglob("*.py") if path != PACKAGE / "families.py")


@pytest.mark.parametrize("family", FAMILIES)
def test_every_family_has_a_complete_writer_and_a_reader(family: str) -> None:
    writer = load_writer(family)
    needed = {name for name in vars(FamilyWriter) if not name.startswith("_")} | set(FamilyWriter.__annotations__)
    assert [name for name in sorted(needed) if not hasattr(writer, name)] == []
    assert isinstance(load_reader(family), FamilyReader)


@pytest.mark.parametrize("family", FAMILIES)
def test_every_family_has_a_definition(family: str) -> None:
    texts = [entry.read_text(encoding="utf-8") for entry in control_library().iterdir() if entry.name.endswith(".toml")]
    assert any(f'family = "{family}"' in text for text in texts)


def test_no_other_module_names_a_family() -> None:
    keys = set(FAMILIES)
    found = [
        f"{path.relative_to(PACKAGE)}:{node.lineno}"
        for path in MODULES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value in keys
    ]
    assert found == []


def test_no_module_imports_the_writer_or_the_reader_of_a_family() -> None:
    found = []
    for path in MODULES:
        here = ".".join(("trunnion", *path.relative_to(PACKAGE).with_suffix("").parts))
        for name in imported(path):
            for folder in ("trunnion.output.families.", "trunnion.readers.families."):
                family = name.removeprefix(folder).partition(".")[0]
                is_family = name.startswith(folder) and (PACKAGE.parent / folder.replace(".", "/") / family).is_dir()
                if is_family and not here.startswith(f"{folder}{family}"):
                    found.append(f"{here} imports {name}")
    assert found == []


def imported(path: Path) -> Iterator[str]:
    """The dotted names of the modules that a file imports."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
