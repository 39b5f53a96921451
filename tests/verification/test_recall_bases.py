"""Every golden program is taken into the recall runs, in the language of its machine."""

from pathlib import Path

import pytest

from tests.support.golden_controls import CASES
from tests.support.recall_proof import bases as made
from tests.support.recall_proof.bases import MACHINES, bases, language_of


@pytest.mark.parametrize("language", MACHINES)
def test_a_machine_says_its_language(language: str) -> None:
    assert language_of(MACHINES[language]) == language


def test_every_golden_program_is_a_base(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for others in ("PARTS", "_PLANES"):  # which are posted
        monkeypatch.setattr(made, others, ())
    monkeypatch.setattr(made, "_CASES", tmp_path)
    found = list(bases(tmp_path))
    assert {base.name for base in found} >= CASES.keys()
    assert {base.family for base in found} == MACHINES.keys()
    assert all(base.text and base.cl.is_file() for base in found)
