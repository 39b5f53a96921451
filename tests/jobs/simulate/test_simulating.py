"""``trunnion.simulate``: programs that cut stock, and what they do that they must not."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.simulating import HEAD, SLOT, STOCK, TOOL, cuboid, simulate, slotted
from tests.support.sweeps import CUBE_FACES
from trunnion.simulation.meshes import TriangleMesh


def test_a_slot_is_cut_and_nothing_is_wrong(tmp_path: Path) -> None:
    found = simulate(tmp_path, SLOT)
    assert found.passed
    assert found.removed == pytest.approx(2500.0, rel=1e-3)
    (operation,) = found.operations
    assert (operation.tool, operation.air, operation.findings) == ("1", 0.0, 0)


def test_the_volume_of_each_block_and_minute_is_told(tmp_path: Path) -> None:
    halves = SLOT.replace("N60 G1 X70 F500\n", "N60 G1 X30 F500\nG1 X70 F250\n")
    found = simulate(tmp_path, halves)
    (operation,) = found.operations
    blocks = operation.blocks
    assert blocks.line.tolist() == [7, 8]
    # The first block removes what is before the cutter's middle at X30 and the half circle before it.
    first = 5.0 * (300.0 + math.pi * 25.0 / 2.0)
    np.testing.assert_allclose(blocks.removed, [first, 2500.0 - first], rtol=5e-3)
    np.testing.assert_allclose(blocks.rate, blocks.removed / [50.0 / 500.0, 40.0 / 250.0], rtol=2e-3)
    assert blocks.removed.sum() == pytest.approx(operation.removed, rel=1e-12)
    data = tmp_path / "found.json"
    trunnion.write_report(found, data)
    told = json.loads(data.read_text())["operations"][0]["blocks"]
    assert (told["line"], len(told["removed_mm3"]), len(told["mm3_per_min"])) == ([7, 8], 2, 2)


@pytest.mark.parametrize(
    ("program", "kind", "block", "depth"),
    [
        (SLOT.replace("N60 G1 X70 F500", "N60 G0 X70"), "rapid through stock", 60, 5.0),
        (SLOT.replace("S1000 M3", "S1000"), "cuts with the spindle off", 60, 5.0),
        (SLOT.replace("Z-5", "Z-9.5").replace("Z20\nM5", "Z20\nM5"), None, 60, 9.5),
    ],
    ids=["rapid", "standing", "sound"],
)
def test_what_a_block_must_not_do_is_found(
    tmp_path: Path, program: str, kind: str | None, block: int, depth: float
) -> None:
    found = simulate(tmp_path, program)
    if kind is None:
        assert found.passed
        return
    (finding,) = found.findings
    assert (finding.kind, finding.block, finding.line) == (kind, block, 7)
    assert finding.depth == pytest.approx(depth, abs=0.1)
    assert not found.passed


@pytest.mark.parametrize(
    ("tool", "kind", "depth"),
    [
        ("1=flat:10,length=60,flutes=3", "shank into stock", 2.0),
        ("1=flat:10,length=4,flutes=4,holder=40x50", "holder into stock", 1.0),
    ],
    ids=["flutes", "holder"],
)
def test_what_does_not_cut_meets_the_stock(tmp_path: Path, tool: str, kind: str, depth: float) -> None:
    found = simulate(tmp_path, SLOT, tools=[tool])
    kinds = {finding.kind: finding for finding in found.findings}
    assert kinds[kind].block == 60
    assert kinds[kind].depth == pytest.approx(depth, abs=0.1)


def test_the_part_that_comes_out_is_compared_with_the_design(tmp_path: Path) -> None:
    sound = simulate(tmp_path, SLOT, part=slotted(5.0))
    assert sound.left is not None
    assert sound.gouge is not None
    assert sound.passed
    assert max(sound.left.largest, sound.gouge.largest) <= sound.limit
    gouged = simulate(tmp_path, SLOT, part=slotted(4.6))
    assert gouged.gouge is not None
    assert gouged.gouge.largest == pytest.approx(0.4, abs=0.01)
    assert [(one.kind, one.block) for one in gouged.findings] == [("gouge", 60)]
    assert gouged.findings[0].depth == pytest.approx(0.4, abs=0.01)
    left = simulate(tmp_path, SLOT, part=slotted(6.0))
    assert left.left is not None
    assert left.left.largest == pytest.approx(1.0, abs=0.01)
    assert left.left.volume == pytest.approx(500.0, rel=0.2)
    assert left.passed  # a roughing program leaves material


def test_what_is_gone_altogether_names_the_block_that_took_it(tmp_path: Path) -> None:
    pin = cuboid((30, -2, -10), (32, 2, 0))
    rest = cuboid((0, 12, -10), (50, 20, 0))
    part = TriangleMesh(np.concatenate((pin.vertices, rest.vertices)), np.concatenate((CUBE_FACES, CUBE_FACES + 8)))
    program = SLOT.replace("N50 G0 Z-5", "N50 G0 Z-11").replace("N60 G1 X70 F500", "N55 G1 X12 F500\nN60 G1 X70")
    tool = "1=flat:20,length=60,flutes=20,holder=40x50"
    found = simulate(tmp_path, program, part=part, tools=[tool], cell=1.0)
    assert [(one.kind, one.block) for one in found.findings] == [("gouge", 60)]
    x, y, z = found.findings[0].place
    assert 30.0 < x < 32.0
    assert -2.0 < y < 2.0
    assert -10.0 < z < 0.0
    assert found.findings[0].depth == pytest.approx(2.0, abs=0.1)


def test_it_ends_after_the_first_finding_or_before_a_block(tmp_path: Path) -> None:
    program = SLOT.replace("N70 G0 Z20", "N70 G0 Y15\nN80 G0 X-20\nN90 G0 Z20")
    whole = simulate(tmp_path, program)
    first = simulate(tmp_path, program, stop_at="first")
    assert [one.block for one in whole.findings] == [80]
    assert first.simulation.stopped is not None
    assert first.removed == pytest.approx(whole.removed)
    before = simulate(tmp_path, program, until="N60")
    assert before.removed == 0.0
    with pytest.raises(trunnion.InputError, match="no block N7777"):
        simulate(tmp_path, program, until="N7777")


def steps(word: str, depth: float) -> str:
    """The slot in steps of 0.09 mm."""
    way = "\n".join(f"{word} X{-20 + 0.09 * k:.3f}" for k in range(1, 1001))
    return HEAD + f"N50 G1 Z-{depth} F500\n{way}\nG0 Z20\nM5\nM30\n"


@pytest.mark.parametrize(
    ("program", "kind", "depth"),
    [
        (steps("G0", 5.0), "rapid through stock", 5.0),
        (steps("G1", 5.0).replace("S1000 M3", "S1000"), "cuts with the spindle off", 5.0),
        (steps("G1", 5.25), "gouge", 0.25),
    ],
    ids=["rapid", "standing", "gouge"],
)
def test_small_steps_hide_nothing(tmp_path: Path, program: str, kind: str, depth: float) -> None:
    found = simulate(tmp_path, program, part=slotted(5.0))
    (finding,) = [one for one in found.findings if one.kind == kind]
    assert finding.depth == pytest.approx(depth, abs=0.02)
    assert finding.line > 100
    first = simulate(tmp_path, program, part=slotted(5.0), stop_at="first")
    assert 0.0 < first.removed < 0.5 * found.removed


@pytest.mark.parametrize(
    "program",
    [SLOT.replace("N50", "T1 M6\nG43 H1\nN50"), SLOT.replace("S1000 M3", "S0 M3"), SLOT.replace("S1000 M3", "M3")],
    ids=["change", "zero", "no speed"],
)
def test_a_spindle_that_stands_is_found(tmp_path: Path, program: str) -> None:
    assert {(one.kind, one.block) for one in simulate(tmp_path, program).findings} == {
        ("cuts with the spindle off", 60)
    }


def test_a_program_that_never_touches_the_stock_says_so(tmp_path: Path) -> None:
    found = simulate(tmp_path, SLOT.replace("Y0", "Y100"))
    assert [one for one in found.remarks if "takes nothing from the stock" in one.what]


def test_what_the_reader_warns_of_is_told(tmp_path: Path) -> None:
    found = simulate(tmp_path, SLOT.replace("N60", "G54\nN55 G55\nN60"))
    assert [one for one in found.remarks if "work offset" in one.what]


def test_a_block_before_which_it_ends_may_stand_before_what_runs_earlier(tmp_path: Path) -> None:
    nc = tmp_path / "part.h"
    nc.write_text(
        "0 BEGIN PGM PART MM\n1 TOOL CALL 1 Z S3000\n2 L X-20 Y+0 R0 FMAX M3\n3 L Z+20 FMAX\n4 CALL LBL 1\n"
        "5 L Z+30 FMAX\n6 M30\n7 LBL 1\n8 L Z-5 FMAX\n9 L X+70 F500\n10 L Z+20 FMAX\n11 LBL 0\n12 END PGM PART MM\n"
    )
    found = trunnion.simulate(nc, machine="dmu65", stock=STOCK, tools=[TOOL], cell=0.5, until=5)
    assert found.removed == pytest.approx(2500.0, rel=1e-3)


def test_an_operation_of_a_subprogram_is_told_in_its_file(tmp_path: Path) -> None:
    main, slot = tmp_path / "main.h", tmp_path / "slot.h"
    main.write_text("0 BEGIN PGM MAIN MM\n1 CALL PGM slot.h\n2 M30\n3 END PGM MAIN MM\n")
    slot.write_text(
        "0 BEGIN PGM SLOT MM\n1 TOOL CALL 1 Z S3000\n2 L X-20 Y+0 R0 FMAX M3\n3 L Z+20 FMAX\n4 L Z-5 FMAX\n"
        "5 L X+70 F500\n6 L Z+20 FMAX\n7 END PGM SLOT MM\n"
    )
    found = trunnion.simulate(main, machine="dmu65", stock=STOCK, tools=[TOOL], subprograms=[slot], cell=0.5)
    (operation,) = found.operations
    assert operation.removed == pytest.approx(2500.0, rel=1e-3)
    assert (operation.file, operation.line, operation.last_line) == (str(slot), 3, 7)


def test_several_programs_cut_the_same_stock(tmp_path: Path) -> None:
    one, two = tmp_path / "one.ngc", tmp_path / "two.ngc"
    one.write_text(SLOT)
    two.write_text(SLOT.replace("Y0", "Y10"))
    found = trunnion.simulate([one, two], machine="xyzac_trt", stock=STOCK, tools=[TOOL], cell=0.5)
    assert found.removed == pytest.approx(5000.0, rel=1e-3)
    again = trunnion.simulate([one, one], machine="xyzac_trt", stock=STOCK, tools=[TOOL], cell=0.5)
    assert again.operations[1].removed == pytest.approx(0.0, abs=1e-6)
    assert again.air[0].length == pytest.approx(90.0)


def test_a_program_with_an_error_cuts_up_to_there(tmp_path: Path) -> None:
    found = simulate(tmp_path, SLOT.replace("N60", "N55 G4711\nN60"))
    assert not found.passed
    assert found.removed == 0.0
    assert [remark for remark in found.remarks if "it is cut up to there" in remark.what]


def test_a_cylinder_is_bored(tmp_path: Path) -> None:
    program = HEAD.replace("X-20", "X0") + "N60 G1 Z-12 F500\nN70 G0 Z20\nM5\nM30\n"
    found = simulate(tmp_path, program, stock="cylinder:30,10,-10", cell=0.25)
    assert found.removed == pytest.approx(250.0 * math.pi, rel=0.01)
