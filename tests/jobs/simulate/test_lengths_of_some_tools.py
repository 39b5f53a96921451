"""The length of one tool is stated, and that of another is unknown: it counts as no number, and least of all as 0."""

from pathlib import Path

import pytest

import trunnion
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.timing import axis_pieces
from trunnion.verification import Verdict

#: The second tool stands at a machine position while the table carries the stock under it, in lines 15 and 16.
TWO_TOOLS = (
    "%\nO0001\nG21 G17 G40 G80 G90 G94\nG49 G53 G0 Z0.\nT1 M6\nS1500 M3\nG54 G0 X0. Y0.\nG43 H1 Z20.\nG1 Z-2. F200.\n"
    "X12.\nG0 Z20.\nG49 G53 G0 Z0.\nT2 M6\nM3 S1500\n{height}G54 G0 X50. Y0.\nX0.\nG43 H2 Z20.\nG1 Z-2. F200.\nY9.\n"
    "G0 Z20.\nM5\nG49 G53 G0 Z0.\nM30\n%\n"
)
AT_HEIGHT = TWO_TOOLS.format(height="G53 G0 Z-350.\n")
TOOLS = ["1=flat:10,length=60", "2=flat:10,length=60"]


def simulated(folder: Path, text: str, lengths: dict[str, float]) -> SimulationResult:
    program = folder / "two.nc"
    program.write_text(text)
    return trunnion.simulate(
        program, machine="matsuura_mx330", stock="box:90,50,12,-20,-15,-12", tools=TOOLS, cell=3.0,
        zero=(0.0, 0.0, 60.0), tool_length=lengths,
    )  # fmt: skip


def unjudged(found: SimulationResult) -> list[int]:
    return [each.line for each in found.remarks if each.code == "SIM146"]


def test_a_rapid_below_a_machine_position_is_not_clear_by_a_length_of_nothing(tmp_path: Path) -> None:
    long = simulated(tmp_path, AT_HEIGHT, {"1": 110.0, "2": 300.0})
    assert [(each.kind, each.line) for each in long.findings if each.line < 18] == [("rapid through stock", 17)]
    unknown = simulated(tmp_path, AT_HEIGHT, {"1": 110.0})
    assert unknown.outcome is not Verdict.PASSED
    assert unjudged(unknown) == [16]
    assert unjudged(long) == []


@pytest.mark.parametrize(("known", "line"), [("1", 15), ("2", 7)])
def test_only_motions_with_the_other_tool_are_unjudged(tmp_path: Path, known: str, line: int) -> None:
    """The tool of which the length is known stands at known places, behind the other one as well."""
    found = simulated(tmp_path, TWO_TOOLS.format(height=""), {known: 110.0})
    assert unjudged(found) == [line]
    other = "2" if known == "1" else "1"
    (missing,) = [each.wording for each in found.remarks if each.wording.variant == "length_of_some_tools"]
    assert missing.parameter("names") == (f"tool {other}",)


@pytest.mark.parametrize(("length", "is_known"), [(None, False), ({"1": 110.0}, False), (300.0, True)])
def test_bodies_stand_nowhere_with_a_tool_of_unknown_length(
    tmp_path: Path, length: float | dict[str, float] | None, is_known: bool
) -> None:
    program = tmp_path / "two.nc"
    program.write_text(AT_HEIGHT)
    machine = "matsuura_mx330"
    run = trunnion.verify(program, machine=machine, zero=(0.0, 0.0, 60.0), tool_length=length).run
    known = {
        run.lines[row]: bool(flag)
        for each in axis_pieces(run, {})
        for row, flag in zip(each.row, each.known, strict=True)
    }
    assert (known[15], known[16], known[19]) == (is_known, is_known, True)
