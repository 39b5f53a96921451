"""Words that are known and not simulated are warnings of a verification."""

from collections.abc import Sequence
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS
from trunnion.errors import Problem
from trunnion.jobs.observer import Observer

CL = TESTS / "data" / "cases" / "tilted_flood.cls"


class Told(Observer):
    """What a verification warns of."""

    def __init__(self) -> None:
        self.said: list[str] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        self.said += [f"{each.code} {each}" for each in problems]


@pytest.mark.parametrize("word", ["M118 X1", "M110"])
def test_words_that_change_what_nobody_sees_are_told(word: str, tmp_path: Path) -> None:
    program = tmp_path / "part.h"
    trunnion.post(CL, machine="dmu65", output=program)
    lines = program.read_text(encoding="utf-8").splitlines()
    at = max(k for k, line in enumerate(lines) if " L Z" in line and "M91" not in line)
    lines.insert(at, f"{lines[at].split()[0]} {word}")
    program.write_text("\n".join(lines) + "\n", encoding="utf-8")
    beside, alone = Told(), Told()
    trunnion.verify(program, machine="dmu65", cl=CL, observer=beside)
    trunnion.verify(program, machine="dmu65", observer=alone)
    for told in (beside, alone):
        assert any("NC221" in each and word.split()[0] in each for each in told.said)
