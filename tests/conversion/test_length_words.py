"""Positions without a tool length, and registers: what a program does not say is asked for, all of it at once."""

from collections.abc import Sequence
from pathlib import Path

import pytest

import trunnion
from trunnion.errors import Problem, RefusedError

HEAD = "%\nO1\nG21 G17 G40 G49 G69 G80 G90 G94\nT1 M6\nG54 G0 X0. Y0. S900 M3\n"

#: Programs that cut without a tool length, by machine.
BARE = {
    "matsuura_mx330": HEAD + "Z9.\nG1 Z-1. F300.\nX9.\nG0 Z9.\nM30\n%\n",
    "xyzac_trt": "G21 G17 G40 G49 G80 G90 G94\nT1 M6\nG54 G0 X0 Y0 S900 M3\nZ9\nG1 Z-1 F300\nX9\nG0 Z9\nM2\n",
    "yl569": "G71 G17 G40 G90 G94\nT1 M6\nG54 G0 X0 Y0 S900 M3\nZ9\nG1 Z-1 F300\nX9\nG0 Z9\nM30\n",
}


def program(folder: Path, text: str) -> Path:
    path = folder / "a.nc"
    path.write_text(text)
    return path


@pytest.mark.parametrize("machine", BARE)
def test_positions_without_a_length_are_asked_for(machine: str, tmp_path: Path) -> None:
    nc = program(tmp_path, BARE[machine])
    for length in (None, 50.0):
        with pytest.raises(RefusedError) as refused:
            trunnion.convert(nc, machine=machine, to_cl=True, tool_length=length)
        assert [each.code for each in refused.value.problems] == ["CNV145", "CNV130"]


@pytest.mark.parametrize("machine", BARE)
def test_they_are_those_of_the_tip_or_of_the_gauge_line(machine: str, tmp_path: Path) -> None:
    nc = program(tmp_path, BARE[machine])

    def depth(**given: object) -> float:
        found = trunnion.convert(nc, machine=machine, to_cl=True, **given)  # type: ignore[arg-type]
        return float(min(found.toolpath.operations[0].moves.tip[:, 2]))

    assert depth(positions="tip") == -1.0
    assert depth(positions="tip", tool_length=50.0) == -1.0
    assert depth(positions="gauge_line", tool_length=50.0) == -51.0
    with pytest.raises(RefusedError, match="length is not known"):
        depth(positions="gauge_line")


def test_a_program_that_calls_its_length_is_not_asked(tmp_path: Path) -> None:
    nc = program(tmp_path, BARE["matsuura_mx330"].replace("Z9.\nG1", "G43 H1 Z9.\nG1"))
    assert trunnion.convert(nc, machine="matsuura_mx330", to_cl=True).passed


def test_all_that_is_missing_is_said_at_once(tmp_path: Path) -> None:
    lines = "Z9.\nG1 Z-1. F300.\nG41 D21 X9.\nY9.\nG40 X20.\nG41 D22 X30.\nY0.\nG40 X40.\nM88\nG0 Z9.\nM30\n%\n"
    nc = program(tmp_path, HEAD + lines)
    with pytest.raises(RefusedError) as refused:
        trunnion.convert(nc, machine="matsuura_mx330", to_machine="dmu65")
    assert [each.code for each in refused.value.problems] == ["CNV145", "CNV151", "CNV146", "CNV130"]
    assert "D21, D22: registers of the radius" in str(refused.value)
    converted = trunnion.convert(
        nc,
        machine="matsuura_mx330",
        to_machine="dmu65",
        positions="tip",
        registers={"D21": "tool", "D22": "tool"},
        assume={"M88": "coolant through"},
    )
    assert converted.passed
    assert " RL" in str(converted.text)


def test_length_registers_are_as_they_are_stated(tmp_path: Path) -> None:
    nc = program(tmp_path, BARE["matsuura_mx330"].replace("Z9.\nG1", "G43 H11 Z9.\nG1"))
    for stated, word in (({}, "H11"), ({"H11": "tool"}, "H1 "), ({"H11": "H7"}, "H7")):
        posted = trunnion.convert(nc, machine="matsuura_mx330", to_machine="haas_umc750", registers=stated)
        assert word in str(posted.text).replace("\n", " ").replace("H01", "H1").replace("H07", "H7")


#: A cut under TCP, which a LinuxCNC switches on by itself, and the block that calls its length.
UNDER_TCP = (
    "G21 G17 G40 G49 G80 G90 G94\nT1 M6\nG54\nG0 A-20 C0\n{length}M428\n"
    "G0 X0 Y0 Z50 S900 M3\nZ9\nG1 Z-1 F300\nX9\nG0 Z50\nM429\nG49\nG53 G0 Z0\nM2\n"
)

#: The same on a Sinumerik.
UNDER_TRAORI = (
    "G71 G17 G40 G90 G94\nT1 M6\nG54\nD0\nG0 B20 C0\n{length}TRAORI\n"
    "G0 X0 Y0 Z50 S900 M3\nZ9\nG1 Z-1 F300\nX9\nG0 Z50\nTRAFOOF\nD0\nSUPA G0 Z0\nM30\n"
)


@pytest.mark.parametrize(("machine", "text"), [("xyzac_trt", UNDER_TCP), ("yl569", UNDER_TRAORI)])
def test_positions_without_a_length_are_asked_for_under_tcp(machine: str, text: str, tmp_path: Path) -> None:
    nc = program(tmp_path, text.format(length=""))
    for given in ({}, {"positions": "gauge_line", "tool_length": 50.0}):
        with pytest.raises(RefusedError, match="guides the gauge line, and not the tip"):
            trunnion.convert(nc, machine=machine, to_cl=True, **given)  # type: ignore[arg-type]
    assert trunnion.convert(nc, machine=machine, to_cl=True, positions="tip").passed
    length = "D1\n" if machine == "yl569" else "G43 H1\n"
    assert trunnion.convert(program(tmp_path, text.format(length=length)), machine=machine, to_cl=True).passed


def test_a_length_that_may_be_skipped_alone_in_its_block_is_told(tmp_path: Path) -> None:
    warned: list[str] = []

    class Told(trunnion.Observer):
        def problems(self, problems: Sequence[Problem]) -> None:
            warned.extend(each.wording.variant for each in problems)

    def variants(length: str) -> list[str]:
        warned.clear()
        nc = program(tmp_path, UNDER_TCP.format(length=length))
        trunnion.convert(nc, machine="xyzac_trt", to_cl=True, observer=Told())
        return [each for each in warned if each == "skips_length"]

    assert variants("/G43 H1\n") == ["skips_length"]
    assert variants("/M8\nG43 H1\n") == []
