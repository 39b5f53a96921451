"""Programs whose tool axis leans near the pole, or whose feed is lowered: proven as declared, and no further."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.examples import THIRDS
from tests.support.jobs import post_job
from tests.support.pole_paths import around_pole
from tests.support.verifying import CL_FOOT, CL_HEAD, check
from trunnion.cl import read_cl
from trunnion.controls import load_control
from trunnion.jobs.post.expected_values import Expectation, expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.machines import Machine, load_machine
from trunnion.model.deviations import Deviations
from trunnion.model.motion import PoleStrategy
from trunnion.model.toolpath import Toolpath
from trunnion.output.program_writer import write_program
from trunnion.planning import PlanOptions
from trunnion.readers import run_program
from trunnion.verification import Verification, verify

ROWS = 81


@dataclass(frozen=True)
class Posted:
    """A posted pass 0.05 degrees from the pole; ``text`` has the lines of its program."""

    machine: Machine
    path: Toolpath
    expected: Expectation
    text: list[str]
    folder: Path

    def verified(self, text: list[str] | None = None, deviations: Deviations | None = None) -> Verification:
        """The program, or another text, verified against the CL file and the declared deviations."""
        file = self.folder / "again.mpf"
        file.write_text("\n".join(self.text if text is None else text) + "\n", encoding="utf-8")
        allowed = [replace(self.expected.tolerances[0], deviations=deviations or self.deviations)]
        run = run_program(file, self.machine)
        return verify(run, [self.path], tolerances=allowed, settings=self.expected.settings)

    @property
    def deviations(self) -> Deviations:
        assert self.expected.tolerances[0].deviations is not None
        return self.expected.tolerances[0].deviations

    def block(self, row: int) -> int:
        """Index of the line that goes to a CL row; row 0 is the rapid."""
        return [k for k, line in enumerate(self.text) if " X" in line and ("C" in line or "Y" in line)][row]


def posted(folder: Path, options: PlanOptions) -> Posted:
    machine = load_machine("yl569")
    axis = around_pole(machine, np.linspace(-2.0, 2.0, ROWS), np.full(ROWS, 0.05))
    tips = [f"{0.25 * k:.6f},{0.01 * k:.6f},5.000000" for k in range(ROWS)]
    points = [f"GOTO/{tip},{i:.9f},{j:.9f},{k:.9f}\n" for tip, (i, j, k) in zip(tips, axis.tolist(), strict=True)]
    source = folder / "pole.cls"
    start = "".join(points[0].replace(",5.000000,", ",50.000000,"))
    head = CL_HEAD.replace("GOTO/0.0,0.0,50.0,0.0,0.0,1.0\n", start).replace("500.0", "3000.0")
    source.write_text(head + "".join(points) + CL_FOOT, encoding="utf-8")
    path = read_cl(source)
    program = plan_program([path], post_job(machine, load_control(machine.control), options, {}))[0]
    target = folder / "pole.mpf"
    with target.open("wb") as sink:
        write_program(program, sink)
        expected = expectation(program)
    return Posted(machine, path, expected, target.read_text(encoding="utf-8").splitlines(), folder)


@pytest.fixture
def leaning(tmp_path: Path) -> Posted:
    return posted(tmp_path, PlanOptions(pole_strategy=PoleStrategy.LEAN))


@pytest.fixture
def slowed(tmp_path: Path) -> Posted:
    return posted(tmp_path, PlanOptions(lower_feed=True))


def failed(found: Verification) -> list[str]:
    return [c.key for c in found.checks if not c.passed]


def with_word(line: str, letter: str, change: float) -> str:
    """The line with a number changed."""
    words = line.split(" ")
    k = next(k for k, word in enumerate(words) if word.startswith(letter))
    words[k] = f"{letter}{float(words[k][len(letter) :]) + change:.5f}"
    return " ".join(words)


@pytest.mark.parametrize("mode", [PoleStrategy.HOLD, PoleStrategy.SPREAD, PoleStrategy.LEAN])
def test_a_leaning_program_is_proven_as_declared(mode: PoleStrategy, tmp_path: Path) -> None:
    found = posted(tmp_path, PlanOptions(pole_strategy=mode)).verified()
    assert failed(found) == []
    assert "; leans by up to 0.0" in check(found, "axis").summary


def test_without_its_declaration_it_fails(leaning: Posted) -> None:
    assert "axis" in failed(leaning.verified(deviations=Deviations.none()))


@pytest.mark.parametrize("third", THIRDS)
def test_a_wrong_rotary_position_is_found_in_every_row(third: int, leaning: Posted) -> None:
    tried = 0
    for k, line in list(enumerate(leaning.text))[third::3]:
        for letter in "BC":
            if any(word.startswith(letter) and word[1:2] in "-.0123456789" for word in line.split(" ")) and "X" in line:
                for change in (2e-5, 0.3):
                    tried += 1
                    found = leaning.verified(
                        [*leaning.text[:k], with_word(line, letter, change), *leaning.text[k + 1 :]]
                    )
                    if "SUPA" not in line:
                        assert "axis" in failed(found), (line, change)
    assert tried > len(leaning.deviations.leaned_rows)


def test_a_lean_beyond_the_requested_one_is_not_accepted(leaning: Posted) -> None:
    off = check(leaning.verified(deviations=replace(leaning.deviations, max_lean=0.03)), "axis")
    assert not off.passed
    assert "more than the 0.03 asked for" in off.places[0].text
    assert off.places[0].cl_line in range(12, 12 + ROWS)


def test_a_declaration_of_other_rows_fails(leaning: Posted) -> None:
    deviations = leaning.deviations
    moved = replace(deviations, leaned_rows=deviations.leaned_rows + 1)
    assert "axis" in failed(leaning.verified(deviations=moved))


def test_a_slowed_program_is_proven_as_declared(slowed: Posted) -> None:
    found = slowed.verified()
    assert failed(found) == []
    assert "for the rotary axes" in check(found, "feed").summary
    assert check(found, "speed").worst is not None
    assert check(found, "speed").worst <= 1.0  # type: ignore[operator]


def test_every_wrong_feed_is_found(slowed: Posted) -> None:
    lines = [k for k, line in enumerate(slowed.text) if " F" in line and "FNORM" not in line]
    assert len(lines) > 10
    for k in lines:
        for change in (0.02, -0.02, 500.0):
            text = [*slowed.text[:k], with_word(slowed.text[k], "F", change), *slowed.text[k + 1 :]]
            assert failed(slowed.verified(text)) == ["feed"], slowed.text[k]


@pytest.mark.parametrize(("factor", "text"), [(0.5, "need no more than"), (1e3, "declared as lowered")])
def test_a_feed_lower_than_needed_or_higher_than_that_of_the_cl_file_is_not_accepted(
    factor: float, text: str, slowed: Posted
) -> None:
    deviations = replace(slowed.deviations, slowed_feed=slowed.deviations.slowed_feed * factor)
    found = check(slowed.verified(deviations=deviations), "feed")
    assert not found.passed
    assert any(text in place.text for place in found.places)
