"""Impellers of other sources on other machines: from a definition to proven programs, with few passes."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import ROOT
from tests.support.posted_balls import ball_centres, gaps, reaching

FOLDER = ROOT / "examples" / "impeller"

#: What the balls may be in a surface: the tolerance of the step, and the decimals of the program.
SLACK = 0.01 + 0.0015


@pytest.mark.nightly  # test_impeller_cutting says it of one machine in each run, tests/impeller of these impellers
@pytest.mark.parametrize(
    ("name", "machine", "scallop", "round_part", "operation", "copies", "radius"),
    [
        ("mixed_flow", "generic_head_head_ca", 0.3, "STOCK_ROUGHING", "ROOT_BLEND", 10, 2.5),
        ("turbo3d", "generic_nutated_b45_c", 0.15, "STOCK_FINISHING", "HUB_FINISH", 9, 1.0),
    ],
)  # fmt: skip
def test_operations_are_proven_and_no_ball_is_in_a_blade_or_the_hub(
    name: str,
    machine: str,
    scallop: float,
    round_part: str,
    operation: str,
    copies: int,
    radius: float,
    tmp_path: Path,
) -> None:
    text = (FOLDER / f"{name}.toml").read_text("utf-8").replace("scallop_mm = 0.01", f"scallop_mm = {scallop}")
    text = re.sub(r"step_down_mm = [\d.]+", "step_down_mm = 5", text).replace("stepover_mm = 0.8", "stepover_mm = 1.6")
    (tmp_path / f"{name}_points.csv").write_bytes((FOLDER / f"{name}_points.csv").read_bytes())
    (tmp_path / "part.toml").write_text(text, "utf-8")
    operations = [round_part, operation]
    found = trunnion.cut_impeller(
        tmp_path / "part.toml", machine=machine, output=tmp_path / "nc", operations=operations
    )
    assert found.passed
    assert [len(step.seconds) for step in found.steps] == [1, copies]
    for copy in (1, 2):  # with splitters: a blade, and a splitter
        centres = reaching(found.impeller, ball_centres(found, f"{operation}_{copy}", radius, 0.5), radius)
        blades, hub = gaps(found.impeller, centres)
        assert blades.min() >= radius - SLACK
        assert hub.min() >= radius - SLACK
        assert min(blades.min(), hub.min()) <= radius + SLACK
