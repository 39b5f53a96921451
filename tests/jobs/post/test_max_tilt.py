"""``--max-tilt`` refuses operations whose tool axis leans too far."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.cli import main

BLADE = str(YL569 / "3_blade_finish.cls")


def test_an_operation_that_leans_more_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "blade.mpf"
    post = ["post", BLADE, "--machine", "yl569", "--output", str(output)]
    assert main([*post, "--max-tilt", "10"]) == 1
    (said,) = [line for line in capsys.readouterr().err.splitlines() if "PLN340" in line]
    assert said.startswith(f"{BLADE}:")
    assert "the tool axis leans" in said
    assert "degrees from Z, over 10; allow it with --max-tilt …, or lean" in said
    assert not output.exists()


def test_the_setting_is_that_of_the_library_and_of_projects() -> None:
    leaning = trunnion.plan(BLADE, machine="yl569").motions[0].operation.moves.axis[:, 2].min()
    assert leaning < 0.98
    with pytest.raises(trunnion.RefusedError, match="PLN340"):
        trunnion.post(BLADE, machine="yl569", settings={"max_tilt": 10})
    assert trunnion.post(BLADE, machine="yl569", settings={"max_tilt": 180}).passed
    with pytest.raises(trunnion.InputError, match="max_tilt"):
        trunnion.post(BLADE, machine="yl569", settings={"max_tilt": 181})
