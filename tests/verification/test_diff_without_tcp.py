"""A program with TCP and its twin without it are the same, at one workpiece zero and one tool length."""

import re
from pathlib import Path

import pytest

import trunnion

_CAP = """TOOL PATH/CAP,TOOL,B10
TLDATA/MILL,10.0,5.0,75.0,0.0,0.0
MSYS/0,0,0,1,0,0,0,1,0
$$ centerline data
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,8000,CLW
RAPID
GOTO/-60,0,0,-1,0,0
FEDRAT/MMPM,500
GOTO/-50,0,0,-1,0,0
GOTO/-43.3013,0,25,-.8660254,0,.5
GOTO/-25,0,43.3013,-.5,0,.8660254
GOTO/0,0,50,0,0,1
GOTO/25,0,43.3013,.5,0,.8660254
RAPID
GOTO/25,0,143.3013,.5,0,.8660254
END-OF-PATH
"""
_ZERO = (0.0, 0.0, 20.0)


def _both(folder: Path, machine: str) -> tuple[Path, Path]:
    """Return a program with TCP and one without for the machine."""
    source = folder / "cap.cls"
    source.write_text(_CAP, encoding="utf-8")
    with_tcp, without = folder / "with.nc", folder / "without.nc"
    assert trunnion.post(source, machine=machine, output=with_tcp).passed
    settings = {"tcp": "off", "zero": "0,0,20", "tool_length": "100"}
    assert trunnion.post(source, machine=machine, output=without, settings=settings).passed
    return with_tcp, without


def _silent(program: Path) -> Path:
    """Return the program without the comments that state its zero and its length."""
    text = program.read_text(encoding="utf-8")
    silent = program.with_name("silent.nc")
    silent.write_text(re.sub("(?i)(without TCP, for|and a tool length of) .*", "", text), encoding="utf-8")
    return silent


@pytest.mark.parametrize("machine", ["mikron_600u", "dmu65", "ucp800"])
def test_a_twin_without_tcp_is_the_same_at_the_place_that_it_states(machine: str, tmp_path: Path) -> None:
    """Half-way it turns over a pole, where the turn is a block of its own with TCP and not without."""
    with_tcp, without = _both(tmp_path, machine)
    for pair in ((with_tcp, without), (without, with_tcp)):
        found = trunnion.diff(*pair, machine=machine)
        assert found.same, found.first
        assert found.stated == (f"{without}: workpiece zero 0, 0, 20 and tool length 100",)


def test_a_place_that_nobody_states_is_asked_for(tmp_path: Path) -> None:
    with_tcp, without = _both(tmp_path, "mikron_600u")
    silent = _silent(without)
    with pytest.raises(trunnion.InputError, match=r"silent\.nc: error: cuts without TCP, .*\[PLC340\]"):
        trunnion.diff(with_tcp, silent, machine="mikron_600u")
    for length in (100.0, 200.0):  # the head stands still: the control adds the length along Z
        assert trunnion.diff(with_tcp, silent, machine="mikron_600u", zero=_ZERO, tool_length=length).same
    assert not trunnion.diff(with_tcp, silent, machine="mikron_600u", zero=(0.0, 0.0, 21.0), tool_length=100.0).same


def test_programs_that_are_both_without_tcp_are_told_apart_wherever_they_stand(tmp_path: Path) -> None:
    _, without = _both(tmp_path, "mikron_600u")
    silent = _silent(without)
    assert trunnion.diff(silent, silent, machine="mikron_600u").same
    moved = tmp_path / "moved.nc"
    text = silent.read_text(encoding="utf-8")
    moved.write_text(re.sub(r"(?m)^(40 L .*Z[-+])", r"\g<1>9", text), encoding="utf-8")
    assert moved.read_text(encoding="utf-8") != text
    assert not trunnion.diff(silent, moved, machine="mikron_600u").same


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (r"(?m)^(40 L .*Z[-+])", r"\g<1>9"),
        (r"(?m)^(40 L .*B-)\d", r"\g<1>2"),
        (r"(?m)^(40 L .*F)", r"\g<1>2"),
    ],
)
def test_one_value_in_one_block_of_the_twin_is_found(old: str, new: str, tmp_path: Path) -> None:
    with_tcp, without = _both(tmp_path, "mikron_600u")
    text = without.read_text(encoding="utf-8")
    harmed = re.sub(old, new, text, count=1)
    assert harmed != text
    without.write_text(harmed, encoding="utf-8")
    assert not trunnion.diff(with_tcp, without, machine="mikron_600u").same
