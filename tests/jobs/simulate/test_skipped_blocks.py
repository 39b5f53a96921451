"""A program with blocks that may be skipped is cut with them and without, and each finding says which."""

from pathlib import Path

import pytest

import trunnion
from trunnion.jobs.simulate.result import SimulationResult

HEAD = "%\nO0001\nG21 G17 G40 G80 G90 G94\nG49 G53 G0 Z0.\n{tool}T1 M6\nG54\nS1500 M3\n"
CUTS = "G0 X0. Y0.\nG43 H1 Z50.\nZ2.\n{plunge}G1 Z-1. F200.\nG1 X30. F200.\n{retract}G0 Z50.\n"
END = "N900 G0 Y5.\nX0.\nM5\nG49 G53 G0 Z0.\nM30\n%\n"


def simulated(
    folder: Path, *, tool: str = "", plunge: str = "", retract: str = "", **given: object
) -> SimulationResult:
    program = folder / "p.nc"
    text = HEAD.format(tool=tool) + CUTS.format(plunge=plunge, retract=retract) + END
    program.write_text(text, encoding="utf-8")
    return trunnion.simulate(
        program, machine="matsuura_mx330", stock="box:80,20,10,-10,-10,-10", tools=["1=ball:10,length=60"], cell=2.0,
        **given,  # type: ignore[arg-type]
    )  # fmt: skip


def test_a_rapid_through_stock_behind_a_retract_that_may_be_skipped(tmp_path: Path) -> None:
    found = simulated(tmp_path, retract="/")
    assert not found.passed
    assert {(each.kind, each.skipped) for each in found.findings} == {
        ("rapid through stock", "with blocks skipped (/, first in line 13)")
    }
    assert str(found.findings[0]).startswith("with blocks skipped (/, first in line 13): rapid through stock: ")
    assert found.findings[0].first_line == 14
    assert found.meanings == ("with blocks skipped (/, first in line 13)",)
    assert found.removed == simulated(tmp_path).removed
    assert simulated(tmp_path).passed


def test_each_level_is_cut(tmp_path: Path) -> None:
    found = simulated(tmp_path, plunge="/2", retract="/3")
    levels = [f"with blocks{which} skipped (/, first in line {line})" for which, line in
              (("", 11), (" of level 2", 11), (" of level 3", 13))]  # fmt: skip
    assert list(found.meanings) == levels
    assert {each.skipped for each in found.findings} == {levels[2]}  # all together stay above the stock
    assert found.verdict.startswith("1 finding: the program must not run; simulated with no block skipped and ")


def test_blocks_that_change_nothing_are_nothing_found(tmp_path: Path) -> None:
    found = simulated(tmp_path, plunge="/M8\n")
    assert found.passed
    assert found.verdict.startswith(
        "nothing found; simulated with no block skipped and with blocks skipped (/, first in line 11)"
    )
    assert simulated(tmp_path).meanings == ()


def test_cuts_without_a_tool_are_an_error_of_that_meaning(tmp_path: Path) -> None:
    found = simulated(tmp_path, tool="/")
    assert not found.passed
    wrong = [each for each in found.remarks if each.code == "SIM150"]
    assert [each.what for each in wrong] == [
        "with blocks skipped (/, first in line 5): the program cuts before it calls a tool"
    ]


def test_a_simulation_to_a_block_or_to_the_first_finding(tmp_path: Path) -> None:
    assert simulated(tmp_path, retract="/", until=900).passed
    assert simulated(tmp_path, retract="/N901 ", until=901).passed  # all behind it is skipped as well
    found = simulated(tmp_path, retract="/", stop_at="first")
    assert [each.first_line for each in found.findings] == [14]


def test_all_setups_are_cut_again(tmp_path: Path) -> None:
    first = HEAD.format(tool="") + CUTS.format(plunge="/", retract="") + END
    second = HEAD.format(tool="") + "G0 X10. Y0.\nG43 H1 Z50.\nZ-1.\nZ50.\nM5\nG49 G53 G0 Z0.\nM30\n%\n"
    for name, text in (("a.nc", first), ("b.nc", second)):
        (tmp_path / name).write_text(text, encoding="utf-8")
    project = tmp_path / "p.toml"
    project.write_text(
        'machine = "matsuura_mx330"\nstock = "box:80,20,10,-10,-10,-10"\ncell_mm = 2.0\n'
        'tools = ["1=ball:10,length=60"]\n[[setup]]\nname = "one"\nprograms = ["a.nc"]\n'
        '[[setup]]\nname = "two"\nprograms = ["b.nc"]\n',
        encoding="utf-8",
    )
    found = trunnion.simulate(project)
    assert [(each.setup, each.kind, bool(each.skipped)) for each in found.findings] == [
        ("two", "rapid through stock", True)  # into what the plunge of the first set-up has not cut
    ]
    assert found.setups[0].passed
    assert not found.setups[1].passed


def test_a_post_is_simulated_with_its_blocks_skipped(tmp_path: Path) -> None:
    cl, out = tmp_path / "p.cls", tmp_path / "p.nc"
    cl.write_text(
        "TOOL PATH/ONE,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\n"
        "RAPID\nGOTO/0,0,50,0,0,1\nFEDRAT/MMPM,500\nGOTO/0,0,-1\nGOTO/30,0,-1\nRAPID\nGOTO/30,0,0\n"
        "OPSKIP/ON\nFEDRAT/MMPM,500\nGOTO/30,0,-1\nGOTO/30,5,-1\nRAPID\nGOTO/30,5,0\nOPSKIP/OFF\n"
        "RAPID\nGOTO/30,15,-0.5\nRAPID\nGOTO/30,15,50\nEND-OF-PATH\n",
        encoding="utf-8",
    )
    given = {"stock": "box:80,20,10,-10,-10,-10", "tools": ["1=flat:10,length=60"], "cell": 2.0}
    with pytest.raises(
        trunnion.ProofFailedError, match=r"with blocks skipped \(/, first in line \d+\): rapid through stock"
    ):
        trunnion.post(cl, machine="matsuura_mx330", output=out, simulation=given)
