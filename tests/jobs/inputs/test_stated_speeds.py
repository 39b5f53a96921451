"""The setting ``spindle``: speeds that the CL file does not have."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.errors import InputError, RefusedError


@pytest.fixture
def silent(tmp_path: Path) -> Path:
    """A CL file of one operation, NO_SPINDL, that never turns the spindle on."""
    text = (YL569 / "2_hub_rough.cls").read_text()
    lines = [line for line in text.splitlines() if not line.startswith("SPINDL")]
    assert len(lines) < len(text.splitlines())
    name = next(line for line in lines if line.startswith("TOOL PATH/")).split("/")[1].split(",")[0]
    file = tmp_path / "silent.cls"
    file.write_text("\n".join(lines).replace(name, "NO_SPINDL") + "\n")
    return file


def words(file: Path) -> str:
    """Return a program as text."""
    return file.read_text("utf-8")


@pytest.mark.parametrize("value", ["7000", "NO_SPINDL:7000", "500,NO_SPINDL:7000"])
def test_an_operation_without_spindl_turns_at_the_stated_speed(silent: Path, value: str, tmp_path: Path) -> None:
    found = trunnion.post(silent, machine="yl569", settings={"spindle": value}, output=tmp_path / "a.mpf")
    assert "S7000" in words(tmp_path / "a.mpf")
    assert found.verification is not None
    assert found.verification.passed
    again = {"spindle": value}
    assert trunnion.verify(tmp_path / "a.mpf", machine="yl569", cl=[silent], settings=again).passed
    assert not trunnion.verify(tmp_path / "a.mpf", machine="yl569", cl=[silent], settings={"spindle": "6000"}).passed


def test_a_speed_below_zero_is_counter_clockwise(silent: Path, tmp_path: Path) -> None:
    settings = {"spindle": "NO_SPINDL:-700"}
    found = trunnion.post(silent, machine="yl569", settings=settings, output=tmp_path / "a.mpf")
    assert found.passed
    assert re.search(r"\bS700\b.* M4\b", words(tmp_path / "a.mpf"))
    assert trunnion.verify(tmp_path / "a.mpf", machine="yl569", cl=[silent], settings=settings).passed
    clockwise = {"spindle": "NO_SPINDL:700"}
    assert not trunnion.verify(tmp_path / "a.mpf", machine="yl569", cl=[silent], settings=clockwise).passed


def test_without_the_setting_it_is_refused(silent: Path, tmp_path: Path) -> None:
    with pytest.raises((InputError, RefusedError), match="spindle=OPERATION:RPM"):
        trunnion.post(silent, machine="yl569", output=tmp_path / "a.mpf")


def test_operations_that_turn_keep_their_speed(tmp_path: Path) -> None:
    hub = YL569 / "2_hub_rough.cls"
    trunnion.post(hub, machine="yl569", output=tmp_path / "a.mpf")
    trunnion.post(hub, machine="yl569", settings={"spindle": "77"}, output=tmp_path / "b.mpf")
    assert words(tmp_path / "a.mpf") == words(tmp_path / "b.mpf")


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("fast", "RPM"),
        ("0", "RPM"),
        ("NO_SPINDL:", "RPM"),
        ("nan", "RPM"),
        ("1,2", "two values"),
        ("OTHER:500", "none of that name"),
    ],
)
def test_what_is_no_speed_of_an_operation_is_an_error(silent: Path, value: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=said):
        trunnion.post(silent, machine="yl569", settings={"spindle": value}, output=tmp_path / "a.mpf")


def test_an_operation_with_spindl_is_given_no_other_speed(silent: Path, tmp_path: Path) -> None:
    spoken = silent.with_name("spoken.cls")
    spoken.write_text(silent.read_text().replace("GOTO/", "SPINDL/RPM,3000,CLW\nGOTO/", 1))
    with pytest.raises(InputError, match="SPINDL before its first cut"):
        trunnion.post(spoken, machine="yl569", settings={"spindle": "NO_SPINDL:500"}, output=tmp_path / "a.mpf")
