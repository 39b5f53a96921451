"""``trunnion.simulate``: tools, their lengths, and what a program adds to them."""

from pathlib import Path

import pytest

import trunnion
from tests.support.simulating import SLOT, TOOL, simulate
from trunnion.compensation.contour_tools import ContourTools
from trunnion.compensation.stretches import RegisterValue
from trunnion.simulation.tool_deltas import as_the_tool_goes

KLARTEXT = (
    "0 BEGIN PGM PART MM\n1 TOOL CALL 1 Z S3000 DL+0.5\n2 L X-20 Y+0 R0 FMAX M3\n3 L Z+20 FMAX\n4 L Z-5 FMAX\n"
    "5 L X+70 F500\n6 L Z+20 FMAX\n7 M30\n8 END PGM PART MM\n"
)


SINUMERIK = "T1 D1\nM6\nG54 G17 G90\nS3000 M3\nG0 X-20 Y0 Z20\nTOFFL=0.5\nG0 Z-5\nG1 X70 F500\nG0 Z20\nM30\n"


@pytest.mark.parametrize(
    ("program", "machine", "removed", "told"),
    [
        (KLARTEXT, "dmu65", 2250.0, ""),
        (KLARTEXT.replace("DL+0.5", "DL-0.5 DR+0.1"), "dmu65", 2750.0, ""),
        (
            KLARTEXT.replace("DL+0.5", "DR+0.5").replace("X+70", "X+70 RL"),
            "dmu65",
            None,
            "DR adds 0.5 mm to the radius",
        ),
        (SINUMERIK, "yl569", 2250.0, ""),
        (SINUMERIK.replace("TOFFL", "TOFF[3]"), "yl569", None, "TOFF moves the tool by 0.5 mm"),
        (SLOT.replace("N50", "G43.2 Z0.5\nN50"), "xyzac_trt", 2250.0, ""),
        (SLOT.replace("G43 H1", "G43 H5"), "xyzac_trt", 2500.0, "is taken for its own length"),
    ],
    ids=["DL", "DL and DR", "DR compensated", "TOFFL", "TOFF", "G43.2", "H5"],
)
def test_what_a_program_adds_to_its_tool_is_simulated_or_refused(
    tmp_path: Path, program: str, machine: str, removed: float | None, told: str
) -> None:
    found = simulate(tmp_path, program, machine=machine)
    assert found.passed is (removed is not None)
    assert not [one for one in found.remarks if "path is that without it" in one.what and removed and "DL" in one.what]
    if removed is not None:
        assert found.removed == pytest.approx(removed, rel=1e-3)
    assert [told in one.what for one in found.remarks if told and told in one.what] == ([True] if told else [])


def test_the_length_of_another_tool_is_an_error(tmp_path: Path) -> None:
    tools = [TOOL, TOOL.replace("1=", "5=", 1)]
    two = SLOT.replace("G43 H1", "G43 H5").replace("M5\nM30", "T5 M6\nG49\nM30")
    found = simulate(tmp_path, two, tools=tools, cell=1.0)
    assert [one.line for one in found.remarks if "cuts with the length of tool 5" in one.what] == [7]
    assert not found.passed


def test_a_length_goes_along_the_tool_and_not_into_machine_positions(tmp_path: Path) -> None:
    program = "T1 D1\nM6\nG54 G90\nS3000 M3\nSUPA G0 Z0\nTRAORI\nG0 X0 Y0 Z50 B30 C0\nTOFFL=2\nG1 Z10 F500\nM30\n"
    nc = tmp_path / "part.mpf"
    nc.write_text(program)
    run = trunnion.read_program(nc, machine="yl569")
    path = as_the_tool_goes(run, {}, RegisterValue.UNKNOWN, ContourTools())
    longer = path.run
    assert not path.problems
    moved = longer.tip - run.tip
    assert moved[-1] == pytest.approx(2.0 * run.axis[-1])
    assert abs(run.axis[-1][2]) < 0.9
    assert not moved[:-1].any()


def test_a_tool_length_that_is_left_out_is_an_error(tmp_path: Path) -> None:
    two = SLOT.replace("M5\nM30", "T2 M6\nS1000 M3\nG0 X-20 Y10 Z-3\nN95 G1 X70\nG0 Z20\nM5\nM30")
    tools = [TOOL, TOOL.replace("1=", "2=", 1)]
    forgotten = simulate(tmp_path, two, tools=tools)
    assert not forgotten.passed
    assert [one for one in forgotten.remarks if "with the length of tool 1" in one.what]
    off = simulate(tmp_path, two.replace("T2 M6", "G49\nT2 M6"), tools=tools)
    assert [one for one in off.remarks if "without a tool length" in one.what]
    assert simulate(tmp_path, two.replace("T2 M6", "T2 M6\nG43 H2"), tools=tools).passed
    (never,) = [one for one in simulate(tmp_path, SLOT.replace("G43 H1\n", "")).remarks if "length:" in one.what]
    assert (never.line, never.severity) == (6, "error")
    sinumerik = "G710 G90 G54\nT1 M6\nD{}\nS1000 M3\nG0 X-20 Y0 Z20\nG0 Z-5\nG1 X70 F500\nG0 Z20\nM30\n"
    assert not simulate(tmp_path, sinumerik.format(0), machine="yl569").passed
    assert simulate(tmp_path, sinumerik.format(1), machine="yl569").passed


def test_a_tool_that_could_pass_between_the_rays_is_refused(tmp_path: Path) -> None:
    thin = "1=flat:0.6,length=60,flutes=20"
    with pytest.raises(trunnion.InputError, match=r"pass between the rays unseen; take cells of 0\.3 mm"):
        simulate(tmp_path, SLOT, tools=[thin])
    assert max(simulate(tmp_path, SLOT, tools=[thin], cell=None, stock="box:10,4,10,0,-2,-10").cell) <= 0.3


def test_a_tool_is_never_guessed(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="tool 1"):
        simulate(tmp_path, SLOT, tools=[])
    with pytest.raises(trunnion.InputError, match="before it calls a tool"):
        simulate(tmp_path, SLOT.replace("T1 M6\nG43 H1\n", ""))


@pytest.mark.parametrize(
    ("length", "holder", "passes", "words"),
    [
        ("110", ",holder=40x50", True, ""),
        ("100", ",holder=40x50", False, "the length 100 mm, and from tip to gauge point it has 110 mm"),
        ("100", "", True, "the length 100 mm, which is taken for its own"),
    ],
    ids=["same", "other", "unknown"],
)
def test_the_length_of_a_tool_definition_is_that_of_the_tool(
    tmp_path: Path, length: str, holder: str, passes: bool, words: str
) -> None:
    program = KLARTEXT.replace("1 TOOL CALL 1 Z S3000 DL+0.5", f"1 TOOL DEF 1 L+{length} R+5\n1 TOOL CALL 1 Z S3000")
    tool = f"1=flat:10,length=60,flutes=20{holder}"
    found = simulate(tmp_path, program, machine="dmu65", tools=[tool], cell=1.0)
    assert found.passed is passes
    assert found.removed == pytest.approx(2500.0, rel=1e-3)
    told = [one.what for one in found.remarks if "TOOL DEF" in one.what]
    assert [words in what for what in told] == ([True] if words else [])


def test_the_radius_of_a_tool_definition_counts_where_it_is_compensated(tmp_path: Path) -> None:
    program = KLARTEXT.replace("1 TOOL CALL 1 Z S3000 DL+0.5", "1 TOOL DEF 1 L+110 R+4\n1 TOOL CALL 1 Z S3000")
    assert simulate(tmp_path, program, machine="dmu65", cell=1.0).passed
    compensated = simulate(tmp_path, program.replace("X+70", "X+70 RL"), machine="dmu65", cell=1.0)
    assert [one.line for one in compensated.remarks if "the radius 4 mm" in one.what and "it has 5 mm" in one.what]
    assert not compensated.passed


def test_another_edge_of_the_tool_is_told(tmp_path: Path) -> None:
    first = SINUMERIK.replace("TOFFL=0.5\n", "")
    told = [
        [one.line for one in simulate(tmp_path, program, machine="yl569", cell=1.0).remarks if "edge D2" in one.what]
        for program in (first, first.replace("D1", "D2"))
    ]
    assert told == [[], [5]]
