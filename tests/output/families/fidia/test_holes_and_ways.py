"""Holes at the feed that stands for rapids, and the way between two operations of one tool."""

from pathlib import Path

import pytest

import trunnion

_HOLE = """G17 Q1
G90
G71
M242
G01 A0. C0. F3000
M306 T.1
G55 O1
G69
S3300 M3
G1 X0. Y0. F3000
Z30.
G83 X0. Y0. Z30. E-5. R2. D2.{feed}
G80
X0. Y0. Z50. F3000
M5
M9
M242
M02
"""
_TWO = """TOOL PATH/{name},TOOL,D10
TLDATA/MILL,10,0,50,0,0
MSYS/0,0,0,1,0,0,0,1,0
LOAD/TOOL,1
SPINDL/RPM,3300,CLW
INTOL/0.01
OUTTOL/0.01
RAPID
GOTO/0,{y},50,{axis}
FEDRAT/MMPM,300
GOTO/0,{y},0
GOTO/10,{y},0
RAPID
GOTO/10,{y},50
END-OF-PATH
"""
_DRILL = """TOOL PATH/D,TOOL,DRILL
TLDATA/DRILL,MILL,1.45,0,50,118,35
MSYS/0,0,0,1,0,0,0,1,0
LOAD/TOOL,1
SPINDL/RPM,3300,CLW
RAPID
GOTO/0,0,50,0,0,1
CYCLE/DRILL,RAPTO,3,FEDTO,-2,RTRCTO,18,MMPM,3000
GOTO/0,0,0
GOTO/10,0,0
CYCLE/OFF
RAPID
GOTO/0,0,50
END-OF-PATH
"""


def _program(folder: Path, feed: str) -> Path:
    program = folder / "hole.txt"
    program.write_text(_HOLE.format(feed=feed), encoding="utf-8")
    return program


@pytest.mark.parametrize(("feed", "passes"), [(" F70", True), ("", False), (" F3000", False), (" F2999", True)])
def test_a_hole_at_the_feed_of_rapids_fails_without_a_cl_file(feed: str, passes: bool, tmp_path: Path) -> None:
    checks = {check.key: check for check in trunnion.verify(_program(tmp_path, feed), machine="hs664rt").checks}
    assert checks["modal"].passed is passes
    assert passes or "stands for rapids" in str(checks["modal"].places[0].said)


@pytest.mark.parametrize("to", [None, "yl569", "dmu65", "matsuura_mx330", "haas_umc750", "xyzac_trt"])
def test_conversion_keeps_such_a_hole_a_cut(to: str | None, tmp_path: Path) -> None:
    converted = trunnion.convert(
        _program(tmp_path, ""), machine="hs664rt", to_cl=to is None, to_machine=to, output=tmp_path / "out.nc"
    )
    (operation,) = converted.toolpath.operations
    assert (operation.moves.kind != 0).sum() == 4  # pecks of 2 mm from 2 to -5
    assert set(operation.moves.feed[operation.moves.kind != 0]) == {3000.0}


def test_a_hole_that_asks_for_that_feed_has_the_next_lower_one(tmp_path: Path) -> None:
    source, program = tmp_path / "d.cls", tmp_path / "d.txt"
    source.write_text(_DRILL, encoding="utf-8")
    assert trunnion.post(source, machine="hs664rt", output=program).passed
    assert "F2999" in program.read_text(encoding="utf-8")


def _between(folder: Path, axis: str = "0,0,1", **settings: str) -> list[str]:
    """Blocks from the end of the first operation to the start of the spindle in the second, without numbers."""
    source, program = folder / "two.cls", folder / "two.txt"
    parts = [_TWO.format(name=name, y=y, axis=axis) for name, y in (("OP1", 0), ("OP2", 10))]
    source.write_text("".join(parts), encoding="utf-8")
    assert trunnion.post(source, machine="hs664rt", output=program, settings=settings, edited="replace").passed
    lines = [line.partition(" ")[2] for line in program.read_text(encoding="utf-8").splitlines()]
    return lines[lines.index("M5") : lines.index("S3300 M3", lines.index("M5"))]


def test_the_tool_is_retracted_once_between_operations_that_share_it(tmp_path: Path) -> None:
    level = ["M5", "M9", "M242", "G1 C0. A0. F3000", "G69", "G55 O1", "G01 C0. A0. F3000"]
    assert _between(tmp_path) == level
    tilted = _between(tmp_path, axis="0.5,0,0.8660254", mode="tilted")
    assert tilted[:5] == ["M5", "M9", "M242", "G1 C0. A0. F3000", "G154"]
    assert tilted.count("M242") == 1
    assert not any("M306" in line for line in tilted)


def test_an_operation_that_can_be_entered_begins_as_a_program_does(tmp_path: Path) -> None:
    assert _between(tmp_path, restart="on").count("M242") == 2


@pytest.mark.parametrize("clearance", [1.0, 0.25, 0.0])
def test_the_clearance_of_pecks_is_a_value_of_the_definition(clearance: float, tmp_path: Path) -> None:
    ours = tmp_path / "ours.toml"
    ours.write_text(
        f'schema = 1\nextends = "hs664rt"\nname = "Ours"\n[control.reading]\npeck_clearance_mm = {clearance}\n',
        encoding="utf-8",
    )
    run = trunnion.read_program(_program(tmp_path, " F70"), machine=ours)
    rapids = {round(float(z), 6) for z, kind in zip(run.tip[:, 2], run.kind, strict=True) if kind == 0}
    assert {0.0 + clearance, -2.0 + clearance, -4.0 + clearance} <= rapids
    ours.write_text(ours.read_text(encoding="utf-8").replace(f"= {clearance}", "= -1"), encoding="utf-8")
    with pytest.raises(trunnion.InputError, match="peck_clearance_mm"):
        trunnion.read_program(_program(tmp_path, " F70"), machine=ours)
