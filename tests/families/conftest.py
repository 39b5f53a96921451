"""The toy family, registered while a test runs: one entry is all that it takes."""

import pytest

from trunnion.families import FAMILIES, FamilyEntry


@pytest.fixture
def toy_family(monkeypatch: pytest.MonkeyPatch) -> str:
    """The name of the toy family."""
    monkeypatch.setitem(FAMILIES, "toy", FamilyEntry("tests.families.toy.writer", "tests.families.toy.reader"))
    return "toy"
